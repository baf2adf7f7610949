#!/usr/bin/env python3
"""The demo assets: the committed files are what the scripts make, every keyframe is a sound mesh, and the two ways to
interpolate the octopus can be told apart."""
import importlib
import json
import math
import os
import sys
import unittest

from glb_file import GlbFile, moved
from obj_file import ObjFile, png_pixels

ASSETS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "assets")
sys.path.insert(0, ASSETS)
from mesh import signed_volume  # noqa: E402
from obj_writer import asset_files  # noqa: E402

FRAMES = {"barb": [0, 10, 20, 30], "octopus": [0, 12, 24, 36, 48]}
LOOP_FRAMES = {"barb": 40, "octopus": 60}


def committed(name):
    folder = os.path.join(ASSETS, name)
    files = {}
    for file_name in os.listdir(folder):
        with open(os.path.join(folder, file_name), "rb") as file:
            files[file_name] = file.read()
    return files


def keyframes(name):
    return [ObjFile(committed(name)[f"{name}_{frame:06d}.obj"].decode("ascii")) for frame in FRAMES[name]]


def blend(keys, weights):
    """Positions: the weighted sum of keyframes; `weights` is {keyframe: weight}."""
    return [tuple(sum(w * keys[k].positions[i][axis] for k, w in weights.items()) for axis in range(3))
            for i in range(len(keys[0].positions))]


def catmull_rom(count, after, u):
    """Weights of evenly spaced keyframes of a closed clip, u (0 to 1) of the way after a keyframe: PROTOCOL.md section 4."""
    uniform = (-u + 2 * u**2 - u**3, 2 - 5 * u**2 + 3 * u**3, u + 4 * u**2 - 3 * u**3, -u**2 + u**3)
    return {(after + k - 1) % count: w / 2 for k, w in enumerate(uniform)}


def connected_parts(faces):
    """The faces of each part of the mesh that hangs together: lists of position indices."""
    parent = {}

    def root(v):
        while parent.setdefault(v, v) != v:
            v = parent[v]
        return v

    for face in faces:
        for v, _, _ in face[1:]:
            parent[root(v)] = root(face[0][0])
    parts = {}
    for face in faces:
        parts.setdefault(root(face[0][0]), []).append([v for v, _, _ in face])
    return list(parts.values())


class DemoAssets(unittest.TestCase):
    def test_the_committed_files_are_what_the_scripts_make(self):
        for name in FRAMES:
            script = importlib.import_module(f"make_{name}")
            made = asset_files(name, script.build_mesh(), script.keyframes(), script.texture())
            found = committed(name)
            self.assertEqual(sorted(found), sorted(made))
            for file_name, content in made.items():
                same = png_pixels(found[file_name]) == png_pixels(content) if file_name.endswith(".png") else \
                    found[file_name] == content
                self.assertTrue(same, f"{file_name} differs: run assets/make_{name}.py")

    def test_all_is_of_modest_size(self):
        for name in FRAMES:
            for file_name, content in committed(name).items():
                self.assertLess(len(content), 500_000, file_name)

    def test_material_and_texture_are_found(self):
        for name in FRAMES:
            files = committed(name)
            for key in keyframes(name):
                self.assertIn(f"mtllib {name}.mtl", key.other)
                self.assertIn(f"usemtl {name}", key.other)
            mtl = files[f"{name}.mtl"].decode("ascii")
            self.assertIn(f"newmtl {name}\n", mtl)
            self.assertIn(f"map_Kd {name}.png\n", mtl)
            self.assertEqual(png_pixels(files[f"{name}.png"])[:2], (512, 512))

    def test_keyframes_share_faces_and_texture_coordinates(self):
        for name in FRAMES:
            first, *others = keyframes(name)
            for key in others:
                self.assertEqual(len(key.positions), len(first.positions))
                self.assertEqual(key.faces, first.faces)
                self.assertEqual(key.texcoords, first.texcoords)

    def test_texture_coordinates_lie_in_the_picture_and_normals_are_unit(self):
        for name in FRAMES:
            for key in keyframes(name):
                self.assertTrue(all(0 <= x <= 1 for uv in key.texcoords for x in uv))
                self.assertTrue(all(abs(math.hypot(*n) - 1) < 1e-3 for n in key.normals))

    def test_every_part_is_wound_outwards(self):
        for name, count in (("barb", 1), ("octopus", 1 + 8 + 2)):
            for key in keyframes(name):
                parts = connected_parts(key.faces)
                self.assertEqual(len(parts), count)
                for part in parts:
                    self.assertGreater(signed_volume(key.positions, part), 0.001)

    def test_every_part_is_closed(self):
        """Each edge is walked once in each direction; places are compared, since the barb's tip is four vertices in one."""
        for name in FRAMES:
            key = keyframes(name)[0]
            edges = [(key.positions[a], key.positions[b]) for face in key.faces
                     for (a, _, _), (b, _, _) in zip(face, face[1:] + face[:1])]
            self.assertEqual(len(set(edges)), len(edges))
            self.assertEqual({(b, a) for a, b in edges}, set(edges))

    def test_the_barb_is_the_recipe(self):
        upright, bent, down, back = (key.positions for key in keyframes("barb"))
        for height, half_width in ((0, 1), (2, 0.75), (4, 0.5), (6, 0)):
            ring = [(x, z) for x, y, z in upright if y == height]
            self.assertEqual(max(max(abs(x), abs(z)) for x, z in ring), half_width)
        self.assertEqual(bent, back)
        self.assertEqual(sum(p == max(upright, key=lambda p: p[1]) for p in upright), 4)
        tips = [max(zip(upright, pose), key=lambda pair: pair[0][1])[1] for pose in (upright, bent, down)]
        self.assertEqual(tips, sorted(tips, key=lambda p: -p[1]))
        self.assertLess(tips[-1][1], 0.5)

    def test_nothing_sinks_into_the_ground(self):
        for name in FRAMES:
            keys = keyframes(name)
            for after in range(len(keys)):
                for eighth in range(8):
                    shown = blend(keys, catmull_rom(len(keys), after, eighth / 8))
                    self.assertGreater(min(y for _, y, _ in shown), -0.01, (name, after, eighth))

    def test_the_octopus_tells_linear_from_catmull_rom(self):
        keys = keyframes("octopus")
        size = max(max(p[axis] for p in keys[0].positions) - min(p[axis] for p in keys[0].positions) for axis in range(3))
        for after in range(len(keys)):
            straight = blend(keys, {after: 0.5, (after + 1) % len(keys): 0.5})
            curved = blend(keys, catmull_rom(len(keys), after, 0.5))
            apart = [math.dist(a, b) for a, b in zip(straight, curved)]
            self.assertGreater(max(apart), 0.05 * size)
            self.assertGreater(sum(apart) / len(apart), 0.02 * size)


