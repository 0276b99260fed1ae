// SPDX-License-Identifier: BSD-3-Clause
import { useEffect, useRef, useState } from "preact/hooks";
import { isOffered, showView, toggleLayer, togglePlaying } from "../actions";
import { connection, type Picture } from "../connection";
import { boxShape, follow, markedBox, type Point } from "../marking";
import { drawOverlay, layerColor, ofRun, together } from "../overlay";
import type { FrameHeader, Layer, Shape } from "../protocol";
import { store, type State } from "../store";
import { useClock, useFresh, useStore } from "../use_store";
import { RunFacts } from "./run_facts";

/** Older than this, a live picture is late. */
const lateMs = 500;

const noLayers: Layer[] = [];
const noViews: string[] = [];

/** The picture that is drawn, and a shape that is drawn over it. */
interface Drawn {
  header: () => FrameHeader | null;
  mark: (shape: Shape | null) => void;
}

interface Shown {
  header: FrameHeader;
  receivedAt: number;
}

/** The newest frame with what was found in it; of two runs beside each other twice. */
export function ImageView() {
  const canvas = useRef<HTMLCanvasElement>(null);
  const secondCanvas = useRef<HTMLCanvasElement>(null);
  const [shown, setShown] = useState<Shown | null>(null);
  const isBeside = useStore(hasTwoPictures);
  const isFresh = useFresh(["frames"]);
  const replay = useStore((state) => state.studyReplay);
  const marking = useMarking(usePictures(canvas, secondCanvas, setShown));
  return (
    <section class="image" aria-label="Image">
      <div class={isBeside ? "screens beside" : "screens"}>
        <div>
          {isBeside && <h2>{titleOf("First run", replay?.before)}</h2>}
          <div class="screen" data-stale={!isFresh}>
            <canvas ref={canvas} role="img" aria-label={pictureInWords(shown, 1, isFresh)} {...marking} />
            {shown !== null && !isFresh && <OldPicture shown={shown} />}
            {shown === null && <p class="empty">No image yet</p>}
          </div>
          <RunFacts run={1} />
        </div>
        {isBeside && (
          <div>
            <h2>{titleOf("Second run", replay?.after)}</h2>
            <div class="screen">
              <canvas ref={secondCanvas} role="img" aria-label={pictureInWords(shown, 2, isFresh)} />
            </div>
            <RunFacts run={2} />
          </div>
        )}
      </div>
      <PictureAge shown={shown} />
      <MarkHint />
      <FollowButtons />
    </section>
  );
}

/** Chooses the view and the overlays of the image. */
export function ViewPanel() {
  return (
    <section aria-label="View">
      <ViewChoice />
      <LayerSwitches />
    </section>
  );
}

/** Over a picture that is not what the camera sees now. */
function OldPicture({ shown }: { shown: Shown }) {
  useClock(2);
  const isOver = useStore((state) => state.status?.over ?? false);
  const age = (shown.header.age_ms ?? 0) + performance.now() - shown.receivedAt;
  return <p class="old">{isOver ? "The last image" : `Image ${(age / 1000).toFixed(0)} s old`}</p>;
}

/** The title of a picture: in a study with the configuration. */
function titleOf(run: string, configuration: string | undefined): string {
  return configuration === undefined ? run : `${run}: ${configuration}`;
}

/** Beside each other are two runs, once there are two. */
export function hasTwoPictures(state: State): boolean {
  return state.isBeside && state.second?.state === "done";
}

function pictureInWords(shown: Shown | null, run: 1 | 2, isFresh: boolean): string {
  if (shown === null) return "no image yet";
  if (!isFresh) return "an old image";
  const image = shown.header.view === "" ? "camera image" : shown.header.view;
  const picture = run === 1 ? image : `${image}, second run`;
  const found = ofRun(shown.header.shapes, run).filter(({ layer, label }) => layer === "detection" && label !== "");
  if (found.length === 0) return `${picture}, nothing found`;
  return `${picture}, found: ${found.map((shape) => shape.label).join(", ")}`;
}

