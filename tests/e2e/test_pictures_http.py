"""Pictures by HTTP (section 7): frame.png, frame.jpg, and stream.mjpg as browsers, VLC and OpenCV read it."""
import shutil
import subprocess
import time
import unittest

import harness
import pictures
from client import PATIENCE_S, read_http_head
from harness import wait_until
from pictures import Mjpeg, Picture, jpeg_size

SMALL = "width=100&height=100"


class Pictures(pictures.PictureCase):
    def setUp(self):
        super().setUp()
        self.add_growing()

    def get(self, target, method="GET", **headers):
        return self.server.http(method, target, headers=headers or None)

    def mjpeg(self, query=SMALL, scene="main", **kw):
        return self.server.keep(Mjpeg(self.server.port, f"/scenes/{scene}/stream.mjpg?{query}", **kw))

    def counts(self):
        stats = self.c.call("server.stats")
        return stats["tweend_streams"], stats["tweend_producers"]


class Stills(Pictures):
    def test_they_are_those_of_frame_render(self):
        for query, params in (("", {"width": 1280, "height": 720}), (f"?{SMALL}", {}), (f"?{SMALL}&time=0.7", {"time": 0.7}),
                              ("?time=1&height=33&width=77", {"time": 1, "width": 77, "height": 33}), (f"?time=-5e0&{SMALL}&", {"time": 0})):
            status, headers, body = self.get(f"/scenes/main/frame.png{query}")
            self.assertEqual((status, headers["content-type"], int(headers["content-length"])), (200, "image/png", len(body)))
            self.assertEqual(body, self.file(**params), query)
            status, headers, body = self.get(f"/scenes/main/frame.jpg{query}")
            self.assertEqual((status, headers["content-type"]), (200, "image/jpeg"))
            self.assertEqual(body, self.file(format="jpeg", **params), query)
        self.assertEqual(self.get(f"/scenes/main/frame.jpg?{SMALL}&quality=30")[2], self.file(format="jpeg", quality=30))

    def test_they_are_not_kept_by_anyone(self):
        for name in ("png", "jpg"):
            self.assertIn("no-store", self.get(f"/scenes/main/frame.{name}?{SMALL}")[1]["cache-control"])

    def test_without_a_time_they_show_now(self):
        first = self.get(f"/scenes/main/frame.png?{SMALL}")[2]
        self.c.call("playback.seek", time=1)
        now = self.get(f"/scenes/main/frame.png?{SMALL}")[2]
        self.assertNotEqual(now, first)
        self.assertEqual(now, self.file(time=1))

    def test_other_scenes(self):
        self.c.call("scene.create", scene="a.b-c")
        picture = Picture.of_png(self.get(f"/scenes/a.b-c/frame.png?{SMALL}")[2])
        self.assertEqual(picture.shown(), set())
        self.assertEqual(self.get(f"/scenes/a%2Eb-c/frame.png?{SMALL}")[2], self.file(scene="a.b-c"))

    def test_escaped_queries(self):
        self.assertEqual(self.get(f"/scenes/main/frame.png?%74ime=%30%2E5&{SMALL}")[2], self.file(time=0.5))

    def test_head_answers_as_get_without_a_body(self):
        for path in (f"/scenes/main/frame.png?{SMALL}", f"/scenes/main/frame.jpg?{SMALL}&time=1", "/scenes/none/frame.png",
                     "/scenes/main/frame.jpg?width=0"):
            c = self.server.http_client()
            status, headers, _ = c.ask("HEAD", path)
            self.assertEqual(c.ask("GET", path)[:2], (status, headers), path)

    def test_many_on_one_connection(self):
        c = self.server.http_client()
        for i in range(20):
            c.send_raw(c.request_bytes("GET", f"/scenes/main/frame.png?width={10 + i}&height=8"))
        for i in range(20):
            self.assertEqual(Picture.of_png(c.read_answer()[2]).width, 10 + i, "in the order they were asked for")
        self.assertEqual(c.ask("GET", "/healthz")[0], 200)


