/** H.264 as Chromium's WebCodecs decodes it from the real server, and what is there where it can't. */
import assert from "node:assert/strict";
import { after, before, describe, test } from "node:test";
import { TweendPage, difference, kDesk, kPhone, launch, until } from "../support/browser.mjs";
import { ServerProcess } from "../support/server_process.mjs";

/** Of 765: what two lossy encodings of one state may differ by, and what those of different states do at least. */
const kSame = 2.5;
const kOther = 10;

let browser, server;
before(async () => ([browser, server] = [await launch(), await ServerProcess.start()]));
after(async () => {
  await browser?.close();
  await server?.kill();
});

/** The server's own picture of a time, as the page's canvas would show it. */
const drawn_by_server = (page, time) =>
  page.page.evaluate(async (time) => {
    const { width, height } = /** @type {HTMLCanvasElement} */ (document.getElementById("picture"));
    const answer = await fetch(`/scenes/main/frame.png?time=${time}&width=${width}&height=${height}`);
    const picture = await createImageBitmap(await answer.blob());
    const side = 48;
    const small = Object.assign(document.createElement("canvas"), { width: side, height: side });
    const context = /** @type {CanvasRenderingContext2D} */ (small.getContext("2d", { willReadFrequently: true }));
    context.drawImage(picture, 0, 0, side, side);
    const { data } = context.getImageData(0, 0, side, side);
    return Array.from({ length: side * side }, (_, i) => data[4 * i] + data[4 * i + 1] + data[4 * i + 2]);
  }, time);

/** Counts the messages of a method that the page sends. */
const count_calls = (page, method) => {
  const sent = { count: 0 };
  page.on("websocket", (socket) => {
    socket.on("framesent", ({ payload }) => (sent.count += String(payload).includes(`"${method}"`) ? 1 : 0));
  });
  return sent;
};

/** In the page, before its scripts: what WebCodecs is there. */
const kWithout = "delete globalThis.VideoDecoder;";
const kBroken = `
  const Whole = globalThis.VideoDecoder;
  globalThis.VideoDecoder = class extends Whole {
    #init;
    constructor(init) { super(init); this.#init = init; }
    decode() { super.close(); queueMicrotask(() => this.#init.error(new Error("the decoder is broken"))); }
  };`;

const kRefusing = `
  const Whole = globalThis.VideoDecoder;
  globalThis.VideoDecoder = class extends Whole {
    configure() { throw new TypeError("no such codec"); }
  };`;
/** Counts the decoders that are open. */
const kCounted = `
  const Whole = globalThis.VideoDecoder;
  globalThis.open_decoders = 0;
  globalThis.VideoDecoder = class extends Whole {
    constructor(init) { super(init); globalThis.open_decoders += 1; }
    close() { super.close(); globalThis.open_decoders -= 1; }
  };`;
/** The next of the stream's packets seem to come behind others that were skipped. */
const kLossy = `
  const Whole = globalThis.WebSocket;
  globalThis.WebSocket = class extends Whole {
    #lost = 0;
    set onmessage(listener) {
      super.onmessage = (event) => {
        if (typeof event.data !== "string") {
          const header = new DataView(event.data);
          if (header.getUint8(6) === 2) header.setUint32(12, header.getUint32(12, true) + (this.#lost += 1), true);
        }
        listener(event);
      };
    }
  };`;

for (const [name, options] of Object.entries({ desk: kDesk, phone: kPhone })) {
  describe(`H.264 at ${name} size`, () => {
    let page;
    before(async () => {
      await server.call("playback.play");
      page = await TweendPage.open(browser, server.url, options);
      await page.ready();
    });
    after(() => page.close());

    test("is what is played, and moves", async () => {
      await page.says("#meter", /^\d+ fps · .* · H\.264 · \d+ kB\/s$/);
      const first = await page.grey();
      await until("the picture moves", async () => difference(await page.grey(), first) > kOther);
      await page.moves();
    });

    test("shows the scene as it is: paused, and wherever it is sought to", async () => {
      await server.call("playback.pause");
      const times = [0.2, 0.6, 0.15];
      const expected = await Promise.all(times.map((time) => drawn_by_server(page, time)));
      const steps = [1, 2].map((i) => difference(expected[i - 1], expected[i]));
      assert.ok(Math.min(...steps) > kOther, `expected times that can be told apart, found them ${steps} apart`);
      for (const [i, time] of times.entries()) {
        await server.call("playback.seek", { time });
        await until(`the picture is that of ${time} s`, async () => difference(await page.grey(), expected[i]) < kSame);
      }
      await page.says("#meter", /^still · \d+ × \d+ · H\.264$/);
    });

    test("shows it to who comes late, too", async () => {
      await server.call("playback.pause");
      const late = await TweendPage.open(browser, server.url, options);
      await late.ready();
      const { players } = await server.call("playback.get");
      const expected = await drawn_by_server(late, players[0].time);
      await until("the picture is there", async () => difference(await late.grey(), expected) < kSame);
      await late.close();
    });
  });
}

