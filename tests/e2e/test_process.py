"""The program (section 9): options, what it refuses, one server a data folder, and how it ends."""
import contextlib
import os
import signal
import socket
import subprocess
import threading
import time

import harness
from client import PATIENCE_S, Closed, Packet, request_json
from harness import TWEEND, lifted, wait_until


class CommandLine(harness.TestCase):
    starts_server = False

    def run_program(self, *arguments):
        """A run that must end by itself."""
        return subprocess.run([TWEEND, *arguments], capture_output=True, text=True, timeout=30, preexec_fn=harness.die_with_parent)

    def refuses(self, *arguments, code=None, says=()):
        done = self.run_program("serve", *arguments)
        self.assertNotIn(done.returncode, (0, -6, -11), done)
        if code is not None:
            self.assertEqual(done.returncode, code, done)
        for word in says:
            self.assertIn(word, done.stderr)
        self.assertNotIn("http://", done.stdout)

    def test_help_and_version(self):
        for arguments in (("--help",), ("serve", "--help")):
            done = self.run_program(*arguments)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
        for option in ("--listen", "--port-file", "--data", "--assets", "--load", "--play", "--no-auth", "--allow-origin"):
            self.assertIn(option, done.stdout)
        for limit in ("10000", "64", "256", "1024", "4000000", "100000", "16777216"):
            self.assertIn(limit, done.stdout, "defaults are told")
        self.assertRegex(self.run_program("--version").stdout, r"^tweend \d+\.\d+\.\d+\n$")

    def test_wrong_usage_is_2(self):
        for arguments in ((), ("serve", "--nope"), ("serve", "extra"), ("nope",), ("serve", "--listen"), ("serve", "--max-scenes", "many"),
                          ("serve", "--no-auth=perhaps")):
            done = self.run_program(*arguments)
            self.assertEqual((done.returncode, done.stdout), (2, ""), arguments)
            self.assertTrue(done.stderr)

    def test_bad_addresses(self):
        for address in ("nonsense", "127.0.0.1", "127.0.0.1:", "127.0.0.1:x", "127.0.0.1:70000", "127.0.0.1:-1", "999.0.0.1:0", ":0",
                        "example.invalid:0", "127.0.0.1:0x", ""):
            self.refuses("--no-auth", "--listen", address)
        self.refuses("--no-auth", "--listen", "nonsense", says=("nonsense", "127.0.0.1:8933"))

    def test_only_loopback_without_authentication(self):
        for address in ("0.0.0.0:0", "[::]:0", "192.0.2.1:0"):
            self.refuses("--no-auth", "--listen", address, says=("--no-auth", "loopback"))

    def test_no_auth_has_to_be_said(self):
        self.refuses("--listen", "127.0.0.1:0", says=("--no-auth",))

    def test_a_port_that_is_taken(self):
        server = self.serve()
        self.refuses("--no-auth", "--listen", f"127.0.0.1:{server.port}", says=(str(server.port),))
        server.line().call("server.ping")

    def test_folders_and_files_that_are_not_there(self):
        folder = self.folder()
        self.refuses("--no-auth", "--listen", "127.0.0.1:0", "--assets", f"{folder}/none", says=(f"{folder}/none",))
        self.refuses("--no-auth", "--listen", "127.0.0.1:0", "--port-file", f"{folder}/none/port", says=("--port-file",))
        with open(f"{folder}/file", "w"):
            pass
        self.refuses("--no-auth", "--listen", "127.0.0.1:0", "--data", f"{folder}/file", says=(f"{folder}/file",))
        self.refuses("--no-auth", "--listen", "127.0.0.1:0", "--assets", folder, "--load", "none.obj", says=("none.obj",))

    def test_loopback_of_version_6(self):
        try:
            with socket.socket(socket.AF_INET6) as probe:
                probe.bind(("::1", 0))
        except OSError:
            self.skipTest("this machine has no IPv6")
        folder = self.folder()
        process = subprocess.Popen([TWEEND, "serve", "--no-auth", "--listen", "[::1]:0", "--port-file", f"{folder}/port"],
                                   stdout=subprocess.PIPE, text=True, preexec_fn=harness.die_with_parent)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.wait, 30)
        self.addCleanup(process.terminate)
        wait_until(lambda: os.path.exists(f"{folder}/port"), "the port file")
        with open(f"{folder}/port") as f:
            port = int(f.read())
        self.assertEqual(process.stdout.readline(), f"http://[::1]:{port}/\n")
        with socket.create_connection(("::1", port), timeout=30) as s:
            s.sendall(request_json("server.ping", id=1) + b"\n")
            with s.makefile("rb") as answers:
                self.assertIn(b"time_us", answers.readline())


