// SPDX-License-Identifier: BSD-3-Clause
// Clicks on something in the live picture, which is then followed, and drags a box around something else:
//
//   node tools/try_follow.js KESTREL FOLDER
import { tryAll } from "./browser.js";

await tryAll(markInFlight);

/** The share of the canvas, as a position for the mouse. */
async function at(canvas, x, y) {
  const box = await canvas.boundingBox();
  return [box.x + x * box.width, box.y + y * box.height];
}

async function markInFlight(t) {
  const settings = ["frames=60", "rate_hz=10", "ground.map_px=512", "shutter.rays_per_pixel=4"];
  t.run(["simulate", "landing", "--scenario", "calm", "--seed", "3", "--output", "flight", ...settings.flatMap((one) => ["--set", one])]);
  const { link } = await t.start(["fly", "flight", "--loop", "--console", "127.0.0.1:0", "--follow"]);
  const page = await t.openPage(link);
  await page.getByRole("img", { name: /^camera image/ }).waitFor();
  await t.waitForState(page, /not marked/);
  await page.getByText("Click on what is to be followed").waitFor();
  await t.expectAccessible(page, "nothing marked");
  const canvas = page.locator(".screen canvas").first();
  await page.mouse.click(...(await at(canvas, 0.5, 0.5)));
  await page.getByText(/follows a box of/).first().waitFor();
  await t.waitForState(page, /following/);
  await page.mouse.move(...(await at(canvas, 0.3, 0.3)));
  await page.mouse.down();
  await page.mouse.move(...(await at(canvas, 0.4, 0.45)), { steps: 5 });
  await t.takePicture(page, "console_marking");
  await page.mouse.up();
  await t.waitForState(page, /following|coasting/);
  await t.takePicture(page, "console_following");
  await page.setViewportSize({ width: 390, height: 844 });
  await page.waitForTimeout(500);
  await t.takePicture(page, "console_following_phone");
}
