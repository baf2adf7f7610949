/** Playback by mouse and by keyboard, and two pages that agree. */
import assert from "node:assert/strict";
import { after, before, beforeEach, describe, test } from "node:test";
import { TweendPage, launch, until } from "../support/browser.mjs";
import { ServerProcess } from "../support/server_process.mjs";

let browser, server, page, duration;

before(async () => {
  [browser, server] = [await launch(), await ServerProcess.start()];
  page = await TweendPage.open(browser, server.url);
  await page.ready();
  duration = Number(await page.page.locator("#duration").textContent());
  assert.ok(duration > 1);
});
after(async () => {
  await page?.close();
  await browser?.close();
  await server?.kill();
});

beforeEach(async () => {
  await page.page.locator("body").click({ position: { x: 300, y: 10 } }); // nobody has the focus
  await server.call("playback.set", { speed: 1, loop: "repeat" });
  await server.call("playback.stop");
  await page.stands_at(0);
});

async function on_the_line(share) {
  const box = await page.page.locator("#scrubber").boundingBox();
  return { x: box.x + 8 + (box.width - 16) * share, y: box.y + box.height / 2 };
}

describe("by mouse", () => {
  test("play, pause and stop", async () => {
    await page.page.locator("#play").click();
    await page.playing(true);
    await page.moves();
    await page.page.locator("#play").click();
    await page.playing(false);
    const [told] = (await server.call("playback.get")).players;
    await page.stands_at(told.time);
    await page.page.locator("#stop").click();
    await page.stands_at(0);
  });

  test("keyframe by keyframe", async () => {
    await page.page.locator("#next").click();
    const second = await until("the next keyframe is reached", async () => (await page.time()) || null);
    await page.page.locator("#next").click();
    await until("the one after it", async () => (await page.time()) > second);
    await page.page.locator("#previous").click();
    await page.stands_at(second);
  });

  test("a drag of the line seeks all the way", async () => {
    const [start, middle] = [await on_the_line(0.1), await on_the_line(0.5)];
    await page.page.mouse.move(start.x, start.y);
    await page.page.mouse.down();
    await page.page.mouse.move(middle.x, middle.y, { steps: 10 });
    await until("the server is there before the button is up", async () => {
      const [{ time }] = (await server.call("playback.get")).players;
      return Math.abs(time - duration / 2) < 0.03;
    });
    await page.page.mouse.up();
    await until("the page shows it", async () => Math.abs((await page.time()) - duration / 2) < 0.03);
    assert.equal(await page.plays(), false);
  });

  test("what plays is held while the line is dragged, and goes on", async () => {
    await page.page.locator("#play").click();
    await page.playing(true);
    const middle = await on_the_line(0.5);
    await page.page.mouse.move(middle.x, middle.y);
    await page.page.mouse.down();
    await page.playing(false);
    await page.page.mouse.up();
    await page.playing(true);
    await page.moves();
  });

  test("speed, direction, loop and blend reach the server", async () => {
    const told = async () => (await server.call("playback.get")).players[0];
    await page.page.locator("#speed_exact").fill("1.5");
    await page.page.locator("#speed_exact").press("Enter");
    await until("the speed is 1.5", async () => (await told()).speed === 1.5);
    await page.page.locator("#reverse").click();
    await until("the speed is -1.5", async () => (await told()).speed === -1.5);
    await until("the field says so", async () => (await page.page.locator("#speed_exact").inputValue()) === "-1.5");
    await page.page.locator("#loop").selectOption("ping_pong");
    await until("the loop is ping_pong", async () => (await told()).loop === "ping_pong");
    const blend = async () => (await server.call("scene.describe")).actors[0].interpolation;
    for (const mode of ["step", "catmull_rom"]) {
      await page.page.locator("#interpolation").selectOption(mode);
      await until(`the blend is ${mode}`, async () => (await blend()) === mode);
    }
    await page.page.locator("#interpolation").selectOption("");
    await until("the blend is the clip's", async () => (await blend()) === null);
  });
});

