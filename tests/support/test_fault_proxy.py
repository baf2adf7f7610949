"""The fault proxy does to bytes what it is told, and nothing else. Times are looked at from below alone: what a fault takes at
least can't be shortened by a machine, what it takes at most depends on who else is at work."""
import asyncio
import contextlib
import random
import socket
import subprocess
import sys
import threading
import time
import unittest

sys.dont_write_bytecode = True
import fault_proxy  # noqa: E402
from fault_proxy import CHUNK_BYTES, DOWN, HELD_BYTES, UP, FaultProxy, Faults, Pump  # noqa: E402

PATIENCE_S = 30


def wait_until(condition, what):
    deadline = time.monotonic() + PATIENCE_S
    while not (value := condition()):
        if time.monotonic() > deadline:
            raise TimeoutError(f"not within {PATIENCE_S} s: {what}")
        time.sleep(0.005)
    return value


def noise(count, seed=1):
    return random.Random(seed).randbytes(count)


def receive(sock, count):
    got = bytearray()
    while len(got) < count and (more := sock.recv(count - len(got))):
        got += more
    return bytes(got)


def receive_all(sock):
    return b"".join(iter(lambda: sock.recv(65536), b""))


class Links(unittest.TestCase):
    def setUp(self):
        self.door = self.closed_later(socket.create_server(("127.0.0.1", 0)))
        self.door.settimeout(PATIENCE_S)
        self.proxy = FaultProxy(self.door.getsockname()[1])
        self.addCleanup(self.proxy.close)

    def closed_later(self, sock):
        self.addCleanup(sock.close)
        return sock

    def connect(self, **options):
        """(client, server): the two ends of a new link."""
        client = socket.socket()
        for name, value in options.items():
            client.setsockopt(socket.SOL_SOCKET, getattr(socket, name), value)
        client.settimeout(PATIENCE_S)
        client.connect(("127.0.0.1", self.proxy.port))
        server, _ = self.door.accept()
        server.settimeout(PATIENCE_S)
        return self.closed_later(client), self.closed_later(server)

    def sending(self, sock, data):
        """On a thread of its own: it may take as long as the proxy wants."""
        def send():
            try:
                sock.sendall(data)
            except OSError as error:
                thread.failure = error
        thread = threading.Thread(target=send, daemon=True)
        thread.failure = None
        thread.start()
        return thread

    def accepted(self, sock, at_least=None):
        """Bytes that can be sent until nothing more is taken for a while, after so many at least."""
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 4096)
        sock.settimeout(0.5)
        count = -2 * 4096  # in its own socket
        deadline = time.monotonic() + PATIENCE_S
        while time.monotonic() < deadline:
            try:
                count += sock.send(bytes(1024))
            except TimeoutError:
                if at_least is None or count >= at_least:
                    break
        return count

    def sees_reset(self, sock, sender=None):
        """A socket tells of a reset once: whoever reads, or the sender."""
        if sender:
            sender.join(PATIENCE_S)
            if isinstance(sender.failure, ConnectionResetError):
                return
        with self.assertRaises(ConnectionResetError):
            receive_all(sock)


class WithoutFaults(Links):
    def test_bytes_pass_unharmed_both_ways_at_once(self):
        client, server = self.connect()
        up, down = noise(1 << 20, 1), noise(1 << 20, 2)
        threads = [self.sending(client, up), self.sending(server, down)]
        got = {}
        threads.append(threading.Thread(target=lambda: got.update(up=receive(server, len(up))), daemon=True))
        threads[-1].start()
        self.assertEqual(receive(client, len(down)), down)
        for thread in threads:
            thread.join(PATIENCE_S)
        self.assertEqual(got["up"], up)
        self.assertEqual((self.proxy.passed(UP), self.proxy.passed(DOWN)), (1 << 20, 1 << 20))

    def test_each_end_may_finish_alone(self):
        client, server = self.connect()
        client.sendall(b"question")
        client.shutdown(socket.SHUT_WR)
        self.assertEqual(receive_all(server), b"question")
        server.sendall(b"answer")
        server.close()
        self.assertEqual(receive_all(client), b"answer")
        wait_until(lambda: self.proxy.links() == 0, "the link is gone")

    def test_a_reset_is_passed_on(self):
        for dying in (0, 1):
            ends = self.connect()
            ends[0].sendall(b"x")
            receive(ends[1], 1)
            ends[dying].setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b"\1\0\0\0\0\0\0\0")
            ends[dying].close()
            self.sees_reset(ends[1 - dying])

    def test_without_a_server_there_is_no_link(self):
        nobody = self.closed_later(socket.socket())
        nobody.bind(("127.0.0.1", 0))  # and nobody else is there meanwhile
        with FaultProxy(nobody.getsockname()[1]) as proxy:
            with self.assertRaises(ConnectionResetError), socket.create_connection(("127.0.0.1", proxy.port), PATIENCE_S) as client:
                receive_all(client)
            wait_until(lambda: proxy.links() == 0, "the link is gone")


