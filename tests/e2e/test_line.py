"""Line JSON: what a client with nothing but a socket sees (sections 1 and 2)."""
import json
import random
import socket
import time

import harness
from client import PATIENCE_S, request_json
from harness import TRIANGLE, lifted


def line(method, params=None, id=None):
    return request_json(method, params, id) + b"\n"


class Messages(harness.TestCase):
    def one_shot(self, data):
        """Sends, ends its side, and reads all there is, like `printf … | nc`."""
        with socket.create_connection(("127.0.0.1", self.server.port), timeout=30) as s:
            s.sendall(data)
            s.shutdown(socket.SHUT_WR)
            answer = b""
            while more := s.recv(65536):
                answer += more
        self.assertTrue(answer.endswith(b"\n") or not answer, answer)
        return [json.loads(text) for text in answer.splitlines()]

    def test_a_request_without_a_line_end_before_the_end_is_answered(self):
        for data in (request_json("server.ping", id=1), request_json("server.ping", id=1) + b"\n",
                     request_json("server.ping", id=1) + b"\r\n"):
            self.assertEqual([m["id"] for m in self.one_shot(data)], [1])
        self.assertEqual([m["id"] for m in self.one_shot(line("server.ping", id=1) + request_json("scene.list", id=2))], [1, 2])

    def test_a_cut_off_request_before_the_end_is_a_parse_error(self):
        answers = self.one_shot(request_json("server.ping", id=1)[:-3])
        self.assertEqual([(m["error"]["code"], m["id"]) for m in answers], [(-32700, None)])

    def test_nothing_is_answered_to_nothing(self):
        self.assertEqual(self.one_shot(b""), [])
        self.assertEqual(self.one_shot(b"\n \n\t\r\n"), [])

    def test_blank_lines_and_carriage_returns_are_ignored(self):
        self.c.send_raw(b"\r\n\n   \t \r\n" + request_json("server.ping", id=1) + b"\r\n\n\r\n  " + request_json("server.ping", id=2) +
                        b"  \r\n \n")
        self.assertEqual([self.c.read()["id"] for _ in range(2)], [1, 2])
        self.assertEqual(self.c.settle(), [])

    def test_ids_come_back_as_they_were(self):
        ids = [0, 1, -7, 2**53 + 1, 2**63, 1.5, -0.25, "", "x", "ä\n\"\\\u0000 😀", "x" * 10000, "1", None]
        for i in ids:
            message = {"jsonrpc": "2.0", "id": i, "method": "scene.list"}
            self.c.send_raw(json.dumps(message).encode() + b"\n")
            answer = self.c.read()
            self.assertEqual((answer["id"], type(answer["id"])), (i, type(i)))
            self.assertIn("result", answer)
        self.c.send_raw(json.dumps({"jsonrpc": "2.0", "id": "ä😀", "method": "scene.list"}, ensure_ascii=False).encode() + b"\n")
        self.assertEqual(self.c.read()["id"], "ä😀")

    def test_ids_of_other_kinds_are_refused(self):
        for i in (True, [1], {"a": 1}):
            self.c.send_raw(json.dumps({"jsonrpc": "2.0", "id": i, "method": "scene.list"}).encode() + b"\n")
            answer = self.c.read()
            self.assertEqual((answer["id"], answer["error"]["code"]), (None, -32600))

    def test_what_is_no_json_is_answered_and_the_connection_lives_on(self):
        for text in (b"{oops", b"{", b"[", b"{}}", b'{"a":1,}', b"[1 2]", b'{"jsonrpc":"2.0","id":1,"method":"server.ping"} x',
                     b'{"a":NaN}', b'{"a":Infinity}', b'{"a":-Infinity}', b'{"a":01}', b"{'a':1}", b'{"a":"\t"}', b'{"a":"\\x"}',
                     b"[1]]", b'{"a":1e}', b'{"a" 1}', b"// comment", b'{"a":/**/1}'):
            self.c.send_raw(b" " + text + b"\n")
            answer = self.c.read()
            self.assertEqual((answer["id"], answer["error"]["code"]), (None, -32700), text)
        self.c.call("server.ping")

    def test_what_is_no_request_is_answered_and_the_connection_lives_on(self):
        good = {"jsonrpc": "2.0", "id": 5, "method": "server.ping"}
        for message in ({}, {"id": 5}, good | {"jsonrpc": "1.0"}, good | {"jsonrpc": 2.0}, {"id": 5, "method": "server.ping"},
                        good | {"method": 1}, good | {"method": None}, {"jsonrpc": "2.0", "id": 5}, good | {"params": 1},
                        good | {"params": "x"}):
            self.c.send_raw(json.dumps(message).encode() + b"\n")
            answer = self.c.read()
            self.assertEqual(answer["error"]["code"], -32600, message)
            self.assertIn(answer["id"], (None, 5))
        for text in (b" 1", b' "x"', b" null", b" true"):
            self.c.send_raw(text + b"\n")
            answer = self.c.read()
            self.assertEqual((answer["id"], answer["error"]["code"]), (None, -32600), text)
        self.c.send_raw(json.dumps(good | {"params": [1]}).encode() + b"\n")
        self.assertIn(self.c.read()["error"]["code"], (-32600, -32602))
        self.c.call("server.ping")

    def test_notifications_are_carried_out_without_an_answer(self):
        self.c.notify("actor.add", actor="tri", mesh=TRIANGLE)
        self.c.notify("keyframe.add", time=0.5, vertices={"positions": lifted(1)})
        self.c.notify("keyframe.add", time=0.5, vertices={"positions": lifted(1)})  # refused, silently
        self.c.notify("no.such.method")
        self.c.notify("server.ping")
        self.c.notify("scene.list")
        self.assertEqual([k["time"] for k in self.c.call("keyframe.list")["keyframes"]], [0.5])
        self.assertEqual(self.c.settle(), [])


