"""Streams of vertices (section 6): packets, pacing, quiet, two on one connection, and how they end."""
import base64
import struct
import time

import harness
from client import DISCONTINUITY, KEY, LAST, Packet
from harness import f32, lifted, wait_until


class Streams(harness.TestCase):
    def setUp(self):
        super().setUp()
        self.add_moving(keys=3)
        self.other = self.server.line()

    def open(self, client=None, **kw):
        return (client or self.c).call("stream.open", kind="vertices", **kw)["stream"]

    def quiet(self, client=None):
        """Nothing is sent for a while: what comes next is what is provoked after it, with the next number."""
        client = client or self.c
        until = time.monotonic() + 0.15
        while time.monotonic() < until:
            self.assertEqual([m for m in client.settle() if isinstance(m, Packet)], [])

    def seek(self, t):
        return self.other.call("playback.seek", time=t)


class Contents(Streams):
    def test_the_layout(self):
        mesh = {"positions": [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, -2], "indices": [0, 1, 2, 0, 2, 3]}
        self.c.call("actor.add", actor="quad", mesh=mesh)
        layout = self.c.call("stream.open", kind="vertices", actor="quad")["layout"]
        self.assertEqual(layout["vertices"], 4)
        indices = base64.b64decode(layout["indices_base64"])
        self.assertEqual(list(struct.unpack("<6I", indices)), mesh["indices"])
        self.assertEqual(layout["bounds"], {"min": [0, 0, -2], "max": [1, 1, 0]})
        layout = self.c.call("stream.open", kind="vertices", actor="tri")["layout"]
        self.assertEqual(layout["bounds"], {"min": [0, 0, 0], "max": [1, 1, 4]})

    def test_texture_coordinates_come_with_the_layout(self):
        folder = self.folder()
        with open(f"{folder}/uv.obj", "w") as f:
            f.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0.25 0.75\nf 1/1 2/2 3/3\n")
        c = self.serve(assets=[folder]).line()
        c.call("actor.add", actor="uv", asset="uv.obj")
        layout = c.call("stream.open", kind="vertices")["layout"]
        uvs = struct.unpack("<6f", base64.b64decode(layout["uvs_base64"]))
        self.assertEqual(uvs, (0, 0, 1, 0, 0.25, 0.75))

    def test_the_first_packet_comes_at_once_right_after_the_answer(self):
        for _ in range(3):
            id = self.c.send("stream.open", kind="vertices", rate=0.01)
            answer = self.c.read()
            self.assertEqual(answer["id"], id)
            packet = self.c.read()  # long before the second is due
            self.assertEqual(packet.stream, answer["result"]["stream"])
            self.assertEqual((packet.kind, packet.encoding, packet.media_us, packet.flags & ~DISCONTINUITY), (2, 0, 0, KEY | LAST))

    def test_packets_are_what_vertices_sample_says(self):
        stream = self.open()
        for t in (0.25, 1.3, 2, 0, 1 / 3):
            self.seek(t)
            packet = self.c.packet_where(lambda p: p.flags & LAST and p.media_us == round(t * 1e6), stream)
            sample = self.other.call("vertices.sample", time=t)
            self.assertEqual(packet.floats(), f32(sample["positions"] + sample["normals"]))
            self.assertEqual(packet.revision, self.other.call("scene.describe")["revision"])

    def test_media_and_server_time_while_it_plays(self):
        stream = self.open(rate=120)
        played = self.other.call("playback.play", time=0, speed=0.5)
        start_us = played["server_time_us"]
        self.c.packet_where(lambda p: p.server_us > start_us, stream)
        for _ in range(20):
            packet = self.c.packet(stream)
            self.assertAlmostEqual(packet.media_us, (packet.server_us - start_us) / 2 % 2_000_000, delta=2)
            self.assertEqual(packet.flags & (KEY | LAST), KEY)
            t = packet.media_us / 1e6
            want = t if t < 1 else 1 + 3 * (t - 1)
            self.assertAlmostEqual(packet.positions()[2], want, delta=1e-4)
            now_us = self.other.call("server.ping")["time_us"]
            self.assertLessEqual(packet.server_us, now_us)

    def test_flags(self):
        stream = self.open(rate=60)
        self.c.packet(stream)
        self.seek(1)
        packet = self.c.packet(stream)
        self.assertEqual((packet.media_us, packet.flags), (1_000_000, KEY | DISCONTINUITY | LAST))
        self.other.call("playback.play", speed=0.01)
        packets = [self.c.packet(stream) for _ in range(5)]
        self.assertEqual([p.flags for p in packets if p.media_us > 1_000_000 and p.flags != KEY], [], "it just plays")
        self.other.call("playback.pause")
        last = self.c.packet_where(lambda p: p.flags & LAST, stream)
        self.assertEqual(last.flags & DISCONTINUITY, 0)
        self.other.call("keyframe.update", keyframe=1, vertices={"positions": lifted(3)})
        packet = self.c.packet(stream)
        self.assertEqual(packet.flags, KEY | DISCONTINUITY | LAST, "an edit")
        self.other.call("clip.create", clip="other", keys=[2, 1])
        self.other.call("playback.play", clip="other", speed=0.1)
        self.c.packet_where(lambda p: p.flags & DISCONTINUITY and not p.flags & LAST, stream)

    def test_a_wrap_of_an_open_clip_is_a_discontinuity(self):
        stream = self.open(rate=60)
        self.other.call("playback.play", time=1.99, speed=0.0001)
        self.c.packet_where(lambda p: p.media_us >= 1_990_000, stream)
        self.other.call("playback.set", speed=0.1)  # it wraps soon, and then not for long
        wrapped = self.c.packet_where(lambda p: p.media_us < 1_000_000, stream)
        self.assertTrue(wrapped.flags & DISCONTINUITY)
        self.assertFalse(self.c.packet(stream).flags & DISCONTINUITY)

    def test_a_wrap_of_a_closed_clip_is_none(self):
        self.c.call("clip.update", clip="default", closed=True)  # 3 s long
        stream = self.open(rate=60)
        self.other.call("playback.play", time=2.99, speed=0.0001)
        self.c.packet_where(lambda p: p.media_us >= 2_990_000, stream)
        self.other.call("playback.set", speed=0.1)
        packets = [self.c.packet(stream)]
        while packets[-1].media_us >= 1_000_000:
            packets.append(self.c.packet(stream))
        self.assertEqual([p for p in packets if p.flags & DISCONTINUITY], [])

    def test_a_stream_of_one_of_several_actors(self):
        self.add_moving("b", keys=2)
        streams = {self.open(actor="tri"): 3, self.open(actor="b"): 2}
        for stream in streams:
            self.c.packet(stream)
        self.other.call("playback.seek", actor="b", time=0.5)
        self.assertEqual(streams[self.c.packet_where(lambda p: p.media_us == 500_000).stream], 2)
        self.quiet()


