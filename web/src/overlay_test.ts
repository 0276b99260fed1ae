// SPDX-License-Identifier: BSD-3-Clause
import { expect, test } from "vitest";
import { ofRun, together } from "./overlay";
import type { Shape } from "./protocol";

const shape = (layer: Shape["layer"], run: 1 | 2, label = ""): Shape => ({ layer, run, label, outline: [1, 2] });

const shapes = [
  shape("prediction", 1),
  shape("detection", 1, "quadrants 0.93"),
  shape("prediction", 2),
  shape("truth", 2, "lost"),
  shape("rejected", 2, "lines 0.61"),
  shape("detection", 2),
];

test("over one picture the second run is a layer of its own, with what it found alone", () => {
  expect(together(shapes).map(({ layer, label }) => [layer, label])).toEqual([
    ["prediction", ""],
    ["detection", "quadrants 0.93"],
    ["second", "second: lines 0.61"],
    ["second", ""],
  ]);
});

test("beside each other each run has all its layers", () => {
  expect(ofRun(shapes, 1)).toEqual(shapes.slice(0, 2));
  expect(ofRun(shapes, 2)).toEqual(shapes.slice(2));
});
