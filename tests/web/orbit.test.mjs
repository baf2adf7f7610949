import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { eye_of, orbit_of, panned, turned, zoomed } from "../../clients/web/orbit.js";

const kOrbit = { azimuth: 0, elevation: 0, distance: 10, target: [0, 0, 0] };
const kPlanes = { near: 0.1, far: 500 };

/** @param {ArrayLike<number>} found @param {ArrayLike<number>} expected */
function near(found, expected) {
  for (let i = 0; i < expected.length; ++i) {
    assert.ok(Math.abs(found[i] - expected[i]) < 1e-9, `expected ${expected}, found ${found}`);
  }
}

describe("an orbit and its eye", () => {
  test("azimuth turns from +Z to +X, elevation lifts", () => {
    near(eye_of(kOrbit), [0, 0, 10]);
    near(eye_of({ ...kOrbit, azimuth: Math.PI / 2 }), [10, 0, 0]);
    near(eye_of({ ...kOrbit, elevation: Math.PI / 2 }), [0, 10, 0]);
    near(eye_of({ ...kOrbit, azimuth: 0.3, elevation: 0.4, target: [1, 2, 3] }), [
      1 + 10 * Math.sin(0.3) * Math.cos(0.4),
      2 + 10 * Math.sin(0.4),
      3 + 10 * Math.cos(0.3) * Math.cos(0.4),
    ]);
  });

  test("the orbit of a camera has its eye", () => {
    for (const eye of [[0, 2, 10], [-3, -1, 2], [5, 0.5, -7]]) {
      const target = [0.5, 0.25, -1];
      near(eye_of(orbit_of({ eye, target })), eye);
    }
  });

  test("a camera above its target is held short of the pole", () => {
    const orbit = orbit_of({ eye: [0, 10, 0], target: [0, 0, 0] });
    assert.ok(orbit.elevation < Math.PI / 2);
    assert.equal(orbit.distance, 10);
  });

  test("a camera on its target has some orbit all the same", () => {
    const orbit = orbit_of({ eye: [1, 1, 1], target: [1, 1, 1] });
    assert.ok(orbit.distance > 0 && Number.isFinite(orbit.elevation));
  });
});

describe("turning", () => {
  test("to the right the scene follows, so the camera goes left", () => {
    const orbit = turned(kOrbit, 100, 0, 400);
    near([orbit.azimuth, orbit.elevation], [-Math.PI / 4, 0]);
    assert.ok(eye_of(orbit)[0] < 0);
  });

  test("downwards the camera rises", () => near([turned(kOrbit, 0, 100, 400).elevation], [Math.PI / 4]));

  test("never over a pole, and the azimuth stays within a turn", () => {
    assert.ok(turned(kOrbit, 0, 9999, 400).elevation < Math.PI / 2);
    assert.ok(turned(kOrbit, 0, -9999, 400).elevation > -Math.PI / 2);
    let orbit = kOrbit;
    for (let i = 0; i < 100; ++i) orbit = turned(orbit, 377, 0, 400);
    assert.ok(Math.abs(orbit.azimuth) <= Math.PI);
  });

  test("nothing is changed in place", () => {
    turned(kOrbit, 5, 5, 100);
    panned(kOrbit, 5, 5, 100, 1);
    zoomed(kOrbit, 2, kPlanes);
    assert.deepEqual(kOrbit, { azimuth: 0, elevation: 0, distance: 10, target: [0, 0, 0] });
  });
});

describe("zooming", () => {
  test("multiplies the distance", () => assert.equal(zoomed(kOrbit, 0.5, kPlanes).distance, 5));
  test("keeps the target between the planes", () => {
    assert.equal(zoomed(kOrbit, 1e-9, kPlanes).distance, 0.2);
    assert.equal(zoomed(kOrbit, 1e9, kPlanes).distance, 450);
  });
});

describe("moving", () => {
  const kFov = Math.PI / 2; // at 10 m the picture is 20 m high

  test("what is under the pointer stays there", () => {
    near(panned(kOrbit, 10, 0, 200, kFov).target, [-1, 0, 0]);
    near(panned(kOrbit, 0, 10, 200, kFov).target, [0, 1, 0]);
  });

  test("sideways of where the camera looks", () => {
    near(panned({ ...kOrbit, azimuth: Math.PI / 2 }, 10, 0, 200, kFov).target, [0, 0, 1]);
    const steep = { ...kOrbit, elevation: Math.PI / 3, azimuth: 1 };
    const moved = panned(steep, 30, -70, 200, kFov);
    const eye = eye_of(steep);
    const offset = moved.target.map((v, i) => v - steep.target[i]);
    near([offset.reduce((sum, v, i) => sum + v * eye[i], 0)], [0]); // at a right angle to the view
    near([moved.distance], [steep.distance]);
  });
});
