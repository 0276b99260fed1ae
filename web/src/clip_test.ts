// SPDX-License-Identifier: BSD-3-Clause
import { expect, test } from "vitest";
import { clipPath, fileName, wholeOr, withFirst, withLast } from "./clip";

test("a clip is of the whole recording until a part is chosen", () => {
  expect(wholeOr(null, 60)).toEqual({ first: 0, last: 59 });
  expect(wholeOr({ first: 3, last: 9 }, 60)).toEqual({ first: 3, last: 9 });
});

test("a part has its end not before its beginning", () => {
  expect(withFirst({ first: 0, last: 59 }, 20)).toEqual({ first: 20, last: 59 });
  expect(withFirst({ first: 0, last: 10 }, 20)).toEqual({ first: 20, last: 20 });
  expect(withLast({ first: 20, last: 59 }, 30)).toEqual({ first: 20, last: 30 });
  expect(withLast({ first: 20, last: 59 }, 5)).toEqual({ first: 5, last: 5 });
});

test("a clip has two numbers for an address, and the server's name", () => {
  const path = clipPath("overlays", { first: 12, last: 80 });
  expect(path).toBe("/export/overlays-12-80.mp4");
  expect(fileName('attachment; filename="overlays-12-80.avi"', path)).toBe("overlays-12-80.avi");
  expect(fileName('attachment; filename="../x"', path)).toBe("overlays-12-80.mp4");
  expect(fileName(null, path)).toBe("overlays-12-80.mp4");
});
