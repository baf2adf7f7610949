"""Undo and redo, edits as one, base revisions and retry keys (sections 5 and 5.2)."""
import random

import harness
from harness import TRIANGLE, lifted

KEY = {"vertices": {"positions": lifted(5)}}


class Undo(harness.TestCase):
    def setUp(self):
        super().setUp()
        self.keys = self.add_moving()
        self.c.call("clip.create", clip="over")
        self.c.call("layer.set", layer="top", clip="over")
        self.marker = self.c.call("marker.add", time=0.5, name="here")["marker"]
        self.c.call("clip.create", clip="second", keys=self.keys[::-1])

    def edits(self):
        """Every editing method, in ways that change something."""
        k = self.keys
        return [
            ("actor.add", {"actor": "b", "mesh": TRIANGLE, "interpolation": "step"}), ("actor.remove", {"actor": "tri"}),
            ("actor.update", {"transform": {"translation": [1, 2, 3]}}), ("actor.update", {"interpolation": "catmull_rom"}),
            ("actor.update", {"visible": False, "spin": 2}), ("keyframe.add", KEY), ("keyframe.add", KEY | {"time": 0.5, "easing": [0, 0, 1, 1]}),
            ("keyframe.add", {"capture": True, "clip": "second"}), ("keyframe.update", {"keyframe": k[1], "interpolation": "step"}),
            ("keyframe.update", {"keyframe": k[1], **KEY}), ("keyframe.update", {"keyframe": k[2], "time": 7, "easing": [0, 0, 1, 1]}),
            ("keyframe.move", {"keyframe": k[0], "time": 9}), ("keyframe.remove", {"keyframe": k[1]}), ("keyframe.remove", {"keyframe": k[2]}),
            ("clip.create", {"clip": "x"}), ("clip.create", {"clip": "cue", "keys": k[:2], "duration": 5, "closed": True}),
            ("clip.update", {"clip": "default", "closed": True}), ("clip.update", {"clip": "second", "closed": True, "duration": 9}),
            ("clip.update", {"clip": "default", "interpolation": "step"}), ("clip.remove", {"clip": "second"}),
            ("clip.remove", {"clip": "default"}), ("camera.set", {"eye": [9, 8, 7]}), ("camera.set", {"fit": True}),
            ("camera.set", {"orbit": {"azimuth": 1, "elevation": 1, "distance": 3}}), ("light.set", {"ambient": 0.75, "position": [1, 1, 1]}),
            ("scene.update", {"background": [1, 0, 0], "grid": True}), ("layer.set", {"layer": "new", "clip": "over", "weight": 0.5}),
            ("layer.set", {"layer": "top", "clip": "over", "additive": True}), ("layer.remove", {"layer": "top"}),
            ("marker.add", {"time": 1, "name": "there"}), ("marker.remove", {"marker": self.marker}),
            ("edit.apply", {"edits": [{"method": "keyframe.add", "params": KEY}, {"method": "actor.remove", "params": {"actor": "tri"}},
                                      {"method": "actor.add", "params": {"actor": "tri", "mesh": TRIANGLE}},
                                      {"method": "camera.set", "params": {"fov_y": 2}}]}),
        ]

    def test_every_method_is_covered(self):
        documented = {m["name"] for m in self.c.call("rpc.discover")["methods"]
                      if {"base_revision", "retry_key"} <= {p["name"] for p in m["params"]}}
        covered = {method for method, _ in self.edits()}
        self.assertEqual(documented - {"scene.create", "scene.remove", "edit.undo", "edit.redo"}, covered)

    def test_each_edit_is_taken_back_and_done_again(self):
        for method, params in self.edits():
            with self.subTest(method=method, params=params):
                before = self.snapshot(document_only=True)
                revision = self.c.call(method, **params)["revision"]
                after = self.snapshot(document_only=True)
                self.assertNotEqual(after, before)
                for _ in range(2):
                    self.assertEqual(self.c.call("edit.undo"), {"undone": method, "revision": (revision := revision + 1)})
                    self.assertEqual(self.snapshot(document_only=True), before)
                    self.assertEqual(self.c.call("edit.redo"), {"redone": method, "revision": (revision := revision + 1)})
                    self.assertEqual(self.snapshot(document_only=True), after)
                self.c.call("edit.undo")

    def test_all_the_way_back_and_forth(self):
        rng = random.Random()
        states = [self.snapshot(document_only=True)]
        methods = []
        for method, params in rng.sample(self.edits(), 15):
            try:
                self.c.call(method, **params)
            except harness.RpcError:
                continue  # what it was about is gone
            states.append(self.snapshot(document_only=True))
            methods.append(method)
        for i in reversed(range(len(methods))):
            self.assertEqual(self.c.call("edit.undo")["undone"], methods[i])
            self.assertEqual(self.snapshot(document_only=True), states[i])
        for i, method in enumerate(methods):
            self.assertEqual(self.c.call("edit.redo")["redone"], method)
            self.assertEqual(self.snapshot(document_only=True), states[i + 1])
        self.refused(-32001, "edit.redo")

    def test_a_new_edit_forgets_what_could_be_redone(self):
        self.c.call("edit.undo")
        self.c.call("camera.set", eye=[1, 1, 1])
        with self.unchanged():
            self.refused(-32001, "edit.redo")

    def test_nothing_to_undo(self):
        self.c.call("scene.create", scene="s")
        with self.unchanged("s"):
            self.refused(-32001, "edit.undo", scene="s")
            self.refused(-32001, "edit.redo", scene="s")

    def test_refused_edits_and_playback_leave_no_step(self):
        self.refused(-32001, "actor.remove", actor="none")
        self.c.call("playback.play")
        self.c.call("playback.stop")
        self.assertEqual(self.c.call("edit.undo")["undone"], "clip.create")

    def test_history_is_of_the_scene_and_shared(self):
        other = self.server.line()
        self.c.call("scene.create", scene="s")
        self.c.call("camera.set", scene="s", eye=[1, 1, 1])
        self.assertEqual(other.call("edit.undo")["undone"], "clip.create")
        self.assertEqual(other.call("edit.undo", scene="s")["undone"], "camera.set")

    def test_a_removed_actor_comes_back_with_its_ids_and_content(self):
        sample = self.c.call("vertices.sample", time=1.5)
        self.c.call("actor.remove", actor="tri")
        self.c.call("edit.undo")
        self.assertEqual([k["keyframe"] for k in self.c.call("keyframe.list")["keyframes"]], self.keys)
        self.assertEqual(self.c.call("vertices.sample", time=1.5), sample)


