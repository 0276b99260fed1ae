// SPDX-License-Identifier: BSD-3-Clause
import { useState } from "preact/hooks";
import { cancelDetection } from "../actions";
import {
  changeText,
  failureOf,
  nameOf,
  orderAfter,
  outcomeText,
  progressInWords,
  sorted,
  summaryOf,
  worstFirst,
  type Column,
  type NumberedRow,
  type Order,
  type Quantity,
  type Side,
  type Study,
  type StudyReplay,
} from "../study";
import { compareVariants, openRow } from "../study_actions";
import { useStore } from "../use_store";
import "./study_page.css";

const quantities: { quantity: Quantity; title: string }[] = [
  { quantity: "found", title: "Found" },
  { quantity: "false", title: "False" },
  { quantity: "error_m", title: "Median error" },
];
const sides: Side[] = ["before", "after"];
const sideInWords: Record<Side, string> = { before: "First", after: "Second" };

/** The recordings of a study, the worst first; each can be opened. */
export function StudyPage() {
  const study = useStore((state) => state.study);
  const replay = useStore((state) => state.studyReplay);
  if (!study) return null;
  return (
    <main class="study">
      <section aria-label="Comparison">
        <VariantChoice study={study} />
        {study.remark !== "" && <p class="hint">{study.remark}</p>}
        {replay && <Opening replay={replay} />}
        {study.error !== "" ? <p role="alert">{study.error}</p> : <Table study={study} />}
      </section>
    </main>
  );
}

function VariantChoice({ study }: { study: Study }) {
  const choose = (side: Side, chosen: number) => {
    const pair = { before: study.before, after: study.after, [side]: chosen };
    compareVariants(pair.before, pair.after);
  };
  return (
    <div class="replay-buttons">
      {sides.map((side) => (
        <label key={side}>
          {sideInWords[side]}{" "}
          <select value={study[side]} onChange={(event) => choose(side, Number(event.currentTarget.value))}>
            {study.variants.map((name, number) => (
              <option key={name} value={number}>
                {name}
              </option>
            ))}
          </select>
        </label>
      ))}
      <button onClick={() => compareVariants(study.after, study.before)}>Swap</button>
      <button onClick={() => compareVariants(study.before, study.after)}>Read again</button>
    </div>
  );
}

function Opening({ replay }: { replay: StudyReplay }) {
  switch (replay.state) {
    case "none":
    case "open":
      return null;
    case "running":
      return (
        <div class="replay-buttons">
          <p role="status">{progressInWords(replay)}</p>
          <progress aria-label="Frames looked at" max={replay.frames || 1} value={replay.done} />
          <button onClick={cancelDetection}>Cancel</button>
        </div>
      );
    case "cancelled":
      return <p role="status">Cancelled: {replay.recording}</p>;
    case "failed":
      return (
        <p role="alert">
          {replay.recording} cannot be replayed: {replay.error}
        </p>
      );
  }
}

function Table({ study }: { study: Study }) {
  const [order, setOrder] = useState<Order>(worstFirst);
  const head = { order, onSort: (column: Column) => setOrder(orderAfter(order, column)) };
  const hidden = study.total - study.rows.length;
  const isEstimated = study.rows.some(({ before, after }) => before.estimated || after.estimated);
  return (
    <>
      {study.judgement !== "" && <p class="judgement">{study.judgement}.</p>}
      <p>
        {summaryOf(study.rows)}.
        {hidden > 0 && ` ${hidden} more are not shown: none of them got worse than these.`}
      </p>
      <p class="hint">
        Change: the share found by the second minus that found by the first, in percentage points; one more false detection counts as
        one found less. Press a recording to replay it at the frame that got worst.
        {isEstimated && " ≈: estimated, as the recording has no truth."}
      </p>
      <div class="study-table">
        <table class="numbers-table">
          <caption class="unseen">Recordings, and what two configurations found in them</caption>
          <thead>
            <tr>
              <Head {...head} column="recording" title="Recording" rows={2} />
              <Head {...head} column="change" title="Change" rows={2} />
              {quantities.map(({ quantity, title }) => (
                <th key={quantity} scope="colgroup" colSpan={2}>
                  {title}
                </th>
              ))}
              <Head {...head} column="failed" title="No result" rows={2} />
            </tr>
            <tr>
              {quantities.map(({ quantity, title }) =>
                sides.map((side) => (
                  <Head
                    {...head}
                    key={`${quantity} ${side}`}
                    column={`${quantity} ${side}`}
                    title={sideInWords[side]}
                    of={`${title}, `}
                    rows={1}
                  />
                )),
              )}
            </tr>
          </thead>
          <tbody>
            {sorted(study, order).map((numbered) => (
              <Row key={numbered.number} study={study} numbered={numbered} />
            ))}
          </tbody>
        </table>
      </div>
    </>
  );
}

interface HeadProps {
  column: Column;
  title: string;
  /** Words before the title for who does not see the head above it. */
  of?: string;
  rows: number;
  order: Order;
  onSort: (column: Column) => void;
}

function Head({ column, title, of = "", rows, order, onSort }: HeadProps) {
  const isSorted = order.column === column;
  const direction = order.isDescending ? "descending" : "ascending";
  return (
    <th scope="col" rowSpan={rows} aria-sort={isSorted ? direction : undefined}>
      <button onClick={() => onSort(column)} title="Sort by this column">
        {of !== "" && <span class="unseen">{of}</span>}
        {title}
        <span aria-hidden="true">{isSorted ? (order.isDescending ? " ▼" : " ▲") : ""}</span>
      </button>
    </th>
  );
}

// The button is what the keyboard reaches; its press is one on the row as well.
function Row({ study, numbered: { row, number } }: { study: Study; numbered: NumberedRow }) {
  const change = changeText(row.change);
  return (
    <tr onClick={() => openRow(number)}>
      <th scope="row">
        <button>{nameOf(row)}</button>
      </th>
      <td data-change={change.startsWith("−") ? "worse" : change.startsWith("+") ? "better" : "none"}>{change}</td>
      {quantities.map(({ quantity }) => sides.map((side) => <td key={`${quantity} ${side}`}>{outcomeText(row[side], quantity)}</td>))}
      <td class="failure">{failureOf(row, study)}</td>
    </tr>
  );
}

/** Above a replay of the study: of what it is, and how far the second run is. */
export function StudyCaption() {
  const replay = useStore((state) => state.studyReplay);
  const second = useStore((state) => state.second);
  const frames = useStore((state) => state.timeline?.times_ms.length);
  if (replay?.state !== "open") return null;
  return (
    <section aria-label="Recording of the study">
      <h2>{replay.recording}</h2>
      <p>
        First run: {replay.before}. Second run: {replay.after}.{" "}
        {second?.state === "running" && (
          <span role="status">
            {second.done} of {frames} frames are done; then both are beside each other.
          </span>
        )}
      </p>
    </section>
  );
}
