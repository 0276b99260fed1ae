// SPDX-License-Identifier: BSD-3-Clause
// Teaches a colour on the page of the program as a person would: of a flight whose objects a model
// without reds does not find, marks a red one by mouse and keys, teaches and saves it, starts the
// program again, and hunts with the saved model. Of a simulated flight, and of hunt_hard where it is
// there, which an independent renderer has made:
//
//   node tools/try_colors.js KESTREL FOLDER
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { tryAll } from "./browser.js";

const hardHunt = fileURLToPath(new URL("../../../shared/data/hunt_hard/discs", import.meta.url));
const blindModel = "blind.yaml";

await tryAll(teachSimulated, teachHard);

async function teachSimulated(t) {
  const settings = ["frames=12", "ground.map_px=1024", "shutter.rays_per_pixel=3"];
  const flight = t.simulate("hunt", "hunt", ["--seed", "4"], settings);
  const known = await teach(t, flight, async (page) => {
    await measurePreview(page);
    await t.takePicture(page, "console_colors");
    await t.expectAccessible(page, "colours");
  });
  expectFound(t, flight, known);
  await findDraftAgain(t, flight);
}

async function teachHard(t) {
  if (!existsSync(hardHunt)) return console.log("left out: there is no hunt_hard");
  const known = await teach(t, hardHunt, (page) => t.takePicture(page, "console_colors_hard"));
  expectFound(t, hardHunt, known);
}

/** Teaches a model without reds what a red one looks like, looks at it, and saves it. */
async function teach(t, flight, look) {
  writeBlindModel(t);
  const known = redsFoundWith(t, flight, []);
  const unknown = redsFoundWith(t, flight, ["--model", blindModel]);
  t.expect(known.length > 0 && unknown.length === 0, `reds: ${known.length} known, ${unknown.length} unknown`);
  const { program, page } = await openColors(t, flight, ["--model", blindModel]);
  await page.keyboard.press("1");
  await page.getByRole("button", { name: "grow" }).click();
  await markReds(t, page, flight, known);
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
  t.expect(parseFloat(recall) > 95, `recall: ${recall}`);
  await page.waitForTimeout(500);
  await look(page);
  await page.keyboard.press("s");
  await page.getByText("saved as taught/objects.yaml").waitFor();
  await t.stop(program);
  await page.close();
  return known;
}

/** The red discs that a hunt finds, by frame. */
function redsFoundWith(t, flight, args) {
  const [head, ...rows] = t.run(["hunt", flight, ...args]).trim().split("\n").map((row) => row.split(","));
  const at = (row, name) => row[head.indexOf(name)];
  return rows
    .filter((row) => at(row, "class") === "red")
    .map((row) => ({ frame: at(row, "frame"), u: Number(at(row, "u_px")), v: Number(at(row, "v_px")) }));
}

function expectFound(t, flight, known) {
  const taught = redsFoundWith(t, flight, ["--model", "taught/objects.yaml"]);
  console.log(`red objects found: built-in ${known.length}, taught ${taught.length}`);
  t.expect(taught.length >= 0.9 * known.length, `the taught model finds ${taught.length} of ${known.length}`);
}

/** The built-in model with a red that nothing has: purple. */
function writeBlindModel(t) {
  const built = readFileSync(new URL("../../src/kestrel/vision/objects/objects.yaml", import.meta.url), "utf8");
  const [before, after] = [built.indexOf("  - name: red"), built.indexOf("  - name: orange")];
  const purple = "  - name: red\n    components:\n      - {weight: 1, mean: [285, 0.9, 0.5], sigma: [4, 0.05, 0.05]}\n";
  writeFileSync(join(t.scratch, blindModel), built.slice(0, before) + purple + built.slice(after));
}

async function openColors(t, flight, args) {
  const { program, link } = await t.start(["console", flight, "--address", "127.0.0.1:0", ...args]);
  const page = await t.openPage(link);
  await page.setViewportSize({ width: 1440, height: 1100 });
  await page.getByRole("button", { name: "Colours" }).click();
  await page.locator("canvas[data-revision]").waitFor();
  return { program, page };
}

function marksSay(page, text) {
  return page.locator(".replay-time").filter({ hasText: text }).waitFor();
}

/** An object of three frames, as a person would click on what is red. */
async function markReds(t, page, flight, known) {
  const images = imageNames(resolve(t.scratch, flight));
  const frames = [...new Set(known.map(({ frame }) => frame))];
  const chosen = [frames[0], frames[Math.floor(frames.length / 2)], frames.at(-1)];
  for (const [i, frame] of chosen.entries()) {
    const number = images.findIndex((image) => frame.endsWith(image));
    await page.getByLabel("Frame", { exact: true }).fill(String(number + 1));
    await page.locator(`canvas[data-frame="${number}"]`).waitFor();
    const red = known.find((one) => one.frame === frame);
    await page.locator("canvas[data-revision]").click({ position: await onScreen(page, red.u, red.v) });
    await marksSay(page, `marks: ${i + 1},`);
  }
}

/** In the order of the frames. */
function imageNames(flight) {
  const rows = readFileSync(join(flight, "mav0/cam0/data.csv"), "utf8").trim().split("\n");
  return rows.filter((row) => !row.startsWith("#")).map((row) => row.split(",")[1].trim());
}

/** Where a pixel of the frame is on the screen. */
async function onScreen(page, u, v) {
  const canvas = page.locator("canvas[data-revision]");
  const box = await canvas.boundingBox();
  const scale = box.width / Number(await canvas.getAttribute("data-width"));
  return { x: (u + 0.5) * scale, y: (v + 0.5) * scale };
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
async function findDraftAgain(t, flight) {
  t.expect(existsSync(join(t.scratch, "taught/draft.yaml")), "no draft is kept");
  const { page } = await openColors(t, flight, []);
  await marksSay(page, "marks: 4,");
  await page.getByText("goes on with the draft").waitFor();
}
