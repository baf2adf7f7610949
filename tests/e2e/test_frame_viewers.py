"""Many viewers of pictures (section 6): who shares a producer, cameras of their own, and viewers that do not read."""
import time

import harness
import pictures
from client import LAST, Packet
from harness import wait_until
from pictures import STRAIGHT

LEFT = STRAIGHT | {"eye": [-6, 2, 8]}
RIGHT = STRAIGHT | {"eye": [6, 2, 8]}


class Viewers(pictures.GrowingCase):
    def look(self, stream, camera, client=None):
        self.assertEqual((client or self.c).call("stream.update", stream=stream, camera=camera), {})

    def counts(self):
        stats = self.other.call("server.stats")
        return stats["tweend_streams"], stats["tweend_producers"]

    def become(self, streams, producers):
        """Producers start and end behind the answers."""
        wait_until(lambda: self.counts() == (streams, producers), f"{streams} streams of {producers} producers")

    def ends_with(self, stream, payload, client=None):
        """The stream comes to rest with this picture: the packets until then."""
        packets = [(client or self.c).packet(stream)]
        while packets[-1].payload != payload or not packets[-1].flags & LAST:  # while it plays slowly, pictures may be equal
            packets.append((client or self.c).packet(stream))
        self.assertEqual([m for m in (client or self.c).settle() if isinstance(m, Packet)], [])
        return packets


class Sharing(Viewers):
    def test_eight_viewers_of_one_view_share_a_producer(self):
        clients = [self.server.line() for _ in range(4)] + [self.server.websocket() for _ in range(4)]
        viewers = [(c, self.open(c, rate=50, encoding="jpeg")) for c in clients]
        for c, stream in viewers:
            c.packet(stream)
        self.become(8, 1)
        before = self.other.call("server.stats")["tweend_packets_produced_total"]
        for i in range(1, 9):
            self.seek(i / 10)
            packets = [c.packet_where(lambda p: p.media_us == i * 100_000, stream) for c, stream in viewers]
            self.assertEqual(len({(p.payload, p.sequence, p.server_us, p.revision) for p in packets}), 1)
        self.assertEqual(self.other.call("server.stats")["tweend_packets_produced_total"] - before, 8)

    def test_all_see_the_same_while_it_plays(self):
        viewers = [(c, self.open(c, rate=30, encoding="jpeg")) for c in [self.server.line() for _ in range(8)]]
        self.other.call("playback.play")
        seen = [{p.sequence: (p.payload, p.media_us, p.server_us) for p in [c.packet(s) for _ in range(25)]} for c, s in viewers]
        common = set.intersection(*[set(packets) for packets in seen])
        self.assertGreater(len(common), 10)
        for sequence in common:
            self.assertEqual(len({packets[sequence] for packets in seen}), 1)

    def test_what_tells_producers_apart(self):
        self.c.call("scene.create", scene="s")
        kinds = ({}, {"camera": LEFT}, {"camera": RIGHT}, {"width": 101}, {"encoding": "jpeg"}, {"encoding": "jpeg", "quality": 50}, {"rate": 29},
                 {"scene": "s"}, {"encoding": "rgba"})
        for kind in kinds:
            self.open(**kind)
        self.become(len(kinds), len(kinds))
        for kind in kinds:
            self.open(self.server.line(), **kind)
            self.server.clients[-1].packet()
        self.become(2 * len(kinds), len(kinds))

    def test_a_parameter_that_says_the_default_is_the_same_as_none(self):
        self.open(encoding="jpeg")
        for same in ({"scene": "main"}, {"rate": 30}, {"quality": 80}, {"delivery": "latest"}):
            self.c.packet(self.open(encoding="jpeg", **same))
        self.become(5, 1)

    def test_a_late_viewer_is_nothing_new_to_the_others(self):
        stream = self.open()
        first = self.c.packet(stream)
        late = self.server.line()
        packet = late.packet(self.open(late))
        self.assertEqual((packet.payload, packet.sequence, packet.server_us), (first.payload, first.sequence, first.server_us))
        self.seek(1)
        self.assertEqual(self.c.packet(stream).sequence, first.sequence + 1, "it was sent nothing in between")

    def test_the_producer_goes_with_its_last_viewer(self):
        clients = [self.server.line() for _ in range(3)]
        for c in clients:
            self.open(c)
        for left, c in zip((2, 1, 0), clients):
            c.close()
            self.become(left, 1 if left else 0)


