// SPDX-License-Identifier: BSD-3-Clause
import { useLayoutEffect, useMemo, useRef, useState } from "preact/hooks";
import { mark } from "../color_actions";
import { paintOverlay, shownAs } from "../color_overlay";
import type { Colors } from "../color_protocol";
import type { ColorView } from "../color_view";
import { useStore } from "../use_store";

type Point = [number, number];

interface Shown {
  frame: number;
  revision: number;
  picture: ImageBitmap;
  labels: Uint8Array;
  /** When it was asked for. */
  began: number;
}

/** A frame of the recording with what the detector takes its pixels for, to be marked. */
export function ColorCanvas({ colors }: { colors: Colors }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const way = useRef<Point[]>([]);
  const [cursor, setCursor] = useState<Point | null>(null);
  const view = useStore((state) => state.colorView);
  const [shown, error] = useFrame(view.frame, colors.revision);
  const size: Point = [shown?.picture.width ?? 0, shown?.picture.height ?? 0];
  const [took_ms, setTook] = useState(0);
  // Not for every change of the colours: labels of another model are on their way then.
  const reused = useRef<Layer | null>(null);
  const layer = useMemo(
    () => shown && (reused.current = layerOf(shown, colors, view, reused.current)),
    [shown, colors.names.join(), colors.color, view.showsLabels, view.showsMarks],
  );
  const draw = () => {
    if (canvas.current && shown && layer) drawFrame(canvas.current, shown.picture, layer.canvas, view, way.current, cursor);
  };
  // At once, not with the picture after the next.
  useLayoutEffect(draw, [shown, layer, view, cursor]);
  useLayoutEffect(() => {
    if (shown) setTook(performance.now() - shown.began);
  }, [shown]);
  const finish = () => {
    if (shown && way.current.length > 0) mark(way.current, ...size);
    way.current = [];
    draw();
  };
  const follow = (event: PointerEvent) => {
    if (!canvas.current || !shown) return;
    const box = canvas.current.getBoundingClientRect();
    way.current.push([
      ((event.clientX - box.left) / box.width) * size[0] - 0.5,
      ((event.clientY - box.top) / box.height) * size[1] - 0.5,
    ]);
    draw();
  };
  const press = (event: KeyboardEvent) => {
    const from = cursor ?? [Math.round(size[0] / 2), Math.round(size[1] / 2)];
    const next = cursorAfter(event, from, size);
    if (next) {
      setCursor(next);
    } else if (event.key === " " || event.key === "Enter") {
      setCursor(from);
      way.current.push(from);
      if (view.tool !== "rectangle" || way.current.length > 1) finish();
    } else if (event.key === "Escape" && way.current.length > 0) {
      way.current = [];
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
    draw();
  };
  return (
    <>
      <div class="screen">
        <canvas
          ref={canvas}
          tabIndex={0}
          role="application"
          aria-label={`Frame ${view.frame + 1}: arrows move, Space marks`}
          data-frame={shown?.frame}
          data-width={size[0]}
          data-revision={shown?.revision}
          onPointerDown={(event) => {
            if (event.button !== 0) return;
            event.currentTarget.setPointerCapture(event.pointerId);
            way.current = [];
            setCursor(null);
            follow(event);
          }}
          onPointerMove={(event) => {
            if (event.buttons !== 0 && way.current.length > 0) follow(event);
          }}
          onPointerUp={finish}
          onPointerCancel={() => {
            way.current = [];
          }}
          onKeyDown={press}
        />
        {!shown && <p class="empty">{error ?? "No image yet"}</p>}
      </div>
      <p class="preview-time">{shown && !error ? `Preview in ${took_ms.toFixed(0)} ms` : error}</p>
    </>
  );
}

/** The frame and its labels; anew when either has changed. Beside it, why there is none. */
function useFrame(frame: number, revision: number): [Shown | null, string | null] {
  const [shown, setShown] = useState<Shown | null>(null);
  const [error, setError] = useState<string | null>(null);
  const last = useRef<{ frame: number; picture: ImageBitmap } | null>(null);
  useLayoutEffect(() => {
    const stop = new AbortController();
    const load = async () => {
      const began = performance.now();
      const known = last.current?.frame === frame ? last.current.picture : null;
      const [picture, labels] = await Promise.all([
        known ?? fetchPicture(`/export/picture-${frame}.jpg`, stop.signal),
        fetchBytes(`/export/labels-${frame}.bin`, stop.signal),
      ]);
      if (stop.signal.aborted) return;
      last.current = { frame, picture };
      setError(null);
      setShown({ frame, revision, picture, labels: new Uint8Array(labels), began });
    };
    load().catch(() => {
      if (!stop.signal.aborted) setError(`Frame ${frame + 1} cannot be shown`);
    });
    return () => stop.abort();
  }, [frame, revision]);
  return [shown, error];
}

async function fetchBytes(path: string, signal: AbortSignal): Promise<ArrayBuffer> {
  const answer = await fetch(path, { signal });
  if (!answer.ok) throw new Error(path);
  return answer.arrayBuffer();
}

async function fetchPicture(path: string, signal: AbortSignal): Promise<ImageBitmap> {
  // The colours are looked at as the camera gave them.
  return createImageBitmap(new Blob([await fetchBytes(path, signal)]), { colorSpaceConversion: "none" });
}

function cursorAfter(event: KeyboardEvent, [u, v]: Point, [width, height]: Point): Point | null {
  const step = event.shiftKey ? 10 : 1;
  const moves: Record<string, Point | undefined> = {
    ArrowLeft: [-step, 0],
    ArrowRight: [step, 0],
    ArrowUp: [0, -step],
    ArrowDown: [0, step],
  };
  const move = moves[event.key];
  if (!move) return null;
  return [
    Math.min(Math.max(u + move[0], 0), width - 1),
    Math.min(Math.max(v + move[1], 0), height - 1),
  ];
}

/** Pixels, and a canvas that they are drawn by. */
interface Layer {
  canvas: OffscreenCanvas;
  image: ImageData;
}

/** What is drawn over the frame, in the layer before if it has the same size: megabytes of new memory cost much. */
function layerOf({ labels, picture }: Shown, colors: Colors, view: ColorView, before: Layer | null): Layer {
  const { width, height } = picture;
  const isOfThisSize = before?.image.width === width && before.image.height === height;
  const layer = before && isOfThisSize ? before : newLayer(width, height);
  paintOverlay(labels, layer.image, {
    showsLabels: view.showsLabels,
    showsMarks: view.showsMarks,
    chosen: colors.names.indexOf(colors.color) + 1,
    colors: colors.names.map(shownAs),
  });
  layer.canvas.getContext("2d")?.putImageData(layer.image, 0, 0);
  return { ...layer };
}

function newLayer(width: number, height: number): Layer {
  return { canvas: new OffscreenCanvas(width, height), image: new ImageData(width, height) };
}

function drawFrame(
  canvas: HTMLCanvasElement,
  picture: ImageBitmap,
  layer: OffscreenCanvas,
  view: ColorView,
  way: Point[],
  cursor: Point | null,
): void {
  const { width, height } = layer;
  const scale = Math.max(1, Math.round(1280 / width));
  if (canvas.width !== width * scale) canvas.width = width * scale;
  if (canvas.height !== height * scale) canvas.height = height * scale;
  const context = canvas.getContext("2d");
  if (!context) return;
  context.imageSmoothingEnabled = false;
  context.drawImage(picture, 0, 0, canvas.width, canvas.height);
  context.drawImage(layer, 0, 0, canvas.width, canvas.height);
  context.save();
  context.scale(scale, scale);
  context.translate(0.5, 0.5);
  drawWay(context, view, cursor && view.tool === "rectangle" ? [...way, cursor] : way);
  if (cursor) drawCursor(context, cursor, view.tool === "brush" ? view.radius : 3);
  context.restore();
}

function drawWay(context: CanvasRenderingContext2D, view: ColorView, way: Point[]): void {
  const [first, last] = [way[0], way.at(-1)];
  if (!first || !last || view.tool === "grow") return;
  if (view.tool === "rectangle") {
    context.lineWidth = 1;
    context.strokeStyle = "#fff";
    context.strokeRect(first[0], first[1], last[0] - first[0], last[1] - first[1]);
    return;
  }
  context.strokeStyle = "rgba(255, 255, 255, 0.6)";
  context.lineWidth = 2 * view.radius + 1;
  context.lineCap = context.lineJoin = "round";
  context.beginPath();
  context.moveTo(...first);
  for (const point of way) context.lineTo(...point);
  context.stroke();
}

// Black and white: seen on any picture.
function drawCursor(context: CanvasRenderingContext2D, [u, v]: Point, radius: number): void {
  for (const [color, width] of [["#000", 3], ["#fff", 1]] as const) {
    context.strokeStyle = color;
    context.lineWidth = width;
    context.beginPath();
    context.arc(u, v, radius, 0, 2 * Math.PI);
    for (const [x, y] of [[1, 0], [-1, 0], [0, 1], [0, -1]] as const) {
      context.moveTo(u + x * radius, v + y * radius);
      context.lineTo(u + x * (radius + 8), v + y * (radius + 8));
    }
    context.stroke();
  }
}
