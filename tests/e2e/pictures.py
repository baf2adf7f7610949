"""Pictures in tests: PNG read and written, what a JPEG says of itself, and scenes of which the picture is known before."""
import base64
import math
import random
import re
import struct
import time
import zlib

import harness
from client import PATIENCE_S, Closed, HttpClient, ProtocolError, read_http_head

PNG_SIGNATURE = b"\x89PNG\r\n\x1a\n"
CHANNELS = {2: 3, 6: 4}  # of a PNG's colour type: RGB, RGBA

QUAD = {"positions": [-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0], "indices": [0, 1, 2, 0, 2, 3]}  # faces +Z
BASE = (128, 128, 255)  # what has no material, where light comes evenly from everywhere
BACKGROUND = (18, 20, 26)  # at first
EVEN = {"ambient": 1, "diffuse": 0, "specular": 0}  # a surface that faces +Z then shows its own colour
SIDE = 100
SQUARE = {"width": SIDE, "height": SIDE}
# Straight on, and in a SQUARE ten pixels a metre at z = 0.
STRAIGHT = {"eye": [0, 0, 10], "target": [0, 0, 0], "fov_y": 2 * math.atan(0.5)}


def rough_grid(n, seed):
    """A surface upright before the camera, so rough that its picture is full of detail."""
    noise = random.Random(seed)
    mesh = harness.grid(n)
    for i in range(0, len(mesh["positions"]), 3):
        x, y, _ = mesh["positions"][i:i + 3]
        mesh["positions"][i:i + 3] = [16 * (x - 0.5), 9 * (y - 0.5), noise.uniform(-0.15, 0.15)]
    return mesh


def add_rough(client):
    """An actor of rough_grid() that fills pictures of 16:9, with two keyframes."""
    client.call("actor.add", actor="rough", mesh=rough_grid(90, 1))
    for seed in (1, 2):
        client.call("keyframe.add", vertices={"positions": rough_grid(90, seed)["positions"]})
    client.call("camera.set", eye=[0, 0, 10], target=[0, 0, 0], fov_y=0.7)


def chunks(png):
    """(type, content) of each chunk of a PNG."""
    if png[:8] != PNG_SIGNATURE:
        raise ProtocolError(f"no PNG: it begins {png[:16].hex()}")
    at, found = 8, []
    while at < len(png):
        size, kind = struct.unpack_from(">I4s", png, at)
        content = png[at + 8:at + 8 + size]
        if struct.unpack_from(">I", png, at + 8 + size)[0] != zlib.crc32(kind + content):
            raise ProtocolError(f"a chunk {kind} with a wrong sum")
        found.append((kind, content))
        at += 12 + size
    if found[-1] != (b"IEND", b""):
        raise ProtocolError("a PNG without an end")
    return found


def paeth(left, up, corner):
    guess = left + up - corner
    return min((left, up, corner), key=lambda v: abs(guess - v))  # of equals the first


