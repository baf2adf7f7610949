"""Streams of pictures (section 6): packets, what they show, who shares a producer, own cameras, and how they end."""
import time

import harness
import pictures
from client import DISCONTINUITY, KEY, LAST, Packet
from harness import wait_until
from pictures import SQUARE, STRAIGHT, Picture, jpeg_size

CODECS = {"jpeg": 0, "png": 1, "rgba": 3}
ASIDE = STRAIGHT | {"eye": [6, 2, 8]}
NOTHING_OPEN = {"tweend_streams": 0, "tweend_producers": 0}


class FrameStreams(pictures.GrowingCase):
    def stats(self):
        return self.other.call("server.stats")

    def quiet(self, client=None):
        """Nothing is sent for a while: what comes next is what is provoked after it, with the next number."""
        client = client or self.c
        until = time.monotonic() + 0.15
        while time.monotonic() < until:
            self.assertEqual([m for m in client.settle() if isinstance(m, Packet)], [])

    def decoded(self, packet, width=100, height=100):
        if packet.encoding == CODECS["png"]:
            return Picture.of_png(packet.payload)
        self.assertEqual(packet.encoding, CODECS["rgba"])
        return Picture.of_rgba(width, height, packet.payload)


class Contents(FrameStreams):
    def first_packet(self, client, **kw):
        """What is answered and the packet that follows at once."""
        id = client.send("stream.open", kind="frames", **kw)
        answer = client.read()
        self.assertEqual(answer["id"], id)
        self.assertEqual(set(answer["result"]), {"stream", "layout"})
        packet = client.read()
        self.assertIsInstance(packet, Packet)
        self.assertEqual(packet.stream, answer["result"]["stream"])
        return answer["result"]["layout"], packet

    def test_the_first_packet_comes_at_once_right_after_the_answer(self):
        self.seek(0.5)
        for client in (self.c, self.server.websocket()):
            for encoding, number in CODECS.items():
                before = self.other.call("server.ping")["time_us"]
                layout, packet = self.first_packet(client, encoding=encoding, rate=0.01, **SQUARE)
                self.assertEqual(layout, {"width": 100, "height": 100, "codec": encoding})
                self.assertEqual((packet.kind, packet.encoding, packet.media_us), (3, number, 500_000))
                self.assertEqual(packet.flags & ~DISCONTINUITY, KEY | LAST)
                self.assertEqual(packet.revision, self.other.call("scene.describe")["revision"])
                self.assertLessEqual(packet.server_us, self.other.call("server.ping")["time_us"])
                if client is self.c:  # who comes later gets what there is
                    self.assertGreaterEqual(packet.server_us, before)

    def test_the_defaults(self):
        layout, packet = self.first_packet(self.c)
        self.assertEqual(layout, {"width": 1280, "height": 720, "codec": "jpeg"})
        self.assertEqual((packet.encoding, jpeg_size(packet.payload)), (0, (1280, 720)))
        self.assertEqual(packet.payload, self.file(width=1280, height=720, format="jpeg", quality=80))

    def test_sizes(self):
        for width, height in ((1, 1), (1, 7), (33, 17), (640, 3)):
            size = {"width": width, "height": height}
            for encoding in CODECS:
                layout, packet = self.first_packet(self.c, encoding=encoding, **size)
                self.assertEqual(layout, size | {"codec": encoding})
                if encoding == "jpeg":
                    self.assertEqual(jpeg_size(packet.payload), (width, height))
                else:
                    self.assertEqual(self.decoded(packet, width, height), self.picture(**size))

    def test_packets_are_what_frame_render_says(self):
        png, jpeg, rgba = self.open(), self.open(encoding="jpeg", quality=55), self.open(encoding="rgba")
        for t in (0.25, 1.5, 0.75):
            self.seek(t)
            for stream, want in ((png, self.file(time=t)), (jpeg, self.file(time=t, format="jpeg", quality=55)), (rgba, None)):
                packet = self.c.packet_where(lambda p: p.media_us == round(t * 1e6), stream)
                if want:
                    self.assertEqual(packet.payload, want)
                else:
                    self.assertEqual(len(packet.payload), 100 * 100 * 4)
                    self.assertEqual(self.decoded(packet), self.picture(time=t))

    def test_rgba_has_the_top_row_first(self):
        self.c.call("actor.update", transform={"translation": [1, 2.5, 0]})
        stream = self.open(encoding="rgba", width=80, height=60)
        picture = self.decoded(self.c.packet(stream), 80, 60)
        left, top, right, bottom = picture.extent()
        self.assertLess(bottom, 30, "it is in the upper half")
        self.assertGreater(left, 39, "and on the right")

    def test_the_media_time_is_that_of_the_named_actor_or_else_of_the_first(self):
        self.add_growing(actor="second")
        first, second = self.open(), self.open(actor="second")
        self.other.call("playback.seek", actor="quad", time=0.5)
        self.other.call("playback.seek", actor="second", time=1.5)
        for stream, media_us in ((first, 500_000), (second, 1_500_000)):
            self.c.packet_where(lambda p: p.media_us == media_us, stream)

    def test_a_scene_without_actors(self):
        self.c.call("scene.create", scene="empty")
        stream = self.open(scene="empty")
        packet = self.c.packet(stream)
        self.assertEqual((packet.media_us, packet.flags & LAST, self.decoded(packet).shown()), (0, LAST, set()))
        self.other.call("actor.add", scene="empty", actor="x", mesh=pictures.QUAD)
        self.assertTrue(self.decoded(self.c.packet(stream)).shown())

    def test_spin_alone_is_movement(self):
        self.c.call("actor.remove", actor="quad")
        self.add_quad()
        self.c.call("actor.update", spin=2)
        self.c.call("playback.play")
        stream = self.open(rate=60)
        packets = [self.c.packet(stream) for _ in range(6)]
        self.assertEqual([p for p in packets if p.flags & LAST], [])
        self.assertGreater(len({p.payload for p in packets}), 2)
        self.other.call("playback.pause")
        last = self.c.packet_where(lambda p: p.flags & LAST, stream)
        self.assertEqual(last.payload, self.file())
        self.quiet()