class Refusals(Pictures):
    STREAM = "stream.mjpg"

    def test_parameters(self):
        queries = ["nope=1", "width=", "width=abc", "width=0", "width=-1", "width=1.5", "width=4097", "height=4097", "quality=0", "quality=101",
                   "quality=high", "scene=main", "scene=other", "width=0x10", "width=1e999", "camera=1", "Width=64", "width%20=64"]
        for leaf in ("frame.png", "frame.jpg", self.STREAM):
            for query in queries + (["rate=0", "rate=241", "kind=vertices", "encoding=png", "time=0"] if leaf == self.STREAM else
                                    ["time=soon", "time=", "time=NaN", "format=png", "rate=5"]):
                status, headers, body = self.get(f"/scenes/main/{leaf}?{query}")
                self.assertEqual((status, headers["content-type"].split(";")[0]), (400, "text/plain"), (leaf, query))
                name = query.split("=")[0].replace("%20", " ")
                self.assertIn(f"params.{name}", body.decode())
        self.assertEqual(self.counts(), (0, 0))

    def test_names_that_are_no_text_are_unknown_parameters(self):
        self.assertEqual(self.get(f"/scenes/main/frame.png?{SMALL}&%ff=1")[0], 400)

    def test_a_parameter_given_twice(self):
        for leaf in ("frame.png", "frame.jpg", self.STREAM):
            c = self.server.http_client()
            c.send_raw(c.request_bytes("GET", f"/scenes/main/{leaf}?{SMALL}&width=8"))
            self.assertEqual(read_http_head(c, time.monotonic() + PATIENCE_S)[0], 400, leaf)

    def test_scenes_and_files_that_are_not_there(self):
        for path in ("none/frame.png", "none/frame.jpg", "none/stream.mjpg", "main/frame.gif", "main/frame", "main/", "main/x/frame.png",
                     "%ff/frame.png", "main%00/frame.png", "../main/frame.png", "/frame.png"):
            status, headers, body = self.get(f"/scenes/{path}?width=8")
            self.assertEqual((status, headers["content-type"].split(";")[0]), (404, "text/plain"), path)
            self.assertTrue(body)

    def test_what_can_only_be_read(self):
        for leaf in ("frame.png", "frame.jpg", self.STREAM):
            for method in ("POST", "PUT", "DELETE"):
                status, headers, _ = self.get(f"/scenes/main/{leaf}", method)
                self.assertEqual(status, 405)
                self.assertIn("GET", headers["allow"])

    def test_hosts(self):
        """What is read may be asked for by any page: an <img> tells no Origin. Names that are not ours may not."""
        for leaf in ("frame.png", "frame.jpg", self.STREAM):
            path = f"/scenes/main/{leaf}?{SMALL}"
            for host in ("evil.example", "localhost.evil.example"):
                self.assertEqual(self.get(path, Host=host)[0], 403, (leaf, host))
        for host in ("localhost", f"127.0.0.1:{self.server.port}", "[::1]:1"):
            self.assertEqual(self.get(f"/scenes/main/frame.png?{SMALL}", Host=host)[0], 200, host)
            self.assertEqual(self.mjpeg(headers={"Host": host}).status, 200, host)

    def test_the_connection_lives_on_after_a_refusal(self):
        c = self.server.http_client()
        for path, status in (("/scenes/main/stream.mjpg?x=1", 400), ("/scenes/none/stream.mjpg", 404), ("/scenes/main/frame.png?x=1", 400),
                             ("/healthz", 200)):
            self.assertEqual(c.ask("GET", path)[0], status)


class Undrawn(harness.TestCase):
    def test_pictures_are_503_and_say_why(self):
        for leaf in ("frame.png", "frame.jpg", "stream.mjpg"):
            status, _, body = self.server.http("GET", f"/scenes/main/{leaf}")
            self.assertEqual(status, 503)
            self.assertIn(b"--no-render", body)
            self.assertEqual(self.server.http("GET", f"/scenes/none/{leaf}")[0], 404)

    def test_it_is_ready_with_and_without(self):
        self.assertEqual(self.server.http("GET", "/readyz")[0], 200)
        self.assertEqual(self.serve(render=True).http("GET", "/readyz")[0], 200)


