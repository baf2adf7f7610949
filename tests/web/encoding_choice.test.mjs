import assert from "node:assert/strict";
import { beforeEach, describe, test } from "node:test";
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
    assert.match(asked[0], /^avc1\.42/);
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
});
