// SPDX-License-Identifier: BSD-3-Clause
import { expect, test } from "vitest";
import { changesIn, type Setting } from "./settings";

function setting(name: string, value: string, given = false): Setting {
  return { name, label: name, value, unit: "", meaning: "", choices: [], given };
}

test("only what is changed, and not given on the command line, is saved", () => {
  const settings = [setting("id", "3"), setting("size", "0.5"), setting("kind", "aruco"), setting("source", "a", true)];
  expect(changesIn(settings, {})).toEqual([]);
  expect(changesIn(settings, { id: "3", size: " 0.4 ", kind: "apriltag", source: "b" })).toEqual([
    "size=0.4",
    "kind=apriltag",
  ]);
});
