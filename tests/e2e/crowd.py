"""A crowd of readers in a process of its own, light enough to leave the machine to the server: one selector drains all of them,
looks at the headers of their packets and passes over the payloads."""
import multiprocessing
import selectors
import signal
import struct
import time

from client import HEADER, MAGIC, PATIENCE_S, LineClient, ProtocolError, WebSocketClient
from harness import die_with_parent

HEALTHY, SLOW, STUCK = "healthy", "slow", "stuck"
SMALL_BUFFER = 8192  # what the kernels of slow and stuck readers are asked to hold
AWAY_S = 0.25  # a turn among the readers takes milliseconds, and is waited for no longer than a sip
SIP_BYTES, SIP_S = 2048, 0.1  # slow ones take 20 kB a second
ANNOUNCEMENT = b'{"jsonrpc":"2.0","method":"stream.packet"'
BINARY_FRAME, TEXT_FRAME = 0x82, 0x81


def name_of(params):
    """What is watched, in a few words: `frames h264`."""
    return " ".join([params["kind"]] + [params[p] for p in ("encoding", "delivery") if p in params])


class Reader:
    """A connection with one stream on it."""

    def __init__(self, port, speaker, manner, params):
        self.manner, self.what = manner, name_of(params)
        self.speaker = speaker(port, receive_buffer=None if manner == HEALTHY else SMALL_BUFFER)
        self.sock = self.speaker.sock
        self.head = self.line_head if speaker is LineClient else self.frame_head
        self.packets = []  # (sequence, bytes)
        self.skip = 0  # bytes of a payload that are still to come
        self.rest = b""  # the beginning of something
        id = self.speaker.send("stream.open", **params)
        if manner != STUCK:
            self.speaker.answer(id)
            self.rest = bytes(self.speaker.received)
        self.sock.setblocking(False)

    def take(self, limit):
        """What has come, at most so much; whether there may be more."""
        try:
            data = self.sock.recv(limit)
        except BlockingIOError:
            return False
        if not data:
            raise ProtocolError(f"the server closed the connection of a {self.manner} reader of {self.what}")
        self.feed(data)
        return len(data) == limit

    def feed(self, data):
        if self.skip >= len(data):
            self.skip -= len(data)
            return
        at = self.skip
        if self.rest:
            data, at = self.rest + data, 0
        while 0 < (end := self.head(data, at)) < len(data):
            at = end
        self.rest, self.skip = (data[at:], 0) if end == 0 else (b"", end - len(data))

    def line_head(self, data, at):
        """Notes the packet that is announced there: where what follows it begins; 0: not all of its head has come."""
        end = data.find(b"\n", at)
        if end < 0 or not data.startswith(ANNOUNCEMENT, at):
            return end + 1
        size = int(data[data.rindex(b":", at, end) + 1:end - 2])
        return self.note(data, end + 1) and end + 1 + size

    def frame_head(self, data, at):
        if len(data) < at + 10:  # none of ours is shorter
            return 0
        opcode, size = data[at], data[at + 1]
        at += 2
        if size >= 126:
            size, at = (struct.unpack_from(">H", data, at)[0], at + 2) if size == 126 else (struct.unpack_from(">Q", data, at)[0], at + 8)
        if opcode not in (TEXT_FRAME, BINARY_FRAME):
            raise ProtocolError(f"a frame that begins {opcode:#x}")
        return at + size if opcode == TEXT_FRAME else self.note(data, at) and at + size

    def note(self, data, at):
        if len(data) < at + HEADER.size:
            return False
        header = HEADER.unpack_from(data, at)
        if header[0] != MAGIC:
            raise ProtocolError(f"a packet of {self.what} that begins {data[at:at + HEADER.size].hex()}")
        self.packets.append((header[6], HEADER.size + header[10]))
        return True


def drain(readers, seconds):
    """Reads for so long, each in its manner. How long of it this process was kept from reading, in seconds."""
    now = time.monotonic()
    end, next_sip, away_s = now + seconds, now, 0.0
    slow = [r for r in readers if r.manner == SLOW]
    with selectors.DefaultSelector() as selector:
        for reader in readers:
            if reader.manner == HEALTHY:
                selector.register(reader.sock, selectors.EVENT_READ, reader)
        while (turn := time.monotonic()) < end:
            if turn - now > AWAY_S:
                away_s += turn - now
            now = turn
            for key, _ in selector.select(max(0, min(next_sip, end) - now)):
                key.data.take(1 << 18)
            if time.monotonic() >= next_sip:
                next_sip += SIP_S
                for reader in slow:
                    reader.take(SIP_BYTES)
    return away_s


def run(pipe, port, manners, streams, seconds):
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    die_with_parent()
    try:
        readers = [Reader(port, (LineClient, WebSocketClient)[i // len(streams[manner]) % 2], manner, streams[manner][i % len(streams[manner])])
                   for manner, count in manners.items() for i in range(count)]
        pipe.send("ready")
        away_s = drain(readers, seconds)
        pipe.send((away_s, [(r.manner, r.what, r.packets) for r in readers]))
        pipe.recv()  # they stay until they are sent away
    except BaseException as error:
        pipe.send(error)
        raise


class Crowd:
    """Readers of a server for so many seconds, from when ready() returns on."""

    def __init__(self, port, manners, streams, seconds):
        """@param manners  how many of each, by manner
        @param streams  what those of each manner ask for, in turn: parameters of stream.open"""
        context = multiprocessing.get_context("fork")
        self.pipe, theirs = context.Pipe()
        self.process = context.Process(target=run, args=(theirs, port, manners, streams, seconds), daemon=True)
        self.process.start()
        theirs.close()

    def said(self, seconds):
        if not self.pipe.poll(seconds):
            raise TimeoutError(f"the crowd said nothing within {seconds} s")
        word = self.pipe.recv()
        if isinstance(word, BaseException):
            raise word
        return word

    def ready(self):
        if self.said(PATIENCE_S * 4) != "ready":
            raise AssertionError("the crowd began with something else")

    def running(self, seconds=0):
        """Whether it has not ended, nor does so within so many seconds."""
        return not self.pipe.poll(seconds)

    def result(self):
        """How many seconds it was kept from reading, and [(manner, what it watches, [(sequence, bytes)])], once it has ended; it
        stays connected until close()."""
        return self.said(PATIENCE_S)

    def close(self):
        if self.process.is_alive():
            self.process.kill()
        self.process.join()
        self.pipe.close()
