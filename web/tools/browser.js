// SPDX-License-Identifier: BSD-3-Clause
// Common part of the programs try_*.js, each of which uses the page of the program in Debian's
// Chromium as a person would.
import { spawn, spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync } from "node:fs";
import { connect, createServer } from "node:net";
import { tmpdir } from "node:os";
import { join, resolve as resolvePath } from "node:path";
import { chromium } from "playwright-core";
import { findingsOf } from "./axe.js";

/** How long anything may take on a computer that others use, ms. */
const patience = 240_000;

/**
 * Runs one part after the other, each with a Try. The arguments are the program and a folder for
 * pictures. Ends with status 1 when something is not as it should be; the other parts are run all
 * the same.
 */
export async function tryAll(...parts) {
  const [kestrel, folder] = process.argv.slice(2);
  if (!kestrel || !folder) throw new Error("expected the program and a folder for the pictures");
  mkdirSync(folder, { recursive: true });
  const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox"] });
  let faults = 0;
  try {
    for (const part of parts) {
      const one = new Try(browser, resolvePath(kestrel), resolvePath(folder));
      const began = Date.now();
      await part(one).catch((error) => one.expect(false, error.stack));
      await one.end();
      for (const fault of one.faults) console.error(`${part.name}: ${fault}`);
      console.log(`${one.faults.length === 0 ? "ok" : "not ok"}: ${part.name}, ${(Date.now() - began) / 1000} s`);
      faults += one.faults.length;
    }
  } finally {
    await browser.close();
  }
  process.exit(faults > 0 ? 1 : 0);
}

/** Programs and pages, which end with it, and what is not as it should be. */
class Try {
  faults = [];
  /** A folder of its own, where the programs run. */
  scratch = mkdtempSync(join(tmpdir(), "kestrel-page-"));
  #browser;
  #kestrel;
  #folder;
  #programs = [];
  #relays = [];

  constructor(browser, kestrel, folder) {
    this.#browser = browser;
    this.#kestrel = kestrel;
    this.#folder = folder;
  }

  expect(condition, text) {
    if (!condition) this.faults.push(text);
  }

