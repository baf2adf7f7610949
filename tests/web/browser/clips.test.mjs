/** An actor with several clips and with joints: what is played, what of it is marked, and its bones. */
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { TweendPage, launch, until } from "../support/browser.mjs";
import { ServerProcess } from "../support/server_process.mjs";

let browser, server, page, actor;

before(async () => {
  [browser, server] = [await launch(), await ServerProcess.start()];
  page = await TweendPage.open(browser, server.url);
  await page.ready();
  [{ actor }] = (await server.call("playback.get")).players;
});
after(async () => {
  await page?.close();
  await browser?.close();
  await server?.kill();
});

const locator = (css) => page.page.locator(css);
const player = async () => (await server.call("playback.get", { actor })).players[0];

test("one clip is no choice", async () => {
  assert.equal(await locator("#actors select").count(), 0);
  assert.equal(await locator("#fade_field").isVisible(), false);
});

test("another clip is chosen in the actor's row; who plays goes on, who stands still does not", async () => {
  await server.call("clip.create", { actor, clip: "bow" });
  for (const time of [0, 1]) await server.call("keyframe.add", { actor, clip: "bow", time, capture: true });
  await locator("#actors select").waitFor();
  assert.equal(await locator("#fade_field").isVisible(), true);
  await server.call("playback.play", { actor });
  await locator("#actors select").selectOption("bow");
  await until("it plays the other clip", async () => (await player()).clip === "bow");
  assert.equal((await player()).playing, true);
  await server.call("playback.pause", { actor });
  await page.playing(false);
  await locator("#actors select").selectOption("default");
  await until("it stands in the first clip", async () => (await player()).clip === "default" && !(await player()).playing);
});

test("a clip that somebody else chose is shown", async () => {
  await server.call("playback.play", { actor, clip: "bow" });
  await until("the choice follows", async () => (await locator("#actors select").inputValue()) === "bow");
});

test("markers are ticks of the line, for the clip that is played", async () => {
  await server.call("marker.add", { actor, clip: "bow", time: 0.5, name: "low" });
  await locator("#markers .marker").waitFor({ state: "attached" });
  assert.equal(await locator("#markers .marker").getAttribute("data-name"), "low");
  const [line, tick] = [await locator("#scrubber").boundingBox(), await locator("#markers .marker").boundingBox()];
  const { duration } = await player();
  const expected = line.x + 8 + (line.width - 16) * (0.5 / duration);
  assert.ok(Math.abs(tick.x + tick.width / 2 - expected) < 1.5, `expected the tick at ${expected}, found it at ${tick.x}`);
  await server.call("playback.play", { actor, clip: "default" });
  await until("they go with their clip", async () => (await locator("#markers .marker").count()) === 0);
});

test("a marker lights up as it is passed", async () => {
  await server.call("playback.play", { actor, clip: "bow" });
  await until("the tick is lit", () =>
    page.page.evaluate(() => (document.querySelector("#markers .marker")?.getAnimations().length ?? 0) > 0),
  );
});

test("who has joints may show them", async () => {
  assert.equal(await locator("#actors .bones").count(), 0);
  await server.call("actor.add", { actor: "bones", skeleton: { joints: [{ name: "hips" }] } });
  await locator("#actors .bones").click();
  await until("the server shows them", async () =>
    (await server.call("scene.describe")).actors.find((a) => a.actor === "bones").show_skeleton,
  );
  await until("the button says so", async () => (await locator("#actors .bones").getAttribute("aria-pressed")) === "true");
});
