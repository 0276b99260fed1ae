// SPDX-License-Identifier: BSD-3-Clause
import { describe, expect, test } from "vitest";
import { initialState, withMessage } from "./store";
import {
  changeText,
  failureOf,
  orderAfter,
  outcomeText,
  progressInWords,
  sorted,
  summaryOf,
  worstFirst,
  type Outcome,
  type Study,
  type StudyReplay,
  type StudyRow,
} from "./study";

function outcome(found: number | null, more: Partial<Outcome> = {}): Outcome {
  return { done: true, failure: "", found, false: 0, error_m: 0.1, estimated: false, ...more };
}

function row(recording: string, before: Outcome, after: Outcome): StudyRow {
  const isKnown = before.found !== null && after.found !== null;
  return { recording, piece: 0, before, after, change: isKnown ? after.found! - before.found! : null };
}

const study: Study = {
  kind: "study",
  variants: ["usual", "strict"],
  before: 0,
  after: 1,
  rows: [
    row("flight 10", outcome(0.9), outcome(null, { failure: "memory limit", false: null, error_m: null })),
    row("flight 9", outcome(0.9), outcome(0.4, { error_m: 0.3 })),
    row("flight 2", outcome(0.5), outcome(0.5, { false: 7 })),
    row("flight 1", outcome(null, { done: false }), outcome(0.5)),
  ],
  total: 4,
  judgement: "Worse in 1 of 2, too few to prove (2 recordings, 8 are the least)",
  remark: "",
  error: "",
};

const names = (order: Parameters<typeof sorted>[1]) => sorted(study, order).map(({ row }) => row.recording);

describe("table of a study", () => {
  test("the worst is first, and the other way round last", () => {
    expect(names(worstFirst)).toEqual(["flight 10", "flight 9", "flight 2", "flight 1"]);
    expect(names(orderAfter(worstFirst, "change"))[0]).toBe("flight 1");
  });

  test("names are in the order of their numbers", () => {
    expect(names({ column: "recording", isDescending: false })).toEqual(["flight 1", "flight 2", "flight 9", "flight 10"]);
  });

  test("a press on a head shows what is bad first, and what is not known last", () => {
    expect(names(orderAfter(worstFirst, "found after"))).toEqual(["flight 9", "flight 2", "flight 1", "flight 10"]);
    expect(names(orderAfter(worstFirst, "false after"))).toEqual(["flight 2", "flight 9", "flight 1", "flight 10"]);
    expect(names(orderAfter(worstFirst, "error_m after"))[0]).toBe("flight 9");
  });

  test("a row keeps the number by which it is opened", () => {
    expect(sorted(study, { column: "recording", isDescending: false })[0]!.number).toBe(3);
  });

  test("says why there is no result", () => {
    expect(failureOf(study.rows[0]!, study)).toBe("strict: memory limit");
    expect(failureOf(study.rows[3]!, study)).toBe("usual: not done yet");
    expect(failureOf(study.rows[1]!, study)).toBe("");
  });

  test("numbers are in words", () => {
    expect(outcomeText(outcome(0.905), "found")).toBe("90.5 %");
    expect(outcomeText(outcome(0.905, { estimated: true }), "found")).toBe("≈ 90.5 %");
    expect(outcomeText(outcome(1, { error_m: null }), "error_m")).toBe("–");
    expect(outcomeText(outcome(1, { error_m: 0.0312 }), "error_m")).toBe("0.031 m");
    expect(changeText(-0.5)).toBe("−50.0");
    expect(changeText(0.123)).toBe("+12.3");
    expect(summaryOf(study.rows.slice(1, 3))).toBe("2 recordings");
    expect(changeText(-0.0001)).toBe("0.0");
    expect(summaryOf(study.rows)).toBe("4 recordings, 2 without a result of both");
  });
});

describe("replay of a study", () => {
  const running: StudyReplay = {
    kind: "study-replay",
    state: "running",
    recording: "flight 9",
    before: "usual",
    after: "strict",
    done: 12,
    frames: 60,
    error: "",
  };

  test("its progress is in words", () => {
    expect(progressInWords(running)).toBe("Opening flight 9 with usual: 12 of 60 frames");
    expect(progressInWords({ ...running, frames: 0 })).toBe("Opening flight 9 with usual: 12 frames");
  });

  test("the page turns to it once it is there, with both runs beside each other", () => {
    let state = withMessage({ ...initialState(), page: "study" }, running);
    expect(state.page).toBe("study");
    state = withMessage(state, { ...running, state: "open" });
    expect(state.page).toBe("watch");
    expect(state.isBeside).toBe(true);
  });

  test("who comes later sees the table", () => {
    const state = withMessage({ ...initialState(), page: "study" }, { ...running, state: "open" });
    expect(state.page).toBe("study");
  });

  test("another recording's timeline leaves nothing of the one before", () => {
    const second = { kind: "second", state: "done", settings: [], done: 2, error: "", marks: "ff" } as const;
    let state = withMessage(initialState(), second as never);
    state = withMessage(state, { kind: "timeline", begin: "0", times_ms: [0, 100], marks: "ff" });
    expect(state.second).toBeNull();
  });
});
