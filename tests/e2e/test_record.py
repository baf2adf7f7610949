"""record.start and record.stop (section 5.3): exact pictures in whole files, or nothing."""
import os
import resource
import signal
from fractions import Fraction

import harness
import pictures
from client import request_json
from films import Film, distance
from harness import wait_until
from pictures import QUAD, Picture

SIZE = {"width": 96, "height": 64}
CLOSE = 3.0  # of 255, in the mean: what two conversions of colours, half their resolution and x264 may change


def shifted(x):
    return [c + (x if i % 3 == 0 else 0) for i, c in enumerate(QUAD["positions"])]


class Recording(pictures.PictureCase):
    needs_h264 = True

    def setUp(self):
        self.root = self.folder()
        self.assets = (self.root,)
        super().setUp()
        self.c.call("actor.add", actor="quad", mesh=QUAD)
        for t in range(5):
            self.c.call("keyframe.add", time=t, vertices={"positions": shifted(2 * t - 4)})
        self.c.call("camera.set", eye=[0, 0, 12], target=[0, 0, 0])

    def path(self, name):
        return os.path.join(self.root, name)

    def start(self, by=None, **kw):
        return (by or self.c).call("record.start", **SIZE | kw)

    def shown_at(self, time):
        return Picture.of_png(self.file(time=time, **SIZE))

    def pass_by(self, us):
        """Lets the server's clock go on by so much."""
        end = self.c.call("server.ping")["time_us"] + us
        wait_until(lambda: self.c.call("server.ping")["time_us"] >= end, "the clock")

    def left(self):
        return sorted(os.listdir(self.root))


