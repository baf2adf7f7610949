"""HTTP (section 7), and who may ask (section 8)."""
import json
import random
import re
import socket

import harness
from client import Closed, WebSocketClient, check_message, request_json

PING = request_json("server.ping", id=1)


class Pages(harness.TestCase):
    def test_health_and_readiness(self):
        for path in ("/", "/healthz", "/readyz", "/healthz?x=1"):
            status, headers, body = self.server.http("GET", path)
            self.assertEqual(status, 200, path)
            self.assertTrue(body)
            self.assertIn("content-type", headers)

    def test_the_page_brings_its_policy_and_is_sent_once(self):
        status, headers, body = self.server.http("GET", "/")
        self.assertEqual((status, headers["content-type"]), (200, "text/html; charset=utf-8"))
        self.assertTrue(headers["content-security-policy"].startswith("default-src 'none'; script-src 'self'"))
        self.assertEqual((headers["cache-control"], headers["x-content-type-options"]), ("no-cache", "nosniff"))
        c = self.server.http_client()
        for _ in range(2):  # the connection lives on
            status, again, rest = c.ask("GET", "/index.html", headers={"If-None-Match": headers["etag"]})
            self.assertEqual((status, rest, again["etag"]), (304, b"", headers["etag"]))
        status, headers, script = c.ask("GET", "/controls/transport.js?x=1")
        self.assertEqual((status, headers["content-type"]), (200, "text/javascript; charset=utf-8"))
        for path in ("/controls", "/controls/../index.html", "/CMakeLists.txt", "/package.json", "/%69ndex.html"):
            self.assertEqual(c.ask("GET", path)[0], 404, path)
        self.assertEqual(c.ask("POST", "/main.js")[0], 405)

    def test_metrics_are_prometheus_text(self):
        self.add_moving()
        status, headers, body = self.server.http("GET", "/metrics")
        self.assertEqual(status, 200)
        self.assertTrue(headers["content-type"].startswith("text/plain"))
        self.assertTrue(body.endswith(b"\n"))
        described, values = {}, {}
        for text in body.decode().splitlines():
            if text.startswith("# "):
                _, what, name, rest = text.split(" ", 3)
                self.assertIn(what, ("HELP", "TYPE"))
                described.setdefault(name, {})[what] = rest
                self.assertNotIn(name, values, "a metric is described before its value")
            else:
                name, value = text.rsplit(" ", 1)
                values[name] = float(value)
        for name in values:
            self.assertRegex(name, r'^tweend_[a-z_]+({([a-z]+="[^"]*",?)+})?$')
            family = re.sub(r"{.*", "", name)
            kind = "counter" if family.endswith("_total") else "gauge"
            if family not in described:
                family, kind = re.sub("_(bucket|sum|count)$", "", family), "histogram"
            self.assertEqual(described[family]["TYPE"], kind)
        self.assertEqual((values["tweend_scenes"], values["tweend_actors"]), (1, 1))
        self.assertEqual(values["tweend_edits_total"], 4)
        self.assertEqual(set(self.c.call("server.stats")), set(values))

    def test_the_document_of_the_methods_is_that_of_rpc_discover(self):
        status, headers, body = self.server.http("GET", "/openrpc.json")
        self.assertEqual((status, headers["content-type"]), (200, "application/json"))
        self.assertEqual(json.loads(body), self.c.call("rpc.discover"))

    def test_head_answers_as_get_without_a_body(self):
        for path in ("/", "/healthz", "/readyz", "/openrpc.json"):
            c = self.server.http_client()
            status, headers, _ = c.ask("HEAD", path)
            self.assertEqual(c.ask("GET", path)[:2], (status, headers))  # on one connection: no body came between

    def test_wrong_methods_and_paths(self):
        c = self.server.http_client()
        for method, path, status in (("POST", "/healthz", 405), ("DELETE", "/readyz", 405), ("PUT", "/", 405), ("GET", "/rpc", 405),
                                     ("PUT", "/rpc", 405), ("DELETE", "/rpc", 405), ("HEAD", "/rpc", 405), ("GET", "/nope", 404),
                                     ("GET", "/healthz/", 404), ("HEAD", "/nope", 404), ("GET", "/../etc/passwd", 404),
                                     ("GET", "/scenes/none/frame.png", 404)):
            got, headers, _ = c.ask(method, path)
            self.assertEqual(got, status, (method, path))
            if status == 405:
                self.assertIn("POST" if path == "/rpc" else "GET", headers["allow"])
        self.assertIn(c.ask("GET", "/ws")[0], range(400, 500))
        self.assertEqual(c.ask("GET", "/healthz")[0], 200)


