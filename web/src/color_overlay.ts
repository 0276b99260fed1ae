// SPDX-License-Identifier: BSD-3-Clause

type Rgb = readonly [number, number, number];

/** Of a mark that is none of the model's colours, and of a label that is several of them. */
const noColor = 255;
const black: Rgb = [0, 0, 0];
const white: Rgb = [255, 255, 255];
const palette: Rgb[] = [
  [255, 64, 64], [255, 150, 40], [250, 230, 60], [70, 220, 90], [70, 140, 255],
  [200, 110, 255], [60, 220, 220], [255, 120, 190],
];
const knownColors: Record<string, Rgb | undefined> = {
  red: palette[0], orange: palette[1], yellow: palette[2], green: palette[3], blue: palette[4],
  purple: palette[5], cyan: palette[6], pink: palette[7], white, black: [40, 40, 40],
};

/** What a colour is shown as, by its name or else its place in the model. */
export function shownAs(name: string, index: number): Rgb {
  return knownColors[name.toLowerCase()] ?? palette[index % palette.length] ?? [255, 255, 255];
}

export interface OverlayWish {
  showsLabels: boolean;
  showsMarks: boolean;
  /** Label of the colour that is looked at. */
  chosen: number;
  /** As the colours are shown, in the order of the labels from 1. */
  colors: Rgb[];
}

/**
 * Paints what is drawn over a frame, from what the server says of its pixels: what the grid takes
 * each of them for, and then what each is marked as. The colour that is looked at is hatched and all else
 * darker; marks have edges, white those of a colour and black those of none.
 */
export function paintOverlay(labels: Uint8Array, image: Pick<ImageData, "data" | "width" | "height">, wish: OverlayWish): void {
  const { width, height } = image;
  const pixels = new Uint32Array(image.data.buffer);
  const marks = labels.subarray(width * height);
  const [plain, hatched] = [labelTable(false, wish), labelTable(true, wish)];
  const [ofColor, ofNone] = [packed(white, 255), packed(black, 255)];
  for (let v = 0; v < height; v++) {
    for (let u = 0; u < width; u++) {
      const i = v * width + u;
      const mark = marks[i] ?? 0;
      pixels[i] = wish.showsLabels ? (((u + v) % 6 < 2 ? hatched : plain)[labels[i] ?? 0] ?? 0) : 0;
      if (mark !== 0 && wish.showsMarks && isEdge(marks, mark, u, v, width, height)) {
        pixels[i] = mark === noColor ? ofNone : ofColor;
      }
    }
  }
}

/** What each of the 256 labels is shown as: a table, since there are a million pixels. */
function labelTable(isHatch: boolean, { chosen, colors }: OverlayWish): Uint32Array {
  return Uint32Array.from({ length: 256 }, (_, label) => {
    const color = colors[label - 1];
    if (!color) return packed(black, 120);
    if (label === chosen) return packed(color, isHatch ? 255 : 90);
    return packed(color, isHatch ? 110 : 60);
  });
}

function packed(color: Rgb, alpha: number): number {
  return new Uint32Array(new Uint8Array([...color, alpha]).buffer)[0] ?? 0;
}

// A marked pixel beside one that is marked otherwise.
function isEdge(
  marks: Uint8Array,
  mark: number,
  u: number,
  v: number,
  width: number,
  height: number,
): boolean {
  const isMarkedSo = (x: number, y: number) =>
    x >= 0 && y >= 0 && x < width && y < height && marks[y * width + x] === mark;
  return !(isMarkedSo(u - 1, v) && isMarkedSo(u + 1, v) && isMarkedSo(u, v - 1) && isMarkedSo(u, v + 1));
}
