// SPDX-License-Identifier: BSD-3-Clause
import { describe, expect, test } from "vitest";
import {
  barsOf,
  decadesAround,
  progressInWords,
  sigmaText,
  subjectInWords,
  valueText,
  wordsOf,
  type Calibration,
} from "./calibration";
import { initialState, withMessage } from "./store";

describe("calibration", () => {
  test("is asked for in the words of the server", () => {
    expect(wordsOf("mount and clock", true)).toEqual(["mount", "clock", "moving"]);
    expect(wordsOf("clock", false)).toEqual(["clock"]);
    expect(wordsOf("lens", true)).toEqual(["lens"]);
    expect(subjectInWords(["mount", "clock", "moving"])).toBe("mount and clock, the pattern moves");
  });

  test("a number has the digits that its uncertainty leaves", () => {
    expect(valueText(1.23456, 0.02)).toBe("1.235");
    expect(valueText(402.1234, 0.3)).toBe("402.12");
    expect(valueText(402.1234, 300)).toBe("402");
    expect(valueText(0.5, 0)).toBe("0.5000");
    expect(valueText(null, 0.1)).toBe("–");
    expect(sigmaText(0)).toBe("held");
    expect(sigmaText(null)).toBe("not told");
    expect(sigmaText(0.021)).toBe("± 0.021");
  });

  test("bars count every value once", () => {
    const bars = barsOf([1, 1.4, 2, 5], 4);
    expect(bars.map(({ count }) => count)).toEqual([2, 1, 0, 1]);
    expect(bars[3]).toEqual({ from: 4, to: 5, count: 1 });
    expect(barsOf([], 4)).toEqual([]);
    expect(barsOf([3, 3], 2).map(({ count }) => count)).toEqual([2, 0]);
  });

  test("decades hold all values, four at most", () => {
    expect(decadesAround([0.02, 3])).toEqual([-2, 1]);
    expect(decadesAround([1])).toEqual([0, 1]);
    expect(decadesAround([1e-9, 10])).toEqual([-3, 1]);
    expect(decadesAround([0])).toEqual([-1, 0]);
  });

  test("says how far it is, and goes when another server comes", () => {
    const running = { kind: "calibration", state: "running", done: 3, of: 9, ending: false } as Calibration;
    expect(progressInWords(running)).toBe("Looking at image 3 of 9");
    expect(progressInWords({ ...running, done: 9 })).toMatch(/^Estimating/);
    expect(progressInWords({ ...running, ending: true })).toMatch(/^Ending/);
    const state = withMessage(initialState(), running);
    expect(state.calibration?.done).toBe(3);
    const hello = { kind: "hello", title: "", live: false, series: [], layers: [], views: [], offers: [], exports: true, colors: false } as const;
    expect(withMessage(state, { ...hello, series: [], layers: [], views: [], offers: [] }).calibration).toBeNull();
  });
});