class Connections(harness.TestCase):
    def test_many_requests_on_one_connection(self):
        c = self.server.http_client()
        for i in range(20):
            self.assertEqual(c.rpc({"jsonrpc": "2.0", "id": i, "method": "scene.list"})["id"], i)
            self.assertEqual(c.ask("GET", "/healthz")[0], 200)

    def test_connection_close_and_http_1_0(self):
        c = self.server.http_client()
        status, headers, _ = c.ask("GET", "/healthz", headers={"Connection": "close"})
        self.assertEqual((status, headers["connection"].lower()), (200, "close"))
        self.assertEqual(c.read_to_end(), [])
        with socket.create_connection(("127.0.0.1", self.server.port), timeout=30) as s:
            s.sendall(b"GET /healthz HTTP/1.0\r\nHost: 127.0.0.1\r\n\r\n")
            data = b""
            while more := s.recv(4096):
                data += more
        self.assertRegex(data, rb"^HTTP/1\.[01] 200 ")

    def test_pipelined_requests_are_answered_in_order(self):
        c = self.server.http_client()
        count = 30
        data = b""
        for i in range(count):
            data += c.request_bytes("POST", "/rpc", request_json("asset.list" if i % 3 else "scene.list", id=i))
            data += c.request_bytes("GET", "/healthz" if i % 2 else "/nope")
        rng = random.Random(1)
        while data:  # in pieces of any size
            piece = rng.randrange(1, 900)
            c.send_raw(data[:piece])
            data = data[piece:]
        for i in range(count):
            self.assertEqual(json.loads(c.read_answer()[2])["id"], i)
            self.assertEqual(c.read_answer()[0], 200 if i % 2 else 404)

    def test_what_is_no_http_is_answered_400_or_closed(self):
        for data in (b"GET /healthz\r\n\r\n", b"GET /healthz HTTP/9.9\r\n\r\n", b"GET  HTTP/1.1\r\n\r\n", b"GET / HTTP/1.1\r\nno colon\r\n\r\n",
                     b"GET / HTTP/1.1\r\nX: " + b"x" * 200_000 + b"\r\n\r\n",
                     b"POST /rpc HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: x\r\n\r\n",
                     b"POST /rpc HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: -1\r\n\r\n",
                     b"POST /rpc HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 99999999999999999999999\r\n\r\n"):
            c = self.server.http_client()
            try:
                c.send_raw(data)
                self.assertIn(c.read_answer()[0], (400, 413, 431, 505), data[:60])
                self.assertEqual(c.read_to_end(), [])
            except (Closed, ConnectionError):
                pass
        self.c.call("server.ping")


