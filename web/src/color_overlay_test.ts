// SPDX-License-Identifier: BSD-3-Clause
import { expect, test } from "vitest";
import { type OverlayWish, paintOverlay, shownAs } from "./color_overlay";

const wish = { showsLabels: true, showsMarks: true, chosen: 2, colors: [shownAs("red", 0), shownAs("mauve", 1)] };

/** One row of pixels, each with a label and a mark. */
function row(...pixels: [number, number][]): Uint8Array {
  return new Uint8Array([...pixels.map(([label]) => label), ...pixels.map(([, mark]) => mark)]);
}

function overlayOf(labels: Uint8Array, wish: OverlayWish): Uint8ClampedArray {
  const image = { width: labels.length / 2, height: 1, data: new Uint8ClampedArray(2 * labels.length) };
  paintOverlay(labels, image, wish);
  return image.data;
}

test("background is darker, the chosen colour stronger than others", () => {
  const pixels = overlayOf(row([0, 0], [1, 0], [2, 0], [255, 0]), wish);
  expect([...pixels.slice(0, 4)]).toEqual([0, 0, 0, 120]);
  expect([...pixels.slice(4, 7)]).toEqual([...shownAs("red", 0)]);
  expect([...pixels.slice(8, 11)]).toEqual([...shownAs("mauve", 1)]);
  expect(pixels[11]).toBeGreaterThan(60);
  expect([...pixels.slice(12)]).toEqual([0, 0, 0, 120]);
});

test("marks have edges: white, or black where they are none of the colours", () => {
  const labels = row([0, 2], [0, 2], [0, 255], [0, 0]);
  const pixels = overlayOf(labels, { ...wish, showsLabels: false });
  expect([...pixels.slice(0, 4)]).toEqual([255, 255, 255, 255]);
  expect([...pixels.slice(8, 12)]).toEqual([0, 0, 0, 255]);
  expect(pixels[15]).toBe(0);
  const hidden = overlayOf(labels, { ...wish, showsLabels: false, showsMarks: false });
  expect(Math.max(...hidden)).toBe(0);
});
