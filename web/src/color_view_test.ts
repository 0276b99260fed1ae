// SPDX-License-Identifier: BSD-3-Clause
import { expect, test } from "vitest";
import type { Colors } from "./color_protocol";
import { canKeep, firstColorView, frameInside, nextColorStep, nextMarked, resized, strokeOf, viewAfter } from "./color_view";

const view = { ...firstColorView, frame: 3 };

test("a brush's way is in whole pixels of the frame, without standing still", () => {
  const stroke = strokeOf(view, "red", [[1.4, 2.6], [1.45, 2.6], [-7, 99]], 40, 30);
  expect(stroke).toEqual({ frame: 3, color: "red", tool: "brush", size: 4, points: [1, 3, 0, 29] });
  expect(strokeOf(view, "red", [], 40, 30)).toBeNull();
});

test("a long way keeps its ends, and as many points as the server takes", () => {
  const way = Array.from({ length: 5000 }, (_, i): [number, number] => [i, i % 7]);
  const points = strokeOf(view, "red", way, 6000, 30)?.points ?? [];
  expect(points.length).toBe(2000);
  expect(points.slice(0, 2)).toEqual([0, 0]);
  expect(points.at(-2)).toBe(4999);
});

test("a rectangle has two corners, what grows one point, and none has no colour", () => {
  const way: [number, number][] = [[1, 1], [5, 9], [8, 3]];
  expect(strokeOf({ ...view, tool: "rectangle", isNone: true }, "red", way, 40, 30)).toEqual({
    frame: 3, color: "", tool: "rectangle", size: 0, points: [1, 1, 8, 3],
  });
  expect(strokeOf({ ...view, tool: "grow" }, "red", way, 40, 30)?.points).toEqual([8, 3]);
});

test("the next step goes from a frame to the saved model", () => {
  const colors = (frames: number, strokes: number, difference: string[]) =>
    nextColorStep({ frames, strokes, difference } as unknown as Colors);
  expect(colors(0, 0, [])).toContain("Keep a frame");
  expect(colors(9, 0, [])).toContain("choose a colour");
  expect(colors(9, 2, [])).toContain("teach");
  expect(colors(9, 2, ["red: 1 component more"])).toContain("save");
});

test("sizes stay within what the server takes", () => {
  let small = view;
  for (let i = 0; i < 40; i++) small = resized(small, -1);
  expect(small.radius).toBe(1);
  let large = view;
  for (let i = 0; i < 40; i++) large = resized(large, 1);
  expect(large.radius).toBe(200);
});

test("the next frame with marks, and none at the end", () => {
  const colors = { marked: [2, 5, 9] } as unknown as Colors;
  expect(nextMarked(colors, 5, 1)).toBe(9);
  expect(nextMarked(colors, 5, -1)).toBe(2);
  expect(nextMarked(colors, 9, 1)).toBeNull();
});

test("who keeps a frame is shown it, unless it is refused; others stay where they are", () => {
  const colors = { frames: 5, most_kept: 32, refused: false } as unknown as Colors;
  const keeping = { ...view, frame: 1, isBusy: true, isKeeping: true };
  expect(viewAfter(keeping, colors)).toMatchObject({ frame: 4, isBusy: false, isKeeping: false });
  expect(viewAfter(keeping, { ...colors, refused: true }).frame).toBe(1);
  expect(viewAfter({ ...keeping, isKeeping: false }, colors).frame).toBe(1);
});

test("frames are kept of a flight only, which begins without any", () => {
  const colors = { frames: 0, most_kept: 32 } as unknown as Colors;
  expect(canKeep(colors)).toBe(true);
  expect(canKeep({ ...colors, most_kept: 0 })).toBe(false);
  expect(canKeep(null)).toBe(false);
  expect(frameInside(3, colors)).toBe(0);
});
