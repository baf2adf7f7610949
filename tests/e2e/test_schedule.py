"""Scheduling at a clock reading (5.2), markers, queues, fades and layers (5, 5.3)."""
import os

import harness
from harness import RpcError, wait_until

ARM = {"joints": [{"name": "root"}, {"name": "arm", "parent": "root"}, {"name": "hand", "parent": "arm"}]}


def turned(x):
    """A rotation about +X, by its sine of the half angle."""
    return {"rotation": [x, 0, 0, (1 - x * x) ** 0.5]}


class Told(harness.TestCase):
    """A moving triangle of 2 s, and who is told of it."""

    def setUp(self):
        super().setUp()
        self.keys = self.add_moving()
        self.c.call("events.subscribe")

    def now_us(self):
        return self.c.call("server.ping")["time_us"]

    def ahead(self, ask):
        """Has ask(at_us) schedule something with late="error", so far ahead that this machine is in time: the reading, and its answer."""
        lead_us = 50_000
        while True:
            at_us = self.now_us() + lead_us
            try:
                return at_us, ask(at_us)
            except RpcError as error:
                if error.path != "params.at_us" or lead_us > 60_000_000:
                    raise
            lead_us *= 4

    def until_clock(self, reading_us):
        wait_until(lambda: self.now_us() >= reading_us, "the reading of the server's clock")

    def events(self, method):
        """What has been told of a method up to now."""
        self.c.call("server.ping")
        return [m["params"] for m in self.c.unread if isinstance(m, dict) and m.get("method") == method]