class Rpc(harness.TestCase):
    def test_one_request(self):
        c = self.server.http_client()
        self.assertIn("time_us", c.rpc(json.loads(PING))["result"])
        for content_type in ("application/json; charset=utf-8", "Application/JSON", "application/json ;x=y"):
            self.assertEqual(c.ask("POST", "/rpc", PING, {"Content-Type": content_type})[0], 200, content_type)
        self.assertEqual(c.ask("POST", "/rpc?x=y", PING)[0], 200)

    def test_errors_come_with_status_200(self):
        c = self.server.http_client()
        for body, code in ((b"{oops", -32700), (b"", -32700), (b"\xff", -32700), (b"1", -32600), (b"[]", -32600), (b"{}", -32600),
                           (request_json("no.such", id=1), -32601), (request_json("playback.seek", {}, 1), -32602),
                           (request_json("playback.get", {"scene": "none"}, 1), -32001)):
            status, headers, answer = c.ask("POST", "/rpc", body)
            self.assertEqual((status, headers["content-type"]), (200, "application/json"), body)
            self.assertEqual(check_message(json.loads(answer))["error"]["code"], code, body)

    def test_batches(self):
        answer = self.server.http_client().rpc([json.loads(request_json(m, id=i)) for i, m in enumerate(
            ("scene.list", "asset.list", "no.such", "scene.describe", "server.ping"))])
        self.assertEqual([m["id"] for m in answer], list(range(5)))

    def test_notifications_are_answered_204(self):
        c = self.server.http_client()
        create = json.loads(request_json("scene.create", {"scene": "a"}))
        for message in (create, [create | {"params": {"scene": "b"}}, create | {"params": {"scene": "c"}}], create):
            status, headers, body = c.ask("POST", "/rpc", json.dumps(message).encode())
            self.assertEqual((status, body, headers.get("content-length", "0")), (204, b"", "0"))
        self.assertEqual([s["scene"] for s in self.c.call("scene.list")["scenes"]], ["a", "b", "c", "main"])
        self.assertEqual(c.ask("GET", "/healthz")[0], 200)

    def test_other_content_types_are_refused(self):
        c = self.server.http_client()
        create = request_json("scene.create", {"scene": "a"}, 1)
        for content_type in ("text/plain", "application/x-www-form-urlencoded", "application/jsonx", "", None):
            self.assertEqual(c.ask("POST", "/rpc", create, {"Content-Type": content_type})[0], 415, content_type)
        self.assertEqual(len(self.c.call("scene.list")["scenes"]), 1)

    def test_a_chunked_body(self):
        c = self.server.http_client()
        c.send_raw(c.request_bytes("POST", "/rpc", headers={"Content-Type": "application/json", "Transfer-Encoding": "chunked"}))
        for part in (PING[:5], PING[5:], b""):
            c.send_raw(f"{len(part):x}\r\n".encode() + part + b"\r\n")
        self.assertEqual(json.loads(c.read_answer()[2])["id"], 1)
        self.assertEqual(c.ask("GET", "/healthz")[0], 200)

    def test_a_client_that_waits_to_be_told_to_continue(self):
        """RFC 9110, 10.1.1: an immediate 100, or an immediate final answer. curl sends this before large bodies."""
        c = self.server.http_client()
        for size in (1100, 1 << 20):
            body = PING[:-1] + b" " * (size - len(PING)) + b"}"
            request = c.request_bytes("POST", "/rpc", body, {"Expect": "100-continue"})
            c.send_raw(request[:-size])
            self.assertEqual(c.read_answer()[0], 100)
            c.send_raw(body)
            self.assertEqual(json.loads(c.read_answer()[2])["id"], 1)

    def test_a_client_that_does_not_wait_although_it_said_so(self):
        c = self.server.http_client()
        c.send_raw(c.request_bytes("POST", "/rpc", PING, {"Expect": "100-continue"}))
        status, _, body = c.read_answer()
        if status == 100:
            status, _, body = c.read_answer()
        self.assertEqual((status, json.loads(body)["id"]), (200, 1))

    def test_a_body_over_the_limit(self):
        too_long = (16 << 20) + 1
        c = self.server.http_client()
        c.send_raw(c.request_bytes("POST", "/rpc", headers={"Content-Type": "application/json", "Content-Length": str(too_long)}))
        self.assertEqual(c.read_answer()[0], 413)  # at once: the body is not waited for
        c = self.server.http_client()
        c.send_raw(c.request_bytes("POST", "/rpc", headers={"Content-Type": "application/json", "Content-Length": str(too_long),
                                                            "Expect": "100-continue"}))
        self.assertEqual(c.read_answer()[0], 413)
        self.c.call("server.ping")

    def test_a_client_that_sends_a_body_over_the_limit_gets_to_see_why(self):
        """Plain clients send all of the body before they read."""
        body = b" " * ((16 << 20) + (1 << 20))
        seen = 0
        for _ in range(5):
            c = self.server.http_client()
            try:
                c.send_raw(c.request_bytes("POST", "/rpc", body))
            except ConnectionError:
                pass
            try:
                seen += c.read_answer()[0] == 413
            except (Closed, ConnectionError):
                pass
        self.assertGreater(seen, 0)
        self.c.call("server.ping")

    def test_a_chunked_body_over_the_limit(self):
        server = self.serve("--max-message-bytes", 1000)
        c = server.http_client()
        c.send_raw(c.request_bytes("POST", "/rpc", headers={"Content-Type": "application/json", "Transfer-Encoding": "chunked"}))
        c.send_raw(b"7d0\r\n" + b" " * 2000 + b"\r\n0\r\n\r\n")
        self.assertEqual(c.read_answer()[0], 413)
        server.line().call("server.ping")

    def test_what_needs_a_connection_is_refused(self):
        self.add_moving()
        c = self.server.http_client()
        for method, params in (("stream.open", {"kind": "vertices"}), ("stream.close", {"stream": 1}), ("events.subscribe", {}),
                               ("stream.update", {"stream": 1}), ("events.unsubscribe", {})):
            self.assertIn("error", c.rpc(json.loads(request_json(method, params, 1))), method)
        stats = self.c.call("server.stats")
        self.assertEqual((stats["tweend_streams"], stats["tweend_producers"]), (0, 0))

    def test_edits_and_samples_as_over_line_json(self):
        c = self.server.http_client()
        self.add_moving()
        sample = json.loads(request_json("vertices.sample", {"time": 1.5}, 1))
        self.assertEqual(c.rpc(sample)["result"], self.c.call("vertices.sample", time=1.5))
        c.rpc(json.loads(request_json("keyframe.remove", {"keyframe": 1}, 1)))
        self.assertEqual(len(self.c.call("keyframe.list")["keyframes"]), 2)


