"""Readers that never read, readers that read slowly and healthy ones, all at once: what the healthy ones are given, what it
costs the server in memory, and whether it answers meanwhile.

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
SIDE = 30  # 900 vertices
JOINTS = 64
PACKET_BYTES = 40 + 900 * 24  # of vertices, the largest ones
# What a connection may make the server hold (docs/PROTOCOL.md, 5.3): itself, and of its one stream a packet that is being
# written and one that waits. Nobody of the crowd asks for anything more, so that neither answers nor events wait.
CONNECTION_BYTES = 64 << 10
BUDGET_MIB = sum(MANNERS.values()) * (CONNECTION_BYTES + 2 * PACKET_BYTES) / (1 << 20)


def share(sequences, newest):
    """Of the packets produced since the first one that came."""
    return len(sequences) / (newest - sequences[0][0] + 1)


class CrowdTest(harness.TestCase):
    render = True

    def setUp(self):
        super().setUp()
        rate = 10 if self.server.sanitized() else 30
        self.streams = [{"kind": "vertices", "actor": "grid", "rate": rate},
                        {"kind": "frames", "width": 320, "height": 180, "rate": rate},
                        {"kind": "pose", "actor": "chain", "rate": rate}]
        self.c.call("actor.add", actor="grid", mesh=harness.grid(SIDE))
        for height in (0.0, 1.0):
            self.c.call("keyframe.add", actor="grid", vertices={"positions": harness.grid(SIDE, height)["positions"]})
        joints = [{"name": f"j{i}"} | ({"parent": f"j{i - 1}", "translation": [0, 0.1, 0]} if i else {}) for i in range(JOINTS)]
        self.c.call("actor.add", actor="chain", skeleton={"joints": joints})
        for angle in (0.0, 0.5):
            self.c.call("keyframe.add", actor="chain", pose={f"j{i}": {"rotation": [0, 0, angle, 1]} for i in range(JOINTS)})
        self.c.call("playback.play", speed=0.05)

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
        people = crowd.Crowd(self.server.port, MANNERS, self.streams, SECONDS)
        self.addCleanup(people.close)
        people.ready()
        round_trips_ms = {}
        while people.running(seconds=0.01):  # a client that asks now and then
            self.ask(round_trips_ms)
            most_mib = max(most_mib, self.server.rss_mib())
        readers = people.result()
        stats = self.c.call("server.stats")
        self.assertEqual(stats["tweend_streams"], sum(MANNERS.values()))
        self.assertLessEqual(stats["tweend_producers"], len(self.streams) + RUNGS - 1)

        newest = {}
        for _, kind, sequences in readers:
            newest[kind] = max([newest.get(kind, 0)] + [s[0] for s in sequences])
        shares = {}
        for manner, kind, sequences in readers:
            numbers = [s[0] for s in sequences]
            self.assertEqual(numbers, sorted(set(numbers)), f"{manner} {kind}")
            if manner != crowd.STUCK:
                self.assertGreater(len(numbers), 1, f"{manner} {kind}")
                shares.setdefault((manner, kind), []).append(share(sequences, newest[kind]))
        self.tell(shares, round_trips_ms, most_mib - before_mib, stats)
        for (manner, kind), kept in shares.items():
            if manner == crowd.HEALTHY:
                self.assertGreaterEqual(min(kept), 0.98, f"{kind}: {sorted(kept)[:5]}")
        self.assertGreater(stats["tweend_packets_skipped_total"], 100, "the others did skip")
        self.assertLess(most_mib - before_mib, BUDGET_MIB * (6 if self.server.sanitized() else 1))

        people.close()
        wait_until(lambda: self.c.call("server.stats")["tweend_producers"] == 0, "the crowd is forgotten")
        self.assertEqual(self.c.call("server.stats")["tweend_streams"], 0)

    def tell(self, shares, round_trips_ms, grown_mib, stats):
        print(f"\n{SECONDS:g} s: {stats['tweend_packets_produced_total']} packets produced, {stats['tweend_packets_sent_total']} sent, "
              f"{stats['tweend_packets_skipped_total']} skipped; the server grew by {grown_mib:.1f} of {BUDGET_MIB:.0f} MiB")
        for (manner, kind), kept in sorted(shares.items()):
            print(f"  {manner:8}{kind:10} of the packets produced came: worst {min(kept):.4f}, median {statistics.median(kept):.4f}")
        for method, times in round_trips_ms.items():
            times.sort()
            print(f"  {method:18}{len(times)} answered: median {statistics.median(times):.2f} ms, p99 {times[int(0.99 * len(times))]:.2f} ms")


if __name__ == "__main__":
    harness.main()
