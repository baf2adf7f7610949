"""glTF assets: read as the specification says, refused where they are not what they should be (sections 3 and 5.3)."""
import math
import os
import random
import subprocess
import unittest

import harness
from gltf_file import GltfFile, about_z, arm, sample, unit
from harness import TWEEND


def run_program(*arguments):
    return subprocess.run([TWEEND, *map(str, arguments)], capture_output=True, text=True, timeout=60,
                          preexec_fn=harness.die_with_parent)


class GltfTestCase(harness.TestCase):
    starts_server = False

    def setUp(self):
        self.root = self.folder()
        self.server = None

    def start(self, *options):
        self.server = self.serve(*options, assets=[self.root])
        self.c = self.server.line()

    def write(self, name, data):
        path = os.path.join(self.root, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "wb") as f:
            f.write(data)
        return path


class Reading(GltfTestCase):
    def test_both_forms_are_listed_and_added(self):
        self.write("arm.glb", arm().glb())
        self.write("text/arm.gltf", arm().gltf("arm%20data.bin"))
        self.write("text/arm data.bin", bytes(arm().blob))
        self.start()
        listed = {a["name"]: a["type"] for a in self.c.call("asset.list")["assets"]}
        self.assertEqual(listed, {"arm.glb": "glb", "text/arm.gltf": "gltf"})
        for i, name in enumerate(sorted(listed)):
            added = self.c.call("actor.add", actor=f"a{i}", asset=name)
            self.assertEqual((added["clips"], added["vertices"], added["joints"]), (["bend", "still"], 6, 3))
        described = self.c.call("scene.describe")["actors"][0]
        self.assertEqual(described["joints"][2], {"name": "elbow", "parent": "shoulder"})
        self.assertEqual([c["type"] for c in described["clips"]], ["skeletal", "skeletal"])

    def test_the_skin_bends(self):
        self.write("arm.glb", arm().glb())
        self.start()
        self.c.call("actor.add", actor="arm", asset="arm.glb")
        sampled = self.c.call("vertices.sample", time=1.0)
        # The elbow at (0, 1, 0) turns by 90 degrees: (x, 1 + h) goes to (-h, 1 + x); the middle follows half of that.
        self.near(sampled["positions"][12:18], [-1, 0.75, 0, -1, 1.25, 0])
        self.near(sampled["positions"][6:9], [-0.125, 0.875, 0])

    def test_options_of_sequences_are_refused(self):
        self.write("arm.glb", arm().glb())
        self.start()
        for name, value in (("fps", 24), ("closed", True), ("duration", 3)):
            self.refused(-32602, "actor.add", path=f"params.{name}", actor="a", asset="arm.glb", **{name: value})

    def test_subscribers_hear_how_far_it_is(self):
        self.write("arm.glb", arm().glb())
        self.start()
        other = self.server.line()
        other.call("events.subscribe")
        self.c.call("actor.add", actor="arm", asset="arm.glb")
        heard = [other.event("asset.progress")]
        while heard[-1]["fraction"] < 1:
            heard.append(other.event("asset.progress"))
        self.assertEqual(heard[0], {"scene": "main", "actor": "arm", "asset": "arm.glb", "fraction": 0})
        self.assertEqual([h["fraction"] for h in heard], sorted(h["fraction"] for h in heard))


