// SPDX-License-Identifier: BSD-3-Clause
// Uses the page of the program as a person would, in Debian's Chromium: watches a simulated flight
// until it tracks, scrubs and plays a recording, comes with a wrong token. Writes pictures to a
// folder, and ends with status 1 when something is not as it should be:
//
//   node tools/try_program.js KESTREL FOLDER
import { spawn, spawnSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve as resolvePath } from "node:path";
import { chromium } from "playwright-core";
import { findingsOf } from "./axe.js";

const [kestrel, folder] = process.argv.slice(2);
if (!kestrel || !folder) throw new Error("expected the program and a folder for the pictures");

let faults = 0;
const scratch = mkdtempSync(join(tmpdir(), "kestrel-page-"));
const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox"] });
try {
  await watchFlight();
  await scrubRecording();
  await tryTokens();
} finally {
  await browser.close();
  rmSync(scratch, { recursive: true });
}
process.exit(faults > 0 ? 1 : 0);

function expect(condition, text) {
  if (condition) return;
  console.error(text);
  faults += 1;
}

/** Starts the program; resolves to it and the link that it prints. */
function start(args) {
  const program = spawn(resolvePath(kestrel), args, { cwd: scratch });
  return new Promise((resolve, reject) => {
    let said = "";
    program.stderr.on("data", (text) => {
      said += text;
      const link = said.match(/console: (http:\S+)/);
      if (link) resolve({ program, link: link[1] });
    });
    program.on("exit", () => reject(new Error(said)));
  });
}

async function openPage(link) {
  const page = await browser.newPage({ viewport: { width: 1440, height: 1000 } });
  page.on("pageerror", (error) => expect(false, `${link}: ${error}`));
  await page.addInitScript(() => localStorage.setItem("kestrel-theme", "light"));
  await page.goto(link);
  return page;
}

async function watchFlight() {
  const { program, link } = await start(
    "fly sim:figure8 --autopilot sim:px4 --guide --console 127.0.0.1:0 --set fly.sim_camera.scale=0.5".split(" "),
  );
  const page = await openPage(link);
  await page.waitForFunction(() => !document.querySelector(".screen .empty"));
  const descends = () => /descend, tracking/.test(document.querySelector(".state-word").textContent);
  await page.waitForFunction(descends, null, { timeout: 90_000 });
  await page.waitForTimeout(2000);
  await page.screenshot({ path: join(folder, "console_live.png") });
  const age = await page.locator(".age").textContent();
  expect(/Frame \d+, \d+ ms old/.test(age), `age of the picture: ${age}`);
  for (const finding of await findingsOf(page)) expect(false, `live: ${finding}`);
  await page.getByRole("button", { name: "Snapshot" }).click();
  await page.getByText(/snapshot kept as kept/).waitFor();
  await page.getByRole("button", { name: "Record" }).click();
  await page.getByRole("button", { name: "Stop recording" }).waitFor();
  await page.keyboard.press("r");
  await page.getByText("the recording is written").waitFor();
  await page.getByRole("heading", { name: "Doctor" }).waitFor();
  program.kill("SIGINT");
  await page.waitForFunction(() => /lost/.test(document.querySelector(".state-word").textContent));
  await page.close();
}

function simulateFlight() {
  const recording = "flight";
  const args = ["simulate", "landing", "--scenario", "figure8", "--seed", "3", "--output", recording];
  const settings = ["frames=60", "rate_hz=10", "ground.map_px=512", "shutter.rays_per_pixel=4"];
  const made = spawnSync(resolvePath(kestrel), [...args, ...settings.flatMap((setting) => ["--set", setting])], {
    cwd: scratch,
  });
  if (made.status !== 0) throw new Error(made.stderr.toString());
  return recording;
}

async function scrubRecording() {
  const { program, link } = await start(["console", simulateFlight(), "--address", "127.0.0.1:0"]);
  const page = await openPage(link);
  const time = page.locator(".replay-time");
  await time.waitFor();
  await page.waitForFunction(() => !document.querySelector(".screen .empty"));
  const isAt = (frame) => time.filter({ hasText: `frame ${frame} of 60` }).waitFor();
  await page.keyboard.press("k");
  await time.filter({ hasText: /frame [2-6]\d of/ }).waitFor();
  await page.keyboard.press("k");
  await page.getByRole("slider").focus();
  await page.keyboard.press("End");
  await isAt(60);
  await page.keyboard.press("Home");
  await isAt(1);
  const box = await page.getByRole("slider").boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  await time.filter({ hasText: /frame (2|3)\d of/ }).waitFor();
  await page.getByRole("button", { name: "+1 frame" }).click();
  await page.getByLabel("Change").selectOption("landing.detector.min_quality");
  await page.getByLabel(/smallest probability/).fill("0.9");
  await page.getByRole("button", { name: "Run" }).click();
  await page.getByText("Second run (below)").waitFor();
  await page.waitForTimeout(500);
  await page.screenshot({ path: join(folder, "console_replay.png") });
  for (const finding of await findingsOf(page)) expect(false, `replay: ${finding}`);
  await page.close();
  program.kill("SIGINT");
}

async function tryTokens() {
  const { program, link } = await start(
    "fly sim:standing --console 127.0.0.1:0 --set console.token=0123456789abcdef".split(" "),
  );
  const page = await openPage(link.replace("abcdef", "abcdee"));
  await page.getByText("who has its token").waitFor();
  await page.getByLabel("Token").fill("0123456789abcdef");
  await page.getByRole("button", { name: "Open" }).click();
  await page.waitForFunction(() => document.querySelector(".state-word")?.textContent !== "Connecting");
  expect(!page.url().includes("token"), "the token stays in the address");
  await page.close();
  program.kill("SIGINT");
}
