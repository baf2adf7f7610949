"""Players (sections 3 and 5): play, pause, stop, seek, step, speed, loop, range; several in lockstep."""
import random

import harness
from harness import wait_until


class Players(harness.TestCase):
    def setUp(self):
        super().setUp()
        self.keys = self.add_moving()  # 2 s long

    def play(self, **kw):
        return self.c.call("playback.play", **kw)

    def set(self, **kw):
        player, = self.c.call("playback.set", **kw)["players"]
        return player

    def seek(self, t):
        return self.c.call("playback.seek", time=t)["players"][0]["time"]

    def follows(self, expected, readings=6):
        """While it plays: each reading's time is what `expected` makes of the clock since the first."""
        first = self.c.call("playback.get")
        start_us, start = first["server_time_us"], first["players"][0]["time"]
        seen = []
        for _ in range(readings):
            now = self.c.call("playback.get")
            player, = now["players"]
            want = expected(start, (now["server_time_us"] - start_us) / 1e6)
            if want is None:
                break
            self.assertAlmostEqual(player["time"], want, delta=5e-6, msg=str(now))
            seen.append(player["time"])
        return seen

    def test_at_first(self):
        self.assertEqual(self.player(), {"actor": "tri", "clip": "default", "playing": False, "time": 0, "speed": 1, "loop": "repeat",
                                         "range": [0, 2], "duration": 2})

    def test_time_follows_the_clock_whatever_the_speed(self):
        for speed in (1, 2.5, 0.01, -1, -3):
            played = self.play(time=1, speed=speed)
            player, = played["players"]
            self.assertEqual((player["playing"], player["speed"], player["time"]), (True, speed, 1))
            self.follows(lambda start, passed: (start + speed * passed) % 2)

    def test_answers_hold_at_their_clock_reading(self):
        played = self.play(time=0.5, speed=1)
        paused = self.c.call("playback.pause")
        passed = (paused["server_time_us"] - played["server_time_us"]) / 1e6
        self.assertAlmostEqual(paused["players"][0]["time"], (0.5 + passed) % 2, delta=2e-6)

    def test_pause_holds_and_play_goes_on(self):
        self.play(time=0.5)
        self.c.call("playback.pause")
        held = self.player()
        self.assertFalse(held["playing"])
        self.assertEqual(self.player()["time"], held["time"])
        self.c.call("playback.pause")
        self.assertEqual(self.player()["time"], held["time"])
        self.assertEqual(self.play()["players"][0]["time"], held["time"])

    def test_stop_goes_to_the_ranges_start(self):
        self.play(time=1.5)
        player, = self.c.call("playback.stop")["players"]
        self.assertEqual((player["playing"], player["time"]), (False, 0))
        self.set(range=[0.5, 1.5])
        self.play(speed=-1)
        player, = self.c.call("playback.stop")["players"]
        self.assertEqual((player["playing"], player["time"]), (False, 0.5))

    def test_seek_clamps_for_once_and_wraps_for_the_others(self):
        self.set(loop="once")
        self.assertEqual([self.seek(t) for t in (-1, 0, 1.25, 2, 5)], [0, 0, 1.25, 2, 2])
        for loop in ("repeat", "ping_pong"):
            self.set(loop=loop)
            for t in (0, 0.5, 1.999, 2):
                self.assertEqual(self.seek(t), t, "out can be sought")
            for t, want in ((2.25, 0.25), (7.5, 1.5), (-0.5, 1.5), (-3.75, 0.25)):
                if loop == "repeat":
                    self.assertAlmostEqual(self.seek(t), want, places=9)
                else:
                    self.assertTrue(0 <= self.seek(t) <= 2)
        self.assertFalse(self.player()["playing"], "a seek starts nothing")

    def test_seeking_while_it_plays(self):
        self.play()
        self.assertEqual(self.seek(1.25), 1.25)
        self.assertTrue(self.player()["playing"])
        self.follows(lambda start, passed: (start + passed) % 2)

    def test_ping_pong(self):
        self.play(time=0, speed=40, loop="ping_pong")

        def reflected(phase):
            phase %= 4
            return phase if phase <= 2 else 4 - phase
        first = self.c.call("playback.get")
        # where it is in its way to and fro is not told: two readings close together tell the direction
        for _ in range(20):
            now = self.c.call("playback.get")
            passed = 40 * (now["server_time_us"] - first["server_time_us"]) / 1e6
            t0, t1 = first["players"][0]["time"], now["players"][0]["time"]
            error = min(abs(t1 - reflected(t0 + passed)), abs(t1 - reflected(4 - t0 + passed)))
            self.assertLess(error, 1e-4)
        seen = set()
        wait_until(lambda: seen.add(round(self.player()["time"])) or seen == {0, 1, 2}, "it comes everywhere")

    def test_range(self):
        player = self.set(range=[0.5, 1])
        self.assertEqual((player["range"], player["time"], player["duration"]), ([0.5, 1], 0.5, 2))
        self.play(speed=1)
        self.follows(lambda start, passed: 0.5 + (start - 0.5 + passed) % 0.5)
        self.c.call("playback.pause")
        self.assertAlmostEqual(self.seek(1.25), 0.75, places=9)
        self.assertEqual(self.seek(1), 1)
        self.set(loop="once")
        self.assertEqual([self.seek(0), self.seek(2)], [0.5, 1])

    def test_the_range_is_the_whole_clip_until_it_is_set(self):
        self.c.call("keyframe.add", time=5, vertices={"positions": harness.lifted(1)})
        self.assertEqual((self.player()["range"], self.player()["duration"]), ([0, 5], 5))
        self.set(range=[1, 3])
        self.c.call("keyframe.add", time=7, vertices={"positions": harness.lifted(1)})
        self.assertEqual((self.player()["range"], self.player()["duration"]), ([1, 3], 7))
        self.c.call("clip.create", clip="other", keys=self.keys[:2], duration=4)
        self.play(clip="other")
        self.assertEqual((self.player()["range"], self.player()["clip"]), ([0, 4], "other"))

    def test_another_clip_starts_at_its_start_or_backwards_at_its_end(self):
        self.c.call("clip.create", clip="other", keys=self.keys[:2], duration=4)
        self.play(time=1.5, speed=0.01)
        player, = self.play(clip="other")["players"]
        self.assertEqual((player["clip"], player["time"], player["speed"]), ("other", 0, 0.01))
        self.play(time=3)
        player, = self.play(clip="other")["players"]
        self.assertAlmostEqual(player["time"], 3, delta=1, msg="the same clip goes on")
        player, = self.play(clip="default", speed=-1)["players"]
        self.assertEqual((player["clip"], player["time"]), ("default", 2))
        player, = self.play(clip="other", time=1.25)["players"]
        self.assertEqual(player["time"], 1.25)

    def test_once_ends_and_play_starts_again(self):
        for speed, end, start in ((50, 2, 0), (-50, 0, 2)):
            player, = self.play(time=1, speed=speed, loop="once")["players"]
            wait_until(lambda: not self.player()["playing"], "the end")
            self.assertEqual(self.player()["time"], end)
            player, = self.play(speed=speed / 1000)["players"]
            self.assertEqual((player["time"], player["playing"]), (start, True))

    def test_once_within_a_range(self):
        self.set(range=[0.5, 1.5])
        self.play(time=0.5, speed=50, loop="once")
        wait_until(lambda: not self.player()["playing"], "the end")
        self.assertEqual(self.player()["time"], 1.5)

    def test_step_by_seconds(self):
        played = self.play(time=0.5, speed=0.01)
        stepped = self.c.call("playback.step", seconds=0.25)
        player, = stepped["players"]
        self.assertFalse(player["playing"], "it pauses first")
        passed = (stepped["server_time_us"] - played["server_time_us"]) / 1e6
        self.assertAlmostEqual(player["time"], 0.75 + 0.01 * passed, delta=2e-6)
        self.seek(1)
        self.assertEqual(self.c.call("playback.step", seconds=-0.75)["players"][0]["time"], 0.25)
        self.set(loop="once")
        self.assertEqual(self.c.call("playback.step", seconds=-1)["players"][0]["time"], 0)
        self.set(loop="repeat")
        self.assertAlmostEqual(self.c.call("playback.step", seconds=-0.5)["players"][0]["time"], 1.5, places=9)

    def test_step_by_keyframes(self):
        self.seek(0.5)
        step = lambda n: self.c.call("playback.step", keyframes=n)["players"][0]["time"]  # noqa: E731
        self.assertEqual([step(1), step(1), step(-1), step(-1)], [1, 2, 1, 0])
        self.seek(0.5)
        self.assertEqual(step(2), 2)
        self.seek(1.5)
        self.assertEqual(step(-2), 0)
        self.set(loop="once")
        self.assertEqual([step(9), step(1), step(-9), step(-1)], [2, 2, 0, 0])

    def test_set_changes_nothing_else(self):
        self.play(time=1)
        self.c.call("playback.pause")
        before = self.player()
        self.assertEqual(self.set(speed=3), before | {"speed": 3})
        self.assertEqual(self.set(loop="ping_pong"), before | {"speed": 3, "loop": "ping_pong"})
        self.assertEqual(self.set(), before | {"speed": 3, "loop": "ping_pong"})

    def test_a_change_of_speed_keeps_the_time(self):
        self.play(time=0.25, speed=0.5)
        for speed in (1, -1, 0.25, 0, 2):
            before = self.c.call("playback.get")
            after = self.c.call("playback.set", speed=speed)
            old = before["players"][0]["speed"]
            passed = (after["server_time_us"] - before["server_time_us"]) / 1e6
            self.assertAlmostEqual(after["players"][0]["time"], (before["players"][0]["time"] + old * passed) % 2, delta=5e-6)

    def test_edits_while_it_plays_keep_the_time(self):
        self.play(time=0, speed=0.05)
        before = self.c.call("playback.get")
        for t in (2.5, 3, 4):
            self.c.call("keyframe.add", time=t, vertices={"positions": harness.lifted(1)})
            now = self.c.call("playback.get")
            passed = (now["server_time_us"] - before["server_time_us"]) / 1e6
            self.assertAlmostEqual(now["players"][0]["time"], before["players"][0]["time"] + 0.05 * passed, delta=5e-6)

    def test_a_clip_that_shrinks_under_the_player(self):
        self.seek(1.75)
        self.c.call("keyframe.remove", keyframe=self.keys[2])
        player = self.player()
        self.assertTrue(0 <= player["time"] <= 1, player)
        self.assertEqual(player["range"], [0, 1])

    def test_an_empty_clip_can_be_played(self):
        self.c.call("clip.create", clip="empty")
        player, = self.play(clip="empty")["players"]
        self.assertEqual((player["time"], player["duration"]), (0, 0))
        self.c.call("playback.seek", time=5)
        self.c.call("playback.step", keyframes=1)
        self.c.call("playback.step", seconds=1)
        self.assertEqual(self.player()["time"], 0)
        self.c.call("vertices.sample")

    def test_players_are_no_part_of_the_document(self):
        before = self.c.call("scene.describe")["revision"]
        self.play()
        self.seek(1)
        self.c.call("playback.stop")
        self.assertEqual(self.c.call("scene.describe")["revision"], before)


