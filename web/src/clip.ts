// SPDX-License-Identifier: BSD-3-Clause
// A part of a recording that is taken away as a video.

/** Frames from 0, the last among them. */
export interface FrameRange {
  first: number;
  last: number;
}

export type ClipKind = "clip" | "overlays";

/** The whole recording, when no part of it was chosen. */
export function wholeOr(range: FrameRange | null, frames: number): FrameRange {
  return range ?? { first: 0, last: Math.max(frames - 1, 0) };
}

/** A part that begins there; one that would have ended before ends there, too. */
export function withFirst(range: FrameRange, frame: number): FrameRange {
  return { first: frame, last: Math.max(range.last, frame) };
}

export function withLast(range: FrameRange, frame: number): FrameRange {
  return { first: Math.min(range.first, frame), last: frame };
}

export function clipPath(kind: ClipKind, { first, last }: FrameRange): string {
  return `/export/${kind}-${first}-${last}.mp4`;
}

/** What a file is to be saved by: what the server calls it, or the end of its path. */
export function fileName(disposition: string | null, path: string): string {
  return disposition?.match(/filename="([\w.-]+)"/)?.[1] ?? path.split("/").at(-1)!;
}

/** Waits until the server has made it, and saves it. Throws an error that says why it is not made. */
export async function saveClip(kind: ClipKind, range: FrameRange, signal: AbortSignal): Promise<void> {
  const path = clipPath(kind, range);
  const answer = await fetch(path, { signal });
  if (!answer.ok) throw new Error((await answer.text()).trim());
  const link = document.createElement("a");
  link.href = URL.createObjectURL(await answer.blob());
  link.download = fileName(answer.headers.get("Content-Disposition"), path);
  link.click();
  URL.revokeObjectURL(link.href);
}
