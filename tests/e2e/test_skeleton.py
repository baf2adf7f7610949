"""Skeletal clips made live (sections 5 and 5.1): skeletons, poses as keyframes, live poses, pose.sample, the pose stream."""
import math
import random
import struct

import harness
from client import KEY, LAST, Packet

JOINTS = [{"name": "hand", "parent": "arm", "translation": [0, 2, 0]},
          {"name": "arm", "parent": "root", "translation": [0, 1, 0]},
          {"name": "root"},
          {"name": "Schwänzchen mit Leerzeichen", "translation": [5, 0, 0]}]
CLOSE = 1e-5


def about_z(angle):
    return [0.0, 0.0, math.sin(angle / 2), math.cos(angle / 2)]


def angle_of(q):
    return 2 * math.atan2(q[2], q[3])


class SkeletonCase(harness.TestCase):
    def setUp(self):
        super().setUp()
        self.c.call("actor.add", actor="rig", skeleton={"joints": JOINTS})

    def key(self, angle, **kw):
        return self.c.call("keyframe.add", pose={"arm": {"rotation": about_z(angle)}}, **kw)["keyframe"]

    def sample(self, **kw):
        return {j["name"]: j for j in self.c.call("pose.sample", **kw)["joints"]}

    def arm(self, **kw):
        return angle_of(self.sample(**kw)["arm"]["rotation"])

    def close(self, a, b, tolerance=CLOSE):
        self.assertEqual(len(a), len(b))
        self.assertLess(max((abs(x - y) for x, y in zip(a, b)), default=0), tolerance, (a, b))


class Skeletons(SkeletonCase):
    def test_joints_keep_their_order_and_names(self):
        described = self.c.call("scene.describe")["actors"][0]
        self.assertEqual([j["name"] for j in described["joints"]], [j["name"] for j in JOINTS])
        self.assertEqual([j.get("parent") for j in described["joints"]], ["arm", "root", None, None])
        self.assertEqual((described["vertices"], described["triangles"], described["source"]), (0, 0, "skeleton"))
        self.assertEqual([(c["clip"], c["keyframes"], c["type"]) for c in described["clips"]], [("default", 0, None)])

    def test_a_chain_follows_its_parents_whatever_the_order(self):
        self.c.call("keyframe.add", pose={"root": {"translation": [1, 0, 0], "scale": [2, 2, 2]}, "arm": {"rotation": about_z(math.pi / 2)}})
        matrices = self.sample(time=0, space="model")
        self.close(matrices["arm"]["matrix"][12:15], [1, 2, 0])
        self.close(matrices["hand"]["matrix"][12:15], [1 - 4, 2, 0])
        self.close(matrices["hand"]["matrix"], [0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, -3, 2, 0, 1])
        self.assertNotIn("translation", matrices["hand"])

    def test_mistakes(self):
        def refused(joints, path, code=-32602):
            self.refused(code, "actor.add", actor="x", skeleton={"joints": joints}, path="params.skeleton." + path)
        with self.unchanged():
            refused([], "joints")
            refused([{"name": "a"}, {"name": "b", "parent": "c"}], "joints[1].parent")
            refused([{"name": "a"}, {"name": "a"}], "joints[1].name")
            refused([{"name": "a", "parent": "a"}], "joints[0].parent")
            refused([{"name": ""}], "joints[0].name")
            refused([{"name": "a", "rotation": [0, 0, 0, 0]}], "joints[0].rotation")
            refused([{"name": "a", "translation": [0, 0]}], "joints[0].translation")
            refused([{"name": "a", "twist": 1}], "joints[0].twist")
            refused([{"name": f"j{i}"} for i in range(4097)], "joints", -32004)
            self.refused(-32602, "actor.add", actor="x", skeleton={"joints": JOINTS}, mesh=harness.TRIANGLE)
            self.refused(-32602, "actor.add", actor="x", skeleton={"joints": JOINTS}, fps=5, path="params.fps")

    def test_what_needs_a_mesh_says_so(self):
        self.refused(-32602, "vertices.sample", path="params.actor")
        self.refused(-32602, "stream.open", kind="vertices", path="params.actor")
        self.refused(-32602, "keyframe.add", vertices={"positions": [0, 0, 0]}, path="params.vertices")
        self.refused(-32602, "clip.create", clip="v", type="vertex", path="params.type")
        self.add_triangle(actor="flat")
        self.refused(-32602, "keyframe.add", actor="flat", pose={}, path="params.pose")
        self.refused(-32602, "stream.open", kind="pose", actor="flat", path="params.actor")
        self.refused(-32602, "clip.create", actor="flat", clip="s", type="skeletal", path="params.type")
        self.assertEqual(self.c.call("pose.sample", actor="flat")["joints"], [])