class Access(harness.TestCase):
    options = ("--allow-origin", "https://studio.example", "--allow-origin", "http://other.example:8080")

    def test_hosts(self):
        port = self.server.port
        for host, status in ((f"127.0.0.1:{port}", 200), ("127.0.0.1", 200), (f"localhost:{port}", 200), ("LOCALHOST", 200),
                             (f"[::1]:{port}", 200), ("192.0.2.7:80", 200), ("studio.example", 200), ("other.example:8080", 200),
                             ("evil.example", 403), (f"evil.example:{port}", 403), ("localhost.evil.example", 403),
                             ("127.0.0.1.evil.example", 403), ("studio.example.evil.example", 403)):
            for path in ("/healthz", "/metrics", "/openrpc.json"):
                self.assertEqual(self.server.http("GET", path, headers={"Host": host})[0], status, (host, path))
            self.assertEqual(self.server.http("POST", "/rpc", PING, {"Host": host})[0], status, host)
        for host in (None, ""):
            self.assertIn(self.server.http("GET", "/metrics", headers={"Host": host})[0], (400, 403))

    def test_origins(self):
        port = self.server.port
        create = request_json("scene.create", {"scene": "a"}, 1)
        for origin, good in ((f"http://127.0.0.1:{port}", True), ("https://studio.example", True), ("http://other.example:8080", True),
                             ("http://evil.example", False), ("null", False), ("http://studio.example", False),
                             ("https://studio.example:444", False), ("http://127.0.0.1:1", False), (f"http://localhost:{port}", False),
                             ("https://studio.example.evil.example", False), ("", False)):
            self.assertEqual(self.server.http("POST", "/rpc", PING, {"Origin": origin})[0], 200 if good else 403, origin)
            if not good:
                self.assertEqual(self.server.http("POST", "/rpc", create, {"Origin": origin})[0], 403)
            ws = WebSocketClient(port, handshake=False)
            self.assertEqual(ws.shake_hands(Origin=origin)[0], 101 if good else 403, origin)
            ws.close()
        self.assertEqual(len(self.c.call("scene.list")["scenes"]), 1)
        ws = WebSocketClient(port, handshake=False)
        self.assertEqual(ws.shake_hands(Host="evil.example")[0], 403)
        ws.close()
        ws = WebSocketClient(port, handshake=False)
        self.assertEqual(ws.shake_hands(Host=f"localhost:{port}", Origin=f"http://localhost:{port}")[0], 101)
        ws.close()

    def test_a_refused_request_does_not_end_the_connection_in_disorder(self):
        c = self.server.http_client()
        self.assertEqual(c.ask("POST", "/rpc", PING, {"Origin": "http://evil.example"})[0], 403)
        self.assertEqual(c.ask("POST", "/rpc", PING)[0], 200)


if __name__ == "__main__":
    harness.main()
