// SPDX-License-Identifier: BSD-3-Clause
import { useEffect, useRef } from "preact/hooks";
import { alongStrip, columnAt, componentInWords, darkness, hueBins, outlines, saturationBins } from "../color_plane";
import type { Colors } from "../color_protocol";
import { useStore } from "../use_store";

/** The hue-saturation histogram of what is marked, and where the mixture's components end. */
export function ColorPlane({ colors }: { colors: Colors }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const theme = useStore((state) => state.theme);
  useEffect(() => {
    if (canvas.current) drawPlane(canvas.current, colors);
  }, [colors, theme]);
  const cut = colors.cut_hue;
  return (
    <section class="color-plane" aria-label="Hue and saturation">
      <h2>Hue and saturation of {colors.color}</h2>
      <canvas ref={canvas} role="img" aria-label={`Marked pixels and ${colors.components.length} components`} />
      <p class="axis" aria-hidden="true">
        {[0, 90, 180, 270].map((place) => (
          <span key={place}>{(place + cut) % 360}°</span>
        ))}
        <span>{cut}°</span>
      </p>
      <p class="legend">
        Hue to the right, saturation upwards; dark: marked pixels; lines: where a component ends (
        {colors.max_distance} standard deviations).
      </p>
      <ul>
        {colors.components.map((component, i) => (
          <li key={i}>{componentInWords(component)}</li>
        ))}
      </ul>
    </section>
  );
}

function drawPlane(canvas: HTMLCanvasElement, colors: Colors): void {
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  canvas.width = width;
  canvas.height = height;
  const context = canvas.getContext("2d");
  if (!context) return;
  const [column, row] = [width / hueBins, height / saturationBins];
  const most = Math.max(...colors.histogram);
  for (let place = 0; place < hueBins; place++) {
    const hue = columnAt(place, colors.cut_hue);
    for (let saturation = 0; saturation < saturationBins; saturation++) {
      const box = [place * column, height - (saturation + 1) * row, column + 1, row + 1] as const;
      context.fillStyle = `hsl(${(hue * 360) / hueBins + 2.5} ${(100 * saturation) / saturationBins}% 82%)`;
      context.fillRect(...box);
      const count = colors.histogram[saturation * hueBins + hue] ?? 0;
      if (count === 0) continue;
      context.fillStyle = `rgba(0, 0, 0, ${darkness(count, most)})`;
      context.fillRect(...box);
    }
  }
  for (const component of colors.components) {
    for (const outline of outlines(component, colors.max_distance, colors.cut_hue)) {
      drawOutline(context, outline, width, height);
    }
    const middle = alongStrip(component.hue, colors.cut_hue);
    drawMean(context, (middle / 360) * width, (1 - component.saturation) * height);
  }
}

function drawOutline(context: CanvasRenderingContext2D, outline: [number, number][], width: number, height: number): void {
  const path = new Path2D();
  for (const [hue, saturation] of outline) path.lineTo((hue / 360) * width, (1 - saturation) * height);
  path.closePath();
  for (const [color, thickness] of [["#fff", 4], ["#000", 2]] as const) {
    context.strokeStyle = color;
    context.lineWidth = thickness;
    context.stroke(path);
  }
}

function drawMean(context: CanvasRenderingContext2D, x: number, y: number): void {
  for (const [color, size] of [["#fff", 4], ["#000", 2]] as const) {
    context.fillStyle = color;
    context.fillRect(x - size, y - size, 2 * size, 2 * size);
  }
}