class Pacing(Streams):
    def test_rates(self):
        self.other.call("playback.play", speed=0.01)
        for rate in (10, 30, 120):
            stream = self.open(rate=rate)
            self.c.packet(stream)
            packets = [self.c.packet(stream) for _ in range(max(5, rate // 6))]
            span = (packets[-1].server_us - packets[0].server_us) / 1e6
            produced = packets[-1].sequence - packets[0].sequence
            self.assertLessEqual(produced, span * rate + 1.5, f"never more than {rate} a second")
            self.assertLess(self.paced(packets, rate), 1.001, "some are neighbours")
            self.c.call("stream.close", stream=stream)

    def test_the_default_is_thirty_a_second(self):
        self.other.call("playback.play", speed=0.01)
        stream = self.open()
        self.c.packet(stream)
        packets = [self.c.packet(stream) for _ in range(10)]
        self.assertLess(self.paced(packets, 30), 1.001, "some are neighbours")
        self.assertLessEqual(packets[-1].sequence - packets[0].sequence, (packets[-1].server_us - packets[0].server_us) * 30e-6 + 1.5)

    def test_sequences_count_what_was_produced(self):
        stream = self.open(rate=240)
        self.other.call("playback.play")
        packets = [self.c.packet(stream) for _ in range(60)]
        sequences = [p.sequence for p in packets]
        self.assertEqual(sequences, sorted(set(sequences)))
        skipped = self.c.call("server.stats")["tweend_packets_skipped_total"]
        self.assertLessEqual(sequences[-1] - sequences[0] + 1 - len(sequences), skipped)

    def test_quiet_when_nothing_changes(self):
        stream = self.open(rate=120)
        first = self.c.packet(stream)
        self.quiet()
        self.seek(0.5)
        second = self.c.packet(stream)
        self.assertEqual((second.media_us, second.sequence), (500_000, first.sequence + 1))
        self.quiet()
        self.other.call("playback.play")
        self.c.packet_where(lambda p: not p.flags & LAST, stream)
        paused = self.other.call("playback.pause")["players"][0]["time"]
        final = self.c.packet_where(lambda p: p.flags & LAST, stream)
        self.assertAlmostEqual(final.media_us, paused * 1e6, delta=1)
        self.quiet()
        self.other.call("scene.describe")
        self.other.call("vertices.sample")
        self.quiet()
        self.seek(0.25)
        self.assertEqual(self.c.packet(stream).sequence, final.sequence + 1)

    def test_a_new_reader_is_nothing_new_to_the_others(self):
        stream = self.open()
        first = self.c.packet(stream)
        for _ in range(5):
            late = self.server.line()
            opened = self.open(late)
            packet = late.packet(opened)
            self.assertEqual((packet.media_us, packet.payload), (first.media_us, first.payload))
            self.assertEqual(packet.stream, opened)
        self.quiet()
        self.seek(1)
        self.assertEqual(self.c.packet(stream).sequence, first.sequence + 1)

    def test_an_edit_elsewhere_is_shown_too(self):
        stream = self.open()
        self.c.packet(stream)
        key = self.other.call("keyframe.update", keyframe=1, vertices={"positions": lifted(-3)})
        packet = self.c.packet(stream)
        self.assertEqual((packet.positions(), packet.revision), (lifted(-3), key["revision"]))
        self.other.call("edit.undo")
        self.assertEqual(self.c.packet(stream).positions(), lifted(0))

    def test_fast_seeks_end_with_the_last_one(self):
        stream = self.open(rate=20)
        for i in range(200):
            self.other.send("playback.seek", time=(i % 100) / 50)
        self.other.settle()
        last = self.seek(1.77)["players"][0]["time"]
        self.assertEqual(last, 1.77)
        self.c.packet_where(lambda p: p.media_us == 1_770_000 and p.flags & LAST, stream)
        self.quiet()


class Handling(Streams):
    def test_two_on_one_connection(self):
        a, b = self.open(rate=60), self.open(rate=15)
        self.assertNotEqual(a, b)
        self.other.call("playback.play")
        seen = {a: [], b: []}

        def four_times_as_many():  # or nearly so, once the machine keeps up
            packet = self.c.packet()
            seen[packet.stream].append(packet.sequence)
            return len(seen[b]) >= 6 and len(seen[a]) >= 2 * len(seen[b])
        wait_until(four_times_as_many, "more packets of the one than of the other")
        for sequences in seen.values():
            self.assertEqual(sequences, sorted(set(sequences)))
        self.c.call("stream.close", stream=a)
        self.c.settle()
        self.assertEqual({self.c.packet().stream for _ in range(5)}, {b})

    def test_the_same_twice_on_one_connection(self):
        a, b = self.open(), self.open()
        self.seek(1)
        for stream in (a, b):
            self.c.packet_where(lambda p: p.media_us == 1_000_000, stream)
        self.c.call("stream.close", stream=a)
        self.seek(0.5)
        self.c.packet_where(lambda p: p.media_us == 500_000, b)
        self.assertEqual([m for m in self.c.settle() if isinstance(m, Packet) and m.stream == a], [])

    def test_equal_streams_share_one_producer(self):
        clients = [self.server.line() for _ in range(8)]
        streams = [(c, self.open(c, rate=50)) for c in clients]
        for c, stream in streams:
            c.packet(stream)
        before = self.c.call("server.stats")
        self.assertEqual((before["tweend_producers"], before["tweend_streams"]), (1, 8))
        for i in range(1, 11):
            self.seek(i / 10)
            packets = [c.packet_where(lambda p: p.media_us == i * 100_000, stream) for c, stream in streams]
            self.assertEqual(len({(p.payload, p.server_us) for p in packets}), 1)
        after = self.c.call("server.stats")
        self.assertEqual(after["tweend_packets_produced_total"] - before["tweend_packets_produced_total"], 10)
        self.assertEqual(after["tweend_packets_sent_total"] - before["tweend_packets_sent_total"], 80)

    def test_update_of_the_rate(self):
        stream = self.open(rate=5)
        self.other.call("playback.play", speed=0.01)
        before = [self.c.packet(stream) for _ in range(2)]
        self.assertEqual(self.c.call("stream.update", stream=stream, rate=100), {})
        self.c.settle()
        after = [self.c.packet(stream) for _ in range(12)]
        sequences = [p.sequence for p in before + after]
        self.assertEqual(sequences, sorted(set(sequences)), "numbers go on")
        gaps = sorted(b.server_us - a.server_us for a, b in zip(after, after[1:]))
        self.assertLess(gaps[0], 100_000)
        self.assertEqual(self.c.call("stream.update", stream=stream), {})
        self.c.packet(stream)
        self.refused(-32602, "stream.update", path="params.encoding", stream=stream, encoding="f32")

    def test_update_while_it_is_quiet(self):
        stream = self.open(rate=5)
        self.c.packet(stream)
        self.c.call("stream.update", stream=stream, rate=60)
        self.seek(0.5)
        self.c.packet_where(lambda p: p.media_us == 500_000, stream)
        self.quiet()

    def test_close(self):
        stream = self.open(rate=240)
        self.other.call("playback.play")
        self.c.packet(stream)
        self.assertEqual(self.c.call("stream.close", stream=stream), {})
        self.c.unread.clear()
        self.quiet()
        self.refused(-32001, "stream.close", path="params.stream", stream=stream)
        self.refused(-32001, "stream.update", path="params.stream", stream=stream, rate=5)
        stats = self.c.call("server.stats")
        self.assertEqual(stats["tweend_streams"], 0)
        again = self.open()
        self.c.packet(again)

    def test_streams_are_of_their_connection(self):
        stream = self.open()
        self.refused(-32001, "stream.close", by=self.other, path="params.stream", stream=stream)
        self.c.call("stream.close", stream=stream)

    def test_opening_and_closing_at_once(self):
        for _ in range(30):
            opening = self.c.send("stream.open", kind="vertices", rate=240)
            self.c.answer(self.c.send("stream.close", stream=self.c.answer(opening)["stream"]))
        stream = self.c.call("stream.open", kind="vertices")["stream"]
        self.c.unread.clear()
        self.seek(1)
        self.c.packet_where(lambda p: p.media_us == 1_000_000, stream)
        wait_until(lambda: self.c.call("server.stats")["tweend_producers"] == 1, "the other producers are gone")

    def test_an_open_that_is_refused_leaves_nothing(self):
        self.refused(-32001, "stream.open", path="params.actor", kind="vertices", actor="none")
        self.refused(-32602, "stream.open", path="params.rate", kind="vertices", rate=1000)
        self.assertEqual(self.c.call("server.stats")["tweend_streams"], 0)

    def test_a_client_that_leaves_takes_its_streams_along(self):
        for leave in ("close", "reset"):
            c = self.server.line()
            for rate in (10, 20, 30):
                self.open(c, rate=rate)
            getattr(c, leave)()
        wait_until(lambda: self.c.call("server.stats")["tweend_producers"] == 0, "its producers are gone")


class Ends(Streams):
    def ended(self, stream, client=None):
        event = (client or self.c).event("stream.ended", stream=stream)
        self.assertEqual(set(event), {"stream", "reason"})
        self.assertTrue(event["reason"])
        return event

    def gone(self, stream):
        self.assertEqual([m for m in self.c.settle() if isinstance(m, Packet)], [])
        self.refused(-32001, "stream.close", path="params.stream", stream=stream)
        stats = self.c.call("server.stats")
        self.assertEqual((stats["tweend_streams"], stats["tweend_producers"]), (0, 0))

    def test_with_the_actor(self):
        stream = self.open()
        self.other.call("playback.play")
        self.c.packet(stream)
        self.other.call("actor.remove", actor="tri")
        self.ended(stream)
        self.c.unread.clear()
        self.gone(stream)

    def test_with_the_scene(self):
        self.c.call("scene.create", scene="s")
        self.add_moving(scene="s")
        streams = [self.open(scene="s", rate=rate) for rate in (10, 20)]
        ws = self.server.websocket()
        third = ws.call("stream.open", kind="vertices", scene="s")["stream"]
        kept = self.open()
        self.other.call("scene.remove", scene="s")
        for stream in streams:
            self.ended(stream)
        self.ended(third, ws)
        self.c.unread.clear()
        self.seek(1)
        self.c.packet_where(lambda p: p.media_us == 1_000_000, kept)

    def test_with_the_undo_of_what_made_the_actor(self):
        self.add_triangle("b")
        stream = self.open(actor="b")
        self.c.packet(stream)
        self.other.call("edit.undo")
        self.ended(stream)
        self.gone(stream)
        self.other.call("edit.redo")
        self.c.packet(self.open(actor="b"))

    def test_with_an_actor_that_is_replaced_by_another_mesh(self):
        """The layout told at first would be wrong."""
        stream = self.open()
        self.c.packet(stream)
        quad = {"positions": [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0], "indices": [0, 1, 2, 0, 2, 3]}
        self.other.call("edit.apply", edits=[{"method": "actor.remove", "params": {"actor": "tri"}},
                                             {"method": "actor.add", "params": {"actor": "tri", "mesh": quad}}])
        self.ended(stream)
        self.gone(stream)
        self.assertEqual(self.c.call("stream.open", kind="vertices")["layout"]["vertices"], 4)
        self.assertEqual(len(self.c.packet().floats()), 24)

    def test_other_edits_do_not_end_it(self):
        stream = self.open()
        for method, params in (("actor.update", {"visible": False}), ("keyframe.remove", {"keyframe": 1}), ("clip.create", {"clip": "x"}),
                               ("playback.play", {"clip": "x"}), ("clip.remove", {"clip": "default"}), ("edit.undo", {}),
                               ("camera.set", {"fov_y": 1})):
            self.other.call(method, **params)
        self.other.call("playback.play", clip="default", time=1.5)
        self.other.call("playback.pause")
        self.c.packet_where(lambda p: p.media_us >= 1_500_000, stream)
        self.assertNotIn("stream.ended", [m.get("method") for m in self.c.settle() if isinstance(m, dict)])

    def test_opening_a_stream_of_an_actor_that_is_being_removed(self):
        """Either it is refused, or it ends; it never hangs in the air."""
        for i in range(20):
            self.other.call("actor.add", actor=f"b{i}", mesh=harness.TRIANGLE)
            removal = self.other.send("actor.remove", actor=f"b{i}")
            try:
                stream = self.open(actor=f"b{i}")
            except harness.RpcError as error:
                self.assertEqual(error.code, -32001)
            else:
                self.ended(stream)
            self.other.answer(removal)
        self.c.unread.clear()
        wait_until(lambda: self.c.call("server.stats")["tweend_streams"] == 0, "no stream is left")


if __name__ == "__main__":
    harness.main()
