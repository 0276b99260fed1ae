// SPDX-License-Identifier: BSD-3-Clause
import type { MapMessage, MapObject, TeamObject } from "./protocol";

/** World (m, north up) to canvas (px). */
export interface MapView {
  centerX: number;
  centerY: number;
  pixelsPerMeter: number;
  width: number;
  height: number;
}

export function toCanvas(view: MapView, point: readonly [number, number]): [number, number] {
  return [
    view.width / 2 + (point[0] - view.centerX) * view.pixelsPerMeter,
    view.height / 2 - (point[1] - view.centerY) * view.pixelsPerMeter,
  ];
}

/** The view that shows all points with a margin, of at least 4 m. */
export function fitView(points: [number, number][], width: number, height: number): MapView {
  if (points.length === 0) {
    return { centerX: 0, centerY: 0, pixelsPerMeter: width / 10, width, height };
  }
  const xs = points.map((point) => point[0]);
  const ys = points.map((point) => point[1]);
  const [minX, maxX, minY, maxY] = [
    Math.min(...xs),
    Math.max(...xs),
    Math.min(...ys),
    Math.max(...ys),
  ];
  const spanX = Math.max(maxX - minX, 4) * 1.25;
  const spanY = Math.max(maxY - minY, 4) * 1.25;
  return {
    centerX: (minX + maxX) / 2,
    centerY: (minY + maxY) / 2,
    pixelsPerMeter: Math.min(width / spanX, height / spanY),
    width,
    height,
  };
}

/** What the view has to show: positions, and the boxes around the ellipses of k sigma. */
export function pointsOf(
  map: MapMessage | null,
  team: TeamObject[],
  track: [number, number][],
  sigmas: number,
): [number, number][] {
  const target = map?.target ? [map.target] : [];
  const ofMap = map ? [...map.objects, ...map.mapped, ...map.prediction, ...target] : [];
  const corners = [...ofMap, ...team].flatMap((object) => cornersOf(object, sigmas));
  return [...track, ...(map?.uav ? [map.uav] : []), ...corners];
}

function cornersOf(
  { position: [x, y], covariance: [xx, , yy] }: MapObject,
  sigmas: number,
): [number, number][] {
  const [dx, dy] = [sigmas * Math.sqrt(xx), sigmas * Math.sqrt(yy)];
  return [
    [x - dx, y - dy],
    [x + dx, y + dy],
  ];
}

/** What the map says beside an object of the team: "red: one two, for two". */
export function teamLabel({ label, uavs, holder }: TeamObject): string {
  return `${label}: ${uavs.join(" ")}${holder ? `, for ${holder}` : ""}`;
}

/** Half axes (m) and direction of the longer one (rad from east) of the ellipse of k sigma. */
export function covarianceEllipse(
  [xx, xy, yy]: readonly [number, number, number],
  sigmas: number,
): { major: number; minor: number; angle: number } {
  const mean = (xx + yy) / 2;
  const difference = Math.hypot((xx - yy) / 2, xy);
  return {
    major: sigmas * Math.sqrt(Math.max(mean + difference, 0)),
    minor: sigmas * Math.sqrt(Math.max(mean - difference, 0)),
    angle: 0.5 * Math.atan2(2 * xy, xx - yy),
  };
}

/** A round number of m (1, 2 or 5 times a power of ten) that is at most so many pixels long. */
export function scaleLength(pixelsPerMeter: number, maxPixels: number): number {
  const longest = maxPixels / pixelsPerMeter;
  const power = 10 ** Math.floor(Math.log10(longest));
  return ([5, 2, 1].find((factor) => factor * power <= longest) ?? 1) * power;
}
