// SPDX-License-Identifier: BSD-3-Clause
import { useEffect, useRef, useState } from "preact/hooks";
import { showView, toggleLayer, togglePlaying } from "../actions";
import { connection, type Picture } from "../connection";
import { drawOverlay, layerColor } from "../overlay";
import type { FrameHeader, Layer } from "../protocol";
import { store } from "../store";
import { useClock, useStore } from "../use_store";

/** Older than this, a live picture is not what the UAV sees now. */
const staleMs = 500;

const noLayers: Layer[] = [];
const noViews: string[] = [];

interface Shown {
  header: FrameHeader;
  receivedAt: number;
}

/** The newest frame with what was found in it. */
export function ImageView() {
  const canvas = useRef<HTMLCanvasElement>(null);
  const [shown, setShown] = useState<Shown | null>(null);
  usePictures(canvas, setShown);
  return (
    <section class="image" aria-label="Image">
      <div class="screen">
        <canvas ref={canvas} role="img" aria-label={pictureInWords(shown)} />
        {shown === null && <p class="empty">No image yet</p>}
      </div>
      <ViewChoice />
      <div class="image-bar">
        <LayerSwitches />
        <PictureAge shown={shown} />
      </div>
    </section>
  );
}

function pictureInWords(shown: Shown | null): string {
  if (shown === null) return "no image yet";
  const picture = shown.header.view === "" ? "camera image" : shown.header.view;
  const found = shown.header.shapes.filter(({ layer, label }) => layer === "detection" && label !== "");
  if (found.length === 0) return `${picture}, nothing found`;
  return `${picture}, found: ${found.map((shape) => shape.label).join(", ")}`;
}

// The next picture is asked for when this one is on the screen, so that none waits anywhere.
function usePictures(
  canvas: { current: HTMLCanvasElement | null },
  setShown: (shown: Shown) => void,
): void {
  useEffect(() => {
    let picture: Picture | null = null;
    const draw = () => {
      if (picture && canvas.current) drawPicture(canvas.current, picture);
    };
    connection.onPicture = (next) => {
      requestAnimationFrame(() => {
        picture?.bitmap.close();
        picture = next;
        draw();
        setShown({ header: next.header, receivedAt: next.receivedAt });
        connection.drawn(next.header);
      });
    };
    let { layers: drawnLayers, view, isFrozen } = store.state;
    const want = () => connection.wantImages({ view, isHeld: isFrozen });
    const unsubscribe = store.subscribe(() => {
      const { state } = store;
      if (state.layers !== drawnLayers) {
        drawnLayers = state.layers;
        draw();
      }
      if (state.view === view && state.isFrozen === isFrozen) return;
      ({ view, isFrozen } = state);
      want();
    });
    want();
    return () => {
      connection.wantImages(null);
      connection.onPicture = null;
      unsubscribe();
    };
  }, []);
}

// The canvas is at least so wide that lines and words over a small frame are fine.
function drawPicture(canvas: HTMLCanvasElement, { header, bitmap }: Picture): void {
  const scale = Math.max(1, Math.round(1280 / header.width));
  canvas.width = header.width * scale;
  canvas.height = header.height * scale;
  const context = canvas.getContext("2d");
  if (!context) return;
  context.imageSmoothingEnabled = scale === 1;
  context.drawImage(bitmap, 0, 0, canvas.width, canvas.height);
  const unit = canvas.width / Math.max(canvas.clientWidth, 1);
  drawOverlay(context, header.shapes, store.state.layers, scale, unit);
}

/** The camera's image, or what the detector makes of it. */
function ViewChoice() {
  const chosen = useStore((state) => state.view);
  const views = useStore((state) => state.hello?.views ?? noViews);
  if (views.length === 0) return null;
  return (
    <div class="switches views" role="group" aria-label="View">
      {["", ...views].map((view) => (
        <button key={view} aria-pressed={view === chosen} onClick={() => showView(view)}>
          {view === "" ? "camera" : view}
        </button>
      ))}
    </div>
  );
}

function LayerSwitches() {
  const isOn = useStore((state) => state.layers);
  const layers = useStore((state) => state.hello?.layers ?? noLayers);
  const isFrozen = useStore((state) => state.isFrozen);
  const isLive = useStore((state) => state.hello?.live ?? true);
  return (
    <div class="switches" role="group" aria-label="Overlay">
      {layers.map((layer: Layer) => (
        <button key={layer} aria-pressed={isOn[layer]} onClick={() => toggleLayer(layer)}>
          <span class="swatch" style={{ background: layerColor(layer) }} />
          {layer}
        </button>
      ))}
      {isLive && (
        <button aria-pressed={isFrozen} onClick={togglePlaying}>
          freeze
        </button>
      )}
    </div>
  );
}

function PictureAge({ shown }: { shown: Shown | null }) {
  useClock(5);
  const isFrozen = useStore((state) => state.isFrozen);
  if (shown === null || shown.header.age_ms === null) return null;
  const age = shown.header.age_ms + performance.now() - shown.receivedAt;
  const text = age < 10000 ? `${age.toFixed(0)} ms old` : `${(age / 1000).toFixed(0)} s old`;
  return (
    <p class="age" data-stale={age > staleMs}>
      Frame {shown.header.sequence}, {text}
      {isFrozen && ", frozen"}
    </p>
  );
}
