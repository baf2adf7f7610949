"""Exporting: asset.export to glb and OBJ sequences, and an actor's .glb by HTTP (sections 5, 5.3 and 7)."""
import json
import math
import os
import shutil
import struct
import subprocess
import unittest

import harness
from harness import TRIANGLE, lifted

HERE = os.path.dirname(os.path.abspath(__file__))
NODE = shutil.which("node") or shutil.which("nodejs")


def read_glb(data):
    """The JSON of a .glb file, and its buffer."""
    magic, version, length, json_bytes, kind = struct.unpack_from("<5I", data)
    assert (magic, version, length, kind) == (0x46546C67, 2, len(data), 0x4E4F534A)
    return json.loads(data[20:20 + json_bytes]), data[28 + json_bytes:]


def turn(angle):
    return [0, 0, math.sin(angle / 2), math.cos(angle / 2)]


class Export(harness.TestCase):
    starts_server = False

    def setUp(self):
        self.root = self.folder()
        self.server = self.serve(assets=[self.root])
        self.c = self.server.line()

    def path(self, name):
        return os.path.join(self.root, name)

    def read(self, name):
        with open(self.path(name), "rb") as f:
            return f.read()

    def files(self):
        return sorted(os.path.relpath(os.path.join(folder, name), self.root)
                      for folder, folders, names in os.walk(self.root) for name in names + folders)

    def export(self, name, format="glb", **kw):
        result = self.c.call("asset.export", format=format, name=name, **kw)
        self.assertEqual(result["name"], name)
        return result

    def validate(self, *names):
        """No error and no warning of the Khronos validator."""
        if NODE is None:
            self.fail("expected node, which runs the Khronos validator; ./dev test installs both")
        run = subprocess.run([NODE, os.path.join(HERE, "validate_gltf.mjs"), *map(self.path, names)], capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)

    def add_arm(self):
        """A skeleton of two roots and a clip of each kind of keyframe."""
        joints = [{"name": "hip", "translation": [0, 1, 0]}, {"name": "knee", "parent": "hip", "translation": [0, -0.5, 0]},
                  {"name": "hat", "scale": [2, 2, 2]}]
        self.c.call("actor.add", actor="arm", skeleton={"joints": joints})
        for i, (mode, angle) in enumerate((("linear", 0), ("step", 1), ("catmull_rom", 2), ("cubic", 0.5), ("linear", 1.5))):
            tangents = {"rotation_out_tangent": [0, 0, 0.3, 0]} if mode == "cubic" else {}
            self.c.call("keyframe.add", time=i * 0.5, interpolation=mode, sparse=i % 2 == 1,
                        pose={"knee": {"rotation": turn(angle), **tangents}, "hat": {"translation": [i, 0, 0]}})
        self.c.call("clip.create", clip="round", closed=True, duration=2.0, interpolation="catmull_rom")
        for i in range(3):
            self.c.call("keyframe.add", clip="round", time=i * 0.5, pose={"hip": {"rotation": turn(i)}},
                        **({"easing": [0.4, 0, 0.2, 1]} if i == 1 else {}))

    def add_wave(self, actor="wave", heights=(0, 1, -2), **kw):
        self.c.call("actor.add", actor=actor, mesh=TRIANGLE, **kw)
        for i, z in enumerate(heights):
            self.c.call("keyframe.add", actor=actor, time=i * 0.5, vertices={"positions": lifted(z)})


