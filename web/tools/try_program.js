// SPDX-License-Identifier: BSD-3-Clause
// Watches a simulated flight until it has landed, measures how old pictures are when they are drawn,
// loses the connection and gets it back, sees the program start anew, does it all by the keyboard, comes
// with a wrong token:
//
//   node tools/try_program.js KESTREL FOLDER
import { tryAll } from "./browser.js";

const flight = "fly sim:figure8 --autopilot sim:px4 --guide --set fly.sim_camera.scale=0.5 --console".split(" ");

await tryAll(watchFlight, measureLatency, loseConnection, restartProgram, useKeyboard, comeWithTokens);

async function watchFlight(t) {
  const { program, link } = await t.start([...flight, "127.0.0.1:0"]);
  const page = await t.openPage(link);
  await t.waitForImage(page);
  await t.expectAccessible(page, "live");
  await page.getByRole("button", { name: "Snapshot" }).click();
  await page.getByText(/snapshot kept as kept/).waitFor();
  await page.getByRole("button", { name: "Record" }).click();
  await page.getByRole("button", { name: "Stop recording" }).waitFor();
  await page.keyboard.press("r");
  await page.getByText("the recording is written").waitFor();
  await page.getByRole("heading", { name: "Doctor" }).waitFor();
  await t.waitForState(page, /(descend|commit), tracking/, 90_000);
  const age = await page.locator(".age").textContent();
  t.expect(/Frame \d+, \d+ ms old/.test(age), `age of the picture: ${age}`);
  await page.waitForTimeout(1000);
  await t.takePicture(page, "console_live");
  await t.takePictures(page, "console_live");
  await page.getByText("landed: contact with the deck").first().waitFor({ timeout: 90_000 });
  // The program stays with the page, which says how the flight ended.
  await t.waitForState(page, /Flight over: landed/);
  await t.expectDashes(page, "over");
  await t.takePictures(page, "console_ended");
  await page.reload();
  await t.waitForState(page, /Flight over: landed/);
  await t.stop(program);
  t.expect(program.exitCode === 0, `the flight ended with status ${program.exitCode}`);
}

/** From capture until the program knows that the picture is drawn, once a second, at 20 pictures/s. */
async function measureLatency(t) {
  const readings = 20;
  const { link } = await t.start(["fly", simulateFlight(t, 20), "--loop", "--console", "127.0.0.1:0"]);
  const page = await t.openPage(link);
  const times_ms = [];
  let pictures = 0;
  page.on("websocket", (socket) =>
    socket.on("framereceived", ({ payload }) => {
      if (typeof payload !== "string") return;
      const message = JSON.parse(payload);
      if (message.kind !== "link" || message.draw_ms === null) return;
      times_ms.push(message.draw_ms);
      pictures = message.images;
    }),
  );
  const began = Date.now();
  await page.reload();
  while (times_ms.length < readings) await page.waitForTimeout(200);
  const rate_hz = (1000 * pictures) / (Date.now() - began);
  const sorted = [...times_ms].sort((a, b) => a - b);
  const median = sorted[readings / 2];
  console.log(
    `capture to drawn: median ${median.toFixed(0)} ms, ` +
      `slowest ${sorted[readings - 1].toFixed(0)} ms, ${rate_hz.toFixed(1)} pictures/s`,
  );
  // 100 ms are wanted; this much on a computer that others use as well.
  t.expect(median <= 250, `capture to drawn: ${median} ms`);
}

/** Resolves when a picture has come after those that were shown before. */
async function waitForNextPicture(page, t) {
  const shown = () => document.querySelector(".age")?.textContent.match(/Frame (\d+)/)?.[1] ?? "";
  const before = await page.evaluate(shown);
  const isNext = (last) => {
    const now = document.querySelector(".age")?.textContent.match(/Frame (\d+)/)?.[1] ?? "";
    return now !== "" && now !== last;
  };
  await page.waitForFunction(isNext, before);
  await t.waitForState(page, /^(?!Connect|No data)/);
}

