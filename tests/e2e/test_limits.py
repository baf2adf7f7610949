"""Each limit is an option; one more than it allows is refused and changes nothing (section 5.3)."""
import contextlib
import json
import os
import struct
import subprocess
import zlib

import harness
from client import Closed, LineClient, request_json
from harness import TRIANGLE, lifted, wait_until

QUAD = {"positions": [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0], "indices": [0, 1, 2, 0, 2, 3]}


def png(width, height):
    """A grey image."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = (b"\0" + b"\x80" * width) * height
    header = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


class Limits(harness.TestCase):
    starts_server = False

    def start(self, *options, **kw):
        self.server = self.serve(*options, **kw)
        self.c = self.server.line()

    def refused_as_limit(self, method, /, **params):
        with self.unchanged():
            self.refused(-32004, method, **params)

    def test_connections(self):
        self.server = self.serve("--max-connections", 3)

        def gets_in():
            c = LineClient(self.server.port)
            try:
                return c.call("server.ping")
            except ConnectionError:
                return None
            finally:
                c.close()

        def first():
            c = self.server.line()
            with contextlib.suppress(ConnectionError):
                if c.call("server.stats")["tweend_connections"] == 1:
                    return c
            c.close()
            return None
        self.c = wait_until(first, "who looked whether it was ready is gone")
        others = [self.server.line() for _ in range(2)]
        for c in others:
            c.call("server.ping")
        for _ in range(3):
            extra = self.server.line()
            with self.assertRaises((Closed, ConnectionError)):
                extra.call("server.ping")
        self.c.call("server.ping")
        others.pop().close()
        wait_until(gets_in, "a place for a new connection")

    def test_streams(self):
        self.start("--max-streams", 2)
        self.add_moving()
        opened = [self.c.call("stream.open", kind="vertices")["stream"] for _ in range(2)]
        self.refused_as_limit("stream.open", kind="vertices")
        self.server.line().call("stream.open", kind="vertices")  # of a connection, not of all
        self.c.call("stream.close", stream=opened[0])
        self.assertNotIn(self.c.call("stream.open", kind="vertices")["stream"], opened)
        self.refused_as_limit("stream.open", kind="vertices")

    def test_scenes(self):
        self.start("--max-scenes", 2)
        self.c.call("scene.create", scene="a")
        self.refused(-32004, "scene.create", scene="b")
        self.assertEqual([s["scene"] for s in self.c.call("scene.list")["scenes"]], ["a", "main"])
        self.c.call("scene.remove", scene="a")
        self.c.call("scene.create", scene="b")

    def test_actors(self):
        self.start("--max-actors", 2)
        self.add_triangle("a")
        self.add_triangle("b")
        self.refused_as_limit("actor.add", actor="c", mesh=TRIANGLE)
        self.refused_as_limit("edit.apply", edits=[{"method": "camera.set", "params": {"eye": [1, 2, 3]}},
                                                   {"method": "actor.add", "params": {"actor": "c", "mesh": TRIANGLE}}])
        self.c.call("actor.remove", actor="a")
        self.add_triangle("c")

    def test_vertices(self):
        folder = self.folder()
        harness.write_obj(os.path.join(folder, "quad.obj"), QUAD["positions"], [(1, 2, 3, 4)])
        harness.write_obj(os.path.join(folder, "tri.obj"), TRIANGLE["positions"])
        self.start("--max-vertices", 3, assets=[folder])
        self.refused_as_limit("actor.add", actor="quad", mesh=QUAD)
        self.refused_as_limit("actor.add", actor="quad", asset="quad.obj")
        self.c.call("actor.add", actor="tri", asset="tri.obj")
        self.add_triangle("tri2")

    def test_keyframes(self):
        folder = self.folder()
        harness.write_sequence(folder, "seq", {i: lifted(i) for i in range(3)})
        self.start("--max-keyframes", 2, assets=[folder])
        self.add_moving(keys=2)
        self.refused_as_limit("keyframe.add", vertices={"positions": lifted(1)})
        self.refused_as_limit("actor.add", actor="seq", asset="seq")
        self.refused_as_limit("clip.create", clip="cue", keys=[1, 2, 1])
        self.c.call("clip.create", clip="cue", keys=[2, 1])
        self.c.call("keyframe.remove", keyframe=1)
        self.add_key(1)

    def test_clips(self):
        self.start("--max-clips", 2)
        self.add_triangle()
        self.c.call("clip.create", clip="b")
        self.refused_as_limit("clip.create", clip="c")
        self.c.call("clip.remove", clip="b")
        self.c.call("clip.create", clip="c")

    def test_steps_of_undo(self):
        self.start("--max-undo", 2)
        self.add_moving(keys=3)
        self.assertEqual([self.c.call("edit.undo")["undone"] for _ in range(2)], ["keyframe.add"] * 2)
        with self.unchanged():
            self.refused(-32001, "edit.undo")
        self.assertEqual([self.c.call("edit.redo")["redone"] for _ in range(2)], ["keyframe.add"] * 2)

    def test_bytes_of_an_asset(self):
        folder = self.folder()
        harness.write_obj(os.path.join(folder, "big.obj"), TRIANGLE["positions"], tail="# " + "x" * 5000 + "\n")
        harness.write_obj(os.path.join(folder, "small.obj"), TRIANGLE["positions"])
        self.start("--max-asset-bytes", 4000, assets=[folder])
        self.refused_as_limit("actor.add", actor="a", asset="big.obj")
        self.c.call("actor.add", actor="a", asset="small.obj")

    def test_pixels_of_a_texture(self):
        folder = self.folder()
        for name, width in (("four", 4), ("five", 5)):
            with open(os.path.join(folder, f"{name}.png"), "wb") as f:
                f.write(png(width, 1))
            with open(os.path.join(folder, f"{name}.mtl"), "w") as f:
                f.write(f"newmtl m\nmap_Kd {name}.png\n")
            with open(os.path.join(folder, f"{name}.obj"), "w") as f:
                f.write(f"mtllib {name}.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n")
        self.start("--max-texture-pixels", 4, assets=[folder])
        self.refused_as_limit("actor.add", actor="a", asset="five.obj")
        self.c.call("actor.add", actor="a", asset="four.obj")

    def test_requests_of_a_batch(self):
        self.start("--max-batch", 3)
        request = {"jsonrpc": "2.0", "id": 1, "method": "scene.list"}
        self.c.send_raw(json.dumps([request] * 3).encode() + b"\n")
        self.assertEqual(len(self.c.read()), 3)
        create = {"jsonrpc": "2.0", "id": 1, "method": "scene.create", "params": {"scene": "s"}}
        self.c.send_raw(json.dumps([create] + [request] * 3).encode() + b"\n")
        answer = self.c.read()
        self.assertEqual((answer["id"], answer["error"]["code"]), (None, -32004))
        self.assertEqual(len(self.c.call("scene.list")["scenes"]), 1)

    def test_nesting(self):
        self.start("--max-json-depth", 6)
        self.add_triangle()
        edits = [{"method": "camera.set", "params": {"eye": [1, 2, 3]}}]  # message, params, edits, edit, params, eye
        self.c.call("edit.apply", edits=edits)
        self.c.send_raw(json.dumps([json.loads(request_json("edit.apply", {"edits": edits}, 1))]).encode() + b"\n")
        answer = self.c.read()
        self.assertEqual((answer["id"], answer["error"]["code"]), (None, -32004))
        self.c.call("server.ping")

    def test_bytes_of_a_message(self):
        self.start("--max-message-bytes", 1000)
        good = request_json("server.ping", id=1)
        fits, over = good[:-1] + b" " * (1000 - len(good)) + b"}", good[:-1] + b" " * (1001 - len(good)) + b"}"
        self.c.send_raw(fits + b"\n")
        self.assertEqual(self.c.read()["id"], 1)
        self.c.send_raw(over + b"\n")
        self.assertEqual(self.c.read()["error"]["code"], -32004)
        self.assertEqual(self.c.read_to_end(), [])
        status, _, body = self.server.http("POST", "/rpc", fits)
        self.assertEqual((status, json.loads(body)["id"]), (200, 1))
        status, _, body = self.server.http("POST", "/rpc", over)
        self.assertEqual((status, json.loads(body)["error"]["code"]), (413, -32004))
        ws = self.server.websocket()
        ws.send_message(fits)
        self.assertEqual(ws.read()["id"], 1)
        ws.send_message(over)
        ws.read_to_end()
        self.assertEqual(ws.close_code, 1009)
        self.server.line().call("server.ping")

    def test_a_websocket_message_in_parts_counts_as_one(self):
        self.start("--max-message-bytes", 1000)
        ws = self.server.websocket()
        ws.send_frame(1, b"{" + b" " * 700, fin=False)
        ws.send_frame(0, b" " * 700)
        ws.read_to_end()
        self.assertEqual(ws.close_code, 1009)

    def test_limits_are_positive_numbers(self):
        for value in ("0", "-1", "x", ""):
            code = subprocess.run([harness.TWEEND, "serve", "--no-auth", "--max-scenes", value], timeout=30,
                                          capture_output=True).returncode
            self.assertEqual(code, 2, value)


if __name__ == "__main__":
    harness.main()
