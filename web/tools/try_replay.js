// SPDX-License-Identifier: BSD-3-Clause
// Replays recordings as a person would, of a landing and of a hunt: scrubs and plays, runs the
// detector again with other options and sees both runs over one picture and beside each other, takes
// a frame, a table and a clip away, opens a result, all by the keyboard as well; sees what the autopilot
// of a recorded flight said:
//
//   node tools/try_replay.js KESTREL FOLDER
import { appendFileSync, readFileSync, statSync, truncateSync } from "node:fs";
import { join } from "node:path";
import { tryAll } from "./browser.js";

const frames = 60;

await tryAll(scrubRecording, compareRuns, saveClip, replayHunt, openHuntResult, useKeysAlone, followAutopilot);

function simulateLanding(t) {
  const settings = [`frames=${frames}`, "rate_hz=10", "ground.map_px=512", "shutter.rays_per_pixel=4"];
  return t.simulate("landing", "flight", ["--scenario", "figure8", "--seed", "3"], settings);
}

function simulateHunt(t) {
  const settings = ["frames=24", "ground.map_px=1024", "shutter.rays_per_pixel=3"];
  return t.simulate("hunt", "hunt", ["--seed", "4"], settings);
}

async function openReplay(t, args) {
  const { link } = await t.start(["console", ...args, "--address", "127.0.0.1:0"]);
  const page = await t.openPage(link);
  await page.locator(".replay-time").waitFor();
  await t.waitForImage(page);
  return page;
}

function isAt(page, text) {
  return page.locator(".replay-time").filter({ hasText: text }).waitFor();
}

async function runAgain(page, option, meaning, value) {
  await page.getByLabel("Change").selectOption(option);
  await page.getByLabel(meaning).fill(value);
  await page.getByRole("button", { name: "Run" }).click();
  await page.getByText("Second run (below)").waitFor();
}

/** Waits until a run says this of the frame. */
function says(page, run, fact) {
  return page.getByLabel(run, { exact: true }).filter({ hasText: fact }).waitFor();
}

async function scrubRecording(t) {
  const page = await openReplay(t, [simulateLanding(t)]);
  await t.waitForState(page, /found|tracking/);
  await page.getByRole("heading", { name: "The whole recording" }).waitFor();
  await page.keyboard.press("k");
  await isAt(page, /frame [2-6]\d of/);
  await page.keyboard.press("k");
  await page.getByRole("slider").focus();
  await page.keyboard.press("End");
  await isAt(page, `frame ${frames} of ${frames}`);
  await page.keyboard.press("Home");
  await isAt(page, `frame 1 of ${frames}`);
  const box = await page.getByRole("slider").boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  await isAt(page, /frame (2|3)\d of/);
  await page.getByRole("button", { name: "+1 frame" }).click();
  await runAgain(page, "landing.detector.min_quality", /smallest accepted probability/, "0.9");
  await page.waitForTimeout(500);
  await page.evaluate(() => scrollTo(0, 0));
  await t.takePicture(page, "console_replay");
  await t.takePictures(page, "console_replay");
}

async function compareRuns(t) {
  const page = await openReplay(t, [simulateLanding(t)]);
  await runAgain(page, "landing.detector.min_quality", /smallest accepted probability/, "1");
  await page.getByRole("slider").focus();
  await page.keyboard.press("Home");
  await page.keyboard.press("d");
  await says(page, "First run", /found\s*yes/);
  await page.getByRole("button", { name: "Beside each other" }).click();
  await says(page, "Second run", /found\s*no/);
  await says(page, "First run", /centre error\s*\d+\.\d+ px/);
  const pictures = page.locator(".screen canvas");
  t.expect((await pictures.count()) === 2, "there are not two pictures");
  const sameSize = await pictures.evaluateAll((all) => all[0].width === all[1].width && all[0].width > 0);
  t.expect(sameSize, "the two pictures differ in size");
  t.expect(await differ(pictures), "the two pictures show the same");
  await t.takePicture(page, "console_beside");
  await t.expectAccessible(page, "beside");
  for (const theme of ["dark", "sun"]) {
    await page.keyboard.press("t");
    await page.getByRole("button", { name: `Theme: ${theme}` }).waitFor();
    await page.waitForTimeout(300);
    await t.takePicture(page, `console_beside_${theme}`);
    await t.expectAccessible(page, `beside, ${theme}`);
  }
  await page.setViewportSize({ width: 1024, height: 768 });
  await page.waitForTimeout(300);
  await t.takePicture(page, "console_beside_tablet");
  const isWider = await page.evaluate(() => document.documentElement.scrollWidth > window.innerWidth);
  t.expect(!isWider, "the page is wider than a tablet");
  await page.keyboard.press("b");
  await pictures.nth(1).waitFor({ state: "detached" });
}