async function loseConnection(t) {
  const { link } = await t.start([...flight, "127.0.0.1:0"]);
  const { relay, link: relayed } = await t.relay(link);
  const page = await t.openPage(relayed);
  await waitForNextPicture(page, t);
  relay.cut();
  await t.waitForState(page, /^No data for \d+ s$/);
  await page.getByText("Connection lost, trying again").waitFor();
  await t.expectDashes(page, "lost");
  await relay.open();
  await waitForNextPicture(page, t);
  relay.cut();
  await t.waitForState(page, /^No data for \d+ s$/);
  await t.takePictures(page, "console_lost");
}

async function restartProgram(t) {
  const first = await t.start([...flight, "127.0.0.1:0"]);
  const page = await t.openPage(first.link);
  await waitForNextPicture(page, t);
  await t.stop(first.program);
  await t.waitForState(page, /Flight over: ended by the user/);
  const { port } = new URL(first.link);
  const second = await t.start([...flight, `127.0.0.1:${port}`]);
  await waitForNextPicture(page, t);
  await t.stop(second.program);
  await t.waitForState(page, /Flight over: ended by the user/);
  // With a token now, which this browser does not know.
  const secret = ["--set", "console.token=0123456789abcdef"];
  await t.start([...flight, `127.0.0.1:${port}`, ...secret]);
  await t.waitForState(page, /token is not known/);
}

async function useKeyboard(t) {
  const { link } = await t.start([...flight, "127.0.0.1:0"]);
  const page = await t.openPage(link);
  await waitForNextPicture(page, t);
  const isPressed = (name) => page.getByRole("button", { name }).getAttribute("aria-pressed");
  await t.tabTo(page, "button", "Snapshot");
  await page.keyboard.press("Enter");
  await page.getByText(/snapshot kept as kept/).waitFor();
  await t.tabTo(page, "button", "freeze");
  await page.keyboard.press("Space");
  t.expect((await isPressed("freeze")) === "true", "the image is not frozen by Space");
  await page.keyboard.press("k");
  t.expect((await isPressed("freeze")) === "false", "the image is still frozen after k");
  const before = await isPressed("detection");
  await page.keyboard.press("1");
  t.expect((await isPressed("detection")) !== before, "1 does not switch the detection");
  await page.keyboard.press("t");
  await page.getByRole("button", { name: "Theme: dark" }).waitFor();
  await t.expectAccessible(page, "dark");
  await page.keyboard.press("?");
  await page.getByRole("dialog", { name: "Keys" }).waitFor();
  await page.keyboard.press("Escape");
  await page.getByRole("dialog", { name: "Keys" }).waitFor({ state: "hidden" });
}

/** Renders a flight of six seconds; the folder. */
function simulateFlight(t, rate_hz) {
  const args = ["simulate", "landing", "--scenario", "figure8", "--seed", "3", "--output", "flight"];
  const settings = [`frames=${6 * rate_hz}`, `rate_hz=${rate_hz}`, "ground.map_px=512", "shutter.rays_per_pixel=4"];
  t.run([...args, ...settings.flatMap((setting) => ["--set", setting])]);
  return "flight";
}

async function comeWithTokens(t) {
  const { link } = await t.start(
    "fly sim:standing --autopilot sim:px4 --console 127.0.0.1:0 --set console.token=0123456789abcdef".split(" "),
  );
  const page = await t.openPage(link.replace("abcdef", "abcdee"));
  await page.getByText("who has its token").waitFor();
  await page.getByLabel("Token").fill("0123456789abcdef");
  await page.getByRole("button", { name: "Open" }).click();
  await page.waitForFunction(() => document.querySelector(".state-word")?.textContent !== "Connecting");
  t.expect(!page.url().includes("token"), "the token stays in the address");
}