// The next picture is asked for when this one is on the screen, so that none waits anywhere.
function usePictures(
  canvas: { current: HTMLCanvasElement | null },
  secondCanvas: { current: HTMLCanvasElement | null },
  setShown: (shown: Shown) => void,
): Drawn {
  const marked = useRef<Shape | null>(null);
  const picture = useRef<Picture | null>(null);
  const isBeside = useStore(hasTwoPictures);
  const layers = useStore((state) => state.layers);
  const isFresh = useFresh(["frames"]);
  const draw = () => {
    if (!picture.current) return;
    const { shapes } = picture.current.header;
    if (!isFresh) return drawPicture(canvas.current, picture.current, []);
    const more = marked.current ? [marked.current] : [];
    if (!secondCanvas.current) return drawPicture(canvas.current, picture.current, [...together(shapes), ...more]);
    drawPicture(canvas.current, picture.current, ofRun(shapes, 1));
    drawPicture(secondCanvas.current, picture.current, ofRun(shapes, 2));
  };
  useEffect(draw, [isBeside, layers, isFresh]);
  const drawNow = useRef(draw);
  drawNow.current = draw;
  useEffect(() => {
    connection.onPicture = (next) => {
      requestAnimationFrame(() => {
        picture.current?.bitmap.close();
        picture.current = next;
        drawNow.current();
        setShown({ header: next.header, receivedAt: next.receivedAt });
        connection.drawn(next.header);
      });
    };
    return () => {
      connection.wantImages(null);
      connection.onPicture = null;
    };
  }, []);
  const view = useStore((state) => state.view);
  const isFrozen = useStore((state) => state.isFrozen);
  useEffect(() => connection.wantImages({ view, isHeld: isFrozen }), [view, isFrozen]);
  const mark = (shape: Shape | null) => {
    marked.current = shape;
    draw();
  };
  return { header: () => picture.current?.header ?? null, mark };
}

/** Pointer events that mark something in the picture; none where nothing can be followed. */
function useMarking({ header, mark }: Drawn) {
  const canMark = useStore((state) => state.hello !== null && isOffered("mark"));
  const begun = useRef<{ at: Point; header: FrameHeader } | null>(null);
  if (!canMark) return {};
  const boxTo = (event: PointerEvent) => {
    const { width, height } = begun.current!.header;
    return markedBox(begun.current!.at, pointOf(event, width, height), width, height);
  };
  return {
    class: "markable",
    onPointerDown: (event: PointerEvent) => {
      const shown = header();
      if (event.button !== 0 || shown === null) return;
      (event.currentTarget as HTMLElement).setPointerCapture(event.pointerId);
      begun.current = { at: pointOf(event, shown.width, shown.height), header: shown };
    },
    onPointerMove: (event: PointerEvent) => {
      if (begun.current) mark(boxShape(boxTo(event)));
    },
    onPointerUp: (event: PointerEvent) => {
      if (begun.current) follow(begun.current.header, boxTo(event));
      begun.current = null;
      mark(null);
    },
    onPointerCancel: () => {
      begun.current = null;
      mark(null);
    },
  };
}

/** The pixel under a pointer. */
function pointOf(event: PointerEvent, width: number, height: number): Point {
  const box = (event.currentTarget as HTMLElement).getBoundingClientRect();
  return [
    ((event.clientX - box.left) / box.width) * width - 0.5,
    ((event.clientY - box.top) / box.height) * height - 0.5,
  ];
}

function MarkHint() {
  const canMark = useStore((state) => state.hello !== null && isOffered("mark"));
  return canMark ? <p class="hint">Click on what is to be followed, or drag a box around it.</p> : null;
}

/** Lets the UAV fly to what is marked, or stand still. */
function FollowButtons() {
  const canFly = useStore((state) => state.hello !== null && isOffered("confirm"));
  if (!canFly) return null;
  return (
    <div class="switches" role="group" aria-label="Follow">
      <button onClick={() => connection.command("confirm")}>fly to it</button>
      <button onClick={() => connection.command("stop")}>stop</button>
    </div>
  );
}

// The canvas is at least so wide that lines and words over a small frame are fine.
function drawPicture(canvas: HTMLCanvasElement | null, { header, bitmap }: Picture, shapes: Shape[]): void {
  if (!canvas) return;
  const scale = Math.max(1, Math.round(1280 / header.width));
  canvas.width = header.width * scale;
  canvas.height = header.height * scale;
  const context = canvas.getContext("2d");
  if (!context) return;
  context.imageSmoothingEnabled = scale === 1;
  context.drawImage(bitmap, 0, 0, canvas.width, canvas.height);
  const unit = canvas.width / Math.max(canvas.clientWidth, 1);
  drawOverlay(context, shapes, store.state.layers, scale, unit);
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
  const isBeside = useStore(hasTwoPictures);
  const ofPicture = layers.filter((layer) => layer !== "second" || !isBeside);
  return (
    <div class="switches" role="group" aria-label="Overlay">
      {ofPicture.map((layer: Layer) => (
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
    <p class="age" data-stale={age > lateMs}>
      Frame {shown.header.sequence}, {text}
      {isFrozen && ", frozen"}
    </p>
  );
}
