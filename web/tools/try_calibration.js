// SPDX-License-Identifier: BSD-3-Clause
// Calibrates from recordings on the page of the program as a person would, with keys alone where
// that is the harder way: mount and clock while the recording plays, cancel, save, download, lens, a
// refusal:
//
//   node tools/try_calibration.js KESTREL FOLDER
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { tryAll } from "./browser.js";

await tryAll(calibrate, beRefused);

async function openFlight(t, frames, rate, args) {
  const settings = [`frames=${frames}`, `rate_hz=${rate}`, "ground.map_px=512", "shutter.rays_per_pixel=4"];
  const flight = t.simulate("landing", "flight", ["--scenario", "aggressive", "--seed", "11"], settings);
  const { link } = await t.start(["console", flight, "--address", "127.0.0.1:0", ...args]);
  const page = await t.openPage(link);
  await page.locator(".replay-time").waitFor();
  return page;
}

async function calibrate(t) {
  const page = await openFlight(t, 120, 15, ["--output", "calibrated"]);
  await calibrateByKeys(t, page);
  await saveTwice(t, page);
  await cancel(page);
  await calibrateLens(t, page);
}

async function calibrateByKeys(t, page) {
  await page.keyboard.press("k");
  await page.keyboard.press("l");
  await t.tabTo(page, "radio", "mount and clock");
  await t.tabTo(page, "checkbox", "the pattern moves, on a smooth path");
  await page.keyboard.press("Space");
  await t.tabTo(page, "button", "Calibrate");
  await page.keyboard.press("Enter");
  await page.getByRole("heading", { name: "Result: mount and clock" }).waitFor();
  const clock = await page.getByRole("row", { name: /clock offset/ }).textContent();
  t.expect(/± 0\.0\d+/.test(clock), `clock: ${clock}`);
  await t.takePicture(page, "console_calibration", { fullPage: true });
  await t.expectAccessible(page, "calibration");
}

async function saveTwice(t, page) {
  await page.getByRole("button", { name: "Save" }).click();
  await page.getByText("Saved as calibrated/mount_clock.yaml").waitFor();
  await page.getByRole("button", { name: "Save" }).click();
  await page.getByText("Saved as calibrated/mount_clock_2.yaml").waitFor();
  const saved = readFileSync(join(t.scratch, "calibrated/mount_clock.yaml"), "utf8");
  t.expect(existsSync(join(t.scratch, "calibrated/mount_clock_2.yaml")), "the second file is not there");
  const download = page.waitForEvent("download");
  await page.getByRole("link", { name: "Download" }).click();
  const given = readFileSync(await (await download).path(), "utf8");
  t.expect(given === saved, "the download is not what was saved");
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

async function calibrateLens(t, page) {
  await page.getByRole("button", { name: "Calibration" }).click();
  await page.getByLabel("lens", { exact: true }).check();
  await page.getByRole("button", { name: "Calibrate" }).click();
  await page.getByRole("heading", { name: "Result: lens" }).waitFor();
  await t.takePicture(page, "console_calibration_lens", { fullPage: true });
  await t.expectAccessible(page, "lens");
}

async function beRefused(t) {
  const page = await openFlight(t, 12, 4, []);
  await page.keyboard.press("l");
  await page.getByRole("button", { name: "Calibrate" }).click();
  const refusal = await page.getByRole("alert").textContent();
  t.expect(/images with poses around them, expected at least 20/.test(refusal), `refusal: ${refusal}`);
  await t.takePicture(page, "console_calibration_refused", { fullPage: true });
  await t.expectAccessible(page, "refusal");
}
