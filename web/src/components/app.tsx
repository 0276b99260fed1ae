// SPDX-License-Identifier: BSD-3-Clause
import { useEffect } from "preact/hooks";
import { isOffered } from "../actions";
import { panels, type PanelName } from "../store";
import { useStore } from "../use_store";
import { CalibrationPage } from "./calibration_page";
import { CameraPage } from "./camera_page";
import { Charts } from "./charts";
import { ColorPage } from "./color_page";
import { EventsPanel } from "./events_panel";
import { ExportPanel } from "./export_panel";
import { Header } from "./header";
import { HealthPanel } from "./health_panel";
import { HelpDialog } from "./help_dialog";
import { ImageView, ViewPanel } from "./image_view";
import { MapPanel } from "./map_panel";
import { PageSwitch } from "./page_switch";
import { Panel, PanelSwitch } from "./panel";
import { ReplayBar } from "./replay_bar";
import { SecondRunPanel } from "./second_run_panel";
import { StudyCaption, StudyPage } from "./study_page";

export function App() {
  const hasColors = useStore((state) => state.hello?.colors ?? false);
  const isOnColors = useStore((state) => state.page === "colors") && hasColors;
  const title = useStore((state) => state.hello?.title);
  const isOnCalibration = useStore((state) => state.page === "calibration") && isOffered("calibrate");
  const isOnStudy = useStore((state) => state.page === "study") && isOffered("open");
  useEffect(() => {
    document.title = title ? `${title}: Kestrel` : "Kestrel";
  }, [title]);
  return (
    <>
      <Header />
      <PageSwitch />
      {isOnColors && <ColorPage />}
      {isOnCalibration && <CalibrationPage />}
      {isOnStudy && <StudyPage />}
      {!isOnColors && !isOnCalibration && !isOnStudy && (isOffered("lens") ? <CameraPage /> : <WatchPage />)}
      <HelpDialog />
    </>
  );
}

/** The image with what was found, the map, the series; of a recording its timeline. */
function WatchPage() {
  const hasTimeline = useStore((state) => state.timeline !== null);
  const hasOptions = useStore((state) => state.options.length > 0);
  const hasExports = useStore((state) => state.hello?.exports ?? false);
  const isThere = (name: PanelName) => (name !== "again" || hasOptions) && (name !== "save" || hasExports);
  return (
    <main class="watch">
      <div class="stage">
        <StudyCaption />
        <ImageView />
        {hasTimeline && <ReplayBar />}
      </div>
      <div class="details">
        <PanelSwitch names={panels.filter(isThere)} />
        <div class="column">
          <Panel name="view">
            <ViewPanel />
          </Panel>
          <Panel name="save">{hasExports && <ExportPanel />}</Panel>
          <Panel name="plots">
            <Charts />
          </Panel>
        </div>
        <div class="column">
          <Panel name="map">
            <MapPanel />
          </Panel>
          <Panel name="again">{hasOptions && <SecondRunPanel />}</Panel>
          <Panel name="health">
            <HealthPanel />
          </Panel>
          <Panel name="events">
            <EventsPanel />
          </Panel>
        </div>
      </div>
    </main>
  );
}
