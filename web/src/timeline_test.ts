// SPDX-License-Identifier: BSD-3-Clause
import { marksInWords, nextDifference } from "./timeline";
import { describe, expect, test } from "vitest";
import type { Timeline } from "./protocol";
import { clockText, columnMarks, eventsUntil, frameAt, frameAtFraction, nextTrouble } from "./timeline";

function timelineOf(marks: string): Timeline {
  return {
    kind: "timeline",
    begin: "0",
    times_ms: [...marks].map((_, i) => 100 * i),
    marks,
  };
}

describe("timeline", () => {
  test("a column shows the worst of its frames", () => {
    expect(columnMarks(timelineOf("ffffxff-l"), 2)).toEqual(["f", "x"]);
    expect(columnMarks(timelineOf("-f"), 4)).toEqual(["-", null, null, "f"]);
  });

  test("finds the frame of a time, whatever the time", () => {
    const timeline = timelineOf("fffff");
    expect(frameAt(timeline, -5)).toBe(0);
    expect(frameAt(timeline, 199)).toBe(1);
    expect(frameAt(timeline, 200)).toBe(2);
    expect(frameAt(timeline, 1e9)).toBe(4);
    expect(frameAtFraction(timeline, 0.5)).toBe(2);
    expect(frameAtFraction(timeline, 7)).toBe(4);
    expect(frameAt(timelineOf(""), 3)).toBe(0);
  });

  test("lists what was said until a frame", () => {
    const event = (ms: number, text: string) => ({ kind: "event" as const, time: `${ms}000000`, level: "info" as const, text });
    const log = [event(-50, "heard"), event(100, "mode LAND"), event(250, "touchdown")];
    const words = (frame: number) => eventsUntil(timelineOf("ffff"), frame, log, [event(0, "cannot be read")]).map(({ text }) => text);
    expect(words(0)).toEqual(["heard", "cannot be read"]);
    expect(words(1)).toEqual(["heard", "cannot be read", "mode LAND"]);
    expect(words(3)).toEqual(["heard", "cannot be read", "mode LAND", "touchdown"]);
  });

  test("goes from trouble to trouble", () => {
    const timeline = timelineOf("ffllfxxf");
    expect(nextTrouble(timeline, 0, 1)).toBe(2);
    expect(nextTrouble(timeline, 2, 1)).toBe(5);
    expect(nextTrouble(timeline, 5, 1)).toBeNull();
    expect(nextTrouble(timeline, 7, -1)).toBe(5);
    expect(nextTrouble(timeline, 5, -1)).toBe(2);
  });

  test("tells the time", () => {
    expect(clockText(62500)).toBe("1:02.50");
    expect(clockText(0)).toBe("0:00.00");
  });
});

test("two runs are compared", () => {
  expect(nextDifference("ffl-", "flf-", 0, 1)).toBe(1);
  expect(nextDifference("ffl-", "flf-", 1, 1)).toBe(2);
  expect(nextDifference("ffl-", "flf-", 2, 1)).toBeNull();
  expect(nextDifference("ffl-", "flf-", 2, -1)).toBe(1);
  expect(marksInWords("ffl-x")).toBe("2 found, 1 lost, 1 false");
});
