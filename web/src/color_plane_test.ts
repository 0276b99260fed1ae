// SPDX-License-Identifier: BSD-3-Clause
import { expect, test } from "vitest";
import { alongStrip, columnAt, outlines } from "./color_plane";

const red = { weight: 1, hue: 358, saturation: 0.7, sigma_hue: 5, sigma_saturation: 0.1, correlation: 0 };

test("the hue is a circle", () => {
  expect(alongStrip(2, 350)).toBe(12);
  expect(alongStrip(340, 350)).toBe(350);
  expect(columnAt(0, 180)).toBe(36);
  expect(columnAt(71, 180)).toBe(35);
});

test("an outline that crosses the strip's end is there twice", () => {
  expect(outlines(red, 3, 180).length).toBe(1);
  const halves = outlines(red, 3, 0);
  expect(halves.length).toBe(2);
  expect(Math.max(...(halves[0] ?? []).map(([hue]) => hue))).toBeCloseTo(373);
  expect(Math.max(...(halves[1] ?? []).map(([hue]) => hue))).toBeCloseTo(13);
});

test("with a correlation the outline leans, and reaches as far", () => {
  const outline = outlines({ ...red, correlation: 0.9 }, 1, 180)[0] ?? [];
  const [hue, saturation] = outline.reduce((most, one) => (one[0] > most[0] ? one : most));
  expect(hue).toBeCloseTo(183);
  expect(saturation).toBeCloseTo(0.79, 2);
  expect(Math.max(...outline.map(([, s]) => s))).toBeCloseTo(0.8, 2);
});