class Streams(Pictures):
    def test_the_first_picture_comes_at_once_and_then_nothing_until_something_changes(self):
        stream = self.mjpeg()
        self.assertEqual(stream.picture(), self.file(format="jpeg"))
        self.assertTrue(stream.silent())
        for time_s in (0.5, 1, 1.5):
            self.c.call("playback.seek", time=time_s)
            self.assertEqual(stream.picture(), self.file(format="jpeg", time=time_s))
            self.assertTrue(stream.silent(0.05))
        self.c.call("light.set", ambient=0.9)
        self.assertEqual(stream.picture(), self.file(format="jpeg"))

    def test_pictures_while_it_plays(self):
        stream = self.mjpeg("width=64&height=48&rate=60&quality=50")
        self.c.call("playback.play")
        seen = [stream.picture() for _ in range(20)]
        self.assertEqual({jpeg_size(data) for data in seen}, {(64, 48)})
        self.assertGreater(len(set(seen)), 5)

    def test_the_defaults(self):
        stream = self.mjpeg("")
        self.assertEqual(stream.picture(), self.file(width=1280, height=720, format="jpeg", quality=80))

    def test_viewers_share_a_producer_with_streams_of_the_same_parameters(self):
        streams = [self.mjpeg(f"{SMALL}&rate=25&quality=70") for _ in range(3)]
        self.c.call("stream.open", kind="frames", width=100, height=100, rate=25, quality=70)
        payload = self.c.packet().payload
        self.assertEqual({stream.picture() for stream in streams}, {payload})
        self.assertEqual(self.counts(), (4, 1))

    def test_a_client_that_leaves_frees_its_producer(self):
        for leave in ("close", "reset"):
            for playing in (False, True):
                self.c.call("playback.play" if playing else "playback.pause")
                stream = self.mjpeg()
                stream.picture()
                self.assertEqual(self.counts(), (1, 1))
                getattr(stream, leave)()
                wait_until(lambda: self.counts() == (0, 0), "it is freed")

    def test_it_ends_with_its_scene(self):
        self.c.call("scene.create", scene="s")
        streams = [self.mjpeg(scene="s"), self.mjpeg(scene="s")]
        kept = self.mjpeg()
        for stream in (*streams, kept):
            stream.picture()
        self.c.call("scene.remove", scene="s")
        for stream in streams:
            self.assertEqual(stream.ends(), b"")
        wait_until(lambda: self.counts() == (1, 1), "the other is left")
        self.c.call("playback.seek", time=1)
        kept.picture()

    def test_one_that_does_not_read_holds_no_one_up(self):
        stuck = [self.mjpeg("width=640&height=480&quality=100", receive_buffer=8192) for _ in range(4)]
        good = self.mjpeg("width=640&height=480&quality=100")
        good.picture()
        self.c.call("playback.play", speed=0.5)
        wait_until(lambda: self.c.call("server.stats")["tweend_packets_skipped_total"] > 5 or not good.picture(), "pictures are skipped")
        before = self.server.rss_mib()
        for _ in range(25):
            jpeg_size(good.picture())
        self.grew_less(before, 32)
        self.c.call("playback.pause")
        last = self.file(format="jpeg", quality=100, width=640, height=480)
        for stream in (good, *stuck):
            while stream.picture() != last:  # however many are still on their way; behind the last there is silence
                pass

    def test_what_the_client_says_meanwhile_is_of_no_consequence(self):
        stream = self.mjpeg()
        stream.picture()
        stream.send_raw(stream.request_bytes("GET", "/healthz"))
        self.assertTrue(stream.silent())
        self.c.call("playback.seek", time=1)
        self.assertEqual(stream.picture(), self.file(format="jpeg", time=1))

    def test_head_says_what_get_would(self):
        for query, status in ((SMALL, 200), ("width=0", 400), ("x=1", 400)):
            self.assertEqual(self.get(f"/scenes/main/stream.mjpg?{query}", "HEAD")[0], status, query)
        self.assertEqual(self.get("/scenes/none/stream.mjpg", "HEAD")[0], 404)
        self.assertEqual(self.counts(), (0, 0))

    def test_the_server_ends_while_pictures_flow(self):
        self.c.call("playback.play")
        reading = self.mjpeg()
        reading.picture()
        self.mjpeg("width=640&height=480&quality=100", receive_buffer=8192)  # which never reads
        for client in (self.server.line(), self.server.websocket()):
            client.call("stream.open", kind="frames", width=64, height=64)
            client.packet()
        self.server.line(receive_buffer=8192).send("stream.open", kind="frames", encoding="rgba", width=640, height=480)
        self.assertEqual(self.server.stop(), 0)
        reading.ends()

    @unittest.skipUnless(shutil.which("ffmpeg"), "ffmpeg is not installed")
    def test_ffmpeg_reads_it_without_a_complaint(self):
        self.c.call("playback.play", speed=0.5)
        done = subprocess.run(["ffmpeg", "-nostdin", "-v", "warning", "-i", f"http://127.0.0.1:{self.server.port}/scenes/main/stream.mjpg?{SMALL}",
                               "-frames:v", "5", "-f", "null", "-"], capture_output=True, text=True, timeout=60, preexec_fn=harness.die_with_parent)
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))


if __name__ == "__main__":
    harness.main()
