"""Scenes, actors, camera and light (sections 3 and 5)."""
import math

import harness
from harness import TRIANGLE, lifted


def distance(a, b):
    return math.dist(a, b)


class Scenes(harness.TestCase):
    def names(self):
        return sorted(s["scene"] for s in self.c.call("scene.list")["scenes"])

    def test_main_always_exists(self):
        self.assertEqual(self.names(), ["main"])
        with self.unchanged():
            self.refused(-32002, "scene.create", path="params.scene", scene="main")
            self.refused(-32602, "scene.remove", path="params.scene", scene="main")

    def test_create_and_remove(self):
        self.c.call("scene.create", scene="b")
        self.c.call("scene.create", scene="a-1.x_Y")
        self.assertEqual(self.names(), ["a-1.x_Y", "b", "main"])
        self.refused(-32002, "scene.create", path="params.scene", scene="b")
        self.c.call("scene.remove", scene="b")
        self.assertEqual(self.names(), ["a-1.x_Y", "main"])
        for method, params in (("scene.describe", {}), ("scene.remove", {}), ("scene.update", {"grid": True}), ("playback.get", {}),
                               ("playback.play", {}), ("edit.undo", {}), ("camera.set", {"fov_y": 1}), ("keyframe.list", {}),
                               ("actor.add", {"actor": "a", "mesh": TRIANGLE}), ("stream.open", {"kind": "vertices"}),
                               ("events.subscribe", {}), ("vertices.sample", {}), ("edit.apply", {"edits": [{"method": "light.set"}]})):
            self.refused(-32001, method, path="params.scene", scene="b", **params)
        self.c.call("scene.create", scene="b")
        self.refused(-32001, "edit.undo", scene="b")

    def test_names(self):
        for name in ("", ".a", "a b", "a/b", "ä", "x" * 65, "a\n", "a\0b"):
            self.refused(-32602, "scene.create", path="params.scene", scene=name)
            self.refused(-32602, "actor.add", path="params.actor", actor=name, mesh=TRIANGLE)
        self.c.call("scene.create", scene="x" * 64)
        self.add_triangle("Z.9_-")

    def test_scenes_are_independent(self):
        self.c.call("scene.create", scene="s")
        with self.unchanged("main"):
            self.add_moving(scene="s")
            self.c.call("playback.play", scene="s")
            self.c.call("camera.set", scene="s", eye=[9, 9, 9])
        with self.unchanged("main"):
            self.c.call("scene.remove", scene="s")

    def test_describe(self):
        self.add_moving()
        d = self.c.call("scene.describe")
        self.assertEqual((d["scene"], d["revision"]), ("main", 4))
        actor, = d["actors"]
        self.assertEqual((actor["actor"], actor["vertices"], actor["triangles"], actor["joints"]), ("tri", 3, 1, []))
        self.assertEqual(actor["transform"], {"translation": [0, 0, 0], "rotation": [0, 0, 0, 1], "scale": [1, 1, 1]})
        clip, = actor["clips"]
        self.assertEqual({k: clip[k] for k in ("clip", "type", "keyframes", "duration", "closed")},
                         {"clip": "default", "type": "vertex", "keyframes": 3, "duration": 2, "closed": False})
        self.assertEqual(actor["player"], {"actor": "tri", "clip": "default", "playing": False, "time": 0, "speed": 1,
                                           "loop": "repeat", "range": [0, 2], "duration": 2})
        self.assertLessEqual({"eye", "target", "up", "fov_y", "near", "far"}, set(d["camera"]))
        self.assertLessEqual({"position", "ambient", "diffuse", "specular", "shininess"}, set(d["light"]))

    def test_update(self):
        self.c.call("scene.update", background=[0.25, 0.5, 1], grid=True)
        d = self.c.call("scene.describe")
        self.assertEqual((d["background"], d["grid"]), ([0.25, 0.5, 1], True))
        self.c.call("scene.update", grid=False)
        d = self.c.call("scene.describe")
        self.assertEqual((d["background"], d["grid"]), ([0.25, 0.5, 1], False))
        for value in ([1, 2], [0, 0, 2], [0, 0, -1], [0, 0, "x"], "red"):
            error = self.refused(-32602, "scene.update", background=value)
            self.assertTrue(error.path.startswith("params.background"), error.path)

    def test_revisions_count_edits(self):
        revision = self.c.call("scene.describe")["revision"]
        for method, params in (("actor.add", {"actor": "a", "mesh": TRIANGLE}), ("keyframe.add", {"vertices": {"positions": lifted(1)}}),
                               ("actor.update", {"visible": False}), ("clip.update", {"clip": "default", "closed": True}),
                               ("camera.set", {"eye": [1, 1, 1]}), ("light.set", {"ambient": 1}), ("scene.update", {"grid": True}),
                               ("edit.undo", {}), ("edit.redo", {}), ("actor.remove", {"actor": "a"})):
            self.assertEqual(self.c.call(method, **params)["revision"], revision := revision + 1, method)
        for method in ("playback.play", "playback.seek", "scene.describe"):
            self.c.call(method, **({"time": 0} if method == "playback.seek" else {}))
        self.assertEqual(self.c.call("scene.describe")["revision"], revision)