def unfiltered(kind, line, before, step):
    """A row of a PNG (its section 9) as it was before it was filtered."""
    if kind == 0:
        return line
    if kind == 2:
        return bytearray((a + b) & 255 for a, b in zip(line, before))
    for i, value in enumerate(line):
        left, corner = (line[i - step], before[i - step]) if i >= step else (0, 0)
        predicted = {1: left, 3: (left + before[i]) // 2, 4: 0}[kind] if kind != 4 else paeth(left, before[i], corner)
        line[i] = (value + predicted) & 255
    return line


class Picture:
    """Pixels: rgb has three bytes for each, the top row first."""

    def __init__(self, width, height, rgb):
        if len(rgb) != width * height * 3:
            raise ProtocolError(f"{len(rgb)} bytes are no picture of {width} x {height}")
        self.width, self.height, self.rgb = width, height, bytes(rgb)

    @classmethod
    def of_png(cls, png):
        found = chunks(png)
        width, height, depth, colour, packing, filtering, interlaced = struct.unpack(">IIBBBBB", found[0][1])
        if found[0][0] != b"IHDR" or depth != 8 or colour not in CHANNELS or packing or filtering or interlaced:
            raise ProtocolError(f"a PNG of another kind: {found[0]}")
        data = zlib.decompress(b"".join(content for kind, content in found if kind == b"IDAT"))
        step = CHANNELS[colour]
        if len(data) != height * (1 + width * step):
            raise ProtocolError(f"a PNG of {width} x {height} with {len(data)} bytes")
        rows, before = [], bytes(width * step)
        for y in range(height):
            at = y * (1 + width * step)
            before = unfiltered(data[at], bytearray(data[at + 1:at + 1 + width * step]), before, step)
            rows.append(before)
        return cls(width, height, b"".join(rows)) if step == 3 else cls.of_rgba(width, height, b"".join(rows))

    @classmethod
    def of_rgba(cls, width, height, data):
        if data[3::4].count(255) != width * height:
            raise ProtocolError("a picture one can see through")
        rgb = bytearray(width * height * 3)
        for channel in range(3):
            rgb[channel::3] = data[channel::4]
        return cls(width, height, rgb)

    def __eq__(self, other):
        return (self.width, self.height, self.rgb) == (other.width, other.height, other.rgb)

    def __repr__(self):
        return f"<{self.width} x {self.height}, {len(set(self.pixels()))} colours, middle {self.at(self.width // 2, self.height // 2)}>"

    def at(self, x, y):
        return tuple(self.rgb[(y * self.width + x) * 3:][:3])

    def pixels(self):
        return list(zip(self.rgb[0::3], self.rgb[1::3], self.rgb[2::3]))

    def row(self, y):
        return self.pixels()[y * self.width:(y + 1) * self.width]

    def brightness(self):
        return sum(self.rgb) / len(self.rgb)

    def shown(self):
        """Where it is not as in the upper left corner: {(x, y)}."""
        pixels = self.pixels()
        return {(i % self.width, i // self.width) for i, p in enumerate(pixels) if p != pixels[0]}

    def extent(self):
        """(left, top, right, bottom) of what is shown; right and bottom are the first pixels beyond."""
        shown = self.shown()
        xs, ys = [x for x, _ in shown], [y for _, y in shown]
        return min(xs), min(ys), max(xs) + 1, max(ys) + 1

    def edge_is_clear(self):
        w, h = self.width, self.height
        return not any(x in (0, w - 1) or y in (0, h - 1) for x, y in self.shown())

    def differing(self, other, by=0):
        """The share of pixels that are further apart than that in some channel."""
        return sum(any(abs(a - b) > by for a, b in zip(p, q)) for p, q in zip(self.pixels(), other.pixels())) / (self.width * self.height)


def png_of(rows):
    """A PNG file of rows of (r, g, b)."""
    def chunk(kind, content):
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))
    data = b"".join(b"\0" + bytes(c for pixel in row for c in pixel) for row in rows)
    return (PNG_SIGNATURE + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(data)) + chunk(b"IEND", b""))


def jpeg_size(data):
    """(width, height) by the frame header of a JPEG, of which every segment up to the scan is looked at."""
    if data[:2] != b"\xff\xd8" or data[-2:] != b"\xff\xd9":
        raise ProtocolError(f"no JPEG, or not all of it: {data[:16].hex()} … {data[-4:].hex()}")
    at, size = 2, None
    while True:
        mark, kind, length = struct.unpack_from(">BBH", data, at)
        if mark != 0xFF:
            raise ProtocolError(f"no JPEG marker at {at}")
        if 0xC0 <= kind <= 0xC2:
            depth, height, width, components = struct.unpack_from(">BHHB", data, at + 4)
            if (depth, components) != (8, 3):
                raise ProtocolError(f"a JPEG of {components} components of {depth} bits")
            size = width, height
        if kind == 0xDA:
            if size is None:
                raise ProtocolError("a JPEG whose scan comes before its frame")
            return size
        at += 2 + length


