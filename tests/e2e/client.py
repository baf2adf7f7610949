"""Clients of a tweend server for tests: line JSON, WebSocket (RFC 6455) and packets, by docs/PROTOCOL.md.

They are strict: whatever the server says that the protocol does not allow raises ProtocolError.
"""
import base64
import contextlib
import hashlib
import json
import os
import socket
import struct
import time

MAGIC = 0x444E5754
HEADER = struct.Struct("<IBBBBIIqqII")
KEY, DISCONTINUITY, LAST = 1, 2, 4  # flags of a packet
PATIENCE_S = 30  # for anything that has to come; nothing takes as long unless it is broken

KINDS = {
    -32700: "parse", -32600: "invalid_request", -32601: "unknown_method", -32602: "invalid_params", -32603: "internal",
    -32001: "not_found", -32002: "conflict", -32003: "forbidden", -32004: "limit", -32005: "bad_asset",
    -32006: "unavailable",
}


class ProtocolError(AssertionError):
    """The server said what the protocol does not allow."""


class Closed(ConnectionError):
    """The server ended the connection."""


class RpcError(Exception):
    """An error answer."""

    def __init__(self, error):
        super().__init__(json.dumps(error))
        self.code = error["code"]
        self.data = error["data"]
        self.path = self.data.get("path")
        self.message = self.data["message"]


