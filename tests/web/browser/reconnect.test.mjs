/** A server that goes and comes back. */
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { TweendPage, launch, until } from "../support/browser.mjs";
import { ServerProcess } from "../support/server_process.mjs";

let browser, server;
before(async () => ([browser, server] = [await launch(), await ServerProcess.start()]));
after(async () => {
  await browser?.close();
  await server?.kill();
});

test("the page says that the server is gone, and goes on when it is back", async () => {
  const page = await TweendPage.open(browser, server.url);
  await page.ready();
  await server.kill();
  await page.says("#connection", "Reconnecting");
  await page.says("#note_text", /^Connection lost: .*Trying again/);
  assert.ok(await page.page.locator("#play").isDisabled());
  const stands = await page.time();
  await page.page.keyboard.press("ArrowRight");
  assert.equal(await page.time(), stands, "nobody is there to say that time goes on");

  // What it shows afterwards must be new.
  await page.page.evaluate(() => {
    const canvas = /** @type {HTMLCanvasElement} */ (document.getElementById("picture"));
    canvas.getContext("2d")?.clearRect(0, 0, canvas.width, canvas.height);
  });
  server = await ServerProcess.start({ listen: server.address });
  await page.ready();
  await until("nothing lies over the picture", () => page.page.locator("#note").isHidden());
  await page.playing(true);
  await page.moves();
  await page.page.keyboard.press("Space");
  await page.playing(false);
  await page.close(/WebSocket connection to .* failed/); // the browser's own words about the attempts
});

test("who is impatient tries at once", async () => {
  const page = await TweendPage.open(browser, server.url);
  await page.ready();
  const { address } = server;
  await server.kill();
  await page.says("#connection", "Reconnecting");
  server = await ServerProcess.start({ listen: address });
  const retry = page.page.locator("#retry");
  // It may have come back by itself meanwhile.
  await retry.click({ timeout: 2000 }).catch(() => {});
  await page.ready();
  await page.close(/WebSocket connection to .* failed/);
});
