"""The protocol over bad links: bytes that come one by one, connections that break in mid-packet, stall, lag, or half die."""
import contextlib
import os
import socket
import sys

import harness
from client import DISCONTINUITY, Closed, HttpClient, LineClient, Packet, ProtocolError, WebSocketClient, request_json
from harness import wait_until

sys.path.append(os.path.join(os.path.dirname(__file__), "..", "support"))
from fault_proxy import FaultProxy  # noqa: E402

SIDE = 30  # 900 vertices, 21,640 bytes a packet
SPEAKERS = (LineClient, WebSocketClient)


class BadLinks(harness.TestCase):
    """self.c is near the server, what through() gives is behind the proxy."""

    def setUp(self):
        super().setUp()
        self.proxy = FaultProxy(self.server.port)
        self.addCleanup(self.proxy.close)

    def through(self, speaker=LineClient, **kw):
        return self.server.keep(speaker(self.proxy.port, **kw))

    def stats(self):
        return self.c.call("server.stats")

    def forgotten(self):
        """Nothing is left of anybody but self.c."""
        def only_one():
            stats = self.stats()
            return (stats["tweend_connections"], stats["tweend_streams"], stats["tweend_producers"]) == (1, 0, 0)
        wait_until(only_one, "connections, streams and producers are forgotten")

    def skips(self, count):
        before = self.stats()["tweend_packets_skipped_total"]
        wait_until(lambda: self.stats()["tweend_packets_skipped_total"] > before + count, "packets are skipped")


class Slices(BadLinks):
    def setUp(self):
        super().setUp()
        self.add_moving()
        for direction in ("up", "down"):
            self.proxy.change(direction, slice_bytes=1)

    def test_commands(self):
        for speaker in SPEAKERS:
            far = self.through(speaker)
            self.assertEqual(far.call("scene.describe"), self.c.call("scene.describe"))
            self.assertEqual(far.call("vertices.sample", actor="tri", time=1.5), self.c.call("vertices.sample", actor="tri", time=1.5))
            name = f"of_{speaker.__name__}"
            far.call("actor.add", actor=name, mesh=harness.TRIANGLE)
            self.refused(-32002, "actor.add", path="params.actor", by=far, actor=name, mesh=harness.TRIANGLE)
            self.assertIn(name, [a["actor"] for a in self.c.call("scene.describe")["actors"]])
            ids = [far.send("server.stats") for _ in range(20)]
            for id in ids:
                self.assertIn("tweend_streams", far.answer(id))
            far.send_message(b"[" + b",".join(request_json("server.ping", {}, i) for i in range(5)) + b"]")
            self.assertEqual(sorted(m["id"] for m in far.read_where(lambda m: isinstance(m, list))), list(range(5)))

    def test_http(self):
        far = self.through(HttpClient)
        for _ in range(3):
            self.assertEqual(far.ask("GET", "/healthz")[0], 200)
            answer = far.rpc({"jsonrpc": "2.0", "id": 1, "method": "scene.describe"})
            self.assertEqual(answer["result"], self.c.call("scene.describe"))

    def test_packets(self):
        near = self.c.call("stream.open", kind="vertices", rate=60)["stream"]
        for speaker in SPEAKERS:
            far = self.through(speaker)
            stream = far.call("stream.open", kind="vertices", rate=60)["stream"]
            far.call("events.subscribe")
            for t in (0.25, 1.75, 1.0, 0.5):
                far.call("playback.seek", time=t)
                at = round(t * 1e6)
                theirs, ours = (c.packet_where(lambda p: p.media_us == at, s) for c, s in ((far, stream), (self.c, near)))
                self.assertEqual((theirs.payload, theirs.server_us, theirs.revision), (ours.payload, ours.server_us, ours.revision))
                self.near(theirs.positions(), self.c.call("vertices.sample", time=t)["positions"])
                far.event("playback.changed")

    def test_a_stream_that_runs(self):
        for speaker in SPEAKERS:
            far = self.through(speaker)
            stream = far.call("stream.open", kind="vertices", rate=30)["stream"]
            self.c.call("playback.play")
            packets = [far.packet(stream) for _ in range(15)]
            for packet in packets:
                self.near(packet.positions(), self.c.call("vertices.sample", time=packet.media_us / 1e6)["positions"], 1e-4)
            sequences = [p.sequence for p in packets]
            self.assertEqual(sequences, sorted(set(sequences)))
            far.call("stream.close", stream=stream)
            far.close()


