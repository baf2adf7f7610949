import assert from "node:assert/strict";
import { test } from "node:test";
import { ServerClock } from "../../clients/web/clock.js";

let local = 0;
const clock_at = (us) => ((local = us), new ServerClock(() => local));

test("nobody knows before the first answer", () => {
  assert.equal(clock_at(5).now_us(), null);
});

test("the answer lies in the middle between question and reading", () => {
  const clock = clock_at(2000);
  clock.add(1000, 500_000, 2000); // the server read 500,000 at our 1,500
  assert.equal(clock.now_us(), 500_500);
  local = 3000;
  assert.equal(clock.now_us(), 501_500);
});

test("the quickest answer is believed", () => {
  const clock = clock_at(0);
  clock.add(0, 100_000, 4000); // offset 98,000
  clock.add(10_000, 110_100, 10_200); // offset 100,000
  clock.add(20_000, 130_000, 29_000);
  assert.equal(clock.best.round_trip_us, 200);
  assert.equal(clock.best.offset_us, 100_000);
});

test("an old answer is forgotten, for clocks drift", () => {
  const clock = clock_at(0);
  clock.add(0, 1000, 10);
  clock.add(61e6, 61e6 + 5000, 61e6 + 1000);
  assert.equal(clock.best.offset_us, 4500);
});

test("only so many answers are kept", () => {
  const clock = clock_at(0);
  clock.add(0, 1000, 1);
  for (let i = 1; i <= 16; ++i) clock.add(i * 1000, i * 1000 + 50, i * 1000 + 100);
  assert.equal(clock.best.offset_us, 0);
});

test("another server has another clock", () => {
  const clock = clock_at(0);
  clock.add(0, 1000, 1);
  clock.reset();
  assert.equal(clock.now_us(), null);
});