class Starting(harness.TestCase):
    starts_server = False

    def assets_folder(self):
        folder = self.folder()
        harness.write_sequence(folder, "wave", {0: lifted(0), 24: lifted(1)})
        harness.write_obj(f"{folder}/props/cup.obj", lifted(3))
        return folder

    def test_the_address_is_printed_and_the_port_file_is_whole(self):
        server = self.serve()
        wait_until(lambda: f"http://127.0.0.1:{server.port}/\n" in server.log_text(), "the address, which is printed behind the file")
        with open(server.port_file) as f:
            self.assertEqual(f.read().strip(), str(server.port))
        self.assertEqual(server.http("GET", "/healthz")[0], 200)

    def test_load(self):
        server = self.serve("--load", "wave", "--load", "props/cup.obj", "--load", "wave", assets=[self.assets_folder()])
        c = server.line()
        actors = c.call("scene.describe")["actors"]
        self.assertEqual([(a["actor"], a["source"]) for a in actors], [("wave", "wave"), ("cup", "props/cup.obj")])
        self.assertEqual([a["player"]["playing"] for a in actors], [False, False])

    def test_load_and_play(self):
        server = self.serve("--load", "wave", "--load", "props/cup.obj", "--play", assets=[self.assets_folder()])
        c = server.line()
        first = c.call("playback.get", actor="wave")
        self.assertTrue(first["players"][0]["playing"])
        wait_until(lambda: c.call("playback.get", actor="wave")["players"][0]["time"] != first["players"][0]["time"], "time goes on")

    def test_a_data_folder_serves_one_server(self):
        folder = os.path.join(self.folder(), "new", "data")
        server = self.serve("--data", folder)
        second = subprocess.run([TWEEND, "serve", "--no-auth", "--listen", "127.0.0.1:0", "--data", folder], capture_output=True, text=True,
                                timeout=30)
        self.assertNotEqual(second.returncode, 0)
        self.assertIn(folder, second.stderr)
        server.line().call("server.ping")
        self.assertEqual(server.stop(), 0)
        self.serve("--data", folder)

    def test_a_data_folder_is_free_again_after_a_crash(self):
        folder = self.folder()
        victim = subprocess.Popen([TWEEND, "serve", "--no-auth", "--listen", "127.0.0.1:0", "--data", folder, "--port-file", f"{folder}/port"],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, preexec_fn=harness.die_with_parent)
        wait_until(lambda: os.path.exists(f"{folder}/port"), "the port file")
        victim.kill()
        victim.wait()
        self.serve("--data", folder).line().call("server.ping")


