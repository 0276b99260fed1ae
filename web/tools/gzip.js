// SPDX-License-Identifier: BSD-3-Clause
// Gzips the files of dist/, as they go into the program; the same bytes for the same files.
import { readdirSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { gzipSync } from "node:zlib";

const folder = new URL("../dist", import.meta.url).pathname;
let total = 0;
for (const name of readdirSync(folder, { recursive: true })) {
  const path = join(folder, name);
  if (name.endsWith(".gz") || !statSync(path).isFile()) continue;
  const bytes = gzipSync(readFileSync(path), { level: 9 });
  writeFileSync(`${path}.gz`, bytes);
  total += bytes.length;
}
console.log(`gzipped: ${(total / 1000).toFixed(1)} kB in all`);
