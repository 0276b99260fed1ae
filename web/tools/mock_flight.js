// SPDX-License-Identifier: BSD-3-Clause
// A landing as the server would tell of it: a UAV spirals down to a pad that drives.
import { crc32, deflateSync } from "node:zlib";

export const width = 376;
export const height = 240;
export const flightSeconds = 40;
export const framesPerSecond = 10;

/** Where all is, so many seconds after the beginning; m. */
export function flightAt(seconds) {
  const t = seconds % flightSeconds;
  const target = [0.8 * t, 4 * Math.sin(0.12 * t)];
  const altitude = Math.max(0.3, 9 * (1 - t / 36));
  const radius = Math.max(0, 2.5 * (1 - t / 30));
  const offset = [radius * Math.cos(0.5 * t), radius * Math.sin(0.5 * t)];
  const isSeen = t > 3 && !(t > 14 && t < 16);
  const isFalse = t > 1.2 && t < 1.6;
  const uav = [target[0] + offset[0], target[1] + offset[1]];
  return { t, target, altitude, offset, uav, isSeen, isFalse };
}

export function markAt(flight) {
  if (flight.isFalse) return "x";
  if (flight.isSeen) return "f";
  return flight.t > 3 ? "l" : "-";
}

export function stateAt(flight) {
  if (flight.t <= 3) return ["searching", "no pattern in view"];
  if (!flight.isSeen) return ["predicting", "pattern hidden: ring cut off at the image's edge"];
  return flight.altitude < 3 ? ["landing", ""] : ["tracking", ""];
}

// Pixels per metre, and where the pattern's centre is.
function projection(flight) {
  const scale = 190 / flight.altitude;
  return {
    scale,
    u: width / 2 - flight.offset[0] * scale * 0.5,
    v: height / 2 + flight.offset[1] * scale * 0.5,
  };
}

/** 'hasSecond': of a second run, too, which finds the pattern elsewhere. */
export function shapesAt(flight, hasSecond) {
  const { scale, u, v } = projection(flight);
  const circle = (x, y, radius) =>
    Array.from({ length: 64 }, (_, i) => {
      const angle = (i * 2 * Math.PI) / 32 / 2;
      return Math.round(10 * (i % 2 ? y + radius * Math.sin(angle - Math.PI / 32) : x + radius * Math.cos(angle))) / 10;
    });
  const shapes = [
    { layer: "rejected", label: "ring: not round", outline: [300, 40, 340, 44, 336, 70, 298, 66] },
  ];
  if (flight.t > 3) shapes.push({ layer: "prediction", label: "", outline: circle(u + 4, v - 3, 0.65 * scale) });
  if (flight.isSeen) {
    shapes.push({ layer: "detection", label: "whole pattern, 93 %", outline: circle(u, v, 0.5 * scale) });
    shapes.push({ layer: "detection", label: "", outline: [u, v] });
  }
  const first = shapes.map((shape) => ({ ...shape, run: 1, closed: true }));
  if (!hasSecond || !flight.isSeen) return first;
  const second = { layer: "detection", label: "pattern, by the edges of its cross, 91 %", outline: circle(u + 3, v + 2, 0.47 * scale), run: 2, closed: true };
  return [...first, second];
}

/** A gray picture of the pad, as PNG: browsers take it for what it is. */
export function pictureAt(flight) {
  const { scale, u, v } = projection(flight);
  const rows = Buffer.alloc(height * (width + 1));
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      rows[y * (width + 1) + 1 + x] = grayAt((x - u) / scale, (y - v) / scale, x * 7 + y * 13);
    }
  }
  return png(rows);
}

function grayAt(x, y, seed) {
  const ground = 96 + ((seed * 2654435761) >>> 28);
  if (Math.abs(x) > 0.75 || Math.abs(y) > 0.75) return ground;
  const radius = Math.hypot(x, y);
  const isRing = radius < 0.5 && radius > 0.4;
  const isCross = radius < 0.4 && Math.min(Math.abs(x - y), Math.abs(x + y)) < 0.07;
  return isRing || isCross ? 25 : 230;
}

function png(rows) {
  const header = Buffer.alloc(13);
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  header[8] = 8;
  const signature = Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]);
  const data = deflateSync(rows, { level: 1 });
  return Buffer.concat([signature, chunk("IHDR", header), chunk("IDAT", data), chunk("IEND", Buffer.alloc(0))]);
}

/** A part of a PNG file. */
export function chunk(type, data) {
  const body = Buffer.concat([Buffer.from(type), data]);
  const bytes = Buffer.alloc(body.length + 8);
  bytes.writeUInt32BE(data.length, 0);
  body.copy(bytes, 4);
  bytes.writeUInt32BE(crc32(body), body.length + 4);
  return bytes;
}