class Sampling(GltfTestCase):
    """Random hierarchies with tracks of every kind against the specification's formulas in doubles."""

    def random_file(self, rng, joints):
        f = GltfFile()
        parents = [None] + [rng.randrange(i) for i in range(1, joints)]
        rest = []
        for i in range(joints):
            rest.append({"translation": [rng.uniform(-1, 1) for _ in range(3)],
                         "rotation": unit([rng.gauss(0, 1) for _ in range(4)]),
                         "scale": [rng.uniform(0.5, 2) for _ in range(3)]})
            children = [c for c in range(joints) if parents[c] == i]
            f.json["nodes"].append({"name": f"j{i}", **rest[i], **({"children": children} if children else {})})
        tracks = {}
        for joint in range(joints):
            for path, width in (("translation", 3), ("rotation", 4), ("scale", 3)):
                if rng.random() < 0.3:
                    continue
                mode = rng.choice(["LINEAR", "STEP", "CUBICSPLINE"])
                keys = rng.randint(1, 9)
                times = sorted({harness.struct.unpack("f", harness.struct.pack("f", rng.uniform(0, 4)))[0] for _ in range(keys)})
                rows = len(times) * (3 if mode == "CUBICSPLINE" else 1)
                values = []
                for row in range(rows):
                    tangent = mode == "CUBICSPLINE" and row % 3 != 1
                    value = [rng.gauss(0, 1) for _ in range(width)]
                    values += unit(value) if path == "rotation" and not tangent else value
                tracks[joint, path] = (times, harness.struct.unpack(f"{len(values)}f", harness.struct.pack(f"{len(values)}f", *values)), width, mode)
        f.animation("all", *((j, p, t[3], t[0], t[1]) for (j, p), t in tracks.items()))
        return f, rest, tracks

    def test_every_kind_of_track(self):
        rng = random.Random(11)
        for round in range(4):
            f, rest, tracks = self.random_file(rng, 12)
            self.write(f"r{round}.glb", f.glb())
            if round == 0:
                self.start()
            self.c.call("actor.add", actor=f"r{round}", asset=f"r{round}.glb")
            times = [rng.uniform(0, 4.2) for _ in range(12)] + [t for track in list(tracks.values())[:3] for t in track[0]]
            for time in times:
                got = self.c.call("pose.sample", actor=f"r{round}", clip="all", time=time)["joints"]
                end = max(t[0][-1] for t in tracks.values())
                for joint in got:
                    number = int(joint["name"][1:])
                    for path in ("translation", "rotation", "scale"):
                        want = rest[number][path]
                        if (number, path) in tracks:
                            t, values, width, mode = tracks[number, path]
                            want = sample(t, values, width, mode, path == "rotation", min(time, end))
                        have = joint[path]
                        if path == "rotation" and sum(a * b for a, b in zip(have, want)) < 0:
                            have = [-x for x in have]
                        self.near(have, want, 2e-5)

    def test_normalized_rotations_and_weights(self):
        f = arm()
        f.animation("packed", (2, "rotation", "LINEAR", [0, 1], [0, 0, 0, 127, 0, 0, 90, 90], 5120))
        self.write("a.glb", f.glb())
        self.start()
        self.c.call("actor.add", actor="a", asset="a.glb")
        got = self.c.call("pose.sample", clip="packed", time=0.5)["joints"][2]["rotation"]
        self.near(got, about_z(math.pi / 4), 1e-5)


