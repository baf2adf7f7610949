import assert from "node:assert/strict";
import { beforeEach, describe, test } from "node:test";
import { ConnectionLost, RpcError } from "../../clients/web/connection.js";
import { FrameStream, stream_size } from "../../clients/web/frame_stream.js";
import { Listeners } from "../../clients/web/listeners.js";
import { settled } from "./support/fake_socket.mjs";

describe("the size to ask for", () => {
  test("is that of the screen's pixels, even", () => {
    assert.deepEqual(stream_size(641, 361, 1), { width: 640, height: 360 });
    assert.deepEqual(stream_size(375, 375, 2), { width: 750, height: 750 });
    assert.deepEqual(stream_size(375.4, 200.7, 1.5), { width: 562, height: 300 });
  });
  test("is capped in the same shape", () => {
    assert.deepEqual(stream_size(2560, 1440, 2), { width: 1280, height: 720 });
    const { width, height } = stream_size(3000, 1000, 1);
    assert.ok(width * height <= 1280 * 720 && Math.abs(width / height - 3) < 0.01);
  });
  test("is never nothing", () => assert.deepEqual(stream_size(1, 0, 1), { width: 16, height: 16 }));
});

/** A connection whose answers the test gives. */
class FakeConnection {
  state = { phase: "stopped" };
  states = new Listeners();
  events = new Listeners();
  packets = new Listeners();
  calls = [];
  call(method, params) {
    return new Promise((resolve, reject) => this.calls.push({ method, params, resolve, reject }));
  }
  become(phase) {
    this.state = { phase };
    if (phase !== "open") for (const c of this.calls.splice(0)) c.reject(new ConnectionLost("gone"));
    this.states.tell(this.state);
  }
  async answer(result = {}) {
    this.calls.shift().resolve(result);
    await settled();
  }
  get asked() {
    return this.calls.map((c) => c.method);
  }
}

let connection, stream, errors;
const kSize = { width: 640, height: 360 };
const camera = (azimuth) => ({ orbit: { azimuth, elevation: 0, distance: 5, target: [0, 0, 0] } });

const opened = (stream, codec = "jpeg") => ({ stream, layout: { codec } });

async function open() {
  stream.set_size(kSize);
  connection.become("open");
  await connection.answer(opened(1));
}

beforeEach(() => {
  connection = new FakeConnection();
  errors = [];
  stream = new FrameStream(connection, "main", (error) => errors.push(error));
  stream.set_encoding("jpeg");
});

describe("a stream", () => {
  test("is opened when there are a connection and a size", async () => {
    stream.set_size(kSize);
    assert.deepEqual(connection.asked, []);
    connection.become("open");
    assert.deepEqual(connection.calls[0].params, {
      kind: "frames", scene: "main", encoding: "jpeg", rate: 30, quality: 80, width: 640, height: 360,
    });
    await connection.answer(opened(1));
    assert.deepEqual(connection.asked, []);
  });

  test("is replaced for another size, without a gap", async () => {
    await open();
    stream.set_size({ width: 320, height: 180 });
    assert.equal(connection.calls[0].params.width, 320);
    await connection.answer(opened(2));
    assert.deepEqual([connection.calls[0].method, connection.calls[0].params], ["stream.close", { stream: 1 }]);
  });

  test("whose pictures nobody can take does not keep the one before", async () => {
    await open();
    stream.opened.add(() => { throw new Error("no decoder"); });
    stream.set_size({ width: 320, height: 180 });
    await connection.answer(opened(2));
    assert.deepEqual(connection.calls.map((c) => [c.method, c.params]), [["stream.close", { stream: 1 }]]);
    await connection.answer();
    assert.deepEqual(errors.map((e) => e.message), ["no decoder"]);
  });

  test("has one camera update on its way, and the newest next", async () => {
    await open();
    for (const azimuth of [1, 2, 3]) stream.set_camera(camera(azimuth));
    assert.equal(connection.calls.length, 1);
    assert.equal(connection.calls[0].params.camera.orbit.azimuth, 1);
    await connection.answer();
    assert.deepEqual(connection.calls.map((c) => [c.method, c.params.camera.orbit.azimuth]), [["stream.update", 3]]);
    await connection.answer();
    stream.set_camera(null);
    assert.deepEqual(connection.calls[0].params, { stream: 1, camera: null });
  });

  test("is opened with the camera that it had", async () => {
    await open();
    stream.set_camera(camera(1));
    await connection.answer();
    connection.become("waiting");
    await settled();
    connection.become("open");
    assert.equal(connection.calls[0].params.camera.orbit.azimuth, 1);
    assert.ok(errors.every((e) => e instanceof ConnectionLost));
  });

  test("is closed while nobody looks", async () => {
    let closed = 0;
    stream.closed.add(() => (closed += 1));
    await open();
    stream.set_watched(false);
    assert.deepEqual([connection.asked, closed], [["stream.close"], 1]);
    await connection.answer();
    stream.set_watched(true);
    assert.deepEqual(connection.asked, ["stream.open"]);
  });

  test("that is refused is not asked for again until something else is wanted", async () => {
    stream.set_size(kSize);
    connection.become("open");
    connection.calls.shift().reject(new Error("too large"));
    await settled();
    assert.deepEqual(connection.asked, []);
    assert.equal(errors[0].message, "too large");
    stream.set_size({ width: 320, height: 180 });
    assert.deepEqual(connection.asked, ["stream.open"]);
  });

  test("what was wanted while a refusal was on its way is asked for", async () => {
    stream.set_size(kSize);
    connection.become("open");
    stream.set_size({ width: 320, height: 180 });
    connection.calls.shift().reject(new Error("too large"));
    await settled();
    assert.deepEqual(connection.calls.map((c) => c.params.width), [320]);
  });

  test("that the server has ended is reported", async () => {
    await open();
    connection.events.tell({ method: "stream.ended", params: { stream: 9, reason: "other" } });
    assert.deepEqual(errors, []);
    connection.events.tell({ method: "stream.ended", params: { stream: 1, reason: "scene removed" } });
    assert.match(errors[0].message, /scene removed/);
    assert.deepEqual(connection.asked, []);
  });
});

