// SPDX-License-Identifier: BSD-3-Clause
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

const axe = createRequire(import.meta.url).resolve("axe-core/axe.min.js");

/**
 * What axe finds in a page of Playwright's, as lines. The content policy keeps scripts out that are
 * not the server's: axe comes by the debugger.
 */
export async function findingsOf(page) {
  await page.evaluate(readFileSync(axe, "utf8"));
  const result = await page.evaluate(() => globalThis.axe.run());
  return result.violations.map(
    ({ id, help, nodes }) => `${id}: ${help}: ${nodes.map((node) => node.target).join(", ")}`,
  );
}
