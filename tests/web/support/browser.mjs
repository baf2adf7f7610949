/**
 * Chromium for the tests, and the page as they see it.
 */
import assert from "node:assert/strict";
import { chromium } from "playwright-core";

const kArguments = [
  "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync", "--enable-unsafe-swiftshader",
];
const kPatience_ms = 30000;
const kPollEvery_ms = 40;

export const kDesk = { viewport: { width: 1280, height: 800 } };
export const kPhone = { viewport: { width: 375, height: 812 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2 };

export const launch = () => chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: kArguments });

/**
 * Waits until something is so.
 * @template T
 * @param {string} what  for the failure's text
 * @param {() => T | Promise<T>} condition
 * @returns {Promise<T>} what the condition answered, neither false nor null
 */
export async function until(what, condition) {
  const end = Date.now() + kPatience_ms;
  for (;;) {
    const found = await condition();
    if (found) return found;
    if (Date.now() > end) assert.fail(`expected within ${kPatience_ms / 1000} s that ${what}`);
    await new Promise((resolve) => setTimeout(resolve, kPollEvery_ms));
  }
}

/** A page of ours, and everything that went wrong in it. */
export class TweendPage {
  /** @type {string[]} */
  problems = [];

  /**
   * @param {import("playwright-core").Browser} browser
   * @param {string} url
   * @param {import("playwright-core").BrowserContextOptions} [options]
   * @param {(page: import("playwright-core").Page) => Promise<void>} [prepare]  before it is loaded
   */
  static async open(browser, url, options = kDesk, prepare = async () => {}) {
    const self = new TweendPage();
    self.context = await browser.newContext(options);
    self.page = await self.context.newPage();
    self.page.on("console", (m) => ["error", "warning"].includes(m.type()) && self.problems.push(m.text())); // CSP's too
    self.page.on("pageerror", (e) => self.problems.push(String(e)));
    self.page.on("requestfailed", (r) => self.problems.push(`${r.url()}: ${r.failure()?.errorText}`));
    await prepare(self.page);
    await self.page.goto(url);
    return self;
  }

  /** @param {RegExp} [expected] problems that a test makes on purpose */
  async close(expected = /^$/) {
    await this.context.close();
    assert.deepEqual(this.problems.filter((p) => !expected.test(p)), []);
  }

  /** Connected, with a picture. */
  async ready() {
    await this.says("#connection", "Connected");
    await until("a picture is shown", () => this.colours().then((n) => n > 8));
  }

  /** @param {string} selector @param {string | RegExp} text */
  says(selector, text) {
    return until(`${selector} says ${text}`, async () => {
      const found = (await this.page.locator(selector).textContent()) ?? "";
      return typeof text === "string" ? found === text : text.test(found);
    });
  }

  /** The time that is shown, seconds. */
  async time() {
    return Number(await this.page.locator("#time").textContent());
  }

  /** @param {number} seconds */
  stands_at(seconds) {
    return until(`the time stands at ${seconds}`, async () => Math.abs((await this.time()) - seconds) < 0.011 && !(await this.plays()));
  }

  async plays() {
    return (await this.page.locator("#play").getAttribute("aria-label")) === "Pause";
  }

  /** @param {boolean} whether */
  playing(whether) {
    return until(whether ? "it plays" : "it is paused", async () => (await this.plays()) === whether);
  }

  async moves() {
    const before = await this.time();
    await until("the time moves", async () => (await this.time()) !== before);
  }

  /** How many colours the picture has. @returns {Promise<number>} */
  colours() {
    return this.page.evaluate(() => {
      const canvas = /** @type {HTMLCanvasElement} */ (document.getElementById("picture"));
      const copy = Object.assign(document.createElement("canvas"), { width: canvas.width, height: canvas.height });
      const context = /** @type {CanvasRenderingContext2D} */ (copy.getContext("2d", { willReadFrequently: true }));
      context.drawImage(canvas, 0, 0);
      const { data } = context.getImageData(0, 0, copy.width, copy.height);
      return new Set(new Uint32Array(data.buffer)).size;
    });
  }

  /** A small grey copy of the picture, to be compared. @returns {Promise<number[]>} */
  grey() {
    return this.page.evaluate(() => {
      const side = 48;
      const small = Object.assign(document.createElement("canvas"), { width: side, height: side });
      const context = /** @type {CanvasRenderingContext2D} */ (small.getContext("2d", { willReadFrequently: true }));
      context.drawImage(/** @type {HTMLCanvasElement} */ (document.getElementById("picture")), 0, 0, side, side);
      const { data } = context.getImageData(0, 0, side, side);
      return Array.from({ length: side * side }, (_, i) => data[4 * i] + data[4 * i + 1] + data[4 * i + 2]);
    });
  }

  /** Until no newer picture comes, then that picture. @returns {Promise<number[]>} */
  async still() {
    let before = await this.grey();
    await until("the picture stands still", async () => {
      const now = await this.grey();
      const same = difference(before, now) === 0;
      before = now;
      return same;
    });
    return before;
  }
}

/**
 * How far two pictures are apart: the mean over their pixels, 0 … 765.
 * @param {number[]} a
 * @param {number[]} b
 */
export const difference = (a, b) => a.reduce((sum, v, i) => sum + Math.abs(v - b[i]), 0) / a.length;