class Packet:
    """A stream packet (section 6)."""

    def __init__(self, raw):
        if len(raw) < HEADER.size:
            raise ProtocolError(f"a packet of {len(raw)} bytes")
        (magic, version, self.kind, self.encoding, self.flags, self.stream, self.sequence, self.media_us, self.server_us,
         self.revision, size) = HEADER.unpack_from(raw)
        if magic != MAGIC or version != 1 or self.flags & ~7 or len(raw) != HEADER.size + size:
            raise ProtocolError(f"a packet that begins {raw[:HEADER.size].hex()} and has {len(raw)} bytes")
        self.payload = raw[HEADER.size:]

    def __repr__(self):
        return f"<packet {self.sequence} of stream {self.stream}, {self.media_us} us, flags {self.flags}>"

    def floats(self):
        return list(struct.unpack(f"<{len(self.payload) // 4}f", self.payload))

    def positions(self):
        values = self.floats()
        return values[:len(values) // 2]


def check_message(message):
    """Every message of the server: an answer, an error, a notification, or an array of answers."""
    if isinstance(message, list):
        if not message:
            raise ProtocolError("an empty batch")
        return [check_message(m) for m in message]
    if not isinstance(message, dict) or message.get("jsonrpc") != "2.0":
        raise ProtocolError(f"not JSON-RPC 2.0: {message}")
    if "method" in message:
        good = set(message) == {"jsonrpc", "method", "params"} and isinstance(message["params"], dict)
    elif "error" in message:
        good = set(message) == {"jsonrpc", "id", "error"} and check_error(message["error"])
    else:
        good = set(message) == {"jsonrpc", "id", "result"}
    if not good:
        raise ProtocolError(f"not JSON-RPC 2.0: {message}")
    return message


def check_error(error):
    data = error.get("data")
    return (set(error) == {"code", "message", "data"} and isinstance(error["message"], str) and isinstance(data, dict) and
            data.get("kind") == KINDS.get(error["code"]) and isinstance(data.get("message"), str) and data["message"] != "" and
            isinstance(data.get("path", ""), str))


def request_json(method, params=None, id=None):
    """A request, or without an id a notification, as bytes."""
    message = {"jsonrpc": "2.0", "method": method}
    if id is not None:
        message["id"] = id
    if params is not None:
        message["params"] = params
    return json.dumps(message).encode()


class Speaker:
    """What line JSON and WebSocket have in common. Not for several threads at once."""

    def __init__(self, port, receive_buffer=None):
        self.sock = socket.socket()
        if receive_buffer:
            self.sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
        self.sock.settimeout(PATIENCE_S)
        try:
            self.sock.connect(("127.0.0.1", port))
        except OSError:
            self.sock.close()
            raise
        self.sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.received = bytearray()
        self.unread = []  # messages and packets that came while something else was waited for
        self.last_id = 0

    def close(self):
        self.sock.close()

    def reset(self):
        """Vanishes: the server sees a reset, not an end."""
        self.sock.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        self.sock.close()

    def send_raw(self, data):
        self.sock.settimeout(PATIENCE_S)
        self.sock.sendall(data)

    def fill(self, deadline):
        """Receives some bytes. Closed at the end, TimeoutError at the deadline."""
        left = deadline - time.monotonic()
        if left <= 0:
            raise TimeoutError
        self.sock.settimeout(left)
        try:
            more = self.sock.recv(1 << 20)
        except ConnectionResetError:
            raise Closed("reset") from None
        if not more:
            raise Closed("ended")
        self.received += more

    def take(self, count, deadline):
        while len(self.received) < count:
            self.fill(deadline)
        taken = bytes(self.received[:count])
        del self.received[:count]
        return taken

    def send_message(self, data):
        raise NotImplementedError

    def read_message(self, deadline):
        raise NotImplementedError

    def read(self, seconds=PATIENCE_S):
        """The next message or packet, in the order they came."""
        return self.unread.pop(0) if self.unread else self.read_message(time.monotonic() + seconds)

    def read_where(self, wanted, seconds=PATIENCE_S):
        """The next message or packet that is wanted; the others stay unread."""
        for i, message in enumerate(self.unread):
            if wanted(message):
                return self.unread.pop(i)
        deadline = time.monotonic() + seconds
        while True:
            try:
                message = self.read_message(deadline)
            except TimeoutError:
                raise TimeoutError(f"not within {seconds} s; unread: {self.unread[:20]}") from None
            if wanted(message):
                return message
            self.unread.append(message)

    def send(self, method, /, **params):
        """Sends a request; the id under which it will be answered."""
        self.last_id += 1
        self.send_message(request_json(method, params, self.last_id))
        return self.last_id

    def notify(self, method, /, **params):
        self.send_message(request_json(method, params))

    def answer(self, id, seconds=PATIENCE_S):
        """The answer to the request of that id: its result, or RpcError."""
        message = self.read_where(lambda m: isinstance(m, dict) and "method" not in m and m["id"] == id, seconds)
        if "error" in message:
            raise RpcError(message["error"])
        return message["result"]

    def call(self, method, /, **params):
        return self.answer(self.send(method, **params))

    def packet(self, stream=None, seconds=PATIENCE_S):
        return self.read_where(lambda m: isinstance(m, Packet) and stream in (None, m.stream), seconds)

    def packet_where(self, wanted, stream=None):
        """The next packet of the stream that is wanted; those before it are dropped."""
        deadline = time.monotonic() + PATIENCE_S
        while time.monotonic() < deadline:
            packet = self.packet(stream)
            if wanted(packet):
                return packet
        raise TimeoutError("packets came, but none that was wanted")

    def event(self, name, /, seconds=PATIENCE_S, **values):
        """The next notification of that name with those values among its params: its params."""
        def wanted(m):
            return isinstance(m, dict) and m.get("method") == name and values.items() <= m["params"].items()
        return self.read_where(wanted, seconds)["params"]

    def settle(self):
        """Reads until a new request is answered, and gives what came before its answer, unread so far."""
        end = self.send("server.stats")  # unlike a ping it waits for its turn
        self.answer(end)
        came, self.unread = self.unread, []
        return came

    def read_to_end(self, seconds=PATIENCE_S):
        """All messages until the server ends the connection."""
        messages = []
        deadline = time.monotonic() + seconds
        try:
            while True:
                messages.append(self.unread.pop(0) if self.unread else self.read_message(deadline))
        except Closed:
            return messages


class LineClient(Speaker):
    """Line JSON."""

    def send_message(self, data):
        self.send_raw(data + b"\n")

    def read_line(self, deadline):
        start = 0
        while (at := self.received.find(b"\n", start)) < 0:
            start = len(self.received)
            try:
                self.fill(deadline)
            except Closed:
                if self.received:
                    raise ProtocolError(f"ended in mid-line: {bytes(self.received[:200])}") from None
                raise
        line = bytes(self.received[:at])
        del self.received[:at + 1]
        return line

    def read_message(self, deadline):
        message = check_message(json.loads(self.read_line(deadline)))
        if isinstance(message, list) or message.get("method") != "stream.packet":
            return message
        params = message["params"]
        if set(params) != {"stream", "bytes"}:
            raise ProtocolError(f"announced a packet by {message}")
        packet = Packet(self.take(params["bytes"], deadline))
        if packet.stream != params["stream"]:
            raise ProtocolError(f"announced {message}, then sent {packet}")
        return packet


TEXT, BINARY, CLOSE, PING, PONG = 1, 2, 8, 9, 10


class WebSocketClient(Speaker):
    """A WebSocket on /ws. handshake=False leaves the opening to the test."""

    def __init__(self, port, subprotocols=("tweend.v1",), handshake=True, **kw):
        super().__init__(port, **kw)
        self.port = port
        self.pongs = []
        self.parts = None  # of a fragmented message: (opcode, bytes)
        self.was_closed = False
        self.close_code = None
        self.close_reason = None
        self.said_goodbye = False
        if handshake:
            status, headers = self.shake_hands(subprotocols)
            if status != 101:
                raise ProtocolError(f"the handshake was answered {status}")
            offered = headers.get("sec-websocket-protocol")
            if offered != ("tweend.v1" if "tweend.v1" in subprotocols else None):
                raise ProtocolError(f"offered {subprotocols}, the server chose {offered}")

    def shake_hands(self, subprotocols=(), **changes):
        """Sends the handshake, with headers changed or (None) left out, and gives status and headers of the answer."""
        key = base64.b64encode(os.urandom(16)).decode()
        headers = {"Host": f"127.0.0.1:{self.port}", "Upgrade": "websocket", "Connection": "Upgrade",
                   "Sec-WebSocket-Version": "13", "Sec-WebSocket-Key": key}
        if subprotocols:
            headers["Sec-WebSocket-Protocol"] = ", ".join(subprotocols)
        headers.update({name.replace("_", "-"): value for name, value in changes.items()})
        lines = ["GET /ws HTTP/1.1"] + [f"{name}: {value}" for name, value in headers.items() if value is not None]
        self.send_raw("\r\n".join(lines + ["", ""]).encode())
        status, answer = read_http_head(self, time.monotonic() + PATIENCE_S)
        if status == 101:
            accept = base64.b64encode(hashlib.sha1((key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11").encode()).digest()).decode()
            if answer["sec-websocket-accept"] != accept or answer["upgrade"].lower() != "websocket":
                raise ProtocolError(f"accepted by {answer}")
        return status, answer

    def send_frame(self, opcode, payload=b"", fin=True, masked=True, reserved=0):
        size = len(payload)
        self.said_goodbye = self.said_goodbye or opcode == CLOSE
        head = bytes([(0x80 if fin else 0) | reserved << 4 | opcode])
        mask_bit = 0x80 if masked else 0
        if size < 126:
            head += bytes([mask_bit | size])
        elif size < 1 << 16:
            head += struct.pack(">BH", mask_bit | 126, size)
        else:
            head += struct.pack(">BQ", mask_bit | 127, size)
        if masked:
            mask = os.urandom(4)
            head += mask
            stream = (mask * (size // 4 + 1))[:size]
            payload = (int.from_bytes(payload, "big") ^ int.from_bytes(stream, "big")).to_bytes(size, "big") if size else b""
        self.send_raw(head + payload)

    def send_message(self, data):
        self.send_frame(TEXT, data)

    def read_frame(self, deadline):
        """(fin, opcode, payload) of the next frame."""
        first, second = self.take(2, deadline)
        size = second & 0x7F
        if first & 0x70 or second & 0x80:
            raise ProtocolError("a frame with reserved bits, or masked by the server")
        if size == 126:
            size = int.from_bytes(self.take(2, deadline), "big")
        elif size == 127:
            size = int.from_bytes(self.take(8, deadline), "big")
        fin, opcode = bool(first & 0x80), first & 0x0F
        if opcode & 8 and (size > 125 or not fin):
            raise ProtocolError("a control frame that is too long or in parts")
        return fin, opcode, self.take(size, deadline)

    def read_message(self, deadline):
        while True:
            fin, opcode, payload = self.read_frame(deadline)
            if self.was_closed:
                raise ProtocolError(f"a frame of opcode {opcode} behind the close frame")
            if opcode == PONG:
                self.pongs.append(payload)
            elif opcode == PING:
                self.send_frame(PONG, payload)
            elif opcode == CLOSE:
                self.was_closed = True
                self.close_code = int.from_bytes(payload[:2], "big") if payload else None
                self.close_reason = payload[2:].decode()
                with contextlib.suppress(OSError):  # the server may not wait for it
                    if not self.said_goodbye:
                        self.send_frame(CLOSE, payload[:2])
            elif opcode in (0, TEXT, BINARY):
                if (opcode == 0) != (self.parts is not None):
                    raise ProtocolError("fragments in disorder")
                kind, before = self.parts or (opcode, b"")
                self.parts = None if fin else (kind, before + payload)
                if fin:
                    return Packet(before + payload) if kind == BINARY else check_message(json.loads((before + payload).decode()))
            else:
                raise ProtocolError(f"opcode {opcode}")


def read_http_head(speaker, deadline):
    """Status and headers (lower case) of an HTTP answer; the body stays in speaker.received."""
    while (end := speaker.received.find(b"\r\n\r\n")) < 0:
        speaker.fill(deadline)
    lines = speaker.take(end + 4, deadline).decode().split("\r\n")
    version, status = lines[0].split(" ")[:2]
    if version != "HTTP/1.1":
        raise ProtocolError(lines[0])
    return int(status), {name.lower(): value.strip() for name, value in (line.split(":", 1) for line in lines[1:] if line)}


class HttpClient(Speaker):
    """HTTP/1.1 by hand, so that a test decides about every byte."""

    def read_message(self, deadline):
        return self.read_answer(seconds=deadline - time.monotonic())

    def request_bytes(self, method, target, body=None, headers=None):
        lines = {"Host": f"127.0.0.1:{self.sock.getpeername()[1]}"}
        if body is not None:
            lines |= {"Content-Type": "application/json", "Content-Length": str(len(body))}
        lines |= headers or {}
        head = [f"{method} {target} HTTP/1.1"] + [f"{k}: {v}" for k, v in lines.items() if v is not None]
        return "\r\n".join(head + ["", ""]).encode() + (body or b"")

    def read_answer(self, head_only=False, seconds=PATIENCE_S):
        """(status, headers, body) of the next answer."""
        deadline = time.monotonic() + seconds
        status, headers = read_http_head(self, deadline)
        if head_only or status in (204, 304) or status < 200:
            return status, headers, b""
        return status, headers, self.take(int(headers["content-length"]), deadline)

    def ask(self, method, target, body=None, headers=None):
        self.send_raw(self.request_bytes(method, target, body, headers))
        return self.read_answer(head_only=method == "HEAD")

    def rpc(self, message):
        """POST /rpc of what can be printed as JSON: what the answer holds."""
        status, headers, body = self.ask("POST", "/rpc", json.dumps(message).encode())
        if (status, headers.get("content-type")) != (200, "application/json"):
            raise ProtocolError(f"answered {status}, {headers}")
        return check_message(json.loads(body))
