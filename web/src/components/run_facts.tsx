// SPDX-License-Identifier: BSD-3-Clause
import { useStore } from "../use_store";

/** What a run says of the frame; of two, what the second says otherwise stands out. */
export function RunFacts({ run }: { run: 1 | 2 }) {
  const runs = useStore((state) => state.findings?.runs);
  const facts = runs?.[run - 1];
  if (!facts) return null;
  const isOther = (i: number) => run === 2 && runs[0]?.[i]?.value !== facts[i]?.value;
  return (
    <dl class="run-facts" aria-label={run === 1 ? "First run" : "Second run"}>
      {facts.map(({ name, value }, i) => (
        <div key={name} data-other={isOther(i)}>
          <dt>{name}</dt>
          <dd>{value === "" ? "–" : value}</dd>
        </div>
      ))}
    </dl>
  );
}