class Pacing(FrameStreams):
    def test_quiet_after_the_final_state_until_something_changes(self):
        stream = self.open(rate=60)
        sequence = self.c.packet(stream).sequence
        self.quiet()
        for change, params in (("playback.seek", {"time": 0.5}), ("keyframe.update", {"keyframe": 1, "interpolation": "step"}),
                               ("light.set", {"ambient": 0.7}), ("camera.set", {"fov_y": 0.8}), ("scene.update", {"background": [1, 1, 1]}),
                               ("actor.update", {"visible": False}), ("edit.undo", {})):
            self.other.call(change, **params)
            packet = self.c.packet(stream)
            self.assertEqual((packet.sequence, packet.flags), (sequence + 1, KEY | DISCONTINUITY | LAST), change)
            self.assertEqual(packet.payload, self.file())
            self.assertEqual(packet.revision, self.other.call("scene.describe")["revision"])
            self.quiet()
            sequence += 1

    def test_looking_changes_nothing(self):
        stream = self.open()
        self.c.packet(stream)
        self.other.call("frame.render", camera=ASIDE, time=1, **SQUARE)
        self.other.call("vertices.sample")
        self.open(self.other, camera=ASIDE)
        self.quiet()

    def test_the_rate_is_kept_while_it_plays(self):
        self.other.call("playback.play", speed=0.1)
        for rate in (10, 40):
            stream = self.open(rate=rate, encoding="jpeg")
            self.c.packet(stream)
            packets = [self.c.packet(stream) for _ in range(12)]
            span = (packets[-1].server_us - packets[0].server_us) / 1e6
            produced = packets[-1].sequence - packets[0].sequence
            self.assertLessEqual(produced, span * rate + 1.5, f"never more than {rate} a second")
            self.assertLessEqual(self.paced(packets, rate), 4, "and not far fewer")
            sequences = [p.sequence for p in packets]
            self.assertEqual(sequences, sorted(set(sequences)))
            self.c.call("stream.close", stream=stream)

    def test_media_and_server_time_while_it_plays(self):
        stream = self.open(rate=60, encoding="rgba", width=16, height=16)
        start_us = self.other.call("playback.play", time=0, speed=0.5)["server_time_us"]
        self.c.packet_where(lambda p: p.server_us > start_us, stream)
        for _ in range(20):
            packet = self.c.packet(stream)
            self.assertAlmostEqual(packet.media_us, (packet.server_us - start_us) / 2 % 2_000_000, delta=2)
            self.assertEqual(packet.flags & (KEY | LAST), KEY)
            self.assertLessEqual(packet.server_us, self.other.call("server.ping")["time_us"])

    def test_while_it_plays_the_picture_is_that_of_its_media_time(self):
        self.c.call("light.set", **pictures.EVEN)
        self.other.call("playback.play", speed=0.5)
        stream = self.open(rate=30)
        for packet in [self.c.packet(stream) for _ in range(8)]:
            half = max(self.other.call("vertices.sample", time=packet.media_us / 1e6)["positions"])
            self.spans(self.decoded(packet), (50 - 10 * half, 50 - 10 * half, 50 + 10 * half, 50 + 10 * half))

    def test_fast_seeks_end_with_the_last_one(self):
        stream = self.open(rate=20)
        for i in range(200):
            self.other.send("playback.seek", time=(i % 100) / 50)
        self.other.settle()
        self.seek(1.77)
        packet = self.c.packet_where(lambda p: p.media_us == 1_770_000 and p.flags & LAST, stream)
        self.assertEqual(packet.payload, self.file(time=1.77))
        self.quiet()

    def test_ended_is_told_after_the_final_picture(self):
        stream = self.open(rate=30)
        self.c.call("events.subscribe")
        for _ in range(3):
            self.other.call("playback.play", time=0, speed=10, loop="once")
            ended = self.c.event("playback.ended")
            self.assertEqual(ended["actor"], "quad")
            final = [m for m in self.c.unread if isinstance(m, Packet)][-1]
            self.assertEqual((final.stream, final.media_us, final.flags & LAST), (stream, 2_000_000, LAST))
            self.c.unread.clear()


