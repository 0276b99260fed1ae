// SPDX-License-Identifier: BSD-3-Clause
// The results of a study: its recordings as two of its configurations saw them. What the server
// says is of src/kestrel/app/console/messages/study_json.h.

/** The result of a configuration for a recording; null where it is not known. */
export interface Outcome {
  done: boolean;
  /** Why it failed; empty: it did not. */
  failure: string;
  /** Share of what should be found, 0 to 1. */
  found: number | null;
  /** Number of false detections. */
  false: number | null;
  /** Median of the error of what was found. */
  error_m: number | null;
  /** The recording has no truth. */
  estimated: boolean;
}

export interface StudyRow {
  recording: string;
  /** From 1; 0: the whole recording. */
  piece: number;
  before: Outcome;
  after: Outcome;
  /** Found in addition by the second, less its additional false ones, as a share. */
  change: number | null;
}

export interface Study {
  kind: "study";
  /** Configurations, with the version where it is needed to tell them apart. */
  variants: string[];
  /** The two that are compared, of variants. */
  before: number;
  after: number;
  /** The worst first. */
  rows: StudyRow[];
  /** Rows of the study, of which these are the worst. */
  total: number;
  /** What the recordings show, in the words of `kestrel study report`; empty: nothing is compared. */
  judgement: string;
  remark: string;
  error: string;
}

/** The recording that is being opened, or replayed. */
export interface StudyReplay {
  kind: "study-replay";
  state: "none" | "running" | "open" | "cancelled" | "failed";
  recording: string;
  before: string;
  after: string;
  /** Frames of the first run, of so many; 0: it is not known of how many. */
  done: number;
  frames: number;
  error: string;
}

export type Side = "before" | "after";
export type Quantity = "found" | "false" | "error_m";
export type Column = "recording" | "change" | "failed" | `${Quantity} ${Side}`;

export interface Order {
  column: Column;
  isDescending: boolean;
}

/** A row with its number, by which the server opens it. */
export interface NumberedRow {
  number: number;
  row: StudyRow;
}

/** The order in which the server sends them: the worst first. */
export const worstFirst: Order = { column: "change", isDescending: false };

export function nameOf(row: StudyRow): string {
  return row.piece === 0 ? row.recording : `${row.recording}, piece ${row.piece}`;
}

/** Why one of the two, or both, have no result; empty: both have one. */
export function failureOf(row: StudyRow, study: Pick<Study, "variants" | "before" | "after">): string {
  const of = (side: Side) => {
    const why = row[side].failure !== "" ? row[side].failure : row[side].done ? "" : "not done yet";
    return why === "" ? "" : `${study.variants[study[side]]}: ${why}`;
  };
  return [of("before"), of("after")].filter((text) => text !== "").join("; ");
}

/** The rows in an order; what is not known comes last in both directions. */
export function sorted(study: Study, order: Order): NumberedRow[] {
  const rows = study.rows.map((row, number) => ({ number, row }));
  const direction = order.isDescending ? -1 : 1;
  const value = valueIn(study, order.column);
  return rows.sort((a, b) => {
    const first = value(a);
    const second = value(b);
    if (first === second) return a.number - b.number;
    if (first === null) return 1;
    if (second === null) return -1;
    if (typeof first === "string") return direction * first.localeCompare(String(second), "en", { numeric: true });
    return direction * (first - Number(second));
  });
}

function valueIn(study: Study, column: Column): (numbered: NumberedRow) => string | number | null {
  if (column === "recording") return ({ row }) => nameOf(row);
  if (column === "failed") return ({ row }) => failureOf(row, study) || null;
  // The server's order, which also knows what failed with the second only.
  if (column === "change") return ({ number }) => number;
  const [quantity, side] = column.split(" ") as [Quantity, Side];
  return ({ row }) => row[side][quantity];
}

/** The order after a press on the head of a column: first what is bad, then the other way round. */
export function orderAfter(order: Order, column: Column): Order {
  if (order.column === column) return { column, isDescending: !order.isDescending };
  return { column, isDescending: column.startsWith("false") || column.startsWith("error_m") };
}

export function outcomeText(outcome: Outcome, quantity: Quantity): string {
  const value = outcome[quantity];
  if (value === null) return "–";
  const about = outcome.estimated ? "≈ " : "";
  if (quantity === "found") return `${about}${(100 * value).toFixed(1)} %`;
  return about + (quantity === "false" ? value.toFixed(0) : `${value.toFixed(3)} m`);
}

/** In percentage points, as "−12.5". */
export function changeText(change: number | null): string {
  if (change === null) return "–";
  const points = (100 * Math.abs(change)).toFixed(1);
  if (Number(points) === 0) return "0.0";
  return `${change < 0 ? "−" : "+"}${points}`;
}

/** As "4 recordings, 1 without a result of both". */
export function summaryOf(rows: StudyRow[]): string {
  const without = rows.filter(({ change }) => change === null).length;
  return `${rows.length} recordings${without > 0 ? `, ${without} without a result of both` : ""}`;
}

export function progressInWords({ recording, before, done, frames }: StudyReplay): string {
  return `Opening ${recording} with ${before}: ${done}${frames > 0 ? ` of ${frames}` : ""} frames`;
}
