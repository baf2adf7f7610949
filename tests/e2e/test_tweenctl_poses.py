"""tweenctl with skeletons: authoring poses, live poses, samples, the pose stream, and markers as they are passed."""
import json
import math
import os
import re

import harness
from test_tweenctl import Remote

SKELETON = {"joints": [{"name": "root"}, {"name": "arm", "parent": "root", "translation": [0, 1, 0]},
                       {"name": "hand", "parent": "arm", "translation": [0, 2, 0]}]}
QUARTER = [0, 0, math.sqrt(0.5), math.sqrt(0.5)]  # about +Z


class Poses(Remote):
    def setUp(self):
        super().setUp()
        self.ctl("add", "rig", "--skeleton", "-", stdin=json.dumps(SKELETON))

    def pose_file(self, pose):
        path = os.path.join(self.folder(), "pose.json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(pose, file)
        return path

    def sample(self, *arguments):
        return {joint["name"]: joint for joint in self.json("pose", "sample", *arguments)["joints"]}

    def close(self, a, b):
        self.assertEqual(len(a), len(b))
        self.assertLess(max(abs(x - y) for x, y in zip(a, b)), 1e-5, (a, b))

    def test_keyframes_of_poses(self):
        self.assertIn("keyframe", self.ctl("keyframe", "add", "--time", 0, "--pose", "{}"))
        path = self.pose_file({"arm": {"rotation": QUARTER}})
        self.ctl("keyframe", "add", "--time", 1, "--pose", "@" + path, "--sparse")
        keyframes = self.json("keyframe", "list")["keyframes"]
        self.assertEqual([k["joints"] for k in keyframes], [["root", "arm", "hand"], ["arm"]])
        self.close(self.sample("--time", 1)["arm"]["rotation"], QUARTER)
        self.close(self.sample("--time", 1, "--space", "model")["hand"]["matrix"][12:15], [-2, 1, 0])
        self.assertIn("-2, 1, 0", self.ctl("pose", "sample", "--time", 1, "--space", "model"))
        self.ctl("keyframe", "update", keyframes[1]["keyframe"], "--pose", '{"arm":{"rotation":[0,0,0,1]}}')
        self.close(self.sample("--time", 1)["arm"]["rotation"], [0, 0, 0, 1])

    def test_cubic_keys_carry_their_tangents(self):
        for time in (0, 1):
            key = {"root": {"translation": [0, 0, 0], "translation_in_tangent": [0, 0, 0], "translation_out_tangent": [4, 0, 0]}}
            self.ctl("keyframe", "add", "--time", time, "--interpolation", "cubic", "--sparse", "--pose", json.dumps(key))
        self.close(self.sample("--time", 0.5)["root"]["translation"], [0.5, 0, 0])  # a Hermite blend: 4 * (u^3 - 2u^2 + u)

    def test_a_live_pose_is_shown_captured_and_cleared(self):
        self.ctl("pose", "set", json.dumps({"arm": {"rotation": QUARTER}}))
        self.close(self.sample()["arm"]["rotation"], QUARTER)
        self.ctl("keyframe", "add", "--capture")
        self.ctl("pose", "clear")
        self.close(self.sample("--time", 0)["arm"]["rotation"], QUARTER)

    def test_a_clip_may_say_what_it_holds(self):
        self.ctl("clip", "create", "dance", "--type", "skeletal")
        self.ctl("keyframe", "add", "--clip", "dance", "--pose", "{}")
        clips = self.c.call("scene.describe")["actors"][0]["clips"]
        self.assertEqual([c["type"] for c in clips if c["clip"] == "dance"], ["skeletal"])

    def test_the_skeleton_is_shown_and_hidden(self):
        shown = lambda: self.c.call("scene.describe")["actors"][0]["show_skeleton"]
        self.ctl("actor", "update", "--show-skeleton")
        self.assertTrue(shown())
        self.ctl("actor", "update", "rig", "--hide-skeleton")
        self.assertFalse(shown())

    def test_the_stream_of_poses_is_watched(self):
        self.ctl("keyframe", "add", "--pose", '{"root":{"translation":[1,2,3]}}')
        line = self.ctl("watch", "pose", "--count", 1)
        self.assertRegex(line, r"3 joints, root at \(1, 2, 3\)")
        packet = self.json("watch", "pose", "--count", 1)
        self.assertEqual((packet["joints"], packet["weights"], packet["bytes"]), (3, 0, 120))

    def test_a_compressed_stream_shows_the_same(self):
        self.ctl("keyframe", "add", "--time", 0, "--pose", '{"root":{"translation":[1,2,3]}}')
        self.ctl("keyframe", "add", "--time", 1, "--pose", '{"root":{"translation":[5,2,3]}}')
        self.ctl("seek", 0.5)
        line = self.ctl("watch", "pose", "--encoding", "q16", "--count", 1)
        x, y, z = map(float, re.search(r"3 joints, root at \((.*), (.*), (.*)\)", line).groups())
        for found, expected in ((x, 3), (y, 2), (z, 3)):
            self.assertAlmostEqual(found, expected, delta=1e-3)
        self.ctl("play", "--loop", "repeat")
        packets = [json.loads(text) for text in
                   self.ctl("--json", "watch", "pose", "--encoding", "q16", "--delivery", "every", "--count", 30).splitlines()]
        numbers = [p["sequence"] for p in packets]
        self.assertEqual(numbers, list(range(numbers[0], numbers[0] + 30)))
        self.assertTrue(any("key" not in p["flags"] for p in packets), "most need their predecessor")

    def test_mistakes_are_told_in_a_line(self):
        self.ctl("pose", "set", "{arm}", code=2)
        self.ctl("pose", "set", "@/no/such/file", code=2)
        self.ctl("keyframe", "add", "--pose", "{}", "--capture", code=2)
        self.ctl("pose", "set", '{"leg":{}}', code=1)
        self.assertIn("leg", self.errors)
        self.ctl("keyframe", "add", "--pose", '{"arm":{"rotation":[0,0,0,0]}}', code=1)
        self.assertIn("params.pose.arm.rotation", self.errors)

    def test_markers_are_printed_as_they_are_passed(self):
        for time in (0, 1):
            self.ctl("keyframe", "add", "--time", time, "--pose", "{}")
        for time, name in ((0.25, "left"), (0.75, "right")):
            self.c.call("marker.add", time=time, name=name)
        waiting = self.start("wait", "marker", "--timeout", 30)
        self.ctl("play", "--loop", "once")
        self.assertEqual(self.output(waiting), "marker.crossed    scene main, rig default: left at 0.25 s\n")


if __name__ == "__main__":
    harness.main()