describe("the choice of encoding", () => {
  test("goes from one to another, and the picture stays", async () => {
    await server.call("playback.play");
    const page = await TweendPage.open(browser, server.url);
    await page.ready();
    await page.page.locator("#encoding").selectOption("jpeg");
    await page.says("#meter", /^\d+ fps · .* · JPEG · /);
    await page.page.locator("#encoding").selectOption("h264");
    await page.says("#meter", /^\d+ fps · .* · H\.264 · /);
    await page.ready();
    await page.close();
  });

  test("is JPEG where there is no WebCodecs, and H.264 can't be chosen", async () => {
    const page = await TweendPage.open(browser, server.url, kDesk, (p) => p.addInitScript(kWithout));
    await page.ready();
    await page.says("#meter", /^\d+ fps · .* · JPEG · /);
    assert.ok(await page.page.locator("#encoding_h264").isDisabled());
    await page.says("#message_text", "");
    await page.close();
  });

  test("is JPEG where the decoder fails, after one try with a new key, and it is said", async () => {
    let calls = { count: 0 };
    const page = await TweendPage.open(browser, server.url, kDesk, async (p) => {
      calls = count_calls(p, "stream.request_key");
      await p.addInitScript(kBroken);
    });
    await page.says("#message_text", /H\.264 can't be played, so JPEG is: the decoder is broken/);
    await page.ready();
    await page.says("#meter", /^\d+ fps · .* · JPEG · /);
    assert.equal(calls.count, 1);
    await page.close();
  });

  test("is JPEG where there is no decoder after all, and H.264 can be asked for again", async () => {
    const page = await TweendPage.open(browser, server.url, kDesk, (p) => p.addInitScript(kRefusing));
    await page.says("#message_text", /H\.264 can't be played, so JPEG is: no such codec/);
    await page.ready();
    await page.says("#encoding_auto", "Auto: JPEG (H.264 failed)");
    const picker = page.page.locator("#encoding");
    await picker.selectOption("h264");
    await until("the picker shows what is so", async () => (await picker.inputValue()) === "auto");
    await page.says("#meter", /^\d+ fps · .* · JPEG · /);
    await page.close();
  });

  test("is JPEG where the connection is too slow for H.264, until H.264 is chosen", async () => {
    const page = await TweendPage.open(browser, server.url, kDesk, (p) => p.addInitScript(kLossy));
    await page.says("#meter", /^\d+ fps · .* · JPEG · /);
    await page.says("#encoding_auto", "Auto: JPEG (slow connection)");
    await page.says("#message_text", "");
    await page.ready();
    await page.page.locator("#encoding").selectOption("h264");
    await page.says("#encoding_auto", "Auto");
    await page.close();
  });

  test("costs no decoder while nobody looks", async () => {
    const page = await TweendPage.open(browser, server.url, kDesk, (p) => p.addInitScript(kCounted));
    await page.says("#meter", /^\d+ fps · .* · H\.264 · /);
    const become = (state) =>
      page.page.evaluate((value) => {
        Object.defineProperty(document, "visibilityState", { value, configurable: true });
        document.dispatchEvent(new Event("visibilitychange"));
      }, state);
    for (const [state, decoders] of [["hidden", 0], ["visible", 1]]) {
      await become(state);
      await until(`there are ${decoders} decoders`, async () => (await page.page.evaluate("open_decoders")) === decoders);
    }
    await page.close();
  });
});
