// SPDX-License-Identifier: BSD-3-Clause
// Comes with a camera and nothing else, as a new user does: its picture, a snapshot, and the lens
// calibrated by a chessboard that is shown to it, until it is saved; a camera that is not there:
//
//   node tools/try_camera.js KESTREL FOLDER
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { tryAll } from "./browser.js";
import { board, lens, writeChessboardVideo } from "./chessboard_video.js";

await tryAll(missCamera, calibrateLens);

async function calibrateLens(t) {
  const camera = writeChessboardVideo(join(t.scratch, "chessboard.gray"));
  const began = Date.now();
  const { link } = await t.start(["console", camera, "--address", "127.0.0.1:0"]);
  const page = await t.openPage(link);
  await t.waitForImage(page);
  await t.waitForState(page, /live/);
  await page.getByRole("button", { name: "Snapshot" }).click();
  await page.getByText(/snapshot kept as/).first().waitFor();
  t.expect(readdirSync(t.scratch).some((name) => /^snapshot_.*png$/.test(name)), "no snapshot is there");
  await page.getByLabel("Columns (inner corners)").fill(String(board.columns));
  await page.getByLabel("Rows (inner corners)").fill(String(board.rows));
  await page.getByLabel("Side of a square, mm").fill(String(1000 * board.side));
  await page.getByRole("button", { name: "Begin" }).click();
  await page.getByText("Residual (RMS)").waitFor();
  await takePictures(t, page, "console_camera_lens");
  await t.expectAccessible(page, "lens");
  await page.getByText("Good enough: save it.").waitFor();
  await saveTwice(t, page);
  await takePictures(t, page, "console_camera_saved");
  console.log(`from the command to the saved calibration: ${((Date.now() - began) / 1000).toFixed(0)} s`);
}

async function saveTwice(t, page) {
  await page.getByRole("button", { name: "Save", exact: true }).click();
  await page.getByText(/Saved as .*camera.yaml/).waitFor();
  const saved = readFileSync(join(t.scratch, "camera.yaml"), "utf8");
  const focal = Number(saved.match(/intrinsics: *\[([\d.]+)/)?.[1]);
  t.expect(Math.abs(focal / lens.focal - 1) < 0.01, `focal length: ${focal}, rendered with ${lens.focal}`);
  await page.getByRole("button", { name: "Save", exact: true }).click();
  await page.getByText("camera.yaml exists already").waitFor();
  await page.getByRole("button", { name: "Replace it" }).click();
  await page.getByText(/Saved as .*camera.yaml/).waitFor();
  const next = await page.locator(".lens code").textContent();
  t.expect(/^kestrel fly '.*' --camera .*camera.yaml --console$/.test(next), `next command: ${next}`);
  t.expect(existsSync(join(t.scratch, "camera.yaml")), "the calibration is gone");
}

async function takePictures(t, page, name) {
  for (const [width, height] of [[1280, 900], [390, 844]]) {
    await page.setViewportSize({ width, height });
    await page.waitForTimeout(300);
    await t.takePicture(page, `${name}_${width}`);
  }
  await page.setViewportSize({ width: 1440, height: 1000 });
}

async function missCamera(t) {
  const { link } = await t.start(["console", "/dev/video63", "--address", "127.0.0.1:0"]);
  const page = await t.openPage(link);
  await t.waitForState(page, /no picture/);
  await page.getByText(/trying again: there is no \/dev\/video63/).waitFor();
  await t.takePicture(page, "console_camera_missing");
  await t.expectAccessible(page, "missing");
}
