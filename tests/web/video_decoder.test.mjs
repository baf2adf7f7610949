import assert from "node:assert/strict";
import { beforeEach, describe, test } from "node:test";
import { UnitDecoder } from "../../clients/web/video_decoder.js";

globalThis.EncodedVideoChunk ??= class {
  constructor(init) {
    Object.assign(this, init);
  }
};

/** A VideoDecoder that decodes when the test says so. */
class FakeDecoder {
  static refuses = false;
  state = "unconfigured";
  chunks = [];
  constructor(init) {
    this.init = init;
  }
  configure(config) {
    if (FakeDecoder.refuses) throw new TypeError("no such codec");
    this.state = "configured";
    this.config = config;
  }
  get decodeQueueSize() {
    return this.chunks.length;
  }
  decode(chunk) {
    if (this.state !== "configured") throw new Error("it is closed");
    this.chunks.push(chunk);
  }
  close() {
    this.state = "closed";
    this.chunks = [];
  }
  /** Puts out the oldest. */
  put_out(frame = new FakeFrame(this.chunks.shift().timestamp)) {
    this.init.output(frame);
    return frame;
  }
  fail(error) {
    this.state = "closed";
    this.init.error(error);
  }
}

class FakeFrame {
  closed = false;
  constructor(timestamp) {
    this.timestamp = timestamp;
  }
  close() {
    this.closed = true;
  }
}

/** Of a stream of 50 a second. */
const unit = (sequence, key = false) => ({
  kind: 3, encoding: 2, key, sequence, server_us: 20_000 * sequence, payload: new Uint8Array([0, 0, 0, 1]),
});

let made, shown, keys, failures, decoder;
const now = () => made.at(-1);
const queued = () => now().chunks.map((c) => c.timestamp / 20_000);

beforeEach(() => {
  [made, shown, keys, failures] = [[], [], 0, []];
  FakeDecoder.refuses = false;
  const sink = {
    show: (image, packet) => shown.push([image, packet.sequence]),
    need_key: () => (keys += 1),
    fail: (error) => failures.push(error.message),
    report: assert.fail,
  };
  decoder = new UnitDecoder("avc1.42c01f", sink, (init) => (made.push(new FakeDecoder(init)), now()));
});

