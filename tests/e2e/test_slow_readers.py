"""Readers that do not read (section 6): they skip, they cost nobody anything, and they come back to what is shown now."""
import time

import harness
from client import DISCONTINUITY, Packet, request_json
from harness import wait_until

SIDE = 80  # 6400 vertices, 154 kB a packet


class SlowReaders(harness.TestCase):
    def setUp(self):
        super().setUp()
        self.add_waving_grid(SIDE)
        self.c.call("playback.play", speed=0.001)
        self.stream = self.c.call("stream.open", kind="vertices", rate=60)["stream"]

    def stuck(self, **kw):
        """A client that opens a stream and never reads."""
        c = self.server.line(receive_buffer=8192, **kw)
        c.send("stream.open", kind="vertices", rate=60)
        return c

    def skips(self, more_than):
        wait_until(lambda: self.c.call("server.stats")["tweend_packets_skipped_total"] > more_than, "packets are skipped")

    def drain(self, seconds, share, at_least=1):
        """The healthy client reads for so long, and again while this machine keeps it from reading: of what is made, which is so
        much at least, it gets this share."""
        def healthy():
            self.c.unread.clear()
            packets = [self.c.packet(self.stream)]
            until = time.monotonic() + seconds
            while time.monotonic() < until:
                packets.append(self.c.packet(self.stream))
            produced = packets[-1].sequence - packets[0].sequence + 1
            return produced > at_least and len(packets) > share * produced
        self.keeps_up(healthy, f"of more than {at_least} packets in {seconds} s, {share} come")

    def test_a_healthy_reader_beside_stuck_ones(self):
        stuck = [self.stuck() for _ in range(12)]
        self.skips(100)
        before = self.server.rss_mib()
        self.drain(1.5, share=0.7, at_least=15)
        self.grew_less(before, 32)
        stats = self.c.call("server.stats")
        self.assertEqual((stats["tweend_streams"], stats["tweend_producers"]), (13, 1))
        for c in stuck:
            c.close()
        wait_until(lambda: self.c.call("server.stats")["tweend_streams"] == 1, "their streams are gone")

    def test_what_a_stuck_reader_finds_when_it_reads_again(self):
        stuck = self.stuck()
        stream = stuck.answer(stuck.last_id)["stream"]
        stuck.packet(stream)
        self.c.call("stream.close", stream=self.stream)  # all that is skipped is the stuck one's
        skipped = self.c.call("server.stats")["tweend_packets_skipped_total"]
        self.skips(skipped + 20)
        self.c.call("playback.seek", time=0.5)  # its packet is skipped, its flag is not
        self.skips(self.c.call("server.stats")["tweend_packets_skipped_total"] + 20)
        now_us = self.c.call("server.ping")["time_us"]
        packets = [stuck.packet(stream)]
        while packets[-1].server_us < now_us:
            packets.append(stuck.packet(stream))
            self.assertLess(len(packets), 100, "packets of long ago")
        gaps = [b.sequence - a.sequence for a, b in zip(packets, packets[1:])]
        self.assertGreater(max(gaps), 10, "a gap shows what was skipped")
        jumps = [p for p in packets if p.flags & DISCONTINUITY and p.media_us >= 500_000]
        self.assertEqual(len(jumps), 1, f"the seek is told once: {packets}")
        sequences = [p.sequence for p in packets]
        self.assertEqual(sequences, sorted(set(sequences)))

    def test_a_stuck_reader_gets_the_final_state(self):
        stuck = self.stuck()
        stream = stuck.answer(stuck.last_id)["stream"]
        stuck.packet(stream)
        self.skips(self.c.call("server.stats")["tweend_packets_skipped_total"] + 10)
        final = self.c.call("playback.pause")["players"][0]["time"]
        self.c.packet_where(lambda p: p.flags & 4, self.stream)
        packet = stuck.packet_where(lambda p: p.flags & 4, stream)
        self.assertAlmostEqual(packet.media_us, final * 1e6, delta=1)
        self.assertEqual([m for m in stuck.settle() if isinstance(m, Packet)], [])

    def test_its_requests_are_still_answered_in_order(self):
        stuck = self.stuck()
        stuck.answer(stuck.last_id)
        self.skips(self.c.call("server.stats")["tweend_packets_skipped_total"] + 5)
        ids = [stuck.send("scene.list") for _ in range(50)]
        self.assertEqual([stuck.answer(i)["scenes"][0]["scene"] for i in ids], ["main"] * 50)

    def test_the_end_is_told_after_the_final_packet_to_a_slow_reader_too(self):
        stuck = self.stuck()
        stream = stuck.answer(stuck.last_id)["stream"]
        stuck.call("events.subscribe")
        self.skips(self.c.call("server.stats")["tweend_packets_skipped_total"] + 10)
        self.c.call("playback.play", time=0.9, speed=5, loop="once")
        self.c.packet_where(lambda p: p.flags & 4 and p.media_us == 1_000_000, self.stream)
        ended = stuck.event("playback.ended")
        self.assertEqual(ended["actor"], "grid")
        packets = [m for m in stuck.unread if isinstance(m, Packet)]
        self.assertEqual((packets[-1].stream, packets[-1].media_us, packets[-1].flags & 4), (stream, 1_000_000, 4))

    def test_a_watcher_that_never_reads_its_events(self):
        """What it may miss is for the server to decide, but it neither grows nor slows anybody."""
        watcher = self.server.line(receive_buffer=4096)
        watcher.send("events.subscribe")
        self.c.call("stream.close", stream=self.stream)
        self.c.unread.clear()
        before = self.server.rss_mib()
        for _ in range(40):
            self.c.send_raw(b"".join(request_json("playback.seek", {"time": i / 500}) + b"\n" for i in range(500)))
            self.c.call("server.stats")
        self.grew_less(before, 64)
        self.c.call("server.ping")

    def test_a_client_that_asks_and_never_reads(self):
        before = self.server.rss_mib()
        greedy = self.server.line(receive_buffer=4096)
        greedy.sock.setblocking(False)
        request = request_json("vertices.sample", {"indices": True}, 1) + b"\n"
        try:
            for _ in range(20_000):
                greedy.sock.send(request)
        except BlockingIOError:
            pass  # the server has stopped reading, as it should
        self.drain(1, share=0.5)
        self.grew_less(before, 96)


if __name__ == "__main__":
    harness.main()
