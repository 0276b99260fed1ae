// SPDX-License-Identifier: BSD-3-Clause
// Looks at a flight, a recording and a hunt as the detector sees them, and teaches a colour while the
// camera is live: keeps frames, marks an object in one, teaches, saves, and hunts with the model:
//
//   node tools/try_live.js KESTREL FOLDER
import { readdirSync } from "node:fs";
import { join } from "node:path";
import { tryAll } from "./browser.js";

const landing = ["frames=60", "rate_hz=10", "ground.map_px=512", "shutter.rays_per_pixel=4"];
const hunt = ["frames=12", "ground.map_px=1024", "shutter.rays_per_pixel=3"];

await tryAll(seeThresholdsOfAFlight, seeThresholdsOfARecording, teachInFlight);

/** Waits until the picture on the screen is what is asked for, as "threshold 1/8". */
function waitForView(page, view) {
  return page.getByRole("img", { name: new RegExp(`^${view},`) }).waitFor();
}

function isPressed(page, name) {
  return page.getByRole("button", { name, exact: true }).getAttribute("aria-pressed");
}

async function frameNumber(page) {
  return (await page.locator(".age").textContent()).match(/Frame (\d+)/)[1];
}

async function seeThresholdsOfAFlight(t) {
  simulate(t, ["landing", "--scenario", "figure8"], landing);
  const { link } = await t.start(fly("landing"));
  const page = await t.openPage(link);
  await t.waitForState(page, /tracking/);
  await waitForView(page, "camera image");
  await page.getByRole("button", { name: "threshold 1/2" }).click();
  await waitForView(page, "threshold 1/2");
  await page.waitForTimeout(500);
  await t.takePicture(page, "console_threshold");
  await t.expectAccessible(page, "threshold");
  const before = await frameNumber(page);
  await page.waitForFunction((last) => !document.querySelector(".age").textContent.includes(`Frame ${last},`), before);
  await seeFrozenFrame(page, t);
  await page.keyboard.press("?");
  await page.getByText("next view of the image").waitFor();
}

/** One frame that is frozen, in several views. */
async function seeFrozenFrame(page, t) {
  await page.keyboard.press("k");
  await page.waitForTimeout(1000);
  const frozen = await frameNumber(page);
  await page.keyboard.press("v");
  await waitForView(page, "threshold 1/1");
  await page.keyboard.press("v");
  await waitForView(page, "camera image");
  await page.keyboard.press("V");
  await waitForView(page, "threshold 1/1");
  t.expect((await frameNumber(page)) === frozen, `frozen frame ${frozen}, then ${await frameNumber(page)}`);
  t.expect((await isPressed(page, "threshold 1/1")) === "true", "the view's button is not pressed");
  await page.keyboard.press("k");
  await page.waitForFunction((last) => !document.querySelector(".age").textContent.includes(`Frame ${last},`), frozen);
}

/** A recording with the name of what it is of. */
function simulate(t, what, settings) {
  t.run(["simulate", ...what, "--seed", "3", "--output", what[0], ...settings.flatMap((one) => ["--set", one])]);
}

/** Flies with a recording as the camera, again and again. */
function fly(recording, ...options) {
  return ["fly", recording, "--loop", "--console", "127.0.0.1:0", ...options];
}

async function seeThresholdsOfARecording(t) {
  simulate(t, ["landing", "--scenario", "figure8"], landing);
  const { link } = await t.start(["console", "landing", "--address", "127.0.0.1:0"]);
  const page = await t.openPage(link);
  await page.locator(".replay-time").waitFor();
  await waitForView(page, "camera image");
  // The recording is held: the same frame in another view.
  await page.keyboard.press("v");
  await waitForView(page, "threshold 1/8");
  await page.getByRole("button", { name: "Calibration" }).click();
  await page.getByRole("button", { name: "Replay" }).click();
  await waitForView(page, "threshold 1/8");
  await page.getByRole("button", { name: "camera", exact: true }).click();
  await waitForView(page, "camera image");
}

