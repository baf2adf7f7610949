"""Pictures over a link of 2 Mbit/s (section 6, `adaptive`): they become smaller instead of late, for nobody but who is behind it;
nothing old waits; and what stands still is shown as it was asked for."""
import os
import statistics
import sys
import threading
import time
import urllib.parse

import harness
import pictures
from client import LAST, PATIENCE_S, Closed, LineClient, ProtocolError, WebSocketClient
from harness import wait_until
from pictures import Mjpeg, jpeg_size

sys.path.append(os.path.join(os.path.dirname(__file__), "..", "support"))
from fault_proxy import HELD_BYTES, FaultProxy  # noqa: E402

SIZE = (640, 360)
RUNG_SIDES = {1, 3 / 4, 5 / 8, 1 / 2, 3 / 8, 1 / 4}  # of what was asked for (section 6)
RATE = 30
LINK_BYTES_PER_S = 250_000  # 2 Mbit/s; the pictures as asked for take three times as much
# What a server may have given its kernel when its client stops reading, and the kernel not yet sent: 128 KiB and what it was at.
KERNEL_BYTES = 256 << 10


class Seen:
    """What a viewer keeps of a packet."""

    def __init__(self, packet, size, came_us):
        self.sequence, self.media_us, self.server_us, self.flags = packet.sequence, packet.media_us, packet.server_us, packet.flags
        self.bytes, self.size, self.came_us = len(packet.payload), size, came_us


class Viewer(threading.Thread):
    """Takes the packets of one stream as they come, on a thread of its own, until its client is closed."""

    def __init__(self, client, params):
        super().__init__(daemon=True)
        self.client, self.seen, self.failure = client, [], None
        self.offset_us = self.clock_offset()
        answer = client.call("stream.open", **params)
        self.layout, self.stream = answer["layout"], answer["stream"]
        self.start()

    def clock_offset(self):
        """The server's clock minus ours, by the fastest of some round trips."""
        def trip():
            before = time.monotonic_ns()
            there = self.client.call("server.ping")["time_us"]
            after = time.monotonic_ns()
            return after - before, there - (before + after) // 2000
        return min(trip() for _ in range(10))[1]

    def run(self):
        try:
            while True:
                packet = self.client.packet(self.stream)
                came_us = time.monotonic_ns() // 1000 + self.offset_us
                self.seen.append(Seen(packet, jpeg_size(packet.payload), came_us))
        except (Closed, OSError):
            pass
        except ProtocolError as error:
            if "in mid-line" not in str(error):
                self.failure = error
        except BaseException as error:
            self.failure = error

    def newest(self):
        return self.seen[-1] if self.seen else None

    def more(self, count):
        """Waits for so many more packets: those, and what came beside them."""
        before = len(self.seen)
        wait_until(lambda: self.failure or len(self.seen) >= before + count, f"{count} more packets")
        return self.seen[before:]


class Ladder(pictures.PictureCase):
    def setUp(self):
        super().setUp()
        self.rate = 10 if self.server.sanitized() else RATE  # there fewer are made, and the link is as much slower
        self.limit = LINK_BYTES_PER_S * self.rate // RATE
        pictures.add_rough(self.c)
        self.asked = {"kind": "frames", "width": SIZE[0], "height": SIZE[1], "rate": self.rate}
        self.proxy = FaultProxy(self.server.port)
        self.addCleanup(self.proxy.close)
        self.viewers = []

    def tearDown(self):
        for viewer in self.viewers:
            viewer.client.sock.shutdown(2)
            viewer.join(PATIENCE_S)
            self.assertIsNone(viewer.failure)
        super().tearDown()

    def view(self, speaker=LineClient, weak=False, **kw):
        client = self.server.keep(speaker(self.proxy.port if weak else self.server.port))
        viewer = Viewer(client, self.asked | kw)
        self.viewers.append(viewer)
        self.assertEqual((viewer.layout["width"], viewer.layout["height"]), SIZE)
        return viewer

    def play(self):
        self.c.call("playback.play", speed=0.2)

    def limited(self, yes=True):
        self.proxy.change("down", bytes_per_s=self.limit if yes else None)

    def goes_down(self, *viewers):
        for viewer in viewers:
            wait_until(lambda: viewer.failure or viewer.newest() and viewer.newest().size < SIZE, "its pictures become smaller")

    def goes_up(self, viewer):
        wait_until(lambda: viewer.failure or viewer.newest().size == SIZE and all(s.bytes > self.full / 1.2 for s in viewer.seen[-3:]),
                   "its pictures are as large again as was asked for", seconds=4 * PATIENCE_S)

    def healthy_all_along(self, viewer):
        """Full pictures, and all of them."""
        seen = list(viewer.seen)
        self.assertEqual({s.size for s in seen}, {SIZE})
        produced = seen[-1].sequence - seen[0].sequence + 1
        self.assertGreaterEqual(len(seen), 0.98 * produced, f"of {produced}")

    def in_order(self, viewer):
        seen = list(viewer.seen)
        self.assertTrue(all(a.sequence < b.sequence and a.server_us <= b.server_us for a, b in zip(seen, seen[1:])))

    def tell_ages(self, name, seen):
        ages = sorted((s.came_us - s.server_us) / 1e3 for s in seen)
        span_s = (seen[-1].came_us - seen[0].came_us) / 1e6
        print(f"\n{name}: {len(seen)} pictures, {len(seen) / span_s:.1f} a second, {sum(s.bytes for s in seen) / span_s / 1e3:.0f} kB/s, sizes "
              f"{sorted({s.size[0] for s in seen})}; age median {statistics.median(ages):.0f} ms, p95 {ages[int(0.95 * len(ages))]:.0f} ms")