/** Whether two canvases have other pixels. */
function differ(canvases) {
  return canvases.evaluateAll(([one, other]) => {
    const pixels = (canvas) => canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
    const [a, b] = [pixels(one), pixels(other)];
    return a.some((value, i) => value !== b[i]);
  });
}

async function saveClip(t) {
  const page = await openReplay(t, [simulateLanding(t)]);
  await page.getByText("Clip: frames 1 to 60").waitFor();
  for (let i = 0; i < 10; i += 1) await page.keyboard.press(".");
  await isAt(page, "frame 11 of");
  await page.keyboard.press("i");
  await page.getByRole("slider").focus();
  await page.keyboard.press("End");
  await isAt(page, `frame ${frames} of`);
  await page.getByRole("button", { name: "−1 frame" }).click();
  await isAt(page, `frame ${frames - 1} of`);
  await page.getByRole("button", { name: "End here" }).click();
  await page.getByText("Clip: frames 11 to 59").waitFor();
  await t.takePicture(page, "console_clip");
  await t.expectAccessible(page, "clip");
  const coming = page.waitForEvent("download");
  await page.getByRole("button", { name: "Save clip with overlays" }).click();
  const download = await coming;
  t.expect(/^overlays-10-58\.(mp4|avi)$/.test(download.suggestedFilename()), download.suggestedFilename());
  const video = readFileSync(await download.path());
  const isVideo = video.subarray(4, 8).toString() === "ftyp" || video.subarray(0, 4).toString() === "RIFF";
  t.expect(isVideo && video.length > 10_000, `the clip is no video, ${video.length} bytes`);
  await page.getByRole("button", { name: "All" }).click();
  await page.getByText("Clip: frames 1 to 60").waitFor();
}

async function replayHunt(t) {
  const page = await openReplay(t, ["--hunt", simulateHunt(t)]);
  await page.keyboard.press("k");
  await isAt(page, "frame 24 of 24");
  await page.getByRole("button", { name: "truth" }).waitFor();
  const map = await page.getByRole("img", { name: /^map/ }).getAttribute("aria-label");
  t.expect(/[1-9]\d* objects in the map/.test(map), `map: ${map}`);
  await runAgain(page, "hunt.detector.min_pixels", /smallest segment/, "100000");
  await page.keyboard.press("b");
  await says(page, "Second run", /objects\s*0/);
  await page.keyboard.press("d");
  await page.keyboard.press("D");
  await says(page, "First run", /found\s*[1-9]\d* of [1-9]/);
  await page.waitForTimeout(500);
  await t.takePicture(page, "console_hunt");
  await t.expectAccessible(page, "hunt");
}

async function openHuntResult(t) {
  const flight = simulateHunt(t);
  t.run(["hunt", flight, "--output", "result"]);
  const page = await openReplay(t, ["--hunt", flight, "result"]);
  const coming = page.waitForEvent("download");
  await page.getByRole("link", { name: "detections (CSV)" }).click();
  const table = readFileSync(await (await coming).path(), "utf8");
  t.expect(table === readFileSync(`${t.scratch}/result/object_detections.csv`, "utf8"), "another table");
  await page.getByRole("button", { name: "trouble ▶" }).click();
  await page.getByRole("button", { name: "Colours" }).click();
  await page.locator("canvas[data-revision]").waitFor();
}

