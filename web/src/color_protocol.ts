// SPDX-License-Identifier: BSD-3-Clause
// The state of the colours that the server sends, and the requests for it, as
// src/kestrel/app/console/messages/color_json.h and color_request.h define them.

/** A Gaussian of a colour's mixture; hue in degrees, saturation 0 to 1. */
export interface ColorComponent {
  weight: number;
  hue: number;
  saturation: number;
  sigma_hue: number;
  sigma_saturation: number;
  correlation: number;
}

export interface Colors {
  kind: "colors";
  /** Another one when the marks or the model have changed, and with them the pictures. */
  revision: number;
  /** Of the recording, or that are kept of a flight. */
  frames: number;
  /** Of a flight's frames; 0: of a recording. */
  most_kept: number;
  /** In the order of the labels, from 1. */
  names: string[];
  /** That is looked at. */
  color: string;
  marked: number[];
  strokes: number;
  can_redo: boolean;
  /** Rows of 72 hues, from the lowest of 25 saturations. */
  histogram: number[];
  /** Where a strip of hues begins, degrees, so that it does not cut the colour. */
  cut_hue: number;
  components: ColorComponent[];
  /** At which a component ends, standard deviations. */
  max_distance: number;
  warnings: string[];
  /** Of the model to the file's, in lines. */
  difference: string[];
  file: string;
  versions: string[];
  /** To the last request, in words. */
  answer: string;
  refused: boolean;
}

export interface ColorScores {
  kind: "color-scores";
  revision: number;
  color: string;
  wanted: number;
  recall: number;
  others: number;
  false_share: number;
  overlaps: { color: string; share: number }[];
  left_outs: { frame: number; recall: number }[];
}

export const tools = ["brush", "rectangle", "grow"] as const;
export type Tool = (typeof tools)[number];

/** Points are u and v in turn, whole pixels of the frame; color "": none of the model's. */
export interface Stroke {
  frame: number;
  color: string;
  tool: Tool;
  size: number;
  points: number[];
}

export type ColorRequest =
  | { colors: "undo" | "redo" | "revert" | "save" | "keep" }
  | { colors: "choose" | "teach"; color: string }
  | ({ colors: "mark" } & Stroke);