class Ending(harness.TestCase):
    def test_with_nobody_there(self):
        for number in (signal.SIGTERM, signal.SIGINT):
            server = self.serve()
            begin = time.monotonic()
            self.assertEqual(server.stop(number), 0)
            self.assertLess(time.monotonic() - begin, 10)

    def test_with_idle_clients_of_all_sorts(self):
        for number in (signal.SIGTERM, signal.SIGINT):
            server = self.serve()
            clients = [server.line(), server.line(), server.websocket(), server.websocket(), server.http_client(), server.line(), server.http_client()]
            clients[0].call("events.subscribe")
            clients[1].send_raw(b'{"jsonrpc":"2.0","id":1,"meth')
            clients[2].call("events.subscribe")
            clients[3].send_raw(b"\x81\xfe")
            clients[4].ask("GET", "/healthz")
            clients[6].send_raw(b"GET /healthz HT")
            self.assertEqual(server.stop(number), 0)
            for c in clients:
                with self.assertRaises((Closed, ConnectionError)):
                    while True:
                        c.fill(time.monotonic() + PATIENCE_S)

    def test_while_streaming_to_many(self):
        self.add_waving_grid(60)
        self.c.call("playback.play")
        readers = [self.server.line(), self.server.line(), self.server.websocket()]
        stuck = [self.server.line(receive_buffer=4096) for _ in range(3)]
        for c in readers:  # at a rate at which nothing waits for them, even should they pause for a moment
            c.call("stream.open", kind="vertices", rate=10)
            c.packet()
        for c in stuck:
            c.send("stream.open", kind="vertices", rate=120)
        wait_until(lambda: self.c.call("server.stats")["tweend_packets_skipped_total"] > 5, "some are stuck")
        results = []
        threads = [threading.Thread(target=lambda c=c: results.append(c.read_to_end())) for c in readers]
        for t in threads:
            t.start()
        begin = time.monotonic()
        self.assertEqual(self.server.stop(), 0)
        self.assertLess(time.monotonic() - begin, 10, "stuck readers are not waited for")
        for t in threads:
            t.join(30)
        self.assertEqual(len(results), 3, "nothing was cut in two")  # read_to_end refuses half a line or packet
        self.assertTrue(all(isinstance(m, Packet) for came in results for m in came))

    def test_what_was_asked_is_answered(self):
        """All that has been sent before the signal: edits, samples, queries; no answer is cut off."""
        for attempt in range(5):
            server = self.serve()
            clients = [server.line(), server.websocket(), server.line()]
            count = 150
            methods = ("keyframe.list", "vertices.sample", "scene.describe", "asset.list", "playback.play", "playback.get", "server.ping")
            clients[0].call("actor.add", actor="tri", mesh=harness.TRIANGLE)
            for c in clients[1:]:
                c.call("server.ping")
            sent = {}
            for c in clients:
                for i in range(count):
                    if i % 3 == 0:
                        sent[c, c.send("keyframe.add", vertices={"positions": lifted(i)})] = "keyframe.add"
                    else:
                        method = methods[i % len(methods)]
                        sent[c, c.send(method)] = method
            self.assertEqual(server.stop(), 0)
            for c in clients:
                answers = c.read_to_end()
                self.assertEqual(sorted(a["id"] for a in answers), sorted(id for client, id in sent if client is c), f"attempt {attempt}")
                self.assertEqual([a["error"] for a in answers if "error" in a], [])
                order = [a["id"] for a in answers if sent[c, a["id"]] != "server.ping"]
                self.assertEqual(order, sorted(order))

    def test_a_request_over_http_that_is_being_answered(self):
        self.c.call("actor.add", actor="grid", mesh=harness.grid(120))
        http = self.server.http_client()
        self.assertEqual(http.ask("GET", "/healthz")[0], 200)
        http.send_raw(http.request_bytes("POST", "/rpc", request_json("vertices.sample", {"indices": True}, 1)))
        answers = []
        reading = threading.Thread(target=lambda: answers.append(http.read_answer()))
        reading.start()
        self.assertEqual(self.server.stop(), 0)
        reading.join(30)
        self.assertEqual(answers[0][0], 200)

    def test_while_clients_come_and_go(self):
        stop = threading.Event()

        def visitor(seed):
            while not stop.is_set():
                with contextlib.suppress(OSError):
                    c = harness.LineClient(self.server.port)
                    try:
                        c.call("scene.describe")
                        c.call("camera.set", fov_y=1)
                    finally:
                        c.reset() if seed % 2 else c.close()
        threads = [threading.Thread(target=visitor, args=(i,)) for i in range(4)]
        for t in threads:
            t.start()
        wait_until(lambda: self.c.call("server.stats")["tweend_edits_total"] > 50, "they are at work")
        code = self.server.stop()
        stop.set()
        for t in threads:
            t.join(30)
        self.assertEqual(code, 0)

    def test_with_a_client_that_asks_and_never_reads(self):
        self.c.call("actor.add", actor="grid", mesh=harness.grid(100))
        greedy = self.server.line(receive_buffer=4096)
        greedy.sock.setblocking(False)
        try:
            while True:
                greedy.sock.send(request_json("vertices.sample", {"indices": True}, 1) + b"\n")
        except BlockingIOError:
            pass
        wait_until(lambda: self.c.call("server.stats")["tweend_requests_total"] > 5, "some were taken")
        begin = time.monotonic()
        self.assertEqual(self.server.stop(), 0)
        self.assertLess(time.monotonic() - begin, 10)

    def test_no_new_clients_are_taken(self):
        port = self.server.port
        self.assertEqual(self.server.stop(), 0)
        with self.assertRaises(ConnectionRefusedError):
            socket.create_connection(("127.0.0.1", port), timeout=5)


if __name__ == "__main__":
    harness.main()
