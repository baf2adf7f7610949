import assert from "node:assert/strict";
import { beforeEach, describe, test } from "node:test";
import { GapWatch } from "../../clients/web/gap_watch.js";
import { EncodingChoice, obstacle_to_h264 } from "../../clients/web/encoding_choice.js";

describe("what stands in the way of H.264", () => {
  const browser = (isConfigSupported) => ({ VideoDecoder: { isConfigSupported } });
  test("is a browser without WebCodecs, or whose WebCodecs can't", async () => {
    assert.notEqual(await obstacle_to_h264({}), "");
    assert.notEqual(await obstacle_to_h264(browser(async () => ({ supported: false }))), "");
    assert.notEqual(await obstacle_to_h264(browser(async () => { throw new TypeError("no such codec"); })), "");
  });
  test("is nothing where a typical stream is decoded", async () => {
    const asked = [];
    const supports = async (config) => (asked.push(config.codec), { supported: true });
    assert.equal(await obstacle_to_h264(browser(supports)), "");
    // Level 3.2: 1358 × 678 is 85 × 43 macroblocks, of which level 3.1 has 3,600.
    assert.deepEqual(asked, ["avc1.42c020"]);
  });
});

describe("the encoding", () => {
  let choice, told;
  const hello = (...capabilities) => ({ phase: "open", hello: { capabilities } });
  beforeEach(() => {
    choice = new EncodingChoice();
    told = [];
    choice.changes.add((encoding) => told.push(encoding));
  });

  test("is not known before the browser is, unless JPEG was chosen", () => {
    assert.equal(choice.encoding, null);
    choice.follow(hello("frames:h264"));
    assert.deepEqual(told, []);
    choice.choose("jpeg");
    assert.deepEqual(told, ["jpeg"]);
  });
  test("is H.264 where browser and server can, and is told once", () => {
    choice.set_obstacle("");
    choice.follow(hello("frames:jpeg", "frames:h264"));
    choice.choose("h264");
    assert.deepEqual(told, ["h264"]);
    assert.equal(choice.why_not_h264, "");
  });
  test("is JPEG where the browser can't, and it is said why", () => {
    choice.set_obstacle("not today");
    choice.choose("h264");
    assert.deepEqual(told, ["jpeg"]);
    assert.equal(choice.why_not_h264, "not today");
  });
  test("follows the server that is there", () => {
    choice.set_obstacle("");
    choice.follow(hello("frames:jpeg"));
    choice.follow({ phase: "waiting", hello: null });
    assert.equal(choice.why_not_h264, "not on this server");
    choice.follow(hello("frames:h264"));
    assert.deepEqual(told, ["h264", "jpeg", "h264"]);
  });
  test("that failed is tried again when somebody chooses, not before", () => {
    choice.set_obstacle("");
    choice.give_up();
    choice.follow(hello("frames:h264"));
    assert.deepEqual(told, ["h264", "jpeg"]);
    choice.choose("h264");
    assert.deepEqual(told, ["h264", "jpeg", "h264"]);
  });
  test("that was chosen and failed is said, and can be chosen again", () => {
    choice.set_obstacle("");
    choice.choose("h264");
    choice.give_up();
    assert.deepEqual([choice.wish, choice.trouble], ["auto", "H.264 failed"]);
    choice.choose("h264");
    assert.deepEqual([choice.wish, choice.trouble, told.at(-1)], ["h264", "", "h264"]);
  });
  test("that failed is tried again on another connection", () => {
    choice.set_obstacle("");
    choice.give_up();
    choice.follow({ phase: "waiting", hello: null });
    choice.follow(hello("frames:h264"));
    assert.deepEqual([told, choice.trouble], [["h264", "jpeg", "h264"], ""]);
  });
  test("on a connection too slow for H.264 is JPEG, unless H.264 was chosen", () => {
    choice.set_obstacle("");
    choice.choose("h264");
    choice.too_slow();
    assert.deepEqual(told, ["h264"]);
    choice.choose("auto");
    choice.too_slow();
    assert.deepEqual([told, choice.wish, choice.trouble], [["h264", "jpeg"], "auto", "slow connection"]);
    choice.choose("jpeg");
    choice.too_slow();
    assert.equal(choice.trouble, "");
  });
});

describe("gaps", () => {
  let watch;
  beforeEach(() => (watch = new GapWatch()));

  test("are too many where a stream loses packets again and again", () => {
    const told = [5, 6, 9, 20, 21, 30, 35].map((sequence, i) => watch.receive(1000 * i, sequence));
    assert.deepEqual(told, [false, false, false, false, false, false, true]);
  });
  test("are not where they are seldom, or all of one moment", () => {
    for (let i = 0; i < 20; ++i) assert.ok(!watch.receive(4000 * i, 2 * i));
    for (let i = 0; i < 90; ++i) assert.ok(!watch.receive(100_000 + 33 * i, 100 + 2 * i));
  });
  test("are none where the numbers go round, or another stream begins", () => {
    for (let i = 0; i < 20; ++i) assert.ok(!watch.receive(1000 * i, (0xfffffff0 + i) >>> 0));
    for (let i = 0; i < 20; ++i) {
      watch.begin();
      assert.ok(!watch.receive(20_000 + 1000 * i, 100 * i));
    }
  });
});