describe("by keyboard", () => {
  const press = (key) => page.page.keyboard.press(key);

  test("Space plays and pauses, Home stops", async () => {
    await press("Space");
    await page.playing(true);
    await page.moves();
    await press("Space");
    await page.playing(false);
    await press("Home");
    await page.stands_at(0);
  });

  test("arrows step, with Shift by keyframe", async () => {
    for (const at of [0.1, 0.2]) {
      await press("ArrowRight");
      await page.stands_at(at);
    }
    await press("ArrowLeft");
    await page.stands_at(0.1);
    await press("Shift+ArrowRight");
    await until("the next keyframe is reached", async () => (await page.time()) > 0.2);
    await press("Shift+ArrowLeft");
    await page.stands_at(0);
  });

  test("arrows on the line step as anywhere, and it says where it is", async () => {
    await page.page.locator("#scrubber").focus();
    await press("ArrowRight");
    await page.stands_at(0.1);
    await until("it says so", async () => /^0\.1 of/.test(await page.page.locator("#scrubber").getAttribute("aria-valuetext")));
    await press("Home");
    await page.stands_at(0);
  });

  test("a key that is typed does nothing else", async () => {
    await page.page.locator("#speed_exact").click();
    await press("ArrowRight");
    await press("Space");
    await page.page.locator("#play").focus();
    await press("Space"); // presses the button: once
    await page.playing(true);
  });
});

test("a refusal is said in the server's words, and can be dismissed", async () => {
  // The page asks for nothing that is wrong: what it asks is made wrong on its way.
  const about_nobody = (page) =>
    page.routeWebSocket("**/ws", (socket) => {
      const server = socket.connectToServer();
      socket.onMessage((text) => {
        const message = JSON.parse(text);
        if (message.method === "playback.set") message.params.actor = "nobody";
        server.send(JSON.stringify(message));
      });
    });
  const refused = await TweendPage.open(browser, server.url, undefined, about_nobody);
  await refused.ready();
  const field = refused.page.locator("#speed_exact");
  await field.fill("3");
  await field.press("Enter");
  await refused.says("#message_text", /^playback\.set: .*nobody/);
  await field.blur();
  assert.equal(await field.inputValue(), "1");
  await refused.page.locator("#message_close").click();
  await until("it is gone", () => refused.page.locator("#message").isHidden());
  await refused.close();
});

describe("two pages", () => {
  let other;
  before(async () => {
    other = await TweendPage.open(browser, server.url);
    await other.ready();
  });
  after(() => other.close());

  test("agree on what one of them does", async () => {
    await page.page.locator("#play").click();
    await other.playing(true);
    await until("they show the same time", async () => {
      const [mine, theirs] = await Promise.all([page.time(), other.time()]);
      return Math.abs(mine - theirs) < 0.1;
    });
    await other.page.locator("#play").click();
    await page.playing(false);
    await page.stands_at(await other.time());
    await other.page.locator("#speed_exact").fill("2");
    await other.page.locator("#speed_exact").press("Enter");
    await other.page.locator("#loop").selectOption("once");
    await until("speed and loop are the other's", async () =>
      (await page.page.locator("#speed_exact").inputValue()) === "2" && (await page.page.locator("#loop").inputValue()) === "once");
    await server.call("playback.set", { speed: 0.01 }); // so that it is seen to play
    await other.page.locator("#play").click();
    await page.playing(true);
    await server.call("playback.set", { speed: 2 });
    await page.playing(false); // played out
    await page.stands_at(duration);
  });

  test("agree on the actors", async () => {
    await other.page.getByRole("button", { name: "Show barb" }).click();
    const eye = page.page.getByRole("button", { name: "Show barb" });
    await until("barb is hidden here too", async () => (await eye.getAttribute("aria-pressed")) === "false");
    await eye.click();
    const theirs = other.page.getByRole("button", { name: "Show barb" });
    await until("and shown there", async () => (await theirs.getAttribute("aria-pressed")) === "true");
  });
});

test("a scene that is not there is said so", async () => {
  const lost = await TweendPage.open(browser, `${server.url}?scene=none`);
  await lost.says("#message_text", /none/);
  await lost.close();
});
