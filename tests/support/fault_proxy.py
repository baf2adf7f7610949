#!/usr/bin/python3
"""A TCP proxy that is a bad link: latency, little bandwidth, slices of a byte, stalls, resets, a client that is gone.

    with FaultProxy(server.port) as proxy:            # links to proxy.port are passed on to the server's
        proxy.change("down", bytes_per_s=250_000)     # "up" is client to server, "down" server to client
        proxy.change("down", stalled=True)            # at any time, also of links that are there already
        proxy.reset()

As a program it tells its port and takes such commands line by line:

    fault_proxy.py --to 127.0.0.1:8933 --down bytes_per_s=250000,latency_s=0.05
    down stalled=yes | up slice_bytes=1 | down bytes_per_s=none | reset | abandon | links

What it holds of a direction, in its own memory and in its sockets, is at most HELD_BYTES, with latency LINE_BYTES more: so a
link that is slow or stalled is felt at the other end at once. It needs neither rights nor the kernel's network emulation.
"""
import argparse
import asyncio
import collections
import contextlib
import dataclasses
import fcntl
import socket
import struct
import sys
import termios
import threading

UP, DOWN = "up", "down"
CHUNK_BYTES = 4096  # read at once
LINE_BYTES = 128 << 10  # on their way at most, where there is latency
SOCKET_BYTES = 8 << 10  # asked of the kernel for each socket; it takes twice as much, bookkeeping included
# Of one direction, without latency: read but not taken, with a chunk that came while the line was full, and in two sockets.
HELD_BYTES = 2 * CHUNK_BYTES + 2 * 2 * SOCKET_BYTES
SEGMENT_BYTES = 1460  # as on an Ethernet: loopback's 64 KiB would fill such buffers with one segment
GRAIN_S = 0.01  # how much of a second of bandwidth goes out in one piece
CATCH_UP_S = 0.02  # of lateness that is made up for: what was not used before that is lost, as on a real link
SIOCOUTQ = termios.TIOCOUTQ
PATIENCE_S = 30


@dataclasses.dataclass(frozen=True)
class Faults:
    """What befalls the bytes of one direction."""
    latency_s: float = 0.0
    bytes_per_s: float | None = None  # None: as many as come
    slice_bytes: int | None = None  # of a write at most. Whoever is slow to read may still find several together
    stalled: bool = False  # nothing more is passed on, and nothing read
    reset_after: int | None = None  # so many bytes of a link reach the other end, then both ends see a reset

    def __post_init__(self):
        for name, good in (("latency_s", self.latency_s >= 0), ("bytes_per_s", self.bytes_per_s is None or self.bytes_per_s > 0),
                           ("slice_bytes", self.slice_bytes is None or self.slice_bytes >= 1),
                           ("reset_after", self.reset_after is None or self.reset_after >= 0)):
            if not good:
                raise ValueError(f"expected {name} that a link can have, found {getattr(self, name)}")

    @classmethod
    def named(cls, text):
        """{name: value} of "bytes_per_s=250000,stalled=yes"; "none" is what there is without faults."""
        found = {}
        for part in filter(None, text.split(",")):
            name, _, value = part.partition("=")
            field = next((f for f in dataclasses.fields(cls) if f.name == name), None)
            if field is None:
                raise ValueError(f"expected one of {', '.join(f.name for f in dataclasses.fields(cls))}, found {name!r}")
            if value == "none":
                found[name] = field.default
            elif name == "stalled":
                found[name] = {"yes": True, "no": False}[value]
            else:
                found[name] = (float if name.endswith("_s") else int)(value)
        return found


def small(sock):
    """Buffers in which little disappears. Before it listens or connects: afterwards the window is agreed on."""
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, SOCKET_BYTES)
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SOCKET_BYTES)
    sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_MAXSEG, SEGMENT_BYTES)
    sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    sock.setblocking(False)
    return sock


async def taken(sock):
    """Waits until the other end's kernel has all that was sent: a reset would destroy the rest."""
    while struct.unpack("i", fcntl.ioctl(sock, SIOCOUTQ, b"\0" * 4))[0]:
        await asyncio.sleep(0.001)


