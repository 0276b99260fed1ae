// SPDX-License-Identifier: BSD-3-Clause
import type { Colors, ColorScores } from "./color_protocol";
import { firstColorView, viewAfter, type ColorView } from "./color_view";
import type { Calibration } from "./calibration";
import type { FrameRange } from "./clip";
import { Freshness, type Staleness } from "./freshness";
import type { Lens } from "./lens";
import type {
  ClipProgress,
  Doctor,
  EventMessage,
  Findings,
  Health,
  Hello,
  Layer,
  LinkReport,
  MapMessage,
  Option,
  Playback,
  SecondRun,
  ServerMessage,
  SourceName,
  Status,
  TeamMessage,
  Timeline,
  Vehicle,
} from "./protocol";
import { SeriesBuffer } from "./series_buffer";
import type { Settings } from "./settings";
import type { Study, StudyReplay } from "./study";

export type ConnectionState = "connecting" | "open" | "lost" | "refused";
export const themes = ["auto", "light", "dark", "sun"] as const;
export type Theme = (typeof themes)[number];

/** A page of the window: a flight or a recording, its colours, the calibration from it, or the table of a study. */
export type Page = "watch" | "colors" | "calibration" | "study";

/** Parts of a page of which a phone shows one. */
export const panels = ["view", "map", "plots", "save", "again", "health", "events"] as const;
export type PanelName = (typeof panels)[number];

export interface State {
  page: Page;
  panel: PanelName;
  connection: ConnectionState;
  hello: Hello | null;
  status: Status | null;
  map: MapMessage | null;
  team: TeamMessage | null;
  health: Health | null;
  vehicle: Vehicle | null;
  doctor: Doctor | null;
  events: EventMessage[];
  /** Of the recorded flight; what comes after the frame that is shown is not shown. */
  log: EventMessage[];
  timeline: Timeline | null;
  playback: Playback | null;
  options: Option[];
  second: SecondRun | null;
  findings: Findings | null;
  /** Two pictures, one for each run. */
  isBeside: boolean;
  /** Frames of a clip; null: the whole recording. */
  clipRange: FrameRange | null;
  clip: ClipProgress | null;
  colors: Colors | null;
  colorScores: ColorScores | null;
  colorView: ColorView;
  calibration: Calibration | null;
  study: Study | null;
  studyReplay: StudyReplay | null;
  lens: Lens | null;
  settings: Settings | null;
  link: LinkReport | null;
  /** Changed in place, by every message. */
  freshness: Freshness;
  staleness: Staleness;
  series: SeriesBuffer;
  /** All values of a recording, a column of each series; null: a flight. */
  flight: SeriesBuffer | null;
  /** UAV's way on the map, oldest first. */
  track: [number, number][];
  layers: Record<Layer, boolean>;
  /** The view that is shown, one of those of hello; "": the camera's image. */
  view: string;
  /** Whether the map shows what the team knows. */
  isTeamShown: boolean;
  isFrozen: boolean;
  isMuted: boolean;
  isHelpShown: boolean;
  theme: Theme;
}

/** Nothing is known yet. */
const unknown: Staleness = { isSilent: false, old: [], fresh: [], missing: [] };

const maxEvents = 200;
const maxTrack = 600;

export function initialState(): State {
  return {
    page: "watch",
    panel: "map",
    connection: "connecting",
    hello: null,
    status: null,
    map: null,
    team: null,
    health: null,
    vehicle: null,
    doctor: null,
    events: [],
    log: [],
    timeline: null,
    playback: null,
    options: [],
    second: null,
    findings: null,
    isBeside: false,
    clipRange: null,
    clip: null,
    colors: null,
    colorScores: null,
    colorView: firstColorView,
    calibration: null,
    study: null,
    studyReplay: null,
    lens: null,
    settings: null,
    link: null,
    freshness: new Freshness(),
    staleness: unknown,
    series: new SeriesBuffer(0),
    flight: null,
    track: [],
    layers: { detection: true, prediction: true, rejected: true, truth: true, second: true },
    view: "",
    isTeamShown: true,
    isFrozen: false,
    isMuted: false,
    isHelpShown: false,
    theme: "auto",
  };
}

