// SPDX-License-Identifier: BSD-3-Clause
import { expect, test } from "vitest";
import { timeToGo } from "./time_to_go";

const times = Array.from({ length: 40 }, (_, i) => 0.1 * i);

test("is the height by the rate of descent of the last two seconds", () => {
  const heights = times.map((t) => (t < 1 ? 20 : 10 - 0.5 * t));
  expect(timeToGo(times, heights)).toBeCloseTo((10 - 0.5 * 3.9) / 0.5, 5);
  expect(timeToGo(times, heights, 25)).toBeGreaterThan(0);
});

test("is not known of a UAV that climbs, hovers or is not seen", () => {
  expect(timeToGo(times, times.map((t) => 5 + t))).toBeNull();
  expect(timeToGo(times, times.map(() => 5))).toBeNull();
  expect(timeToGo(times, times.map((t) => (t > 3.8 ? null : 9 - t)))).toBeNull();
  expect(timeToGo([], [])).toBeNull();
  expect(timeToGo([0, 0.1], [5, 4])).toBeNull();
});