class Schedule(Told):
    def test_what_can_be_scheduled(self):
        far = self.now_us() + 3_600_000_000
        for method, params in (("playback.play", {}), ("playback.pause", {}), ("playback.stop", {}), ("playback.seek", {"time": 1}),
                               ("playback.step", {"seconds": 1}), ("playback.set", {"speed": 2}), ("playback.queue", {"clips": [{"clip": "default"}]}),
                               ("camera.set", {"fit": True}), ("actor.update", {"spin": 1})):
            with self.unchanged():
                answer = self.c.call(method, at_us=far, **params)
            self.assertEqual((sorted(answer), answer["at_us"]), (["at_us", "scheduled"], far))
            self.c.call("schedule.cancel", scheduled=answer["scheduled"])
        for method, params in (("playback.get", {}), ("light.set", {}), ("keyframe.add", {"capture": True}), ("pose.clear", {})):
            self.refused(-32602, method, path="params.at_us", at_us=far, **params)

    def test_refusals(self):
        far = self.now_us() + 3_600_000_000
        self.refused(-32602, "camera.set", path="params.at_us", fit=True, at_us=far, base_revision=1)
        self.refused(-32602, "actor.update", path="params.at_us", spin=1, at_us=far, retry_key="k")
        self.refused(-32602, "playback.play", path="params.at_us", at_us=1, late="error")
        self.refused(-32602, "playback.play", path="params.late", at_us=1, late="never")
        self.refused(-32602, "playback.play", path="params.at_us", at_us=0.5)
        self.refused(-32602, "playback.play", path="params.tiem", at_us=far, tiem=1)
        self.refused(-32001, "playback.play", path="params.scene", at_us=far, scene="nowhere")
        self.refused(-32001, "schedule.list", path="params.scene", scene="nowhere")
        self.refused(-32001, "schedule.cancel", path="params.scheduled", scheduled=99)
        self.refused(-32602, "edit.apply", path="params.edits[0].params.at_us", edits=[{"method": "camera.set", "params": {"at_us": far}}])
        self.assertEqual(self.c.call("schedule.list"), {"scheduled": []})

    def test_list_and_cancel(self):
        far = self.now_us() + 3_600_000_000
        ids = [self.c.call("playback.seek", time=1, at_us=far + d)["scheduled"] for d in (2, 1, 1)]
        self.c.call("scene.create", scene="two")
        other = self.c.call("camera.set", scene="two", fov_y=1, at_us=far)["scheduled"]
        self.assertEqual(self.c.call("schedule.list")["scheduled"],
                         [{"scheduled": ids[i], "at_us": far + d, "method": "playback.seek"} for i, d in ((1, 1), (2, 1), (0, 2))])
        self.assertEqual([s["scheduled"] for s in self.c.call("schedule.list", scene="two")["scheduled"]], [other])
        self.assertEqual(self.c.call("schedule.cancel", scheduled=ids[1]), {})
        self.refused(-32001, "schedule.cancel", scheduled=ids[1])
        self.assertEqual([s["scheduled"] for s in self.c.call("schedule.list")["scheduled"]], [ids[2], ids[0]])

    def test_times_are_exact(self):
        def ask(at):
            self.c.call("playback.play", speed=0.5, at_us=at, late="error")
            self.c.call("playback.seek", time=1, at_us=at + 1, late="error")
            self.c.call("playback.set", speed=-0.25, at_us=at + 40_001, late="error")
        at, _ = self.ahead(ask)
        changed = self.c.event("playback.changed", server_time_us=at + 40_001)
        self.assertAlmostEqual(changed["players"][0]["time"], 1.02, delta=1e-9)
        answer = self.c.call("playback.get")
        self.assertAlmostEqual(answer["players"][0]["time"], 1.02 - 0.25e-6 * (answer["server_time_us"] - at - 40_001), delta=1e-9)

    def test_edits_have_their_turn_as_edits(self):
        before = self.c.call("scene.describe")["revision"]
        self.c.call("actor.update", spin=2, at_us=self.now_us() + 20_000)
        self.assertEqual(self.c.event("scene.changed"), {"scene": "main", "revision": before + 1, "method": "actor.update", "actor": "tri"})
        self.assertEqual(self.c.call("scene.describe")["actors"][0]["spin"], 2)
        self.assertEqual(self.c.call("edit.undo")["undone"], "actor.update")
        # One that is late is answered as any edit.
        self.assertEqual(sorted(self.c.call("camera.set", fov_y=1, at_us=1)), ["camera", "revision"])

    def test_failures_are_told(self):
        _, answer = self.ahead(lambda at: self.c.call("playback.play", clip="none", at_us=at, late="error"))
        told = self.c.event("schedule.failed")
        self.assertEqual((told["scene"], told["scheduled"], told["method"]), ("main", answer["scheduled"], "playback.play"))
        error = self.refused(-32001, "playback.play", clip="none")
        self.assertEqual((told["error"]["code"], told["error"]["data"]["path"]), (error.code, "params.clip"))

    def test_they_go_with_their_client_no_more_than_edits_do(self):
        other = self.server.line()
        other.call("playback.seek", time=1.5, at_us=self.now_us() + 100_000)
        other.close()
        wait_until(lambda: self.player()["time"] == 1.5, "the seek of a client that has gone")


class ScheduleLimit(Told):
    options = ("--max-scheduled", 2, "--max-queued-clips", 2, "--max-markers", 2)

    def test_limits(self):
        far = self.now_us() + 3_600_000_000
        for _ in range(2):
            self.c.call("playback.play", at_us=far)
            self.c.call("marker.add", time=1, name="m")
        self.refused(-32004, "playback.play", at_us=far)
        self.refused(-32004, "marker.add", time=1, name="m")
        self.refused(-32004, "playback.queue", path="params.clips", clips=[{"clip": "default"}] * 3)