class Apply(harness.TestCase):
    def setUp(self):
        super().setUp()
        self.keys = self.add_moving()

    def apply(self, *edits, **kw):
        return {"edits": [{"method": m, "params": p} for m, p in edits], **kw}

    def test_one_revision_and_one_step(self):
        before = self.snapshot(document_only=True)
        revision = self.c.call("scene.describe")["revision"]
        answer = self.c.call("edit.apply", **self.apply(("keyframe.add", KEY), ("keyframe.move", {"keyframe": self.keys[0], "time": 0.5}),
                                                        ("camera.set", {"eye": [1, 1, 1]}), ("actor.add", {"actor": "b", "mesh": TRIANGLE})))
        self.assertEqual(answer["revision"], revision + 1)
        self.assertEqual([r["revision"] for r in answer["results"]], [revision + 1] * 4)
        self.assertEqual((answer["results"][0]["index"], answer["results"][0]["time"]), (3, 3))
        self.assertEqual(answer["results"][3]["clips"], ["default"])
        self.assertEqual(self.c.call("edit.undo"), {"undone": "edit.apply", "revision": revision + 2})
        self.assertEqual(self.snapshot(document_only=True), before)

    def test_later_edits_see_the_earlier_ones(self):
        self.c.call("edit.apply", **self.apply(
            ("actor.add", {"actor": "b", "mesh": TRIANGLE}), ("keyframe.add", {"actor": "b", "time": 1, **KEY}),
            ("keyframe.add", {"actor": "b", **KEY}), ("clip.create", {"actor": "b", "clip": "c"}),
            ("keyframe.add", {"actor": "b", "clip": "c", "capture": True}), ("actor.remove", {"actor": "tri"}), ("keyframe.add", KEY)))
        self.assertEqual([k["time"] for k in self.c.call("keyframe.list")["keyframes"]], [1, 2, 3])
        self.assertEqual(len(self.c.call("keyframe.list", clip="c")["keyframes"]), 1)

    def test_all_or_nothing_and_the_path_of_what_failed(self):
        good = ("keyframe.add", KEY)
        cases = [
            (("keyframe.add", {"time": -1, **KEY}), -32602, "params.edits[1].params.time"),
            (("keyframe.add", {"time": 0, **KEY}), -32002, "params.edits[1].params.time"),
            (("keyframe.add", {"tiem": 0, **KEY}), -32602, "params.edits[1].params.tiem"),
            (("keyframe.add", {"vertices": {"positions": [0] * 21}}), -32602, "params.edits[1].params.vertices.positions"),
            (("keyframe.move", {"keyframe": 999, "time": 9}), -32001, "params.edits[1].params.keyframe"),
            (("keyframe.move", {"keyframe": 1}), -32602, "params.edits[1].params.time"),
            (("actor.remove", {"actor": "none"}), -32001, "params.edits[1].params.actor"),
            (("actor.add", {"actor": "tri", "mesh": TRIANGLE}), -32002, "params.edits[1].params.actor"),
            (("clip.create", {"clip": "cue", "keys": [1, 999]}), -32001, "params.edits[1].params.keys[1]"),
            (("no.such", {}), -32602, "params.edits[1].method"), (("playback.play", {}), -32602, "params.edits[1].method"),
            (("edit.undo", {}), -32602, "params.edits[1].method"), (("scene.create", {"scene": "s"}), -32602, "params.edits[1].method"),
            (("edit.apply", {"edits": []}), -32602, "params.edits[1].method"),
            (("camera.set", {"scene": "other"}), -32602, "params.edits[1].params.scene"),
            (("camera.set", {"base_revision": 4}), -32602, "params.edits[1].params.base_revision"),
            (("camera.set", {"retry_key": "k"}), -32602, "params.edits[1].params.retry_key"),
        ]
        for bad, code, path in cases:
            with self.subTest(bad=bad), self.unchanged():
                self.refused(code, "edit.apply", path=path, **self.apply(good, bad, good))

    def test_what_is_no_list_of_edits(self):
        with self.unchanged():
            for edits, path in (([], "params.edits"), ("x", "params.edits"), ([1], "params.edits[0]"), ([{}], "params.edits[0].method"),
                                ([{"method": 1}], "params.edits[0].method"), ([{"method": "camera.set", "x": 1}], "params.edits[0].x"),
                                ([{"method": "camera.set", "params": [1]}], "params.edits[0].params")):
                self.refused(-32602, "edit.apply", path=path, edits=edits)
            self.refused(-32602, "edit.apply", path="params.edits")

    def test_nobody_sees_half_of_it(self):
        other = self.server.line()
        for _ in range(30):
            done = self.c.send("edit.apply", **self.apply(*[("keyframe.add", KEY)] * 5))
            counts = {len(other.call("keyframe.list")["keyframes"]) for _ in range(3)}
            self.c.answer(done)
            self.assertLessEqual(counts, set(range(3, 1000, 5)))

    def test_many_edits(self):
        count = 2000
        answer = self.c.call("edit.apply", **self.apply(*[("keyframe.add", {"time": 10 + i, **KEY}) for i in range(count)]))
        self.assertEqual(len(answer["results"]), count)
        self.assertEqual(len(self.c.call("keyframe.list")["keyframes"]), count + 3)
        self.c.call("edit.undo")
        self.assertEqual(len(self.c.call("keyframe.list")["keyframes"]), 3)


