// SPDX-License-Identifier: BSD-3-Clause
// The state of a calibration that the server sends, as src/kestrel/app/console/messages/calibration_json.cc
// writes it, and its presentation in the page.

/** A quantity before and after; null where it is not known, a sigma of 0 where it was held. */
export interface CalibrationNumber {
  name: string;
  unit: string;
  before: number | null;
  after: number | null;
  sigma: number | null;
}

export interface Residuals {
  of: string;
  unit: string;
  over: string;
  rms_before: number | null;
  rms_after: number | null;
  /** Over, before, after. */
  points: (number | null)[][];
}

export interface Calibration {
  kind: "calibration";
  state: "none" | "running" | "done" | "cancelled" | "refused";
  number: number;
  asked: string[];
  done: number;
  of: number;
  /** It was cancelled, and goes on for a while. */
  ending: boolean;
  error: string;
  width: number;
  height: number;
  /** x and y in turn, pixels. */
  places: number[];
  distance_name: string;
  distances_m: number[];
  coverage: string;
  numbers: CalibrationNumber[];
  residuals: Residuals;
  warnings: string[];
  can_save: boolean;
  /** Why the result is not worth keeping; else empty. */
  no_use: string;
  saved: string;
  save_error: string;
}

export const subjects = ["mount", "clock", "mount and clock", "lens"] as const;
export type Subject = (typeof subjects)[number];

export const advice: Record<Subject, string> = {
  mount: "From a slow flight around a pattern that stands, at several heights and headings.",
  clock: "From a flight with quick tilts and turns.",
  "mount and clock": "From one flight that tells both: quick tilts and turns, at several heights and sides.",
  lens: "From views of the pattern near and far, tilted to all sides, and in all of the image.",
};

/** The words in which the server is asked. */
export function wordsOf(subject: Subject, isMoving: boolean): string[] {
  if (subject === "lens") return ["lens"];
  const words: string[] = subject === "mount and clock" ? ["mount", "clock"] : [subject];
  return isMoving ? [...words, "moving"] : words;
}

export function subjectInWords(asked: string[]): string {
  const words = asked.filter((word) => word !== "moving").join(" and ");
  return asked.includes("moving") ? `${words}, the pattern moves` : words;
}

/** How far it is, in words. */
export function progressInWords({ done, of, ending }: Calibration): string {
  if (ending) return "Ending: what goes on takes a moment";
  return done < of ? `Looking at image ${done} of ${of}` : "Estimating: the replay goes on meanwhile";
}

/** With as many digits as the uncertainty leaves it. */
export function valueText(value: number | null, sigma: number | null): string {
  if (value === null) return "–";
  const isTold = sigma !== null && sigma > 0;
  const digits = isTold ? Math.min(Math.max(1 - Math.floor(Math.log10(sigma)), 0), 7) : 4;
  return value.toFixed(digits);
}

export function sigmaText(sigma: number | null): string {
  if (sigma === null) return "not told";
  return sigma === 0 ? "held" : `± ${valueText(sigma, sigma)}`;
}

export interface Bar {
  from: number;
  to: number;
  count: number;
}

/** How often values are in each of so many ranges of the same width. */
export function barsOf(values: number[], count: number): Bar[] {
  if (values.length === 0) return [];
  const low = Math.min(...values);
  const width = (Math.max(...values) - low || 1) / count;
  const bars = Array.from({ length: count }, (_, i) => ({
    from: low + i * width,
    to: low + (i + 1) * width,
    count: 0,
  }));
  for (const value of values) bars[Math.min(Math.floor((value - low) / width), count - 1)]!.count += 1;
  return bars;
}

/** Decades around positive numbers, at least one. */
export function decadesAround(values: number[]): [number, number] {
  const positive = values.filter((value) => value > 0);
  if (positive.length === 0) return [-1, 0];
  const low = Math.floor(Math.log10(Math.min(...positive)));
  const high = Math.ceil(Math.log10(Math.max(...positive)));
  return [Math.max(low, high - 4), Math.max(high, low + 1)];
}
