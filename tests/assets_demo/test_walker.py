#!/usr/bin/env python3
"""The demo's walker: the committed file is what its script makes, is sound glTF, and walks as people do."""
import math
import os
import sys
import unittest

from glb_file import GlbFile, moved

ASSETS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "assets")
sys.path.insert(0, ASSETS)
import make_walker  # noqa: E402
from mesh import signed_volume  # noqa: E402

PARTS = 23  # closed surfaces
STANCES = {"walk": (0.62, 1.10 / 1.0), "run": (0.36, 1.66 / 0.64)}  # share of the loop on the ground, metres a second
FLAT = {"walk": (0.11, 0.33), "run": (0.08, 0.15)}  # of the loop: when the whole sole is on the ground


class Walker(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with open(os.path.join(ASSETS, "walker.glb"), "rb") as file:
            cls.data = file.read()
        cls.file = GlbFile(cls.data)
        cls.clips = {name: cls.file.clip(name) for name in ("walk", "run", "wave")}
        cls.primitive = cls.file.json["meshes"][0]["primitives"][0]

    def attribute(self, name):
        return self.file.rows(self.primitive["attributes"][name])

    def at(self, clip, share, joint):
        """Rotation and place of a joint in the world, at a share of the loop."""
        clip = self.clips[clip]
        return self.file.places(clip, (share % 1.0) * clip.duration)[self.file.node(joint)]

    def test_the_committed_file_is_what_the_script_makes(self):
        self.assertTrue(make_walker.make() == self.data, "walker.glb differs: run assets/make_walker.py")

    def test_it_is_of_modest_size(self):
        self.assertLess(len(self.data), 600_000)
        self.assertGreater(len(self.attribute("POSITION")), 5_000)

    def test_bounds_are_those_of_the_values(self):
        for number, accessor in enumerate(self.file.json["accessors"]):
            if not accessor.get("normalized"):
                columns = list(zip(*self.file.rows(number)))
                self.assertEqual(accessor["min"], [min(c) for c in columns])
                self.assertEqual(accessor["max"], [max(c) for c in columns])

    def test_weights_sum_to_one_and_name_joints(self):
        joints = len(self.file.json["skins"][0]["joints"])
        for numbers, weights in zip(self.attribute("JOINTS_0"), self.attribute("WEIGHTS_0")):
            self.assertAlmostEqual(sum(weights), 1.0, places=6)
            self.assertTrue(all(number < joints and (weight > 0 or number == 0) for number, weight in zip(numbers, weights)))

    def test_every_joint_pulls_at_something(self):
        pulling = {number for row in zip(self.attribute("JOINTS_0"), self.attribute("WEIGHTS_0"))
                   for number, weight in zip(*row) if weight > 0}
        self.assertEqual(pulling, set(range(len(self.file.json["skins"][0]["joints"]))))

    def test_normals_are_unit_and_look_outwards(self):
        positions, normals = self.attribute("POSITION"), self.attribute("NORMAL")
        self.assertTrue(all(abs(math.hypot(*n) - 1) < 1e-3 for n in normals))
        along = 0
        for a, b, c in self.faces():
            u, v = (tuple(q - p for p, q in zip(positions[a], positions[k])) for k in (b, c))
            n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
            along += sum(x * y for x, y in zip(n, normals[a])) > 0
        self.assertGreater(along / len(self.faces()), 0.99)

    def faces(self):
        indices = [i for (i,) in self.file.rows(self.primitive["indices"])]
        return list(zip(*[iter(indices)] * 3))

    def test_every_part_is_closed_and_wound_outwards(self):
        edges = [edge for a, b, c in self.faces() for edge in ((a, b), (b, c), (c, a))]
        self.assertEqual(len(set(edges)), len(edges))
        self.assertEqual({(b, a) for a, b in edges}, set(edges))
        parent = list(range(len(self.attribute("POSITION"))))

        def root(v):
            while parent[v] != v:
                parent[v] = parent[parent[v]]
                v = parent[v]
            return v

        for a, b in edges:
            parent[root(a)] = root(b)
        parts = {}
        for face in self.faces():
            parts.setdefault(root(face[0]), []).append(face)
        self.assertEqual(len(parts), PARTS)
        for part in parts.values():
            self.assertGreater(signed_volume(self.attribute("POSITION"), part), 0)

    def test_at_rest_it_stands_on_the_ground_and_is_as_tall_as_it_says(self):
        heights = [y for _, y, _ in self.attribute("POSITION")]
        self.assertAlmostEqual(min(heights), 0.0, places=3)
        self.assertAlmostEqual(max(heights), 1.82, delta=0.03)

    def test_the_bind_pose_is_the_rest_pose(self):
        class Nothing:
            def sample(self, node, path, time):
                return None

        rest = self.file.places(Nothing(), 0.0)
        skin = self.file.json["skins"][0]
        for joint, matrix in zip(skin["joints"], self.file.rows(skin["inverseBindMatrices"])):
            self.assertEqual(matrix[:12] + matrix[15:], (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1))
            for place, back in zip(rest[joint][1], matrix[12:15]):
                self.assertAlmostEqual(place, -back, places=4)

    def test_rotations_are_unit_and_neighbours_of_one_sign(self):
        for clip in self.clips.values():
            for (_, path), (_, rows, mode) in clip.tracks.items():
                if path == "rotation":
                    keys = rows[1::3] if mode == "CUBICSPLINE" else rows
                    self.assertTrue(all(abs(math.hypot(*key) - 1) < 1e-6 for key in keys))
                    self.assertTrue(all(sum(a * b for a, b in zip(*pair)) > 0 for pair in zip(keys, keys[1:])))

    def test_every_clip_keys_every_joint_and_is_a_closed_loop(self):
        for clip in self.clips.values():
            self.assertEqual({node for node, path in clip.tracks if path == "rotation"}, set(self.file.json["skins"][0]["joints"]))
            for times, rows, mode in clip.tracks.values():
                self.assertEqual((times[0], times[-1]), (0.0, clip.duration))
                keys = rows[1::3] if mode == "CUBICSPLINE" else rows
                width = len(keys) // len(times)  # morph weights: several numbers a key
                self.assertEqual(keys[:width], keys[-width:])

    def test_no_joint_jumps(self):
        """Between keys of every clip, over the seam as well, no joint turns faster than 30 rad/s."""
        for name, clip in self.clips.items():
            for (node, path), (times, rows, mode) in clip.tracks.items():
                if path == "rotation":
                    keys = rows[1::3] if mode == "CUBICSPLINE" else rows
                    for (t, a), (u, b) in zip(zip(times, keys), zip(times[1:], keys[1:])):
                        angle = 2 * math.acos(min(1.0, abs(sum(x * y for x, y in zip(a, b)))))
                        self.assertLess(angle / (u - t), 30, (name, self.file.nodes[node]["name"], t))

    def test_a_flat_foot_stays_where_the_ground_carries_it(self):
        for name, (_, speed) in STANCES.items():
            duration, (first, last) = self.clips[name].duration, FLAT[name]
            for joint, late in (("foot_l", 0.0), ("foot_r", 0.5)):
                _, start = self.at(name, first + late, joint)
                for step in range(1, 21):
                    share = first + (last - first) * step / 20
                    turn, place = self.at(name, share + late, joint)
                    self.assertAlmostEqual(place[0], start[0], delta=0.002)
                    self.assertAlmostEqual(place[1], start[1], delta=0.002)
                    self.assertAlmostEqual(place[2], start[2] - speed * (share - first) * duration, delta=0.004)
                    self.assertGreater(abs(turn[3]), 0.9998)  # level: turned by less than 2.3 degrees

    def test_each_foot_lands_in_front_at_its_marker_and_leaves_behind(self):
        for name, (stance, _) in STANCES.items():
            for suffix, late in (("l", 0.0), ("r", 0.5)):
                hips = self.at(name, late, "hips")[1]
                self.assertGreater(self.at(name, late, f"foot_{suffix}")[1][2], hips[2] + 0.15)
                self.assertLess(self.at(name, late + stance, f"toes_{suffix}")[1][2], hips[2] - 0.15)
                swung = [self.at(name, late + stance + (1 - stance) * s, f"foot_{suffix}")[1][1] for s in (0.3, 0.5, 0.7)]
                self.assertGreater(min(swung), self.at(name, late + 0.2 * stance, f"foot_{suffix}")[1][1])

    def test_who_runs_flies_and_who_walks_does_not(self):
        lowest = {name: [min(y for _, y, _ in self.shown(name, share)) for share in self.shares(16)] for name in STANCES}
        self.assertGreater(max(lowest["run"]), 0.02)
        self.assertLess(max(lowest["walk"]), 0.012)

    def test_nothing_sinks_into_the_ground(self):
        for name in self.clips:
            for share in self.shares(24):
                self.assertGreater(min(y for _, y, _ in self.shown(name, share)), -0.01, (name, share))

    def shown(self, name, share):
        return self.file.skinned(self.file.places(self.clips[name], share * self.clips[name].duration))

    @staticmethod
    def shares(count):
        return [i / count for i in range(count)]

    def test_left_and_right_do_the_same_half_a_loop_apart(self):
        for name in STANCES:
            for share in self.shares(12):
                now, later = (self.file.places(self.clips[name], s % 1.0 * self.clips[name].duration) for s in (share, share + 0.5))
                for joint in ("foot", "toes", "lower_leg", "hand", "lower_arm"):
                    left, right = now[self.file.node(f"{joint}_l")][1], later[self.file.node(f"{joint}_r")][1]
                    for a, b in zip(left, (-right[0], right[1], right[2])):
                        self.assertAlmostEqual(a, b, delta=1e-4, msg=(name, share, joint))

    def test_knees_and_elbows_bend_one_way(self):
        for name in self.clips:
            for share in self.shares(16):
                for suffix in "lr":
                    hip, knee, ankle = (self.at(name, share, f"{j}_{suffix}") for j in ("upper_leg", "lower_leg", "foot"))
                    middle = [(a + b) / 2 for a, b in zip(hip[1], ankle[1])]
                    ahead = moved(hip[0], (0, 0, 0), (0, 0, 1))
                    self.assertGreater(sum((k - m) * f for k, m, f in zip(knee[1], middle, ahead)), -0.02, (name, share))

    def test_the_waving_hand_is_above_the_shoulder_and_the_feet_stand(self):
        feet = [self.at("wave", 0.0, f"foot_{s}")[1] for s in "lr"]
        for share in self.shares(20):
            self.assertGreater(self.at("wave", share, "hand_r")[1][1], self.at("wave", share, "upper_arm_r")[1][1] + 0.15)
            for suffix, start in zip("lr", feet):
                self.assertLess(math.dist(self.at("wave", share, f"foot_{suffix}")[1], start), 0.003)

    def test_blinking_closes_the_eyes_and_moves_nothing_else(self):
        blink = self.file.rows(self.primitive["targets"][0]["POSITION"])
        moves = [(p, d) for p, d in zip(self.attribute("POSITION"), blink) if any(d)]
        self.assertTrue(20 < len(moves) < 400)
        heights = [p[1] for p, _ in moves], [p[1] + d[1] for p, d in moves]
        self.assertLess(max(heights[1]) - min(heights[1]), 0.3 * (max(heights[0]) - min(heights[0])))


if __name__ == "__main__":
    unittest.main()
