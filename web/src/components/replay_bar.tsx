// SPDX-License-Identifier: BSD-3-Clause
import { useEffect, useRef } from "preact/hooks";
import { seekFrame, seekTrouble, setSpeed, step, togglePlaying } from "../actions";
import type { Timeline } from "../protocol";
import { themeColor } from "../theme";
import {
  clockText,
  columnMarks,
  fractionOf,
  frameAt,
  frameAtFraction,
  markAt,
  markInWords,
  type Mark,
} from "../timeline";
import { useStore } from "../use_store";

const speeds = [0.1, 0.25, 0.5, 1, 2, 5, 10];
/** How high a mark is drawn, so that they are told apart without colour. */
const markHeights: Record<Mark, number> = { "-": 0.1, f: 0.4, l: 0.7, x: 1 };
const markColors: Record<Mark, string> = { "-": "muted", f: "good", l: "doubtful", x: "wrong" };

/** A recording's timeline, where each frame is marked by what became of it. */
export function ReplayBar() {
  const timeline = useStore((state) => state.timeline);
  const playback = useStore((state) => state.playback);
  const second = useStore((state) => state.second);
  if (!timeline) return null;
  const frame = playback?.frame ?? 0;
  const speed = playback?.speed ?? 0;
  return (
    <section class="replay" aria-label="Replay">
      <div class="replay-buttons">
        <button onClick={() => seekTrouble(-1)}>◀ trouble</button>
        <button onClick={() => step(-1)}>−1 frame</button>
        <button onClick={togglePlaying}>{speed === 0 ? "Play" : "Hold"}</button>
        <button onClick={() => step(1)}>+1 frame</button>
        <button onClick={() => seekTrouble(1)}>trouble ▶</button>
        <label>
          Speed{" "}
          <select
            value={speed === 0 ? 1 : speed}
            onChange={(event) => setSpeed(Number(event.currentTarget.value))}
          >
            {speeds.map((one) => (
              <option key={one} value={one}>
                {one}×
              </option>
            ))}
          </select>
        </label>
        <span class="replay-time">
          {clockText(timeline.times_ms[frame] ?? 0)} / {clockText(timeline.times_ms.at(-1) ?? 0)},
          frame {frame + 1} of {timeline.times_ms.length}, {markInWords(markAt(timeline, frame))}
          {second?.state === "done" && `, second run: ${markInWords(markAt(second, frame))}`}
        </span>
      </div>
      <ExportLinks frame={frame} hasSecond={second?.state === "done"} />
      <Scrubber timeline={timeline} second={second?.state === "done" ? second.marks : null} frame={frame} />
    </section>
  );
}

/** What can be taken away: the frame that is shown, and the tables of what was found. */
function ExportLinks({ frame, hasSecond }: { frame: number; hasSecond: boolean }) {
  const isOffered = useStore((state) => state.hello?.exports ?? false);
  if (!isOffered) return null;
  return (
    <p class="exports">
      Save: <a href={`/export/frame-${frame}.png`} download>frame</a>
      <a href={`/export/overlays-${frame}.png`} download>frame with overlays</a>
      <a href="/export/detections-1.csv" download>detections (CSV)</a>
      {hasSecond && <a href="/export/detections-2.csv" download>second run's detections (CSV)</a>}
    </p>
  );
}

interface ScrubberProps {
  timeline: Timeline;
  /** Marks of the second run; null: there is none. */
  second: string | null;
  frame: number;
}

function Scrubber({ timeline, second, frame }: ScrubberProps) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const theme = useStore((state) => state.theme);
  useEffect(() => {
    if (canvas.current) drawTimeline(canvas.current, timeline, second, frame);
  }, [timeline, second, frame, theme]);
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
function drawTimeline(canvas: HTMLCanvasElement, timeline: Timeline, second: string | null, frame: number): void {
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
  context.fillStyle = themeColor("text");
  context.fillRect(fractionOf(timeline, frame) * (width - 2) - 1, 0, 3, height);
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
