// SPDX-License-Identifier: BSD-3-Clause
// Looks at a study as a person would: reads and sorts its table, replays the recording that got worst
// with both configurations beside each other, is told why another cannot be opened, all by the
// keyboard as well:
//
//   node tools/try_study.js KESTREL FOLDER
import { spawnSync } from "node:child_process";
import { mkdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { tryAll } from "./browser.js";

const frames = 60;
/** From this frame on, counted from 0, the strict configuration finds nothing in the study. */
const firstLost = 36;

const tables = `
CREATE TABLE unit(key TEXT PRIMARY KEY, recording TEXT, piece INTEGER, configuration TEXT, version TEXT,
  task TEXT, seed INTEGER, state TEXT, reason TEXT, frames INTEGER, path TEXT);
CREATE TABLE bin(key TEXT, quantity TEXT, lower REAL, upper REAL, frames INTEGER, found INTEGER,
  "false" INTEGER, error_sum REAL);
CREATE TABLE summary(key TEXT, name TEXT, value REAL);
CREATE TABLE worst(key TEXT, rank INTEGER, time_ns INTEGER, frame TEXT, what TEXT, value REAL);
CREATE TABLE detection(key TEXT, time_ns INTEGER, frame TEXT, found INTEGER, "false" INTEGER, error_m REAL);
CREATE TABLE configuration(name TEXT, version TEXT, task TEXT, place INTEGER, command TEXT, arguments TEXT, text TEXT);
INSERT INTO configuration VALUES('usual', 'v1', 'land', 0, 'kestrel', '[]', '');
INSERT INTO configuration VALUES('strict', 'v1', 'land', 1, 'kestrel', '[]', 'landing: {detector: {min_quality: 1}}')`;

await tryAll(replayTheWorst, useKeysAlone);

/** A study of a flight, of one that is on another computer, and of one that failed. */
function makeStudy(t) {
  const settings = [`frames=${frames}`, "rate_hz=10", "ground.map_px=256", "shutter.rays_per_pixel=2"];
  const flight = join(t.scratch, t.simulate("landing", "flight", ["--scenario", "figure8", "--seed", "3"], settings));
  const rows = readFileSync(join(flight, "mav0/cam0/data.csv"), "utf8").trim().split("\n").slice(1);
  const times = rows.map((row) => row.split(",")[0]);
  const units = [
    unitOf("gusts", "usual", times, frames, flight),
    unitOf("gusts", "strict", times, firstLost, flight),
    unitOf("calm", "usual", times, frames, "sftp://nas/calm"),
    unitOf("calm", "strict", times, frames, "sftp://nas/calm"),
    unitOf("dusk", "usual", times, frames, flight),
    failedUnit("dusk", "strict", "killed: more than 4000 MB of memory"),
  ];
  mkdirSync(join(t.scratch, "study"), { recursive: true });
  writeDatabase(join(t.scratch, "study/study.db"), [tables, ...units].join(";\n"));
  return "study";
}

function unitOf(recording, configuration, times, found, path) {
  const key = recording + configuration;
  const unit = `INSERT INTO unit VALUES('${key}', '${recording}', 0, '${configuration}', 'v1', 'land', NULL, 'done', '', ${frames}, '${path}')`;
  const bin = `INSERT INTO bin VALUES('${key}', 'all', -1e999, 1e999, ${frames}, ${found}, 0, 1)`;
  const detections = times.map((time, i) => {
    const error = i < found ? 0.02 + 0.001 * i : "NULL";
    return `INSERT INTO detection VALUES('${key}', ${time}, '${time}.png', ${i < found ? 1 : 0}, 0, ${error})`;
  });
  return [unit, bin, ...detections].join(";\n");
}

function failedUnit(recording, configuration, reason) {
  return `INSERT INTO unit VALUES('${recording + configuration}', '${recording}', 0, '${configuration}', 'v1', 'land', NULL, 'failed', '${reason}', 0, '')`;
}

/** Node before 22 has no SQLite of its own. */
function writeDatabase(path, sql) {
  const program = "import sqlite3, sys; sqlite3.connect(sys.argv[1]).executescript(sys.stdin.read()).connection.commit()";
  const done = spawnSync("python3", ["-c", program, path], { input: sql });
  if (done.status !== 0) throw new Error(done.stderr.toString());
}

async function openStudy(t) {
  const { link } = await t.start(["console", makeStudy(t), "--address", "127.0.0.1:0"]);
  const page = await t.openPage(link);
  await page.getByRole("table").waitFor();
  return page;
}

function namesOf(page) {
  return page.locator(".study-table tbody th").allTextContents();
}

function isAt(page, text) {
  return page.locator(".replay-time").filter({ hasText: text }).waitFor();
}

async function replayTheWorst(t) {
  const page = await openStudy(t);
  t.expect((await namesOf(page)).join() === "dusk,gusts,calm", `the order is ${await namesOf(page)}`);
  await page.getByText("Worse in 1 of 2, too few to prove (2 recordings, 8 are the least).").waitFor();
  t.expect((await page.getByText(/\d worse/).count()) === 0, "the table judges by itself");
  await page.getByText("strict: killed: more than 4000 MB of memory").waitFor();
  await t.takePicture(page, "console_study");
  await t.expectAccessible(page, "study");
  await page.getByRole("button", { name: "Recording" }).click();
  t.expect((await namesOf(page)).join() === "calm,dusk,gusts", `by name the order is ${await namesOf(page)}`);
  await page.getByRole("columnheader", { name: "Recording" }).and(page.locator("[aria-sort=ascending]")).waitFor();
  await page.getByRole("cell", { name: "−40.0" }).click();
  await page.getByRole("heading", { name: "Second run: strict" }).waitFor();
  await isAt(page, `frame ${firstLost + 1} of ${frames}`);
  await page.getByLabel("First run", { exact: true }).filter({ hasText: /found\s*yes/ }).waitFor();
  await page.getByLabel("Second run", { exact: true }).filter({ hasText: /found\s*no/ }).waitFor();
  await t.takePicture(page, "console_study_replay");
  await t.expectAccessible(page, "replay of a study");
  await page.getByRole("button", { name: "Table" }).click();
  await page.getByRole("button", { name: "calm" }).click();
  await page.getByText("calm cannot be replayed: the recording is not on this computer: sftp://nas/calm").waitFor();
  await t.expectAccessible(page, "study, refused");
}

async function useKeysAlone(t) {
  const page = await openStudy(t);
  await t.tabTo(page, "button", "Swap");
  await page.keyboard.press("Enter");
  await page.getByRole("cell", { name: "+40.0" }).waitFor();
  await t.tabTo(page, "button", "gusts");
  await page.keyboard.press("Enter");
  await page.getByRole("heading", { name: "First run: strict" }).waitFor();
  await isAt(page, `frame ${firstLost + 1} of ${frames}`);
  await page.keyboard.press("w");
  await page.getByRole("table").waitFor();
  await page.keyboard.press("?");
  await page.getByRole("dialog", { name: "Keys" }).getByText("to the study's table and back").waitFor();
  await page.keyboard.press("Escape");
  await page.keyboard.press("w");
  await page.getByRole("heading", { name: "Second run: usual" }).waitFor();
}