/** The state after a message. Series and ages are changed in place: a clock shows them. */
export function withMessage(state: State, message: ServerMessage): State {
  switch (message.kind) {
    case "hello":
      // A new server, or the same one again: what it knows comes after this.
      return {
        ...state,
        hello: message,
        page: pageAfter(state, message),
        view: message.views.includes(state.view) ? state.view : "",
        events: [],
        log: [],
        track: [],
        map: null,
        team: null,
        status: null,
        vehicle: null,
        health: null,
        doctor: null,
        timeline: null,
        playback: null,
        options: [],
        second: null,
        findings: null,
        clipRange: null,
        clip: null,
        colors: null,
        colorScores: null,
        calibration: null,
        study: null,
        studyReplay: null,
        freshness: new Freshness(),
        staleness: unknown,
        lens: null,
        settings: null,
        series: new SeriesBuffer(message.series.length),
        flight: null,
      };
    case "sample":
      state.series.add(message);
      return state;
    case "series":
      return { ...state, flight: SeriesBuffer.ofRecording(message) };
    case "sources":
      state.freshness.tell(message, performance.now());
      return state;
    case "status":
      return { ...state, status: message };
    case "map":
      return { ...state, map: message, track: withPoint(state.track, message.uav) };
    case "team":
      return { ...state, team: message };
    case "health":
      return { ...state, health: message };
    case "vehicle":
      return { ...state, vehicle: message };
    case "doctor":
      return { ...state, doctor: message };
    case "event":
      return { ...state, events: [...state.events, message].slice(-maxEvents) };
    case "log":
      return { ...state, log: message.events };
    case "timeline":
      // A study opens one recording after the other: what was said of the one before is gone.
      return { ...state, timeline: message, second: null, findings: null, clipRange: null, track: [], flight: null };
    case "playback":
      return { ...state, playback: message };
    case "options":
      return { ...state, options: message.options };
    case "second":
      return { ...state, second: message };
    case "findings":
      return { ...state, findings: message };
    case "clip":
      return { ...state, clip: message };
    case "colors":
      return { ...state, colors: message, colorView: viewAfter(state.colorView, message) };
    case "color-scores":
      return { ...state, colorScores: message };
    case "calibration":
      return { ...state, calibration: message };
    case "study":
      return { ...state, study: message };
    case "study-replay":
      return withReplay(state, message);
    case "lens":
      return { ...state, lens: message };
    case "settings":
      return { ...state, settings: message };
    case "link":
      return { ...state, link: message };
  }
}

/** Whether values that come from these sources are what is now; what a recording has, always is. */
export function isFresh(state: State, sources: SourceName[]): boolean {
  if (!state.hello?.live) return true;
  const { isSilent, fresh } = state.staleness;
  const isHeard = state.connection === "open" && !isSilent;
  return isHeard && !state.status?.over && sources.every((source) => fresh.includes(source));
}

/** A study begins with its table; a page that comes back to it stays where it was. */
function pageAfter(state: State, hello: Hello): Page {
  if (!hello.offers.includes("open")) return state.page === "study" ? "watch" : state.page;
  return state.study === null ? "study" : state.page;
}

/** The page turns to a recording that was asked for, as soon as it is there. */
function withReplay(state: State, replay: StudyReplay): State {
  const hasOpened = replay.state === "open" && state.studyReplay?.state === "running";
  if (!hasOpened) return { ...state, studyReplay: replay };
  return { ...state, studyReplay: replay, page: "watch", isBeside: true };
}

function withPoint(
  track: [number, number][],
  point: [number, number] | null,
): [number, number][] {
  const last = track.at(-1);
  if (!point) return track;
  const distance = last ? Math.hypot(last[0] - point[0], last[1] - point[1]) : 0;
  if (last && distance < 0.05) return track;
  // So far from one frame to the next: a recording was wound.
  if (distance > 3) return [point];
  return [...track, point].slice(-maxTrack);
}

/** The one store: components look at it by useStore, everybody changes it by set. */
export class Store {
  private current = initialState();
  private readonly listeners = new Set<() => void>();

  get state(): State {
    return this.current;
  }

  set(change: Partial<State>): void {
    this.replace({ ...this.current, ...change });
  }

  receive(message: ServerMessage): void {
    this.replace(withMessage(this.current, message));
    this.current.freshness.hear(performance.now());
  }

  subscribe(listener: () => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  private replace(state: State): void {
    if (state === this.current) return;
    this.current = state;
    for (const listener of this.listeners) listener();
  }
}

export const store = new Store();
