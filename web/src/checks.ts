// SPDX-License-Identifier: BSD-3-Clause
import type { Check } from "./protocol";

/** What a user has to look at, the worst first, and what he need not. */
export function sortedChecks(checks: Check[]): { inDoubt: Check[]; others: Check[] } {
  const wrong = checks.filter((check) => check.verdict === "wrong");
  const doubtful = checks.filter((check) => check.verdict === "doubtful");
  const others = checks.filter((check) => !wrong.includes(check) && !doubtful.includes(check));
  return { inDoubt: [...wrong, ...doubtful], others };
}

/** As "9 good, 2 not checked". */
export function countText(checks: Check[]): string {
  const good = checks.filter((check) => check.verdict === "good").length;
  const rest = checks.length - good;
  return rest === 0 ? `${good} good` : `${good} good, ${rest} not checked`;
}
