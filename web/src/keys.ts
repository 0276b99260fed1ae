// SPDX-License-Identifier: BSD-3-Clause
import {
  isOffered,
  nextTheme,
  seekDifference,
  seekTrouble,
  step,
  takeSnapshot,
  toggleHelp,
  toggleLayer,
  togglePlaying,
  toggleRecording,
} from "./actions";
import { toggleCalibrationPage } from "./calibration_actions";
import { layers, type CommandName } from "./protocol";
import { store } from "./store";

export interface Key {
  keys: string[];
  meaning: string;
  /** Whether this server has something that it does; always, when it is not said. */
  isOffered?: () => boolean;
  act: () => void;
}

const has = (name: CommandName) => () => isOffered(name);

export const keys: Key[] = [
  ...layers.map((layer, i) => ({
    keys: [String(i + 1)],
    meaning: `show ${layer}`,
    isOffered: () => store.state.hello?.layers.includes(layer) ?? false,
    act: () => toggleLayer(layer),
  })),
  { keys: ["k"], meaning: "freeze the image; play or hold a recording", act: togglePlaying },
  { keys: ["."], meaning: "a frame forward", isOffered: has("step"), act: () => step(1) },
  { keys: [","], meaning: "a frame back", isOffered: has("step"), act: () => step(-1) },
  { keys: ["n"], meaning: "to the next lost or false frames", isOffered: has("seek"), act: () => seekTrouble(1) },
  { keys: ["p"], meaning: "to those before", isOffered: has("seek"), act: () => seekTrouble(-1) },
  { keys: ["d"], meaning: "to the next frame where two runs differ", isOffered: has("detect"), act: () => seekDifference(1) },
  { keys: ["D"], meaning: "to the one before", isOffered: has("detect"), act: () => seekDifference(-1) },
  { keys: ["c"], meaning: "calibration, or back to the replay", isOffered: has("calibrate"), act: toggleCalibrationPage },
  { keys: ["r"], meaning: "start or stop recording", isOffered: has("record"), act: toggleRecording },
  { keys: ["s"], meaning: "keep a snapshot", isOffered: has("snapshot"), act: takeSnapshot },
  { keys: ["t"], meaning: "next theme: auto, light, dark, sun", act: nextTheme },
  { keys: ["?", "h"], meaning: "show or hide these keys", act: toggleHelp },
];

export function handleKey(event: KeyboardEvent): void {
  // What is typed into a form is no key of these.
  if (event.target instanceof HTMLInputElement || event.target instanceof HTMLSelectElement) return;
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  if (event.key === "Escape" && store.state.isHelpShown) return toggleHelp();
  const key = keys.find((one) => one.keys.includes(event.key) && (one.isOffered?.() ?? true));
  if (!key) return;
  event.preventDefault();
  key.act();
}
