// SPDX-License-Identifier: BSD-3-Clause
// Collects what is not as it should be.
const failures = []
export const expect = (holds, what) => { if (!holds) failures.push(what) }

// Prints that, and ends with status 1 if there is anything.
export function finish() {
  for (const failure of new Set(failures)) console.error(failure)
  process.exit(failures.length === 0 ? 0 : 1)
}
