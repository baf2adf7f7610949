"""What is shown between keyframes, against the formulas of section 4 written out plainly."""
import math
import random

import harness
from harness import lifted


def catmull_rom(keys, t, closed, duration):
    """Section 4's blend of (time, value) keys: a Hermite blend with central tangents."""
    n = len(keys)

    def key(i):
        if closed:
            return keys[i % n][0] + duration * (i // n), keys[i % n][1]
        if i < 0:  # repeated, as far outside as its neighbour is inside
            return 2 * keys[0][0] - keys[1][0], keys[0][1]
        if i >= n:
            return 2 * keys[-1][0] - keys[-2][0], keys[-1][1]
        return keys[i]

    i = max((i for i in range(n) if keys[i][0] <= t), default=0)
    if not closed and i == n - 1:
        return keys[-1][1]
    (t0, x0), (t1, x1), (t2, x2), (t3, x3) = (key(j) for j in range(i - 1, i + 3))
    u, h = (t - t1) / (t2 - t1), t2 - t1
    m1, m2 = (x2 - x0) / (t2 - t0), (x3 - x1) / (t3 - t1)
    return ((2 * u**3 - 3 * u**2 + 1) * x1 + (u**3 - 2 * u**2 + u) * h * m1 + (-2 * u**3 + 3 * u**2) * x2 + (u**3 - u**2) * h * m2)


def linear(keys, t, closed, duration):
    ring = keys + ([(duration, keys[0][1])] if closed else [])
    for (t0, x0), (t1, x1) in zip(ring, ring[1:]):
        if t0 <= t <= t1:
            return x0 + (x1 - x0) * (t - t0) / (t1 - t0)
    return keys[0][1] if t < keys[0][0] else ring[-1][1]


def step(keys, t, closed, duration):
    if closed and t >= duration:
        t -= duration
    return next((x for time, x in reversed(keys) if time <= t), keys[0][1])


class Samples(harness.TestCase):
    def height(self, t):
        sample = self.c.call("vertices.sample", time=t)
        self.assertEqual(sample["count"], 3)
        return sample["positions"][2]

    def test_even_keys_give_the_uniform_formula(self):
        heights = [3, -1, 4, 10, 2]
        self.add_triangle(interpolation="catmull_rom")
        for i, h in enumerate(heights):
            self.add_key(h, time=i)
        for t in (1.25, 1.5, 2.75):
            i, u = int(t), t - int(t)
            a, b, c, d = heights[i - 1:i + 3]
            want = (2 * b + (c - a) * u + (2 * a - 5 * b + 4 * c - d) * u * u + (-a + 3 * b - 3 * c + d) * u**3) / 2
            self.assertAlmostEqual(self.height(t), want, places=4)

    def test_random_clips_open_and_closed_even_and_uneven(self):
        seed = random.randrange(1 << 30)
        rng = random.Random(seed)
        blends = {"step": step, "linear": linear, "catmull_rom": catmull_rom}
        for round_ in range(12):
            times = sorted(rng.sample(range(1, 40), rng.randrange(1, 6)))
            times = [0] + [t / 4 for t in times] if round_ % 3 else list(range(rng.randrange(2, 6)))
            keys = [(float(t), rng.randrange(-50, 50) / 4) for t in times]
            closed = round_ % 2 == 1
            actor = f"a{round_}"
            self.add_triangle(actor, closed=closed)
            for t, h in keys:
                self.add_key(h, actor=actor, time=t)
            duration = self.c.call("keyframe.list", actor=actor)["duration"]
            want = keys[-1][0] * len(keys) / (len(keys) - 1) if closed else keys[-1][0]
            self.assertAlmostEqual(duration, want, places=9)
            for mode, blend in blends.items():
                self.c.call("actor.update", actor=actor, interpolation=mode)
                for t in [rng.uniform(0, duration) for _ in range(8)] + [t for t, _ in keys]:
                    got = self.c.call("vertices.sample", actor=actor, time=t)["positions"][2]
                    self.assertAlmostEqual(got, blend(keys, t, closed, duration), delta=2e-4,
                                           msg=f"seed {seed}: {mode} of {keys}, closed {closed}, at {t}")

    def test_time_is_clamped_to_the_clip(self):
        self.add_moving()
        for t, clamped in ((-1, 0), (0, 0), (2, 2), (2.5, 2), (1e300, 2), (-1e300, 0)):
            sample = self.c.call("vertices.sample", time=t)
            self.assertEqual((sample["time"], sample["positions"][2]), (clamped, clamped**2))

    def test_the_end_of_a_closed_clip_is_its_beginning(self):
        self.add_moving(closed=True)
        self.assertEqual(self.c.call("vertices.sample", time=3)["positions"], lifted(0))
        self.assertEqual(self.c.call("vertices.sample", time=99)["time"], 3)

    def test_without_a_time_it_is_what_is_shown(self):
        self.add_moving(keys=2)
        for t in (0.25, 0.75):
            self.c.call("playback.seek", time=t)
            sample = self.c.call("vertices.sample")
            self.assertEqual((sample["time"], sample["positions"]), (t, lifted(t)))
        before = self.c.call("playback.play", loop="once", speed=0.1)["players"][0]["time"]
        sample = self.c.call("vertices.sample")
        after = self.player()["time"]
        self.assertTrue(before <= sample["time"] <= after)
        self.assertAlmostEqual(sample["positions"][2], sample["time"], places=6)

    def test_another_clip_than_the_player_is_on(self):
        self.add_moving()
        self.c.call("clip.create", clip="other", keys=[3, 1], duration=1)
        self.assertEqual(self.c.call("vertices.sample", clip="other", time=0)["positions"], lifted(4))
        self.refused(-32001, "vertices.sample", path="params.clip", clip="none")

    def test_normals_are_unit_length_and_follow_the_surface(self):
        self.add_moving(interpolation="catmull_rom")
        for t in (0, 0.3, 1.7):
            sample = self.c.call("vertices.sample", time=t)
            for i in range(0, 9, 3):
                self.assertAlmostEqual(math.hypot(*sample["normals"][i:i + 3]), 1, places=4)
        flat = self.c.call("vertices.sample", time=0)["normals"]
        self.near(flat, [0, 0, 1] * 3)

    def test_normals_weigh_their_triangles_by_area(self):
        positions = [0, 0, 0, 4, 0, 0, 0, 4, 0, 0, 0, 1]  # a large triangle facing +Z and a small one facing +X meet at 0
        self.c.call("actor.add", actor="a", mesh={"positions": positions, "indices": [0, 1, 2, 0, 2, 3]})
        normals = self.c.call("vertices.sample")["normals"]
        length = math.hypot(16, 4)
        self.near(normals[:3], [4 / length, 0, 16 / length], 1e-5)
        self.near(normals[3:6], [0, 0, 1], 1e-5)
        self.near(normals[9:12], [1, 0, 0], 1e-5)

    def test_indices_only_on_request(self):
        self.add_moving()
        self.assertEqual(set(self.c.call("vertices.sample")), {"time", "count", "positions", "normals"})
        self.assertEqual(self.c.call("vertices.sample", indices=True)["indices"], [0, 1, 2])
        self.assertNotIn("indices", self.c.call("vertices.sample", indices=False))

    def test_sampling_changes_nothing(self):
        self.add_moving()
        with self.unchanged():
            for t in (0, 1, 2):
                self.c.call("vertices.sample", time=t, indices=True)

    def test_a_mesh_of_many_vertices(self):
        mesh = harness.grid(150)
        self.c.call("actor.add", actor="grid", mesh=mesh)
        for height in (0.0, 2.0):
            self.c.call("keyframe.add", vertices={"positions": harness.grid(150, height)["positions"]})
        sample = self.c.call("vertices.sample", time=0.25)
        self.assertEqual(sample["count"], 150 * 150)
        self.near(sample["positions"], harness.grid(150, 0.5)["positions"], 1e-6)


if __name__ == "__main__":
    harness.main()
