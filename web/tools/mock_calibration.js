// SPDX-License-Identifier: BSD-3-Clause
// A calibration as the server would tell of it: of the mount and the clock, over a circle of 300
// sightings.
import { height, width } from "./mock_flight.js";

const nothing = {
  kind: "calibration",
  state: "none",
  number: 0,
  asked: [],
  done: 0,
  of: 400,
  ending: false,
  error: "",
  width,
  height,
  places: [],
  distance_name: "",
  distances_m: [],
  coverage: "",
  numbers: [],
  residuals: { of: "", unit: "", over: "", rms_before: null, rms_after: null, points: [] },
  warnings: [],
  can_save: true,
  no_use: "",
  saved: "",
  save_error: "",
};

/** What a client of the mock server is told of calibrations. */
export class MockCalibration {
  constructor(send) {
    this.send = send;
    this.last = nothing;
    this.tell({});
  }

  tell(change) {
    this.last = { ...this.last, ...change };
    this.send(this.last);
  }

  receive(message) {
    if (message.command === "calibrate") this.start(message.settings);
    if (message.command === "calibrate-save") this.tell({ saved: "calibrated/mount_clock.yaml" });
    if (message.command === "calibrate-cancel") {
      clearTimeout(this.timer);
      this.tell({ state: "cancelled" });
    }
  }

  start(asked) {
    this.tell({ ...nothing, asked, number: this.last.number + 1, state: "running", done: 120 });
    this.timer = setTimeout(() => this.tell(asked[0] === "lens" ? refusal : result()), 500);
  }
}

const refusal = {
  state: "refused",
  error: "the views cannot tell the lens: the pattern is in 3 of them, near enough for its edges, expected at least 8",
};

function result() {
  const sightings = Array.from({ length: 300 }, (_, i) => i);
  const noise = (i) => 0.5 + Math.abs(Math.sin(12.9898 * i));
  return {
    state: "done",
    done: 400,
    places: sightings.flatMap((i) => [
      Math.round(width * (0.5 + 0.38 * Math.cos(i / 20) * (i / 300))),
      Math.round(height * (0.5 + 0.4 * Math.sin(i / 20) * (i / 300))),
    ]),
    distance_name: "height above the pattern",
    distances_m: sightings.map((i) => 1 + i / 60),
    coverage: "the pattern was found in 300 of 400 images, its centre in 26 of 48 fields of the image, from 1.0 to 6.0 m above it; 296 used, 4 left out",
    numbers: [
      { name: "mount turned by roll", unit: "degrees", before: 0, after: 1.283, sigma: 0.021 },
      { name: "mount turned by pitch", unit: "degrees", before: 0, after: -0.644, sigma: 0.019 },
      { name: "mount turned by yaw", unit: "degrees", before: 0, after: 0.31, sigma: 0.12 },
      { name: "clock offset", unit: "s", before: 0, after: 0.0552, sigma: 0.0004 },
    ],
    residuals: {
      of: "positions in the world",
      unit: "m",
      over: "time, s",
      rms_before: 0.253,
      rms_after: 0.0113,
      points: sightings.map((i) => [i / 10, 0.25 * noise(i), 0.01 * noise(i + 7)]),
    },
    warnings: [
      "the flight cannot tell the yaw of the mount (standard deviation 0.12 degrees): fly slowly around a standing pattern, at several heights and headings",
    ],
  };
}