class Resets(BadLinks):
    def test_in_mid_packet_or_wherever_it_strikes(self):
        self.add_waving_grid(SIDE)
        self.c.call("playback.play", speed=0.1)
        for speaker in SPEAKERS:
            for count in (1, 10_000, 30_000, 45_000, 60_001, 100_000):  # the layout takes 27 kB, each packet 22
                before = self.proxy.passed("down")
                far = self.through(speaker)
                shaken = self.proxy.passed("down") - before
                self.proxy.change("down", reset_after=shaken + count)
                far.send("stream.open", kind="vertices", rate=60)
                came = []
                with self.assertRaises((Closed, ProtocolError)):  # the latter in mid-line
                    while True:
                        came.append(far.read())
                self.assertEqual(sum(isinstance(m, Packet) for m in came), max(0, (count - 27_000) // 21_640), f"of {count} bytes")
                self.proxy.change("down", reset_after=None)
                self.forgotten()

    def test_in_mid_request_nothing_is_carried_out(self):
        self.add_triangle()
        before = self.c.call("scene.describe")
        request = request_json("actor.add", {"actor": "late", "mesh": harness.TRIANGLE}, 1)
        for speaker in SPEAKERS:
            far = self.through(speaker)
            far.call("server.ping")
            if speaker is LineClient:
                far.send_raw(request[:-5])
            else:
                far.send_frame(1, request[:-5], fin=False)
            wait_until(lambda: self.proxy.passed("up") > len(request) - 5, "the request is under way")
            self.proxy.reset()
            self.forgotten()
        self.assertEqual(self.c.call("scene.describe"), before)

    def test_an_edit_whose_answer_was_lost_is_not_made_twice(self):
        self.add_triangle()
        far = self.through()
        far.call("server.ping")
        self.proxy.change("down", stalled=True)
        edit = {"vertices": {"positions": harness.lifted(1)}, "retry_key": "only once"}
        far.send("keyframe.add", **edit)
        wait_until(lambda: len(self.c.call("keyframe.list")["keyframes"]) == 1, "the keyframe is there")
        self.proxy.reset()
        with self.assertRaises(Closed):
            far.read()
        self.proxy.change("down", stalled=False)
        answer = self.through().call("keyframe.add", **edit)
        keyframes = self.c.call("keyframe.list")["keyframes"]
        self.assertEqual([k["keyframe"] for k in keyframes], [answer["keyframe"]])

    def test_many_at_once(self):
        self.add_waving_grid(SIDE)
        self.c.call("playback.play", speed=0.1)
        for _ in range(3):
            clients = [self.through(SPEAKERS[i % 2]) for i in range(20)]
            for far in clients:
                far.send("stream.open", kind="vertices", rate=60)
            for far in clients:
                far.packet()
            self.proxy.reset()
            self.forgotten()
        self.c.call("server.ping")


class Stalls(BadLinks):
    def setUp(self):
        super().setUp()
        self.add_waving_grid(SIDE)
        self.c.call("playback.play", speed=0.01)

    def test_a_stream_goes_on_with_what_is_shown_now(self):
        for speaker in SPEAKERS:
            far = self.through(speaker)
            stream = far.call("stream.open", kind="vertices", rate=60)["stream"]
            packets = [far.packet(stream)]
            self.proxy.change("down", stalled=True)
            self.skips(20)
            self.c.call("playback.seek", time=0.5)
            self.skips(20)
            now_us = self.c.call("server.ping")["time_us"]
            self.proxy.change("down", stalled=False)
            while packets[-1].server_us < now_us:
                packets.append(far.packet(stream))
            gaps = [b.sequence - a.sequence for a, b in zip(packets, packets[1:])]
            self.assertGreaterEqual(min(gaps), 1)
            self.assertGreater(max(gaps), 20, "the gap shows what was skipped")
            jumps = [p for p in packets if p.flags & DISCONTINUITY and p.media_us >= 500_000]
            self.assertEqual(len(jumps), 1, "the seek is told, once")
            self.c.call("playback.seek", time=0)
            far.close()

    def test_answers_come_when_it_goes_on(self):
        far = self.through()
        far.call("server.ping")
        self.proxy.change("down", stalled=True)
        ids = [far.send("playback.seek", time=i / 100) for i in range(50)]
        wait_until(lambda: self.player()["time"] >= 0.49, "they are carried out")
        self.proxy.change("down", stalled=False)
        for i, id in enumerate(ids):
            self.assertAlmostEqual(far.answer(id)["players"][0]["time"], i / 100, delta=1e-6)

    def test_a_request_that_stalls_in_the_middle_holds_up_nobody(self):
        far = self.through()
        stream = far.call("stream.open", kind="vertices", rate=60)["stream"]
        request = request_json("actor.add", {"actor": "late", "mesh": harness.grid(60)}, 77) + b"\n"
        far.send_raw(request[:1000])
        wait_until(lambda: self.proxy.passed("up") >= 1000, "a part of it has arrived")
        self.proxy.change("up", stalled=True)
        with contextlib.suppress(BlockingIOError):
            far.sock.setblocking(False)
            sent = 1000
            while sent < len(request):
                sent += far.sock.send(request[sent:])
        for _ in range(10):
            far.packet(stream)  # the other way is open
            self.c.call("playback.get", actor="grid")
        self.proxy.change("up", stalled=False)
        far.send_raw(request[sent:])
        self.assertEqual(far.answer(77)["vertices"], 3600)

    def test_it_costs_the_server_no_memory(self):
        far = [self.through() for _ in range(10)]
        for c in far:
            c.send("stream.open", kind="vertices", rate=240)
            c.packet()
        before = self.server.rss_mib()
        self.proxy.change("down", stalled=True)
        self.skips(2_000)
        self.grew_less(before, 16)


class Latency(BadLinks):
    def test_answers_keep_their_order_and_packets_carry_their_age(self):
        self.add_moving()
        near = self.c.call("stream.open", kind="vertices", rate=60)["stream"]
        for direction in ("up", "down"):
            self.proxy.change(direction, latency_s=0.1)
        for speaker in SPEAKERS:
            far = self.through(speaker)
            ids = [far.send("vertices.sample", time=i / 10) for i in range(10)]  # all under way together
            for i, id in enumerate(ids):
                self.assertEqual(far.answer(id)["time"], i / 10)
            stream = far.call("stream.open", kind="vertices", rate=60)["stream"]
            packets = [far.packet(stream)]
            for i in range(1, 20):  # the server has sent each to both before it makes the next
                self.c.call("playback.seek", time=i / 10)
                self.c.packet_where(lambda p: p.media_us == i * 100_000, near)
            for _ in range(1, 20):
                packets.append(far.packet(stream))
                self.assertGreaterEqual(self.c.call("server.ping")["time_us"] - packets[-1].server_us, 100_000)
            self.assertEqual(packets[-1].sequence - packets[0].sequence, 19, "lag alone skips nothing")
            far.close()
            self.c.call("playback.seek", time=0)
            self.c.packet_where(lambda p: p.media_us == 0, near)

    def test_who_has_said_all_still_hears_the_rest(self):
        self.add_waving_grid(SIDE)
        self.proxy.change("down", latency_s=0.1, bytes_per_s=1_000_000)
        far = self.through()
        ids = [far.send("vertices.sample", time=i / 100) for i in range(10)]
        far.sock.shutdown(socket.SHUT_WR)
        messages = far.read_to_end()
        self.assertEqual([m["id"] for m in messages], ids)
        self.forgotten()


class HalfDead(BadLinks):
    def setUp(self):
        super().setUp()
        self.add_waving_grid(SIDE)
        self.c.call("playback.play", speed=0.01)

    def test_a_viewer_that_has_gone_without_a_word(self):
        stream = self.c.call("stream.open", kind="vertices", rate=60)["stream"]
        far = [self.through(SPEAKERS[i % 2]) for i in range(10)]
        for c in far:
            c.send("stream.open", kind="vertices", rate=60)
            c.packet()
        self.proxy.abandon()
        self.skips(100)
        before = self.server.rss_mib()
        self.c.unread.clear()

        def most_of_them():
            packets = [self.c.packet(stream) for _ in range(60)]
            return len(packets) >= 0.7 * (packets[-1].sequence - packets[0].sequence + 1)
        self.keeps_up(most_of_them, "most of what is made reaches who reads")
        self.grew_less(before, 16)
        self.assertEqual(self.stats()["tweend_streams"], 11)
        self.c.call("stream.close", stream=stream)
        self.proxy.reset()
        self.forgotten()

    def test_it_does_not_keep_the_server_from_ending(self):
        far = self.through()
        far.call("stream.open", kind="vertices", rate=60)
        self.proxy.abandon()
        self.skips(20)
        self.assertEqual(self.server.stop(), 0)


if __name__ == "__main__":
    harness.main()