describe("a decoder of units", () => {
  test("is told the codec, and no description: units are Annex B", () => {
    assert.deepEqual(now().config, { codec: "avc1.42c01f", optimizeForLatency: true });
  });

  test("refuses what is no unit", () => {
    assert.throws(() => decoder.push({ ...unit(1, true), encoding: 0 }), /expected a frame as h264, found kind 3, encoding 0/);
  });

  test("begins with a key", () => {
    [unit(4), unit(5, true), unit(6)].forEach((u) => decoder.push(u));
    assert.deepEqual(now().chunks.map((c) => [c.timestamp, c.type]), [[100_000, "key"], [120_000, "delta"]]);
    assert.equal(keys, 0, "the first comes by itself");
  });

  test("shows each frame with its packet, and keeps none that it has not", () => {
    [unit(5, true), unit(6), unit(7)].forEach((u) => decoder.push(u));
    now().chunks.shift(); // one that is never put out
    const frame = now().put_out();
    assert.deepEqual(shown, [[frame, 6]]);
    assert.ok(now().put_out(new FakeFrame(100_000)).closed, "5 was given up");
    now().put_out();
    assert.deepEqual(shown.map(([, sequence]) => sequence), [6, 7]);
  });

  test("waits for a key after a gap, and asks for it once", () => {
    [unit(5, true), unit(7), unit(8), unit(9)].forEach((u) => decoder.push(u));
    assert.deepEqual(queued(), [5]);
    assert.equal(keys, 1);
    [unit(10, true), unit(11)].forEach((u) => decoder.push(u));
    assert.deepEqual(queued(), [5, 10, 11]);
  });

  test("counts on where the numbers go round", () => {
    [unit(0xffffffff, true), unit(0)].forEach((u) => decoder.push(u));
    assert.equal(keys, 0);
    assert.deepEqual(queued(), [0xffffffff, 0]);
  });

  test("has a bounded queue: the rest is dropped up to a key, which sweeps it away", () => {
    decoder.push(unit(0, true));
    now().put_out();
    for (let i = 1; i < 30; ++i) decoder.push(unit(i));
    const full = queued().length;
    assert.ok(full < 10);
    assert.equal(keys, 1);
    const before = now();
    decoder.push(unit(30, true));
    assert.equal(before.state, "closed");
    assert.deepEqual(queued(), [30]);
    assert.deepEqual(failures, []);
  });

  test("waits for a decoder that is slow to start, with the same one", () => {
    decoder.push(unit(0, true));
    for (let i = 1; i < 100; ++i) decoder.push(unit(i, i % 12 === 0)); // two seconds
    assert.deepEqual([made.length, failures], [1, []]);
    assert.ok(queued().length < 10 && keys > 0);
    while (queued().length > 0) now().put_out();
    [unit(100, true), unit(101)].forEach((u) => decoder.push(u));
    now().put_out();
    assert.deepEqual([queued(), shown.at(-1)[1]], [[101], 100]);
  });

  test("gives up one that never starts", () => {
    for (let i = 0; i < 50 * 10 && failures.length === 0; ++i) decoder.push(unit(i, i % 12 === 0));
    assert.deepEqual([made.length, failures], [1, ["the decoder does not begin"]]);
    assert.equal(now().state, "closed");
  });

  test("grants time to start to one that takes another's place, too", () => {
    decoder.push(unit(0, true));
    now().put_out();
    for (let i = 1; i < 10; ++i) decoder.push(unit(i));
    for (let i = 10; i < 100; ++i) decoder.push(unit(i, i % 12 === 0));
    assert.deepEqual([made.length, failures], [2, []]);
  });

  test("fails where there is no decoder for what it was told", () => {
    FakeDecoder.refuses = true;
    assert.throws(() => new UnitDecoder("avc1", {}, (init) => new FakeDecoder(init)), /no such codec/);
    decoder.push(unit(0, true));
    now().fail(new Error("first"));
    assert.deepEqual([failures, keys], [["no such codec"], 0]);
    decoder.push(unit(1, true)); // goes nowhere
  });

  test("lets a first error pass with a new key, the second without a picture between ends it", () => {
    decoder.push(unit(0, true));
    now().fail(new Error("first"));
    assert.deepEqual([made.length, keys, failures], [2, 1, []]);
    decoder.push(unit(1));
    assert.deepEqual(queued(), []);
    decoder.push(unit(2, true));
    now().fail(new Error("second"));
    assert.deepEqual([made.length, keys, failures], [2, 1, ["second"]]);
    decoder.push(unit(3, true)); // goes nowhere
  });

  test("forgets an error once a picture has come", () => {
    for (let i = 0; i < 4; ++i) {
      decoder.push(unit(2 * i, true));
      now().put_out();
      now().fail(new Error("once more"));
    }
    assert.deepEqual([failures, keys, shown.length], [[], 4, 4]);
  });

  test("shows nothing once it is closed, and lets go of what comes late", () => {
    decoder.push(unit(0, true));
    const late = new FakeFrame(0);
    decoder.close();
    now().init.output(late);
    now().init.error(new Error("late"));
    decoder.push(unit(1, true));
    assert.ok(late.closed);
    assert.deepEqual([shown, failures, keys], [[], [], 0]);
  });

  test("lets go of frames of the decoder before", () => {
    decoder.push(unit(0, true));
    const before = now();
    before.fail(new Error("first"));
    assert.ok(before.put_out(new FakeFrame(0)).closed);
    assert.deepEqual(shown, []);
  });
});
