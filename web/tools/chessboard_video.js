// SPDX-License-Identifier: BSD-3-Clause
// Renders a chessboard that a person shows to a camera: raw 8-bit gray frames, one after the other,
// for GStreamer's rawvideoparse.
import { closeSync, openSync, writeSync } from "node:fs";

export const lens = { width: 480, height: 360, focal: 400, rate: 20 };
/** Inner corners, and the side of a square in m. */
export const board = { columns: 9, rows: 6, side: 0.025 };

/** How the board is held, one after the other and always whole in view: its middle in the image, distance, tilts (rad). */
function poses() {
  const tilts = [[0, 0], [0.45, 0], [-0.45, 0], [0, 0.5], [0, -0.5], [0.3, 0.35], [-0.3, -0.35]];
  const near = tilts.map((tilt) => ({ place: [0.5, 0.5], distance: 0.28, tilt }));
  const [left, middle, right, top, bottom] = [0.2, 0.5, 0.8, 0.22, 0.78];
  const places = [
    [left, top], [middle, top], [right, top], [left, 0.5], [right, 0.5], [left, bottom], [middle, bottom], [right, bottom],
  ];
  const far = [0.6, 0.62, 0.66].flatMap((distance, round) =>
    places.map((place, i) => ({ place, distance, tilt: tilts[(i + 3 * round) % tilts.length] })),
  );
  return [...near, ...far];
}

/** Gray value of the board's plane at x, y (m) from its middle. */
function grayAt(x, y) {
  const column = Math.floor(x / board.side + (board.columns + 1) / 2);
  const row = Math.floor(y / board.side + (board.rows + 1) / 2);
  const isOn = (i, count) => i >= -1 && i <= count + 1;
  if (!isOn(column, board.columns) || !isOn(row, board.rows)) return 110;
  const isSquare = column >= 0 && row >= 0 && column <= board.columns && row <= board.rows;
  return isSquare && (column + row) % 2 === 0 ? 30 : 220;
}

function render({ place, distance, tilt }) {
  const { width, height, focal } = lens;
  const [cx, sx, cy, sy] = [Math.cos(tilt[0]), Math.sin(tilt[0]), Math.cos(tilt[1]), Math.sin(tilt[1])];
  // Columns of the board's rotation: about y, then about x.
  const ex = [cy, sx * sy, -cx * sy];
  const ey = [0, cx, sx];
  const n = [sy, -sx * cy, cx * cy];
  const middle = [((place[0] - 0.5) * width * distance) / focal, ((place[1] - 0.5) * height * distance) / focal, distance];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const reach = dot(n, middle);
  const frame = Buffer.alloc(width * height);
  for (let v = 0; v < height; v += 1) {
    for (let u = 0; u < width; u += 1) {
      let sum = 0;
      for (let i = 0; i < 9; i += 1) {
        const ray = [(u + ((i % 3) - 1) / 3 - (width - 1) / 2) / focal, (v + (Math.floor(i / 3) - 1) / 3 - (height - 1) / 2) / focal, 1];
        const scale = reach / dot(n, ray);
        const on = [scale * ray[0] - middle[0], scale * ray[1] - middle[1], scale - middle[2]];
        sum += grayAt(dot(on, ex), dot(on, ey));
      }
      frame[v * width + u] = sum / 9;
    }
  }
  return frame;
}

/** Writes the frames to a file; returns the pipeline that plays it as a camera would. */
export function writeChessboardVideo(path) {
  const still = 20; // frames
  const file = openSync(path, "w");
  for (const pose of poses()) {
    const frame = render(pose);
    for (let i = 0; i < still; i += 1) writeSync(file, frame);
  }
  closeSync(file);
  const { width, height, rate } = lens;
  return `filesrc location=${path} ! rawvideoparse format=gray8 width=${width} height=${height} framerate=${rate}/1 ! identity sync=true ! videoconvert`;
}
