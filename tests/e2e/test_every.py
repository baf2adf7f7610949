"""Delivery `every` (section 6): nothing is skipped, and who falls too far behind is told so and cut off."""
import harness
from client import Packet, request_json
from harness import wait_until

SIDE = 80  # 6400 vertices, 154 kB a packet: 16 MiB are some 110 of them


class Every(harness.TestCase):
    def setUp(self):
        super().setUp()
        self.add_waving_grid(SIDE)
        self.c.call("playback.play", speed=0.001)

    def stats(self):
        return self.c.call("server.stats")

    def falls_behind(self, client):
        client.call("stream.open", kind="vertices", rate=240, delivery="every")
        wait_until(lambda: self.stats()["tweend_streams"] == 0, "it is cut off")

    def check_packets(self, messages):
        sequences = [m.sequence for m in messages if isinstance(m, Packet)]
        self.assertEqual(sequences, list(range(sequences[0], sequences[0] + len(sequences))), "in order, none skipped")

    def test_a_line_client_is_told_and_cut_off(self):
        client = self.server.line(receive_buffer=8192)
        self.falls_behind(client)
        messages = client.read_to_end()
        self.check_packets(messages)
        last = messages[-1]
        self.assertEqual(last["method"], "stream.ended")
        self.assertRegex(last["params"]["reason"], "expected .* found .*")

    def test_a_websocket_is_closed_with_try_again_later(self):
        client = self.server.websocket(receive_buffer=8192)
        self.falls_behind(client)
        self.check_packets(client.read_to_end())
        self.assertEqual(client.close_code, 1013)
        self.assertRegex(client.close_reason, "expected .* found .*")

    def test_nothing_is_left_of_it(self):
        client = self.server.line(receive_buffer=8192)
        self.falls_behind(client)
        wait_until(lambda: self.stats()["tweend_producers"] == 0, "its producer has stopped though the client has not read")
        self.c.call("server.ping")

    def test_what_it_asks_meanwhile_holds_up_nobody(self):
        client = self.server.line(receive_buffer=8192)
        # More answers than it may have unread, and requests that wait behind them.
        client.call("stream.open", kind="vertices", rate=240, delivery="every")
        client.sock.setblocking(False)
        try:
            for _ in range(3000):
                client.sock.send(request_json("vertices.sample", {}, 7) + b"\n")
        except BlockingIOError:
            pass
        wait_until(lambda: self.stats()["tweend_streams"] == 0, "it is cut off")
        for _ in range(20):
            self.c.call("server.ping")


class Unread(harness.TestCase):
    def test_clients_that_ask_and_vanish(self):
        """What has arrived of one is read after its write has failed: that must hurt nobody."""
        for _ in range(60):
            client = self.server.websocket()
            for _ in range(3):
                client.send("server.ping")
            client.reset()
        wait_until(lambda: self.c.call("server.stats")["tweend_connections"] == 1, "they are gone")


if __name__ == "__main__":
    harness.main()
