// SPDX-License-Identifier: BSD-3-Clause
// Messages of the server, as src/kestrel/app/console/messages/console_json.h writes it. Times are whole
// nanoseconds as text: they are beyond what numbers hold here.
import type { Calibration } from "./calibration";

import type { Colors, ColorScores } from "./color_protocol";
import type { Lens } from "./lens";
import type { Settings } from "./settings";
import type { Study, StudyReplay } from "./study";

export const layers = ["detection", "prediction", "rejected", "truth", "second"] as const;
export type Layer = (typeof layers)[number];

/** A line over the image, x and y in turn, in pixels of the frame; one point is a mark. */
export interface Shape {
  layer: Layer;
  label: string;
  outline: number[];
  /** The last point is joined to the first. */
  closed: boolean;
  /** Run of the detector over a recording; a flight has the first only. */
  run: 1 | 2;
}

export interface FrameHeader {
  sequence: number;
  time: string;
  /** Since the light was collected, when it was sent; null for recordings. */
  age_ms: number | null;
  /** The view of it, one of those of hello; "": the camera's image. */
  view: string;
  width: number;
  height: number;
  shapes: Shape[];
}

/** Source of a flight's values. */
export type SourceName = "frames" | "autopilot" | "pose";

export interface Series {
  name: string;
  unit: string;
  label: string;
  /** That its values come from. */
  sources: SourceName[];
  /** Whole numbers. */
  is_count: boolean;
}

export type CommandName =
  | "record"
  | "snapshot"
  | "play"
  | "seek"
  | "step"
  | "detect"
  | "cancel"
  | "calibrate"
  | "calibrate-cancel"
  | "calibrate-save"
  | "compare"
  | "open"
  | "lens"
  | "lens-stop"
  | "lens-save"
  | "settings"
  | "mark"
  | "point"
  | "confirm"
  | "stop";

export interface Hello {
  kind: "hello";
  title: string;
  live: boolean;
  series: Series[];
  /** Layers of shapes that there can be. */
  layers: Layer[];
  /** Images that can be shown in place of the camera's, as "threshold 1/8". */
  views: string[];
  offers: CommandName[];
  /** Whether frames and tables can be had at /export/. */
  exports: boolean;
  /** Whether colours can be taught. */
  colors: boolean;
}

/** One value for each series of hello; null where it is not known. */
export interface Sample {
  kind: "sample";
  time: string;
  values: (number | null)[];
}

/** All samples of a recording: a list of values for each series of hello. */
export interface RecordedSeries {
  kind: "series";
  times_ms: number[];
  values: (number | null)[][];
}

/** How old the newest data of each source were, at a time; null where it has given none yet. */
export interface Sources {
  kind: "sources";
  time: string;
  sources: { name: SourceName; age_ms: number | null }[];
}

export interface Status {
  kind: "status";
  state: string;
  reason: string;
  recording: boolean;
  /** The flight has ended; the reason says how. */
  over: boolean;
  /** Folder in which an ended flight is recorded; empty: none. */
  replay: string;
}

/** World frame: x east, y north, m; the covariance is xx, xy, yy. */
export interface MapObject {
  label: string;
  color: string;
  position: [number, number];
  covariance: [number, number, number];
}

export interface MapMessage {
  kind: "map";
  uav: [number, number] | null;
  heading: number;
  target: MapObject | null;
  velocity: [number, number];
  prediction: MapObject[];
  /** In view. */
  objects: MapObject[];
  /** Objects in the hunt's map by now. */
  mapped: MapObject[];
}

/** Object of the team's map, in this UAV's world. */
export interface TeamObject extends MapObject {
  /** Names of those that have it in their maps. */
  uavs: string[];
  /** The one that goes for it; empty: none. */
  holder: string;
}

export interface TeamMessage {
  kind: "team";
  objects: TeamObject[];
}

export interface Check {
  name: string;
  verdict: "good" | "doubtful" | "wrong" | "not checked";
  measured: string;
  /** The remedy; empty where all is well. */
  advice: string;
}

export interface Health {
  kind: "health";
  checks: Check[];
}

/** The vehicle, for the head of the page, and the used parts of the limits (0 to 1). */
export interface Vehicle {
  kind: "vehicle";
  facts: Check[];
  /** Empty while guidance does not fly. */
  limits: { limit: string; share: number }[];
  /** Why the target cannot be followed; empty: it can. */
  cannot_follow: string;
}

/** The checks of `kestrel doctor` that can be made in flight. */
export interface Doctor {
  kind: "doctor";
  checks: Check[];
}

export interface EventMessage {
  kind: "event";
  time: string;
  level: "info" | "warning" | "error";
  text: string;
}

/** What the autopilot of a recorded flight said, in order of time. */
export interface RecordedLog {
  kind: "log";
  events: EventMessage[];
}

/** One character of marks for each frame: - nothing, f found, l lost, x false. */
export interface Timeline {
  kind: "timeline";
  begin: string;
  times_ms: number[];
  marks: string;
}

export interface Playback {
  kind: "playback";
  frame: number;
  speed: number;
}

/** An option that the page can change for a second run, by its name in `kestrel config`. */
export interface Option {
  name: string;
  value: string;
  unit: string;
  meaning: string;
}

export interface OptionList {
  kind: "options";
  options: Option[];
}

/** The recording once more with other options; marks as of Timeline, once it is done. */
export interface SecondRun {
  kind: "second";
  state: "none" | "running" | "done" | "cancelled" | "failed";
  settings: string[];
  done: number;
  error: string;
  marks: string;
}

/** Something about a frame in words. */
export interface Fact {
  name: string;
  value: string;
}

/** Findings of the first run in the frame that is shown and, once it is done, of the second. */
export interface Findings {
  kind: "findings";
  frame: number;
  runs: Fact[][];
}

/** How many frames of a clip are made; of none, when no clip is. */
export interface ClipProgress {
  kind: "clip";
  done: number;
  frames: number;
}

export interface LinkReport {
  kind: "link";
  dropped: number;
  images: number;
  draw_ms: number | null;
  clients: number;
}

export type ServerMessage =
  | Hello
  | Sample
  | RecordedSeries
  | Sources
  | Status
  | MapMessage
  | TeamMessage
  | Vehicle
  | Health
  | Doctor
  | EventMessage
  | RecordedLog
  | Timeline
  | Playback
  | OptionList
  | SecondRun
  | Findings
  | ClipProgress
  | Colors
  | ColorScores
  | Calibration
  | Study
  | StudyReplay
  | Lens
  | Settings
  | LinkReport;

export interface ImageMessage {
  header: FrameHeader;
  jpeg: Blob;
}

/** The length of the header (32 bits, lowest byte first), the header, the JPEG. */
export function unpackImage(message: ArrayBuffer): ImageMessage {
  const size = new DataView(message).getUint32(0, true);
  const text = new TextDecoder().decode(new Uint8Array(message, 4, size));
  return {
    header: JSON.parse(text) as FrameHeader,
    jpeg: new Blob([new Uint8Array(message, 4 + size)], { type: "image/jpeg" }),
  };
}

/** Seconds from one time to another; exact to the microsecond however long ago the epoch is. */
export function secondsBetween(from: string, to: string): number {
  return Number((BigInt(to) - BigInt(from)) / 1000n) / 1e6;
}