class Lockstep(harness.TestCase):
    def setUp(self):
        super().setUp()
        self.keys = {name: self.add_moving(name) for name in "abc"}

    def test_all_actors_at_once(self):
        answers = [self.c.call("playback.play", time=0.5, speed=0.7), self.c.call("playback.set", speed=1.5),
                   self.c.call("playback.seek", time=0.25), self.c.call("playback.get"), self.c.call("playback.pause"),
                   self.c.call("playback.step", seconds=0.1), self.c.call("playback.get")]
        for answer in answers:
            self.assertEqual([p["actor"] for p in answer["players"]], ["a", "b", "c"])
            self.assertEqual(len({(p["time"], p["playing"], p["speed"]) for p in answer["players"]}), 1, answer)

    def test_one_actor_of_several(self):
        self.c.call("playback.play", actor="b", time=1)
        players = self.c.call("playback.get")["players"]
        self.assertEqual([p["playing"] for p in players], [False, True, False])
        self.assertEqual([p["actor"] for p in self.c.call("playback.seek", actor="b", time=0)["players"]], ["b"])
        self.refused(-32001, "playback.play", path="params.actor", actor="d")

    def test_a_clip_that_one_of_them_lacks_changes_nothing(self):
        for actor in "ac":
            self.c.call("clip.create", actor=actor, clip="other", keys=self.keys[actor])
        with self.unchanged():
            self.refused(-32001, "playback.play", path="params.clip", clip="other", speed=2, time=1, loop="once")
        self.c.call("clip.create", actor="b", clip="other", keys=self.keys["b"])
        self.c.call("playback.play", clip="other")

    def test_a_range_that_does_not_fit_one_of_them_changes_nothing(self):
        self.c.call("keyframe.remove", actor="c", keyframe=self.keys["c"][2])
        with self.unchanged():
            self.refused(-32602, "playback.set", path="params.range", range=[0, 2], speed=3)

    def test_scenes_without_actors(self):
        self.c.call("scene.create", scene="empty")
        for method, params in (("play", {}), ("pause", {}), ("stop", {}), ("seek", {"time": 1}), ("step", {"keyframes": 1}), ("set", {}), ("get", {})):
            answer = self.c.call(f"playback.{method}", scene="empty", **params)
            self.assertEqual(answer["players"], [])
            self.assertIsInstance(answer["server_time_us"], int)

    def test_a_random_walk_against_a_model(self):
        """Paused players under random commands: their times are those of plain arithmetic."""
        seed = random.randrange(1 << 30)
        rng = random.Random(seed)
        self.c.call("playback.set", loop="once")
        low, high, t, loop = 0.0, 2.0, 0.0, "once"
        for step in range(150):
            kind = rng.choice(("seek", "step", "stop", "range", "loop", "all"))
            x = rng.randrange(-16, 40) / 8
            place = lambda v: min(max(v, low), high) if loop == "once" or low <= v <= high else low + (v - low) % (high - low)  # noqa: E731
            if kind == "seek":
                t, answer = place(x), self.c.call("playback.seek", time=x)
            elif kind == "step":
                t, answer = place(t + x), self.c.call("playback.step", seconds=x)
            elif kind == "stop":
                t, answer = low, self.c.call("playback.stop")
            elif kind == "range":
                low, high = sorted(rng.sample([i / 4 for i in range(9)], 2))
                t, answer = place(t), self.c.call("playback.set", range=[low, high])
            elif kind == "loop":
                loop = rng.choice(("once", "repeat"))
                answer = self.c.call("playback.set", loop=loop)
            else:
                low, high = 0.0, 2.0
                t, answer = place(t), self.c.call("playback.set", range=None)
            for player in answer["players"]:
                self.assertAlmostEqual(player["time"], t, delta=1e-9, msg=f"seed {seed}, step {step}: {kind} {x} {loop} {low} {high}")
                self.assertEqual((player["range"], player["loop"], player["playing"]), ([low, high], loop, False))


if __name__ == "__main__":
    harness.main()
