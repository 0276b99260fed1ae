// SPDX-License-Identifier: BSD-3-Clause
import {
  chooseColor,
  keepFrame,
  redo,
  resize,
  revert,
  save,
  setTool,
  setView,
  showMarked,
  stepFrame,
  teach,
  undo,
} from "./color_actions";
import { canKeep } from "./color_view";
import type { Key } from "./keys";
import { store } from "./store";

const digits = ["1", "2", "3", "4", "5", "6", "7", "8", "9"];
const nameAt = (i: number) => store.state.colors?.names[i];

/** Of the page of colours. */
export function colorKeys(): Key[] {
  return [
    ...digits.map((digit, i) => ({
      keys: [digit],
      meaning: `mark ${nameAt(i) ?? ""}`,
      isOffered: () => nameAt(i) !== undefined,
      act: () => chooseColor(nameAt(i)),
    })),
    { keys: ["0"], meaning: "mark what is none of the colours", act: () => setView({ isNone: true }) },
    { keys: ["b"], meaning: "brush", act: () => setTool("brush") },
    { keys: ["x"], meaning: "rectangle", act: () => setTool("rectangle") },
    { keys: ["g"], meaning: "grow from a point", act: () => setTool("grow") },
    { keys: ["]"], meaning: "a larger brush, grow further", act: () => resize(1) },
    { keys: ["["], meaning: "a smaller brush, grow less far", act: () => resize(-1) },
    { keys: ["z"], meaning: "undo a mark", act: undo },
    { keys: ["Z", "y"], meaning: "redo it", act: redo },
    { keys: ["e"], meaning: "teach the colour", act: teach },
    { keys: ["s"], meaning: "save the model", act: save },
    { keys: ["v"], meaning: "revert to the saved model", act: revert },
    {
      keys: ["k"],
      meaning: "keep a frame of the camera",
      isOffered: () => canKeep(store.state.colors),
      act: keepFrame,
    },
    { keys: ["."], meaning: "a frame forward", act: () => stepFrame(1) },
    { keys: [","], meaning: "a frame back", act: () => stepFrame(-1) },
    { keys: [">"], meaning: "ten frames forward", act: () => stepFrame(10) },
    { keys: ["<"], meaning: "ten frames back", act: () => stepFrame(-10) },
    { keys: ["n"], meaning: "to the next frame with marks", act: () => showMarked(1) },
    { keys: ["p"], meaning: "to the one before", act: () => showMarked(-1) },
    {
      keys: ["o"],
      meaning: "show what the detector sees",
      act: () => setView({ showsLabels: !store.state.colorView.showsLabels }),
    },
    {
      keys: ["m"],
      meaning: "show the marks",
      act: () => setView({ showsMarks: !store.state.colorView.showsMarks }),
    },
    {
      keys: ["arrows", "Space", "Esc"],
      meaning: "in the image: move by a pixel (Shift: ten), mark there, give up a rectangle",
      act: () => {},
    },
  ];
}