class Glb(Export):
    def test_it_is_an_asset(self):
        self.add_wave()
        result = self.export("wave.glb")
        self.assertEqual(result["bytes"], os.path.getsize(self.path("wave.glb")))
        self.assertEqual(self.files(), ["wave.glb"], "nothing else is left")
        self.validate("wave.glb")

    def test_skeletons_are_valid(self):
        self.add_arm()
        self.export("arm.glb")
        self.validate("arm.glb")
        document, _ = read_glb(self.read("arm.glb"))
        self.assertEqual([n["name"] for n in document["nodes"]], ["hip", "knee", "hat"])
        self.assertEqual([a["name"] for a in document["animations"]], ["default", "round"])
        self.assertEqual(document["nodes"][1]["translation"], [0, -0.5, 0])

    def test_poses_come_back_the_same(self):
        """Also where keys lie in different hemispheres, and where a closed clip has turned over at its end."""
        self.add_arm()
        clips = ["default", "round"]
        for mode in ("step", "linear", "catmull_rom", "cubic"):
            for closed in (False, True):
                for signs in ((1, -1, 1, 1), (1, 1, -1, -1), (-1, 1, -1, 1)):
                    clips.append(f"{mode}{len(clips)}")
                    self.c.call("clip.create", clip=clips[-1], interpolation=mode, **({"closed": True, "duration": 4} if closed else {}))
                    for i, sign in enumerate(signs if mode != "cubic" else (1, 1, 1, 1)):
                        self.c.call("keyframe.add", clip=clips[-1], time=i * 0.8 + (0.1 if len(clips) % 2 else 0),
                                    pose={"hip": {"rotation": [sign * v for v in turn(0.9 * i)]}})
        self.export("arm.glb")
        self.validate("arm.glb")
        self.c.call("actor.add", actor="again", asset="arm.glb")
        for clip in clips:
            for time in (0, 0.03, 0.25, 0.55, 0.95, 1.3, 1.75, 2.2, 2.9, 3.6, 3.97):
                a, b = ({j["name"]: j for j in self.c.call("pose.sample", actor=n, clip=clip, time=time)["joints"]}
                        for n in ("arm", "again"))
                for name, joint in a.items():
                    self.near(b[name]["translation"] + b[name]["scale"], joint["translation"] + joint["scale"])
                    sign = 1 if sum(p * q for p, q in zip(joint["rotation"], b[name]["rotation"])) > 0 else -1
                    self.near([sign * v for v in b[name]["rotation"]], joint["rotation"])

    def test_vertices_come_back_the_same(self):
        self.add_wave(interpolation="catmull_rom")
        self.export("wave.glb")
        self.c.call("actor.add", actor="again", asset="wave.glb")
        for time in (0, 0.2, 0.5, 0.77, 1):
            a, b = (self.c.call("vertices.sample", actor=n, clip="default", time=time) for n in ("wave", "again"))
            self.near(b["positions"], a["positions"])
            self.near(b["normals"], a["normals"], 1e-4)

    def test_vertex_clips_become_morph_targets(self):
        self.add_wave(interpolation="catmull_rom")
        self.c.call("clip.create", clip="cue", keys=[k["keyframe"] for k in self.c.call("keyframe.list")["keyframes"]][:2],
                    closed=True, duration=1)
        self.export("wave.glb")
        self.validate("wave.glb")
        document, _ = read_glb(self.read("wave.glb"))
        mesh = document["meshes"][0]
        self.assertEqual(mesh["extras"]["targetNames"], ["default:1", "default:2"], "one for each that differs from the rest")
        self.assertEqual(mesh["weights"], [0, 0])
        self.assertEqual({a["name"]: a["samplers"][0]["interpolation"] for a in document["animations"]},
                         {"default": "CUBICSPLINE", "cue": "CUBICSPLINE"})

    def test_an_actor_that_moves_nothing(self):
        self.c.call("actor.add", actor="still", mesh=TRIANGLE)
        self.export("still.glb")
        self.validate("still.glb")
        self.assertNotIn("animations", read_glb(self.read("still.glb"))[0])

    def test_several_scenes_and_actors(self):
        self.c.call("scene.create", scene="two")
        self.c.call("actor.add", scene="two", actor="a", mesh=TRIANGLE)
        self.add_wave("b")
        self.add_wave("c")
        self.export("a.glb", scene="two")
        self.export("b.glb", actor="b")
        self.refused(-32602, "asset.export", path="params.actor", format="glb", name="c.glb")
        self.refused(-32001, "asset.export", path="params.actor", format="glb", name="c.glb", actor="none")
        self.refused(-32001, "asset.export", path="params.scene", format="glb", name="c.glb", scene="none")
        self.assertEqual(self.files(), ["a.glb", "b.glb"])


