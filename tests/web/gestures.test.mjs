import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { PointerTracker, wheel_factor } from "../../clients/web/gestures.js";

let told, tracker;
beforeEach(() => {
  told = [];
  tracker = new PointerTracker({
    turn: (dx, dy) => told.push(["turn", dx, dy]),
    pan: (dx, dy) => told.push(["pan", dx, dy]),
    zoom: (factor) => told.push(["zoom", factor]),
  });
});

test("a pointer that is not down says nothing", () => {
  tracker.move(1, { x: 5, y: 5 });
  tracker.press(1, { x: 0, y: 0 }, false);
  tracker.lift(1);
  tracker.move(1, { x: 5, y: 5 });
  assert.deepEqual(told, []);
  assert.equal(tracker.active, false);
});

test("one pointer turns by how far it went since", () => {
  tracker.press(1, { x: 10, y: 10 }, false);
  tracker.move(1, { x: 13, y: 8 });
  tracker.move(1, { x: 14, y: 8 });
  assert.deepEqual(told, [["turn", 3, -2], ["turn", 1, 0]]);
});

test("with Shift it moves", () => {
  tracker.press(1, { x: 0, y: 0 }, true);
  tracker.move(1, { x: 2, y: 3 });
  assert.deepEqual(told, [["pan", 2, 3]]);
});

test("two fingers apart come nearer, together they move", () => {
  tracker.press(1, { x: 0, y: 0 }, false);
  tracker.press(2, { x: 100, y: 0 }, false);
  tracker.move(2, { x: 200, y: 0 });
  assert.deepEqual(told, [["pan", 50, 0], ["zoom", 0.5]]);
  told.length = 0;
  tracker.move(1, { x: 10, y: 0 });
  tracker.move(2, { x: 210, y: 0 });
  const [right] = [told.filter(([what]) => what === "pan").reduce((sum, [, dx]) => sum + dx, 0)];
  assert.equal(right, 10);
  const zoom = told.filter(([what]) => what === "zoom").reduce((all, [, f]) => all * f, 1);
  assert.ok(Math.abs(zoom - 1) < 1e-12);
});

test("the finger that stays turns again; a third says nothing", () => {
  tracker.press(1, { x: 0, y: 0 }, false);
  tracker.press(2, { x: 100, y: 0 }, false);
  tracker.press(3, { x: 50, y: 0 }, false);
  tracker.move(3, { x: 70, y: 0 });
  tracker.lift(2);
  tracker.move(1, { x: 4, y: 0 });
  assert.deepEqual(told, [["turn", 4, 0]]);
});

test("fingers on one spot do not divide by nothing", () => {
  tracker.press(1, { x: 0, y: 0 }, false);
  tracker.press(2, { x: 0, y: 0 }, false);
  tracker.move(2, { x: 10, y: 0 });
  assert.deepEqual(told, [["pan", 5, 0]]);
});

test("the wheel goes away downwards, as far in lines as in pixels, and is never wild", () => {
  assert.ok(wheel_factor({ deltaY: 100, deltaMode: 0, ctrlKey: false }) > 1);
  assert.ok(wheel_factor({ deltaY: -100, deltaMode: 0, ctrlKey: false }) < 1);
  assert.equal(wheel_factor({ deltaY: 3, deltaMode: 1, ctrlKey: false }), wheel_factor({ deltaY: 48, deltaMode: 0, ctrlKey: false }));
  assert.equal(wheel_factor({ deltaY: 1e6, deltaMode: 0, ctrlKey: false }), 2);
  assert.equal(wheel_factor({ deltaY: -1e6, deltaMode: 0, ctrlKey: true }), 0.5);
  assert.ok(wheel_factor({ deltaY: 5, deltaMode: 0, ctrlKey: true }) > wheel_factor({ deltaY: 5, deltaMode: 0, ctrlKey: false }));
});
