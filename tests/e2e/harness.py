"""Starts and ends servers for tests, and what the tests share: a TestCase, meshes, OBJ files."""
import contextlib
import ctypes
import os
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True
from client import PATIENCE_S, HttpClient, LineClient, RpcError, WebSocketClient  # noqa: E402

TWEEND = os.environ["TWEEND"]
TWEENCTL = os.environ["TWEENCTL"]
LIBC = ctypes.CDLL(None)
PR_SET_PDEATHSIG = 1

TRIANGLE = {"positions": [0, 0, 0, 1, 0, 0, 0, 1, 0], "indices": [0, 1, 2]}


def die_with_parent():
    """In a child: should the tests be killed, the kernel ends it too."""
    LIBC.prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def wait_until(condition, what, seconds=PATIENCE_S):
    """Looks again and again until the condition holds; its value."""
    deadline = time.monotonic() + seconds
    while not (value := condition()):
        if time.monotonic() > deadline:
            raise TimeoutError(f"not within {seconds} s: {what}")
        time.sleep(0.005)
    return value


class Server:
    """A server of its own on a port that the system picked. close() ends it and looks at how it went.

    With render it draws pictures; what that needs takes a fifth of a second to start, so it is not the default.
    """

    def __init__(self, *options, assets=(), auth=("--no-auth",), listen="127.0.0.1:0", render=False):
        self.folder = tempfile.mkdtemp(prefix="tweend-e2e-")
        self.port_file = os.path.join(self.folder, "port")
        self.log = os.path.join(self.folder, "log")
        self.clients = []
        command = [TWEEND, "serve", "--listen", listen, "--port-file", self.port_file, *auth]
        if not render:
            command.append("--no-render")
        for folder in assets:
            command += ["--assets", folder]
        self.process = None
        try:
            with open(self.log, "wb") as log:
                self.process = subprocess.Popen([*command, *map(str, options)], stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                                                preexec_fn=die_with_parent)
            wait_until(lambda: self.process.poll() is not None or os.path.exists(self.port_file), "the port file")
            if self.process.poll() is not None:
                raise RuntimeError(f"the server ended at once: {self.process.returncode}\n{self.log_text()}")
            with open(self.port_file) as f:
                self.port = int(f.read())
            wait_until(lambda: self.http("GET", "/readyz")[0] == 200, "readiness")
        except BaseException:
            if self.process:
                self.process.kill()
                self.process.wait()
            shutil.rmtree(self.folder)
            raise

    def log_text(self):
        with open(self.log, errors="replace") as f:
            return f.read()

    def keep(self, client):
        self.clients.append(client)
        return client

    def line(self, **kw):
        return self.keep(LineClient(self.port, **kw))

    def websocket(self, **kw):
        return self.keep(WebSocketClient(self.port, **kw))

    def http_client(self):
        return self.keep(HttpClient(self.port))

    def http(self, method, target, body=None, headers=None):
        """One request on a connection of its own."""
        client = HttpClient(self.port)
        try:
            return client.ask(method, target, body, headers)
        finally:
            client.close()

    def rss_mib(self):
        with open(f"/proc/{self.process.pid}/status") as f:
            return next(int(line.split()[1]) / 1024 for line in f if line.startswith("VmRSS:"))

    def sanitized(self):
        with open(f"/proc/{self.process.pid}/maps") as f:
            return any("san.so" in line for line in f)

    def tell_to_stop(self, signal_number=signal.SIGTERM):
        if self.process.poll() is None:
            self.process.send_signal(signal_number)

    def stop(self, signal_number=signal.SIGTERM):
        """Ends it as an administrator would; its exit code."""
        self.tell_to_stop(signal_number)
        return self.process.wait(PATIENCE_S)

    def close(self):
        for client in self.clients:  # first, so that no goodbye waits for those that don't read
            client.close()
        try:
            code = self.stop()
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            code = "never: it had to be killed"
        log = self.log_text()
        shutil.rmtree(self.folder)
        if code != 0 or "Sanitizer" in log or "runtime error" in log:
            raise AssertionError(f"the server's exit code after SIGTERM: {code}; it said:\n{log[-8000:]}")


