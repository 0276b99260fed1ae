// SPDX-License-Identifier: BSD-3-Clause
import { describe, expect, test } from "vitest";
import { covarianceEllipse, fitView, pointsOf, scaleLength, teamLabel, toCanvas } from "./map_geometry";
import type { TeamObject } from "./protocol";

const ofTeam: TeamObject = {
  label: "red",
  color: "",
  position: [10, 20],
  covariance: [4, 0, 1],
  uavs: ["one", "two"],
  holder: "",
};

describe("map", () => {
  test("north is up, east is right, all points are in view", () => {
    const points: [number, number][] = [
      [0, 0],
      [30, 10],
      [-5, 40],
    ];
    const view = fitView(points, 300, 200);
    for (const point of points) {
      const [x, y] = toCanvas(view, point);
      expect(x).toBeGreaterThan(0);
      expect(x).toBeLessThan(300);
      expect(y).toBeGreaterThan(0);
      expect(y).toBeLessThan(200);
    }
    expect(toCanvas(view, [0, 1])[1]).toBeLessThan(toCanvas(view, [0, 0])[1]);
    expect(toCanvas(view, [1, 0])[0]).toBeGreaterThan(toCanvas(view, [0, 0])[0]);
  });

  test("one point, or none, is shown all the same", () => {
    expect(toCanvas(fitView([[7, 8]], 100, 100), [7, 8])).toEqual([50, 50]);
    expect(fitView([], 100, 100).pixelsPerMeter).toBeGreaterThan(0);
  });

  test("what the team knows is in view, before the own map is there as well", () => {
    expect(pointsOf(null, [ofTeam], [[1, 2]], 2)).toEqual([
      [1, 2],
      [6, 18],
      [14, 22],
    ]);
    expect(pointsOf(null, [], [], 2)).toEqual([]);
  });

  test("an object of the team says who has it and who goes for it", () => {
    expect(teamLabel(ofTeam)).toBe("red: one two");
    expect(teamLabel({ ...ofTeam, holder: "two" })).toBe("red: one two, for two");
  });

  test("the ellipse is that of the covariance", () => {
    const turned = covarianceEllipse([2.5, 1.5, 2.5], 2);
    expect(turned.major).toBeCloseTo(4);
    expect(turned.minor).toBeCloseTo(2);
    expect(turned.angle).toBeCloseTo(Math.PI / 4);
    expect(covarianceEllipse([0, 0, 0], 2)).toEqual({ major: 0, minor: 0, angle: 0 });
  });

  test("the scale is round", () => {
    expect(scaleLength(10, 75)).toBe(5);
    expect(scaleLength(3, 75)).toBe(20);
    expect(scaleLength(500, 75)).toBeCloseTo(0.1);
  });
});
