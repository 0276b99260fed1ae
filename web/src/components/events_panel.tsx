// SPDX-License-Identifier: BSD-3-Clause
import { secondsBetween } from "../protocol";
import { useStore } from "../use_store";

/** What has happened, the newest first. */
export function EventsPanel() {
  const events = useStore((state) => state.events);
  const first = events[0]?.time;
  return (
    <section class="events" aria-label="Events">
      <h2>Events</h2>
      <ol tabIndex={0} aria-label="Events, the newest first">
        {events
          .map((event, i) => (
            <li key={i} data-level={event.level}>
              <time>{first === undefined ? "" : `+${secondsBetween(first, event.time).toFixed(1)} s`}</time>{" "}
              {event.level !== "info" && <b>{event.level}: </b>}
              {event.text}
            </li>
          ))
          .reverse()}
      </ol>
    </section>
  );
}