class Refusals(FrameStreams):
    def refused_open(self, code, path, **kw):
        self.refused(code, "stream.open", path=f"params.{path}", **{"kind": "frames"} | kw)

    def tearDown(self):
        # A producer stops on the stage's thread, after its reader's close has been answered.
        wait_until(lambda: self.stats().items() >= NOTHING_OPEN.items(), "no stream and no producer is left")
        super().tearDown()

    def test_what_is_no_picture(self):
        for name in ("width", "height"):
            self.refused_open(-32004, name, **{name: 4097})
            for value in (0, -1, 1.5, "8"):
                self.refused_open(-32602, name, **{name: value})
        for value in (0, 101, 50.5):
            self.refused_open(-32602, "quality", quality=value)
        for rate in (0, -1, 241):
            self.refused_open(-32602, "rate", rate=rate)
        for encoding in ("f32", "gif", "jpg", ""):
            self.refused_open(-32602, "encoding", encoding=encoding)

    def test_scenes_actors_and_cameras(self):
        self.refused_open(-32001, "scene", scene="none")
        self.refused_open(-32001, "actor", actor="none")
        self.refused_open(-32602, "camera.eye", camera={"eye": [1, 1, 1], "target": [1, 1, 1]})
        self.refused_open(-32602, "camera.x", camera={"x": 1})
        self.refused_open(-32602, "camera", camera=None)

    def test_what_is_of_frames_is_refused_of_vertices(self):
        for name, value in (("width", 64), ("height", 64), ("quality", 50), ("camera", {"fit": True}), ("encoding", "jpeg"), ("encoding", "rgba")):
            self.refused(-32602, "stream.open", path=f"params.{name}", kind="vertices", **{name: value})

    def test_a_camera_for_a_stream_of_vertices(self):
        stream = self.c.call("stream.open", kind="vertices")["stream"]
        for camera in ({"fit": True}, None):
            self.refused(-32602, "stream.update", path="params.camera", stream=stream, camera=camera)
        self.c.call("stream.close", stream=stream)


class Ends(FrameStreams):
    def ended(self, stream, client=None):
        event = (client or self.c).event("stream.ended", stream=stream)
        self.assertTrue(event["reason"])

    def test_with_the_scene(self):
        self.c.call("scene.create", scene="s")
        ws = self.server.websocket()
        gone = [(self.c, self.open(scene="s")), (self.c, self.open(scene="s", camera=ASIDE)), (ws, self.open(ws, scene="s"))]
        kept = self.open()
        self.c.packet(kept)
        self.other.call("scene.remove", scene="s")
        for client, stream in gone:
            self.ended(stream, client)
            self.refused(-32001, "stream.close", by=client, path="params.stream", stream=stream)
        self.seek(1)
        self.c.packet_where(lambda p: p.media_us == 1_000_000, kept)
        self.assertEqual(self.stats()["tweend_producers"], 1)

    def test_with_the_actor_it_names_and_no_other(self):
        self.add_growing(actor="second")
        named, unnamed = self.open(actor="second"), self.open()
        self.c.packet(named)
        before = self.c.packet(unnamed)
        self.other.call("actor.remove", actor="second")
        self.ended(named)
        self.other.call("actor.remove", actor="quad")
        packet = self.c.packet_where(lambda p: p.revision == before.revision + 2, unnamed)
        self.assertEqual(self.decoded(packet).shown(), set())

    def test_close(self):
        stream = self.open(rate=60)
        self.other.call("playback.play")
        self.c.packet(stream)
        self.assertEqual(self.c.call("stream.close", stream=stream), {})
        self.c.unread.clear()
        self.quiet()
        self.refused(-32001, "stream.close", path="params.stream", stream=stream)
        wait_until(lambda: self.stats()["tweend_producers"] == 0, "the producer is gone")

    def test_clients_that_leave_while_pictures_are_in_the_making(self):
        self.other.call("playback.play")
        for i in range(20):
            c = self.server.line()
            c.send("stream.open", kind="frames", width=400, height=300, rate=240 - i % 3)
            if i % 2:
                c.packet()
            getattr(c, "reset" if i % 3 else "close")()
        wait_until(lambda: (self.stats()["tweend_streams"], self.stats()["tweend_producers"]) == (0, 0), "all is gone")
        self.c.packet(self.open())


if __name__ == "__main__":
    harness.main()