class Markers(Told):
    def test_add_list_remove_and_undo(self):
        first = self.c.call("marker.add", time=1.5, name="b")
        second = self.c.call("marker.add", time=0.25, name="a")
        self.assertEqual(second["revision"], first["revision"] + 1)
        listed = [{"marker": second["marker"], "time": 0.25, "name": "a"}, {"marker": first["marker"], "time": 1.5, "name": "b"}]
        self.assertEqual(self.c.call("marker.list"), {"markers": listed})
        self.c.call("marker.remove", marker=first["marker"])
        self.assertEqual(self.c.call("marker.list"), {"markers": listed[:1]})
        self.assertEqual(self.c.call("edit.undo")["undone"], "marker.remove")
        self.assertEqual(self.c.call("marker.list"), {"markers": listed})
        for _ in range(2):
            self.c.call("edit.undo")
        self.assertEqual(self.c.call("marker.list"), {"markers": []})
        self.assertGreater(self.c.call("marker.add", time=1, name="c")["marker"], second["marker"], "ids are not used again")

    def test_refusals(self):
        for path, params in (("params.time", {"time": -0.1, "name": "m"}), ("params.name", {"time": 1, "name": ""}),
                             ("params.name", {"time": 1, "name": "a" * 65}), ("params.name", {"time": 1}), ("params.time", {"name": "m"})):
            self.refused(-32602, "marker.add", path=path, **params)
        self.refused(-32001, "marker.add", path="params.clip", clip="none", time=1, name="m")
        self.refused(-32001, "marker.remove", path="params.marker", marker=self.keys[0])
        marker = self.c.call("marker.add", time=1, name="m")["marker"]
        self.c.call("clip.create", clip="other")
        self.refused(-32001, "marker.remove", path="params.marker", marker=marker, clip="other")

    def test_crossings_are_told_once_with_their_reading(self):
        marker = self.c.call("marker.add", time=0.5, name="step")["marker"]
        begin = self.c.call("playback.play", time=0, speed=40)["server_time_us"]
        self.until_clock(begin + 300_000)
        end = self.c.call("playback.pause")["server_time_us"]
        told = self.events("marker.crossed")
        # At 12.5 ms, then each 50 ms.
        want = [begin + 12_500 + 50_000 * k for k in range(1000) if begin + 12_500 + 50_000 * k <= end]
        self.assertEqual([t["at_us"] for t in told], want)
        for t in told:
            del t["at_us"]
            self.assertEqual(t, {"scene": "main", "actor": "tri", "clip": "default", "marker": marker, "name": "step", "time": 0.5})

    def test_the_end_comes_after_the_marker_on_it(self):
        for at in (0, 2):
            self.c.call("marker.add", time=at, name=f"m{at}")
        begin = self.c.call("playback.play", loop="once", speed=50)["server_time_us"]
        self.c.event("playback.ended")
        told = [m for m in self.c.unread if isinstance(m, dict) and m["method"] == "marker.crossed"]
        self.assertEqual([(m["params"]["name"], m["params"]["at_us"]) for m in told], [("m0", begin), ("m2", begin + 40_000)])

    def test_a_seek_fires_none_and_a_start_does(self):
        self.c.call("marker.add", time=0.5, name="m")
        for at in (0.5, 1.5, 0.5):
            self.c.call("playback.seek", time=at)
        self.assertEqual(self.events("marker.crossed"), [])
        begin = self.c.call("playback.play", speed=0.001)["server_time_us"]
        self.assertEqual(self.c.event("marker.crossed")["at_us"], begin)
        self.c.call("playback.play")  # it plays already
        self.c.call("playback.set", speed=0.002)
        self.assertEqual(self.events("marker.crossed"), [])

    def test_only_subscribers_are_told_and_only_of_later(self):
        self.c.call("marker.add", time=0.5, name="m")
        self.c.call("events.unsubscribe")
        self.c.call("playback.play", time=0, speed=100, loop="once")
        wait_until(lambda: not self.player()["playing"], "the end")
        self.c.call("events.subscribe")
        self.c.call("playback.seek", time=1)
        self.assertEqual(self.events("marker.crossed"), [])

    def test_nothing_runs_while_nobody_listens(self):
        """A fast player with a marker wakes no thread without subscribers; with them, some 60 times a second."""
        self.c.call("marker.add", time=0.5, name="m")
        begin_us, before = self.c.call("playback.play", speed=200)["server_time_us"], self.wakes()
        wait_until(lambda: self.now_us() >= begin_us + 500_000 and self.woken_since(before) >= 30, "threads are woken")
        took_us, heard = self.now_us() - begin_us, self.woken_since(before)
        self.c.call("events.unsubscribe")
        before = self.wakes()
        self.until_clock(self.now_us() + took_us)
        self.assertLess(2 * self.woken_since(before), heard)

    def wakes(self):
        counts = {}
        for task in os.listdir(f"/proc/{self.server.process.pid}/task"):
            with open(f"/proc/{self.server.process.pid}/task/{task}/status") as f:
                counts[task] = next(int(line.split()[1]) for line in f if line.startswith("voluntary_ctxt_switches"))
        return counts

    def woken_since(self, before):
        """How often threads were woken, but for the one that was asked for the time all the while."""
        grown = sorted(count - before.get(task, 0) for task, count in self.wakes().items())
        return sum(grown[:-1])