async function seeSegmentation(page, t) {
  await page.getByRole("button", { name: "segmentation" }).click();
  await waitForView(page, "segmentation");
  await t.waitForState(page, /in view/);
  await page.keyboard.press("k");
  await page.waitForTimeout(500);
  await t.takePicture(page, "console_segmentation");
  await t.expectAccessible(page, "segmentation");
  await page.keyboard.press("k");
}

/** The objects that a hunt finds. */
function objectsIn(t, args) {
  const [head, ...rows] = t.run(["hunt", ...args]).trim().split("\n").map((row) => row.split(","));
  const at = (row, name) => row[head.indexOf(name)];
  return rows
    .map((row) => ({ color: at(row, "class"), u: Number(at(row, "u_px")), v: Number(at(row, "v_px")) }))
    .filter(({ color }) => color !== "");
}

async function teachInFlight(t) {
  simulate(t, ["hunt"], hunt);
  const { program, link } = await t.start(fly("hunt", "--hunt"));
  const page = await t.openPage(link);
  await seeSegmentation(page, t);
  await page.getByRole("button", { name: "Colours" }).click();
  await page.getByText("No frame is kept yet").waitFor();
  await page.getByRole("img", { name: "camera image" }).waitFor();
  await t.expectAccessible(page, "no frame kept");
  const object = await keepAFrameWithAnObject(page, t);
  const { color } = object;
  await page.getByRole("group", { name: "Mark as" }).getByRole("button", { name: color }).click();
  await page.keyboard.press("g");
  await page.locator("canvas[data-revision]").click({ position: await onScreen(page, object) });
  await page.locator(".replay-time").filter({ hasText: "marks: 1," }).waitFor();
  await page.keyboard.press("e");
  await page.getByText(`taught ${color}`).waitFor();
  await page.getByText(`Found of what is marked ${color}`).waitFor();
  await page.waitForTimeout(500);
  await t.takePicture(page, "console_colors_live");
  await t.expectAccessible(page, "colours of a flight");
  await page.keyboard.press("s");
  await page.getByText("saved as kept/taught/objects.yaml").waitFor();
  await page.keyboard.press("c");
  await waitForView(page, "segmentation");
  await t.stop(program);
  const count = (args) => objectsIn(t, ["hunt", ...args]).filter((one) => one.color === color).length;
  const [known, taught] = [count([]), count(["--model", "kept/taught/objects.yaml"])];
  console.log(`${color} objects found: built-in ${known}, taught in flight ${taught}`);
  t.expect(known > 0 && taught > 0, "what was taught finds nothing");
}

/** Keeps frames, by button and key, until there is an object in one: that. */
async function keepAFrameWithAnObject(page, t) {
  for (let kept = 1; kept <= 12; kept += 1) {
    if (kept === 1) await page.getByRole("button", { name: "Keep frame" }).click();
    else await page.keyboard.press("k");
    await page.getByText(`frame ${kept} is kept as kept/colors_`).waitFor();
    await page.locator(`canvas[data-frame="${kept - 1}"]`).waitFor();
    const folder = readdirSync(join(t.scratch, "kept")).find((name) => name.startsWith("colors_"));
    const file = readdirSync(join(t.scratch, "kept", folder)).sort()[kept - 1];
    const found = objectsIn(t, [`kept/${folder}/${file}`, "--camera", "hunt/mav0/cam0/sensor.yaml"]);
    if (kept > 1 && found.length > 0) return found[0];
  }
  throw new Error("no object is in the frames that were kept");
}

/** Where a pixel of the frame is on the screen. */
async function onScreen(page, { u, v }) {
  const canvas = page.locator("canvas[data-revision]");
  const box = await canvas.boundingBox();
  const scale = box.width / Number(await canvas.getAttribute("data-width"));
  return { x: (u + 0.5) * scale, y: (v + 0.5) * scale };
}
