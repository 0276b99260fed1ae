// SPDX-License-Identifier: BSD-3-Clause
// Actions of the user, by button or key.
import { wholeOr, withFirst, withLast, type FrameRange } from "./clip";
import { connection } from "./connection";
import type { CommandName, Layer } from "./protocol";
import { store, type PanelName } from "./store";
import { applyTheme, themeAfter } from "./theme";
import { nextDifference, nextTrouble } from "./timeline";

export function isOffered(name: CommandName): boolean {
  return store.state.hello?.offers.includes(name) ?? false;
}

function command(name: CommandName, value?: number): void {
  if (isOffered(name)) connection.command(name, value);
}

export function toggleLayer(layer: Layer): void {
  const { layers } = store.state;
  store.set({ layers: { ...layers, [layer]: !layers[layer] } });
}

/** Looks at the camera's image ("") or a view of it. */
export function showView(view: string): void {
  store.set({ view });
}

/** The next one, or the one before. */
export function turnView(direction: 1 | -1): void {
  const { hello, view } = store.state;
  const views = ["", ...(hello?.views ?? [])];
  showView(views.at((views.indexOf(view) + direction) % views.length) ?? "");
}

export function toggleTeam(): void {
  store.set({ isTeamShown: !store.state.isTeamShown });
}

export function toggleRecording(): void {
  command("record", store.state.status?.recording ? 0 : 1);
}

export function takeSnapshot(): void {
  command("snapshot");
}

/** Points the gimbal again that was left to somebody else. */
export function pointGimbal(): void {
  command("point");
}

/** A live image is frozen here, a recording is held by the server. */
export function togglePlaying(): void {
  if (!isOffered("play")) store.set({ isFrozen: !store.state.isFrozen });
  else command("play", store.state.playback?.speed === 0 ? 1 : 0);
}

export function setSpeed(speed: number): void {
  command("play", speed);
}

export function step(frames: number): void {
  command("step", frames);
}

export function seekFrame(frame: number): void {
  const time = store.state.timeline?.times_ms[frame];
  if (time !== undefined) command("seek", time / 1000);
}

export function seekTrouble(direction: 1 | -1): void {
  const { timeline, playback } = store.state;
  if (!timeline || !playback) return;
  const frame = nextTrouble(timeline, playback.frame, direction);
  if (frame !== null) seekFrame(frame);
}

/** Runs the detector again, with settings as "landing.still=true". */
export function detectAgain(settings: string[]): void {
  if (isOffered("detect")) connection.commandWith("detect", settings);
}

export function cancelDetection(): void {
  command("cancel");
}

/** To the next frame that the two runs tell differently. */
export function seekDifference(direction: 1 | -1): void {
  const { timeline, playback, second } = store.state;
  if (!timeline || !playback || second?.state !== "done") return;
  const frame = nextDifference(timeline.marks, second.marks, playback.frame, direction);
  if (frame !== null) seekFrame(frame);
}

/** Both runs over one picture, or each with a picture of its own. */
export function toggleBeside(): void {
  store.set({ isBeside: !store.state.isBeside });
}

function chooseClip(change: (range: FrameRange, frame: number) => FrameRange): void {
  const { timeline, playback, clipRange } = store.state;
  if (!timeline || !playback) return;
  store.set({ clipRange: change(wholeOr(clipRange, timeline.times_ms.length), playback.frame) });
}

export function beginClipHere(): void {
  chooseClip(withFirst);
}

export function endClipHere(): void {
  chooseClip(withLast);
}

export function clipAll(): void {
  store.set({ clipRange: null });
}

export function nextTheme(): void {
  const theme = themeAfter(store.state.theme);
  applyTheme(theme);
  store.set({ theme });
}

export function toggleMute(): void {
  store.set({ isMuted: !store.state.isMuted });
}

export function showPanel(panel: PanelName): void {
  store.set({ panel });
}

export function toggleHelp(): void {
  store.set({ isHelpShown: !store.state.isHelpShown });
}
