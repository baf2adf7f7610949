import assert from "node:assert/strict";
import { beforeEach, describe, test } from "node:test";
import { make_actions } from "../../clients/web/actions.js";
import { Latest } from "../../clients/web/latest.js";
import { StageStore } from "../../clients/web/stage_state.js";
import { settled } from "./support/fake_socket.mjs";

const player = (actor, playing) => ({
  actor, clip: "c", playing, time: 0, speed: 1, loop: "repeat", range: [0, 1], duration: 1,
});

let calls, errors, store, actions;

beforeEach(() => {
  [calls, errors] = [[], []];
  const connection = { call: (method, params) => new Promise((resolve, reject) => calls.push({ method, params, resolve, reject })) };
  store = new StageStore("main");
  actions = make_actions(connection, store, (error) => errors.push(error));
});

function play(...playing) {
  const names = playing.map((_, i) => "ab"[i]);
  const actors = names.map((actor) => ({ actor, interpolation: null, visible: true, clips: [] }));
  store.dispatch({ type: "described", scene: { scene: "main", revision: 1, actors, camera: {} } });
  store.dispatch({ type: "players", players: names.map((n, i) => player(n, playing[i])), server_time_us: 1 });
}
const asked = () => calls.map(({ method, params }) => [method, params]);

test("a command concerns all, or who is selected", () => {
  play(true, true);
  actions.pause();
  actions.select("b");
  actions.stop();
  assert.deepEqual(asked(), [["playback.pause", { scene: "main" }], ["playback.stop", { scene: "main", actor: "b" }]]);
});

test("play or pause is what is not yet", () => {
  play(false, true);
  actions.toggle_play();
  actions.select("a");
  actions.toggle_play();
  assert.deepEqual(calls.map((c) => c.method), ["playback.pause", "playback.play"]);
});

test("the answer is shown without waiting for the event", async () => {
  play(true);
  actions.pause();
  calls[0].resolve({ players: [player("a", false)], server_time_us: 2 });
  await settled();
  assert.equal(store.state.players["a"].playing, false);
});

test("a refusal is reported and changes nothing", async () => {
  play(true);
  actions.pause();
  calls[0].reject(new Error("no"));
  await settled();
  assert.deepEqual(errors.map((e) => e.message), ["no"]);
  assert.equal(store.state.players["a"].playing, true);
});

test("a drag holds what plays, and lets exactly that go on", () => {
  play(false, true);
  actions.hold();
  actions.release();
  actions.release();
  assert.deepEqual(asked(), [["playback.pause", { scene: "main" }], ["playback.play", { scene: "main", actor: "b" }]]);
});

test("a drag over what is paused starts nothing", () => {
  play(false, false);
  actions.hold();
  actions.release();
  assert.deepEqual(asked(), []);
});

test("a blend for all is one edit", () => {
  play(true, true);
  actions.set_interpolation("step");
  const update = (actor) => ({ method: "actor.update", params: { actor, interpolation: "step" } });
  assert.deepEqual(asked(), [["edit.apply", { scene: "main", edits: [update("a"), update("b")] }]]);
});

test("a blend for one is its own, and null leaves it to the clip", () => {
  play(true, true);
  actions.select("a");
  actions.set_interpolation(null);
  assert.deepEqual(asked(), [["actor.update", { scene: "main", actor: "a", interpolation: null }]]);
});

test("another clip is faded to, and goes on", async () => {
  play(true, true);
  actions.set_fade(0.5);
  actions.play_clip("b", "run");
  assert.deepEqual(asked(), [["playback.play", { scene: "main", actor: "b", clip: "run", fade: 0.5 }]]);
  calls[0].resolve({ players: [{ ...player("b", true), clip: "run" }], server_time_us: 2 });
  await settled();
  assert.equal(store.state.players["b"].clip, "run");
});

test("another clip of one who stands still stands still", () => {
  play(false);
  actions.play_clip("a", "run");
  assert.deepEqual(asked(), [
    ["playback.play", { scene: "main", actor: "a", clip: "run" }],
    ["playback.pause", { scene: "main", actor: "a" }],
  ]);
});

test("a skeleton is shown of one actor", () => {
  play(true, true);
  actions.set_skeleton("b", true);
  assert.deepEqual(asked(), [["actor.update", { scene: "main", actor: "b", show_skeleton: true }]]);
});

describe("the latest of many", () => {
  test("waits while one is on its way; those between are never sent", async () => {
    play(true);
    for (const time of [0.1, 0.2, 0.3]) actions.seek(time);
    assert.deepEqual(calls.map((c) => c.params.time), [0.1]);
    calls[0].resolve(null);
    await settled();
    assert.deepEqual(calls.map((c) => c.params.time), [0.1, 0.3]);
    calls[1].resolve(null);
    await settled();
    assert.equal(calls.length, 2);
  });

  test("a failure does not stop what comes after", async () => {
    const sent = [];
    const latest = new Latest((value) => (sent.push(value), Promise.reject(new Error("x"))));
    latest.push(1);
    latest.push(2);
    await settled();
    assert.deepEqual(sent, [1, 2]);
    assert.equal(latest.busy, false);
  });
});