  /** Starts the program with the console; resolves to it and the link that it prints. */
  start(args) {
    const program = spawn(this.#kestrel, args, { cwd: this.scratch });
    this.#programs.push(program);
    return new Promise((resolve, reject) => {
      let said = "";
      program.stderr.on("data", (text) => {
        said += text;
        const link = said.match(/console: (http:\S+)/);
        if (link) resolve({ program, link: link[1] });
      });
      program.on("exit", () => reject(new Error(said)));
    });
  }

  /** Ends a program, and waits until it has. */
  async stop(program) {
    if (program.exitCode !== null || program.signalCode !== null) return;
    const ended = new Promise((resolve) => program.on("exit", resolve));
    program.kill("SIGINT");
    await ended;
  }

  /** Runs the program until it is done; throws when it fails. Returns what it prints. */
  run(args) {
    const done = spawnSync(this.#kestrel, args, { cwd: this.scratch, maxBuffer: 1 << 28 });
    if (done.status !== 0) throw new Error(done.stderr.toString());
    return done.stdout.toString();
  }

  /** Makes a recording; settings are as "frames=60". Returns its folder. */
  simulate(what, folder, args, settings) {
    const changes = settings.flatMap((setting) => ["--set", setting]);
    this.run(["simulate", what, ...args, "--output", folder, ...changes]);
    return folder;
  }

  async openPage(link) {
    const page = await this.#browser.newPage({ viewport: { width: 1440, height: 1000 } });
    page.setDefaultTimeout(patience);
    page.on("pageerror", (error) => this.expect(false, `${link}: ${error}`));
    await page.addInitScript(() => localStorage.setItem("kestrel-theme", "light"));
    await page.goto(link);
    return page;
  }

  /** Numbers, facts of the vehicle and of the plots, as they are on the page. */
  valuesOn(page) {
    return page.locator(".numbers dd, .vehicle li b, .chart-grid figcaption b").allTextContents();
  }

  /** Nothing is shown as a value of now. */
  async expectDashes(page, name) {
    const values = await this.valuesOn(page);
    this.expect(values.length > 3, `${name}: there are no values`);
    const shown = values.filter((value) => !value.startsWith("–"));
    this.expect(shown.length === 0, `${name}: still shows ${shown.join(", ")}`);
    this.expect((await page.locator(".health .sign").allTextContents()).every((sign) => sign.trim() !== "✓"), `${name}: health is ticked`);
  }

  /** Pictures as a phone shows the page, upright and across, and a laptop; in the sun and in the dark. */
  async takePictures(page, name) {
    const before = page.viewportSize();
    for (const [width, height] of [[390, 844], [844, 390], [1280, 900]]) {
      await page.setViewportSize({ width, height });
      for (const theme of ["sun", "dark"]) {
        await page.evaluate((one) => (document.documentElement.dataset.theme = one), theme);
        await page.waitForTimeout(400);
        await this.takePicture(page, `${name}_${width}x${height}_${theme}`);
        await this.expectAccessible(page, `${name}, ${width}x${height}, ${theme}`);
      }
      const isWider = await page.evaluate(() => document.documentElement.scrollWidth > window.innerWidth);
      this.expect(!isWider, `${name}: the page is wider than ${width} px`);
    }
    await page.evaluate(() => (document.documentElement.dataset.theme = "light"));
    await page.setViewportSize(before);
  }

  async waitForImage(page) {
    await page.waitForFunction(() => !document.querySelector(".screen .empty"));
  }

  /** Waits until the state in words is so. */
  async waitForState(page, pattern) {
    const isSo = ({ source }) => new RegExp(source).test(document.querySelector(".state-word")?.textContent ?? "");
    await page.waitForFunction(isSo, { source: pattern.source });
  }

  /** Goes by Tab to what has this role and name. */
  async tabTo(page, role, name) {
    const wanted = page.getByRole(role, { name });
    for (let i = 0; i < 90; i += 1) {
      await page.keyboard.press("Tab");
      if (await wanted.evaluate((element) => element === document.activeElement)) return;
    }
    this.expect(false, `Tab does not lead to ${name}`);
  }

  /** 'options': Playwright's, as fullPage. */
  async takePicture(page, name, options = {}) {
    await page.screenshot({ path: join(this.#folder, `${name}.png`), ...options });
  }

  async expectAccessible(page, name) {
    for (const finding of await findingsOf(page)) this.expect(false, `${name}: ${finding}`);
  }

  /** A network between the page and the program that can be cut, and mended. */
  async relay(link) {
    const relay = new Relay(Number(new URL(link).port));
    this.#relays.push(relay);
    return { relay, link: `http://127.0.0.1:${await relay.open()}/` };
  }

  async end() {
    for (const context of this.#browser.contexts()) await context.close();
    for (const relay of this.#relays) relay.cut();
    for (const program of this.#programs) await this.stop(program);
    rmSync(this.scratch, { recursive: true });
  }
}

class Relay {
  #port = 0;
  #target;
  #server = null;
  #sockets = new Set();

  constructor(target) {
    this.#target = target;
  }

  /** Takes connections, at the same port as before if it has been open. */
  open() {
    this.#server = createServer((socket) => {
      const other = connect(this.#target, "127.0.0.1");
      for (const end of [socket, other]) {
        this.#sockets.add(end);
        end.on("error", () => end.destroy());
        end.on("close", () => this.#sockets.delete(end));
      }
      socket.pipe(other).pipe(socket);
    });
    return new Promise((resolve) => {
      this.#server.listen(this.#port, "127.0.0.1", () => {
        this.#port = this.#server.address().port;
        resolve(this.#port);
      });
    });
  }

  /** Loses all that is sent from now on, as a Wi-Fi out of reach: no end is told. */
  lose() {
    for (const socket of this.#sockets) {
      socket.unpipe();
      socket.pause();
    }
  }

  /** Ends all connections, and takes no more. */
  cut() {
    this.#server.close();
    for (const socket of this.#sockets) socket.destroy();
  }
}
