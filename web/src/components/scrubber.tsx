// SPDX-License-Identifier: BSD-3-Clause
import { useEffect, useRef } from "preact/hooks";
import { seekFrame } from "../actions";
import type { FrameRange } from "../clip";
import type { Timeline } from "../protocol";
import { themeColor } from "../theme";
import { columnMarks, fractionOf, frameAt, frameAtFraction, markAt, markInWords, type Mark } from "../timeline";
import { useStore } from "../use_store";

/** How high a mark is drawn, so that they are told apart without colour. */
const markHeights: Record<Mark, number> = { "-": 0.1, f: 0.4, l: 0.7, x: 1 };
const markColors: Record<Mark, string> = { "-": "muted", f: "good", l: "doubtful", x: "wrong" };

interface ScrubberProps {
  timeline: Timeline;
  /** Marks of the second run; null: there is none. */
  second: string | null;
  frame: number;
}

/** The timeline, on which a frame is chosen; the part that a clip is made of lies between two marks. */
export function Scrubber({ timeline, second, frame }: ScrubberProps) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const theme = useStore((state) => state.theme);
  const clip = useStore((state) => state.clipRange);
  useEffect(() => {
    if (canvas.current) drawTimeline(canvas.current, timeline, second, frame, clip);
  }, [timeline, second, frame, theme, clip]);
  const seekTo = (event: PointerEvent) => {
    if (!canvas.current || event.buttons === 0) return;
    const box = canvas.current.getBoundingClientRect();
    seekFrame(frameAtFraction(timeline, (event.clientX - box.left) / box.width));
  };
  return (
    <canvas
      ref={canvas}
      class={second === null ? "scrubber" : "scrubber two-tracks"}
      role="slider"
      tabIndex={0}
      aria-label="Timeline"
      aria-valuemin={1}
      aria-valuemax={timeline.times_ms.length}
      aria-valuenow={frame + 1}
      aria-valuetext={`frame ${frame + 1}, ${markInWords(markAt(timeline, frame))}`}
      onPointerDown={(event) => {
        event.currentTarget.setPointerCapture(event.pointerId);
        seekTo(event);
      }}
      onPointerMove={seekTo}
      onKeyDown={(event) => {
        const next = frameForKey(event.key, timeline, frame);
        if (next === null) return;
        event.preventDefault();
        seekFrame(next);
      }}
    />
  );
}

function frameForKey(key: string, timeline: Timeline, frame: number): number | null {
  const last = timeline.times_ms.length - 1;
  const time = timeline.times_ms[frame] ?? 0;
  switch (key) {
    case "ArrowLeft":
      return Math.max(frame - 1, 0);
    case "ArrowRight":
      return Math.min(frame + 1, last);
    case "PageDown":
      return frameAt(timeline, time - 5000);
    case "PageUp":
      return frameAt(timeline, time + 5000);
    case "Home":
      return 0;
    case "End":
      return last;
    default:
      return null;
  }
}

/** The first run's marks; of two runs the first's above the second's. */
function drawTimeline(
  canvas: HTMLCanvasElement,
  timeline: Timeline,
  second: string | null,
  frame: number,
  clip: FrameRange | null,
): void {
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  canvas.width = width;
  canvas.height = height;
  const context = canvas.getContext("2d");
  if (!context) return;
  if (second === null) {
    drawTrack(context, timeline, height, height);
  } else {
    const track = Math.floor(height / 2) - 1;
    drawTrack(context, timeline, track, track);
    drawTrack(context, { ...timeline, marks: second }, height, track);
    context.fillStyle = themeColor("muted");
    context.fillRect(0, track, width, 1);
  }
  if (clip) drawClip(context, fractionOf(timeline, clip.first) * width, fractionOf(timeline, clip.last) * width);
  context.fillStyle = themeColor("text");
  context.fillRect(fractionOf(timeline, frame) * (width - 2) - 1, 0, 3, height);
}

// Between two brackets; what is not of the clip is covered.
function drawClip(context: CanvasRenderingContext2D, begin: number, end: number): void {
  const { width, height } = context.canvas;
  context.fillStyle = themeColor("panel");
  context.globalAlpha = 0.7;
  context.fillRect(0, 0, begin, height);
  context.fillRect(end, 0, width - end, height);
  context.globalAlpha = 1;
  context.strokeStyle = themeColor("accent");
  context.lineWidth = 3;
  for (const [x, inwards] of [[Math.max(begin, 2), 7], [Math.min(end, width - 2), -7]] as const) {
    context.beginPath();
    context.moveTo(x + inwards, 2);
    context.lineTo(x, 2);
    context.lineTo(x, height - 2);
    context.lineTo(x + inwards, height - 2);
    context.stroke();
  }
}

function drawTrack(context: CanvasRenderingContext2D, timeline: Timeline, bottom: number, height: number): void {
  let last: Mark | null = null;
  columnMarks(timeline, context.canvas.width).forEach((mark, x) => {
    last = mark ?? last;
    if (last === null) return;
    context.fillStyle = themeColor(markColors[last]);
    context.fillRect(x, bottom, 1, -height * markHeights[last]);
  });
}