class Actors(harness.TestCase):
    def test_add_from_a_mesh(self):
        added = self.add_triangle()
        self.assertEqual(added, {"actor": "tri", "clips": ["default"], "vertices": 3, "joints": 0, "revision": 1})
        sample = self.c.call("vertices.sample", indices=True)
        self.assertEqual((sample["count"], sample["positions"], sample["indices"]), (3, TRIANGLE["positions"], [0, 1, 2]))
        self.near(sample["normals"], [0, 0, 1] * 3)

    def test_normals_of_a_mesh_may_be_given(self):
        self.c.call("actor.add", actor="a", mesh=TRIANGLE | {"normals": [0, 0, 2, 0, 1, 0, 1, 0, 0]})
        self.near(self.c.call("vertices.sample")["normals"], [0, 0, 1, 0, 1, 0, 1, 0, 0])

    def test_order_and_names(self):
        for name in ("b", "a", "c"):
            self.add_triangle(name)
        self.refused(-32002, "actor.add", path="params.actor", actor="a", mesh=TRIANGLE)
        self.assertEqual([a["actor"] for a in self.c.call("scene.describe")["actors"]], ["b", "a", "c"])
        self.c.call("actor.remove", actor="a")
        self.refused(-32001, "actor.remove", path="params.actor", actor="a")
        self.assertEqual([a["actor"] for a in self.c.call("scene.describe")["actors"]], ["b", "c"])
        self.add_triangle("a")

    def test_bad_meshes(self):
        p, i = TRIANGLE["positions"], TRIANGLE["indices"]
        for mesh, path in (({"positions": p}, "params.mesh.indices"), ({"indices": i}, "params.mesh.positions"),
                           ({"positions": p[:8], "indices": i}, "params.mesh.positions"), ({"positions": [], "indices": []}, "params.mesh"),
                           ({"positions": p, "indices": [0, 1]}, "params.mesh.indices"),
                           ({"positions": p, "indices": [0, 1, 3]}, "params.mesh.indices"),
                           ({"positions": p, "indices": [0, 1, -1]}, "params.mesh.indices"),
                           ({"positions": p, "indices": [0, 1, 1.5]}, "params.mesh.indices"),
                           ({"positions": p, "indices": i, "normals": [0, 0, 1]}, "params.mesh.normals"),
                           ({"positions": p[:8] + ["x"], "indices": i}, "params.mesh.positions[8]"),
                           ({"positions": p[:8] + [1e39], "indices": i}, "params.mesh.positions"),
                           ({"positions": p, "indices": i, "uvs": []}, "params.mesh.uvs")):
            with self.unchanged():
                error = self.refused(-32602, "actor.add", actor="a", mesh=mesh)
                self.assertTrue(error.path.startswith(path), f"{mesh}: {error}")
        self.refused(-32602, "actor.add", actor="a")
        self.refused(-32602, "actor.add", actor="a", mesh=TRIANGLE, asset="x.obj")

    def test_an_actor_may_be_left_out_where_there_is_one(self):
        self.refused(-32001, "keyframe.list", path="params.actor")
        self.add_triangle("a")
        self.c.call("keyframe.list")
        self.c.call("actor.update", visible=False)
        self.add_triangle("b")
        for method, params in (("keyframe.list", {}), ("actor.update", {"visible": True}), ("vertices.sample", {}),
                               ("keyframe.add", {"vertices": {"positions": lifted(1)}}), ("clip.create", {"clip": "x"}),
                               ("stream.open", {"kind": "vertices"})):
            self.refused(-32602, method, path="params.actor", **params)
            self.refused(-32001, method, path="params.actor", actor="none", **params)
        self.assertEqual([p["actor"] for p in self.c.call("playback.get")["players"]], ["a", "b"])

    def test_update(self):
        self.add_triangle()
        self.c.call("actor.update", transform={"translation": [1, 2, 3], "rotation": [0, 2, 0, 0], "scale": [2, 2, 2]}, spin=0.5)
        self.c.call("actor.update", transform={"translation": [4, 5, 6]})
        actor, = self.c.call("scene.describe")["actors"]
        self.assertEqual(actor["transform"], {"translation": [4, 5, 6], "rotation": [0, 1, 0, 0], "scale": [2, 2, 2]})
        with self.unchanged():
            self.refused(-32602, "actor.update", path="params.transform.rotation", transform={"rotation": [0, 0, 0, 0]})
            self.refused(-32602, "actor.update", path="params.transform.roation", transform={"roation": [0, 0, 0, 1]})
            self.refused(-32602, "actor.update", path="params.interpolation", interpolation="smooth")
            self.refused(-32602, "actor.update", path="params.spin", spin="fast")

    def test_interpolation_null_clears_it(self):
        self.add_moving(interpolation="step")
        self.assertEqual(self.c.call("scene.describe")["actors"][0]["interpolation"], "step")
        at = lambda: self.c.call("vertices.sample", time=0.5)["positions"][2]  # noqa: E731
        self.assertEqual(at(), 0)
        self.c.call("actor.update", interpolation="linear")
        self.assertEqual(at(), 0.5)
        self.c.call("clip.update", clip="default", interpolation="step")
        self.assertEqual(at(), 0.5, "the actor's comes before the clip's")
        self.c.call("actor.update", interpolation=None)
        self.assertEqual(at(), 0)
        key = self.c.call("keyframe.list")["keyframes"][0]["keyframe"]
        self.c.call("keyframe.update", keyframe=key, interpolation="linear")
        self.assertEqual(at(), 0.5, "the keyframe's comes first")
        self.c.call("keyframe.update", keyframe=key, interpolation=None)
        self.assertEqual(at(), 0)
        self.c.call("clip.update", clip="default", interpolation=None)
        self.assertEqual(at(), 0.5, "else linear")
        self.assertIsNone(self.c.call("scene.describe")["actors"][0]["interpolation"])

    def test_model_space_is_not_moved_by_the_transform(self):
        self.add_moving()
        before = self.c.call("vertices.sample", time=1)
        self.c.call("actor.update", transform={"translation": [1, 2, 3]}, spin=3)
        self.assertEqual(self.c.call("vertices.sample", time=1), before)


