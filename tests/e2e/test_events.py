"""Events (section 5): playback.changed, playback.ended, scene.changed."""
import harness
from client import LAST, Packet
from harness import TRIANGLE, lifted

KEY = {"vertices": {"positions": lifted(5)}}


class Watched(harness.TestCase):
    """A scene that moves, and on another connection who is told of it."""

    def setUp(self):
        super().setUp()
        self.keys = self.add_moving()
        self.w = self.server.line()
        self.w.call("events.subscribe")
        self.told()

    def told(self, client=None, scene="main"):
        """What the watcher has been told up to now: a command without effect marks the place."""
        client = client or self.w
        mark = self.c.call("playback.set", scene=scene)["server_time_us"]
        client.event("playback.changed", server_time_us=mark)
        came, client.unread = client.unread, []
        return [(m["method"], m["params"]) for m in came if isinstance(m, dict)]


class Changes(Watched):
    def test_playback_changed(self):
        for method, params in (("play", {"speed": 0.5}), ("set", {"speed": 2}), ("seek", {"time": 1}), ("step", {"keyframes": 1}),
                               ("pause", {}), ("stop", {})):
            answer = self.c.call(f"playback.{method}", **params)
            event = self.w.event("playback.changed")
            self.assertEqual(event, {"scene": "main", **answer})
        self.c.call("playback.get")
        self.assertEqual(self.told(), [])

    def test_playback_changed_names_only_the_players_concerned(self):
        self.add_moving("other")
        self.told()
        self.c.call("playback.seek", actor="other", time=1)
        self.assertEqual([p["actor"] for p in self.w.event("playback.changed")["players"]], ["other"])
        self.c.call("playback.seek", time=1)
        self.assertEqual([p["actor"] for p in self.w.event("playback.changed")["players"]], ["tri", "other"])

    def test_scene_changed(self):
        k = self.keys
        for method, params, about in (
                ("actor.add", {"actor": "b", "mesh": TRIANGLE}, {"actor": "b"}), ("actor.update", {"actor": "b", "spin": 1}, {"actor": "b"}),
                ("actor.remove", {"actor": "b"}, {"actor": "b"}), ("keyframe.add", KEY, {"actor": "tri", "clip": "default", "keyframe": None}),
                ("keyframe.update", {"keyframe": k[0], **KEY}, {"actor": "tri", "clip": "default", "keyframe": k[0]}),
                ("keyframe.move", {"keyframe": k[0], "time": 0.5}, {"actor": "tri", "clip": "default", "keyframe": k[0]}),
                ("keyframe.remove", {"keyframe": k[1]}, {"actor": "tri", "clip": "default", "keyframe": k[1]}),
                ("clip.create", {"clip": "x"}, {"actor": "tri", "clip": "x"}), ("clip.update", {"clip": "x", "closed": True}, {"actor": "tri", "clip": "x"}),
                ("clip.remove", {"clip": "x"}, {"actor": "tri", "clip": "x"}), ("camera.set", {"fov_y": 1}, {}), ("light.set", {"ambient": 1}, {}),
                ("scene.update", {"grid": True}, {}), ("edit.undo", {}, {}), ("edit.redo", {}, {}),
                ("edit.apply", {"edits": [{"method": "keyframe.add", "params": KEY}, {"method": "camera.set", "params": {"fov_y": 2}}]}, {})):
            answer = self.c.call(method, **params)
            event = self.w.event("scene.changed")
            if "keyframe" in about:
                about["keyframe"] = answer.get("keyframe", about["keyframe"])
            self.assertEqual(event, {"scene": "main", "revision": answer["revision"], "method": method, **about})

    def test_refused_edits_are_not_told(self):
        self.refused(-32001, "keyframe.remove", keyframe=99)
        self.refused(-32001, "playback.play", clip="none")
        self.refused(-32602, "edit.apply", edits=[{"method": "camera.set"}, {"method": "no.such"}])
        self.assertEqual(self.told(), [])

    def test_of_one_scene_and_until_unsubscribed(self):
        self.c.call("scene.create", scene="s")
        self.add_triangle(scene="s")
        self.assertEqual(self.told(), [])
        self.w.call("events.subscribe", scene="s")
        self.w.call("events.subscribe", scene="s")  # once is enough
        self.c.call("camera.set", scene="s", fov_y=2)
        self.c.call("camera.set", fov_y=2)
        self.assertEqual(sorted(p["scene"] for _, p in self.told()), ["main", "s"])
        self.w.call("events.unsubscribe")
        self.w.call("events.unsubscribe")
        self.c.call("camera.set", scene="s", fov_y=1)
        self.c.call("camera.set", fov_y=1)
        self.assertEqual([p["scene"] for _, p in self.told(scene="s")], ["s"])

    def test_ones_own_changes_are_told_too(self):
        self.w.call("camera.set", fov_y=1)
        self.w.event("scene.changed", method="camera.set")
        self.w.call("playback.play")
        self.w.event("playback.changed")

    def test_every_edit_of_a_pipeline_is_told_in_order(self):
        count = 200
        for i in range(count):
            self.c.send("keyframe.add", time=10 + i, **KEY)
        revisions = [self.w.event("scene.changed")["revision"] for _ in range(count)]
        self.assertEqual(revisions, list(range(revisions[0], revisions[0] + count)))

    def test_every_watcher_is_told_the_same(self):
        watchers = [self.w, self.server.line(), self.server.websocket()]
        for w in watchers[1:]:
            w.call("events.subscribe")
        marks = []
        for i in range(21):
            marks.append(self.c.call("playback.seek", time=i / 20)["server_time_us"])
            self.c.call("camera.set", fov_y=1 + i / 20)
        marks.append(self.c.call("playback.stop")["server_time_us"])
        told = []
        for w in watchers:
            w.event("playback.changed", server_time_us=marks[0])
            w.unread.clear()
            w.event("playback.changed", server_time_us=marks[-1])
            told.append(w.unread)
        self.assertEqual(len(told[0]), 41)
        self.assertEqual(told[0], told[1])
        self.assertEqual(told[0], told[2])


