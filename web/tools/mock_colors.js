// SPDX-License-Identifier: BSD-3-Clause
// The page of colours as the server would serve it, without teaching: a red and a blue disc on grass.
import { deflateSync } from "node:zlib";
import { chunk } from "./mock_flight.js";

const width = 320;
const height = 180;
const frames = 30;
const names = ["red", "orange", "yellow", "green", "blue"];
const none = 255;

const components = [
  { weight: 0.7, hue: 357, saturation: 0.78, sigma_hue: 5, sigma_saturation: 0.1, correlation: 0.4 },
  { weight: 0.3, hue: 4, saturation: 0.5, sigma_hue: 4, sigma_saturation: 0.08, correlation: 0 },
];

// Bins of 5 degrees and 0.04, as many samples as the mixture has there.
const histogram = Array.from({ length: 72 * 25 }, (_, i) => {
  const [hue, saturation] = [5 * (i % 72) + 2.5, Math.floor(i / 72) / 25 + 0.02];
  const density = components.map((one) => {
    const away = ((hue - one.hue + 540) % 360) - 180;
    return Math.exp(-0.5 * ((away / one.sigma_hue) ** 2 + ((saturation - one.saturation) / one.sigma_saturation) ** 2));
  });
  return Math.round(400 * Math.max(...density));
});

/** What one browser has marked. */
export class MockColors {
  strokes = [];
  undone = [];
  revision = 1;
  color = "red";
  isTaught = false;

  /** What the page is told when it comes, and after each request. */
  messages(answer = "") {
    const colors = {
      kind: "colors",
      revision: this.revision,
      frames,
      most_kept: 0,
      names,
      color: this.color,
      marked: [...new Set(this.strokes.map(({ frame }) => frame))].sort((a, b) => a - b),
      strokes: this.strokes.length,
      can_redo: this.undone.length > 0,
      histogram,
      cut_hue: 180,
      components,
      max_distance: 3,
      warnings: ["marked on 1 of the frames: mark it on at least 3, in sun and in shade"],
      difference: this.isTaught ? ["    - name: red", "-       - {weight: 1}", "+       - {weight: 0.7}"] : [],
      file: "taught/objects.yaml",
      versions: ["taught/objects.yaml.1"],
      answer,
      refused: false,
    };
    const scores = {
      kind: "color-scores",
      revision: this.revision,
      color: this.color,
      wanted: 1234,
      recall: 0.987,
      others: 5120,
      false_share: 0.0012,
      overlaps: [{ color: "orange", share: 0.004 }],
      left_outs: [{ frame: 0, recall: 0.97 }, { frame: 8, recall: 0.81 }],
    };
    return [colors, scores];
  }

  receive(request) {
    const action = request.colors;
    if (action === "choose") this.color = request.color;
    else this.revision += 1;
    if (action === "mark") {
      this.strokes.push(request);
      this.undone = [];
    }
    if (action === "undo" && this.strokes.length > 0) this.undone.push(this.strokes.pop());
    if (action === "redo" && this.undone.length > 0) this.strokes.push(this.undone.pop());
    if (action === "teach") this.isTaught = true;
    if (action === "save" || action === "revert") this.isTaught = false;
    const answers = { teach: `taught ${request.color}`, save: "saved as taught/objects.yaml" };
    return this.messages(answers[action]);
  }
}

// 0: grass, 1: the red disc, 5: the blue one.
function labelAt(frame, x, y) {
  if (Math.hypot(x - 90 - 4 * frame, y - 80) < 26) return 1;
  return Math.hypot(x - 220, y - 110) < 22 ? 5 : 0;
}

const paints = { 0: [96, 122, 70], 1: [196, 40, 44], 5: [40, 90, 160] };

/** PNG of a frame, or of its labels and marks; null where a path is neither. */
export function colorPicture(path) {
  const [, kind, digits] = path.match(/^\/export\/(picture|labels)-(\d+)\.(?:jpg|png)$/) ?? [];
  if (!kind || Number(digits) >= frames) return null;
  const frame = Number(digits);
  const pixelAt = (x, y) => {
    const label = labelAt(frame, x, y);
    const isGround = y < 20 && x > 40 && x < 200;
    if (kind === "labels") return [label, isGround ? none : 0, 0];
    const noise = ((x * 7919 + y * 104729) % 17) - 8;
    return paints[label].map((value) => value + noise);
  };
  const rows = Buffer.alloc(height * (3 * width + 1));
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) rows.set(pixelAt(x, y), y * (3 * width + 1) + 1 + 3 * x);
  }
  const header = Buffer.alloc(13);
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  header[8] = 8;
  header[9] = 2; // red, green, blue
  const signature = Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]);
  const data = deflateSync(rows, { level: 1 });
  return Buffer.concat([signature, chunk("IHDR", header), chunk("IDAT", data), chunk("IEND", Buffer.alloc(0))]);
}
