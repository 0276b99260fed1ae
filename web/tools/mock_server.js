// SPDX-License-Identifier: BSD-3-Clause
// Serves page/ and a simulated flight, for work on the page without the program:
//
//   node tools/mock_server.js [PORT] [--replay | --study]
import { existsSync, readFileSync } from "node:fs";
import { createServer } from "node:http";
import { join } from "node:path";
import { WebSocketServer } from "ws";
import { colorPicture, MockColors } from "./mock_colors.js";
import { MockCalibration } from "./mock_calibration.js";
import { MockStudy } from "./mock_study.js";
import {
  flightAt,
  flightSeconds,
  framesPerSecond,
  height,
  markAt,
  pictureAt,
  shapesAt,
  stateAt,
  width,
} from "./mock_flight.js";

const built = new URL("../page", import.meta.url).pathname;
const types = { html: "text/html; charset=utf-8", js: "text/javascript", css: "text/css", svg: "image/svg+xml" };
const frameCount = flightSeconds * framesPerSecond;

const ofPose = ["frames", "pose"];
const series = [
  { name: "height", unit: "m", label: "Camera height", sources: ofPose },
  { name: "offset", unit: "m", label: "Camera offset", sources: ofPose },
  { name: "speed", unit: "m/s", label: "Target's speed", sources: ofPose },
  { name: "quality", unit: "", label: "Quality", sources: ["frames"] },
  { name: "detect", unit: "ms", label: "Detection", sources: ["frames"] },
  { name: "latency", unit: "ms", label: "Capture to result", sources: ["frames"] },
];

const checks = [
  { name: "camera", verdict: "good", measured: "30.0 frames/s, 0 missed, 0 repeated", advice: "" },
  { name: "autopilot", verdict: "doubtful", measured: "104 packets/s, 3 damaged, 0 not sent", advice: "" },
  { name: "processor", verdict: "good", measured: "38 % of one, there are 4", advice: "" },
];

const doctorChecks = [
  { name: "frame rate", verdict: "good", measured: "30.0 images/s", advice: "" },
  { name: "focus", verdict: "doubtful", measured: "edges rise over 4.1 px", advice: "turn the lens until they are sharp" },
  { name: "disk", verdict: "wrong", measured: "400 MB free", advice: "remove old recordings" },
  { name: "calibration by the pattern", verdict: "not checked", measured: "pattern in view in 2 of 30 images", advice: "" },
];

const views = ["threshold 1/8", "threshold 1/4"];

const options = [
  { name: "landing.detector.min_quality", value: "0.6", unit: "1", meaning: "smallest accepted probability" },
  { name: "landing.still", value: "false", unit: "", meaning: "frames have nothing to do with each other" },
];

const settings = [
  { name: "fly.source", label: "Camera", value: "/dev/video0", unit: "", meaning: "camera or recording", choices: [], given: true },
  { name: "landing.target.kind", label: "Target", value: "aruco", unit: "", meaning: "what the target is", choices: ["aruco", "ring-cross"], given: false },
  { name: "landing.target.id", label: "Id of the target", value: "3", unit: "", meaning: "id of the pad", choices: [], given: false },
];

/** The answer to changes that are saved. */
function savedSettings(changes) {
  const values = Object.fromEntries(changes.map((change) => change.split("=")));
  const changed = settings.map((one) => ({ ...one, value: values[one.name] ?? one.value }));
  return { kind: "settings", file: "kestrel.yaml", settings: changed, saved: "saved to kestrel.yaml; restart kestrel fly", error: "" };
}

/**
 * Starts the server; resolves to it. 'isReplay': as `kestrel console` of a recording; 'isStudy': of a study. Its
 * 'silent' are the sources of a flight that give nothing any more, with the time of the last, ms; "program": it says
 * nothing at all; "flight": it is over.
 */
