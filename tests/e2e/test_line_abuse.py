"""Line JSON: limits, noise, and clients that are slow or vanish; nobody else is disturbed (sections 1 and 5.3)."""
import contextlib
import random
import socket
import time

import harness
from client import PATIENCE_S, Closed, LineClient, Packet, request_json
from harness import wait_until

MIB = 1 << 20


def padded(size):
    """A good request of just so many bytes."""
    text = request_json("server.ping", id=1)
    return text[:-1] + b" " * (size - len(text)) + b"}"


class Limits(harness.TestCase):
    def send_too_much(self, data):
        """Whoever is slow with the last of it may be cut off meanwhile; the answer is there all the same."""
        with contextlib.suppress(ConnectionError):
            self.c.send_raw(data)

    def ends_after(self, code):
        answer = self.c.read()
        self.assertEqual((answer["id"], answer["error"]["code"]), (None, code))
        self.assertEqual(self.c.read_to_end(), [])
        self.server.line().call("server.ping")

    def test_a_line_of_the_limit_is_answered(self):
        self.c.send_raw(padded(16 * MIB) + b"\n")
        self.assertEqual(self.c.read()["id"], 1)
        self.c.call("server.ping")

    def test_a_line_over_the_limit_is_answered_and_the_connection_closed(self):
        self.send_too_much(padded(16 * MIB + 1) + b"\n")
        self.ends_after(-32004)

    def test_a_line_over_the_limit_is_not_waited_out(self):
        self.send_too_much(b"[" + b" " * (16 * MIB + 70000))
        self.ends_after(-32004)

    def test_requests_before_a_line_that_is_too_long_are_answered(self):
        self.c.send_raw(b"".join(request_json(m, id=i) + b"\n" for i, m in enumerate(("scene.list", "asset.list", "scene.describe"))))
        self.send_too_much(b" " + padded(16 * MIB + 1) + b"\n")
        self.assertEqual([self.c.read()["id"] for _ in range(3)], [0, 1, 2])
        self.ends_after(-32004)

    def test_nesting(self):
        def nested(depth):  # the message itself is the first level, its params the second
            return b'{"jsonrpc":"2.0","id":1,"method":"server.ping","params":{"x":' + b"[" * (depth - 2) + b"]" * (depth - 2) + b"}}"
        for depth, code in ((3, -32602), (64, -32602), (65, -32004), (5000, -32004)):
            self.c.send_raw(nested(depth) + b"\n")
            self.assertEqual(self.c.read()["error"]["code"], code, depth)
        self.c.send_raw(b"[" * 100000 + b"\n")
        self.assertIn(self.c.read()["error"]["code"], (-32004, -32700))
        self.c.send_raw(b'{"a":' * 100000 + b"\n")
        self.assertIn(self.c.read()["error"]["code"], (-32004, -32700))
        self.c.call("server.ping")

    def test_what_is_not_utf8_is_answered_and_the_connection_closed(self):
        for text in (b"\xff", b"\xc0\x80", b"\xed\xa0\x80", b"\xf5\x80\x80\x80", b"\xe2\x82", b"\x80", b"\xf0\x82\x82\xac"):
            self.c = self.server.line()
            self.c.send_raw(request_json("scene.list", id=1) + b"\n" + b'{"jsonrpc":"2.0","id":"' + text +
                            b'","method":"scene.list"}\n' + request_json("scene.list", id=3) + b"\n")
            self.assertEqual(self.c.read()["id"], 1)
            self.ends_after(-32700)


class Noise(harness.TestCase):
    def ends_silently(self, data):
        patient = self.server.line()  # says nothing: whoever is out of patience ends this one first
        c = self.server.line()
        c.send_raw(data)
        try:
            c.fill(time.monotonic() + PATIENCE_S)
            self.fail(f"{data[:20]} was answered {bytes(c.received[:100])}")
        except Closed:
            pass
        patient.call("server.ping")
        patient.close()
        c.close()

    def test_unknown_first_bytes_close_the_connection(self):
        for data in (b"\x00", b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", b"\xff\xfe", b"x", b"hello\n", b"GARBAGE / HTTP/1.1\r\n\r\n",
                     b"get / HTTP/1.1\r\n\r\n", b"1\n", b'"x"\n', b"null\n", b"\xef\xbb\xbf{}\n", b"SSH-2.0-OpenSSH_9.2\r\n"):
            self.ends_silently(data)
        self.c.call("server.ping")

    def test_random_bytes_never_take_it_down(self):
        rng = random.Random(time.time_ns())
        good = request_json("keyframe.add", {"time": 1, "vertices": {"positions": [0] * 9}}, 1) + b"\n"
        for i in range(120):
            c = LineClient(self.server.port)
            data = rng.randbytes(rng.randrange(1, 3000))
            if i % 3 == 1:
                data = b"{" + data
            if i % 3 == 2:
                changed = bytearray(good)
                for _ in range(3):
                    changed[rng.randrange(len(changed))] = rng.randrange(256)
                data = bytes(changed)
            try:
                c.send_raw(data)
                c.sock.shutdown(socket.SHUT_WR)
                c.sock.recv(65536)
            except OSError:
                pass  # closed while sending, as it should
            c.close()
        self.c.call("server.ping")
        wait_until(lambda: self.c.call("server.stats")["tweend_connections"] == 1, "the others are gone")


