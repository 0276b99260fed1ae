// SPDX-License-Identifier: BSD-3-Clause
import { expect, test, vi } from "vitest";
import { drawOverlay, ofRun, together } from "./overlay";
import type { Shape } from "./protocol";

const shape = (layer: Shape["layer"], run: 1 | 2, label = ""): Shape => ({ layer, run, label, outline: [1, 2], closed: true });

const shapes = [
  shape("prediction", 1),
  shape("detection", 1, "ring 0.93"),
  shape("prediction", 2),
  shape("truth", 2, "lost"),
  shape("rejected", 2, "lines 0.61"),
  shape("detection", 2),
];

test("over one picture the second run is a layer of its own, with what it found alone", () => {
  expect(together(shapes).map(({ layer, label }) => [layer, label])).toEqual([
    ["prediction", ""],
    ["detection", "ring 0.93"],
    ["second", "second: lines 0.61"],
    ["second", ""],
  ]);
});

test("beside each other each run has all its layers", () => {
  expect(ofRun(shapes, 1)).toEqual(shapes.slice(0, 2));
  expect(ofRun(shapes, 2)).toEqual(shapes.slice(2));
});

/** The lines of all paths that are stroked, as "1,2 3,4 closed". */
function drawnPaths(outlines: Partial<Shape>[]): string[] {
  const drawn: string[] = [];
  class RecordedPath {
    steps: string[] = [];
    moveTo = (x: number, y: number) => this.steps.push(`${x},${y}`);
    lineTo = (x: number, y: number) => this.steps.push(`${x},${y}`);
    closePath = () => this.steps.push("closed");
  }
  vi.stubGlobal("Path2D", RecordedPath);
  const context = { setLineDash: () => {}, stroke: (path: RecordedPath) => drawn.push(path.steps.join(" ")) };
  const isOn = { detection: true, prediction: true, rejected: true, truth: true, second: false };
  const all = outlines.map((one) => ({ ...shape("detection", 1), ...one }));
  drawOverlay(context as unknown as CanvasRenderingContext2D, all, isOn, 1, 1);
  vi.unstubAllGlobals();
  return [...new Set(drawn)];
}

test("a closed outline is joined to its first point, a line that leaves the image is not", () => {
  const outline = [0, 0, 4, 0, 4, 4];
  expect(drawnPaths([{ outline, closed: true }])).toEqual(["0.5,0.5 4.5,0.5 4.5,4.5 closed"]);
  expect(drawnPaths([{ outline, closed: false }])).toEqual(["0.5,0.5 4.5,0.5 4.5,4.5"]);
});

test("a layer that is off is not drawn", () => {
  expect(drawnPaths([{ layer: "second", outline: [0, 0, 4, 0, 4, 4] }])).toEqual([]);
});
