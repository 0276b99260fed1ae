// SPDX-License-Identifier: BSD-3-Clause
// Opens the page in Debian's Chromium over the mock server, writes pictures of it to a folder, and
// ends with status 1 when axe finds something:
//
//   node tools/pictures.js FOLDER
import { join } from "node:path";
import { chromium } from "playwright-core";
import { findingsOf } from "./axe.js";
import { startMockServer } from "./mock_server.js";

const folder = process.argv[2];
if (!folder) throw new Error("expected a folder for the pictures");
const views = [
  { name: "live-light", theme: "light", width: 1440, height: 1000 },
  { name: "live-dark", theme: "dark", width: 1440, height: 1000 },
  { name: "live-sun", theme: "sun", width: 1440, height: 1000 },
  { name: "live-tablet", theme: "light", width: 820, height: 1180 },
  { name: "replay", theme: "light", width: 1440, height: 1000, isReplay: true },
  { name: "beside-tablet", theme: "sun", width: 1024, height: 768, isReplay: true, isBeside: true },
  { name: "colors", theme: "light", width: 1440, height: 1000, isReplay: true, isColors: true },
  { name: "colors-dark", theme: "dark", width: 1440, height: 1000, isReplay: true, isColors: true },
  { name: "colors-tablet", theme: "sun", width: 820, height: 1180, isReplay: true, isColors: true },
  { name: "calibration-light", theme: "light", width: 1440, height: 1000, isReplay: true, calibrates: true },
  { name: "calibration-dark", theme: "dark", width: 1440, height: 1000, isReplay: true, calibrates: true },
  { name: "calibration-tablet", theme: "sun", width: 820, height: 1180, isReplay: true, calibrates: true },
  { name: "study-light", theme: "light", width: 1440, height: 1000, isStudy: true },
  { name: "study-dark", theme: "dark", width: 1440, height: 1000, isStudy: true },
  { name: "study-tablet", theme: "sun", width: 820, height: 1180, isStudy: true },
  { name: "study-beside", theme: "light", width: 1440, height: 1000, isStudy: true, opens: true },
];

// Pages on a phone and a laptop of a flight that lives, stops, loses its network and ends, and of a replay.
const sizes = [[390, 844], [844, 390], [1280, 900]];
for (const state of ["live", "stopped", "lost", "ended", "replay"]) {
  for (const [width, height] of sizes) {
    for (const theme of ["sun", "dark"]) {
      views.push({ name: `${state}-${width}x${height}-${theme}`, theme, width, height, state, isReplay: state === "replay", isShort: true });
    }
  }
}

// A word after the folder: only views whose names begin so.
const wanted = views.filter(({ name }) => name.startsWith(process.argv[3] ?? ""));
let findings = 0;
const servers = [await startMockServer(8091), await startMockServer(8092, true), await startMockServer(8093, true, true)];
const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox"] });
for (const view of wanted) {
  const page = await browser.newPage({ viewport: { width: view.width, height: view.height }, bypassCSP: false });
  page.on("pageerror", (error) => report(`${view.name}: ${error}`));
  page.on("console", (message) => {
    if (message.type() === "error") report(`${view.name}: ${message.text()}`);
  });
  await page.addInitScript((theme) => localStorage.setItem("kestrel-theme", theme), view.theme);
  await page.goto(`http://127.0.0.1:${view.isStudy ? 8093 : view.isReplay ? 8092 : 8091}/${view.isColors ? "#colors" : ""}`);
  if (view.isStudy) await sortStudy(page, view.opens);
  else await page.waitForFunction(() => !document.querySelector(".screen .empty"));
  if (view.isColors) await teachColor(page);
  else await page.keyboard.press("3");
  if (view.calibrates) await calibrate(page);
  if (view.isReplay && !view.isColors && !view.calibrates && !view.isShort) await detectAgain(page);
  if (view.isBeside) await page.keyboard.press("b");
  await page.waitForTimeout(view.isColors || view.calibrates ? 1000 : view.isShort ? 4000 : 7000);
  await reach(view.state, servers[0]);
  await page.screenshot({ path: join(folder, `${view.name}.png`) });
  for (const finding of await findingsOf(page)) report(`${view.name}: ${finding}`);
  await page.close();
  servers[0].silent.clear();
}
await browser.close();
for (const server of servers) server.close();
process.exit(findings > 0 ? 1 : 0);

/** A flight that has come to a state, some seconds ago. */
async function reach(state, server) {
  if (state === "stopped") server.silent.set("program", Date.now());
  if (state === "ended") server.silent.set("flight", Date.now());
  if (state === "lost") server.sockets.clients.forEach((socket) => socket.terminate());
  if (state === "lost") server.silent.set("program", Date.now());
  if (["stopped", "ended", "lost"].includes(state)) await new Promise((resolve) => setTimeout(resolve, 2500));
}

async function detectAgain(page) {
  await page.getByLabel("Change").selectOption("landing.detector.min_quality");
  await page.getByLabel(/smallest accepted probability/).fill("0.9");
  await page.getByRole("button", { name: "Run" }).click();
  await page.getByText("Second run (below)").waitFor();
}

async function sortStudy(page, opens) {
  await page.getByRole("button", { name: "Recording", exact: true }).click();
  await page.getByRole("button", { name: "Change" }).click();
  if (!opens) return;
  await page.getByRole("row").filter({ hasText: "−1" }).first().click();
  await page.getByRole("heading", { name: "Second run: strict min_quality=0.9" }).waitFor();
}

async function teachColor(page) {
  await page.getByRole("application").focus();
  await page.keyboard.press("Shift+ArrowLeft");
  await page.keyboard.press(" ");
  await page.keyboard.press("e");
  await page.getByText("taught red").waitFor();
}

async function calibrate(page) {
  await page.keyboard.press("l");
  await page.getByRole("button", { name: "Calibrate" }).click();
  await page.getByRole("heading", { name: "Result" }).waitFor();
}

function report(text) {
  console.error(text);
  findings += 1;
}
