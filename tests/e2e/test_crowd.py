"""Readers that never read, readers that read slowly and healthy ones, of packets that stand alone and of chains, all at once: what
the healthy ones are given, what it costs the server in memory, and whether it answers meanwhile.

TWEEND_CROWD_SECONDS says how long, 15 unless told; a minute is what a release is tried with:

    TWEEND_CROWD_SECONDS=60 ctest --test-dir build/release -R e2e.crowd -V
"""
import os
import statistics
import time

import crowd
import harness
from harness import wait_until

SECONDS = float(os.environ.get("TWEEND_CROWD_SECONDS", 15))
MANNERS = {crowd.STUCK: 20, crowd.SLOW: 200, crowd.HEALTHY: 50}
RUNGS = 7  # of pictures: readers that can't take them are sent smaller ones, which they share
RUNG_BYTES = 2 << 20  # surfaces, pixels and packets of the producer of smaller ones, whoever watches
SIDE = 30  # 900 vertices
JOINTS = 64
# What a connection may make the server hold (docs/PROTOCOL.md, 5.3): itself, and of its one stream a packet that is being
# written and one that waits, or a chain of eight, or with `every` all that were made, each counting for 4 KiB at least, up to 16 MiB.
# Nobody of the crowd asks for anything more, so that neither answers nor events wait; but one pings.
CONNECTION_BYTES = 64 << 10
CHAIN = 8
EVERY_BYTES, EVERY_LEAST_BYTES = 16 << 20, 4096
ANSWERS_BYTES = 1 << 20
PING = b"\x89\xfd" + bytes(4 + 125)  # as large as they may be, masked by zeros


def share(packets, numbers):
    """Of the packets with these numbers, since the first one that came."""
    return len(packets) / sum(number >= packets[0][0] for number in numbers)


class Pinger:
    """A WebSocket that pings for all it can and never reads."""

    def __init__(self, client):
        self.sock, self.rest = client.sock, b""
        self.sock.setblocking(False)

    def ping(self):
        """Until the server takes no more, or it has taken a few thousand."""
        try:
            for _ in range(16):
                self.rest = self.rest or PING * 256
                self.rest = self.rest[self.sock.send(self.rest):]
        except OSError:  # it takes none, or it has cut us off
            pass