class WithFaults(Links):
    def test_who_does_not_read_is_felt_at_the_other_end(self):
        client, server = self.connect(SO_RCVBUF=4096)
        accepted = self.accepted(server, at_least=CHUNK_BYTES)
        self.assertLessEqual(accepted - self.proxy.passed(DOWN), HELD_BYTES)
        self.assertGreaterEqual(accepted, CHUNK_BYTES)

    def test_a_stall_holds_everything_and_loses_nothing(self):
        client, server = self.connect()
        self.proxy.change(DOWN, stalled=True)
        data = noise(200_000)
        thread = self.sending(server, data)
        client.sendall(b"the other way goes on")
        self.assertEqual(receive(server, 21), b"the other way goes on")
        self.assertEqual(self.proxy.passed(DOWN), 0)
        self.proxy.change(DOWN, stalled=False)
        self.assertEqual(receive(client, len(data)), data)
        thread.join(PATIENCE_S)

    def test_what_a_stall_takes_is_bounded(self):
        self.proxy.change(DOWN, stalled=True)
        _, server = self.connect()
        self.assertLessEqual(self.accepted(server), HELD_BYTES)
        self.assertEqual(self.proxy.passed(DOWN), 0)

    def test_latency_is_waited_in_each_direction_and_keeps_the_order(self):
        client, server = self.connect()
        self.proxy.change(UP, latency_s=0.1)
        self.proxy.change(DOWN, latency_s=0.05)
        start = time.monotonic()
        client.sendall(b"there")
        self.assertEqual(receive(server, 5), b"there")
        server.sendall(b"back")
        self.assertEqual(receive(client, 4), b"back")
        self.assertGreaterEqual(time.monotonic() - start, 0.15)
        data = noise(300_000)
        self.sending(server, data)
        self.proxy.change(DOWN, latency_s=0.0)  # what is under way is not overtaken
        self.assertEqual(receive(client, len(data)), data)

    def test_bandwidth_is_not_exceeded(self):
        client, server = self.connect()
        rate = 200_000
        self.proxy.change(DOWN, bytes_per_s=rate)
        data = noise(rate // 2)
        start = time.monotonic()
        self.sending(server, data)
        self.assertEqual(receive(client, len(data)), data)
        self.assertGreaterEqual(time.monotonic() - start, 0.5 - fault_proxy.CATCH_UP_S - fault_proxy.GRAIN_S)

    def test_a_link_can_be_freed_while_it_is_slow(self):
        client, server = self.connect()
        self.proxy.change(DOWN, bytes_per_s=10)
        data = noise(300_000)
        self.sending(server, data)
        self.assertEqual(receive(client, 1), data[:1])
        self.proxy.change(DOWN, bytes_per_s=None)  # 300 kB at ten bytes a second would be eight hours
        self.assertEqual(receive(client, len(data) - 1), data[1:])

    def test_slices_of_a_byte_arrive_unharmed(self):
        client, server = self.connect()
        self.proxy.change(UP, slice_bytes=1)
        data = noise(5_000)
        self.sending(client, data)
        self.assertEqual(receive(server, len(data)), data)

    def test_each_slice_is_a_write_of_its_own(self):
        """Looked at where writes keep their boundaries, as TCP's do not."""
        async def writes(size):
            reader, source = socket.socketpair(socket.AF_UNIX, socket.SOCK_STREAM)
            sink, datagrams = socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)
            with reader, source, sink, datagrams:
                for sock in (source, sink):
                    sock.setblocking(False)
                pump = Pump(source, sink, Faults(slice_bytes=size), lambda: None)
                await pump.deliver(memoryview(b"123456789"))
                datagrams.setblocking(False)
                found = []
                with contextlib.suppress(BlockingIOError):
                    while True:
                        found.append(datagrams.recv(100))
                return found

        self.assertEqual(asyncio.run(writes(1)), [b"1", b"2", b"3", b"4", b"5", b"6", b"7", b"8", b"9"])
        self.assertEqual(asyncio.run(writes(4)), [b"1234", b"5678", b"9"])
        self.assertEqual(asyncio.run(writes(None)), [b"123456789"])