class Refusals(GltfTestCase):
    def bad(self, name, *words):
        with self.unchanged():
            error = self.refused(-32005, "actor.add", path="params.asset", actor="bad", asset=name)
        for word in (name, *words):
            self.assertIn(word, error.message)

    def test_malformed_files(self):
        whole = arm().glb()
        self.write("cut.glb", whole[:len(whole) // 2])
        damaged = arm()
        damaged.json["accessors"][0]["count"] = 1_000_000_000
        self.write("overrun.glb", damaged.glb())
        damaged = arm()
        damaged.json["nodes"][2]["children"] = [0]
        damaged.json["nodes"][0].pop("children")
        damaged.json["nodes"][1]["children"] = [2]
        damaged.json["nodes"][0]["children"] = [1]
        self.write("cycle.glb", damaged.glb())
        damaged = arm()
        damaged.json["extensionsRequired"] = ["KHR_draco_mesh_compression"]
        self.write("draco.glb", damaged.glb())
        self.write("deep.gltf", b"[" * 1_000_000)
        self.write("nul.gltf", arm().gltf() + b"\0")
        self.start()
        self.c.call("actor.add", actor="tri", mesh=harness.TRIANGLE)
        before = self.server.rss_mib()
        self.bad("cut.glb", "cut short")
        self.bad("overrun.glb", "/accessors/0/count", "found 1000000000")
        self.bad("cycle.glb", "above itself")
        self.bad("draco.glb", "/extensionsRequired/0", "KHR_draco_mesh_compression")
        self.bad("deep.gltf", "nested")
        self.bad("nul.gltf", "NUL")
        self.grew_less(before, 64)

    def test_uris_that_leave(self):
        outside = self.folder()
        with open(os.path.join(outside, "arm.bin"), "wb") as f:
            f.write(arm().blob)
        uris = [os.path.join(outside, "arm.bin"), "../" + os.path.basename(outside) + "/arm.bin",
                "%2E%2E/" + os.path.basename(outside) + "/arm.bin", "file://" + outside + "/arm.bin",
                "http://127.0.0.1:9/arm.bin", "link.bin"]
        os.symlink(os.path.join(outside, "arm.bin"), os.path.join(self.root, "link.bin"))
        for i, uri in enumerate(uris):
            self.write(f"u{i}.gltf", arm().gltf(uri))
        self.start()
        self.c.call("actor.add", actor="tri", mesh=harness.TRIANGLE)
        for i in range(len(uris)):
            self.bad(f"u{i}.gltf", "/buffers/0/uri")


class Programs(GltfTestCase):
    def test_inspect_tells_what_a_file_holds(self):
        shown = run_program("inspect", self.write("arm.glb", arm().glb()))
        self.assertEqual(shown.returncode, 0, shown.stderr)
        for line in ("glTF 2.0", "3 joints", "    elbow", "6 vertices, 4 triangles", "2 matrices, 4 influences",
                     "bend: 1.000 s, 2 keyframes"):
            self.assertIn(line, shown.stdout)
        self.assertEqual(shown.stderr, "")

    def test_inspect_tells_what_is_wrong(self):
        damaged = arm()
        damaged.json["nodes"][0]["mesh"] = 4
        shown = run_program("inspect", self.write("bad.glb", damaged.glb()))
        self.assertEqual((shown.returncode, shown.stdout), (1, ""))
        self.assertIn('"bad.glb" /nodes/0/mesh: expected the index of one of 1 meshes, found 4', shown.stderr)
        self.assertEqual(run_program("inspect", os.path.join(self.root, "none.glb")).returncode, 1)
        self.assertEqual(run_program("inspect").returncode, 2)

    def test_inspect_takes_obj_files_and_sequences(self):
        harness.write_sequence(self.root, "wave", {0: harness.lifted(0), 12: harness.lifted(1)})
        shown = run_program("inspect", os.path.join(self.root, "wave"))
        self.assertEqual(shown.returncode, 0, shown.stderr)
        self.assertIn("default: 0.500 s, 2 keyframes of vertices", shown.stdout)

    @unittest.skipUnless(run_program("doctor").returncode == 0, "nothing draws here")
    def test_render_shows_the_clip_that_is_asked_for(self):
        path = self.write("arm.glb", arm().glb())
        pictures = {}
        for clip in ("bend", "still"):
            out = os.path.join(self.root, clip + ".png")
            done = run_program("render", path, "--clip", clip, "--at", 1, "--size", "64x48", "-o", out)
            self.assertEqual(done.returncode, 0, done.stderr)
            with open(out, "rb") as f:
                pictures[clip] = f.read()
        self.assertNotEqual(pictures["bend"], pictures["still"])
        refused = run_program("render", path, "--clip", "none", "-o", os.path.join(self.root, "x.png"))
        self.assertEqual(refused.returncode, 1)
        self.assertIn("none", refused.stderr)


if __name__ == "__main__":
    harness.main()
