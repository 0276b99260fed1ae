// SPDX-License-Identifier: BSD-3-Clause
import { useEffect } from "preact/hooks";
import { useStore } from "../use_store";
import { Charts } from "./charts";
import { EventsPanel } from "./events_panel";
import { Header } from "./header";
import { HealthPanel } from "./health_panel";
import { HelpDialog } from "./help_dialog";
import { ImageView } from "./image_view";
import { MapPanel } from "./map_panel";
import { ReplayBar } from "./replay_bar";

export function App() {
  const title = useStore((state) => state.hello?.title);
  const hasTimeline = useStore((state) => state.timeline !== null);
  useEffect(() => {
    document.title = title ? `${title}: Kestrel` : "Kestrel";
  }, [title]);
  return (
    <>
      <Header />
      <main>
        <div class="column">
          <ImageView />
          {hasTimeline && <ReplayBar />}
          <Charts />
        </div>
        <div class="column">
          <MapPanel />
          <HealthPanel />
          <EventsPanel />
        </div>
      </main>
      <HelpDialog />
    </>
  );
}