class WeakLinks(Ladder):
    def test_a_weak_link_is_given_smaller_pictures_and_nobody_else(self):
        near = self.view()
        self.play()
        heavy = statistics.median(s.bytes for s in near.more(10))
        self.assertGreater(heavy * self.rate, 1.5 * self.limit, "there is something to go down for")
        self.limited()
        weak = [self.view(WebSocketClient, weak=True), self.view()]
        self.goes_down(weak[0])
        before = near.newest().sequence
        settled = weak[0].more(4 * self.rate)
        wait_until(lambda: near.newest().sequence >= before + 4 * self.rate, "the others go on")
        for size in {s.size for s in weak[0].seen}:
            self.assertIn(size, {(round(SIZE[0] * r), round(SIZE[1] * r)) for r in RUNG_SIDES})
        self.in_order(weak[0])
        self.healthy_all_along(near)
        self.healthy_all_along(weak[1])
        self.assertLess(statistics.median(s.bytes for s in settled) * self.rate, 2 * self.limit)
        self.tell_ages("behind 2 Mbit/s", settled)
        self.tell_ages("beside it", near.seen[-4 * self.rate:])

    def test_nothing_old_waits(self):
        near = self.view()
        self.play()
        self.limited()
        weak = self.view(weak=True)
        weak.more(2 * self.rate)
        self.proxy.change("down", stalled=True)
        # As many at any rate, so that more is passed over than could be held.
        passed = len(near.more(2 * RATE))
        had = len(weak.seen)
        self.assertGreater(passed * statistics.median(s.bytes for s in weak.seen[-self.rate:]), 1.2 * (KERNEL_BYTES + HELD_BYTES))
        shown = near.newest().server_us  # the newest there is; a period later at the latest it waits for the weak one, too
        self.proxy.change("down", stalled=False, bytes_per_s=None)
        wait_until(lambda: weak.failure or weak.newest().server_us > shown, "it is current again")
        came = weak.seen[had:]
        period_us = 1e6 / self.rate
        old = [s for s in came if s.server_us < shown - 2 * period_us]
        self.assertLess(sum(s.bytes for s in old), KERNEL_BYTES + HELD_BYTES, "what the kernels held, and no more, is old")
        numbers = [s.server_us for s in came]
        self.assertGreater(max(b - a for a, b in zip(numbers, numbers[1:])), 0.25 * passed * period_us, "then it skips to what is shown now")
        self.in_order(weak)

    def test_who_would_rather_wait_is_sent_what_was_asked_for(self):
        self.play()
        self.limited()
        adaptive, stubborn = self.view(weak=True), self.view(weak=True, adaptive=False)
        http = self.server.keep(Mjpeg(self.proxy.port, "/scenes/main/stream.mjpg?" + urllib.parse.urlencode(
            {"width": SIZE[0], "height": SIZE[1], "rate": self.rate})))
        self.goes_down(adaptive)
        stubborn.more(self.rate // 2)
        self.assertEqual({s.size for s in stubborn.seen}, {SIZE})
        self.assertEqual({jpeg_size(http.picture()) for _ in range(len(stubborn.seen) // 2)}, {SIZE})

    def test_it_goes_up_again_when_the_link_does(self):
        near = self.view()
        self.play()
        self.full = statistics.median(s.bytes for s in near.more(10))
        self.limited()
        weak = self.view(weak=True)
        self.goes_down(weak)
        self.limited(False)
        self.goes_up(weak)
        self.in_order(weak)
        self.healthy_all_along(near)


class Stills(Ladder):
    def test_what_stands_still_is_shown_as_it_was_asked_for(self):
        near = self.view()
        self.play()
        self.limited()
        weak = self.view(weak=True)
        self.goes_down(weak)
        for t in (0.25, 0.75):
            self.c.call("playback.pause")
            seen = len(weak.seen)
            self.c.call("playback.seek", time=t)
            want = self.file(time=t, width=SIZE[0], height=SIZE[1], format="jpeg", quality=80)
            wait_until(lambda: weak.failure or weak.newest().size == SIZE and weak.newest().media_us == round(t * 1e6), "the full picture")
            wait_until(lambda: near.newest().media_us == round(t * 1e6), "near, too")
            coarse = [s for s in weak.seen[seen:] if s.size < SIZE and s.media_us == round(t * 1e6)]
            fine = [s for s in weak.seen[seen:] if s.size == SIZE and s.media_us == round(t * 1e6)]
            self.assertEqual(len(fine), 1)
            self.assertEqual((fine[0].bytes, fine[0].flags & LAST, fine[0].media_us), (len(want), LAST, round(t * 1e6)))
            self.assertEqual(len([s for s in near.seen if s.media_us == round(t * 1e6)]), 1, "who had it is sent nothing more")
            if coarse:
                print(f"\nrefined {(fine[0].came_us - coarse[-1].came_us) / 1e3:.0f} ms after the coarse picture had come")
            self.in_order(weak)
            self.play()
            self.goes_down(weak)


if __name__ == "__main__":
    harness.main()