export function startMockServer(port, isReplay = false, isStudy = false) {
  const server = createServer(sendFile);
  const sockets = new WebSocketServer({ server, path: "/live" });
  server.silent = new Map();
  server.sockets = sockets;
  sockets.on("connection", (socket) => new Client(socket, isReplay, isStudy, server.silent));
  return new Promise((resolve) => server.listen(port, "127.0.0.1", () => resolve(server)));
}

function sendFile(request, response) {
  const picture = colorPicture(request.url);
  if (picture) return response.writeHead(200, { "Content-Type": "image/png" }).end(picture);
  const name = request.url === "/" ? "/index.html" : request.url;
  const path = join(built, name);
  if (!path.startsWith(built) || !existsSync(path)) return response.writeHead(404).end();
  response.writeHead(200, {
    "Content-Type": types[path.split(".").at(-1)] ?? "application/octet-stream",
    "Content-Security-Policy":
      "default-src 'self'; img-src 'self' blob:; base-uri 'none'; form-action 'self'; frame-ancestors 'none'",
  });
  return response.end(readFileSync(path));
}

class Client {
  constructor(socket, isReplay, isStudy, silent) {
    this.socket = socket;
    this.silent = silent;
    this.isReplay = isReplay;
    this.isStudy = isStudy;
    this.frame = 0;
    this.speed = 1;
    this.isRecording = false;
    this.hasSecond = false;
    this.wantsImages = false;
    this.inFlight = null;
    this.colors = new MockColors();
    socket.on("message", (text) => this.receive(JSON.parse(text)));
    const timer = setInterval(() => this.tick(), 1000 / framesPerSecond);
    socket.on("close", () => clearInterval(timer));
    if (!silent.has("program")) this.greet();
  }

  send(message) {
    this.socket.send(JSON.stringify(message));
  }

  greet() {
    const offers = this.isStudy ? ["play", "seek", "step", "detect", "cancel", "compare", "open"] : this.isReplay ? ["play", "seek", "step", "detect", "cancel", "calibrate"] : ["record", "snapshot", "settings"];
    const title = this.isStudy ? "study" : this.isReplay ? "Recording flight_07" : "Simulated flight";
    const layers = ["detection", "prediction", "rejected", ...(this.isReplay ? ["second"] : [])];
    this.send({ kind: "hello", title, live: !this.isReplay, series, layers, views, offers, exports: this.isReplay, colors: this.isReplay && !this.isStudy });
    if (this.isStudy) return this.greetWithStudy();
    this.send({ kind: "health", checks });
    if (!this.isReplay) this.send({ kind: "doctor", checks: doctorChecks });
    if (!this.isReplay) this.send(team());
    if (!this.isReplay) this.send({ kind: "settings", file: "kestrel.yaml", settings, saved: "", error: "" });
    this.event("info", "camera opened: 376x240, 30 Hz");
    this.event("warning", "autopilot's clock is 12 ms ahead");
    if (this.isReplay) this.sendTimeline();
    if (this.isReplay) this.send({ kind: "options", options });
    if (this.isReplay) this.colors.messages().forEach((message) => this.send(message));
    if (this.isReplay) this.calibration = new MockCalibration((message) => this.send(message));
  }

  greetWithStudy() {
    this.speed = 0;
    this.study = new MockStudy(
      (message) => this.send(message),
      (second) => {
        this.sendTimeline();
        this.send({ kind: "options", options });
        this.show(200, 0);
        this.detect([second]);
      },
    );
  }

  /** A second run that loses the pattern more often. */
  detect(settings) {
    const second = { kind: "second", settings, done: 120, error: "", marks: "" };
    this.send({ ...second, state: "running" });
    const marks = Array.from({ length: frameCount }, (_, i) => {
      const mark = markAt(flightAt(i / framesPerSecond));
      return mark === "f" && i % 60 < 12 ? "l" : mark;
    });
    setTimeout(() => {
      this.hasSecond = true;
      this.send({ ...second, state: "done", done: frameCount, marks: marks.join("") });
    }, 500);
  }