class Conflicts(harness.TestCase):
    def setUp(self):
        super().setUp()
        self.add_moving()
        self.revision = self.c.call("scene.describe")["revision"]

    def test_base_revision(self):
        self.c.call("camera.set", eye=[1, 1, 1], base_revision=self.revision)
        with self.unchanged():
            for method, params in (("camera.set", {"eye": [2, 2, 2]}), ("keyframe.add", KEY), ("keyframe.remove", {"keyframe": 1}),
                                   ("edit.undo", {}), ("actor.remove", {"actor": "tri"}), ("clip.create", {"clip": "x"}),
                                   ("edit.apply", {"edits": [{"method": "light.set", "params": {"ambient": 1}}]}), ("scene.update", {})):
                error = self.refused(-32002, method, base_revision=self.revision, **params)
                self.assertEqual(error.data["revision"], self.revision + 1)
            self.refused(-32602, "camera.set", path="params.base_revision", base_revision="x")
            self.refused(-32602, "camera.set", path="params.base_revision", base_revision=-1)
        self.c.call("edit.undo", base_revision=self.revision + 1)

    def test_of_two_edits_on_the_same_base_one_wins(self):
        clients = [self.c, self.server.line(), self.server.websocket()]
        for _ in range(20):
            base = self.c.call("scene.describe")["revision"]
            sent = [(c, c.send("keyframe.add", base_revision=base, **KEY)) for c in clients]
            won = 0
            for c, id in sent:
                try:
                    self.assertEqual(c.answer(id)["revision"], base + 1)
                    won += 1
                except harness.RpcError as error:
                    self.assertEqual((error.code, error.data["revision"]), (-32002, base + 1))
            self.assertEqual(won, 1)
            self.assertEqual(self.c.call("scene.describe")["revision"], base + 1)

    def test_a_retry_key_is_carried_out_once(self):
        for method, params in (("keyframe.add", KEY), ("camera.set", {"eye": [1, 2, 3]}), ("clip.create", {"clip": "x"}), ("edit.undo", {}),
                               ("edit.apply", {"edits": [{"method": "keyframe.add", "params": KEY}]}), ("edit.redo", {})):
            if method == "edit.redo":
                self.c.call("edit.undo")
            first = self.c.call(method, retry_key="key of " + method, **params)
            with self.unchanged():
                self.assertEqual(self.c.call(method, retry_key="key of " + method, **params), first)
                self.assertEqual(self.server.line().call(method, retry_key="key of " + method, **params), first)

    def test_a_retry_key_is_of_the_scene_and_of_what_was_carried_out(self):
        self.c.call("scene.create", scene="s")
        self.refused(-32001, "keyframe.remove", keyframe=99, retry_key="k")
        first = self.c.call("camera.set", eye=[1, 2, 3], retry_key="k")
        other = self.c.call("camera.set", scene="s", eye=[1, 2, 3], retry_key="k")
        self.assertNotEqual(first["revision"], other["revision"])
        for key in ("", "x" * 65, 1, None):
            self.refused(-32602, "camera.set", path="params.retry_key", retry_key=key)
        self.c.call("camera.set", retry_key="ä" * 32)

    def test_a_repeated_request_comes_before_a_stale_base(self):
        """A client that lost the answer repeats the request as it was."""
        first = self.c.call("keyframe.add", base_revision=self.revision, retry_key="k", **KEY)
        self.assertEqual(self.c.call("keyframe.add", base_revision=self.revision, retry_key="k", **KEY), first)

    def test_the_same_key_pipelined_from_several_connections(self):
        clients = [self.server.line() for _ in range(4)]
        sent = [(c, c.send("keyframe.add", retry_key="k", **KEY)) for c in clients for _ in range(5)]
        answers = [c.answer(id) for c, id in sent]
        self.assertTrue(all(a == answers[0] for a in answers))
        self.assertEqual(len(self.c.call("keyframe.list")["keyframes"]), 4)

    def test_scenes_with_a_retry_key(self):
        self.assertEqual(self.c.call("scene.create", scene="s", retry_key="k"), self.c.call("scene.create", scene="s", retry_key="k"))
        self.assertEqual(self.c.call("scene.remove", scene="s", retry_key="r"), self.c.call("scene.remove", scene="s", retry_key="r"))


if __name__ == "__main__":
    harness.main()