class Queue(Told):
    def setUp(self):
        super().setUp()
        self.c.call("clip.create", clip="b", keys=self.keys[:2])

    def test_refusals_change_nothing(self):
        with self.unchanged():
            self.refused(-32001, "playback.queue", path="params.clips[1].clip", clips=[{"clip": "b"}, {"clip": "none"}])
            self.refused(-32602, "playback.queue", path="params.clips", clips=[])
            self.refused(-32602, "playback.queue", path="params.clips[0].repeat", clips=[{"clip": "b", "repeat": 0}])
            self.refused(-32602, "playback.queue", path="params.clips[0].fade", clips=[{"clip": "b", "fade": -1}])
            self.refused(-32602, "playback.queue", path="params.clips[0].loop", clips=[{"clip": "b", "loop": "twice"}])

    def test_clips_follow_each_other_and_the_last_one_ends(self):
        self.c.call("clip.update", clip="b", duration=1000)  # or on a slow machine both moves would be told as one
        self.c.call("playback.set", speed=20)
        self.c.call("playback.queue", clips=[{"clip": "default"}, {"clip": "b", "repeat": 2, "loop": "ping_pong"}])
        clips = [self.c.event("playback.changed", scene="main")["players"][0] for _ in range(3)][1:]
        self.c.call("playback.set", speed=20_000)
        clips += [self.c.event("playback.changed", scene="main")["players"][0] for _ in range(2)][1:]
        self.assertEqual([(p["clip"], p["playing"]) for p in clips], [("default", True), ("b", True), ("b", False)])
        self.assertEqual(self.c.event("playback.ended")["clip"], "b")
        self.assertEqual((self.player()["time"], self.player()["loop"]), (0, "repeat"))

    def test_pause_keeps_it_and_seek_ends_it(self):
        self.c.call("playback.set", speed=0.001)
        self.c.call("playback.queue", clips=[{"clip": "default", "repeat": 3}, {"clip": "b"}])
        self.c.call("playback.pause")
        self.c.call("playback.play", speed=100)
        wait_until(lambda: self.player()["clip"] == "b" and not self.player()["playing"], "the queue's end")
        self.c.call("playback.set", speed=0.001)
        self.c.call("playback.queue", clips=[{"clip": "default"}, {"clip": "b"}])
        self.c.call("playback.seek", time=0.5)
        self.assertEqual((self.player()["clip"], self.player()["loop"]), ("default", "repeat"))


class Poses(harness.TestCase):
    """An arm with two clips, each one pose."""

    def setUp(self):
        super().setUp()
        self.c.call("actor.add", actor="arm", skeleton=ARM)
        self.key("default", {"root": {"translation": [0, 0, 0]}})
        self.c.call("clip.create", clip="up")
        self.key("up", {"root": {"translation": [0, 2, 0]}, "arm": {"translation": [0, 4, 0]}})

    def key(self, clip, pose):
        for t in (0, 1):
            self.c.call("keyframe.add", clip=clip, pose=pose, time=t)

    def heights(self):
        return [j["translation"][1] for j in self.c.call("pose.sample")["joints"]]