class Sequences(Export):
    def test_it_reads_back(self):
        self.add_wave()
        result = self.export("out", "obj_sequence")
        self.assertEqual(self.files(), ["out", "out/out_000000.obj", "out/out_000012.obj", "out/out_000024.obj"])
        self.assertEqual(result["bytes"], sum(os.path.getsize(self.path(f)) for f in self.files()[1:]))
        self.c.call("actor.add", actor="again", asset="out")
        for time in (0, 0.5, 0.7, 1):
            a, b = (self.c.call("vertices.sample", actor=n, time=time) for n in ("wave", "again"))
            self.near(b["positions"], a["positions"], 0)
            self.near(b["normals"], a["normals"], 1e-6)

    def test_frames(self):
        self.add_wave(heights=())
        self.c.call("keyframe.add", time=1.01, vertices={"positions": lifted(1)})
        self.export("late", "obj_sequence")
        self.assertEqual(self.files(), ["late", "late/late_000024.obj"], "the nearest frame")
        self.c.call("keyframe.add", time=1.015, vertices={"positions": lifted(2)})
        error = self.refused(-32602, "asset.export", path="params.actor", format="obj_sequence", name="both")
        for words in ("1.01 s", "1.015 s", "frame 24"):
            self.assertIn(words, error.message)
        self.assertEqual(self.files(), ["late", "late/late_000024.obj"])

    def test_the_players_clip_is_meant(self):
        self.add_wave()
        self.c.call("clip.create", clip="other")
        self.c.call("keyframe.add", clip="other", vertices={"positions": lifted(9)})
        self.c.call("playback.play", clip="other")
        self.export("other", "obj_sequence")
        self.assertEqual(self.files(), ["other", "other/other_000000.obj"])
        self.assertIn(b"v 0 0 9\n", self.read("other/other_000000.obj"))

    def test_a_skeleton_alone_has_no_vertices(self):
        self.add_arm()
        error = self.refused(-32602, "asset.export", path="params.actor", format="obj_sequence", name="arm")
        self.assertIn("glb", error.message)


