// SPDX-License-Identifier: BSD-3-Clause
import type { ColorComponent } from "./color_protocol";

export const hueBins = 72;
export const saturationBins = 25;
const degreesPerBin = 360 / hueBins;

/** Where a hue is on a strip that begins at 'cut' degrees: 0 to 360. */
export function alongStrip(hue: number, cut: number): number {
  return (((hue - cut) % 360) + 360) % 360;
}

/** The histogram's column that is drawn at a place of the strip. */
export function columnAt(place: number, cut: number): number {
  return (place + Math.round(cut / degreesPerBin)) % hueBins;
}

/** How dark a bin is drawn, 0 to 1: few samples are seen beside many. */
export function darkness(count: number, most: number): number {
  return count === 0 ? 0 : 0.25 + (0.75 * Math.log1p(count)) / Math.log1p(most);
}

/**
 * Outlines where a component ends, as hue along the strip and saturation: one that crosses the
 * strip's end is there twice.
 */
export function outlines(component: ColorComponent, distance: number, cut: number): [number, number][][] {
  const count = 64;
  const { sigma_hue, sigma_saturation, correlation } = component;
  const middle = alongStrip(component.hue, cut);
  const reach = distance * sigma_hue;
  const shifts = [0, ...(middle + reach > 360 ? [-360] : []), ...(middle < reach ? [360] : [])];
  return shifts.map((shift) =>
    Array.from({ length: count }, (_, i): [number, number] => {
      const angle = (2 * Math.PI * i) / count;
      const across = correlation * Math.cos(angle) + Math.sqrt(1 - correlation ** 2) * Math.sin(angle);
      return [
        middle + shift + reach * Math.cos(angle),
        component.saturation + distance * sigma_saturation * across,
      ];
    }),
  );
}

export function componentInWords(component: ColorComponent): string {
  const { hue, sigma_hue, saturation, sigma_saturation } = component;
  return `hue ${hue.toFixed(0)}° ± ${sigma_hue.toFixed(0)}°, saturation ${saturation.toFixed(2)} ± ${sigma_saturation.toFixed(2)}`;
}