class Keys(SkeletonCase):
    def test_every_joint_is_keyed_unless_sparse(self):
        names = [j["name"] for j in JOINTS]
        self.key(0)
        self.c.call("keyframe.add", pose={"arm": {"rotation": about_z(1)}, "hand": {}}, sparse=True)
        listed = self.c.call("keyframe.list")["keyframes"]
        self.assertEqual([k["joints"] for k in listed], [names, ["arm"]])

    def test_sparse_keys_leave_other_tracks_alone(self):
        self.c.call("keyframe.add", time=0, pose={"arm": {"rotation": about_z(0)}, "hand": {"translation": [0, 0, 0]}})
        self.key(1, time=1, sparse=True)
        self.c.call("keyframe.add", time=4, pose={"hand": {"translation": [4, 0, 0]}}, sparse=True)
        for t in (0.5, 1, 2, 3.5, 4):
            at = self.sample(time=t)
            self.assertAlmostEqual(at["hand"]["translation"][0], t, delta=CLOSE)
            self.assertAlmostEqual(angle_of(at["arm"]["rotation"]), min(t, 1), delta=CLOSE)

    def test_what_is_not_named_is_keyed_as_shown(self):
        self.c.call("keyframe.add", time=0, pose={"hand": {"translation": [0, 0, 0]}})
        self.c.call("keyframe.add", time=2, pose={"hand": {"translation": [2, 0, 0]}})
        self.key(1, time=1)
        self.c.call("keyframe.add", time=0.5, pose={"hand": {"scale": [2, 2, 2]}})
        at = self.sample(time=0.5)["hand"]
        self.close(at["translation"], [0.5, 0, 0])
        self.close(at["scale"], [2, 2, 2])
        self.assertEqual(self.sample(time=0)["Schwänzchen mit Leerzeichen"]["translation"], [5, 0, 0], "at rest where nothing is keyed")

    def test_rotations_are_normalised(self):
        self.c.call("keyframe.add", pose={"arm": {"rotation": [0, 0, 3, 4]}})
        self.close(self.sample(time=0)["arm"]["rotation"], [0, 0, 0.6, 0.8])

    def test_cubic_with_tangents(self):
        a, b, out, into = 1.0, 4.0, 2.0, -3.0
        self.c.call("keyframe.add", time=1, interpolation="cubic", pose={"root": {"translation": [a, 0, 0], "translation_out_tangent": [out, 0, 0]}})
        self.c.call("keyframe.add", time=3, interpolation="cubic", pose={"root": {"translation": [b, 0, 0], "translation_in_tangent": [into, 0, 0]}})
        for u in (0, 0.1, 0.5, 0.77, 1):
            want = ((2 * u**3 - 3 * u**2 + 1) * a + 2 * (u**3 - 2 * u**2 + u) * out + (3 * u**2 - 2 * u**3) * b + 2 * (u**3 - u**2) * into)
            self.assertAlmostEqual(self.sample(time=1 + 2 * u)["root"]["translation"][0], want, delta=CLOSE)

    def test_modes_of_clip_actor_and_keyframe(self):
        first = self.key(0, time=0)
        self.key(1, time=1)
        self.assertAlmostEqual(self.arm(time=0.25), 0.25, delta=CLOSE)
        self.c.call("clip.update", clip="default", interpolation="step")
        self.assertEqual(self.arm(time=0.25), 0)
        self.c.call("actor.update", interpolation="linear")
        self.assertAlmostEqual(self.arm(time=0.25), 0.25, delta=CLOSE)
        self.c.call("keyframe.update", keyframe=first, interpolation="step")
        self.assertEqual(self.arm(time=0.25), 0)
        self.assertEqual([k["interpolation"] for k in self.c.call("keyframe.list")["keyframes"]], ["step", "linear"])

    def test_a_closed_clip_blends_over_its_seam(self):
        for t, angle in ((0, 0), (1, 1)):
            self.key(angle, time=t)
        self.c.call("clip.update", clip="default", closed=True, duration=3)
        self.assertAlmostEqual(self.arm(time=2), 0.5, delta=CLOSE)
        self.assertAlmostEqual(self.arm(time=2.5), 0.25, delta=CLOSE)

    def test_update(self):
        first, second = self.key(0), self.key(1)
        self.c.call("keyframe.update", keyframe=second, sparse=True, pose={"hand": {"scale": [3, 3, 3]}})
        at = self.sample(time=1)
        self.assertAlmostEqual(angle_of(at["arm"]["rotation"]), 1, delta=CLOSE)
        self.close(at["hand"]["scale"], [3, 3, 3])
        self.c.call("edit.undo")
        self.close(self.sample(time=1)["hand"]["scale"], [1, 1, 1])
        self.c.call("keyframe.update", keyframe=first, time=0.5, pose={"arm": {"rotation": about_z(-1)}})
        self.assertAlmostEqual(self.arm(time=0.75), 0, delta=CLOSE)

    def test_mistakes(self):
        self.key(0)
        with self.unchanged():
            for kw, path in (({"pose": {"nobody": {}}}, "pose.nobody"), ({"pose": {"arm": {"rotation": [0, 0, 0, 0]}}}, "pose.arm.rotation"),
                             ({"pose": {"arm": {"rotation": [1, 2]}}}, "pose.arm.rotation"), ({"pose": {"arm": {"twist": 1}}}, "pose.arm.twist"),
                             ({"pose": {"arm": 5}}, "pose.arm"), ({"pose": []}, "pose"), ({"pose": {"arm": {"scale": [1, 1, None]}}}, "pose.arm.scale[2]"),
                             ({"pose": {"arm": {"rotation_in_tangent": [0, 0, 0, 1]}}}, "pose.arm.rotation_in_tangent"),
                             ({"pose": {}, "weights": [1]}, "weights"), ({"weights": [1]}, "weights"), ({"pose": {}, "capture": True}, "capture"),
                             ({"pose": {}, "vertices": {"positions": []}}, "pose"), ({"capture": True, "sparse": True}, "sparse")):
                self.refused(-32602, "keyframe.add", path="params." + path, **kw)
            self.refused(-32602, "keyframe.add", path="params.vertices")

    def test_poses_and_vertices_do_not_mix(self):
        key = self.key(0)
        self.add_triangle(actor="flat")
        flat = self.c.call("keyframe.add", actor="flat", capture=True)["keyframe"]
        self.refused(-32602, "keyframe.update", actor="flat", keyframe=flat, pose={}, path="params.pose")
        self.refused(-32602, "keyframe.update", actor="rig", keyframe=key, vertices={"positions": [0, 0, 0]}, path="params.vertices")

    def test_cues(self):
        keys = [self.key(a, actor="rig") for a in (0, 1, 2)]
        self.c.call("clip.create", clip="cue", keys=[keys[2], keys[0]], duration=2)
        self.assertAlmostEqual(self.arm(clip="cue", time=0), 2, delta=CLOSE)
        self.assertAlmostEqual(self.arm(clip="cue", time=1), 1, delta=CLOSE)