class Ends(Links):
    def test_a_reset_after_so_many_bytes(self):
        data = noise(20_000)
        for count in (0, 1, 4096, 12_345):
            self.proxy.change(DOWN, reset_after=count)
            client, server = self.connect()
            sender = self.sending(server, data)
            if count:
                self.assertEqual(receive(client, count), data[:count])
            self.sees_reset(client)
            self.sees_reset(server, sender)

    def test_a_reset_on_command_and_links_that_come_after_it(self):
        pairs = [self.connect() for _ in range(3)]
        for client, server in pairs:
            server.sendall(b"x")
            self.assertEqual(receive(client, 1), b"x")
        self.assertEqual(self.proxy.links(), 3)
        self.proxy.reset()
        for client, server in pairs:
            self.sees_reset(client)
            self.sees_reset(server)
        wait_until(lambda: self.proxy.links() == 0, "the links are gone")
        client, server = self.connect()
        client.sendall(b"again")
        self.assertEqual(receive(server, 5), b"again")

    def test_an_abandoned_server_hears_nothing_until_the_reset(self):
        client, server = self.connect()
        client.sendall(b"x")
        receive(server, 1)
        self.proxy.abandon()
        self.assertEqual(receive_all(client), b"")
        self.assertLessEqual(self.accepted(server), HELD_BYTES)
        server.settimeout(0.2)
        with self.assertRaises(TimeoutError):
            server.recv(1)
        server.settimeout(PATIENCE_S)
        self.proxy.reset()
        self.sees_reset(server)

    def test_closing_the_proxy_ends_its_links(self):
        client, server = self.connect()
        self.proxy.close()
        self.assertEqual((receive_all(client), receive_all(server)), (b"", b""))
        with self.assertRaises(ConnectionRefusedError):
            socket.create_connection(("127.0.0.1", self.proxy.port), PATIENCE_S)


class Words(unittest.TestCase):
    def test_what_no_link_can_have(self):
        for wrong in ({"latency_s": -1}, {"bytes_per_s": 0}, {"slice_bytes": 0}, {"reset_after": -1}):
            with self.assertRaisesRegex(ValueError, next(iter(wrong))):
                Faults(**wrong)
        with self.assertRaisesRegex(ValueError, "expected one of .*found 'lag'"):
            Faults.named("lag=1")

    def test_what_can_be_named(self):
        self.assertEqual(Faults.named("bytes_per_s=2.5e5,slice_bytes=1,stalled=yes,latency_s=0.1,reset_after=7"),
                         {"bytes_per_s": 250_000, "slice_bytes": 1, "stalled": True, "latency_s": 0.1, "reset_after": 7})
        self.assertEqual(Faults.named("bytes_per_s=none,stalled=no,latency_s=none"),
                         {"bytes_per_s": None, "stalled": False, "latency_s": 0})
        self.assertEqual(Faults.named(""), {})

    def test_the_program(self):
        with socket.create_server(("127.0.0.1", 0)) as door:
            door.settimeout(PATIENCE_S)
            program = subprocess.Popen(
                [sys.executable, "-B", fault_proxy.__file__, "--to", f"127.0.0.1:{door.getsockname()[1]}", "--up", "slice_bytes=2"],
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
            with program, socket.create_connection(fault_proxy.address(program.stdout.readline()), PATIENCE_S) as client:
                def told(line):
                    program.stdin.write(line + "\n")
                    program.stdin.flush()
                    return program.stdout.readline()
                server, _ = door.accept()
                with server:
                    client.sendall(b"abc")
                    self.assertEqual(receive(server, 3), b"abc")
                    self.assertEqual(told("links"), "1 links, 3 bytes up, 0 bytes down\n")
                    self.assertIn("found 'hurt'", told("hurt"))
                    self.assertEqual(told("down stalled=yes\nlinks"), "1 links, 3 bytes up, 0 bytes down\n")
                    self.assertIn("expected bytes_per_s", told("down bytes_per_s=-1"))
                    self.assertIn("links", told("reset\nlinks"))
                    with self.assertRaises(ConnectionResetError):
                        receive_all(client)
                program.stdin.close()  # the end of its input is its end
                self.assertEqual(program.wait(PATIENCE_S), 0)


if __name__ == "__main__":
    unittest.main()
