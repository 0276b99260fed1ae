// SPDX-License-Identifier: BSD-3-Clause
// The guided calibration of a live camera's lens, as src/kestrel/app/console/messages/lens_json.cc writes it,
// and what the page makes of it.

export interface LensEstimate {
  focal_px: number;
  focal_sigma_px: number;
  rms_px: number;
  views: number;
  /** Model of the distortion. */
  model: string;
  warnings: string[];
}

export interface Lens {
  kind: "lens";
  running: boolean;
  board: string;
  /** Why it did not begin. */
  error: string;
  /** The view to show next. */
  advice: string;
  views: number;
  /** Corners in each field of the image, row by row. */
  fields: number[];
  columns: number;
  /** Numbers of views in which this side of the board is nearer. */
  left: number;
  right: number;
  top: number;
  bottom: number;
  /** Numbers of views in which the board is large, and small. */
  near: number;
  far: number;
  estimate: LensEstimate | null;
  /** Why there is no estimate although there are views. */
  refusal: string;
  /** Good enough to be saved. */
  good: boolean;
  folder: string;
  saved: string;
  /** Command that uses what was saved. */
  next: string;
  save_error: string;
  /** The file is there, and was not to be replaced. */
  exists: boolean;
}

export const boards = ["chessboard", "charuco", "aprilgrid", "print"] as const;
export type Board = (typeof boards)[number];

export const boardNames: Record<Board, string> = {
  chessboard: "Chessboard",
  charuco: "ChArUco board",
  aprilgrid: "AprilGrid",
  print: "Kestrel's own print",
};

/** Input fields of a board; lengths in mm. */
export interface BoardForm {
  board: Board;
  columns: number;
  rows: number;
  side_mm: number;
  /** Side of a ChArUco board's markers. */
  marker_mm: number;
  family: string;
  /** Between an AprilGrid's tags, in sides of a tag. */
  gap: number;
}

export const usualForms: Record<Board, BoardForm> = {
  chessboard: form("chessboard", 9, 6, 25),
  charuco: form("charuco", 7, 5, 40),
  aprilgrid: form("aprilgrid", 6, 6, 88),
  print: form("print", 0, 0, 0),
};

function form(board: Board, columns: number, rows: number, side_mm: number): BoardForm {
  return { board, columns, rows, side_mm, marker_mm: 30, family: "DICT_4X4_50", gap: 0.3 };
}

/** The things that columns and rows count. */
export const counted: Record<Board, string> = {
  chessboard: "inner corners",
  charuco: "squares",
  aprilgrid: "tags",
  print: "",
};

/** The board as `kestrel calibrate lens --board` takes it; empty for Kestrel's own print. */
export function boardText({ board, columns, rows, side_mm, marker_mm, family, gap }: BoardForm): string {
  const metres = (mm: number) => String(Number((mm / 1000).toFixed(6)));
  const size = `${columns}x${rows}:${metres(side_mm)}`;
  switch (board) {
    case "chessboard":
      return `chessboard:${size}`;
    case "charuco":
      return `charuco:${size}:${metres(marker_mm)}:${family}`;
    case "aprilgrid":
      return `aprilgrid:${size}:${gap}`;
    case "print":
      return "";
  }
}

export interface Goal {
  name: string;
  views: number;
  wanted: number;
}

/** Tilts and distances, with the numbers of views that the program wants (lens_guide.cc). */
export function goalsOf(lens: Lens): Goal[] {
  return [
    { name: "left side nearer", views: lens.left, wanted: 2 },
    { name: "right side nearer", views: lens.right, wanted: 2 },
    { name: "upper side nearer", views: lens.top, wanted: 2 },
    { name: "lower side nearer", views: lens.bottom, wanted: 2 },
    { name: "near", views: lens.near, wanted: 3 },
    { name: "far", views: lens.far, wanted: 3 },
  ];
}

export function focalText({ focal_px, focal_sigma_px }: LensEstimate): string {
  const percent = (100 * focal_sigma_px) / focal_px;
  return `${focal_px.toFixed(1)} ± ${focal_sigma_px.toFixed(1)} px (${percent.toPrecision(1)} %)`;
}
