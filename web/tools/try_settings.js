// SPDX-License-Identifier: BSD-3-Clause
// Changes the settings of a flight as a pilot in the field does, and flies with them; is refused a
// wrong value, an armed UAV and a program without a file:
//
//   node tools/try_settings.js KESTREL FOLDER
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { tryAll } from "./browser.js";

const quick = ["frames=60", "rate_hz=10", "ground.map_px=256", "shutter.rays_per_pixel=4"];
const file = "# the field at the river\nlanding:\n  target:\n    kind: ring-cross  # ours\n";

await tryAll(changeSettings, refuseWhileArmed, refuseWithoutFile);

function writeConfig(t, text) {
  writeFileSync(join(t.scratch, "kestrel.yaml"), text);
}

function readConfig(t) {
  return readFileSync(join(t.scratch, "kestrel.yaml"), "utf8");
}

async function openSettings(page) {
  await page.locator(".settings summary").click();
  return page.getByRole("form", { name: "Settings" });
}

async function changeSettings(t) {
  t.simulate("landing", "landing", ["--scenario", "calm", "--seed", "2"], quick);
  writeConfig(t, `${file}fly:\n  source: landing\n`);
  const fly = ["fly", "--loop", "--console", "127.0.0.1:0", "--config", "kestrel.yaml"];
  const { program, link } = await t.start(fly);
  const page = await t.openPage(link);
  await t.waitForState(page, /tracking/);
  await t.takePictures(page, "console_settings_folded");
  const form = await openSettings(page);
  t.expect((await form.getByLabel("Camera").inputValue()) === "landing", "the camera is not shown");
  t.expect(await form.getByRole("button", { name: "Save" }).isDisabled(), "nothing is changed, and it can be saved");
  await form.getByLabel("Size of the target").fill("-1");
  await form.getByRole("button", { name: "Save" }).click();
  await form.getByText(/^Not saved: .*size_m/).waitFor();
  t.expect(readConfig(t) === `${file}fly:\n  source: landing\n`, "a wrong value is in the file");
  await t.takePictures(page, "console_settings_refused");
  await form.getByLabel("Size of the target").fill("0.6");
  await form.getByRole("combobox", { name: "Target" }).selectOption("aruco");
  await form.getByLabel("Id of the target").fill("7");
  await form.getByRole("button", { name: "Save" }).click();
  await form.getByText("saved to kestrel.yaml; restart kestrel fly").waitFor();
  await t.takePictures(page, "console_settings_saved");
  const saved = readConfig(t);
  t.expect(saved.startsWith("# the field at the river\n"), `the comment is gone: ${saved}`);
  t.expect(/kind: aruco  # ours\n/.test(saved) && /id: 7\n/.test(saved) && /size_m: 0.6\n/.test(saved), saved);
  await t.stop(program);
  const again = await t.start(fly);
  await page.goto(again.link);
  const next = await openSettings(page);
  t.expect((await next.getByLabel("Id of the target").inputValue()) === "7", "the next start has another id");
  await t.stop(again.program);
}

async function refuseWhileArmed(t) {
  writeConfig(t, file);
  const flight = ["fly", "sim:standing", "--autopilot", "sim:px4", "--set", "fly.sim_camera.scale=0.4"];
  const { program, link } = await t.start([...flight, "--console", "127.0.0.1:0", "--config", "kestrel.yaml"]);
  const page = await t.openPage(link);
  await page.locator(".vehicle li").filter({ hasText: /^motors armed/ }).waitFor();
  const form = await openSettings(page);
  t.expect(await form.getByLabel("Camera").isDisabled(), "the command line's camera can be changed");
  await form.getByLabel("Id of the target").fill("7");
  await form.getByRole("button", { name: "Save" }).click();
  await form.getByText(/^Not saved: the UAV is armed/).waitFor();
  t.expect(readConfig(t) === file, "saved while armed");
  await t.stop(program);
}

async function refuseWithoutFile(t) {
  t.simulate("landing", "landing", ["--scenario", "calm", "--seed", "2"], quick);
  const { program, link } = await t.start(["fly", "landing", "--loop", "--console", "127.0.0.1:0"]);
  const page = await t.openPage(link);
  const form = await openSettings(page);
  await form.getByText("Start kestrel fly with --config FILE to change settings here.").waitFor();
  t.expect(await form.getByLabel("Id of the target").isDisabled(), "can be changed without a file");
  await t.expectAccessible(page, "no file");
  await t.stop(program);
}
