import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { ConnectionLost, RpcError } from "../../clients/web/connection.js";
import { actor_detail } from "../../clients/web/controls/actor_list.js";
import { markers_on_line } from "../../clients/web/controls/marker_ticks.js";
import { error_text } from "../../clients/web/controls/messages.js";
import { interpolation_choice } from "../../clients/web/controls/playback_options.js";
import { belongs_to } from "../../clients/web/controls/shortcuts.js";
import { bytes_text, connection_words, meter_words } from "../../clients/web/controls/status.js";
import { FrameMeter } from "../../clients/web/frame_meter.js";
import { ViewCamera } from "../../clients/web/view_camera.js";

describe("keys belong to", () => {
  const owner = (tagName, type) => ({ tagName, type });
  test("whoever types", () => {
    assert.ok(belongs_to(owner("INPUT", "number"), "ArrowLeft"));
    assert.ok(belongs_to(owner("SELECT"), "s"));
    assert.ok(belongs_to(owner("INPUT", "range"), "Home"));
  });
  test("a button, if they press it", () => {
    assert.ok(belongs_to(owner("BUTTON"), " "));
    assert.ok(!belongs_to(owner("BUTTON"), "ArrowLeft"));
    assert.ok(belongs_to(owner("INPUT", "radio"), "ArrowDown"));
    assert.ok(!belongs_to(owner("INPUT", "radio"), "f"));
  });
  test("us, on the page and on the line of time", () => {
    assert.ok(!belongs_to(owner("BODY"), " "));
    assert.ok(!belongs_to({ tagName: "INPUT", type: "range", id: "scrubber" }, "ArrowLeft"));
  });
});

describe("words", () => {
  test("of a refusal name the method and the parameter", () => {
    const error = new RpcError("playback.set", { code: -32602, message: "x", data: { path: "params.speed", message: "expected y" } });
    assert.equal(error_text(error), "playback.set: expected y (params.speed)");
    assert.equal(error_text(new RpcError("a.b", { code: -32601, message: "no such method" })), "a.b: no such method");
  });
  test("of a lost connection are the connection's", () => assert.equal(error_text(new ConnectionLost("x")), ""));
  test("of anything else are its own", () => {
    assert.equal(error_text(new Error("oh")), "oh");
    assert.equal(error_text("oh"), "oh");
  });
  test("of the connection say what is being done about it", () => {
    const words = (phase) => connection_words({ phase, reason: "it fell", retry_ms: 1500, hello: null });
    assert.equal(words("open").note, "");
    assert.match(words("waiting").note, /it fell.*1\.5 s/);
    assert.match(words("connecting").note, /it fell.*now/);
    assert.match(words("refused").note, /refuses.*it fell/);
    assert.match(words("stopped").note, /closed/);
    assert.match(connection_words({ phase: "connecting", reason: "", retry_ms: 0, hello: null }).note, /^Connecting/);
  });
  test("of an actor count what it has", () => {
    const clip = (keyframes) => ({ clip: "c", type: "vertex", keyframes, duration: 1, closed: false });
    assert.equal(actor_detail({ clips: [clip(1)], vertices: 1234 }), "1 keyframe · 1,234 vertices");
    assert.equal(actor_detail({ clips: [clip(2), clip(3)], vertices: 1 }), "2 clips · 5 keyframes · 1 vertex");
  });
});

test("the blend shown is that of all concerned, or mixed", () => {
  const state = (selected, ...modes) => ({ selected, actors: modes.map((interpolation, i) => ({ actor: "ab"[i], interpolation })) });
  assert.equal(interpolation_choice(state(null)), "");
  assert.equal(interpolation_choice(state(null, null, null)), "");
  assert.equal(interpolation_choice(state(null, "step", null)), "mixed");
  assert.equal(interpolation_choice(state("a", "step", null)), "step");
});

test("markers beyond the end of the line are not on it", () => {
  const at = (...times) => times.map((time, marker) => ({ marker, time, name: "m" }));
  assert.deepEqual(markers_on_line(at(0, 1, 1.5), 1).map((m) => m.time), [0, 1]);
  assert.deepEqual(markers_on_line(at(0), 0), []);
});

describe("the meter", () => {
  test("has seen nothing at first", () => {
    assert.deepEqual(new FrameMeter().read(0), { per_second: 0, age_ms: null, bytes_per_second: 0 });
  });
  test("counts the last second, and tells the middle age", () => {
    const meter = new FrameMeter();
    [0, 500, 600, 700].forEach((at, i) => meter.add(at, [1, 90, 5, 7][i]));
    const read = (at) => Object.values(meter.read(at)).slice(0, 2);
    assert.deepEqual(read(900), [4, 7]);
    assert.deepEqual(read(1100), [3, 7]);
    assert.deepEqual(read(9999), [0, null]);
  });
  test("counts what came in the last second, drawn or not", () => {
    const meter = new FrameMeter();
    [0, 500, 600].forEach((at) => meter.receive(at, 1000));
    assert.equal(meter.read(900).bytes_per_second, 3000);
    assert.equal(meter.read(1100).bytes_per_second, 2000);
    assert.equal(meter.read(1100).per_second, 0);
  });
  test("does without ages that nobody knows", () => {
    const meter = new FrameMeter();
    meter.add(0, null);
    assert.deepEqual(meter.read(1), { per_second: 1, age_ms: null, bytes_per_second: 0 });
  });

  const picture = (encoding, width = 1280, height = 720) => ({
    layout: { encoding, codec: "", width: 1280, height: 720 },
    size: { width, height },
  });
  const reading = { per_second: 30, age_ms: 4.23, bytes_per_second: 210_400 };
  test("says what comes", () => {
    assert.equal(meter_words(reading, picture("h264")), "30 fps · 4.2 ms old · 1280 × 720 · H.264 · 210 kB/s");
    assert.equal(meter_words({ ...reading, age_ms: null }, picture("jpeg")), "30 fps · 1280 × 720 · JPEG · 210 kB/s");
    assert.equal(meter_words({ ...reading, per_second: 0 }, picture("jpeg")), "still · 1280 × 720 · JPEG");
    assert.equal(meter_words(reading, null), "no picture");
  });
  test("says so where a picture came smaller than asked for", () => {
    assert.match(meter_words(reading, picture("jpeg", 640, 360)), / · 640 × 360 of 1280 × 720 · /);
  });
  test("counts bytes as people do", () => {
    assert.deepEqual([0, 1499, 999_499, 999_500, 2_340_000].map(bytes_text), ["0 kB", "1 kB", "999 kB", "1.0 MB", "2.3 MB"]);
  });
});

describe("the page's camera", () => {
  const kScene = { eye: [0, 0, 10], target: [0, 0, 0], fov_y: 1, near: 0.1, far: 100 };
  const make = () => {
    const camera = new ViewCamera();
    const told = [];
    camera.changes.add((own) => told.push(own));
    return { camera, told };
  };
  test("is the scene's until somebody turns it", () => {
    const { camera, told } = make();
    camera.turn(1, 1, 100); // nothing is shown yet
    camera.follow(kScene);
    assert.equal(camera.stream_camera, null);
    camera.zoom(2);
    camera.follow({ ...kScene, eye: [0, 0, 50] });
    camera.zoom(2);
    assert.deepEqual(told.map((own) => own.orbit.distance), [20, 40]);
  });
  test("goes back to the scene's, once", () => {
    const { camera, told } = make();
    camera.follow(kScene);
    camera.reset();
    camera.turn(1, 0, 100);
    camera.reset();
    camera.reset();
    assert.deepEqual(told.slice(1), [null]);
  });
});
