// SPDX-License-Identifier: BSD-3-Clause
import { useRef, useState } from "preact/hooks";
import { beginClipHere, clipAll, endClipHere } from "../actions";
import { saveClip, wholeOr, type ClipKind } from "../clip";
import type { Timeline } from "../protocol";
import { clockText } from "../timeline";
import { useStore } from "../use_store";

/** The downloads: the frame that is shown, the tables of what was found, a clip. */
export function ExportPanel() {
  const timeline = useStore((state) => state.timeline);
  const frame = useStore((state) => state.playback?.frame ?? 0);
  const hasSecond = useStore((state) => state.second?.state === "done");
  if (!timeline) return null;
  return (
    <section class="export" aria-label="Save">
      <p class="exports">
        Save: <a href={`/export/frame-${frame}.png`} download>frame</a>
        <a href={`/export/overlays-${frame}.png`} download>frame with overlays</a>
        <a href="/export/detections-1.csv" download>detections (CSV)</a>
        {hasSecond && <a href="/export/detections-2.csv" download>second run's detections (CSV)</a>}
      </p>
      <ClipChooser timeline={timeline} />
    </section>
  );
}

function ClipChooser({ timeline }: { timeline: Timeline }) {
  const chosen = useStore((state) => state.clipRange);
  const { first, last } = wholeOr(chosen, timeline.times_ms.length);
  const [error, setError] = useState("");
  const [isWaiting, setIsWaiting] = useState(false);
  const abort = useRef<AbortController | null>(null);
  const save = async (kind: ClipKind) => {
    abort.current = new AbortController();
    setError("");
    setIsWaiting(true);
    try {
      await saveClip(kind, { first, last }, abort.current.signal);
    } catch (reason) {
      if (!abort.current.signal.aborted) setError(String((reason as Error).message));
    }
    setIsWaiting(false);
  };
  const clockAt = (frame: number) => clockText(timeline.times_ms[frame] ?? 0);
  return (
    <div class="clip replay-buttons" role="group" aria-label="Clip">
      <span class="clip-range">
        Clip: frames {first + 1} to {last + 1} ({clockAt(first)} to {clockAt(last)})
      </span>
      <button onClick={beginClipHere}>Begin here</button>
      <button onClick={endClipHere}>End here</button>
      <button onClick={clipAll} disabled={chosen === null}>
        All
      </button>
      <button onClick={() => void save("clip")} disabled={isWaiting}>
        Save clip
      </button>
      <button onClick={() => void save("overlays")} disabled={isWaiting}>
        Save clip with overlays
      </button>
      {isWaiting && <ClipProgress onCancel={() => abort.current?.abort()} />}
      {error !== "" && <p role="alert">{error}</p>}
    </div>
  );
}

function ClipProgress({ onCancel }: { onCancel: () => void }) {
  const progress = useStore((state) => state.clip);
  return (
    <>
      <span role="status">
        {progress && progress.frames > 0 ? `${progress.done} of ${progress.frames} frames` : "on its way"}
      </span>
      <button onClick={onCancel}>Cancel</button>
    </>
  );
}
