"""WebSocket (RFC 6455) on /ws: the same messages, packets as binary messages."""
import json
import time

import harness
from client import BINARY, CLOSE, PING, PONG, TEXT, Packet, request_json


class Opening(harness.TestCase):
    def shake(self, *subprotocols, **changes):
        ws = self.server.websocket(handshake=False)
        return ws, *ws.shake_hands(subprotocols, **changes)

    def test_with_and_without_the_subprotocol(self):
        for offered in ((), ("tweend.v1",), ("other", "tweend.v1")):
            ws = self.server.websocket(subprotocols=offered)  # checks what the server chose
            self.assertIn("time_us", ws.call("server.ping"))

    def test_an_unknown_subprotocol_is_never_chosen(self):
        _, status, headers = self.shake("tweend.v9", "x")
        self.assertNotIn("sec-websocket-protocol", headers)
        self.assertIn(status, (101, 400))

    def test_what_is_no_handshake_is_refused(self):
        for changes in ({"Sec_WebSocket_Version": "8"}, {"Sec_WebSocket_Version": None}, {"Sec_WebSocket_Key": None},
                        {"Upgrade": None}, {"Connection": "close"}, {"Upgrade": "h2c"}):
            _, status, _ = self.shake("tweend.v1", **changes)
            self.assertIn(status, range(400, 500), changes)

    def test_header_names_and_values_in_any_case(self):
        _, status, _ = self.shake("tweend.v1", Upgrade="WebSocket", Connection="keep-alive, upgrade")
        self.assertEqual(status, 101)

    def test_after_other_requests_on_the_same_connection(self):
        ws = self.server.websocket(handshake=False)
        ws.send_raw(b"GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
        while b"ok\n" not in ws.received:
            ws.fill(time.monotonic() + 30)
        ws.received.clear()
        self.assertEqual(ws.shake_hands(("tweend.v1",))[0], 101)
        ws.call("server.ping")


class Messages(harness.TestCase):
    def setUp(self):
        super().setUp()
        self.ws = self.server.websocket()

    def test_answers_are_text_messages_in_order(self):
        ids = [self.ws.send(m) for m in ("scene.list", "asset.list", "scene.describe", "asset.list", "server.stats") * 20]
        self.assertEqual([self.ws.read()["id"] for _ in ids], ids)

    def test_errors_batches_and_notifications_as_on_line_json(self):
        for text, code in ((b"{oops", -32700), (b"", -32700), (b"1", -32600), (b"[" * 100, -32004)):
            self.ws.send_message(text)
            answer = self.ws.read()
            self.assertEqual((answer["id"], answer["error"]["code"]), (None, code), text)
        self.ws.send_message(json.dumps([json.loads(request_json("scene.list", id=i)) for i in range(3)]).encode())
        self.assertEqual([m["id"] for m in self.ws.read()], [0, 1, 2])
        self.ws.notify("scene.create", scene="a")
        self.assertEqual(len(self.ws.call("scene.list")["scenes"]), 2)

    def test_line_ends_within_a_message_are_white_space(self):
        self.ws.send_message(b'\r\n{"jsonrpc":"2.0",\n"id":1,\n"method":"scene.list"}\n')
        self.assertEqual(self.ws.read()["id"], 1)

    def test_packets_are_binary_messages(self):
        self.add_moving()
        opened = self.ws.call("stream.open", kind="vertices")
        packet = self.ws.packet()
        self.assertEqual((packet.stream, packet.kind, packet.media_us), (opened["stream"], 2, 0))
        self.assertEqual(packet.positions(), self.c.call("vertices.sample")["positions"])

    def test_large_answers_and_packets(self):
        """Frames with 16-bit and 64-bit lengths."""
        for n in (20, 120):
            mesh = harness.grid(n)
            self.ws.call("actor.add", actor=f"grid{n}", mesh=mesh)
            sample = self.ws.call("vertices.sample", actor=f"grid{n}", indices=True)
            self.assertEqual(sample["indices"], mesh["indices"])
            stream = self.ws.call("stream.open", kind="vertices", actor=f"grid{n}")["stream"]
            self.assertEqual(len(self.ws.packet(stream).payload), n * n * 24)

    def test_pings_are_answered_with_their_payload_amid_streaming(self):
        self.add_waving_grid(50, (1.0, 0.0))
        self.ws.call("stream.open", kind="vertices", rate=240)
        self.c.call("playback.play")
        sent = []
        for i in range(30):
            sent.append(f"ping {i} ".encode() + b"\0\xff" * i)
            self.ws.send_frame(PING, sent[-1])
            self.ws.packet()
            self.ws.call("server.ping")
        while len(self.ws.pongs) < len(sent):
            self.ws.packet()
        self.assertEqual(self.ws.pongs, sent)

    def test_messages_in_parts_with_pings_between(self):
        text = request_json("server.hello", {"client": "ä😀" * 100}, 1)
        for size in (1, 7, 100):
            parts = [text[i:i + size] for i in range(0, len(text), size)]
            for i, part in enumerate(parts):
                self.ws.send_frame(TEXT if i == 0 else 0, part, fin=i == len(parts) - 1)
                if i == 1:
                    self.ws.send_frame(PING, b"between")
            self.assertEqual(self.ws.read()["id"], 1)
            self.assertEqual(self.ws.pongs.pop(), b"between")
        self.ws.send_frame(TEXT, text, fin=False)
        self.ws.send_frame(0, b"", fin=True)
        self.assertEqual(self.ws.read()["id"], 1)

    def test_pongs_that_nobody_asked_for_are_ignored(self):
        self.ws.send_frame(PONG, b"unasked")
        self.ws.call("server.ping")

    def test_events(self):
        self.ws.call("events.subscribe")
        self.c.call("camera.set", eye=[1, 2, 3])
        self.assertEqual(self.ws.event("scene.changed")["method"], "camera.set")


class Ending(harness.TestCase):
    def setUp(self):
        super().setUp()
        self.ws = self.server.websocket()

    def ends_with(self, code, ws=None):
        ws = ws or self.ws
        ws.read_to_end()
        self.assertEqual(ws.close_code, code)
        self.c.call("server.ping")
        harness.wait_until(lambda: self.c.call("server.stats")["tweend_connections"] == 1, "its connection is gone")

    def test_a_close_is_answered_in_kind(self):
        for payload, code in ((b"\x03\xe8", 1000), (b"\x03\xe9going", 1001), (b"\x0f\xa0mine", 4000)):
            ws = self.server.websocket()
            ws.send_frame(CLOSE, payload)
            ws.read_to_end()
            self.assertEqual(ws.close_code, code)
        self.ws.send_frame(CLOSE)
        self.ws.read_to_end()
        self.assertIn(self.ws.close_code, (None, 1000))

    def test_a_close_amid_streaming(self):
        """No packet follows the server's close frame (the client checks that), whoever begins."""
        self.add_waving_grid(50, (1.0, 0.0))
        self.c.call("playback.play")
        # Goodbye not said: the server waits for the client's close frame, with its streams open.
        for opcode, payload, code in ((CLOSE, b"\x03\xe8", 1000), (BINARY, b"x", 1003)):
            ws = self.server.websocket()
            for _ in range(4):
                ws.call("stream.open", kind="vertices", rate=240)
            for _ in range(5):
                ws.packet()
            ws.said_goodbye = opcode == BINARY
            ws.send_frame(opcode, payload)
            ws.read_to_end()
            self.assertEqual(ws.close_code, code)
            ws.close()
            harness.wait_until(lambda: self.c.call("server.stats")["tweend_streams"] == 0, "its streams are gone")
        self.ws.call("stream.open", kind="vertices", rate=240)
        self.ws.packet()
        self.server.tell_to_stop()
        self.ws.read_to_end()  # meanwhile: who does not read is not waited for
        self.assertEqual(self.ws.close_code, 1001)
        self.assertEqual(self.server.stop(), 0)

    def test_binary_messages_are_refused(self):
        self.ws.send_frame(BINARY, request_json("scene.create", {"scene": "a"}, 1))
        self.ends_with(1003)
        self.assertEqual(len(self.c.call("scene.list")["scenes"]), 1)

    def test_unmasked_frames_are_refused(self):
        self.ws.send_frame(TEXT, request_json("scene.create", {"scene": "a"}, 1), masked=False)
        self.ends_with(1002)
        self.assertEqual(len(self.c.call("scene.list")["scenes"]), 1)

    def test_breaches_of_the_protocol(self):
        for frame in ({"opcode": TEXT, "payload": b"{}", "reserved": 4}, {"opcode": 3}, {"opcode": 11}, {"opcode": 0, "payload": b"x"},
                      {"opcode": PING, "fin": False}, {"opcode": PING, "payload": b"x" * 126}, {"opcode": CLOSE, "payload": b"x"},
                      {"opcode": CLOSE, "payload": b"\x03\xed"}, {"opcode": CLOSE, "payload": b"\x00\x00"}):
            ws = self.server.websocket()
            ws.send_frame(**frame)
            ws.read_to_end()
            self.assertIn(ws.close_code, (1002, None), frame)
        ws = self.server.websocket()
        ws.send_frame(TEXT, b"{", fin=False)
        ws.send_frame(TEXT, b"}")
        ws.read_to_end()
        self.assertEqual(ws.close_code, 1002)
        self.c.call("server.ping")

    def test_text_that_is_not_utf8(self):
        for payload in (b"\xff", b'{"a":"\xed\xa0\x80"}', b"\xe2\x82"):
            ws = self.server.websocket()
            ws.send_frame(TEXT, payload)
            ws.read_to_end()
            self.assertEqual(ws.close_code, 1007)
        ws = self.server.websocket()
        ws.send_frame(TEXT, '{"jsonrpc":"2.0","id":"€'.encode()[:-1], fin=False)  # cut in mid-letter: fine, it goes on
        ws.send_frame(0, '{"jsonrpc":"2.0","id":"€","method":"scene.list"}'.encode()[len('{"jsonrpc":"2.0","id":"'.encode()) + 2:])
        self.assertEqual(ws.read()["id"], "€")

    def test_a_message_over_the_limit(self):
        self.ws.send_raw(b"\x81\xff" + (17 << 20).to_bytes(8, "big") + b"\0\0\0\0")  # its length is enough
        self.ends_with(1009)

    def test_a_server_that_stops_says_so(self):
        self.ws.call("events.subscribe")
        self.assertEqual(self.server.stop(), 0)
        self.ws.read_to_end()
        self.assertEqual(self.ws.close_code, 1001)

    def test_clients_of_all_sorts_see_the_same_scene(self):
        self.add_moving()
        self.ws.call("playback.seek", time=1.25)
        http = json.loads(self.server.http("POST", "/rpc", request_json("vertices.sample", id=1))[2])["result"]
        self.assertEqual(self.ws.call("vertices.sample"), http)
        self.assertEqual(self.c.call("vertices.sample"), http)
        opened = [c.call("stream.open", kind="vertices")["stream"] for c in (self.ws, self.c)]
        a, b = self.ws.packet(opened[0]), self.c.packet(opened[1])
        self.assertIsInstance(a, Packet)
        self.assertEqual((a.payload, a.media_us), (b.payload, b.media_us))


if __name__ == "__main__":
    harness.main()
