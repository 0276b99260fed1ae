// SPDX-License-Identifier: BSD-3-Clause
import { useEffect } from "preact/hooks";
import { isOffered } from "../actions";
import { useStore } from "../use_store";
import { CalibrationPage } from "./calibration_page";
import { Charts } from "./charts";
import { ColorPage } from "./color_page";
import { EventsPanel } from "./events_panel";
import { Header } from "./header";
import { HealthPanel } from "./health_panel";
import { HelpDialog } from "./help_dialog";
import { ImageView } from "./image_view";
import { MapPanel } from "./map_panel";
import { PageSwitch } from "./page_switch";
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
      {!isOnColors && !isOnCalibration && !isOnStudy && <WatchPage />}
      <HelpDialog />
    </>
  );
}

/** The image with what was found, the map, the series; of a recording its timeline. */
function WatchPage() {
  const hasTimeline = useStore((state) => state.timeline !== null);
  const hasOptions = useStore((state) => state.options.length > 0);
  return (
    <main>
      <div class="column">
        <StudyCaption />
        <ImageView />
        {hasTimeline && <ReplayBar />}
        <Charts />
      </div>
      <div class="column">
        <MapPanel />
        {hasOptions && <SecondRunPanel />}
        <HealthPanel />
        <EventsPanel />
      </div>
    </main>
  );
}
