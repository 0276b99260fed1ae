// SPDX-License-Identifier: BSD-3-Clause
// Teaches a colour on the page of the program as a person would, in Debian's Chromium: of a simulated
// flight whose objects a model without reds does not find, marks a red one by mouse and keys, teaches
// and saves it, starts the program again, and hunts with the saved model. Writes a picture to a
// folder, and ends with status 1 when something is not as it should be:
//
//   node tools/try_colors.js KESTREL FOLDER
import { spawn, spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve as resolvePath } from "node:path";
import { chromium } from "playwright-core";
import { findingsOf } from "./axe.js";

const [kestrel, folder] = process.argv.slice(2);
if (!kestrel || !folder) throw new Error("expected the program and a folder for the pictures");
const flight = "hunt";
const blindModel = "blind.yaml";

let faults = 0;
const scratch = mkdtempSync(join(tmpdir(), "kestrel-colors-"));
const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox"] });
try {
  simulate();
  const known = redsFoundWith([]);
  writeBlindModel();
  const unknown = redsFoundWith(["--model", blindModel]);
  expect(known.count > 0 && unknown.count === 0, `reds: ${known.count} known, ${unknown.count} unknown`);
  await teachRed(known);
  const taught = redsFoundWith(["--model", "taught/objects.yaml"]);
  console.log(`red objects found: built-in ${known.count}, before ${unknown.count}, taught ${taught.count}`);
  expect(taught.count >= 0.9 * known.count, "the taught model finds fewer");
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

function run(args) {
  const done = spawnSync(resolvePath(kestrel), args, { cwd: scratch, maxBuffer: 1 << 28 });
  if (done.status !== 0) throw new Error(done.stderr.toString());
  return done.stdout.toString();
}

function simulate() {
  const settings = ["frames=12", "ground.map_px=1024", "shutter.rays_per_pixel=3"];
  run(["simulate", "hunt", "--seed", "4", "--output", flight, ...settings.flatMap((one) => ["--set", one])]);
}

/** The red discs that a hunt finds: how many, and where by frame. */
function redsFoundWith(args) {
  const [head, ...rows] = run(["hunt", flight, ...args]).trim().split("\n").map((row) => row.split(","));
  const at = (row, name) => row[head.indexOf(name)];
  const reds = rows
    .filter((row) => at(row, "class") === "red")
    .map((row) => ({ frame: at(row, "frame"), u: Number(at(row, "u_px")), v: Number(at(row, "v_px")) }));
  return { count: reds.length, reds };
}

/** The built-in model with a red that nothing has: purple. */
function writeBlindModel() {
  const built = readFileSync(new URL("../../src/kestrel/objects/objects.yaml", import.meta.url), "utf8");
  const [before, after] = [built.indexOf("  - name: red"), built.indexOf("  - name: orange")];
  const purple = "  - name: red\n    components:\n      - {weight: 1, mean: [285, 0.9, 0.5], sigma: [4, 0.05, 0.05]}\n";
  writeFileSync(join(scratch, blindModel), built.slice(0, before) + purple + built.slice(after));
}

/** Starts the program; resolves to it and the link that it prints. */
function start(args) {
  const program = spawn(resolvePath(kestrel), ["console", flight, "--address", "127.0.0.1:0", ...args], { cwd: scratch });
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

async function stop(program) {
  const ended = new Promise((resolve) => program.on("exit", resolve));
  program.kill("SIGINT");
  await ended;
}

async function openColors(link) {
  const page = await browser.newPage({ viewport: { width: 1440, height: 1100 } });
  page.on("pageerror", (error) => expect(false, `${link}: ${error}`));
  await page.addInitScript(() => localStorage.setItem("kestrel-theme", "light"));
  await page.goto(link);
  await page.getByRole("button", { name: "Colours" }).click();
  await page.locator("canvas[data-revision]").waitFor();
  return page;
}

function marksSay(page, text) {
  return page.locator(".replay-time").filter({ hasText: text }).waitFor();
}

/** Where a pixel of the frame is on the screen. */
async function onScreen(page, u, v) {
  const canvas = page.locator("canvas[data-revision]");
  const box = await canvas.boundingBox();
  const scale = box.width / Number(await canvas.getAttribute("data-width"));
  return { x: (u + 0.5) * scale, y: (v + 0.5) * scale };
}

async function teachRed(known) {
  const { program, link } = await start(["--model", blindModel]);
  const images = imageNames();
  const page = await openColors(link);
  const canvas = page.locator("canvas[data-revision]");
  await page.keyboard.press("1");
  await page.getByRole("button", { name: "grow" }).click();
  // An object of three frames, as a person would click on what is red.
  const frames = [...new Set(known.reds.map(({ frame }) => frame))];
  const chosen = [frames[0], frames[Math.floor(frames.length / 2)], frames.at(-1)];
  for (const [i, frame] of chosen.entries()) {
    const number = images.findIndex((image) => frame.endsWith(image));
    await page.getByLabel("Frame", { exact: true }).fill(String(number + 1));
    await page.locator(`canvas[data-frame="${number}"]`).waitFor();
    const red = known.reds.find((one) => one.frame === frame);
    await canvas.click({ position: await onScreen(page, red.u, red.v) });
    await marksSay(page, `marks: ${i + 1},`);
  }
  await markGroundByKeys(page, 4);
  await page.keyboard.press("z");
  await marksSay(page, "marks: 3,");
  await page.keyboard.press("Z");
  await marksSay(page, "marks: 4,");
  await page.keyboard.press("1");
  await page.keyboard.press("e");
  await page.getByText("taught red").waitFor();
  await page.getByText("Found of what is marked red").waitFor();
  const recall = await page.locator(".scores dd").first().textContent();
  expect(parseFloat(recall) > 95, `recall: ${recall}`);
  await page.waitForTimeout(500);
  await measurePreview(page);
  await page.screenshot({ path: join(folder, "console_colors.png") });
  for (const finding of await findingsOf(page)) expect(false, `colours: ${finding}`);
  await page.keyboard.press("s");
  await page.getByText("saved as taught/objects.yaml").waitFor();
  await stop(program);
  await page.close();
  await findDraftAgain();
}

/** In the order of the frames. */
function imageNames() {
  const rows = readFileSync(join(scratch, flight, "mav0/cam0/data.csv"), "utf8").trim().split("\n");
  return rows.filter((row) => !row.startsWith("#")).map((row) => row.split(",")[1].trim());
}

async function markGroundByKeys(page, count) {
  await page.keyboard.press("0");
  await page.keyboard.press("x");
  await page.locator("canvas[data-revision]").focus();
  for (let i = 0; i < 60; i++) await page.keyboard.press("Shift+ArrowUp");
  await page.keyboard.press("Space");
  for (let i = 0; i < 8; i++) await page.keyboard.press("Shift+ArrowRight");
  for (let i = 0; i < 3; i++) await page.keyboard.press("Shift+ArrowDown");
  await page.keyboard.press("Space");
  await marksSay(page, `marks: ${count},`);
}

async function measurePreview(page) {
  const times = [];
  for (let i = 0; i < 10; i++) {
    await page.keyboard.press("z");
    await marksSay(page, "marks: 3,");
    await page.keyboard.press("Z");
    await marksSay(page, "marks: 4,");
    await page.waitForTimeout(300);
    times.push(parseFloat((await page.locator(".preview-time").textContent()).replace("Preview in ", "")));
  }
  times.sort((a, b) => a - b);
  const size = await page.locator("canvas[data-revision]").evaluate((one) => `${one.width} x ${one.height} px drawn`);
  console.log(`preview: median ${times[5]} ms, slowest ${times[9]} ms, ${size}`);
}

/** A new run of the program: the marks are there again, and the model that was saved. */
async function findDraftAgain() {
  expect(existsSync(join(scratch, "taught/draft.yaml")), "no draft is kept");
  const { program, link } = await start([]);
  const page = await openColors(link);
  await marksSay(page, "marks: 4,");
  await page.getByText("goes on with the draft").waitFor();
  await stop(program);
  await page.close();
}
