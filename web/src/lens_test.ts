// SPDX-License-Identifier: BSD-3-Clause
import { expect, test } from "vitest";
import { boardText, focalText, goalsOf, usualForms, type Lens } from "./lens";

test("a board is told as the command takes it", () => {
  expect(boardText(usualForms.chessboard)).toBe("chessboard:9x6:0.025");
  expect(boardText({ ...usualForms.chessboard, side_mm: 24.3 })).toBe("chessboard:9x6:0.0243");
  expect(boardText(usualForms.charuco)).toBe("charuco:7x5:0.04:0.03:DICT_4X4_50");
  expect(boardText(usualForms.aprilgrid)).toBe("aprilgrid:6x6:0.088:0.3");
  expect(boardText(usualForms.print)).toBe("");
});

test("the focal length has its uncertainty, in px and percent", () => {
  const estimate = { focal_px: 512.34, focal_sigma_px: 1.26, rms_px: 0.1, views: 20, model: "none", warnings: [] };
  expect(focalText(estimate)).toBe("512.3 ± 1.3 px (0.2 %)");
});

test("goals count the views of each tilt and distance", () => {
  const lens = { left: 2, right: 0, top: 1, bottom: 0, near: 3, far: 0 } as Lens;
  const reached = goalsOf(lens).filter(({ views, wanted }) => views >= wanted);
  expect(reached.map(({ name }) => name)).toEqual(["left side nearer", "near"]);
});
