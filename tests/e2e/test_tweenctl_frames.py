"""tweenctl frame and tweenctl watch frames against a running server."""
import json
import os
import subprocess

import harness
import pictures
from films import Film, decode_h264, distance
from harness import TWEENCTL
from pictures import STRAIGHT, Picture, jpeg_size


class Frames(pictures.PictureCase):
    def setUp(self):
        super().setUp()
        self.add_growing()
        self.c.call("camera.set", **STRAIGHT)
        self.out = self.folder()

    def run_ctl(self, *arguments, code=0, port=None):
        done = subprocess.run([TWEENCTL, "--server", f"127.0.0.1:{port or self.server.port}", *map(str, arguments)], capture_output=True,
                              timeout=60, preexec_fn=harness.die_with_parent)
        self.assertEqual(done.returncode, code, f"{arguments}: {done.stdout[:300]}{done.stderr}")
        return done

    def ctl(self, *arguments, **kw):
        """What it prints."""
        return self.run_ctl(*arguments, **kw).stdout.decode()

    def refused_ctl(self, code, *arguments, **kw):
        """What is wrong is told in one line."""
        error = self.run_ctl(*arguments, code=code, **kw).stderr.decode()
        self.assertRegex(error, r"\A[^\n]+\n\Z", arguments)
        return error

    def path(self, name):
        return os.path.join(self.out, name)

    def read(self, name):
        with open(self.path(name), "rb") as f:
            return f.read()

    def test_a_picture_into_a_file(self):
        self.ctl("frame", self.path("a.png"))
        self.assertEqual(self.read("a.png"), self.file(width=1280, height=720))
        self.ctl("frame", self.path("a.jpg"), "--size", "64x48", "--quality", 40)
        self.assertEqual(self.read("a.jpg"), self.file(width=64, height=48, format="jpeg", quality=40))
        self.ctl("frame", self.path("b.png"), "--width", 30, "--height", 20, "--time", 0.5)
        self.assertEqual(self.read("b.png"), self.file(width=30, height=20, time=0.5))
        self.ctl("frame", self.path("b.png"), "--width", 31, "--height", 20)
        self.assertEqual(Picture.of_png(self.read("b.png")).width, 31, "an earlier file is replaced")

    def test_a_picture_to_standard_output(self):
        done = self.run_ctl("frame", "-", "--size", "40x30", "--time", 1)
        self.assertEqual(done.stdout, self.file(width=40, height=30, time=1))
        self.assertEqual(done.stderr, b"")

    def test_a_camera_of_one_s_own(self):
        for options, camera in ((["--fit"], {"fit": True}), (["--eye", "3,1,9", "--target", "0,1,0"], {"eye": [3, 1, 9], "target": [0, 1, 0]}),
                                (["--orbit", "1,0.5,15"], {"orbit": {"azimuth": 1, "elevation": 0.5, "distance": 15}}),
                                (["--fov-y", 0.5, "--up", "1,0,0"], {"fov_y": 0.5, "up": [1, 0, 0]})):
            self.ctl("frame", self.path("a.png"), "--size", "100x100", *options)
            self.assertEqual(self.read("a.png"), self.file(camera=camera), options)
        self.assertEqual(self.c.call("scene.describe")["camera"]["eye"], STRAIGHT["eye"])

    def test_another_scene(self):
        self.ctl("scene", "create", "two")
        self.ctl("--scene", "two", "frame", self.path("a.png"), "--size", "20x20")
        self.assertEqual(Picture.of_png(self.read("a.png")).shown(), set())

    def test_what_is_refused_leaves_no_file(self):
        self.refused_ctl(1, "--scene", "none", "frame", self.path("a.png"))
        self.refused_ctl(1, "frame", self.path("a.png"), "--width", 5000)
        self.refused_ctl(2, "frame", self.path("a.gif"))
        self.refused_ctl(1, "frame", self.path("a.png"), "--quality", 0)
        self.refused_ctl(1, "frame", self.path("none/a.png"), "--size", "8x8")
        self.assertEqual(os.listdir(self.out), [])
        error = self.refused_ctl(1, "frame", self.path("a.png"), port=self.serve().port)
        self.assertIn("--no-render", error)
        self.assertEqual(os.listdir(self.out), [])

    def test_watching_pictures_go_by(self):
        self.c.call("playback.play", speed=0.5)
        lines = self.ctl("watch", "frames", "--count", 5, "--size", "64x48").splitlines()
        self.assertEqual(len(lines), 5)
        for line in lines:
            self.assertRegex(line, r"^#\d+ ")

    def test_storing_them(self):
        self.c.call("playback.play", speed=3)
        self.ctl("watch", "frames", "-o", self.out, "--count", 5, "--size", "64x48")
        names = sorted(os.listdir(self.out))
        self.assertEqual(len(names), 5)
        for name in names:
            self.assertRegex(name, r"^frame_\d+\.jpg$")
            self.assertEqual(jpeg_size(self.read(name)), (64, 48))
        self.assertGreater(len({self.read(name) for name in names}), 1, "they move")

    def test_storing_the_one_that_shows_what_stands_still(self):
        self.c.call("playback.seek", time=1)
        made = self.path("new/folder")
        self.ctl("watch", "frames", "-o", made, "--count", 1, "--encoding", "png", "--size", "100x100", "--fit")
        name, = os.listdir(made)
        self.assertEqual(self.read(f"new/folder/{name}"), self.file(camera={"fit": True}))

    def test_video_into_a_file(self):
        self.skip_without_h264()
        self.c.call("playback.play", speed=0.5)
        said = self.ctl("watch", "frames", "--encoding", "h264", "-o", self.path("a.h264"), "--count", 12, "--size", "64x48")
        self.assertIn("a.h264: 12 frames, ", said)
        self.assertEqual(self.read("a.h264")[:3], b"\0\0\0", "Annex B begins with a start code")
        self.assertEqual(len(decode_h264(self.read("a.h264"), 64, 48)), 12)

    def test_video_to_standard_output(self):
        self.skip_without_h264()
        done = self.run_ctl("watch", "frames", "--encoding", "h264", "-o", "-", "--count", 1, "--size", "64x48")
        self.assertRegex(done.stderr.decode(), r"\A-: 1 frame, [^\n]+\n\Z")
        raw = self.run_ctl("watch", "frames", "--encoding", "rgba", "-o", "-", "--count", 1, "--size", "64x48").stdout
        self.assertEqual(len(raw), 64 * 48 * 4)
        shown, = decode_h264(done.stdout, 64, 48)
        self.assertLess(distance(shown, Picture.of_rgba(64, 48, raw)), 6, "they show the same")

    def test_a_recording(self):
        self.skip_without_h264()
        assets = self.folder()
        port = self.serve(assets=[assets], render=True).port
        started = json.loads(self.ctl("--json", "record", "start", "walk.mp4", "--size", "64x48", port=port))["record"]
        self.assertRegex(self.ctl("record", "start", "walk", "--size", "64x48", port=port), "^recording [0-9]+ to walk: ")
        self.assertRegex(self.ctl("record", "stop", started, port=port), "^walk.mp4 saved: [1-9][0-9]* pictures, [1-9][0-9]* bytes\n$")
        self.assertEqual(Film(os.path.join(assets, "walk.mp4")).size, (64, 48))
        self.ctl("record", "stop", started + 1, port=port)
        self.assertIn("frame_000000.png", os.listdir(os.path.join(assets, "walk")))
        for name in ("film.avi", "film.mp"):
            self.assertIn("expected a name that ends with .mp4", self.refused_ctl(1, "record", "start", name, port=port))
        self.assertEqual(sorted(os.listdir(assets)), ["walk", "walk.mp4"])

    def test_what_the_server_knows_better(self):
        error = self.refused_ctl(1, "watch", "frames", "--encoding", "h264", "--size", "65x48", "-o", self.path("a.h264"))
        self.assertRegex(error, "params.width|without")
        self.refused_ctl(1, "watch", "frames", "--bitrate", 100000)
        self.refused_ctl(1, "watch", "frames", "--encoding", "png", "--adaptive")
        self.assertEqual(os.listdir(self.out), [])

    def test_watching_where_nothing_is_drawn(self):
        error = self.refused_ctl(1, "watch", "frames", "--count", 1, port=self.serve().port)
        self.assertIn("--no-render", error)

    def test_as_json(self):
        self.c.call("playback.play", speed=0.5)
        for line in self.ctl("--json", "watch", "frames", "--count", 3, "--size", "16x16").splitlines():
            self.assertIsInstance(json.loads(line), dict)


if __name__ == "__main__":
    harness.main()