class Endings(Watched):
    def wait_for_the_end(self, count=1):
        """All that came up to the count-th playback.ended."""
        came, ends = [], 0
        while ends < count:
            came.append(self.w.read())
            ends += isinstance(came[-1], dict) and came[-1].get("method") == "playback.ended"
        return came

    def test_ended_comes_once_after_the_final_packet(self):
        stream = self.w.call("stream.open", kind="vertices", rate=60)["stream"]
        for speed, start, end_us in ((20, 0, 2_000_000), (-20, 2, 0), (7, 1, 2_000_000)):
            self.c.call("playback.play", time=start, speed=speed, loop="once")
            came = self.wait_for_the_end()
            self.assertEqual(came[-1]["params"], {"scene": "main", "actor": "tri", "clip": "default"})
            final = [m for m in came if isinstance(m, Packet)][-1]
            self.assertEqual((final.media_us, final.flags & LAST, final.stream), (end_us, LAST, stream))
            self.assertEqual(final.positions(), self.w.call("vertices.sample")["positions"])
            self.assertEqual(self.w.settle(), [], "nothing follows")
        marker = self.c.call("playback.seek", time=1)["players"][0]["time"]
        rest = [m for m in (self.w.packet(stream), *self.w.settle()) if isinstance(m, Packet)]
        self.assertEqual([p.media_us for p in rest], [marker * 1e6], "no packet came in between")
        self.assertEqual(rest[0].sequence, final.sequence + 1)

    def test_ended_after_the_final_packets_of_all_streams(self):
        streams = [self.w.call("stream.open", kind="vertices", rate=rate)["stream"] for rate in (5, 30, 30, 240)]
        for _ in range(3):
            self.c.call("playback.play", time=0, speed=10, loop="once")
            came = self.wait_for_the_end()
            for stream in streams:
                final = [m for m in came if isinstance(m, Packet) and m.stream == stream][-1]
                self.assertEqual((final.media_us, final.flags & LAST), (2_000_000, LAST), f"stream {stream}")

    def test_a_stream_that_is_asked_for_rarely_does_not_hold_the_end_up(self):
        stream = self.w.call("stream.open", kind="vertices", rate=0.01)["stream"]
        self.w.packet(stream)
        self.c.call("playback.play", time=0, speed=10, loop="once")
        self.w.event("playback.ended")  # the stream's next packet is due in a hundred seconds

    def test_ended_without_any_stream(self):
        self.c.call("playback.play", time=0, speed=50, loop="once")
        self.w.event("playback.ended")
        player = self.player()
        self.assertEqual((player["playing"], player["time"]), (False, 2))
        self.assertNotIn("playback.ended", [m for m, _ in self.told()], "each end is told once")

    def test_every_actor_that_ends_is_told(self):
        self.add_moving("other", keys=2)
        self.c.call("playback.play", speed=20, loop="once")
        ended = [self.w.event("playback.ended")["actor"] for _ in range(2)]
        self.assertEqual(ended, ["other", "tri"], "in the order of their ends")

    def test_what_does_not_end_is_not_told(self):
        for loop in ("repeat", "ping_pong"):
            self.c.call("playback.play", speed=200, loop=loop)
            for _ in range(20):
                self.w.call("vertices.sample")
        self.c.call("playback.play", time=0, speed=0.01, loop="once")
        self.c.call("playback.pause")
        self.c.call("playback.seek", time=2)  # to the end, but not by playing
        self.c.call("playback.stop")
        self.assertNotIn("playback.ended", [m for m, _ in self.told()])

    def test_a_seek_or_pause_before_the_end_takes_it_back(self):
        self.c.call("playback.play", time=0, speed=0.01, loop="once")  # minutes: none of this comes too late
        self.c.call("playback.set", speed=0.0001)
        self.c.call("playback.seek", time=1.99)
        self.c.call("playback.pause")
        self.c.call("playback.play", time=1.9, speed=10)
        self.w.event("playback.ended")
        self.assertNotIn("playback.ended", [m for m, _ in self.told()], "it is told once")

    def test_an_end_that_comes_to_meet_the_player(self):
        """The clip becomes shorter than where the player is."""
        self.c.call("playback.play", time=1.5, speed=0.01, loop="once")
        self.c.call("keyframe.remove", keyframe=self.keys[2])
        self.w.event("playback.ended")
        self.assertEqual((self.player()["time"], self.player()["playing"]), (1, False))

    def test_playing_a_clip_without_length_ends_at_once(self):
        self.c.call("clip.create", clip="empty")
        self.c.call("playback.play", clip="empty", loop="once")
        self.assertEqual(self.w.event("playback.ended")["clip"], "empty")


if __name__ == "__main__":
    harness.main()