class Slow(harness.TestCase):
    def test_a_client_that_says_nothing_at_first(self):
        quiet = [self.server.line() for _ in range(3)]
        wait_until(lambda: self.c.call("server.stats")["tweend_connections"] == 4, "all are connected")
        self.assertEqual(quiet[0].call("server.hello")["server"], "tweend")

    def test_a_byte_at_a_time(self):
        for byte in request_json("scene.list", id=1) + b"\r\n":
            self.c.send_raw(bytes([byte]))
        self.assertEqual(self.c.read()["id"], 1)
        c = self.server.http_client()
        for byte in c.request_bytes("GET", "/healthz"):
            c.send_raw(bytes([byte]))
        self.assertEqual(c.read_answer()[0], 200)

    def test_half_a_client(self):
        """One that has ended its own side gets all its answers."""
        count = 200
        self.c.send_raw(b"".join(request_json("asset.list" if i % 5 == 0 else "scene.list", id=i) + b"\n" for i in range(count)))
        self.c.sock.shutdown(socket.SHUT_WR)
        self.assertEqual([m["id"] for m in self.c.read_to_end()], list(range(count)))


class Vanishing(harness.TestCase):
    """A healthy client goes on, and nothing of those that vanish is left behind."""

    def setUp(self):
        super().setUp()
        self.add_waving_grid(60, (1.0, 2.0, 0.0))
        self.stream = self.c.call("stream.open", kind="vertices", rate=60)["stream"]
        self.c.call("playback.play")
        self.packets = []

    def healthy(self):
        """The healthy client's next packets come, in order, and only those."""
        for _ in range(3):
            self.packets.append(self.c.packet(self.stream))
        sequences = [p.sequence for p in self.packets]
        self.assertEqual(sequences, sorted(set(sequences)))

    def tidy(self):
        wait_until(lambda: (lambda s: s["tweend_connections"] == 1 and s["tweend_streams"] == 1 and s["tweend_producers"] == 1)(
            self.c.call("server.stats")), "connections and streams of those that vanished are gone")
        self.healthy()

    def test_in_mid_line(self):
        for i in range(20):
            c = self.server.line()
            c.send_raw(request_json("scene.describe", id=1) + b"\n" + request_json("keyframe.remove", {"keyframe": 1}, 2)[:-(i % 20) - 1])
            c.reset() if i % 2 else c.close()
        self.tidy()
        self.assertEqual(len(self.c.call("keyframe.list")["keyframes"]), 3, "half a request is not carried out")

    def test_in_mid_packet(self):
        for i in range(10):
            c = self.server.line(receive_buffer=4096)
            c.call("stream.open", kind="vertices", rate=120)
            c.take(1000, time.monotonic() + 30)
            c.reset() if i % 2 else c.close()
            self.healthy()
        self.tidy()

    def test_with_answers_on_their_way(self):
        for i in range(10):
            c = self.server.line(receive_buffer=4096)
            c.call("events.subscribe")
            for _ in range(10):
                c.send("vertices.sample", indices=True)
                c.send("playback.set", speed=1)
            c.reset() if i % 2 else c.close()
            self.healthy()
        self.tidy()

    def test_in_the_middle_of_a_websocket_frame(self):
        for i in range(10):
            c = self.server.websocket()
            c.call("stream.open", kind="vertices", rate=120)
            c.send_raw(b"\x81\xfe\x10\x00\x01\x02\x03\x04{")
            c.reset() if i % 2 else c.close()
            self.healthy()
        self.tidy()

    def test_in_the_middle_of_an_http_request(self):
        for data in (b"POST /rpc HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\nContent-Length: 1000\r\n\r\n{",
                     b"GET /healthz HTTP/1.1\r\nHo", b"G", b"GET /ws HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\n"):
            for reset in (True, False):
                c = self.server.http_client()
                c.send_raw(data)
                c.reset() if reset else c.close()
        self.healthy()
        self.tidy()

    def test_a_notification_by_one_that_vanishes_is_carried_out(self):
        c = self.server.line()
        c.notify("keyframe.remove", keyframe=1)
        c.close()
        wait_until(lambda: len(self.c.call("keyframe.list")["keyframes"]) == 2, "the edit")
        self.healthy()
        self.assertTrue(all(isinstance(p, Packet) for p in self.packets))


if __name__ == "__main__":
    harness.main()
