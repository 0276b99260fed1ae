// SPDX-License-Identifier: BSD-3-Clause
import { secondsBetween } from "../protocol";
import { eventsUntil } from "../timeline";
import { useStore } from "../use_store";

/** What has happened, of a recording until the frame that is shown; the newest first. */
export function EventsPanel() {
  const log = useStore((state) => state.log);
  const added = useStore((state) => state.events);
  const timeline = useStore((state) => state.timeline);
  const frame = useStore((state) => state.playback?.frame ?? 0);
  const events = timeline ? eventsUntil(timeline, frame, log, added) : added;
  const first = timeline?.begin ?? events[0]?.time;
  return (
    <section class="events" aria-label="Events">
      <h2>Events</h2>
      <ol tabIndex={0} aria-label="Events, the newest first">
        {events
          .map((event, i) => (
            <li key={i} data-level={event.level}>
              <time>{first === undefined ? "" : sinceText(secondsBetween(first, event.time))}</time>{" "}
              {event.level !== "info" && <b>{event.level}: </b>}
              {event.text}
            </li>
          ))
          .reverse()}
      </ol>
    </section>
  );
}

function sinceText(seconds: number): string {
  return `${seconds < 0 ? "−" : "+"}${Math.abs(seconds).toFixed(1)} s`;
}
