// SPDX-License-Identifier: BSD-3-Clause
import { useEffect } from "preact/hooks";
import { useStore } from "../use_store";
import { showPage } from "../color_actions";
import { Charts } from "./charts";
import { ColorPage } from "./color_page";
import { EventsPanel } from "./events_panel";
import { Header } from "./header";
import { HealthPanel } from "./health_panel";
import { HelpDialog } from "./help_dialog";
import { ImageView } from "./image_view";
import { MapPanel } from "./map_panel";
import { ReplayBar } from "./replay_bar";
import { SecondRunPanel } from "./second_run_panel";

/** The pages, where there is more than one. */
function Pages() {
  const page = useStore((state) => state.page);
  return (
    <nav aria-label="Pages">
      <button aria-pressed={page === "main"} onClick={() => showPage("main")}>
        Replay
      </button>
      <button aria-pressed={page === "colors"} onClick={() => showPage("colors")}>
        Colours
      </button>
    </nav>
  );
}

export function App() {
  const hasColors = useStore((state) => state.hello?.colors ?? false);
  const isOnColors = useStore((state) => state.page === "colors") && hasColors;
  const title = useStore((state) => state.hello?.title);
  const hasTimeline = useStore((state) => state.timeline !== null);
  const hasOptions = useStore((state) => state.options.length > 0);
  useEffect(() => {
    document.title = title ? `${title}: Kestrel` : "Kestrel";
  }, [title]);
  return (
    <>
      <Header />
      {hasColors && <Pages />}
      {isOnColors ? (
        <ColorPage />
      ) : (
        <main>
          <div class="column">
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
      )}
      <HelpDialog />
    </>
  );
}
