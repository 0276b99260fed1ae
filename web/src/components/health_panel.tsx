// SPDX-License-Identifier: BSD-3-Clause
import { countText, sortedChecks } from "../checks";
import type { Check, SourceName } from "../protocol";
import { useFresh, useStore } from "../use_store";

const signs: Record<Check["verdict"], string> = {
  good: "✓",
  doubtful: "!",
  wrong: "✗",
  "not checked": "–",
};

/** The sources that a check judges; the other checks judge the program itself. */
const sourcesOf: Record<string, SourceName[]> = { camera: ["frames"], vision: ["frames"], autopilot: ["autopilot"] };

/** How the flight's parts do now, the doctor's checks, and this browser's connection. */
export function HealthPanel() {
  const health = useStore((state) => state.health);
  const doctor = useStore((state) => state.doctor);
  const link = useStore((state) => state.link);
  const isLive = useStore((state) => state.hello?.live ?? false);
  const isHeard = useFresh([]);
  return (
    <section class="health" aria-label="Health">
      <h2>Health</h2>
      <ul>
        {health?.checks.map((check) => <CheckItem key={check.name} check={check} sources={sourcesOf[check.name] ?? []} />)}
        {link && isHeard && (
          <li data-verdict={link.dropped > 0 ? "doubtful" : "good"}>
            <span class="sign" aria-hidden="true">
              {signs[link.dropped > 0 ? "doubtful" : "good"]}
            </span>
            <b>this page</b> {!isLive || link.draw_ms === null ? "" : `${link.draw_ms.toFixed(0)} ms to draw, `}
            {link.dropped} messages dropped, {link.clients} looking
          </li>
        )}
      </ul>
      {doctor && <DoctorChecks checks={doctor.checks} />}
    </section>
  );
}

/** Shows the doubtful checks first; the rest can be opened. */
function DoctorChecks({ checks }: { checks: Check[] }) {
  const { inDoubt, others } = sortedChecks(checks);
  return (
    <>
      <h3>Doctor</h3>
      <ul>
        {inDoubt.map((check) => (
          <CheckItem key={check.name} check={check} />
        ))}
      </ul>
      <details>
        <summary>{countText(others)}</summary>
        <ul>
          {others.map((check) => (
            <CheckItem key={check.name} check={check} />
          ))}
        </ul>
      </details>
    </>
  );
}

/** A check of what is not known any more is none. */
function CheckItem({ check, sources = [] }: { check: Check; sources?: SourceName[] }) {
  const isKnown = useFresh(sources);
  const verdict = isKnown ? check.verdict : "not checked";
  return (
    <li data-verdict={verdict} data-stale={!isKnown}>
      <span class="sign" aria-hidden="true">
        {signs[verdict]}
      </span>
      <b>{check.name}</b> {isKnown ? check.measured : "–"}
      <span class="unseen"> ({verdict})</span>
      {isKnown && check.advice !== "" && <p class="advice">{check.advice}</p>}
    </li>
  );
}
