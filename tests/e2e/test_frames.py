"""frame.render (section 5): files, sizes, times, the viewer's own camera, and what is refused."""
import math

import harness
import pictures
from pictures import BACKGROUND, BASE, SQUARE, STRAIGHT, Picture, jpeg_size

HALF_TURN = {"orbit": {"azimuth": math.pi / 2, "elevation": 0.3, "distance": 12}}


class Files(pictures.PictureCase):
    def setUp(self):
        super().setUp()
        self.add_quad()
        self.straight()

    def test_png_is_the_default_and_its_size_that_of_the_answer(self):
        answer = self.c.call("frame.render")
        self.assertEqual((answer["width"], answer["height"], answer["format"], answer["time"]), (1280, 720, "png", 0))
        picture = Picture.of_png(self.file(width=1280, height=720))
        self.assertEqual((picture.width, picture.height), (1280, 720))
        self.coloured(picture, 640, 360, BASE)
        self.coloured(picture, 0, 0, BACKGROUND)

    def test_sizes(self):
        self.c.call("actor.update", transform={"scale": [1000, 1000, 1]})
        for width, height in ((1, 1), (1, 50), (50, 1), (3, 5), (33, 17), (127, 129), (640, 2), (2, 640)):
            picture = self.picture(width=width, height=height)
            self.assertEqual((picture.width, picture.height), (width, height))
            self.coloured(picture, width // 2, height // 2, BASE)
            self.assertEqual(jpeg_size(self.file(width=width, height=height, format="jpeg")), (width, height))

    def test_one_side_alone(self):
        for given, size in (({"width": 64}, (64, 720)), ({"height": 48}, (1280, 48))):
            answer = self.c.call("frame.render", **given)
            self.assertEqual((answer["width"], answer["height"]), size)

    def test_a_picture_of_the_largest_width(self):
        picture = self.picture(width=4096, height=16)
        self.assertEqual((picture.width, picture.height), (4096, 16))

    def test_the_answer_says_what_format_it_has(self):
        for given, said in (({}, "png"), ({"format": "png"}, "png"), ({"format": "jpeg"}, "jpeg")):
            self.assertEqual(self.c.call("frame.render", **SQUARE | given)["format"], said)

    def test_a_higher_quality_takes_more_bytes(self):
        sizes = [len(self.file(format="jpeg", quality=q)) for q in (1, 20, 80, 100)]
        self.assertEqual(sizes, sorted(set(sizes)))
        self.assertEqual(self.file(format="jpeg"), self.file(format="jpeg", quality=80))

    def test_the_side_of_a_picture_can_be_limited(self):
        server = self.serve("--max-frame-side", 64, render=True)
        c = server.line()
        self.assertEqual(c.call("frame.render", width=64, height=64)["width"], 64)
        self.refused(-32004, "frame.render", by=c, path="params.height", width=64, height=65)
        self.refused(-32004, "frame.render", by=c, path="params.width")

    def test_pictures_of_many_sizes_are_not_kept(self):
        def ask(count):
            for i in range(count):
                self.c.call("frame.render", width=100 + 7 * i % 300, height=100 + 11 * i % 300)
        ask(40)
        before = self.server.rss_mib()
        ask(200)
        self.grew_less(before, 24)

    def test_the_server_says_what_it_draws(self):
        capabilities = self.c.call("server.hello")["capabilities"]
        self.assertLessEqual({"frames:jpeg", "frames:png", "frames:rgba"}, set(capabilities))

    def test_pictures_asked_for_at_once_are_answered_in_order(self):
        ids = [self.c.send("frame.render", width=8 + i, height=8) for i in range(40)]
        self.assertEqual([self.c.read()["id"] for _ in ids], ids)

    def test_pictures_over_a_websocket_and_post_are_the_same(self):
        want = self.file()
        self.assertEqual(self.file(client=self.server.websocket()), want)
        answer = self.server.http_client().rpc({"jsonrpc": "2.0", "id": 1, "method": "frame.render", "params": SQUARE})
        self.assertEqual(answer["result"], self.c.call("frame.render", **SQUARE))


class Refusals(pictures.PictureCase):
    def test_sizes_that_are_none_and_sizes_beyond_the_limit(self):
        for name in ("width", "height"):
            self.refused(-32004, "frame.render", path=f"params.{name}", **{name: 4097})
            self.refused(-32004, "frame.render", path=f"params.{name}", **{name: 10 ** 15})
            for value in (0, -1, -4096, 1.5, "64", None):
                self.refused(-32602, "frame.render", path=f"params.{name}", **{name: value})

    def test_qualities_and_formats(self):
        for value in (0, -1, 101, 80.5, "80"):
            self.refused(-32602, "frame.render", path="params.quality", quality=value, format="jpeg")
        for value in ("jpg", "PNG", "rgba", "", None):
            self.refused(-32602, "frame.render", path="params.format", format=value)

    def test_scenes_that_are_not_there(self):
        self.refused(-32001, "frame.render", path="params.scene", scene="none")

    def test_cameras_that_can_show_nothing(self):
        for camera, path in (({"eye": [1, 2, 3], "target": [1, 2, 3]}, "eye"), ({"up": [0, 0, 0]}, "up"),
                             ({"eye": [0, 5, 0], "target": [0, 0, 0], "up": [0, 1, 0]}, "up"), ({"near": 9, "far": 8}, "near")):
            self.refused(-32602, "frame.render", path=f"params.camera.{path}", camera=camera, **SQUARE)

    def test_cameras_that_are_none(self):
        for camera, path in (({"x": 1}, ".x"), ({"eye": [0, 1]}, ".eye"), ({"eye": [0, 1, "2"]}, ".eye[2]"), ({"fov_y": 0}, ".fov_y"),
                             ({"near": 0}, ".near"), ({"far": -1}, ".far"), ({"fit": 1}, ".fit"), ({"orbit": {}}, ".orbit.azimuth"),
                             ({"orbit": {"azimuth": 0, "elevation": 0, "y": 1}}, ".orbit.y"),
                             ({"orbit": {"azimuth": 0, "elevation": 0, "distance": 0}}, ".orbit.distance"),
                             ({"eye": [0, 1, 2], "orbit": {"azimuth": 0, "elevation": 0}}, ".orbit"), (None, ""), ([], ""), ("main", "")):
            self.refused(-32602, "frame.render", path=f"params.camera{path}", camera=camera, **SQUARE)

    def test_nothing_of_it_is_an_edit(self):
        self.add_quad()
        with self.unchanged():
            for params in ({}, {"camera": HALF_TURN}, {"camera": {"fit": True}}, {"time": 3}, {"width": 0}, {"camera": {"x": 1}}):
                try:
                    self.c.call("frame.render", **SQUARE | params)
                except harness.RpcError:
                    pass
        self.refused(-32602, "frame.render", path="params.base_revision", base_revision=1)
        self.refused(-32602, "frame.render", path="params.actor", actor="quad")


class Times(pictures.PictureCase):
    def setUp(self):
        super().setUp()
        self.add_growing()
        self.straight()

    def test_the_time_is_clamped_and_answered(self):
        for asked, answered in ((0.5, 0.5), (0, 0), (-3, 0), (2, 2), (7, 2), (1e300, 2)):
            self.assertEqual(self.c.call("frame.render", time=asked, **SQUARE)["time"], answered)
        self.assertEqual(self.file(time=-3), self.file(time=0))
        self.assertEqual(self.file(time=7), self.file(time=2))

    def test_the_time_answered_is_that_of_the_first_actor(self):
        self.add_growing(actor="short", keys=((0, 1), (0.5, 2)))
        self.c.call("playback.seek", actor="short", time=0.25)
        self.c.call("playback.seek", actor="quad", time=1.5)
        self.assertEqual(self.c.call("frame.render", **SQUARE)["time"], 1.5)
        self.assertEqual(self.c.call("frame.render", time=1.75, **SQUARE)["time"], 1.75)

    def test_a_scene_without_actors_has_the_time_0(self):
        self.c.call("scene.create", scene="empty")
        answer = self.c.call("frame.render", scene="empty", time=5, **SQUARE)
        self.assertEqual(answer["time"], 0)
        self.assertEqual(self.picture(scene="empty").shown(), set())

    def test_the_same_again_is_the_same_bytes(self):
        for params in ({"time": 0.3}, {"time": 1.7, "camera": HALF_TURN}, {"time": 1, "format": "jpeg"}, {}):
            first = self.file(**params)
            for _ in range(3):
                self.assertEqual(self.file(**params), first)
        self.assertEqual(self.file(client=self.server.line(), time=0.3), self.file(time=0.3))

    def test_without_a_time_it_is_what_is_shown_now(self):
        for time in (0.25, 1.5, 2, 0):
            self.c.call("playback.seek", time=time)
            answer = self.c.call("frame.render", **SQUARE)
            self.assertEqual(answer, self.c.call("frame.render", time=time, **SQUARE))
            self.assertEqual(answer["time"], time)

    def test_while_it_plays_the_time_answered_is_the_picture_s(self):
        start_us = self.c.call("playback.play", time=0, speed=0.05)["server_time_us"]
        for _ in range(5):
            before = self.c.call("server.ping")["time_us"]
            answer = self.c.call("frame.render", **SQUARE)
            after = self.c.call("server.ping")["time_us"]
            self.assertLessEqual((before - start_us) * 0.05e-6, answer["time"] + 2e-6)
            self.assertGreaterEqual((after - start_us) * 0.05e-6, answer["time"] - 2e-6)
            again = self.c.call("frame.render", time=answer["time"], **SQUARE)
            self.assertEqual(again["base64"], answer["base64"])

    def test_a_time_shows_without_the_spin(self):
        still = self.file(time=0)
        self.c.call("actor.update", spin=3)
        self.c.call("playback.play", speed=0.0001)
        harness.wait_until(lambda: self.picture().differing(Picture.of_png(still)) > 0.02, "it turns")
        self.assertEqual(self.file(time=0), still)
        self.c.call("playback.pause")
        self.assertNotEqual(self.file(), still)
        self.assertEqual(self.file(), self.file(), "what is paused turns no further")

    def test_a_time_shows_the_clip_of_the_player(self):
        self.c.call("clip.create", clip="other", keys=[3, 2], duration=1)
        first = self.file(time=0)
        self.c.call("playback.play", clip="other")
        self.c.call("playback.pause")
        self.assertNotEqual(self.file(time=0), first)
        self.spans(self.picture(time=0), (30, 30, 70, 70))


class OwnCameras(pictures.PictureCase):
    def setUp(self):
        super().setUp()
        self.add_growing(actor="tri")
        self.c.call("light.set", ambient=1)
        self.before = self.c.call("scene.describe")

    def tearDown(self):
        self.assertEqual(self.c.call("scene.describe"), self.before, "a viewer's camera is no edit")
        super().tearDown()

    def test_eye_and_target(self):
        self.assertNotEqual(self.file(camera={"eye": [3, 1, 8]}), self.file())
        self.assertNotEqual(self.file(camera={"target": [1, 1, 0]}), self.file())
        self.spans(self.picture(camera=STRAIGHT), (40, 40, 60, 60))
        self.spans(self.picture(camera=STRAIGHT | {"eye": [0, 0, 20]}), (45, 45, 55, 55))
        self.spans(self.picture(camera=STRAIGHT | {"eye": [2, 0, 10], "target": [2, 0, 0]}), (20, 40, 40, 60))

    def test_what_is_left_out_is_the_scene_s(self):
        camera = self.before["camera"]
        self.assertEqual(self.file(camera={}), self.file())
        self.assertEqual(self.file(camera={"eye": camera["eye"]}), self.file())
        self.assertEqual(self.file(camera=camera), self.file())

    def test_orbit(self):
        straight = self.picture(camera=STRAIGHT)
        around = {"orbit": {"azimuth": 0, "elevation": 0, "distance": 10, "target": [0, 0, 0]}, "fov_y": STRAIGHT["fov_y"]}
        self.assertLess(straight.differing(self.picture(camera=around), by=2), 0.005)
        sixty = {"orbit": {"azimuth": math.pi / 3, "elevation": 0, "distance": 10}, "fov_y": STRAIGHT["fov_y"]}
        left, top, right, bottom = self.picture(camera=sixty).extent()
        self.assertLess(right - left, 14, "half as wide from there")
        self.assertGreaterEqual(bottom - top, 19)

    def test_up_and_fov(self):
        self.c.call("playback.seek", time=0)
        self.before = self.c.call("scene.describe")
        self.spans(self.picture(camera=STRAIGHT | {"fov_y": 2 * math.atan(0.25)}), (30, 30, 70, 70))
        turned = self.picture(camera=STRAIGHT | {"up": [1, 1, 0]}).extent()
        self.assertGreater(turned[2] - turned[0], 26, "on its corner")

    def test_near_and_far(self):
        self.assertEqual(self.picture(camera=STRAIGHT | {"far": 9.9}).shown(), set())
        self.assertEqual(self.picture(camera=STRAIGHT | {"near": 10.1}).shown(), set())
        self.assertTrue(self.picture(camera=STRAIGHT | {"near": 9.9, "far": 10.1}).shown())

    def test_fit(self):
        for camera in ({"fit": True}, {"eye": [500, 300, 900], "fit": True}, {"eye": [0, 0.1, 1], "fit": True}):
            for time in (0, 1, 2):
                picture = self.picture(camera=camera, time=time)
                self.assertTrue(picture.shown())
                self.assertTrue(picture.edge_is_clear())


class Undrawn(harness.TestCase):
    """A server that was told to draw nothing."""

    def test_pictures_are_refused_and_the_message_says_why(self):
        for method, params in (("frame.render", {}), ("frame.render", {"format": "jpeg", "width": 8, "height": 8}),
                               ("stream.open", {"kind": "frames"})):
            self.assertIn("--no-render", self.refused(-32006, method, **params).message)
        self.refused(-32001, "frame.render", path="params.scene", scene="none")
        self.refused(-32602, "frame.render", path="params.width", width=0)

    def test_it_does_not_say_that_it_draws(self):
        self.assertEqual([c for c in self.c.call("server.hello")["capabilities"] if c.startswith("frames")], [])

    def test_everything_else_works(self):
        self.add_moving()
        stream = self.c.call("stream.open", kind="vertices")["stream"]
        self.c.call("playback.seek", time=1)
        packet = self.c.packet_where(lambda p: p.media_us == 1_000_000, stream)
        self.assertEqual(packet.positions(), harness.lifted(1))
        self.c.call("camera.set", fit=True)
        self.assertEqual(self.c.call("vertices.sample")["positions"], harness.lifted(1))


if __name__ == "__main__":
    harness.main()