  findings(flight) {
    const facts = (isSeen, quality) => [
      { name: "found", value: isSeen ? "yes" : "no, ring: not round" },
      { name: "method", value: isSeen ? "whole pattern" : "" },
      { name: "quality", value: isSeen ? quality : "" },
    ];
    const runs = [facts(flight.isSeen, "0.93"), facts(flight.isSeen && this.frame % 60 >= 12, "0.91")];
    return { kind: "findings", frame: this.frame, runs: this.hasSecond ? runs : runs.slice(0, 1) };
  }

  sendTimeline() {
    const frames = Array.from({ length: frameCount }, (_, i) => i);
    this.send({
      kind: "timeline",
      begin: "1700000000000000000",
      times_ms: frames.map((i) => (1000 * i) / framesPerSecond),
      marks: frames.map((i) => markAt(flightAt(i / framesPerSecond))).join(""),
    });
    const samples = frames.map((i) => valuesAt(flightAt(i / framesPerSecond)));
    this.send({
      kind: "series",
      times_ms: frames.map((i) => (1000 * i) / framesPerSecond),
      values: series.map((_, column) => samples.map((sample) => sample[column])),
    });
  }

  sendSources() {
    const age = (name) => Date.now() - (this.silent.get(name) ?? Date.now() - 20);
    const sources = ["frames", "autopilot", "pose"].map((name) => ({ name, age_ms: age(name) }));
    this.send({ kind: "sources", time: `${Date.now()}000000`, sources });
  }

  event(level, text) {
    this.send({ kind: "event", time: this.time(), level, text });
  }

  time() {
    return `${1_700_000_000_000 + Math.round((1000 * this.frame) / framesPerSecond)}000000`;
  }

  receive(message) {
    if ("colors" in message) this.colors.receive(message).forEach((answer) => this.send(answer));
    if ("images" in message) this.want(message);
    if (message.ack === this.inFlight) this.inFlight = null;
    if (message.command === "record") {
      this.isRecording = message.value === 1;
      this.event("info", this.isRecording ? "recording to flight_08" : "recording ended");
    }
    this.calibration?.receive(message);
    this.study?.receive(message);
    if (message.command === "detect") this.detect(message.settings);
    if (message.command === "settings") this.send(savedSettings(message.settings));
    if (message.command === "snapshot") this.event("info", "snapshot kept");
    if (message.command === "play") this.speed = message.value;
    if (message.command === "step") this.show(this.frame + message.value, 0);
    if (message.command === "seek") this.show(Math.round(message.value * framesPerSecond), this.speed);
  }

  /** A held picture is sent again for another view only. */
  want({ images, hold }) {
    const view = images === true ? "" : images;
    this.wantsImages = images !== false && !(hold && this.view === view);
    this.isHeld = hold;
    this.view = view;
  }

  show(frame, speed) {
    this.frame = Math.min(Math.max(frame, 0), frameCount - 1);
    this.speed = speed;
    this.tellAll();
  }

  tick() {
    if (this.silent.has("program")) return;
    if (!this.isReplay) this.frame += 1;
    else if (this.speed !== 0) this.frame = Math.round(this.frame + Math.max(this.speed, 1)) % frameCount;
    this.tellAll();
  }

  tellAll() {
    const flight = flightAt(this.frame / framesPerSecond);
    const [state, reason] = stateAt(flight);
    const over = this.silent.has("flight");
    const end = { state: "flight over", reason: "landed, 0.04 m from the centre by the estimate", over, replay: "kept/flight_08" };
    this.send({ kind: "status", state, reason, recording: this.isRecording, over: false, replay: "", ...(over ? end : {}) });
    if (!this.isReplay) this.send(vehicleAt(flight));
    if (!this.isReplay) this.sendSources();
    this.send({ kind: "sample", time: this.time(), values: valuesAt(flight) });
    this.send(mapOf(flight));
    if (this.isReplay) this.send(this.findings(flight));
    if (this.isReplay) this.send({ kind: "playback", frame: this.frame, speed: this.speed });
    if (this.frame % 10 === 0) this.send({ kind: "link", dropped: 0, images: this.frame, draw_ms: 24, clients: 1 });
    this.sendImage(flight);
  }

