// SPDX-License-Identifier: BSD-3-Clause
import { expect, test } from "vitest";
import { countText, sortedChecks } from "./checks";
import type { Check } from "./protocol";

function check(name: string, verdict: Check["verdict"]): Check {
  return { name, verdict, measured: "", advice: "" };
}

test("what is wrong comes first, what is good is counted", () => {
  const { inDoubt, others } = sortedChecks([
    check("images", "good"),
    check("focus", "doubtful"),
    check("mount", "not checked"),
    check("disk", "wrong"),
  ]);
  expect(inDoubt.map((one) => one.name)).toEqual(["disk", "focus"]);
  expect(countText(others)).toBe("1 good, 1 not checked");
  expect(countText(others.slice(0, 1))).toBe("1 good");
});
