/** What is seen, at both sizes, and the page's own camera. */
import assert from "node:assert/strict";
import { after, before, describe, test } from "node:test";
import { fileURLToPath } from "node:url";
import { TweendPage, difference, kDesk, kPhone, launch, until } from "../support/browser.mjs";
import { ServerProcess } from "../support/server_process.mjs";

/** Pictures of one state differ by less, those of different ones by more. */
const kSame = 0.5;
const kOther = 2;
/** A server whose pictures have half the sides asked for. */
const kHalfSize = fileURLToPath(new URL("../support/fake_server.mjs", import.meta.url));

let browser, server;
before(async () => ([browser, server] = [await launch(), await ServerProcess.start()]));
after(async () => {
  await browser?.close();
  await server?.kill();
});

for (const [name, options] of Object.entries({ desk: kDesk, phone: kPhone })) {
  test(`at ${name} size there is a picture, and nothing sticks out`, async () => {
    const page = await TweendPage.open(browser, server.url, options);
    await page.ready();
    await page.says("#meter", /^\d+ fps · [\d.]+ ms old · \d+ × \d+( of \d+ × \d+)? · (H\.264|JPEG) · [\d.]+ [kM]B\/s$/);
    const wide = await page.page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert.ok(wide <= 0, `expected nothing beyond the right edge, found ${wide} px`);
    await page.close();
  });
}

test("a picture that came smaller than asked for fills its place, and the meter says so", async () => {
  const small = await ServerProcess.start({ program: kHalfSize });
  const page = await TweendPage.open(browser, small.url, kPhone);
  await page.ready();
  await page.says("#meter", /· 375 × 375 of 750 × 750 · JPEG · /);
  const { width, height } = await page.page.locator("#picture").evaluate((c) => ({ width: c.width, height: c.height }));
  assert.deepEqual([width, height], [750, 750]);
  const wide = await page.page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert.ok(wide <= 0, `expected nothing beyond the right edge, found ${wide} px`);
  await page.close();
  await small.kill();
});

test("the picture takes the shape of its place", async () => {
  const page = await TweendPage.open(browser, server.url);
  await page.ready();
  const shape = () =>
    page.page.evaluate(() => {
      const { width, height, clientWidth, clientHeight } = /** @type {HTMLCanvasElement} */ (document.getElementById("picture"));
      return { found: width / height, place: clientWidth / clientHeight };
    });
  const fits = () => until("the picture has the shape of its place", async () => {
    const { found, place } = await shape();
    return Math.abs(found / place - 1) < 0.02;
  });
  await fits();
  const wide = (await shape()).place;
  await page.page.setViewportSize({ width: 800, height: 900 });
  await until("its place is narrower", async () => (await shape()).place < wide);
  await fits();
  await page.ready();
  await page.close();
});

describe("the page's own camera", () => {
  let page, other, whole;

  before(async () => {
    await server.call("playback.stop");
    page = await TweendPage.open(browser, server.url);
    other = await TweendPage.open(browser, server.url);
    await Promise.all([page.ready(), other.ready()]);
    whole = await page.still();
  });
  after(async () => {
    await page.close();
    await other.close();
  });

  const changed = (what) => until(`${what} changes the picture`, async () => difference(await page.grey(), whole) > kOther);
  const restored = () => until("the scene's camera is back", async () => difference(await page.still(), whole) < kSame);

  async function drag(dx, dy) {
    const box = await page.page.locator("#picture").boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    await page.page.mouse.move(x, y);
    await page.page.mouse.down();
    await page.page.mouse.move(x + dx, y + dy, { steps: 12 });
    await page.page.mouse.up();
  }

  test("turns by dragging, goes back by its button, and no other page sees it", async () => {
    const others = await other.still();
    const { revision } = await server.call("scene.describe");
    await drag(180, 60);
    await changed("a drag");
    assert.ok(difference(await other.still(), others) < kSame);
    assert.equal((await server.call("scene.describe")).revision, revision, "it is no edit");
    await page.page.locator("#fit").click();
    await restored();
  });

  test("moves with Shift, goes back by F", async () => {
    await page.page.keyboard.down("Shift");
    await drag(150, 0);
    await page.page.keyboard.up("Shift");
    await changed("a drag with Shift");
    await page.page.keyboard.press("f");
    await restored();
  });

  test("zooms by the wheel and by keys", async () => {
    await page.page.locator("#picture").hover();
    await page.page.mouse.wheel(0, -400);
    await changed("the wheel");
    await page.page.keyboard.press("f");
    await restored();
    for (let i = 0; i < 6; ++i) await page.page.keyboard.press("-");
    await changed("a key");
    await page.page.keyboard.press("f");
    await restored();
  });

  test("an actor that is hidden is gone, and comes back", async () => {
    await page.page.getByRole("button", { name: "Show barb" }).click();
    await until("the picture is empty", async () => (await page.colours()) < 300 && difference(await page.grey(), whole) > kOther / 2);
    await page.page.getByRole("button", { name: "Show barb" }).click();
    await restored();
  });
});

test("two fingers zoom", async () => {
  await server.call("playback.stop");
  const page = await TweendPage.open(browser, server.url, kPhone);
  await page.ready();
  const whole = await page.still();
  const box = await page.page.locator("#picture").boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  const session = await page.context.newCDPSession(page.page);
  const touch = (type, half) =>
    session.send("Input.dispatchTouchEvent", {
      type,
      touchPoints: half === null ? [] : [{ x: x - half, y, id: 1 }, { x: x + half, y, id: 2 }],
    });
  await touch("touchStart", 40);
  for (let half = 45; half <= 100; half += 5) await touch("touchMove", half);
  await touch("touchEnd", null);
  await until("a pinch changes the picture", async () => difference(await page.grey(), whole) > kOther);
  await page.close();
});