class Pump:
    """One direction of a link: from the socket it reads, over the line, to the socket it writes. The loop's thread only."""

    def __init__(self, source, sink, faults, reset):
        self.loop = asyncio.get_running_loop()
        self.source, self.sink, self.reset = source, sink, reset
        self.faults = faults
        self.line = collections.deque()  # (when it arrives, bytes); no bytes: the end
        self.line_bytes = 0
        self.passed = 0  # bytes that the other end was given
        self.free_at = 0.0  # when the bandwidth has a place for the next byte
        self.woken = asyncio.Event()

    def change(self, faults):
        self.faults = faults
        self.woken.set()

    async def until(self, condition, deadline=None):
        """Waits for the condition, which is looked at whenever anything has changed, or for the deadline."""
        while not condition():
            self.woken.clear()
            try:
                async with asyncio.timeout_at(deadline):
                    await self.woken.wait()
            except TimeoutError:
                return

    def room(self):
        """What may be on the line."""
        f = self.faults
        return CHUNK_BYTES + min(LINE_BYTES, f.latency_s * (f.bytes_per_s or float("inf")) if f.latency_s else 0)

    async def transmit(self, data):
        """Puts it on the line in the time that it needs at this bandwidth."""
        while data:
            rate = self.faults.bytes_per_s
            count = len(data) if rate is None else max(1, min(len(data), int(rate * GRAIN_S)))
            if rate is not None:
                self.free_at = max(self.free_at, self.loop.time() - CATCH_UP_S) + count / rate
                await self.until(lambda: self.faults.bytes_per_s != rate, self.free_at)
            await self.until(lambda: not self.faults.stalled)  # that may have come in the meantime
            self.put(data[:count])
            data = data[count:]

    async def read(self):
        while True:
            await self.until(lambda: not self.faults.stalled and self.line_bytes < self.room())
            data = await self.loop.sock_recv(self.source, CHUNK_BYTES)
            if not data:
                return self.put(data)
            await self.transmit(data)

    def put(self, data):
        self.line.append((self.loop.time() + self.faults.latency_s, data))
        self.line_bytes += len(data)
        self.woken.set()

    async def write(self):
        while True:
            await self.until(lambda: self.line)
            due, data = self.line[0]
            await asyncio.sleep(due - self.loop.time())
            if not data:
                self.sink.shutdown(socket.SHUT_WR)
                return
            await self.deliver(memoryview(data))
            self.line.popleft()
            self.line_bytes -= len(data)
            self.woken.set()

    async def deliver(self, data):
        while data:
            left = float("inf") if self.faults.reset_after is None else max(0, self.faults.reset_after - self.passed)
            count = int(min(len(data), self.faults.slice_bytes or len(data), left))
            await self.loop.sock_sendall(self.sink, data[:count])
            self.passed += count
            if count == left:
                await taken(self.sink)
                self.reset()
                await asyncio.Event().wait()  # until this is cancelled
            data = data[count:]
            await asyncio.sleep(0)  # a send that succeeds at once would keep everybody else waiting


class Link:
    """A client's connection and that to the server."""

    def __init__(self, client, server, faults):
        self.client, self.server = client, server
        self.over = asyncio.Event()
        self.broken = False
        self.abandoned = False
        self.pumps = {UP: Pump(client, server, faults[UP], self.reset), DOWN: Pump(server, client, faults[DOWN], self.reset)}
        self.tasks = []

    def reset(self):
        self.broken = True
        self.over.set()

    def abandon(self):
        self.abandoned = True
        self.over.set()

    async def pump(self):
        try:
            await asyncio.gather(*self.tasks)
        except OSError:
            self.broken = True
        self.over.set()

    async def run(self):
        self.tasks = [asyncio.create_task(step) for p in self.pumps.values() for step in (p.read(), p.write())]
        whole = asyncio.create_task(self.pump())
        try:
            await self.over.wait()
            if self.abandoned:
                await self.cancel(whole)
                self.client.close()
                self.over.clear()
                await self.over.wait()  # the server's end stays as it is
        finally:
            await self.cancel(whole)

    async def cancel(self, whole):
        for task in (whole, *self.tasks):
            task.cancel()
        await asyncio.gather(whole, *self.tasks, return_exceptions=True)

    def close(self):
        for sock in (self.client, self.server):
            if self.broken:
                with contextlib.suppress(OSError):
                    sock.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            sock.close()


