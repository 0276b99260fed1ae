// SPDX-License-Identifier: BSD-3-Clause

/** The descent is that of the last so many seconds. */
const spanSeconds = 2;
/** Slower, the UAV does not descend, m/s. */
const leastDescent = 0.05;

/** Seconds until the height is 0 at the present rate of descent; null where there is none. */
export function timeToGo(times: (number | null)[], heights: (number | null)[], last = times.length - 1): number | null {
  const end = times[last];
  const height = heights[last];
  if (end === null || end === undefined || height === null || height === undefined) return null;
  let first = last;
  while (first > 0 && (times[first - 1] ?? -Infinity) >= end - spanSeconds) first -= 1;
  while (first < last && heights[first] === null) first += 1;
  const seconds = end - (times[first] ?? end);
  if (seconds < 0.25 * spanSeconds) return null;
  const descent = ((heights[first] ?? height) - height) / seconds;
  return descent < leastDescent ? null : height / descent;
}
