"""Keyframes and clips (sections 5.1 and 5.3)."""
import base64
import random
import re
import struct

import harness
from harness import TRIANGLE, f32, lifted


class Keyframes(harness.TestCase):
    def keys(self, **kw):
        return [(k["keyframe"], k["time"]) for k in self.c.call("keyframe.list", **kw)["keyframes"]]

    def test_adding(self):
        self.add_triangle()
        first = self.c.call("keyframe.add", vertices={"positions": lifted(1)})
        self.assertEqual((first["index"], first["time"], first["revision"]), (0, 0, 2), "the first one stands at 0")
        second = self.c.call("keyframe.add", vertices={"positions": lifted(2)})
        self.assertEqual((second["index"], second["time"]), (1, 1), "then one second after the last")
        between = self.c.call("keyframe.add", time=0.25, vertices={"positions": lifted(3)})
        self.assertEqual((between["index"], between["time"]), (1, 0.25))
        self.assertEqual(self.c.call("keyframe.add", vertices={"positions": lifted(2)})["time"], 2)
        self.assertEqual(len({k for k, _ in self.keys()}), 4)

    def test_a_clip_that_begins_late_shows_its_first_keyframe_before(self):
        self.add_triangle()
        self.add_key(5, time=2)
        self.add_key(7, time=3)
        self.assertEqual(self.c.call("vertices.sample", time=1)["positions"], lifted(5))
        self.assertEqual(self.c.call("keyframe.list")["duration"], 3)

    def test_two_keyframes_are_never_within_a_microsecond(self):
        self.add_triangle()
        first = self.add_key(0, time=1)
        second = self.add_key(1, time=2)
        with self.unchanged():
            for t in (1, 1 + 5e-7, 1 - 5e-7, 2):
                self.refused(-32002, "keyframe.add", time=t, vertices={"positions": lifted(1)})
            self.refused(-32002, "keyframe.move", keyframe=first, time=2 - 5e-7)
            self.refused(-32002, "keyframe.update", keyframe=second, time=1)
        self.add_key(3, time=1 + 2e-6)
        self.c.call("keyframe.move", keyframe=first, time=1 - 5e-7)

    def test_wrong_counts_name_both(self):
        self.add_moving()
        with self.unchanged():
            for vertices, path in (({"positions": [0] * 21}, "positions"), ({"positions": []}, "positions"), ({"positions": [0] * 8}, "positions"),
                                   ({"positions": lifted(1), "normals": [0, 0, 1]}, "normals")):
                error = self.refused(-32602, "keyframe.add", vertices=vertices, path="params.vertices." + path)
                found = {int(n) for n in re.findall(r"\d+", error.message)}
                count = len(vertices[path])
                self.assertTrue({3, count // 3} <= found or {9, count} <= found, error.message)
            packed = base64.b64encode(struct.pack("<6f", *range(6))).decode()
            self.refused(-32602, "keyframe.add", vertices={"positions_base64": packed}, path="params.vertices.positions_base64")

    def test_base64(self):
        self.add_triangle()
        rng = random.Random(5)
        for _ in range(3):
            values = f32([rng.uniform(-100, 100) for _ in range(9)])
            packed = base64.b64encode(struct.pack("<9f", *values)).decode()
            key = self.c.call("keyframe.add", vertices={"positions_base64": packed})
            self.assertEqual(f32(self.c.call("vertices.sample", time=key["time"])["positions"]), values)
        normals = base64.b64encode(struct.pack("<9f", 1, 0, 0, 0, 1, 0, 0, 0, 1)).decode()
        key = self.c.call("keyframe.add", vertices={"positions": lifted(1), "normals_base64": normals})
        self.assertEqual(self.c.call("vertices.sample", time=key["time"])["normals"], [1, 0, 0, 0, 1, 0, 0, 0, 1])

    def test_bad_vertices(self):
        self.add_moving()
        nan = base64.b64encode(struct.pack("<9f", *[0] * 8, float("nan"))).decode()
        infinite = base64.b64encode(struct.pack("<9f", *[0] * 8, float("inf"))).decode()
        good = base64.b64encode(struct.pack("<9f", *[0] * 9)).decode()
        with self.unchanged():
            for vertices in ({}, {"positions": lifted(1), "positions_base64": good}, {"normals": lifted(1)}, {"positions": "x"},
                             {"positions": [0] * 8 + [1e39]}, {"positions": [0] * 8 + [None]}, {"positions": [0] * 8 + ["1"]},
                             {"positions_base64": nan}, {"positions_base64": infinite}, {"positions_base64": "!!!!"},
                             {"positions_base64": good[:-1]}, {"positions_base64": good + "AAA="}, {"positions_base64": 1},
                             {"positions": lifted(1), "normals": lifted(1), "normals_base64": good}, {"points": lifted(1)},
                             {"positions": [True] * 9}):
                error = self.refused(-32602, "keyframe.add", vertices=vertices)
                self.assertTrue(error.path.startswith("params.vertices"), f"{vertices}: {error}")
        self.c.send_raw(b'{"jsonrpc":"2.0","id":1,"method":"keyframe.add","params":{"vertices":{"positions":[0,0,0,0,0,0,0,0,1e999]}}}\n')
        self.assertIn(self.c.read()["error"]["code"], (-32602, -32700))

    def test_bad_times(self):
        self.add_moving()
        with self.unchanged():
            for time in (-1, -1e-9, "1", None, [1], True):
                self.refused(-32602, "keyframe.add", path="params.time", time=time, vertices={"positions": lifted(1)})
                self.refused(-32602, "keyframe.move", path="params.time", time=time, keyframe=1)

    def test_what_a_keyframe_is_made_of(self):
        self.add_moving()
        with self.unchanged():
            self.refused(-32602, "keyframe.add")
            self.refused(-32602, "keyframe.add", time=5)
            self.refused(-32602, "keyframe.add", capture=False)
            self.refused(-32602, "keyframe.add", capture=True, vertices={"positions": lifted(1)})
            self.refused(-32602, "keyframe.update", keyframe=1, capture=True, vertices={"positions": lifted(1)})
            self.refused(-32001, "keyframe.add", path="params.clip", clip="none", vertices={"positions": lifted(1)})

    def test_easing(self):
        self.add_moving()
        key = self.add_key(9, time=3, easing=[0.42, 0, 0.58, 1], interpolation="linear")
        self.add_key(0, time=4)
        listed = self.c.call("keyframe.list")["keyframes"]
        self.assertEqual([k.get("easing") for k in listed], [None, None, None, [0.42, 0, 0.58, 1], None])
        self.assertAlmostEqual(self.c.call("vertices.sample", time=3.5)["positions"][2], 4.5, places=4)
        # ease-in-out at a quarter: CSS's cubic-bezier(.42, 0, .58, 1) gives 0.12916
        self.assertAlmostEqual(self.c.call("vertices.sample", time=3.25)["positions"][2], 9 * (1 - 0.12916), places=3)
        with self.unchanged():
            for easing in ([1, 2, 3], [-0.1, 0, 1, 1], [0, 0, 1.1, 1], [0, 0, 1, "x"], "ease"):
                error = self.refused(-32602, "keyframe.update", keyframe=key, easing=easing)
                self.assertTrue(error.path.startswith("params.easing"), error)
        self.c.call("keyframe.update", keyframe=key, easing=None)
        self.assertAlmostEqual(self.c.call("vertices.sample", time=3.25)["positions"][2], 9 * 0.75, places=4)

    def test_update_changes_only_what_is_named(self):
        keys = self.add_moving()
        self.c.call("keyframe.update", keyframe=keys[1], vertices={"positions": lifted(7)})
        self.assertEqual([self.c.call("vertices.sample", time=t)["positions"][2] for t in range(3)], [0, 7, 4])
        self.c.call("keyframe.update", keyframe=keys[1], time=1.5, interpolation="step")
        self.assertEqual(self.keys(), [(keys[0], 0), (keys[1], 1.5), (keys[2], 2)])
        self.assertEqual(self.c.call("vertices.sample", time=1.5)["positions"][2], 7)
        self.assertEqual([k["interpolation"] for k in self.c.call("keyframe.list")["keyframes"]], ["linear", "step", "linear"])

    def test_moving_over_others(self):
        keys = self.add_moving()
        self.c.call("keyframe.move", keyframe=keys[0], time=5)
        self.assertEqual(self.keys(), [(keys[1], 1), (keys[2], 2), (keys[0], 5)])
        self.assertEqual([self.c.call("vertices.sample", time=t)["positions"][2] for t in (1, 2, 5)], [1, 4, 0])

    def test_ids_are_never_used_again(self):
        keys = self.add_moving()
        self.c.call("keyframe.remove", keyframe=keys[2])
        self.assertNotIn(self.add_key(1), keys)
        self.c.call("edit.undo")
        self.c.call("edit.undo")
        self.assertEqual(self.keys(), list(zip(keys, (0, 1, 2))))
        self.assertNotIn(self.add_key(1), keys)
        for method, params in (("remove", {}), ("move", {"time": 9}), ("update", {"time": 9})):
            self.refused(-32001, f"keyframe.{method}", path="params.keyframe", keyframe=12345, **params)
        self.refused(-32602, "keyframe.remove", path="params.keyframe", keyframe=1.5)

    def test_capture_records_what_is_shown_at_this_moment(self):
        self.add_moving()
        self.c.call("playback.seek", time=1.5)
        shown = self.c.call("vertices.sample")
        key = self.c.call("keyframe.add", time=3, capture=True)
        captured = self.c.call("vertices.sample", time=3)
        self.assertEqual(captured["positions"], shown["positions"])
        self.near(captured["normals"], shown["normals"], 1e-6)
        self.c.call("playback.seek", time=0.5)
        self.c.call("keyframe.update", keyframe=key["keyframe"], capture=True)
        self.assertEqual(self.c.call("vertices.sample", time=3)["positions"][2], 0.5)

    def test_capture_while_playing(self):
        self.add_moving(keys=2)  # height = time
        self.c.call("clip.create", clip="taken")
        before = self.c.call("playback.play", loop="once", speed=0.25)
        self.c.call("keyframe.add", clip="taken", capture=True)
        after = self.c.call("playback.get")
        height = self.c.call("vertices.sample", clip="taken", time=0)["positions"][2]
        self.assertTrue(before["players"][0]["time"] - 1e-6 <= height <= after["players"][0]["time"] + 1e-6, height)

    def test_random_edits_against_a_model(self):
        """keyframe.list after each edit, and what is sampled, are those of a sorted list kept here."""
        seed = random.randrange(1 << 30)
        rng = random.Random(seed)
        self.add_triangle()
        model, history, undone = {}, [], []  # id -> (time, height, interpolation)
        new_id = 1
        for step in range(150):
            kind = rng.choice(("add", "add", "add", "update", "move", "remove", "undo", "redo"))
            before = dict(model)
            t, height = rng.randrange(100) / 8, rng.randrange(1000) / 8
            mode = rng.choice(("step", "linear", None))
            taken = {time: k for k, (time, _, _) in model.items()}
            if kind == "undo":
                if not history:
                    continue  # what is left made the actor
                self.c.call("edit.undo")
                undone.append(model)
                model = history.pop()
            elif kind == "redo":
                if not undone:
                    self.refused(-32001, "edit.redo")
                    continue
                self.c.call("edit.redo")
                history.append(model)
                model = undone.pop()
            else:
                key = rng.choice(list(model)) if model else 999
                params = {"add": {"time": t, "vertices": {"positions": lifted(height)}} | ({"interpolation": mode} if mode else {}),
                          "update": {"keyframe": key, "vertices": {"positions": lifted(height)}, "interpolation": mode},
                          "move": {"keyframe": key, "time": t}, "remove": {"keyframe": key}}[kind]
                if kind == "add" and t in taken or kind == "move" and taken.get(t, key) != key and model:
                    self.refused(-32002, f"keyframe.{kind}", **params)
                    continue
                if kind != "add" and not model:
                    self.refused(-32001, f"keyframe.{kind}", **params)
                    continue
                answer = self.c.call(f"keyframe.{kind}", **params)
                if kind == "add":
                    self.assertGreaterEqual(answer["keyframe"], new_id, f"seed {seed}")
                    new_id = answer["keyframe"] + 1
                    model[answer["keyframe"]] = (t, height, mode)
                elif kind == "update":
                    model[key] = (model[key][0], height, mode)
                elif kind == "move":
                    model[key] = (t, *model[key][1:])
                else:
                    del model[key]
                history.append(before)
                undone = []
            want = sorted((time, key, mode or "linear") for key, (time, _, mode) in model.items())
            listed = self.c.call("keyframe.list")
            self.assertEqual([(k["time"], k["keyframe"], k["interpolation"]) for k in listed["keyframes"]], want, f"seed {seed}, step {step}")
            self.assertEqual(listed["duration"], want[-1][0] if want else 0)
            if len(want) > 1:
                i = rng.randrange(len(want) - 1)
                (t0, k0, mode), (t1, k1, _) = want[i:i + 2]
                u = rng.randrange(1, 8) / 8
                h0, h1 = model[k0][1], model[k1][1]
                height = self.c.call("vertices.sample", time=t0 + (t1 - t0) * u)["positions"][2]
                self.assertAlmostEqual(height, h0 if mode == "step" else h0 + (h1 - h0) * u, delta=1e-3, msg=f"seed {seed}, step {step}")


class Clips(harness.TestCase):
    def clip(self, name="default"):
        return next(c for c in self.c.call("scene.describe")["actors"][0]["clips"] if c["clip"] == name)

    def height(self, t, clip):
        return self.c.call("vertices.sample", clip=clip, time=t)["positions"][2]

    def test_an_empty_clip_shows_the_rest_of_the_mesh(self):
        self.add_triangle()
        self.assertEqual((self.clip()["type"], self.clip()["keyframes"], self.clip()["duration"]), (None, 0, 0))
        self.assertEqual(self.c.call("vertices.sample", time=3), self.c.call("vertices.sample"))
        self.assertEqual(self.c.call("vertices.sample")["positions"], TRIANGLE["positions"])
        self.add_key(1)
        self.assertEqual(self.clip()["type"], "vertex", "its first keyframe says what it is")

    def test_cues(self):
        keys = self.add_moving(keys=4)  # heights 0 1 4 9
        self.c.call("clip.create", clip="cue", keys=[keys[3], keys[0], keys[3], keys[1]], duration=6)
        self.assertEqual((self.clip("cue")["keyframes"], self.clip("cue")["duration"]), (4, 6))
        self.assertEqual([k["time"] for k in self.c.call("keyframe.list", clip="cue")["keyframes"]], [0, 2, 4, 6])
        self.assertEqual([self.height(t, "cue") for t in (0, 2, 4, 6, 1)], [9, 0, 9, 1, 4.5])
        ids = [k["keyframe"] for k in self.c.call("keyframe.list", clip="cue")["keyframes"]]
        self.assertFalse(set(ids) & set(keys), "ids are unique in the actor")
        self.c.call("keyframe.update", keyframe=keys[3], vertices={"positions": lifted(0)})
        self.assertEqual(self.height(0, "cue"), 9, "a cue's keyframes are its own")

    def test_a_closed_cue_leaves_a_spacing_to_blend_back(self):
        keys = self.add_moving(keys=3)
        self.c.call("clip.create", clip="cue", keys=keys[::-1], duration=6, closed=True)
        self.assertEqual([k["time"] for k in self.c.call("keyframe.list", clip="cue")["keyframes"]], [0, 2, 4])
        self.assertEqual((self.clip("cue")["duration"], self.clip("cue")["closed"]), (6, True))
        self.assertEqual([self.height(t, "cue") for t in (0, 2, 4, 5, 6)], [4, 1, 0, 2, 4])

    def test_bad_cues(self):
        keys = self.add_moving()
        self.c.call("actor.add", actor="other", mesh=TRIANGLE)
        with self.unchanged():
            self.refused(-32001, "clip.create", path="params.keys[1]", actor="tri", clip="cue", keys=[keys[0], 999])
            self.refused(-32001, "clip.create", path="params.keys[0]", actor="other", clip="cue", keys=[keys[0]])
            self.refused(-32602, "clip.create", path="params.duration", actor="tri", clip="cue", keys=keys, duration=0)
            self.refused(-32602, "clip.create", actor="tri", clip="cue", keys="all")
            self.refused(-32002, "clip.create", path="params.clip", actor="tri", clip="default", keys=keys)
            self.refused(-32602, "clip.create", path="params.clip", actor="tri", clip="a b")
            self.refused(-32602, "clip.create", path="params.type", actor="tri", clip="cue", type="sparse")

    def test_closed_clips_and_durations(self):
        self.add_moving()
        self.c.call("clip.update", clip="default", closed=True)
        self.assertEqual((self.clip()["duration"], self.clip()["closed"]), (3, True), "one mean spacing after the last key")
        self.assertEqual(self.height(2.5, "default"), 2)
        self.c.call("clip.update", clip="default", duration=4)
        self.assertEqual(self.height(3, "default"), 2)
        self.assertEqual(self.c.call("keyframe.list")["closed"], True)
        with self.unchanged():
            for duration in (2, 1, 0, -1, "x"):
                self.refused(-32602, "clip.update", path="params.duration", clip="default", duration=duration)
            self.refused(-32602, "keyframe.add", time=5, vertices={"positions": lifted(1)})
            self.refused(-32602, "keyframe.add", time=4, vertices={"positions": lifted(1)})
            key = self.c.call("keyframe.list")["keyframes"][0]["keyframe"]
            self.refused(-32602, "keyframe.move", keyframe=key, time=4.5)
        self.c.call("clip.update", clip="default", duration=None)
        self.assertEqual(self.clip()["duration"], 3)
        self.c.call("clip.update", clip="default", closed=False)
        self.assertEqual(self.clip()["duration"], 2)

    def test_an_open_clip_may_be_longer_than_its_keyframes(self):
        self.add_moving()
        self.c.call("clip.update", clip="default", duration=2)
        self.c.call("clip.update", clip="default", duration=5)
        self.assertEqual((self.clip()["duration"], self.height(4, "default")), (5, 4))
        with self.unchanged():
            self.refused(-32602, "clip.update", path="params.duration", clip="default", duration=1.5)

    def test_mean_spacing_of_uneven_keys(self):
        self.add_triangle(closed=True)
        for t in (0, 1, 4):
            self.add_key(t, time=t)
        self.assertEqual(self.clip()["duration"], 6)

    def test_a_clip_that_is_played_may_be_removed(self):
        self.add_moving()
        self.c.call("clip.create", clip="other", keys=[2, 3])
        self.c.call("playback.play", clip="other")
        self.c.call("clip.remove", clip="other")
        player = self.player()
        self.assertEqual((player["clip"], player["duration"], player["playing"], player["time"]), ("default", 2, False, 0))
        self.c.call("vertices.sample")
        with self.unchanged():
            self.refused(-32001, "clip.remove", path="params.clip", clip="other")

    def test_the_only_clip_stays(self):
        """An actor always has one: its player has to be on something."""
        self.add_triangle()
        with self.unchanged():
            self.refused(-32602, "clip.remove", path="params.clip", clip="default")

    def test_methods_work_on_the_players_clip_if_none_is_named(self):
        self.add_moving()
        self.c.call("clip.create", clip="other")
        self.c.call("playback.play", clip="other")
        self.add_key(5)
        self.assertEqual(self.clip("other")["keyframes"], 1)
        self.assertEqual(len(self.c.call("keyframe.list")["keyframes"]), 1)
        self.assertEqual(len(self.c.call("keyframe.list", clip="default")["keyframes"]), 3)
        self.assertEqual(self.c.call("vertices.sample", time=0)["positions"], lifted(5))

    def test_a_keyframes_id_is_enough_to_find_it(self):
        keys = self.add_moving()
        self.c.call("clip.create", clip="other")
        self.c.call("playback.play", clip="other")
        self.c.call("keyframe.move", keyframe=keys[2], time=4)
        self.assertEqual(self.clip()["duration"], 4)
        self.refused(-32001, "keyframe.remove", path="params.keyframe", clip="other", keyframe=keys[2])
        self.c.call("keyframe.remove", keyframe=keys[2])
        self.assertEqual(self.clip()["keyframes"], 2)


if __name__ == "__main__":
    harness.main()
