import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { anchored, time_at } from "../../clients/web/player_time.js";

const kPlayer = {
  actor: "a", clip: "c", playing: true, time: 1, speed: 1, loop: "repeat", range: [0, 4], duration: 4, at_us: 1e6, returning: false,
};
/** @param {object} changes @param {number} seconds after the anchor */
const time_of = (changes, seconds) => Number(time_at({ ...kPlayer, ...changes }, 1e6 + seconds * 1e6).toFixed(9));

describe("time at a reading", () => {
  test("stands where it was if paused, unknown, without length, or before it was told", () => {
    assert.equal(time_of({ playing: false }, 9), 1);
    assert.equal(time_at(kPlayer, null), 1);
    assert.equal(time_of({ range: [1, 1] }, 9), 1);
    assert.equal(time_of({}, -3), 1);
  });

  test("runs with the speed, backwards too", () => {
    assert.equal(time_of({}, 0.5), 1.5);
    assert.equal(time_of({ speed: 2 }, 0.5), 2);
    assert.equal(time_of({ speed: -1 }, 0.5), 0.5);
    assert.equal(time_of({ speed: 0 }, 5), 1);
  });

  test("once stops at its ends", () => {
    assert.equal(time_of({ loop: "once" }, 9), 4);
    assert.equal(time_of({ loop: "once", speed: -1 }, 9), 0);
    assert.equal(time_of({ loop: "once", range: [0.5, 2] }, 9), 2);
  });

  test("repeat goes around within its range", () => {
    assert.equal(time_of({}, 4), 1);
    assert.equal(time_of({ speed: -1 }, 2), 3);
    assert.equal(time_of({ range: [1, 3] }, 3.5), 2.5);
  });

  test("ping-pong turns at both ends, and may be on its way back already", () => {
    assert.equal(time_of({ loop: "ping_pong" }, 4), 3);
    assert.equal(time_of({ loop: "ping_pong" }, 8), 1);
    assert.equal(time_of({ loop: "ping_pong", speed: -1 }, 2), 1);
    assert.equal(time_of({ loop: "ping_pong", returning: true }, 0.5), 0.5);
    assert.equal(time_of({ loop: "ping_pong", returning: true }, 2), 1);
    assert.equal(time_of({ loop: "ping_pong", range: [1, 3], time: 2 }, 1.5), 2.5);
  });
});

describe("a reading from a packet", () => {
  const player = { ...kPlayer, loop: "ping_pong" };

  test("from before what is known is no news", () => assert.equal(anchored(player, 2, 0.5e6, false), player));
  test("moves the anchor", () => {
    const next = anchored(player, 1.1, 1.1e6, false);
    assert.deepEqual([next.time, next.at_us, next.returning], [1.1, 1.1e6, false]);
  });
  test("shows which way a ping-pong goes", () => {
    assert.equal(anchored(player, 0.9, 1.1e6, false).returning, true);
    assert.equal(anchored({ ...player, returning: true }, 1.1, 1.1e6, false).returning, false);
    assert.equal(anchored({ ...player, speed: -1 }, 0.9, 1.1e6, false).returning, false);
  });
  test("shows nothing over a jump, paused, or in another loop", () => {
    assert.equal(anchored(player, 0.9, 1.1e6, true).returning, false);
    assert.equal(anchored({ ...player, playing: false }, 0.9, 1.1e6, false).returning, false);
    assert.equal(anchored(kPlayer, 0.9, 1.1e6, false).returning, false);
  });
});