class Demo(unittest.TestCase):
    def setUp(self):
        with open(os.path.join(ASSETS, "demo.json"), encoding="utf-8") as file:
            self.edits = json.load(file)

    def test_it_shows_loops_of_the_committed_assets(self):
        added = self.params_of("actor.add")
        self.assertEqual([a["actor"] for a in added], ["octopus_linear", "octopus_catmull_rom", "barb", "walker"])
        for actor in added[:3]:
            self.assertTrue(actor["closed"])
            self.assertAlmostEqual(actor["duration"], LOOP_FRAMES[actor["asset"]] / actor["fps"], places=5)

    def params_of(self, method):
        return [edit["params"] for edit in self.edits if edit["method"] == method]

    def test_the_walkers_markers_stand_where_its_feet_land(self):
        """At a marker the foot of its name is the one in front, and comes down."""
        walker = self.walker()
        marked = [(m["clip"], m["name"]) for m in self.params_of("marker.add") if m["actor"] == "walker"]
        self.assertEqual(sorted(marked), [(clip, side) for clip in ("run", "walk") for side in ("left", "right")])
        for marker in self.params_of("marker.add"):
            clip, foot, other = walker.clip(marker["clip"]), "foot_" + marker["name"][0], "foot_" + "lr"[marker["name"] == "left"]
            before, now = (walker.places(clip, (marker["time"] + s) % clip.duration) for s in (-0.05, 0.0))
            places = [pose[walker.node(foot)][1] for pose in (before, now)]
            self.assertGreater(places[1][2], now[walker.node(other)][1][2] + 0.3)
            self.assertGreater(places[0][1], places[1][1] + 0.01)

    @staticmethod
    def walker():
        with open(os.path.join(ASSETS, "walker.glb"), "rb") as file:
            return GlbFile(file.read())

    def test_no_two_actors_touch(self):
        """Their boxes over all poses, Catmull-Rom's overshoot included, stand apart on the ground."""
        boxes = [self.ground_box(actor) for actor in self.params_of("actor.add")]
        for i, a in enumerate(boxes):
            for b in boxes[:i]:
                self.assertTrue(any(a[axis][1] < b[axis][0] or b[axis][1] < a[axis][0] for axis in (0, 1)), (a, b))

    def ground_box(self, actor):
        shown = self.all_poses(actor["asset"])
        transform = actor["transform"]
        turn, grow = tuple(transform.get("rotation", (0, 0, 0, 1))), transform.get("scale", [1, 1, 1])
        places = [moved(turn, transform["translation"], [x * s for x, s in zip(p, grow)]) for p in shown]
        return [(min(p[axis] for p in places), max(p[axis] for p in places)) for axis in (0, 2)]

    def all_poses(self, asset):
        if asset == "walker.glb":
            walker = self.walker()
            clips = [walker.clip(name) for name in ("walk", "run", "wave")]
            return [p for clip in clips for i in range(5) for p in walker.skinned(walker.places(clip, clip.duration * i / 5))]
        keys = keyframes(asset)
        return [p for after in range(len(keys)) for quarter in range(4)
                for p in blend(keys, catmull_rom(len(keys), after, quarter / 4))]


if __name__ == "__main__":
    unittest.main()