class Batches(harness.TestCase):
    def batch(self, *messages):
        self.c.send_raw(json.dumps(messages).encode() + b"\n")

    def request(self, id, method, **params):
        return {"jsonrpc": "2.0", "id": id, "method": method, "params": params}

    def test_a_batch_is_answered_by_one_array_in_order(self):
        self.batch(self.request("a", "actor.add", actor="tri", mesh=TRIANGLE), self.request(2, "keyframe.list"),
                   self.request(3, "keyframe.add", vertices={"positions": lifted(1)}), self.request(4, "keyframe.list"),
                   self.request(5, "server.ping"), self.request(6, "no.such"), 7, {"jsonrpc": "2.0", "method": "scene.list"},
                   self.request(8, "vertices.sample"))
        answer = self.c.read()
        self.assertEqual([m["id"] for m in answer], ["a", 2, 3, 4, 5, 6, None, 8])
        self.assertEqual([m.get("error", {}).get("code") for m in answer], [None] * 5 + [-32601, -32600, None])
        self.assertEqual([len(answer[i]["result"]["keyframes"]) for i in (1, 3)], [0, 1])

    def test_a_batch_of_notifications_is_not_answered(self):
        self.batch({"jsonrpc": "2.0", "method": "scene.create", "params": {"scene": "s"}}, {"jsonrpc": "2.0", "method": "no.such"})
        self.assertEqual(len(self.c.call("scene.list")["scenes"]), 2)
        self.assertEqual(self.c.settle(), [])

    def test_an_empty_batch_is_refused_by_a_single_answer(self):
        self.batch()
        answer = self.c.read()
        self.assertEqual((answer["id"], answer["error"]["code"]), (None, -32600))

    def test_a_batch_of_what_is_no_request_is_answered_by_as_many_errors(self):
        self.batch(1, "x", None, [], [1])
        self.assertEqual([(m["id"], m["error"]["code"]) for m in self.c.read()], [(None, -32600)] * 5)

    def test_a_batch_keeps_its_place_between_single_requests(self):
        self.c.send_raw(line("scene.list", id=1) + json.dumps([self.request(2, "scene.list"), self.request(3, "asset.list")]).encode() +
                        b"\n" + line("scene.list", id=4))
        got = [self.c.read() for _ in range(3)]
        self.assertEqual([got[0]["id"], [m["id"] for m in got[1]], got[2]["id"]], [1, [2, 3], 4])

    def test_events_and_packets_never_come_between_the_answers_of_a_batch(self):
        self.add_moving()
        self.c.call("events.subscribe")
        self.batch(self.request(1, "stream.open", kind="vertices"), self.request(2, "playback.play"),
                   self.request(3, "vertices.sample"), self.request(4, "playback.pause"))
        got = self.c.read_where(lambda m: isinstance(m, list))  # read_message refuses what is cut in two
        self.assertEqual([m["id"] for m in got], [1, 2, 3, 4])
        self.c.event("playback.changed")