class CrowdTest(harness.TestCase):
    render = True

    def setUp(self):
        super().setUp()
        # A sanitizer slows all of it down, and its run is to show races and leaks.
        rate, self.seconds = (10, min(SECONDS, 15)) if self.server.sanitized() else (30, SECONDS)
        vertices, frames, pose = ({"kind": "vertices", "actor": "grid", "rate": rate},
                                  {"kind": "frames", "width": 320, "height": 180, "rate": rate},
                                  {"kind": "pose", "actor": "chain", "rate": rate})
        chained = [frames | {"encoding": "h264"}, vertices | {"encoding": "meshopt"}, pose | {"encoding": "q16"}]
        every = pose | {"delivery": "every"}
        self.streams = [vertices, frames, pose, *chained]
        self.asked = {crowd.HEALTHY: [vertices, frames, pose, every], crowd.SLOW: self.streams,
                      crowd.STUCK: [*self.streams, *self.streams, every]}
        self.waiting = {crowd.name_of(s): CHAIN if s in chained else 1 for s in self.streams} | {crowd.name_of(every): self.seconds * rate}
        self.add_waving_grid(SIDE)
        joints = [{"name": f"j{i}"} | ({"parent": f"j{i - 1}", "translation": [0, 0.1, 0]} if i else {}) for i in range(JOINTS)]
        self.c.call("actor.add", actor="chain", skeleton={"joints": joints})
        for angle in (0.0, 0.5):
            self.c.call("keyframe.add", actor="chain", pose={f"j{i}": {"rotation": [0, 0, angle, 1]} for i in range(JOINTS)})
        self.c.call("playback.play", speed=0.05)

    def budget_mib(self, largest):
        """What the crowd and the one who pings may make the server hold, given the largest packet of each stream."""
        def of_stream(manner, what):
            if manner == crowd.HEALTHY:
                return 2 * largest[what]
            if what.endswith("every"):
                return min(EVERY_BYTES, self.waiting[what] * max(largest[what], EVERY_LEAST_BYTES))
            return (1 + self.waiting[what]) * largest[what]
        streams = [(manner, crowd.name_of(s)) for manner, count in MANNERS.items() for s in (self.asked[manner] * count)[:count]]
        return ((RUNGS - 1) * RUNG_BYTES + CONNECTION_BYTES + ANSWERS_BYTES + sum(CONNECTION_BYTES + of_stream(*s) for s in streams)) / (1 << 20)

    def ask(self, round_trips_ms):
        """One request of each of some kinds; that all are answered is what calling them means."""
        for method, params in (("server.ping", {}), ("playback.get", {"actor": "grid"}), ("actor.update", {"actor": "grid", "spin": 0.1}),
                               ("playback.set", {"actor": "chain", "speed": 0.05})):
            start = time.perf_counter()
            self.c.call(method, **params)
            round_trips_ms.setdefault(method, []).append((time.perf_counter() - start) * 1e3)

    def test_healthy_readers_in_a_crowd(self):
        watcher = self.server.line()
        for stream in self.streams:  # the producers' memory is not the crowd's
            number = watcher.call("stream.open", **stream)["stream"]
            watcher.packet(number)
            watcher.packet(number)
        watcher.close()
        before_mib, most_mib = self.server.rss_mib(), 0.0
        people = crowd.Crowd(self.server.port, MANNERS, self.asked, self.seconds)
        self.addCleanup(people.close)
        people.ready()
        pinger = Pinger(self.server.websocket(receive_buffer=crowd.SMALL_BUFFER))
        round_trips_ms = {}
        while people.running(seconds=0.01):  # a client that asks now and then
            pinger.ping()
            self.ask(round_trips_ms)
            most_mib = max(most_mib, self.server.rss_mib())
        away_s, readers = people.result()
        stats = self.c.call("server.stats")
        self.assertEqual(stats["tweend_streams"], sum(MANNERS.values()))
        self.assertLessEqual(stats["tweend_producers"], len(self.streams) + RUNGS - 1)

        given, largest = {}, {}  # numbers that any of the healthy has; bytes
        for manner, what, packets in readers:
            if manner == crowd.HEALTHY:
                given.setdefault(what, set()).update(number for number, _ in packets)
            largest[what] = max([largest.get(what, 0)] + [size for _, size in packets])
        shares = {}
        for manner, what, packets in readers:
            numbers = [number for number, _ in packets]
            self.assertEqual(numbers, sorted(set(numbers)), f"{manner} {what}")
            if what.endswith("every") and numbers:
                self.assertEqual(numbers[-1] - numbers[0] + 1, len(numbers), "none is skipped")
            if manner != crowd.STUCK:
                self.assertGreater(len(numbers), 1, f"{manner} {what}")
                produced = range(max([*given.get(what, ()), *numbers]) + 1)
                shares.setdefault((manner, what), []).append(share(packets, given[what] if manner == crowd.HEALTHY else produced))
        budget_mib = self.budget_mib(largest) * (6 if self.server.sanitized() else 1)
        self.tell(shares, round_trips_ms, most_mib - before_mib, budget_mib, stats)
        # What was replaced while all of them were kept from reading is not the server's fault.
        least = 0.98 - away_s / self.seconds
        for what, numbers in given.items():
            self.assertGreaterEqual(len(numbers), least * (max(numbers) - min(numbers) + 1), f"{what}, away for {away_s:.1f} s")
        for (manner, what), kept in shares.items():
            if manner == crowd.HEALTHY:
                self.assertGreaterEqual(min(kept), 0.98, f"{what}: {sorted(kept)[:5]}")
        self.assertGreater(stats["tweend_packets_skipped_total"], 100, "the others did skip")
        self.assertLess(most_mib - before_mib, budget_mib)

        people.close()
        wait_until(lambda: self.c.call("server.stats")["tweend_producers"] == 0, "the crowd is forgotten")
        self.assertEqual(self.c.call("server.stats")["tweend_streams"], 0)

    def tell(self, shares, round_trips_ms, grown_mib, budget_mib, stats):
        print(f"\n{self.seconds:g} s: {stats['tweend_packets_produced_total']} packets produced, {stats['tweend_packets_sent_total']} sent, "
              f"{stats['tweend_packets_skipped_total']} skipped; the server grew by {grown_mib:.1f} of {budget_mib:.0f} MiB")
        for (manner, what), kept in sorted(shares.items()):
            print(f"  {manner:8}{what:17} of the packets produced came: worst {min(kept):.4f}, median {statistics.median(kept):.4f}")
        for method, times in round_trips_ms.items():
            times.sort()
            print(f"  {method:18}{len(times)} answered: median {statistics.median(times):.2f} ms, p99 {times[int(0.99 * len(times))]:.2f} ms")


if __name__ == "__main__":
    harness.main()
