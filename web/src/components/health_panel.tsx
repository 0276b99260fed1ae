// SPDX-License-Identifier: BSD-3-Clause
import type { Check } from "../protocol";
import { useStore } from "../use_store";

const signs: Record<Check["verdict"], string> = {
  good: "✓",
  doubtful: "!",
  wrong: "✗",
  "not checked": "–",
};

/** The doctor's checks, and this browser's connection. */
export function HealthPanel() {
  const health = useStore((state) => state.health);
  const link = useStore((state) => state.link);
  const isLive = useStore((state) => state.hello?.live ?? false);
  return (
    <section class="health" aria-label="Health">
      <h2>Health</h2>
      <ul>
        {health?.checks.map((check) => (
          <li key={check.name} data-verdict={check.verdict}>
            <span class="sign" aria-hidden="true">
              {signs[check.verdict]}
            </span>
            <b>{check.name}</b> {check.measured}
            <span class="unseen"> ({check.verdict})</span>
          </li>
        ))}
        {link && (
          <li data-verdict={link.dropped > 0 ? "doubtful" : "good"}>
            <span class="sign" aria-hidden="true">
              {signs[link.dropped > 0 ? "doubtful" : "good"]}
            </span>
            <b>this page</b> {!isLive || link.draw_ms === null ? "" : `${link.draw_ms.toFixed(0)} ms to draw, `}
            {link.dropped} messages dropped, {link.clients} looking
          </li>
        )}
      </ul>
    </section>
  );
}