class Cameras(Viewers):
    def test_an_update_brings_the_picture_from_there_and_null_goes_back(self):
        stream = self.open()
        plain = self.c.packet(stream).payload
        revision = self.other.call("scene.describe")["revision"]
        for camera in (LEFT, RIGHT, {"fit": True}, {"orbit": {"azimuth": 1, "elevation": 0.5, "distance": 15}}):
            want = self.file(camera=camera)
            self.assertNotEqual(want, plain)
            self.look(stream, camera)
            self.assertEqual(len(self.ends_with(stream, want)), 1)
            self.look(stream, None)
            self.assertEqual(len(self.ends_with(stream, plain)), 1)
        self.assertEqual(self.other.call("scene.describe")["revision"], revision)

    def test_a_camera_replaces_the_one_before_as_a_whole(self):
        stream = self.open(camera=LEFT | {"fov_y": 0.4})
        self.c.packet(stream)
        self.look(stream, {"eye": RIGHT["eye"]})
        self.ends_with(stream, self.file(camera={"eye": RIGHT["eye"]}))

    def test_the_same_camera_again_brings_nothing(self):
        stream = self.open(camera=LEFT)
        first = self.c.packet(stream)
        for _ in range(3):
            self.look(stream, LEFT)
        self.seek(1)
        self.assertEqual(self.c.packet(stream).sequence, first.sequence + 1)

    def test_cameras_that_are_refused_leave_the_stream_as_it_was(self):
        stream = self.open(camera=LEFT)
        first = self.c.packet(stream)
        self.refused(-32602, "stream.update", path="params.camera.eye", stream=stream, camera={"eye": [0, 0, 0], "target": [0, 0, 0]})
        self.refused(-32602, "stream.update", path="params.camera.x", stream=stream, camera={"x": 1}, rate=5)
        self.refused(-32602, "stream.update", path="params.width", stream=stream, width=64)
        self.refused(-32602, "stream.update", path="params.rate", stream=stream, camera=RIGHT, rate=1000)
        self.seek(1)
        packet = self.c.packet(stream)
        self.assertEqual((packet.payload, packet.sequence), (self.file(camera=LEFT, time=1), first.sequence + 1))

    def test_a_viewer_that_looks_elsewhere_moves_no_one_else(self):
        a, b = self.server.line(), self.server.websocket()
        streams = {a: self.open(a), b: self.open(b)}
        plain = a.packet(streams[a])
        b.packet(streams[b])
        self.become(2, 1)
        self.look(streams[b], LEFT, b)
        self.ends_with(streams[b], self.file(camera=LEFT), b)
        self.become(2, 2)
        self.assertEqual([m for m in a.settle() if isinstance(m, Packet)], [])
        self.look(streams[b], None, b)
        self.ends_with(streams[b], plain.payload, b)
        self.become(2, 1)
        self.seek(1)
        self.assertEqual(a.packet(streams[a]).payload, b.packet(streams[b]).payload)

    def test_the_scene_s_camera_moves_those_without_their_own(self):
        viewer = self.server.websocket()
        follows, own = self.open(), self.open(viewer, camera=LEFT)
        self.c.packet(follows)
        self.ends_with(own, self.file(camera=LEFT), viewer)
        self.other.call("camera.set", eye=[2, 3, 9])
        self.ends_with(follows, self.file())
        self.ends_with(own, self.file(camera=LEFT), viewer)
        self.look(own, None, viewer)
        self.ends_with(own, self.file(), viewer)

    def test_fifty_updates_at_once_end_with_the_last(self):
        for client in (self.c, self.server.websocket()):
            stream = self.open(client, rate=20)
            client.packet(stream)
            for i in range(50):
                last = STRAIGHT | {"eye": [0.2 * i - 4, 1, 9]}
                client.send("stream.update", stream=stream, camera=last)
            client.answer(client.last_id)
            packets = self.ends_with(stream, self.file(camera=last), client)
            self.assertLess(len(packets), 40, "what is out of date is not drawn")

    def test_updates_while_it_plays(self):
        stream = self.open(rate=30)
        self.other.call("playback.play", speed=0.3)
        numbers = [self.c.packet(stream).sequence]
        for camera in (LEFT, None, RIGHT, {"fit": True}):
            self.look(stream, camera)
            numbers += [self.c.packet(stream).sequence for _ in range(3)]
        self.assertEqual(numbers, sorted(set(numbers)), "numbers go on")
        self.other.call("playback.pause")
        self.ends_with(stream, self.file(camera={"fit": True}))

    def test_fit_follows_edits(self):
        stream = self.open(camera={"fit": True})
        self.c.packet(stream)
        self.other.call("actor.update", transform={"translation": [50, 0, 0]})
        self.ends_with(stream, self.file(camera={"fit": True}))


