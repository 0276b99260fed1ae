// SPDX-License-Identifier: BSD-3-Clause
import type { Colors, Stroke, Tool } from "./color_protocol";

/** What this browser shows of the page of colours, and what it marks with. */
export interface ColorView {
  frame: number;
  tool: Tool;
  /** Of the brush: radius, pixels. */
  radius: number;
  /** Of growing: how much a channel may differ, of 255. */
  reach: number;
  /** What is marked is none of the model's colours. */
  isNone: boolean;
  showsLabels: boolean;
  showsMarks: boolean;
  /** Something that takes longer was asked for. */
  isBusy: boolean;
  /** This browser has asked for a frame to be kept, which it will show. */
  isKeeping: boolean;
}

export const firstColorView: ColorView = {
  frame: 0,
  tool: "brush",
  radius: 4,
  reach: 24,
  isNone: false,
  showsLabels: true,
  showsMarks: true,
  isBusy: false,
  isKeeping: false,
};

/** The next thing to do to teach a colour, in a line. */
export function nextColorStep(colors: Colors): string {
  if (colors.frames === 0) return "Keep a frame of the camera first (k)";
  if (colors.strokes === 0) return "First choose a colour, then paint over pixels that have it";
  if (colors.difference.length === 0) return "Paint more, or teach what is marked (e)";
  return "Look at the preview in other frames, then save the model (s)";
}

/** When the server has answered; of another recording it may have fewer frames. */
export function viewAfter(view: ColorView, colors: Colors): ColorView {
  const frame = view.isKeeping && !colors.refused ? colors.frames - 1 : view.frame;
  return { ...view, frame: frameInside(frame, colors), isBusy: false, isKeeping: false };
}

/** As the server takes them. */
export const sizeRange: Record<Tool, [number, number]> = {
  brush: [1, 200],
  rectangle: [0, 0],
  grow: [1, 100],
};
const maxPoints = 1000;

export function sizeOf(view: ColorView): number {
  return { brush: view.radius, rectangle: 0, grow: view.reach }[view.tool];
}

/** The tool made larger or smaller: by a quarter, at least by one. */
export function resized(view: ColorView, direction: 1 | -1): ColorView {
  const [min, max] = sizeRange[view.tool];
  const size = sizeOf(view);
  const next = Math.min(Math.max(size + direction * Math.max(1, Math.round(size / 4)), min), max);
  if (view.tool === "brush") return { ...view, radius: next };
  return view.tool === "grow" ? { ...view, reach: next } : view;
}

/** Whether frames of a camera can be kept to be marked. */
export function canKeep(colors: Colors | null): boolean {
  return colors !== null && colors.most_kept > 0;
}

export function frameInside(frame: number, colors: Colors): number {
  return Math.max(Math.min(frame, colors.frames - 1), 0);
}

/** The next frame with marks in a direction; null: there is none. */
export function nextMarked(colors: Colors, frame: number, direction: 1 | -1): number | null {
  const ahead = colors.marked.filter((one) => (one - frame) * direction > 0);
  return (direction === 1 ? ahead[0] : ahead.at(-1)) ?? null;
}

/** A stroke along points in pixels of the frame; null where there is nothing to mark. */
export function strokeOf(
  view: ColorView,
  color: string,
  way: [number, number][],
  width: number,
  height: number,
): Stroke | null {
  const inside = way.map(([u, v]): [number, number] => [
    Math.min(Math.max(Math.round(u), 0), width - 1),
    Math.min(Math.max(Math.round(v), 0), height - 1),
  ]);
  const first = inside[0];
  const last = inside.at(-1);
  if (!first || !last) return null;
  const points = { brush: thinned(inside), rectangle: [first, last], grow: [last] }[view.tool];
  return {
    frame: view.frame,
    color: view.isNone ? "" : color,
    tool: view.tool,
    size: sizeOf(view),
    points: points.flat(),
  };
}

// Without points where the last one is, and as many as the server takes.
function thinned(way: [number, number][]): [number, number][] {
  const moves = way.filter(([u, v], i) => {
    const before = way[i - 1];
    return !before || before[0] !== u || before[1] !== v;
  });
  if (moves.length <= maxPoints) return moves;
  return Array.from(
    { length: maxPoints },
    (_, i) => moves[Math.round((i * (moves.length - 1)) / (maxPoints - 1))] ?? [0, 0],
  );
}
