// SPDX-License-Identifier: BSD-3-Clause
// Stops, continues and kills the program of a flight, loses its Wi-Fi, and lets each source of a mock flight
// fall silent: within a second the page says so, and shows nothing old as what is now:
//
//   node tools/try_silence.js KESTREL FOLDER
import { tryAll } from "./browser.js";
import { startMockServer } from "./mock_server.js";

const flight = "fly sim:figure8 --autopilot sim:px4 --guide --set fly.sim_camera.scale=0.5 --console 127.0.0.1:0".split(" ");

await tryAll(stopProgram, loseNetwork, silenceSources);

/** Waits for a flight whose values are there. */
async function waitForValues(page) {
  await page.waitForFunction(() => /\d/.test(document.querySelector(".numbers dd")?.textContent ?? ""));
  await page.locator(".vehicle li b").filter({ hasText: "armed" }).waitFor();
}

async function stopProgram(t) {
  const { program, link } = await t.start(flight);
  const page = await t.openPage(link);
  await waitForValues(page);
  program.kill("SIGSTOP");
  await t.waitForState(page, /^No data for \d+ s$/);
  await t.expectDashes(page, "stopped");
  await page.getByRole("img", { name: "an old image" }).waitFor();
  await t.takePictures(page, "console_stopped");
  program.kill("SIGCONT");
  await waitForValues(page);
  program.kill("SIGKILL");
  await t.waitForState(page, /^No data for \d+ s$/);
  await page.getByText("Connection lost, trying again").waitFor();
  await t.expectDashes(page, "killed");
}

async function loseNetwork(t) {
  const { link } = await t.start(flight);
  const { relay, link: relayed } = await t.relay(link);
  const page = await t.openPage(relayed);
  await waitForValues(page);
  relay.lose();
  await t.waitForState(page, /^No data for \d+ s$/);
  await t.expectDashes(page, "out of reach");
  // The network comes back, and what it held is gone.
  await waitForValues(page);
}

async function silenceSources(t) {
  const server = await startMockServer(0);
  const page = await t.openPage(`http://127.0.0.1:${server.address().port}/`);
  const value = (name) => page.locator(".numbers div").filter({ hasText: name }).locator("dd").textContent();
  const mode = page.locator(".vehicle li b").first();
  await page.waitForFunction(() => /\d/.test(document.querySelector(".numbers dd")?.textContent ?? ""));
  server.silent.set("autopilot", Date.now());
  await page.getByRole("alert").filter({ hasText: /^Autopilot silent for \d+ s$/ }).waitFor();
  t.expect((await mode.textContent()) === "–", "the mode of a silent autopilot is shown");
  t.expect(/\d/.test(await value("Camera height")), "the height is not shown any more");
  await t.expectAccessible(page, "autopilot silent");
  server.silent.delete("autopilot");
  server.silent.set("pose", Date.now());
  await page.getByRole("alert").filter({ hasText: /^No pose for \d+ s$/ }).waitFor();
  t.expect((await mode.textContent()) === "GUIDED", "the mode does not come back");
  t.expect((await value("Camera offset")).startsWith("–"), "an offset without a pose is shown");
  server.silent.delete("pose");
  server.silent.set("frames", Date.now());
  await t.waitForState(page, /^No images for \d+ s$/);
  t.expect((await value("Camera height")).startsWith("–"), "a height without images is shown");
  await page.getByRole("img", { name: "an old image" }).waitFor();
  server.silent.clear();
  await t.waitForState(page, /^(?!No images)/);
  server.closeAllConnections();
  server.close();
}