class Pipelines(harness.TestCase):
    """Random requests of all sorts, sent without waiting, against a model of what each must be answered."""

    def setUp(self):
        super().setUp()
        self.add_triangle()
        self.keys = {}  # time -> (id, height)
        self.next_key = 1
        self.seed = random.randrange(1 << 30)

    def make(self, rng):
        """A request and what its answer has to say, by the model as it is when its turn comes."""
        kind = rng.choice(("add", "add", "add", "move", "remove", "list", "sample", "seek", "get", "ping", "bad", "asset", "describe"))
        times = sorted(self.keys)
        if kind == "add":
            t = rng.randrange(40) / 4
            if t in self.keys:
                return "keyframe.add", {"time": t, "vertices": {"positions": lifted(t)}}, lambda m: m["error"]["code"] == -32002
            self.keys[t], self.next_key = (self.next_key, t * t), self.next_key + 1
            want, index = self.keys[t][0], sorted(self.keys).index(t)
            return ("keyframe.add", {"time": t, "vertices": {"positions": lifted(t * t)}},
                    lambda m: (m["result"]["keyframe"], m["result"]["index"], m["result"]["time"]) == (want, index, t))
        if kind == "move" and times:
            t, to = rng.choice(times), rng.randrange(40) / 4
            if to in self.keys and to != t:
                return "keyframe.move", {"keyframe": self.keys[t][0], "time": to}, lambda m: m["error"]["code"] == -32002
            self.keys[to] = key = self.keys.pop(t)
            return "keyframe.move", {"keyframe": key[0], "time": to}, lambda m: "result" in m
        if kind == "remove" and times:
            key = self.keys.pop(rng.choice(times))
            return "keyframe.remove", {"keyframe": key[0]}, lambda m: "result" in m
        if kind == "sample" and times:
            t = rng.choice(times)
            height = self.keys[t][1]
            return "vertices.sample", {"time": t}, lambda m: m["result"]["positions"] == lifted(height)
        if kind == "seek":
            return "playback.seek", {"time": 0}, lambda m: m["result"]["players"][0]["duration"] == (times[-1] if times else 0)
        if kind == "get":
            return "playback.get", {}, lambda m: m["result"]["players"][0]["duration"] == (times[-1] if times else 0)
        if kind == "describe":
            return "scene.describe", {}, lambda m: m["result"]["actors"][0]["clips"][0]["keyframes"] == len(times)
        if kind == "ping":
            return "server.ping", {}, lambda m: "time_us" in m["result"]
        if kind == "bad":
            return "keyframe.add", {"tiem": 1}, lambda m: m["error"]["code"] == -32602
        if kind == "asset":
            return "asset.list", {}, lambda m: m["result"] == {"assets": []}
        want = [(self.keys[t][0], t) for t in times]
        return "keyframe.list", {}, lambda m: [(k["keyframe"], k["time"]) for k in m["result"]["keyframes"]] == want

    def run_pipeline(self, client, count, rng):
        requests = {i: self.make(rng) for i in range(1, count + 1)}
        client.send_raw(b"".join(line(method, params, i) for i, (method, params, _) in requests.items()))
        answers = [client.read() for _ in range(count)]
        self.assertEqual(sorted(m["id"] for m in answers), list(requests), "each request is answered once")
        pings = {i for i, (method, _, _) in requests.items() if method == "server.ping"}
        order = [m["id"] for m in answers if m["id"] not in pings]
        self.assertEqual(order, sorted(order), "only pings may overtake")
        for place, message in enumerate(answers):
            method, params, good = requests[message["id"]]
            if message["id"] in pings:
                self.assertLessEqual(sum(m["id"] < message["id"] for m in answers[place:]), count)
            try:
                self.assertTrue(good(message))
            except (AssertionError, KeyError):
                self.fail(f"seed {self.seed}: {method} {params} was answered {message}; the model has {self.keys}")

    def test_random_pipelines_agree_with_a_model(self):
        rng = random.Random(self.seed)
        for count in (1, 2, 40, 400):
            self.run_pipeline(self.c, count, rng)
        self.run_pipeline(self.server.line(), 300, rng)

    def test_edits_never_change_places(self):
        """An edit that takes long, behind one that is refused at once and a query, and before a quick one."""
        mesh = harness.grid(40)
        self.c.call("actor.add", actor="grid", mesh=mesh)
        vertices = {"positions": mesh["positions"]}
        self.c.call("keyframe.add", actor="grid", time=0, vertices=vertices)
        for i in range(1, 301):
            self.c.send("keyframe.add", actor="grid", time=0, capture=True)  # the time is taken
            self.c.send("asset.list")
            slow = self.c.send("keyframe.add", actor="grid", time=i, vertices=vertices)
            quick = self.c.send("camera.set", fov_y=1)
            self.assertLess(self.c.answer(slow)["revision"], self.c.answer(quick)["revision"])

    def test_a_pipeline_longer_than_what_waits_at_once(self):
        count = 5000
        received = []
        data = b"".join(line("scene.list" if i % 7 else "vertices.sample", id=i) for i in range(count))
        sent = 0
        deadline = time.monotonic() + PATIENCE_S
        while sent < len(data) and time.monotonic() < deadline:  # reads while it writes: neither side may stick
            self.c.sock.setblocking(False)  # reading waits
            try:
                sent += self.c.sock.send(data[sent:sent + 65536])
            except BlockingIOError:
                received.append(self.c.read())
        received += [self.c.read() for _ in range(count - len(received))]
        self.assertEqual([m["id"] for m in received], list(range(count)))

    def test_a_ping_never_waits_behind_heavy_requests(self):
        mesh = harness.grid(100)
        self.c.call("actor.add", actor="grid", mesh=mesh)
        for _ in range(10):
            self.c.send("vertices.sample", actor="grid", indices=True)
            ping = self.c.send("server.ping")
            self.assertIn("time_us", self.c.answer(ping))
        self.c.settle()

    def test_two_connections_are_independent(self):
        other = self.server.line()
        held = b'{"jsonrpc":"2.0","id":1,"method":"ser'
        self.c.send_raw(held)
        other.call("scene.describe")
        self.c.send_raw(b'ver.ping"}\n')
        self.assertEqual(self.c.read()["id"], 1)


