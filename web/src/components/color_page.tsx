// SPDX-License-Identifier: BSD-3-Clause
import {
  chooseColor,
  redo,
  resize,
  setTool,
  setView,
  showFrame,
  showMarked,
  stepFrame,
  undo,
} from "../color_actions";
import { shownAs } from "../color_overlay";
import { tools, type Colors } from "../color_protocol";
import { canKeep, sizeOf } from "../color_view";
import { useStore } from "../use_store";
import { ColorCamera } from "./color_camera";
import { ColorCanvas } from "./color_canvas";
import { ColorPanel } from "./color_panel";
import { ColorPlane } from "./color_plane";

/** Teaches the colours of a model by marking pixels in frames of a recording, or kept of a flight. */
export function ColorPage() {
  const colors = useStore((state) => state.colors);
  if (!colors) return <p class="empty-page">The colours are not known yet</p>;
  return (
    <main class="colors">
      <div class="column">
        <section aria-label="Mark">
          <ColorChoice colors={colors} />
          <ToolChoice colors={colors} />
          {colors.frames > 0 ? <ColorCanvas colors={colors} /> : <NoFrame />}
          {colors.frames > 0 && <FrameChoice colors={colors} />}
        </section>
      </div>
      <div class="column">
        {canKeep(colors) && <ColorCamera colors={colors} />}
        <ColorPanel colors={colors} />
        <ColorPlane colors={colors} />
      </div>
    </main>
  );
}

function NoFrame() {
  return (
    <div class="screen">
      <p class="empty">No frame is kept yet: keep one of the camera to mark its colours (k)</p>
    </div>
  );
}

function ColorChoice({ colors }: { colors: Colors }) {
  const isNone = useStore((state) => state.colorView.isNone);
  return (
    <div class="switches" role="group" aria-label="Mark as">
      {colors.names.map((name, i) => (
        <button key={name} aria-pressed={!isNone && name === colors.color} onClick={() => chooseColor(name)}>
          <span class="swatch" style={{ background: `rgb(${shownAs(name, i).join(",")})` }} />
          {name}
        </button>
      ))}
      <button aria-pressed={isNone} onClick={() => setView({ isNone: true })}>
        none of them
      </button>
    </div>
  );
}

function ToolChoice({ colors }: { colors: Colors }) {
  const view = useStore((state) => state.colorView);
  const hasSize = view.tool !== "rectangle";
  return (
    <div class="switches" role="group" aria-label="Tool">
      {tools.map((tool) => (
        <button key={tool} aria-pressed={view.tool === tool} onClick={() => setTool(tool)}>
          {tool}
        </button>
      ))}
      <button disabled={!hasSize} aria-label="smaller" onClick={() => resize(-1)}>
        −
      </button>
      <span class="tool-size">{hasSize ? `${sizeOf(view)}${view.tool === "brush" ? " px" : " of 255"}` : "–"}</span>
      <button disabled={!hasSize} aria-label="larger" onClick={() => resize(1)}>
        +
      </button>
      <button disabled={colors.strokes === 0} onClick={undo}>
        Undo
      </button>
      <button disabled={!colors.can_redo} onClick={redo}>
        Redo
      </button>
      <button aria-pressed={view.showsLabels} onClick={() => setView({ showsLabels: !view.showsLabels })}>
        preview
      </button>
      <button aria-pressed={view.showsMarks} onClick={() => setView({ showsMarks: !view.showsMarks })}>
        marks
      </button>
    </div>
  );
}

function FrameChoice({ colors }: { colors: Colors }) {
  const frame = useStore((state) => state.colorView.frame);
  return (
    <div class="replay-buttons">
      <button onClick={() => showMarked(-1)}>◀ marked</button>
      <button onClick={() => stepFrame(-1)}>−1 frame</button>
      <input
        type="range"
        aria-label="Frame"
        min={1}
        max={colors.frames}
        value={frame + 1}
        onInput={(event) => showFrame(Number(event.currentTarget.value) - 1)}
      />
      <button onClick={() => stepFrame(1)}>+1 frame</button>
      <button onClick={() => showMarked(1)}>marked ▶</button>
      <span class="replay-time">
        frame {frame + 1} of {colors.frames}; marks: {colors.strokes}, marked frames: {colors.marked.length}
      </span>
    </div>
  );
}