class Live(SkeletonCase):
    def test_a_live_pose_is_shown_on_top_until_cleared(self):
        self.key(0.5)
        with self.unchanged():
            self.assertEqual(self.c.call("pose.set", pose={"arm": {"rotation": about_z(1)}}), {})
            self.assertAlmostEqual(self.arm(), 1, delta=CLOSE)
            self.assertAlmostEqual(self.arm(time=0), 0.5, delta=CLOSE, msg="a time shows the clip alone")
            self.c.call("pose.set", pose={"hand": {"scale": [2, 2, 2]}})
            self.assertAlmostEqual(self.arm(), 0.5, delta=CLOSE, msg="the newest takes the place of the last")
            self.assertEqual(self.sample()["hand"]["scale"], [2, 2, 2])
            self.assertEqual(self.c.call("pose.clear"), {})
            self.assertEqual(self.sample()["hand"]["scale"], [1, 1, 1])
            self.c.call("pose.clear")

    def test_capture_takes_it(self):
        self.c.call("pose.set", pose={"arm": {"rotation": about_z(1)}})
        self.c.call("keyframe.add", capture=True)
        self.c.call("pose.clear")
        self.assertAlmostEqual(self.arm(), 1, delta=CLOSE)

    def test_it_is_streamed_at_once_and_nobody_is_told(self):
        self.key(0)
        other = self.server.line()
        other.call("events.subscribe")
        stream = self.c.call("stream.open", kind="pose")["stream"]
        self.c.packet_where(lambda p: p.flags & LAST, stream)
        for angle in (0.1, 0.2, 0.3):
            other.call("pose.set", pose={"arm": {"rotation": about_z(angle)}})
            self.c.packet_where(lambda p: abs(angle_of(p.floats()[13:17]) - angle) < CLOSE and p.flags & LAST, stream)
        other.call("server.ping")
        self.assertEqual([m for m in other.unread if not isinstance(m, Packet)], [])

    def test_mistakes(self):
        self.refused(-32602, "pose.set", pose={"nobody": {}}, path="params.pose.nobody")
        self.refused(-32602, "pose.set", path="params.pose")
        self.refused(-32001, "pose.set", actor="nobody", pose={}, path="params.actor")
        self.refused(-32001, "pose.set", scene="none", pose={}, path="params.scene")
        self.add_triangle(actor="flat")
        self.refused(-32602, "pose.set", actor="flat", pose={}, path="params.pose")
        self.refused(-32602, "pose.set", pose={}, path="params.actor")


