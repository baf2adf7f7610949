import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { StageStore, initial_state, lead_markers, lead_player, reduce, selected_players } from "../../clients/web/stage_state.js";

const player = (actor, changes = {}) => ({
  actor, clip: "c", playing: true, time: 1, speed: 1, loop: "repeat", range: [0, 4], duration: 4, ...changes,
});
const actor = (name) => ({ actor: name, source: null, interpolation: null, visible: true, vertices: 3, triangles: 1, clips: [] });
const scene = (...names) => ({ scene: "main", revision: names.length, actors: names.map(actor), camera: { eye: [0, 0, 1] } });

/** @param {...import("../../clients/web/stage_state.js").StageChange} changes */
const after = (...changes) => changes.reduce(reduce, initial_state("main"));
const kTwo = [
  { type: "connected", can_control: true },
  { type: "described", scene: scene("a", "b") },
  { type: "players", players: [player("a"), player("b", { time: 2 })], server_time_us: 1e6 },
];

describe("what is told", () => {
  test("a scene has its actors, a player its reading", () => {
    const state = after(...kTwo);
    assert.equal(state.connected, true);
    assert.equal(state.revision, 2);
    assert.deepEqual(state.actors.map((a) => a.actor), ["a", "b"]);
    assert.deepEqual(state.players["b"], { ...player("b", { time: 2 }), at_us: 1e6, returning: false });
  });

  test("news of one player leaves the others", () => {
    const state = after(...kTwo, { type: "players", players: [player("a", { playing: false })], server_time_us: 2e6 });
    assert.equal(state.players["a"].playing, false);
    assert.equal(state.players["b"].playing, true);
  });

  test("what is older than what is known is no news", () => {
    const state = after(...kTwo, { type: "players", players: [player("a", { speed: 9 })], server_time_us: 0.5e6 });
    assert.equal(state.players["a"].speed, 1);
  });

  test("an actor that is gone takes its player and its selection along", () => {
    const state = after(...kTwo, { type: "selected", actor: "b" }, { type: "described", scene: scene("a") });
    assert.deepEqual(Object.keys(state.players), ["a"]);
    assert.equal(state.selected, null);
  });

  test("a selection outlives other edits", () => {
    const state = after(...kTwo, { type: "selected", actor: "b" }, { type: "described", scene: scene("c", "b") });
    assert.equal(state.selected, "b");
  });

  test("a player that has ended stands at its end", () => {
    const once = { type: "players", players: [player("a", { loop: "once", speed: -1 }), player("b")], server_time_us: 2e6 };
    const ended = after(...kTwo, once, { type: "ended", actor: "a", clip: "c" }, { type: "ended", actor: "b", clip: "c" });
    assert.deepEqual([ended.players["a"].playing, ended.players["a"].time], [false, 0]);
    assert.deepEqual([ended.players["b"].playing, ended.players["b"].time], [false, 4]);
  });

  test("the end of another clip, or of nobody, changes nothing", () => {
    const state = after(...kTwo);
    assert.equal(reduce(state, { type: "ended", actor: "a", clip: "other" }), state);
    assert.equal(reduce(state, { type: "ended", actor: "none", clip: "c" }), state);
  });
});

describe("readings", () => {
  const reading = { type: "reading", actor: null, time: 3, server_us: 2e6, jumped: false };

  test("of a picture are the first actor's", () => {
    const state = after(...kTwo, reading);
    assert.deepEqual([state.players["a"].time, state.players["a"].at_us], [3, 2e6]);
    assert.equal(state.players["b"].time, 2);
  });
  test("of a named actor are its own", () => assert.equal(after(...kTwo, { ...reading, actor: "b" }).players["b"].time, 3));
  test("of nobody change nothing", () => {
    const state = after();
    assert.equal(reduce(state, reading), state);
  });
  test("which way a ping-pong goes is kept until it becomes something else", () => {
    const pong = (changes = {}) => [player("a", { loop: "ping_pong", ...changes })];
    const back = [
      { type: "players", players: pong(), server_time_us: 2e6 },
      { ...reading, time: 0.9, server_us: 2.1e6 },
    ];
    assert.equal(after(...kTwo, ...back).players["a"].returning, true);
    const kept = after(...kTwo, ...back, { type: "players", players: pong({ speed: 2 }), server_time_us: 3e6 });
    assert.equal(kept.players["a"].returning, true);
    const other = after(...kTwo, ...back, { type: "players", players: [player("a")], server_time_us: 3e6 });
    assert.equal(other.players["a"].returning, false);
  });
});

describe("without a connection", () => {
  test("time stands where it was then", () => {
    const state = after(...kTwo, { type: "disconnected", now_us: 2e6 });
    assert.equal(state.connected, false);
    assert.deepEqual([state.players["a"].time, state.players["a"].playing], [2, false]);
  });
  test("the next server's clock may say anything", () => {
    const again = { type: "players", players: [player("a", { time: 0.5 })], server_time_us: 10 };
    const state = after(...kTwo, { type: "disconnected", now_us: 2e6 }, { type: "connected", can_control: false }, again);
    assert.deepEqual([state.players["a"].time, state.players["a"].at_us, state.can_control], [0.5, 10, false]);
  });
});

describe("who is meant", () => {
  test("all, and the first leads; or the selected one", () => {
    const all = after(...kTwo);
    assert.equal(lead_player(all)?.actor, "a");
    assert.deepEqual(selected_players(all).map((p) => p.actor), ["a", "b"]);
    const one = reduce(all, { type: "selected", actor: "b" });
    assert.equal(lead_player(one)?.actor, "b");
    assert.deepEqual(selected_players(one).map((p) => p.actor), ["b"]);
  });
  test("nobody, where there is nobody", () => {
    assert.equal(lead_player(after()), null);
    assert.deepEqual(selected_players(after()), []);
  });
});

describe("markers", () => {
  const list = [{ marker: 7, time: 0.5, name: "left" }];
  const markers = (actor, clip) => ({ type: "markers", actor, clip, list });
  test("are those of the clip that the lead player plays", () => {
    assert.deepEqual(lead_markers(after(...kTwo, markers("a", "c"))), list);
    assert.deepEqual(lead_markers(after(...kTwo, markers("a", "c"), { type: "selected", actor: "b" })), []);
  });
  test("of another clip, or that nobody has told, are none", () => {
    assert.deepEqual(lead_markers(after(...kTwo, markers("a", "other"))), []);
    assert.deepEqual(lead_markers(after(...kTwo)), []);
    assert.deepEqual(lead_markers(after()), []);
  });
  test("that are crossed twice are news twice", () => {
    const crossed = { type: "crossed", actor: "a", clip: "c", marker: 7 };
    const once = after(...kTwo, crossed);
    assert.deepEqual(once.crossed, { actor: "a", clip: "c", marker: 7 });
    assert.notEqual(reduce(once, crossed).crossed, once.crossed);
  });
});

test("listeners are told at once and of changes only", () => {
  const store = new StageStore("main");
  const told = [];
  const end = store.subscribe((s) => told.push(s.revision));
  store.dispatch({ type: "ended", actor: "x", clip: "y" });
  store.dispatch({ type: "described", scene: scene("a") });
  end();
  store.dispatch({ type: "described", scene: scene() });
  assert.deepEqual(told, [0, 1]);
  assert.equal(store.state.revision, 0);
});
