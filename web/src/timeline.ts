// SPDX-License-Identifier: BSD-3-Clause
import { secondsBetween, type EventMessage, type Timeline } from "./protocol";

export type Mark = "-" | "f" | "l" | "x";

const rank: Record<Mark, number> = { "-": 0, f: 1, l: 2, x: 3 };
const words: Record<Mark, string> = {
  "-": "nothing to find",
  f: "found",
  l: "lost",
  x: "false",
};

export function markAt(timeline: Pick<Timeline, "marks">, frame: number): Mark {
  const mark = timeline.marks[frame];
  return mark === "f" || mark === "l" || mark === "x" ? mark : "-";
}

export function markInWords(mark: Mark): string {
  return words[mark];
}

function duration(timeline: Timeline): number {
  return Math.max(timeline.times_ms.at(-1) ?? 0, 1);
}

/** For each column of a timeline so wide, the worst mark of its frames; null where there is none. */
export function columnMarks(timeline: Timeline, width: number): (Mark | null)[] {
  const columns: (Mark | null)[] = Array.from({ length: width }, () => null);
  timeline.times_ms.forEach((time, frame) => {
    const column = Math.min(width - 1, Math.floor((time / duration(timeline)) * width));
    const mark = markAt(timeline, frame);
    const before = columns[column];
    if (before === null || before === undefined || rank[mark] > rank[before]) columns[column] = mark;
  });
  return columns;
}

/** The last frame not after a time. */
export function frameAt(timeline: Timeline, timeMs: number): number {
  let low = 0;
  let high = timeline.times_ms.length - 1;
  while (low < high) {
    const middle = Math.ceil((low + high) / 2);
    if (timeline.times_ms[middle]! <= timeMs) low = middle;
    else high = middle - 1;
  }
  return low;
}

export function frameAtFraction(timeline: Timeline, fraction: number): number {
  return frameAt(timeline, Math.min(Math.max(fraction, 0), 1) * duration(timeline));
}

export function fractionOf(timeline: Timeline, frame: number): number {
  return (timeline.times_ms[frame] ?? 0) / duration(timeline);
}

/** What was said until a frame, and what is said of the replay itself; in order of time. */
export function eventsUntil(timeline: Timeline, frame: number, log: EventMessage[], events: EventMessage[]): EventMessage[] {
  const now = timeline.times_ms[frame] ?? 0;
  const said = log.filter(({ time }) => 1000 * secondsBetween(timeline.begin, time) <= now);
  return [...said, ...events].sort((a, b) => secondsBetween(b.time, a.time));
}

/** The first frame of the next stretch of trouble (lost or false), in a direction; null: none. */
export function nextTrouble(timeline: Timeline, frame: number, direction: 1 | -1): number | null {
  const isTrouble = (i: number) => rank[markAt(timeline, i)] >= rank.l;
  const count = timeline.times_ms.length;
  for (let i = frame + direction; i >= 0 && i < count; i += direction) {
    if (isTrouble(i) && !isTrouble(i - 1)) return i;
  }
  return null;
}

/** The next frame, in a direction, whose marks differ; null: none. */
export function nextDifference(first: string, second: string, frame: number, direction: 1 | -1): number | null {
  const count = Math.min(first.length, second.length);
  for (let i = frame + direction; i >= 0 && i < count; i += direction) {
    if (first[i] !== second[i]) return i;
  }
  return null;
}

/** As "12 found, 3 lost, 0 false". */
export function marksInWords(marks: string): string {
  const count = (mark: Mark) => [...marks].filter((one) => one === mark).length;
  return `${count("f")} found, ${count("l")} lost, ${count("x")} false`;
}

/** As "1:02.50". */
export function clockText(timeMs: number): string {
  const minutes = Math.floor(timeMs / 60000);
  return `${minutes}:${((timeMs % 60000) / 1000).toFixed(2).padStart(5, "0")}`;
}