/** Does by keys alone what is done by hand above. */
async function useKeysAlone(t) {
  const page = await openReplay(t, [simulateLanding(t)]);
  await page.keyboard.press("?");
  const help = page.getByRole("dialog", { name: "Keys" });
  await help.getByText("two runs beside each other").waitFor();
  await help.getByText("a clip begins with this frame").waitFor();
  await page.keyboard.press("Escape");
  await t.tabTo(page, "combobox", /^Change/);
  await page.keyboard.press("ArrowDown");
  await t.tabTo(page, "textbox", /outer_diameter/);
  await page.keyboard.press("Control+a");
  await page.keyboard.type("0.9");
  await page.keyboard.press("Enter");
  await page.getByText("Second run (below)").waitFor();
  await t.tabTo(page, "button", "Beside each other");
  await page.keyboard.press("Space");
  await page.locator(".screen canvas").nth(1).waitFor();
  await page.keyboard.press("b");
  await page.locator(".screen canvas").nth(1).waitFor({ state: "detached" });
  await page.keyboard.press(".");
  await isAt(page, "frame 2 of");
  await page.keyboard.press("o");
  await page.getByText("Clip: frames 1 to 2").waitFor();
  const coming = page.waitForEvent("download");
  await t.tabTo(page, "button", /^Save clip$/);
  await page.keyboard.press("Enter");
  t.expect((await coming).suggestedFilename().startsWith("clip-0-1."), "another clip");
  await page.keyboard.press("a");
  await page.getByText("Clip: frames 1 to 60").waitFor();
}

/** Mode, motors, battery and texts are those of the frame; of a damaged log, what is left. */
async function followAutopilot(t) {
  t.run(["fly", "sim:standing", "--autopilot", "sim:ardupilot", "--record", "flight", "--output", "flown"]);
  const page = await openReplay(t, ["flight"]);
  await seekTo(page, 0.1);
  await vehicleSays(page, /mode LOITER.*motors armed.*battery \d+\.\d V, \d+ %/);
  await eventsSay(page, /ArduPilot \(system 1\) heard, LOITER, armed/);
  const early = await eventsOf(page).textContent();
  t.expect(!/mode LAND|Disarming/.test(early), `events of later are listed: ${early}`);
  await seekTo(page, 0.6);
  await vehicleSays(page, /mode LAND.*motors armed/);
  await eventsSay(page, /mode LAND, armed.*autopilot: PrecLand: Target Found/);
  await t.takePicture(page, "console_replay_flight");
  await t.takePictures(page, "console_replay_flight");
  await takeEventsOnPhone(t, page);
  await page.getByRole("slider").focus();
  await page.keyboard.press("End");
  await vehicleSays(page, /mode LAND.*motors disarmed/);
  await eventsSay(page, /mode LAND, disarmed.*autopilot: Disarming motors/);
  await showDamagedLog(t, join(t.scratch, "flight/mavlink.tlog"));
}

async function showDamagedLog(t, log) {
  truncateSync(log, Math.floor(statSync(log).size / 2));
  appendFileSync(log, "cut");
  const page = await openReplay(t, ["flight"]);
  await eventsSay(page, /mavlink\.tlog: \d+ of \d+ bytes are damaged or cut off: the rest is shown/);
  await seekTo(page, 0.1);
  await vehicleSays(page, /mode LOITER.*motors armed/);
  await page.getByRole("slider").focus();
  await page.keyboard.press("End");
  await vehicleSays(page, /^mode not recorded/);
}

async function takeEventsOnPhone(t, page) {
  const before = page.viewportSize();
  await page.setViewportSize({ width: 390, height: 844 });
  await page.getByRole("button", { name: "events", exact: true }).click();
  await eventsOf(page).scrollIntoViewIfNeeded();
  await t.takePicture(page, "console_replay_events_390x844");
  await page.setViewportSize(before);
}

/** Presses on the timeline, at a part of its length. */
async function seekTo(page, part) {
  const box = await page.getByRole("slider").boundingBox();
  await page.mouse.click(box.x + box.width * part, box.y + box.height / 2);
}

function vehicleSays(page, facts) {
  return page.getByRole("group", { name: "Vehicle" }).filter({ hasText: facts }).waitFor();
}

function eventsOf(page) {
  return page.getByLabel("Events, the newest first");
}

function eventsSay(page, text) {
  return eventsOf(page).filter({ hasText: text }).waitFor();
}