class SlowViewers(Viewers):
    """Pictures without compression: 400 x 300 are 480 kB each."""
    LARGE = {"encoding": "rgba", "width": 400, "height": 300, "rate": 30}

    def stuck(self, **kw):
        c = self.server.line(receive_buffer=8192)
        c.send("stream.open", kind="frames", **self.LARGE | kw)
        return c

    def skipped(self):
        return self.other.call("server.stats")["tweend_packets_skipped_total"]

    def skips(self, count):
        before = self.skipped()
        wait_until(lambda: self.skipped() > before + count, "packets are skipped")

    def test_viewers_that_never_read_hold_no_one_up(self):
        self.other.call("playback.play", speed=0.2)
        stream = self.open(**self.LARGE)
        for _ in range(5):
            self.c.packet(stream)
        stuck = [self.stuck(), *(self.stuck() for _ in range(6)), self.stuck(camera=LEFT), self.stuck(encoding="jpeg", quality=100)]
        for _ in range(15):
            self.c.packet(stream)
        before = self.server.rss_mib()

        def healthy():  # unless this machine keeps it from reading
            packets = [self.c.packet(stream)]
            until = time.monotonic() + 1.5
            while time.monotonic() < until:
                packets.append(self.c.packet(stream))
            produced = packets[-1].sequence - packets[0].sequence + 1
            return produced > 8 and len(packets) > 0.7 * produced
        self.keeps_up(healthy, "of more than 8 pictures in 1.5 s, 0.7 come")
        self.grew_less(before, 48)
        for c in stuck:
            c.close()
        self.become(1, 1)

    def test_one_that_reads_again_finds_what_is_shown_now(self):
        self.other.call("playback.play", speed=0.2)
        stuck = self.stuck()
        stream = stuck.answer(stuck.last_id)["stream"]
        first = stuck.packet(stream)
        self.skips(15)
        now_us = self.other.call("server.ping")["time_us"]
        packets = [stuck.packet(stream)]
        while packets[-1].server_us < now_us:
            packets.append(stuck.packet(stream))
            self.assertLess(len(packets), 20, "pictures of long ago")
        gaps = [b.sequence - a.sequence for a, b in zip([first, *packets], packets)]
        self.assertGreater(max(gaps), 5, "a gap shows what was skipped")
        self.other.call("playback.pause")
        final = stuck.packet_where(lambda p: p.flags & LAST, stream)
        self.assertEqual(pictures.Picture.of_rgba(400, 300, final.payload), self.picture(width=400, height=300))


if __name__ == "__main__":
    harness.main()