class Stream(SkeletonCase):
    def test_layout_and_payload(self):
        rng = random.Random(4)
        pose = {j["name"]: {"translation": [rng.uniform(-9, 9) for _ in range(3)], "scale": [rng.uniform(0.1, 3) for _ in range(3)],
                            "rotation": [rng.uniform(-1, 1) for _ in range(4)]} for j in JOINTS}
        self.c.call("keyframe.add", pose=pose)
        opened = self.c.call("stream.open", kind="pose")
        layout = opened["layout"]
        self.assertEqual([(j["name"], j.get("parent")) for j in layout["joints"]], [(j["name"], j.get("parent")) for j in JOINTS])
        self.assertEqual((layout["weights"], layout["stride"]), ([], 40))
        packet = self.c.packet(opened["stream"])
        self.assertEqual((packet.kind, packet.encoding, packet.flags), (1, 0, KEY | LAST))
        sampled = self.sample()
        want = [x for j in JOINTS for part in ("translation", "rotation", "scale") for x in sampled[j["name"]][part]]
        self.assertEqual(packet.payload, struct.pack(f"<{len(want)}f", *want))

    def test_sixty_a_second_while_it_moves(self):
        self.key(0)
        self.key(1)
        stream = self.c.call("stream.open", kind="pose")["stream"]
        self.c.call("playback.play", loop="once", speed=0.01)
        self.c.packet_where(lambda p: not p.flags & LAST, stream)
        self.assertLess(self.paced([self.c.packet(stream) for _ in range(30)], 60), 1.001, "some are neighbours")
        self.c.call("playback.set", speed=10)
        last = self.c.packet_where(lambda p: p.flags & LAST and p.media_us == 1_000_000, stream)
        self.assertAlmostEqual(angle_of(last.floats()[13:17]), 1, delta=CLOSE)

    def test_mistakes(self):
        for kw in ({"width": 5}, {"camera": {"fit": True}}, {"quality": 5}, {"encoding": "jpeg"}, {"encoding": "q17"}):
            self.refused(-32602, "stream.open", kind="pose", path="params." + next(iter(kw)), **kw)


if __name__ == "__main__":
    harness.main()