class Files(Recording):
    def test_each_picture_shows_the_scene_at_its_reading(self):
        for fps in (30, 29.97):
            name = f"at-{fps}.mp4"
            self.c.call("playback.stop")
            started = self.start(name=name, fps=fps)
            self.pass_by(150_000)
            played = self.c.call("playback.play", loop="once")
            self.pass_by(900_000)
            stop_us = self.c.call("server.ping")["time_us"]
            answer = self.c.call("record.stop", record=started["record"])
            film = Film(self.path(name))
            self.assertEqual(answer, {"name": name, "frames": len(film.times), "bytes": os.path.getsize(self.path(name))})
            exact = Fraction(str(fps))
            self.assertEqual(film.times, [k / exact for k in range(len(film.times))])
            self.assertEqual(film.duration, len(film.times) / exact)
            self.assertGreaterEqual(len(film.times), (stop_us - started["start_us"]) * fps / 1e6)
            self.assertEqual(film.size, (96, 64))
            decoded = film.pictures()
            moved = 0
            for k in range(0, len(decoded), 3):
                reading_us = started["start_us"] + k * 1e6 / fps
                time = max(0, reading_us - played["server_time_us"]) / 1e6
                near = distance(decoded[k], self.shown_at(time))
                self.assertLess(near, CLOSE, (fps, k))
                if 0.2 < time < 3.5:  # it moves: what was shown three pictures before and after is further off
                    for other in (time - 3 / fps, time + 3 / fps):
                        self.assertLess(near, distance(decoded[k], self.shown_at(other)), (fps, k))
                    moved += 1
            self.assertGreater(moved, 2)

    def test_a_folder_of_pictures(self):
        started = self.start(name="walk", format="png_sequence", fps=20, width=33, height=21)
        self.pass_by(200_000)
        answer = self.c.call("record.stop", record=started["record"])
        names = [f"frame_{k:06}.png" for k in range(answer["frames"])]
        self.assertGreaterEqual(len(names), 4)
        self.assertEqual(sorted(os.listdir(self.path("walk"))), names)
        self.assertEqual(sum(os.path.getsize(self.path(f"walk/{n}")) for n in names), answer["bytes"])
        with open(self.path(f"walk/{names[0]}"), "rb") as f:
            first = Picture.of_png(f.read())
        self.assertEqual(first, Picture.of_png(self.file(time=0, width=33, height=21)))

    def test_an_own_camera(self):
        camera = {"eye": [0, 0, 3], "target": [0, 0, 0]}
        started = self.start(name="near.mp4", camera=camera)
        self.c.call("record.stop", record=started["record"])
        first = Film(self.path("near.mp4")).pictures()[0]
        self.assertLess(distance(first, Picture.of_png(self.file(time=0, camera=camera, **SIZE))), CLOSE)

    def test_edits_are_seen_and_a_removed_scene_ends_it(self):
        self.c.call("scene.create", scene="two")
        self.c.call("actor.add", scene="two", actor="quad", mesh=QUAD)
        started = self.start(scene="two", name="two.mp4")
        self.pass_by(100_000)
        self.c.call("scene.update", scene="two", background=[1, 1, 1])
        self.pass_by(100_000)
        self.c.call("scene.remove", scene="two")
        answer = self.c.call("record.stop", record=started["record"])
        decoded = Film(self.path("two.mp4")).pictures()
        self.assertEqual(len(decoded), answer["frames"])
        self.assertLess(decoded[0].at(0, 0)[0], 60)
        self.assertGreater(decoded[-1].at(0, 0)[0], 200)

    def test_it_outlives_its_connection_and_holds_up_nobody(self):
        other = self.server.line()
        started = self.start(by=other, name="on.mp4")
        other.close()
        self.pass_by(100_000)
        # Beside it one of which much is still to be made when it is stopped.
        long = self.start(name="long", format="png_sequence", fps=240, width=640, height=480)
        self.pass_by(200_000)
        stops = [1001, 1002]
        asked = [request_json("record.stop", {"record": r["record"]}, id) for r, id in zip((long, started), stops)]
        self.c.send_raw(b"\n".join([*asked, request_json("server.ping", id=1003), b""]))  # at once: it may not lag behind
        self.assertEqual(self.c.read()["id"], 1003, "it is answered before them, on the same connection")
        frames = [self.c.answer(stop)["frames"] for stop in stops]
        self.assertEqual(frames[0], len(os.listdir(self.path("long"))))
        self.assertEqual(frames[1], len(Film(self.path("on.mp4")).times))
        self.assertGreaterEqual(min(frames), 3)


    def test_they_are_found_again(self):
        self.assertEqual(self.c.call("record.list"), {"recordings": []})
        started = self.start(name="found.mp4", fps=25)
        listed = self.server.line().call("record.list")["recordings"]
        frames = listed[0].pop("frames")
        self.assertGreaterEqual(frames, 0)
        self.assertEqual(listed, [{"recording": started["record"], "scene": "main", "name": "found.mp4", "fps": 25,
                                   "start_us": started["start_us"], "state": "running"}])
        self.assertEqual(self.c.call("server.stats")["tweend_recordings"], 1)
        self.pass_by(100_000)
        self.c.call("record.stop", record=started["record"])
        self.assertEqual(self.c.call("record.list"), {"recordings": []})
        self.assertEqual(self.c.call("server.stats")["tweend_recordings"], 0)