class Greetings(harness.TestCase):
    def test_hello(self):
        hello = self.c.call("server.hello", client="test")
        self.assertEqual((hello["server"], hello["protocol"], hello["role"]), ("tweend", 1, "admin"))
        self.assertRegex(hello["version"], r"^\d+\.\d+\.\d+")
        self.assertIsInstance(hello["capabilities"], list)
        self.c.call("server.hello", token="anything")

    def test_the_clock_is_steady_and_in_microseconds(self):
        asked = []  # (our clock before, the server's reading, our clock after)
        while len(asked) < 2 or asked[-1][2] - asked[0][0] < 0.05:
            before = time.monotonic()
            asked.append((before, self.c.call("server.ping")["time_us"], time.monotonic()))
        readings = [reading for _, reading, _ in asked]
        self.assertEqual(readings, sorted(readings))
        passed_s = (readings[-1] - readings[0]) / 1e6
        self.assertGreaterEqual(passed_s, asked[-1][0] - asked[0][2] - 1e-3)
        self.assertLessEqual(passed_s, asked[-1][2] - asked[0][0] + 1e-3)
        self.assertTrue(all(isinstance(r, int) for r in readings))

    def test_stats_are_numbers_named_as_metrics(self):
        stats = self.c.call("server.stats")
        self.assertGreaterEqual(stats["tweend_requests_total"], 1)
        for name, value in stats.items():
            self.assertRegex(name, r'^tweend_[a-z_]+({.*})?$')
            self.assertIsInstance(value, (int, float))

    def test_the_document_of_the_methods(self):
        document = self.c.call("rpc.discover")
        self.assertRegex(document["openrpc"], r"^1\.")
        methods = {m["name"]: m for m in document["methods"]}
        for name in ("server.ping", "rpc.discover", "scene.describe", "actor.add", "keyframe.add", "clip.create", "edit.apply",
                     "playback.play", "camera.set", "vertices.sample", "stream.open", "events.subscribe"):
            self.assertIn(name, methods)
        for method in methods.values():
            self.assertIn(method["x-role"], ("view", "control", "admin"))
            self.assertTrue(method["summary"])
            for parameter in method["params"]:
                self.assertIn("schema", parameter)
            self.assertIn("schema", method["result"])


if __name__ == "__main__":
    harness.main()
