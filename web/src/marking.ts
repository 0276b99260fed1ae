// SPDX-License-Identifier: BSD-3-Clause
// A person marks in the image what is to be followed: by a drag around it, or a click on it.
import { connection } from "./connection";
import type { FrameHeader, Shape } from "./protocol";

export type Point = [number, number];
/** Upper left pixel, width and height. */
export type Box = [number, number, number, number];

/** A click is a box of this share of the image's width around it. */
const clickedShare = 0.08;
/** A drag that is shorter is a click. */
const shortestShare = 0.012;

/** The box of a drag within an image of this size; of a click, a square around it. */
export function markedBox(from: Point, to: Point, width: number, height: number): Box {
  const isClick = Math.hypot(to[0] - from[0], to[1] - from[1]) < shortestShare * width;
  const half = isClick ? (clickedShare * width) / 2 : 0;
  const within = (value: number, size: number) => Math.min(Math.max(value, 0), size - 1);
  const left = within(Math.min(from[0], to[0]) - half, width);
  const top = within(Math.min(from[1], to[1]) - half, height);
  const right = within(Math.max(from[0], to[0]) + half, width);
  const bottom = within(Math.max(from[1], to[1]) + half, height);
  return [left, top, right - left, bottom - top].map(Math.round) as Box;
}

/** What is drawn while the box is marked. */
export function boxShape([x, y, width, height]: Box): Shape {
  const outline = [x, y, x + width, y, x + width, y + height, x, y + height];
  return { layer: "prediction", run: 1, label: "follow this", outline, closed: true };
}

/** Follows what the box has around it in the picture with this header, however old that is. */
export function follow(header: FrameHeader, box: Box): void {
  connection.commandWith("mark", [header.time, ...box.map(String)]);
}
