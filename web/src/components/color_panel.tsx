// SPDX-License-Identifier: BSD-3-Clause
import { revert, save, teach } from "../color_actions";
import type { Colors, ColorScores } from "../color_protocol";
import { useStore } from "../use_store";

/** Teaches and saves; how good what was taught is, and what to mark next. */
export function ColorPanel({ colors }: { colors: Colors }) {
  const isBusy = useStore((state) => state.colorView.isBusy);
  const hasChanged = colors.difference.length > 0;
  return (
    <section class="color-panel" aria-label="Teach">
      <h2>Teach</h2>
      <div class="replay-buttons">
        <button class="teach" onClick={teach}>
          Teach {colors.color}
        </button>
        <button disabled={!hasChanged} onClick={revert}>
          Revert
        </button>
        <button disabled={!hasChanged} onClick={save}>
          Save model
        </button>
      </div>
      <p class="answer" role="status" data-refused={colors.refused}>
        {isBusy ? "working…" : colors.answer || (hasChanged ? "taught, not saved" : "")}
      </p>
      <Scores colors={colors} />
      <ul class="warnings">
        {colors.warnings.map((warning) => (
          <li key={warning} data-verdict="doubtful">
            <span class="sign">!</span>
            {warning}
          </li>
        ))}
      </ul>
      <Model colors={colors} />
    </section>
  );
}

const percent = (share: number) => `${(100 * share).toFixed(share > 0 && share < 0.1 ? 2 : 1)} %`;

function Scores({ colors }: { colors: Colors }) {
  const scores = useStore((state) => state.colorScores);
  const isOfThis = scores?.color === colors.color && scores.revision === colors.revision;
  if (!scores || !isOfThis) return <p class="legend">counting…</p>;
  return (
    <dl class="scores" aria-label={`Scores of ${scores.color}`}>
      <dt>Found of what is marked {scores.color}</dt>
      <dd>{scores.wanted === 0 ? "nothing is marked" : `${percent(scores.recall)} of ${scores.wanted} px`}</dd>
      <dt>Taken for it of what is marked otherwise</dt>
      <dd>{scores.others === 0 ? "nothing is marked" : `${percent(scores.false_share)} of ${scores.others} px`}</dd>
      <dt>Shared with other colours</dt>
      <dd>{scores.overlaps.map(({ color, share }) => `${color} ${percent(share)}`).join(", ") || "nothing"}</dd>
      <LeftOuts scores={scores} />
    </dl>
  );
}

function LeftOuts({ scores }: { scores: ColorScores }) {
  if (scores.left_outs.length === 0) return null;
  return (
    <>
      <dt>Found of a frame, taught by the other frames only</dt>
      <dd>{scores.left_outs.map(({ frame, recall }) => `frame ${frame + 1}: ${percent(recall)}`).join(", ")}</dd>
    </>
  );
}

function Model({ colors }: { colors: Colors }) {
  return (
    <>
      <h3>Model</h3>
      <p>
        {colors.file}
        {colors.versions.length > 0 && `; kept: ${colors.versions.map((name) => name.split("/").at(-1)).join(", ")}`}
      </p>
      {colors.difference.length > 0 && (
        <pre class="difference" tabIndex={0} role="region" aria-label="Difference to the file">
          {colors.difference.join("\n")}
        </pre>
      )}
    </>
  );
}
