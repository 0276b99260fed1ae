// SPDX-License-Identifier: BSD-3-Clause
// Runs every tools/try_*.js, one after the other; ends with status 1 when one of them does:
//
//   node tools/all_tries.js KESTREL FOLDER
import { spawnSync } from "node:child_process";
import { readdirSync } from "node:fs";
import { fileURLToPath } from "node:url";

const tools = fileURLToPath(new URL(".", import.meta.url));
const names = readdirSync(tools).filter((name) => /^try_\w+\.js$/.test(name)).sort();
const failed = names.filter((name) => {
  console.log(`== ${name}`);
  const { status } = spawnSync(process.execPath, [`${tools}${name}`, ...process.argv.slice(2)], { stdio: "inherit" });
  return status !== 0;
});
if (failed.length > 0) console.error(`failed: ${failed.join(", ")}`);
process.exit(failed.length > 0 ? 1 : 0);
