// SPDX-License-Identifier: BSD-3-Clause
// What a user can do on the page of colours, by button or key.
import type { ColorRequest, Tool } from "./color_protocol";
import { canKeep, frameInside, nextMarked, resized, strokeOf, type ColorView } from "./color_view";
import { connection } from "./connection";
import { store } from "./store";

export function setView(change: Partial<ColorView>): void {
  store.set({ colorView: { ...store.state.colorView, ...change } });
}

export function showFrame(frame: number): void {
  const { colors } = store.state;
  if (colors) setView({ frame: frameInside(frame, colors) });
}

export function stepFrame(frames: number): void {
  showFrame(store.state.colorView.frame + frames);
}

export function showMarked(direction: 1 | -1): void {
  const { colors, colorView } = store.state;
  const frame = colors && nextMarked(colors, colorView.frame, direction);
  if (frame !== null) showFrame(frame);
}

export function setTool(tool: Tool): void {
  setView({ tool });
}

export function resize(direction: 1 | -1): void {
  setView(resized(store.state.colorView, direction));
}

/** Looks at a colour and marks it from now on. */
export function chooseColor(color: string | undefined): void {
  if (color === undefined) return;
  setView({ isNone: false });
  if (color !== store.state.colors?.color) connection.colors({ colors: "choose", color });
}

/** Marks along points in pixels of the frame. */
export function mark(way: [number, number][], width: number, height: number): void {
  const { colors, colorView } = store.state;
  const stroke = colors && strokeOf(colorView, colors.color, way, width, height);
  if (stroke) ask({ colors: "mark", ...stroke });
}

export function undo(): void {
  ask({ colors: "undo" });
}

export function redo(): void {
  ask({ colors: "redo" });
}

export function teach(): void {
  const color = store.state.colors?.color;
  if (color !== undefined) ask({ colors: "teach", color });
}

export function revert(): void {
  ask({ colors: "revert" });
}

export function save(): void {
  ask({ colors: "save" });
}

/** Keeps the camera's newest image as a frame, and shows it. */
export function keepFrame(): void {
  if (!canKeep(store.state.colors)) return;
  ask({ colors: "keep" });
  setView({ isKeeping: true });
}

function ask(request: ColorRequest): void {
  setView({ isBusy: true });
  connection.colors(request);
}