class CameraAndLight(harness.TestCase):
    def test_camera_fields(self):
        camera = self.c.call("camera.set", eye=[1, 2, 3], target=[4, 5, 6], up=[0, 0, 1], fov_y=1, near=0.5, far=50)["camera"]
        self.assertEqual(camera, {"eye": [1, 2, 3], "target": [4, 5, 6], "up": [0, 0, 1], "fov_y": 1, "near": 0.5, "far": 50})
        self.assertEqual(self.c.call("scene.describe")["camera"], camera)
        self.assertEqual(self.c.call("camera.set", eye=[3, 2, 1])["camera"], camera | {"eye": [3, 2, 1]})

    def test_bad_cameras(self):
        self.c.call("camera.set", eye=[0, 0, 5], target=[0, 0, 0], up=[0, 1, 0], near=1, far=10)
        with self.unchanged():
            for params in ({"eye": [0, 0, 0]}, {"up": [0, 0, 1]}, {"up": [0, 0, 0]}, {"near": 10}, {"near": 0}, {"near": -1}, {"far": 0.5},
                           {"fov_y": 0}, {"fov_y": 3.2}, {"eye": [1, 2]}, {"eye": [1, 2, None]}, {"orbit": {}}, {"fit": 1},
                           {"orbit": {"azimuth": 0, "elevation": 0, "distance": 0}}, {"orbit": {"azimuth": 0, "elevation": 0, "roll": 1}},
                           {"eye": [1, 2, 3], "orbit": {"azimuth": 0, "elevation": 0}}):
                error = self.refused(-32602, "camera.set", **params)
                self.assertTrue(error.path.startswith("params."), f"{params}: {error}")

    def test_orbit(self):
        for azimuth, elevation in ((0, 0), (1, 0.5), (-2, -1), (3, 1.5), (7, 0)):
            camera = self.c.call("camera.set", orbit={"azimuth": azimuth, "elevation": elevation, "distance": 4, "target": [1, 2, 3]})["camera"]
            want = [1 + 4 * math.cos(elevation) * math.sin(azimuth), 2 + 4 * math.sin(elevation),
                    3 + 4 * math.cos(elevation) * math.cos(azimuth)]
            self.near(camera["eye"], want, 1e-4)
            self.assertEqual(camera["target"], [1, 2, 3])
        camera = self.c.call("camera.set", orbit={"azimuth": 0.3, "elevation": 0.1})["camera"]
        self.assertEqual(camera["target"], [1, 2, 3])
        self.assertAlmostEqual(distance(camera["eye"], camera["target"]), 4, places=4)

    def test_fit_keeps_the_direction_and_brings_all_visible_actors_into_view(self):
        self.add_moving("a", transform={"translation": [10, 0, 0]})
        self.add_triangle("b", transform={"translation": [-10, 5, 0], "scale": [3, 3, 3]})
        self.add_triangle("hidden", transform={"translation": [1000, 0, 0]})
        self.c.call("actor.update", actor="hidden", visible=False)
        self.c.call("camera.set", eye=[1, 2, 3], target=[0, 0, 0])
        camera = self.c.call("camera.set", fit=True)["camera"]
        direction = [t - e for e, t in zip(camera["eye"], camera["target"])]
        length = math.hypot(*direction)
        want = [-x / math.hypot(1, 2, 3) for x in (1, 2, 3)]
        self.near([x / length for x in direction], want, 1e-4)
        self.assertLess(length, 200, "what is hidden need not be in view")
        corners = [(10, 0, 4), (10, 0, 0), (11, 0, 0), (10, 1, 0), (-10, 5, 0), (-7, 5, 0), (-10, 8, 0)]
        for corner in corners:
            to = [c - e for c, e in zip(corner, camera["eye"])]
            depth = sum(a * b for a, b in zip(to, want))
            self.assertTrue(camera["near"] < depth < camera["far"], f"{corner} at depth {depth}: {camera}")
            self.assertLess(math.acos(min(1, depth / math.hypot(*to))), camera["fov_y"] / 2 + 1e-3, corner)

    def test_fit_to_nothing_changes_no_view(self):
        before = self.c.call("scene.describe")["camera"]
        self.assertEqual(self.c.call("camera.set", fit=True)["camera"], before)

    def test_light(self):
        light = self.c.call("light.set", position=[1, 2, 3], ambient=0.25, diffuse=0.5, specular=0.75, shininess=8)["light"]
        self.assertEqual(light, {"position": [1, 2, 3], "ambient": 0.25, "diffuse": 0.5, "specular": 0.75, "shininess": 8})
        self.assertEqual(self.c.call("light.set", diffuse=2)["light"], light | {"diffuse": 2})
        self.assertEqual(self.c.call("scene.describe")["light"], light | {"diffuse": 2})
        with self.unchanged():
            for params in ({"ambient": -1}, {"shininess": 0}, {"position": [1]}, {"diffuse": "x"}, {"colour": 1}):
                self.refused(-32602, "light.set", path="params." + next(iter(params)), **params)


if __name__ == "__main__":
    harness.main()
