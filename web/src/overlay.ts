// SPDX-License-Identifier: BSD-3-Clause
import type { Layer, Shape } from "./protocol";

/** How a layer is drawn: told apart by dashes as well as by colour. */
const styles: Record<Layer, { color: string; dash: number[] }> = {
  detection: { color: "#3dff6e", dash: [] },
  prediction: { color: "#5cc8ff", dash: [8, 5] },
  rejected: { color: "#ff7a5c", dash: [5, 4] },
  truth: { color: "#ffffff", dash: [1, 3] },
  second: { color: "#ffd84a", dash: [2, 4] },
};

export function layerColor(layer: Layer): string {
  return styles[layer].color;
}

/** For a picture of both runs: what the second found is a layer of its own. */
export function together(shapes: Shape[]): Shape[] {
  const isOver = ({ run, layer }: Shape) => run === 1 || layer === "detection" || layer === "rejected";
  return shapes.filter(isOver).map((shape) => (shape.run === 1 ? shape : asSecond(shape)));
}

function asSecond(shape: Shape): Shape {
  return { ...shape, layer: "second", label: shape.label === "" ? "" : `second: ${shape.label}` };
}

/** For a picture of one run: all its layers. */
export function ofRun(shapes: Shape[], run: 1 | 2): Shape[] {
  return shapes.filter((shape) => shape.run === run);
}

/**
 * Draws the shapes of the layers that are on. 'scale': canvas pixels a pixel of the frame; 'unit':
 * canvas pixels a pixel of the page, so that lines and words are as large as others there.
 */
export function drawOverlay(
  context: CanvasRenderingContext2D,
  shapes: Shape[],
  isOn: Record<Layer, boolean>,
  scale: number,
  unit: number,
): void {
  for (const shape of shapes) {
    if (!isOn[shape.layer]) continue;
    const { color, dash } = styles[shape.layer];
    const path = outlinePath(shape, scale, unit);
    // A dark line below, for bright images.
    strokePath(context, path, "rgba(0, 0, 0, 0.65)", 4 * unit, []);
    const dashes = dash.map((length) => length * unit);
    strokePath(context, path, color, 2 * unit, dashes);
    drawLabel(context, shape, color, scale, unit);
  }
  context.setLineDash([]);
}

function strokePath(
  context: CanvasRenderingContext2D,
  path: Path2D,
  color: string,
  width: number,
  dash: number[],
): void {
  context.strokeStyle = color;
  context.lineWidth = width;
  context.setLineDash(dash);
  context.stroke(path);
}

// Pixel (0, 0) is the centre of the first one.
function at(value: number | undefined, scale: number): number {
  return ((value ?? 0) + 0.5) * scale;
}

function outlinePath(shape: Shape, scale: number, unit: number): Path2D {
  const { outline } = shape;
  const path = new Path2D();
  if (outline.length === 2) {
    const [x, y] = [at(outline[0], scale), at(outline[1], scale)];
    path.moveTo(x - 7 * unit, y);
    path.lineTo(x + 7 * unit, y);
    path.moveTo(x, y - 7 * unit);
    path.lineTo(x, y + 7 * unit);
    return path;
  }
  for (let i = 0; i + 1 < outline.length; i += 2) {
    path.lineTo(at(outline[i], scale), at(outline[i + 1], scale));
  }
  if (shape.closed) path.closePath();
  return path;
}

function drawLabel(
  context: CanvasRenderingContext2D,
  shape: Shape,
  color: string,
  scale: number,
  unit: number,
): void {
  if (shape.label === "") return;
  const xs = shape.outline.filter((_, i) => i % 2 === 0);
  const ys = shape.outline.filter((_, i) => i % 2 === 1);
  context.font = `600 ${14 * unit}px system-ui, sans-serif`;
  const width = context.measureText(shape.label).width;
  const x = Math.min(Math.max(at(Math.min(...xs), scale), 3), context.canvas.width - width - 3);
  const y = Math.max(at(Math.min(...ys), scale) - 8 * unit, 15 * unit);
  context.setLineDash([]);
  context.lineWidth = 4 * unit;
  context.strokeStyle = "rgba(0, 0, 0, 0.75)";
  context.strokeText(shape.label, x, y);
  context.fillStyle = color;
  context.fillText(shape.label, x, y);
}