class Names(Export):
    def setUp(self):
        super().setUp()
        self.c.call("actor.add", actor="tri", mesh=TRIANGLE)

    def test_taken_names(self):
        self.export("a.glb")
        before = self.read("a.glb")
        os.mkdir(self.path("folder"))
        os.symlink("/nowhere/at/all", self.path("dangling.glb"))
        for name, format in (("a.glb", "glb"), ("folder", "obj_sequence"), ("dangling.glb", "glb")):
            self.refused(-32002, "asset.export", path="params.name", format=format, name=name)
        self.assertEqual(self.read("a.glb"), before)
        self.assertEqual(self.files(), ["a.glb", "dangling.glb", "folder"])

    def test_names_that_leave(self):
        outside = self.folder()
        os.symlink(outside, self.path("out"))
        for name in ("../a.glb", "/tmp/a.glb", "x/../../a.glb", "./a.glb", "out/a.glb", "a//b.glb", ""):
            self.refused(-32001, "asset.export", path="params.name", format="glb", name=name)
            self.refused(-32001, "asset.export", path="params.name", format="obj_sequence", name=name[:-4])
        self.assertEqual(os.listdir(outside), [])
        self.assertEqual(self.files(), ["out"])

    def test_names_of_other_letters_and_endings(self):
        for name in (".hidden.glb", "a b.glb", "é.glb", "a.obj", "a.GLB", "x" * 61 + ".glb", "d/.x.glb"):
            self.refused(-32602, "asset.export", path="params.name", format="glb", name=name)
        for name in (".hidden", "a b", "a.obj", "a.glb", "a.GLTF"):
            self.refused(-32602, "asset.export", path="params.name", format="obj_sequence", name=name)
        self.refused(-32602, "asset.export", path="params.format", format="fbx", name="a.fbx")
        self.assertEqual(self.files(), [])

    def test_folders_have_to_be_there(self):
        error = self.refused(-32001, "asset.export", path="params.name", format="glb", name="deep/down/a.glb")
        self.assertIn('"deep/down"', error.message)
        os.makedirs(self.path("deep/down"))
        self.export("deep/down/a.glb")
        self.export("deep/seq", "obj_sequence")
        self.assertEqual(self.files(), ["deep", "deep/down", "deep/down/a.glb", "deep/seq", "deep/seq/seq_000000.obj"])

    @unittest.skipIf(os.geteuid() == 0, "root may write anywhere")
    def test_a_folder_that_can_not_be_written_to(self):
        os.chmod(self.root, 0o500)
        self.addCleanup(os.chmod, self.root, 0o700)
        self.refused(-32006, "asset.export", format="glb", name="a.glb")

    def test_without_an_assets_folder(self):
        c = self.serve().line()
        c.call("actor.add", actor="tri", mesh=TRIANGLE)
        error = self.refused(-32006, "asset.export", by=c, format="glb", name="a.glb")
        self.assertIn("--assets", error.message)

    def test_a_full_disk_leaves_nothing(self):
        """A limit on the length of files stands for the disk."""
        import resource
        server = self.serve(assets=[self.root])
        c = server.line()
        c.call("actor.add", actor="grid", mesh=harness.grid(60))
        resource.prlimit(server.process.pid, resource.RLIMIT_FSIZE, (20_000, resource.RLIM_INFINITY))
        for format, name in (("glb", "grid.glb"), ("obj_sequence", "grid")):
            error = self.refused(-32006, "asset.export", by=c, format=format, name=name)
            self.assertIn(name, error.message)
        resource.prlimit(server.process.pid, resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
        self.assertEqual(self.files(), [])
        c.call("asset.export", format="glb", name="grid.glb")

    def test_the_later_folders_are_left_alone(self):
        second = self.folder()
        c = self.serve(assets=[self.root, second]).line()
        c.call("actor.add", actor="tri", mesh=TRIANGLE)
        c.call("asset.export", format="glb", name="a.glb")
        self.assertEqual((os.listdir(self.root), os.listdir(second)), (["a.glb"], []))


class Http(Export):
    def test_the_file(self):
        self.add_wave()
        status, headers, body = self.server.http("GET", "/scenes/main/actors/wave.glb")
        self.assertEqual((status, headers["content-type"]), (200, "model/gltf-binary"))
        self.assertIn('filename="wave.glb"', headers["content-disposition"])
        self.export("same.glb")
        self.assertEqual(body, self.read("same.glb"))
        status, headers, nothing = self.server.http("HEAD", "/scenes/main/actors/wave.glb")
        self.assertEqual((status, headers["content-length"], nothing), (200, str(len(body)), b""))

    def test_what_is_not_there(self):
        self.add_wave()
        for path in ("main/actors/none.glb", "none/actors/wave.glb", "main/actors/.glb", "main/actors/wave.gltf",
                     "main/actors/x/wave.glb", "main/wave.glb", "main/actors/%FF.glb"):
            status, _, body = self.server.http("GET", f"/scenes/{path}")
            self.assertEqual(status, 404, path)
            self.assertIn(b"expected", body)
        self.assertEqual(self.server.http("POST", "/scenes/main/actors/wave.glb")[0], 405)

    def test_a_too_large_one(self):
        server = self.serve("--max-asset-bytes", 1000)
        c = server.line()
        c.call("actor.add", actor="grid", mesh=harness.grid(20))
        status, _, body = server.http("GET", "/scenes/main/actors/grid.glb")
        self.assertEqual(status, 400)
        self.assertIn(b"1000 bytes", body)


if __name__ == "__main__":
    harness.main()
