// SPDX-License-Identifier: BSD-3-Clause
import { describe, expect, test } from "vitest";
import { Freshness, silenceInWords, stalenessOf } from "./freshness";
import type { Sources, SourceName } from "./protocol";

/** The program's clock is so far ahead of the page's, ms. */
const ahead = 5_000_000;

/** Ages as told by the program when the page's clock shows 'sent'. */
function told(sent: number, ages: Partial<Record<SourceName, number | null>>): Sources {
  const sources = Object.entries(ages).map(([name, age_ms]) => ({ name: name as SourceName, age_ms }));
  return { kind: "sources", time: `${sent + ahead}000000`, sources };
}

function heard(freshness: Freshness, message: Sources, now: number): void {
  freshness.hear(now);
  freshness.tell(message, now);
}

describe("freshness", () => {
  test("a program that says nothing for a second is silent, with its age", () => {
    const freshness = new Freshness();
    expect(stalenessOf(freshness, true, 50)).toEqual({ isSilent: false, old: [], fresh: [], missing: [] });
    heard(freshness, told(100, { frames: 20, autopilot: 30 }), 103);
    expect(stalenessOf(freshness, true, 900).fresh).toEqual(["frames", "autopilot"]);
    const later = stalenessOf(freshness, true, 1200);
    expect(later).toEqual({ isSilent: true, old: ["frames", "autopilot"], fresh: [], missing: [] });
    expect(silenceInWords(null, freshness.silence(21_103))).toBe("No data for 21 s");
  });

  test("each source is old by itself, by the program's age and the page's clock", () => {
    const freshness = new Freshness();
    heard(freshness, told(0, { frames: 900, autopilot: 50, pose: 2500 }), 2);
    expect(stalenessOf(freshness, true, 50)).toMatchObject({ old: ["pose"], fresh: ["frames", "autopilot"] });
    expect(stalenessOf(freshness, true, 200)).toMatchObject({ old: ["frames", "pose"], fresh: ["autopilot"] });
    expect(silenceInWords("frames", freshness.age("frames", 2102))).toBe("No images for 3 s");
  });

  test("a source that has given nothing yet is missing, and of one that is not known nothing is fresh", () => {
    const freshness = new Freshness();
    heard(freshness, told(0, { frames: null }), 1);
    expect(stalenessOf(freshness, true, 2)).toEqual({ isSilent: false, old: [], fresh: [], missing: ["frames"] });
  });

  test("what the network has kept for long is old when it comes", () => {
    const freshness = new Freshness();
    heard(freshness, told(0, { frames: 20 }), 5);
    heard(freshness, told(1000, { frames: 20 }), 4005);
    expect(freshness.age("frames", 4005)).toBeCloseTo(3020, -1);
    expect(stalenessOf(freshness, true, 4005).old).toEqual(["frames"]);
    heard(freshness, told(4100, { frames: 20 }), 4105);
    expect(stalenessOf(freshness, true, 4105).fresh).toEqual(["frames"]);
  });

  test("clocks that drift apart make nothing old", () => {
    const freshness = new Freshness();
    for (let now = 0; now < 86_400_000; now += 60_000) {
      heard(freshness, told(Math.round(now * (1 - 5e-5)), { frames: 20 }), now);
    }
    expect(freshness.age("frames", 86_340_000)).toBeLessThan(100);
  });

  test("a recording may be quiet for longer", () => {
    const freshness = new Freshness();
    freshness.hear(0);
    expect(stalenessOf(freshness, false, 1500).isSilent).toBe(false);
    expect(stalenessOf(freshness, false, 3500).isSilent).toBe(true);
  });
});
