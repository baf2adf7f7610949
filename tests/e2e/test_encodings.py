"""Encodings of streams (section 6): what they decode to, which packets are keys, and who gets which."""
import math
import os
import struct

import harness
import pictures
from client import DISCONTINUITY, KEY, LAST
from films import decode_h264
from harness import wait_until
from pictures import SIDE, SQUARE

ARM = {"joints": [{"name": "root"}, {"name": "elbow", "parent": "root", "translation": [0, 1, 0]},
                  {"name": "hand", "parent": "elbow", "translation": [0, 0.5, 0]}]}


class Encodings(harness.TestCase):
    def add_arm(self):
        self.c.call("actor.add", actor="arm", skeleton=ARM)
        for angle in (0.0, 1.0):
            half = angle / 2
            turn = [0, 0, math.sin(half), math.cos(half)]
            self.c.call("keyframe.add", actor="arm", pose={"elbow": {"rotation": turn}, "root": {"translation": [angle, 0, 0]}})

    def test_what_may_be_asked_for(self):
        self.add_arm()
        self.add_triangle()
        for kind, encoding in (("pose", "meshopt"), ("pose", "jpeg"), ("vertices", "h264"), ("frames", "q16"), ("frames", "f32")):
            self.refused(-32602, "stream.open", path="params.encoding", kind=kind, actor="arm" if kind == "pose" else "tri",
                         encoding=encoding)
        self.refused(-32602, "stream.open", path="params.bitrate", kind="vertices", actor="tri", bitrate=100_000)
        self.refused(-32602, "stream.open", path="params.bitrate", kind="frames", encoding="h264", bitrate=100)
        for params in ({"kind": "vertices", "actor": "tri"}, {"kind": "pose", "actor": "arm"}, {"kind": "vertices", "encoding": "q16", "actor": "tri"}):
            self.refused(-32602, "stream.open", path="params.adaptive", adaptive=True, **params)
            self.c.call("stream.open", adaptive=False, **params)
        self.refused(-32602, "stream.open", path="params.adaptive", kind="frames", encoding="png", adaptive=True)
        self.refused(-32001, "stream.request_key", path="params.stream", stream=7)

    def test_q16_vertices_are_within_their_error(self):
        self.add_moving(keys=3)
        exact = self.c.call("stream.open", kind="vertices")["stream"]
        opened = self.c.call("stream.open", kind="vertices", encoding="q16")
        for t in (0.25, 1.5):
            self.c.call("playback.seek", time=t)
            want = self.c.packet_where(lambda p: p.media_us == t * 1e6, exact).positions()
            packet = self.c.packet_where(lambda p: p.media_us == t * 1e6, opened["stream"])
            self.assertEqual((packet.encoding, packet.flags & KEY), (1, KEY))
            n = opened["layout"]["vertices"]
            bounds = struct.unpack_from("<6f", packet.payload)
            extent = bounds[3:]
            quantised = struct.unpack_from(f"<{3 * n}H", packet.payload, 24)
            got = [bounds[i % 3] + q / 65535 * extent[i % 3] for i, q in enumerate(quantised)]
            self.near(got, want, max(extent) / 65535 * 0.51 + 1e-6)

    def test_q16_poses_leave_out_what_does_not_change(self):
        self.add_arm()
        stream = self.c.call("stream.open", kind="pose", encoding="q16", rate=60)["stream"]
        first = self.c.packet(stream)
        self.assertEqual((first.encoding, first.flags & (KEY | LAST)), (1, KEY | LAST))
        self.c.call("playback.play", speed=0.1)
        packets = [self.c.packet(stream) for _ in range(90)]
        keys = [p for p in packets if p.flags & KEY]
        others = [p for p in packets if not p.flags & KEY]
        self.assertGreater(len(others), 60)
        self.assertGreaterEqual(len(keys), 1)
        self.assertLess(max(len(p.payload) for p in others), min(len(p.payload) for p in keys))
        self.c.call("playback.pause")
        last = self.c.packet_where(lambda p: p.flags & LAST, stream)
        self.assertTrue(last.flags & KEY, "what is shown last decodes on its own")
        late = self.server.line()
        again = late.call("stream.open", kind="pose", encoding="q16", rate=60)["stream"]
        packet = late.packet(again)
        self.assertEqual((packet.payload, packet.server_us), (last.payload, last.server_us))

    def test_a_seek_does_not_make_the_steps_of_q16_poses_coarse(self):
        self.c.call("actor.add", actor="arm", skeleton=ARM)
        for x in (1, 1001):
            self.c.call("keyframe.add", actor="arm", pose={"root": {"translation": [x, 0, 0]}})
        stream = self.c.call("stream.open", kind="pose", encoding="q16")["stream"]
        for t, x in ((0, 1), (1, 1001), (0, 1)):
            self.c.call("playback.seek", time=t)
            packet = self.c.packet_where(lambda p: p.media_us == t * 1e6, stream)
            sections, of_joints, *base, exponent = struct.unpack_from("<BB3fb", packet.payload)
            self.assertEqual((sections & 1, of_joints & 1, base), (1, 1, [x, 0, 0]))
            self.assertEqual(exponent, -17, "what it was at rest")

    def test_whoever_joins_a_moving_stream_begins_with_a_key(self):
        self.add_arm()
        self.c.call("playback.play", speed=0.01)
        stream = self.c.call("stream.open", kind="pose", encoding="q16")["stream"]
        self.c.packet_where(lambda p: not p.flags & KEY, stream)
        for _ in range(3):
            late = self.server.line()
            joined = late.call("stream.open", kind="pose", encoding="q16")["stream"]
            self.assertTrue(late.packet(joined).flags & KEY)
            late.close()

    def test_a_key_that_is_asked_for(self):
        self.add_arm()
        stream = self.c.call("stream.open", kind="pose", encoding="q16")["stream"]
        first = self.c.packet(stream)
        self.c.call("stream.request_key", stream=stream)
        again = self.c.packet(stream)
        self.assertEqual((again.sequence, again.payload), (first.sequence + 1, first.payload))
        self.c.call("playback.play", speed=0.01)
        self.c.packet_where(lambda p: not p.flags & KEY, stream)
        self.c.call("stream.request_key", stream=stream)
        self.c.packet_where(lambda p: p.flags & KEY, stream)

    def test_figures_of_each_stream(self):
        self.add_moving()
        stream = self.c.call("stream.open", kind="vertices", encoding="q16")["stream"]
        self.c.packet(stream)
        labels = 'scene="main",kind="vertices",actor="tri",encoding="q16"'

        def figure(name):
            return [v for k, v in self.c.call("server.stats").items() if k.startswith(f"tweend_stream_{name}{{") and labels in k]
        self.assertEqual((figure("readers"), figure("produced_total")), ([1], [1]))
        wait_until(lambda: figure("sent_total") == [1], "the packet is counted")
        self.assertEqual(figure("queued"), [0])
        wait_until(lambda: self.c.call("server.stats")["tweend_packet_delay_seconds_count"] == 1, "its delay was measured")
        self.c.call("stream.close", stream=stream)
        wait_until(lambda: figure("readers") == [], "it is gone")