class Refusals(Recording):
    def refused_start(self, code, path=None, **kw):
        error = self.refused(code, "record.start", path=path, **SIZE | {"name": "a.mp4"} | kw)
        self.assertEqual(self.left(), [])
        return error

    def test_names(self):
        for name in ("../a.mp4", "", "/a.mp4", "none/a.mp4"):
            self.refused_start(-32001, "params.name", name=name)
        for name in (".a.mp4", "a b.mp4", "a.avi", "a", "a.MP4"):
            self.refused_start(-32602, "params.name", name=name)
        for name in ("a.mp4", "a.png", ".a"):
            self.refused_start(-32602, "params.name", name=name, format="png_sequence")

    def test_sizes_and_rates(self):
        self.refused_start(-32602, "params.width", width=33)
        self.refused_start(-32602, "params.height", height=21)
        self.refused_start(-32004, "params.width", width=100_000)
        for fps in (0, -1, 1e-13, 0.00099, 241):
            self.refused_start(-32602, "params.fps", fps=fps)
        self.refused_start(-32001, "params.scene", scene="none")
        self.refused_start(-32602, format="avi")

    def test_a_taken_name(self):
        started = self.start(name="a.mp4")
        self.refused(-32002, "record.start", path="params.name", name="a.mp4", **SIZE)
        self.c.call("record.stop", record=started["record"])
        self.refused(-32002, "record.start", path="params.name", name="a.mp4", **SIZE)
        self.assertEqual(self.left(), ["a.mp4"])

    def test_a_name_that_was_taken_meanwhile(self):
        started = self.start(name="a.mp4")
        with open(self.path("a.mp4"), "w") as f:
            f.write("theirs")
        self.refused(-32002, "record.stop", record=started["record"])
        self.assertEqual(self.left(), ["a.mp4"])
        self.assertEqual(os.path.getsize(self.path("a.mp4")), 6)

    def test_what_was_never_started_or_has_been_stopped(self):
        self.refused(-32001, "record.stop", path="params.record", record=1)
        started = self.start(name="a.mp4")
        self.c.call("record.stop", record=started["record"])
        self.refused(-32001, "record.stop", path="params.record", record=started["record"])

    def test_one_too_many(self):
        server = self.serve("--max-recordings", 2, assets=(self.folder(),), render=True)
        c = server.line()
        self.start(by=c, name="a.mp4")
        first = self.start(by=c, name="b.mp4")
        error = self.refused(-32004, "record.start", by=c, name="c.mp4", **SIZE)
        self.assertIn("(1, 2)", error.message)
        c.call("record.stop", record=first["record"])
        self.start(by=c, name="c.mp4")

    def test_the_longest(self):
        folder = self.folder()
        server = self.serve("--max-recorded-pictures", 5, assets=(folder,), render=True)
        c = server.line()
        started = self.start(by=c, name="a.mp4")
        wait_until(lambda: os.path.exists(f"{folder}/a.mp4"), "the file")
        self.assertEqual(c.call("record.stop", record=started["record"])["frames"], 5)

    def test_where_nothing_draws_or_there_is_no_folder(self):
        self.refused(-32006, "record.start", by=self.serve(assets=(self.root,)).line(), name="a.mp4")
        self.refused(-32006, "record.start", by=self.serve(render=True).line(), name="a.mp4")
        self.assertEqual(self.left(), [])


class Ends(Recording):
    def test_a_full_disk_leaves_nothing(self):
        """A limit on the length of files stands for the disk."""
        server = self.serve(assets=(self.root,), render=True)
        c = server.line()
        resource.prlimit(server.process.pid, resource.RLIMIT_FSIZE, (500, resource.RLIM_INFINITY))
        for format, name in (("mp4", "a.mp4"), ("png_sequence", "walk")):
            started = self.start(by=c, name=name, format=format, width=640, height=480)
            error = self.refused(-32006, "record.stop", by=c, record=started["record"])
            self.assertIn(name, error.message)
        resource.prlimit(server.process.pid, resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
        self.assertEqual(self.left(), [])

    def test_a_server_that_stops_makes_files_of_what_there_is(self):
        self.start(name="a.mp4")
        self.start(name="walk", format="png_sequence")
        self.pass_by(300_000)
        self.assertEqual(self.server.stop(), 0)
        self.assertEqual(self.left(), ["a.mp4", "walk"])
        self.assertEqual(len(Film(self.path("a.mp4")).pictures()), len(Film(self.path("a.mp4")).times))

    def test_a_server_that_is_killed_leaves_nothing_under_the_name(self):
        server = harness.Server(assets=(self.root,), render=True)
        c = server.line()
        self.start(by=c, name="a.mp4")
        self.start(by=c, name="walk", format="png_sequence")
        wait_until(lambda: any(os.path.isdir(self.path(n)) and len(os.listdir(self.path(n))) > 3 for n in self.left()), "pictures")
        server.stop(signal.SIGKILL)
        with self.assertRaises(AssertionError):
            server.close()
        self.assertEqual([n for n in self.left() if not n.startswith(".")], [])


if __name__ == "__main__":
    harness.main()