class Mjpeg(HttpClient):
    """A stream of pictures: each is read together with the boundary behind it, for only then is it known to be whole."""

    def __init__(self, port, target, headers=None, **kw):
        super().__init__(port, **kw)
        self.send_raw(self.request_bytes("GET", target, headers=headers))
        self.status, self.headers = read_http_head(self, time.monotonic() + PATIENCE_S)
        if self.status == 200:
            kind = re.fullmatch(r"multipart/x-mixed-replace; *boundary=\"?([^\"\s;]+)\"?", self.headers["content-type"])
            if not kind or "content-length" in self.headers or "transfer-encoding" in self.headers:
                raise ProtocolError(f"no stream of pictures: {self.headers}")
            self.boundary = b"--" + kind[1].encode() + b"\r\n"
            self.expect(self.boundary, time.monotonic() + PATIENCE_S)

    def expect(self, bytes_, deadline):
        if (got := self.take(len(bytes_), deadline)) != bytes_:
            raise ProtocolError(f"expected {bytes_}, got {got}")

    def picture(self, seconds=PATIENCE_S):
        """The next picture's JPEG."""
        deadline = time.monotonic() + seconds
        while (end := self.received.find(b"\r\n\r\n")) < 0:
            self.fill(deadline)
        lines = self.take(end + 4, deadline).decode().split("\r\n")[:-2]
        headers = {name.lower(): value.strip() for name, value in (line.split(":", 1) for line in lines)}
        if headers["content-type"] != "image/jpeg":
            raise ProtocolError(f"a part with {headers}")
        data = self.take(int(headers["content-length"]), deadline)
        self.expect(b"\r\n" + self.boundary, deadline)
        return data

    def silent(self, seconds=0.2):
        try:
            self.fill(time.monotonic() + seconds)
        except TimeoutError:
            return not self.received
        return False

    def ends(self):
        """Reads what is left."""
        try:
            while True:
                self.fill(time.monotonic() + PATIENCE_S)
        except Closed:
            return bytes(self.received)


class PictureCase(harness.TestCase):
    """A server that draws."""
    render = True

    def file(self, client=None, **kw):
        """A picture's file by frame.render, small unless said otherwise."""
        answer = (client or self.c).call("frame.render", **SQUARE | kw)
        self.assertEqual(set(answer), {"time", "width", "height", "format", "base64"})
        return base64.b64decode(answer["base64"], validate=True)

    def picture(self, **kw):
        return Picture.of_png(self.file(**kw))

    def add_quad(self, actor="quad", **kw):
        return self.c.call("actor.add", actor=actor, mesh=QUAD, **kw)

    def straight(self):
        """The scene's camera looks straight at z = 0, and everything shows its own colour."""
        self.c.call("camera.set", **STRAIGHT)
        self.c.call("light.set", **EVEN)

    def add_growing(self, keys=((0, 1), (1, 3), (2, 2)), **kw):
        """A quad of so many metres' half a side at such times."""
        self.add_quad(**kw)
        at = {"actor": kw["actor"]} if "actor" in kw else {}
        for time, size in keys:
            self.c.call("keyframe.add", time=time, vertices={"positions": [size * p for p in QUAD["positions"]]}, **at)

    def coloured(self, picture, x, y, want, tolerance=1):
        got = picture.at(x, y)
        self.assertLessEqual(max(abs(g - w) for g, w in zip(got, want)), tolerance, f"at {x}, {y}: got {got}, want {want}")

    def spans(self, picture, want, tolerance=1):
        """What is shown reaches from left, top to right, bottom."""
        got = picture.extent()
        self.assertLessEqual(max(abs(g - w) for g, w in zip(got, want)), tolerance, f"got {got}, want {want}")


class GrowingCase(PictureCase):
    """A growing quad, which the scene's camera looks straight at, and a client beside the one that watches."""
    encoding = "png"  # of streams, unless said otherwise

    def setUp(self):
        super().setUp()
        self.add_growing()
        self.c.call("camera.set", **STRAIGHT)
        self.other = self.server.line()

    def open(self, client=None, **kw):
        """A stream of small pictures: its number."""
        return (client or self.c).call("stream.open", **{"kind": "frames", "encoding": self.encoding} | SQUARE | kw)["stream"]

    def seek(self, t):
        return self.other.call("playback.seek", time=t)