class WithoutH264(pictures.PictureCase):
    def setUp(self):
        self.assets = (self.folder(),)
        super().setUp()
        if "frames:h264" in self.c.call("server.hello")["capabilities"]:
            self.skipTest("a build with H.264")

    def test_what_needs_it_is_unavailable_and_the_rest_is_not(self):
        self.add_growing()
        self.refused(-32006, "stream.open", kind="frames", encoding="h264", **SQUARE)
        self.refused(-32006, "record.start", name="a.mp4", **SQUARE)
        self.assertEqual(self.server.http("GET", "/scenes/main/clip.mp4?width=96&height=64")[0], 503)
        for encoding in ("jpeg", "png", "rgba"):
            self.c.packet(self.c.call("stream.open", kind="frames", encoding=encoding, **SQUARE)["stream"])
        started = self.c.call("record.start", name="folder", format="png_sequence", **SQUARE)
        self.assertGreater(self.c.call("record.stop", record=started["record"])["frames"], 0)
        self.assertEqual(os.listdir(self.assets[0]), ["folder"])


class H264(pictures.GrowingCase):
    """FFmpeg reads what is sent, without a word."""
    needs_h264 = True
    encoding = "h264"

    def decode(self, packets):
        """The pictures of these packets, in order."""
        return decode_h264(b"".join(p.payload for p in packets), SIDE, SIDE)

    def looks_like(self, picture, want):
        """But for what a lossy encoding does at edges."""
        self.assertLess(picture.differing(want, by=30), 0.06)

    def test_odd_sizes_are_refused(self):
        self.refused(-32602, "stream.open", path="params.width", kind="frames", encoding="h264", width=99, height=100)
        self.refused(-32602, "stream.open", path="params.height", kind="frames", encoding="h264", width=100, height=99)

    def test_a_stream_decodes_picture_for_picture(self):
        opened = self.c.call("stream.open", kind="frames", encoding="h264", rate=60, **SQUARE)
        self.assertRegex(opened["layout"]["codec"], r"^avc1\.[0-9a-f]{6}$")
        stream = opened["stream"]
        self.c.call("playback.play", speed=0.2, loop="repeat")
        packets = [self.c.packet(stream) for _ in range(90)]
        self.c.call("playback.pause")
        while not packets[-1].flags & LAST:
            packets.append(self.c.packet(stream))
        self.assertEqual([p.sequence for p in packets], list(range(len(packets))))
        self.assertTrue(packets[0].flags & KEY and packets[-1].flags & KEY)
        self.assertGreater(sum(not p.flags & KEY for p in packets), 60)
        for p in packets:
            # An Annex B start code, then for keys the parameter sets (types 7 and 8) and an IDR picture (5), else a picture (1).
            types = [p.payload[i + 3] & 31 for i in range(len(p.payload) - 3) if p.payload[i:i + 3] == b"\0\0\1"]
            types = [t for t in types if t in (1, 5, 7, 8)]
            self.assertEqual((types[:2], set(types[2:])) if p.flags & KEY else set(types), ([7, 8], {5}) if p.flags & KEY else {1})
            if p.flags & DISCONTINUITY:
                self.assertTrue(p.flags & KEY)
        shown = self.decode(packets)
        self.assertEqual(len(shown), len(packets))
        want = self.picture(time=packets[-1].media_us / 1e6)
        self.looks_like(shown[-1], want)

    def test_whoever_joins_can_decode_at_once(self):
        self.c.call("playback.play", speed=0.1)
        self.c.packet_where(lambda p: not p.flags & KEY, self.open())
        late = self.server.line()
        stream = self.open(late)
        packets = [late.packet(stream) for _ in range(10)]
        self.assertTrue(packets[0].flags & KEY)
        self.assertEqual(len(self.decode(packets)), 10)

    def test_a_seek_while_all_stands_still(self):
        stream = self.open()
        packets = [self.c.packet(stream)]
        for t in (0.5, 1.5):
            self.c.call("playback.seek", time=t)
            packets.append(self.c.packet_where(lambda p: p.media_us == t * 1e6, stream))
        self.assertTrue(all(p.flags & KEY and p.flags & LAST for p in packets))
        shown = self.decode(packets)
        for p, picture in zip(packets, shown, strict=True):
            self.looks_like(picture, self.picture(time=p.media_us / 1e6))

    def bits_of_seconds(self, packets):
        """Of all seconds that begin with one of these packets and lie among them."""
        end_us = packets[-1].server_us
        return [8 * sum(len(p.payload) for p in packets if 0 <= p.server_us - first.server_us < 1_000_000)
                for first in packets if first.server_us + 1_000_000 <= end_us]

    def test_a_bit_rate_is_kept(self):
        self.c.call("actor.remove", actor="quad")
        pictures.add_rough(self.c)
        self.c.call("playback.play", speed=0.2, loop="ping_pong")
        wide = {"width": 640, "height": 360, "rate": 30}
        free, kept = self.open(**wide), self.open(bitrate=300_000, **wide)
        packets = {free: [], kept: []}
        while min(map(len, packets.values())) < 75:
            packet = self.c.packet()
            packets[packet.stream].append(packet)
        usual = 8 * sum(len(p.payload) for p in packets[free]) / len(packets[free])
        self.assertGreater(30 * usual, 2 * 300_000, "there is something to keep from")
        self.assertLessEqual(max(self.bits_of_seconds(packets[kept])), 300_000)

    def test_fewer_bits_than_the_coarsest_pictures_take(self):
        least = 13_100 + 100 * 30 + 42 * 80 * 45
        asked = {"kind": "frames", "encoding": "h264", "width": 1280, "height": 720}
        self.refused(-32602, "stream.open", path="params.bitrate", bitrate=least - 1, **asked)
        stream = self.open(bitrate=least, width=1280, height=720)
        self.refused(-32602, "stream.update", path="params.rate", stream=stream, rate=31)
        self.c.call("stream.update", stream=stream, rate=29)

    def test_another_rate_begins_anew(self):
        def parameters(packet):
            """A key's sequence parameter set, which tells the rate."""
            return next(unit for unit in packet.payload.split(b"\0\0\1") if unit[:1] and unit[0] & 31 == 7)

        stream = self.open(rate=30)
        before = parameters(self.c.packet(stream))
        self.c.call("playback.play", speed=0.1)
        packets = [self.c.packet_where(lambda p: not p.flags & KEY, stream)]
        self.c.call("stream.update", stream=stream, rate=20)
        while len(begun := [i for i, p in enumerate(packets) if p.flags & KEY and parameters(p) != before]) < 2:
            packets.append(self.c.packet(stream))
        anew = begun[0]
        for rate, run in ((30, packets[:anew]), (20, packets[anew + 1:])):
            if len(run) > 1:
                self.paced(run, rate)
        self.assertEqual(len(self.decode(packets[anew:])), len(packets) - anew)

    def test_a_quality_is_of_jpeg_alone(self):
        for encoding in ("png", "h264", "rgba"):
            answers = [self.open(encoding=encoding, **kw) for kw in ({}, {"quality": 1})]
            payloads = [self.c.packet(stream).payload for stream in answers]
            self.assertEqual(*payloads)
        wait_until(lambda: self.c.call("server.stats")["tweend_producers"] == 3, "those of an encoding share a producer")

    def test_a_server_tells_what_it_draws(self):
        frames = {c for c in self.c.call("server.hello")["capabilities"] if c.startswith("frames:")}
        self.assertEqual(frames, {"frames:jpeg", "frames:png", "frames:rgba", "frames:h264"})


if __name__ == "__main__":
    harness.main()