class Fades(Poses):
    def test_a_fade_goes_from_the_one_to_the_other(self):
        self.assertEqual(self.heights()[:2], [0, 0])
        begin = self.c.call("playback.play", clip="up", fade=0.3)["server_time_us"]
        seen = []
        while not seen or seen[-1][1] < 2:
            low = self.c.call("server.ping")["time_us"]
            height = self.heights()[0]
            seen.append((low, height, self.c.call("server.ping")["time_us"]))
        for low, height, high in seen:
            self.assertLessEqual(min(2, 2 * (low - begin) / 3e5) - 1e-4, height)
            self.assertLessEqual(height, min(2, 2 * (high - begin) / 3e5) + 1e-4)
        self.refused(-32602, "playback.play", path="params.fade", clip="up", fade=-1)

    def test_a_paused_fade_is_streamed_to_its_end(self):
        self.c.call("playback.play", clip="up", fade=3)  # it is not over before there is a stream
        self.c.call("playback.pause")
        stream = self.c.call("stream.open", kind="pose", actor="arm")["stream"]
        packets = [self.c.packet(stream)]
        while not packets[-1].flags & 4:
            packets.append(self.c.packet(stream))
        self.assertGreater(len(packets), 2)
        self.assertAlmostEqual(packets[-1].floats()[1], 2, delta=1e-6)
        self.assertFalse(any(p.flags & 2 for p in packets), "a fade is no discontinuity")


class Layers(Poses):
    def test_a_layer_replaces_by_its_weight_where_its_mask_lets_it(self):
        revision = self.c.call("layer.set", layer="l", clip="up", weight=0.5)["revision"]
        self.near(self.heights(), [1, 2, 0])
        self.assertEqual(self.c.call("layer.set", layer="l", clip="up", mask=["arm"])["revision"], revision + 1)
        self.near(self.heights(), [0, 4, 0])
        self.c.call("layer.set", layer="m", clip="up", additive=True, weight=0.25)
        self.near(self.heights(), [0.5, 5, 0])
        self.assertEqual(self.c.call("scene.describe")["actors"][0]["layers"], [
            {"layer": "l", "clip": "up", "weight": 1, "additive": False, "mask": ["arm"]},
            {"layer": "m", "clip": "up", "weight": 0.25, "additive": True}])
        self.c.call("layer.remove", layer="l")
        self.near(self.heights(), [0.5, 1, 0])
        for _ in range(4):
            self.c.call("edit.undo")
        self.near(self.heights(), [0, 0, 0])
        self.c.call("edit.redo")
        self.near(self.heights(), [1, 2, 0])

    def test_a_fade_takes_its_time(self):
        self.c.call("layer.set", layer="l", clip="up", fade=0.2)
        wait_until(lambda: self.heights()[0] == 2, "the layer's weight")
        self.c.call("layer.remove", layer="l", fade=0.2)
        self.assertEqual(self.c.call("scene.describe")["actors"][0]["layers"], [])
        wait_until(lambda: self.heights()[0] == 0, "the layer's going")
        self.c.call("layer.set", layer="m", clip="up", fade=100)
        self.assertLess(self.heights()[0], 2)
        self.c.call("layer.remove", layer="m")
        self.c.call("layer.set", layer="n", clip="up")
        self.c.call("layer.remove", layer="n", fade=100)
        self.assertGreater(self.heights()[0], 0)

    def test_refusals(self):
        before = self.c.call("scene.describe")
        self.refused(-32001, "layer.set", path="params.clip", layer="l", clip="none")
        self.refused(-32602, "layer.set", path="params.mask[1]", layer="l", clip="up", mask=["arm", "leg"])
        self.refused(-32602, "layer.set", path="params.weight", layer="l", clip="up", weight=1.5)
        self.refused(-32602, "layer.set", path="params.fade", layer="l", clip="up", fade=-1)
        self.refused(-32602, "layer.set", path="params.layer", layer="", clip="up")
        self.refused(-32001, "layer.remove", path="params.layer", layer="l")
        self.assertEqual(self.c.call("scene.describe"), before)
        self.c.call("layer.set", layer="l", clip="up")
        self.refused(-32602, "clip.remove", path="params.clip", clip="up")
        self.c.call("layer.remove", layer="l")
        self.c.call("clip.remove", clip="up")

    def test_there_is_a_most(self):
        for i in range(16):
            self.c.call("layer.set", layer=f"l{i}", clip="up", weight=0)
        self.refused(-32004, "layer.set", layer="one_more", clip="up")
        self.c.call("layer.set", layer="l3", clip="default")

    def test_vertex_clips_are_no_layers(self):
        self.add_moving("tri")
        self.refused(-32602, "layer.set", path="params.clip", actor="tri", layer="l", clip="default")


if __name__ == "__main__":
    harness.main()
