// SPDX-License-Identifier: BSD-3-Clause
import { seekTrouble, setSpeed, step, togglePlaying } from "../actions";
import { clockText, markAt, markInWords } from "../timeline";
import { useStore } from "../use_store";
import { Scrubber } from "./scrubber";

const speeds = [0.1, 0.25, 0.5, 1, 2, 5, 10];
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
      </div>
      <p class="replay-time">
          {clockText(timeline.times_ms[frame] ?? 0)} / {clockText(timeline.times_ms.at(-1) ?? 0)},
          frame {frame + 1} of {timeline.times_ms.length}, {markInWords(markAt(timeline, frame))}
          {second?.state === "done" && `, second run: ${markInWords(markAt(second, frame))}`}
      </p>
      <Scrubber timeline={timeline} second={second?.state === "done" ? second.marks : null} frame={frame} />
    </section>
  );
}
