// SPDX-License-Identifier: BSD-3-Clause
import { expect, test } from "vitest";
import { boxShape, markedBox } from "./marking";

test("a drag in any direction is the same box", () => {
  expect(markedBox([100, 50], [140, 90], 640, 480)).toEqual([100, 50, 40, 40]);
  expect(markedBox([140, 90], [100, 50], 640, 480)).toEqual([100, 50, 40, 40]);
});

test("a click is a square around it", () => {
  expect(markedBox([320, 240], [322, 241], 640, 480)).toEqual([294, 214, 53, 52]);
});

test("a box stays within the image", () => {
  expect(markedBox([-20, 470], [60, 500], 640, 480)).toEqual([0, 470, 60, 9]);
  const [x, y, width, height] = markedBox([639, 0], [639, 0], 640, 480);
  expect([x + width <= 640, y, height > 0]).toEqual([true, 0, true]);
});

test("the box is drawn around what is marked", () => {
  expect(boxShape([1, 2, 3, 4]).outline).toEqual([1, 2, 4, 2, 4, 6, 1, 6]);
});
