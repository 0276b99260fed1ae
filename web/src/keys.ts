// SPDX-License-Identifier: BSD-3-Clause
import {
  beginClipHere,
  clipAll,
  endClipHere,
  isOffered,
  nextTheme,
  seekDifference,
  seekTrouble,
  step,
  takeSnapshot,
  toggleBeside,
  toggleHelp,
  toggleLayer,
  togglePlaying,
  toggleRecording,
  toggleTeam,
  turnView,
} from "./actions";
import { colorKeys } from "./color_keys";
import { offeredPages, togglePage } from "./pages";
import { layers, type CommandName } from "./protocol";
import { store } from "./store";

export interface Key {
  keys: string[];
  meaning: string;
  /** Whether this server has something that it does; always, when it is not said. */
  isOffered?: () => boolean;
  act: () => void;
}

const hasExports = () => store.state.hello?.exports ?? false;
const has = (name: CommandName) => () => isOffered(name);

const hasViews = () => (store.state.hello?.views.length ?? 0) > 0;

const mainKeys: Key[] = [
  ...layers.map((layer, i) => ({
    keys: [String(i + 1)],
    meaning: `show ${layer}`,
    isOffered: () => store.state.hello?.layers.includes(layer) ?? false,
    act: () => toggleLayer(layer),
  })),
  { keys: ["v"], meaning: "next view of the image", isOffered: hasViews, act: () => turnView(1) },
  { keys: ["V"], meaning: "the view before", isOffered: hasViews, act: () => turnView(-1) },
  {
    keys: ["m"],
    meaning: "show the team's objects on the map",
    isOffered: () => store.state.team !== null,
    act: toggleTeam,
  },
  { keys: ["k", " "], meaning: "freeze the image; play or hold a recording", act: togglePlaying },
  { keys: ["."], meaning: "a frame forward", isOffered: has("step"), act: () => step(1) },
  { keys: [","], meaning: "a frame back", isOffered: has("step"), act: () => step(-1) },
  { keys: ["n"], meaning: "to the next lost or false frames", isOffered: has("seek"), act: () => seekTrouble(1) },
  { keys: ["p"], meaning: "to those before", isOffered: has("seek"), act: () => seekTrouble(-1) },
  { keys: ["d"], meaning: "to the next frame where two runs differ", isOffered: has("detect"), act: () => seekDifference(1) },
  { keys: ["D"], meaning: "to the one before", isOffered: has("detect"), act: () => seekDifference(-1) },
  {
    keys: ["b"],
    meaning: "two runs beside each other, or both over one picture",
    isOffered: has("detect"),
    act: toggleBeside,
  },
  { keys: ["i"], meaning: "a clip begins with this frame", isOffered: hasExports, act: beginClipHere },
  { keys: ["o"], meaning: "it ends with this one", isOffered: hasExports, act: endClipHere },
  { keys: ["a"], meaning: "a clip of the whole recording", isOffered: hasExports, act: clipAll },
  { keys: ["r"], meaning: "start or stop recording", isOffered: has("record"), act: toggleRecording },
  { keys: ["s"], meaning: "keep a snapshot", isOffered: has("snapshot"), act: takeSnapshot },
];

const commonKeys: Key[] = [
  {
    keys: ["c"],
    meaning: "to the page of colours and back",
    isOffered: () => offeredPages().includes("colors"),
    act: () => togglePage("colors"),
  },
  {
    keys: ["l"],
    meaning: "to the page of calibrations and back",
    isOffered: () => offeredPages().includes("calibration"),
    act: () => togglePage("calibration"),
  },
  {
    keys: ["w"],
    meaning: "to the study's table and back",
    isOffered: () => offeredPages().includes("study") && offeredPages().length > 1,
    act: () => togglePage("study"),
  },
  { keys: ["t"], meaning: "next theme: auto, light, dark, sun", act: nextTheme },
  { keys: ["?", "h"], meaning: "show or hide these keys", act: toggleHelp },
];

/** Those of the page that is shown. */
export function keys(): Key[] {
  const ofPage = store.state.page === "colors" ? colorKeys() : mainKeys;
  return [...ofPage, ...commonKeys].filter((key) => key.isOffered?.() ?? true);
}

// What is typed into a form is no key of these.
function isTyping(target: EventTarget | null): boolean {
  return (target instanceof HTMLInputElement && target.type !== "range") || target instanceof HTMLSelectElement;
}

export function handleKey(event: KeyboardEvent): void {
  if (isTyping(event.target)) return;
  if (event.key === " " && event.target instanceof HTMLButtonElement) return; // presses the button
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  if (event.key === "Escape" && store.state.isHelpShown) return toggleHelp();
  const key = keys().find((one) => one.keys.includes(event.key));
  if (!key) return;
  event.preventDefault();
  key.act();
}