describe("an encoding", () => {
  const refused = (kind, path) => new RpcError("stream.open", { code: -32000, message: "no", data: { kind, path } });
  const refusal = refused("unavailable");

  test("has to be known before anything is asked for", () => {
    stream = new FrameStream(connection, "main", assert.fail);
    stream.set_size(kSize);
    connection.become("open");
    assert.deepEqual(connection.asked, []);
    stream.set_encoding("h264");
    assert.deepEqual(connection.calls[0].params, {
      kind: "frames", scene: "main", encoding: "h264", rate: 30, width: 640, height: 360,
    });
  });

  test("is told with its codec before the first packet", async () => {
    const told = [];
    stream.opened.add((layout) => told.push(layout));
    stream.set_encoding("h264");
    stream.set_size(kSize);
    connection.become("open");
    await connection.answer(opened(1, "avc1.42c01e"));
    assert.deepEqual(told, [{ encoding: "h264", codec: "avc1.42c01e", width: 640, height: 360 }]);
  });

  test("is changed without a gap", async () => {
    await open();
    stream.set_encoding("h264");
    assert.deepEqual(connection.calls.map((c) => [c.method, c.params.encoding]), [["stream.open", "h264"]]);
    await connection.answer(opened(2, "avc1.42c01e"));
    assert.deepEqual(connection.calls.map((c) => [c.method, c.params]), [["stream.close", { stream: 1 }]]);
  });

  test("that is refused is told, and reported unless another is wanted then", async () => {
    stream.set_encoding("h264");
    stream.set_size(kSize);
    connection.become("open");
    connection.calls.shift().reject(refusal);
    await settled();
    assert.deepEqual(errors, [refusal]);
    stream.refusals.add(() => stream.set_encoding("jpeg"));
    stream.set_size({ width: 320, height: 180 });
    connection.calls.shift().reject(refusal);
    await settled();
    assert.deepEqual(connection.calls.map((c) => c.params.encoding), ["jpeg"]);
    assert.equal(errors.length, 1);
  });

  test("is not what was refused where there is no such scene, or no room", async () => {
    const told = [];
    stream.refusals.add((error) => told.push(error.path || error.kind));
    stream.set_encoding("h264");
    connection.become("open");
    const answers = [
      refused("not_found", "params.scene"), refused("limit"), refused("invalid_params", "params.scene"), new ConnectionLost("gone"),
      refused("invalid_params", "params.encoding"), refused("invalid_params", "params.height"), refusal,
    ];
    for (const [i, answer] of answers.entries()) {
      stream.set_size({ width: 320 + 2 * i, height: 180 });
      connection.calls.shift().reject(answer);
      await settled();
    }
    assert.deepEqual(told, ["params.encoding", "params.height", "unavailable"]);
    assert.equal(errors.length, answers.length);
  });

  test("keys are asked for of the open stream", async () => {
    stream.request_key();
    await open();
    stream.request_key();
    assert.deepEqual(connection.calls.map((c) => [c.method, c.params]), [["stream.request_key", { stream: 1 }]]);
  });
});

describe("packets", () => {
  const packet = (number) => {
    const view = new DataView(new ArrayBuffer(40));
    view.setUint32(0, 0x444e5754, true);
    view.setUint8(4, 1);
    view.setUint32(8, number, true);
    return view.buffer;
  };

  test("of this stream are told, of one that was closed not", async () => {
    await open();
    const got = [];
    stream.packets.add((p) => got.push(p.stream));
    connection.packets.tell(packet(1));
    connection.packets.tell(packet(2));
    assert.deepEqual(got, [1]);
  });

  test("that are none are reported", async () => {
    await open();
    connection.packets.tell(new ArrayBuffer(3));
    assert.match(errors[0].message, /at least 40 bytes/);
  });
});