class TestCase(unittest.TestCase):
    """Each test gets a server with these options and a line client of it."""
    options = ()
    assets = ()
    render = False
    starts_server = True
    needs_h264 = False

    def setUp(self):
        if self.starts_server:
            self.server = self.serve(*self.options, assets=self.assets, render=self.render)
            self.c = self.server.line()
            self.c.call("server.ping")  # who says nothing for long is taken for nobody
            if self.needs_h264:
                self.skip_without_h264()

    def skip_without_h264(self):
        """Builds with -DTWEEND_H264=OFF have none."""
        if "frames:h264" not in self.c.call("server.hello")["capabilities"]:
            self.skipTest("a build without H.264")

    def serve(self, *options, **kw):
        server = Server(*options, **kw)
        self.addCleanup(server.close)
        return server

    def folder(self):
        folder = tempfile.mkdtemp(prefix="tweend-e2e-")
        self.addCleanup(shutil.rmtree, folder)
        return folder

    def refused(self, code, method, /, *, path=None, by=None, **params):
        """Calls and expects this error, at this path if one is given: the error."""
        try:
            result = (by or self.c).call(method, **params)
        except RpcError as error:
            self.assertEqual(error.code, code, f"{method} {str(params)[:300]}: {error}")
            if path is not None:
                self.assertEqual(error.path, path, f"{method} {str(params)[:300]}: {error}")
            return error
        self.fail(f"{method} {str(params)[:300]} was not refused: {str(result)[:300]}")

    def snapshot(self, scene="main", document_only=False):
        """All that can be known of a scene; with document_only without its revision and players."""
        described = self.c.call("scene.describe", scene=scene)
        if document_only:
            del described["revision"]
            for actor in described["actors"]:
                del actor["player"]
        keyframes = {}
        for actor in described["actors"]:
            for clip in actor["clips"]:
                at = {"scene": scene, "actor": actor["actor"], "clip": clip["clip"]}
                keyframes[actor["actor"], clip["clip"]] = [
                    (k, actor["vertices"] and self.c.call("vertices.sample", **at, time=k["time"])["positions"],
                     actor["joints"] and self.c.call("pose.sample", **at, time=k["time"])["joints"])
                    for k in self.c.call("keyframe.list", **at)["keyframes"]] + self.c.call("marker.list", **at)["markers"]
        return described, keyframes

    @contextlib.contextmanager
    def unchanged(self, scene="main"):
        before = self.snapshot(scene)
        yield
        self.assertEqual(self.snapshot(scene), before)

    def grew_less(self, before_mib, mib):
        """Since it held so much, the server has grown by less than that; a sanitizer holds a multiple of it."""
        self.assertLess(self.server.rss_mib() - before_mib, mib * (6 if self.server.sanitized() else 1))

    def keeps_up(self, in_a_window, what):
        """In one of three windows of time: in another this machine may have been away."""
        self.assertTrue(any(in_a_window() for _ in range(3)), what)

    def paced(self, packets, rate):
        """Each was made at a reading of the rate's grid, or more than a period after the one before: the machine was away.
        The shortest time between two, in periods."""
        period_us = 1e6 / rate
        gaps = []
        for a, b in zip(packets, packets[1:]):
            beside_us = abs(b.server_us - round(b.server_us / period_us) * period_us)
            gaps.append((b.server_us - a.server_us) / period_us)
            self.assertTrue(gaps[-1] > 0 and (beside_us < 2 or gaps[-1] >= 1), f"{b} comes {gaps[-1]:.3f} periods after {a}")
        return min(gaps)

    def near(self, got, want, tolerance=1e-5):
        self.assertEqual(len(got), len(want))
        worst = max((abs(g - w) for g, w in zip(got, want)), default=0)
        self.assertLessEqual(worst, tolerance, f"got {list(got)[:9]}…, want {list(want)[:9]}…")

    def add_triangle(self, actor="tri", **kw):
        return self.c.call("actor.add", actor=actor, mesh=TRIANGLE, **kw)

    def add_key(self, z, **kw):
        """Adds a keyframe to a triangle whose first corner is at height z: its id."""
        return self.c.call("keyframe.add", vertices={"positions": lifted(z)}, **kw)["keyframe"]

    def add_moving(self, actor="tri", keys=3, client=None, **kw):
        """Adds a triangle whose first corner is at height t² at the times 0, 1, …; the ids of its keyframes."""
        self.add_triangle(actor, **kw)
        at = {"scene": kw["scene"]} if "scene" in kw else {}
        return [self.add_key(t * t, actor=actor, time=t, **at) for t in range(keys)]

    def add_waving_grid(self, side, heights=(0.0, 1.0), actor="grid"):
        """Adds a mesh of side × side vertices that is at these heights at the times 0, 1, …"""
        self.c.call("actor.add", actor=actor, mesh=grid(side))
        for height in heights:
            self.c.call("keyframe.add", actor=actor, vertices={"positions": grid(side, height)["positions"]})

    def player(self, **kw):
        players = self.c.call("playback.get", **kw)["players"]
        self.assertEqual(len(players), 1)
        return players[0]


def f32(values):
    """As a float32 holds them: JSON has the shortest digits that give the same float32."""
    return list(struct.unpack(f"<{len(values)}f", struct.pack(f"<{len(values)}f", *values)))


def lifted(z):
    return [0, 0, z, 1, 0, 0, 0, 1, 0]


def grid(n, height=0.0):
    """A mesh of n × n vertices."""
    positions = [c for y in range(n) for x in range(n) for c in (x / n, y / n, height)]
    indices = [i for y in range(n - 1) for x in range(n - 1)
               for i in (y * n + x, y * n + x + 1, y * n + x + n, y * n + x + 1, y * n + x + n + 1, y * n + x + n)]
    return {"positions": positions, "indices": indices}


def write_obj(path, positions, faces=((1, 2, 3),), tail=""):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    lines = [f"v {positions[i]:.9g} {positions[i + 1]:.9g} {positions[i + 2]:.9g}" for i in range(0, len(positions), 3)]
    lines += ["f " + " ".join(map(str, face)) for face in faces]
    with open(path, "w") as f:
        f.write("\n".join(lines) + "\n" + tail)


def write_sequence(root, name, frames, faces=((1, 2, 3),)):
    """A folder of OBJ files: frames is {number: positions}."""
    for number, positions in frames.items():
        write_obj(os.path.join(root, name, f"{os.path.basename(name)}_{number:06d}.obj"), positions, faces)


def main():
    unittest.main()