class FaultProxy:
    """Links from a port of its own (proxy.port) to the server's. Runs on a thread of its own; its functions are for any other
    thread, and have done what they say when they return. Faults hold for all links, those to come too."""

    def __init__(self, to, up=Faults(), down=Faults(), listen=("127.0.0.1", 0)):
        """@param to  a port on 127.0.0.1, or (host, port)"""
        self.to = ("127.0.0.1", to) if isinstance(to, int) else to
        self.faults = {UP: up, DOWN: down}
        self.current = []
        self.passed_before = {UP: 0, DOWN: 0}  # by links that are gone
        self.door = small(socket.socket())
        self.door.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            self.door.bind(listen)
            self.door.listen(256)
        except OSError:
            self.door.close()
            raise
        self.port = self.door.getsockname()[1]
        self.loop = asyncio.new_event_loop()
        self.stop = asyncio.Event()
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def change(self, direction, /, **faults):
        """These faults from now on; what is not named stays as it is."""
        changed = dataclasses.replace(self.faults[direction], **faults)

        def do():
            self.faults[direction] = changed
            for link in self.current:
                link.pumps[direction].change(changed)
        self.on_loop(do)

    def reset(self):
        """Both ends of all links see a reset."""
        self.on_loop(lambda: [link.reset() for link in self.current])

    def abandon(self):
        """The clients are gone, and the server is not told: its ends stay open, unread, until reset() or close()."""
        self.on_loop(lambda: [link.abandon() for link in self.current])

    def links(self):
        return self.on_loop(lambda: len(self.current))

    def passed(self, direction):
        """Bytes that all links together have given to the other end."""
        return self.on_loop(lambda: self.passed_before[direction] + sum(link.pumps[direction].passed for link in self.current))

    def close(self):
        """Ends the links as they are; bytes on their way are lost."""
        if self.thread.is_alive():
            self.loop.call_soon_threadsafe(self.stop.set)
            self.thread.join(PATIENCE_S)

    def on_loop(self, what):
        async def do():
            return what()
        return asyncio.run_coroutine_threadsafe(do(), self.loop).result(PATIENCE_S)

    def run(self):
        with contextlib.closing(self.loop):
            self.loop.run_until_complete(self.serve())

    async def serve(self):
        tasks = set()
        accepting = asyncio.create_task(self.accept(tasks))
        await self.stop.wait()
        for task in (accepting, *tasks):
            task.cancel()
        await asyncio.gather(accepting, *tasks, return_exceptions=True)
        self.door.close()

    async def accept(self, tasks):
        while True:
            client, _ = await self.loop.sock_accept(self.door)
            task = asyncio.create_task(self.serve_link(client))
            tasks.add(task)
            task.add_done_callback(tasks.discard)

    async def serve_link(self, client):
        server = small(socket.socket())
        link = Link(client, server, self.faults)
        self.current.append(link)
        try:
            client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            await self.loop.sock_connect(server, self.to)
            await link.run()
        except OSError:
            link.broken = True  # as if there were no server here either
        finally:
            self.current.remove(link)
            for direction, pump in link.pumps.items():
                self.passed_before[direction] += pump.passed
            link.close()


def address(text):
    host, _, port = text.rpartition(":")
    return host or "127.0.0.1", int(port)


def obey(proxy, line):
    """Carries out a line of the program's input: what is to be printed."""
    command, _, rest = line.strip().partition(" ")
    if command in (UP, DOWN):
        proxy.change(command, **Faults.named(rest))
    elif command in ("reset", "abandon"):
        getattr(proxy, command)()
    elif command == "links":
        return f"{proxy.links()} links, {proxy.passed(UP)} bytes up, {proxy.passed(DOWN)} bytes down"
    elif command:
        raise ValueError(f"expected up, down, reset, abandon or links, found {command!r}")
    return None


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--to", type=address, required=True, metavar="HOST:PORT")
    parser.add_argument("--listen", type=address, default=("127.0.0.1", 0), metavar="HOST:PORT")
    for direction in (UP, DOWN):
        parser.add_argument(f"--{direction}", type=Faults.named, default={}, metavar="NAME=VALUE,…")
    options = parser.parse_args(arguments)
    with FaultProxy(options.to, Faults(**options.up), Faults(**options.down), options.listen) as proxy:
        print(f"127.0.0.1:{proxy.port}", flush=True)
        for line in sys.stdin:
            try:
                answer = obey(proxy, line)
            except (ValueError, KeyError) as error:
                answer = str(error)
            if answer:
                print(answer, flush=True)


if __name__ == "__main__":
    main()