  sendImage(flight) {
    if (!this.wantsImages || this.inFlight !== null || this.silent.has("frames")) return;
    this.sequence = (this.sequence ?? 0) + 1;
    this.inFlight = this.sequence;
    if (this.isHeld) this.wantsImages = false;
    const header = Buffer.from(
      JSON.stringify({
        sequence: this.sequence,
        time: this.time(),
        age_ms: this.isReplay ? null : 18,
        view: this.view,
        width,
        height,
        shapes: shapesAt(flight, this.hasSecond),
      }),
    );
    const size = Buffer.alloc(4);
    size.writeUInt32LE(header.length);
    this.socket.send(Buffer.concat([size, header, pictureAt(flight)]));
  }
}

function valuesAt(flight) {
  const quality = flight.isSeen ? 0.93 + 0.03 * Math.sin(3 * flight.t) : null;
  const detect = 1.6 + 0.4 * Math.sin(7 * flight.t);
  return [flight.altitude, Math.hypot(...flight.offset), 0.8, quality, detect, 31 + 4 * Math.sin(flight.t)];
}

function mapOf(flight) {
  const at = (label, position, sigma) => ({
    label,
    color: "",
    position,
    covariance: [sigma * sigma, 0.3 * sigma * sigma, 0.6 * sigma * sigma],
  });
  const ahead = [1, 2, 3].map((seconds) => {
    const later = flightAt(flight.t + seconds);
    return at(`+${seconds} s`, later.target, 0.15 + 0.25 * seconds);
  });
  const isKnown = flight.t > 3;
  return {
    kind: "map",
    uav: flight.uav,
    heading: 0.1 * flight.t,
    target: isKnown ? at("pad", flight.target, flight.isSeen ? 0.12 : 0.4) : null,
    velocity: [0.8, 0],
    prediction: isKnown ? ahead : [],
    objects: [],
    mapped: [],
  };
}

// Messages that a UAV of a team that hunts would receive; the landing has them on its map as well.
/** A multicopter that guidance flies down. */
function vehicleAt(flight) {
  const fact = (name, measured, verdict = "good") => ({ name, verdict, measured, advice: "" });
  return {
    kind: "vehicle",
    facts: [
      fact("mode", "GUIDED"),
      fact("motors", "armed"),
      fact("battery", "14.9 V, 22 %", "doubtful"),
      fact("GPS", "fix, 14 satellites"),
      fact("position", "trusted"),
    ],
    limits: [
      { limit: "lean", share: Math.min(1, 0.3 + flight.offset[0] ** 2 / 6) },
      { limit: "speed", share: 0.42 },
      { limit: "climb", share: 0.6 },
    ],
    cannot_follow: flight.t > 14 && flight.t < 16 ? "cannot keep up: needs 54 deg of lean, the limit is 35" : "",
  };
}

function team() {
  const known = (label, position, uavs, holder) => ({
    label,
    color: "",
    position,
    covariance: [0.04, 0, 0.04],
    uavs,
    holder,
  });
  return {
    kind: "team",
    objects: [
      known("red", [4, 3], ["one", "two"], "two"),
      known("green", [11, -3], ["one"], ""),
      known("blue", [20, 5], ["three", "two"], "one"),
    ],
  };
}

if (process.argv[1] === new URL(import.meta.url).pathname) {
  const port = Number(process.argv[2] ?? 8090);
  const isStudy = process.argv.includes("--study");
  await startMockServer(port, process.argv.includes("--replay") || isStudy, isStudy);
  console.log(`http://127.0.0.1:${port}/`);
}
