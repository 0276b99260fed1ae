// SPDX-License-Identifier: BSD-3-Clause
// Calibrates from recordings on the page of the program as a person would, with keys alone where
// that is the harder way, in Debian's Chromium: mount and clock while the recording plays, a
// refusal, cancel, save, download. Writes pictures to a folder, and ends with status 1 when
// something is not as it should be:
//
//   node tools/try_calibration.js KESTREL FOLDER
import { spawn, spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve as resolvePath } from "node:path";
import { chromium } from "playwright-core";
import { findingsOf } from "./axe.js";

const [kestrel, folder] = process.argv.slice(2);
if (!kestrel || !folder) throw new Error("expected the program and a folder for the pictures");

// How long anything may take on a computer that others use.
const patience = 240_000;
let faults = 0;
const scratch = mkdtempSync(join(tmpdir(), "kestrel-calibration-"));
const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox"] });
let program;
try {
  const flight = await openPage(await start([simulateFlight("flight", 120, 15), "--output", "calibrated"]));
  await calibrateByKeys(flight);
  await saveTwice(flight);
  await cancel(flight);
  await calibrateLens(flight);
  program.kill("SIGINT");
  await beRefused(await openPage(await start([simulateFlight("short", 12, 4)])));
} finally {
  program?.kill("SIGINT");
  await browser.close();
  rmSync(scratch, { recursive: true });
}
process.exit(faults > 0 ? 1 : 0);

function expect(condition, text) {
  if (condition) return;
  console.error(text);
  faults += 1;
}

function simulateFlight(name, frames, rate) {
  const args = ["simulate", "landing", "--scenario", "aggressive", "--seed", "11", "--output", name];
  const settings = [`frames=${frames}`, `rate_hz=${rate}`, "ground.map_px=512", "shutter.rays_per_pixel=4"];
  const made = spawnSync(resolvePath(kestrel), [...args, ...settings.flatMap((setting) => ["--set", setting])], {
    cwd: scratch,
  });
  if (made.status !== 0) throw new Error(made.stderr.toString());
  return name;
}

/** Starts the program; resolves to the link that it prints. */
function start(args) {
  program = spawn(resolvePath(kestrel), ["console", ...args, "--address", "127.0.0.1:0"], { cwd: scratch });
  return new Promise((resolve, reject) => {
    let said = "";
    program.stderr.on("data", (text) => {
      said += text;
      const link = said.match(/console: (http:\S+)/);
      if (link) resolve(link[1]);
    });
    program.on("exit", () => reject(new Error(said)));
  });
}

async function openPage(link) {
  const page = await browser.newPage({ viewport: { width: 1440, height: 1000 } });
  page.setDefaultTimeout(patience);
  page.on("pageerror", (error) => expect(false, `${link}: ${error}`));
  await page.addInitScript(() => localStorage.setItem("kestrel-theme", "light"));
  await page.goto(link);
  await page.locator(".replay-time").waitFor();
  return page;
}

/** Presses Tab until what has the focus says this. */
async function tabTo(page, text) {
  const focused = () => document.activeElement.closest("label")?.textContent ?? document.activeElement.textContent;
  for (let i = 0; i < 40; i++) {
    if ((await page.evaluate(focused)).trim().startsWith(text)) return;
    await page.keyboard.press("Tab");
  }
  throw new Error(`Tab does not lead to ${text}`);
}

async function calibrateByKeys(page) {
  await page.keyboard.press("k");
  await page.keyboard.press("l");
  await tabTo(page, "mount and clock");
  await tabTo(page, "the pattern moves");
  await page.keyboard.press("Space");
  await tabTo(page, "Calibrate");
  await page.keyboard.press("Enter");
  await page.getByRole("heading", { name: "Result: mount and clock" }).waitFor();
  const clock = page.getByRole("row", { name: /clock offset/ });
  expect(/± 0\.0\d+/.test(await clock.textContent()), `clock: ${await clock.textContent()}`);
  await page.screenshot({ path: join(folder, "console_calibration.png"), fullPage: true });
  for (const finding of await findingsOf(page)) expect(false, `calibration: ${finding}`);
}

async function saveTwice(page) {
  await page.getByRole("button", { name: "Save" }).click();
  await page.getByText("Saved as calibrated/mount_clock.yaml").waitFor();
  await page.getByRole("button", { name: "Save" }).click();
  await page.getByText("Saved as calibrated/mount_clock_2.yaml").waitFor();
  const saved = readFileSync(join(scratch, "calibrated/mount_clock.yaml"), "utf8");
  expect(existsSync(join(scratch, "calibrated/mount_clock_2.yaml")), "the second file is not there");
  const download = page.waitForEvent("download");
  await page.getByRole("link", { name: "Download" }).click();
  const given = readFileSync(await (await download).path(), "utf8");
  expect(given === saved, "the download is not what was saved");
}

async function cancel(page) {
  await page.getByLabel("mount", { exact: true }).check();
  await page.getByRole("button", { name: "Calibrate" }).click();
  await page.getByRole("button", { name: "Cancel" }).click();
  await page.getByText("Cancelled: mount").waitFor();
  // The replay was never held up.
  await page.getByRole("button", { name: "Replay" }).click();
  await page.getByRole("slider").focus();
  await page.keyboard.press("End");
  await page.locator(".replay-time").filter({ hasText: "frame 120 of 120" }).waitFor();
}

async function calibrateLens(page) {
  await page.getByRole("button", { name: "Calibration" }).click();
  await page.getByLabel("lens", { exact: true }).check();
  await page.getByRole("button", { name: "Calibrate" }).click();
  await page.getByRole("heading", { name: "Result: lens" }).waitFor();
  await page.screenshot({ path: join(folder, "console_calibration_lens.png"), fullPage: true });
  for (const finding of await findingsOf(page)) expect(false, `lens: ${finding}`);
}

async function beRefused(page) {
  await page.keyboard.press("l");
  await page.getByRole("button", { name: "Calibrate" }).click();
  const refusal = page.getByRole("alert");
  await refusal.waitFor();
  const text = await refusal.textContent();
  expect(/images with poses around them, expected at least 20/.test(text), `refusal: ${text}`);
  await page.screenshot({ path: join(folder, "console_calibration_refused.png"), fullPage: true });
  for (const finding of await findingsOf(page)) expect(false, `refusal: ${finding}`);
}
