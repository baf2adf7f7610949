"""GET /scenes/{scene}/clip.mp4 (section 7): a clip as a film."""
import os
import select
import signal
import socket
import struct
from fractions import Fraction
from random import Random

import harness
import pictures
from films import Film, distance
from pictures import QUAD, Picture

SMALL = "width=96&height=64"
LONG = "width=1920&height=1080&to=75&fps=240"  # more than anybody waits for


class Clip(pictures.PictureCase):
    needs_h264 = True

    def setUp(self):
        super().setUp()
        self.root = self.folder()
        self.c.call("actor.add", actor="quad", mesh=QUAD)
        for t in range(3):
            moved = [c + (3 * t - 3 if i % 3 == 0 else 0) for i, c in enumerate(QUAD["positions"])]
            self.c.call("keyframe.add", time=t, vertices={"positions": moved})
        self.c.call("camera.set", eye=[0, 0, 12], target=[0, 0, 0])

    def film(self, query=SMALL, scene="main"):
        status, headers, body = self.server.http("GET", f"/scenes/{scene}/clip.mp4?{query}")
        self.assertEqual((status, headers["content-type"], int(headers["content-length"])), (200, "video/mp4", len(body)), body[:200])
        path = os.path.join(self.root, "film.mp4")
        with open(path, "wb") as f:
            f.write(body)
        return Film(path)

    def refuses(self, status, query, *says, scene="main", server=None):
        got, _, body = (server or self.server).http("GET", f"/scenes/{scene}/clip.mp4?{query}")
        self.assertEqual(got, status, body[:200])
        for word in says:
            self.assertIn(word, body.decode())

    def test_the_whole_clip_by_default(self):
        film = self.film()
        self.assertEqual(film.times, [Fraction(k, 30) for k in range(60)])
        self.assertEqual(film.duration, 2)
        decoded = film.pictures()
        for k in (0, 17, 40, 59):
            shown = Picture.of_png(self.file(time=k / 30, width=96, height=64))
            self.assertLess(distance(decoded[k], shown), 3, k)
        self.assertGreater(distance(decoded[0], decoded[59]), 4)

    def test_as_many_pictures_as_the_server_allows(self):
        few = self.serve("--max-film-pictures", 10, render=True)
        few.line().call("actor.add", actor="quad", mesh=QUAD)
        self.refuses(400, SMALL + "&to=2&fps=5.5", "10", "11", server=few)
        self.assertEqual(few.http("GET", f"/scenes/main/clip.mp4?{SMALL}&to=2&fps=5")[0], 200)

    def test_a_stretch_at_another_rate(self):
        film = self.film(SMALL + "&from=0.5&to=1.5&fps=12.5")
        self.assertEqual(film.times, [k / Fraction("12.5") for k in range(13)])  # 12.5, rounded
        shown = Picture.of_png(self.file(time=0.5 + 4 / 12.5, width=96, height=64))
        self.assertLess(distance(film.pictures()[4], shown), 3)

    def test_it_does_not_matter_what_is_played(self):
        before = self.film(SMALL + "&to=0.5").pictures()
        self.c.call("playback.play", speed=3)
        self.assertEqual(self.film(SMALL + "&to=0.5").pictures(), before)

    def test_it_plays_while_it_loads(self):
        _, _, body = self.server.http("GET", f"/scenes/main/clip.mp4?{SMALL}")
        self.assertLess(body.index(b"moov"), body.index(b"mdat"))

    def test_an_actor_says_how_long_it_is(self):
        self.c.call("actor.add", actor="brief", mesh=QUAD)
        for t in (0, 0.2):
            self.c.call("keyframe.add", actor="brief", time=t, vertices={"positions": QUAD["positions"]})
        self.assertEqual(len(self.film(SMALL + "&actor=brief").times), 6)
        self.assertEqual(len(self.film(SMALL).times), 60)

    def test_nothing_that_moves_is_one_picture(self):
        self.c.call("scene.create", scene="two")
        self.c.call("actor.add", scene="two", actor="still", mesh=QUAD)
        self.assertEqual(len(self.film(scene="two").times), 1)

    def test_head_tells_the_length(self):
        http = self.server.http_client()
        _, headers, body = http.ask("GET", f"/scenes/main/clip.mp4?{SMALL}&to=0.1")
        http.send_raw(http.request_bytes("HEAD", f"/scenes/main/clip.mp4?{SMALL}&to=0.1"))
        status, told, nothing = http.read_answer(head_only=True)
        self.assertEqual((status, told["content-length"], nothing), (200, headers["content-length"], b""))
        self.assertEqual(len(body), int(told["content-length"]))

    def test_refusals(self):
        self.refuses(404, SMALL, "none", scene="none")
        self.refuses(404, SMALL + "&actor=none", "params.actor")
        self.c.call("scene.create", scene="empty")
        self.refuses(404, SMALL, "actor", scene="empty")
        self.refuses(400, "width=33&height=20", "params.width", "even")
        self.refuses(400, "width=32&height=21", "params.height", "even")
        self.refuses(400, "width=100000", "params.width")
        for query in ("from=-1", "to=-1", "fps=0", "fps=1e-13", "fps=1000", "from=x", "nope=1", "from=1&from=2", "scene=main"):
            self.refuses(400, query, "params." + query.split("=")[0])
        self.refuses(400, "from=1.5&to=1", "params.to")
        self.refuses(400, "from=3", "params.from: expected a time up to 2", "found 3")
        self.refuses(400, SMALL + "&to=1000&fps=240", "18000", "240000")
        self.refuses(400, SMALL + "&to=1e300", "18000")
        self.refuses(503, SMALL, server=self.undrawing())

    def undrawing(self):
        server = self.serve()
        server.line().call("actor.add", actor="quad", mesh=QUAD)
        return server

    def test_a_server_that_stops_does_not_wait_for_a_film(self):
        clients = [self.waiting(), self.waiting()]  # for the one under way, and the one after
        self.c.call("frame.render", width=8, height=8)  # meanwhile others are served
        self.server.process.send_signal(signal.SIGTERM)
        for client in clients:
            status, _, body = client.read_answer()
            self.assertEqual((status, body), (503, b"the server stops\n"))
        self.assertEqual(self.server.stop(), 0)

    def waiting(self, query=LONG):
        """A client that has asked for a film."""
        client = self.server.http_client()
        film = client.request_bytes("GET", f"/scenes/main/clip.mp4?{query}")
        client.send_raw(client.request_bytes("GET", "/healthz") + film)
        self.assertEqual(client.read_answer()[0], 200)
        self.c.call("server.ping")  # behind it the film has been asked for, too
        return client

    def test_a_client_that_closes_its_side_holds_up_nobody(self):
        clients = [self.waiting(), self.waiting()]
        for client in clients:
            client.sock.shutdown(socket.SHUT_WR)
        for client in clients:
            status, headers, body = client.read_answer()
            self.assertEqual((status, headers["connection"]), (503, "close"))
            self.assertIn(b"closed its side", body)
        self.assertEqual(len(self.film(SMALL + "&to=0.1").times), 3)

    def test_a_client_that_is_gone_holds_up_nobody(self):
        for linger in (0, None):  # a reset, and a close
            clients = [self.waiting(), self.waiting()]
            for client in clients:
                if linger is not None:
                    client.sock.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, linger))
                client.close()
            self.assertEqual(len(self.film(SMALL + "&to=0.1").times), 3)

    def test_a_crowd_is_told_to_come_back(self):
        clients = [self.waiting() for _ in range(65)]  # one under way, 64 behind it
        status, headers, body = self.server.http("GET", f"/scenes/main/clip.mp4?{SMALL}")
        self.assertEqual((status, headers["retry-after"]), (503, "10"))
        self.assertIn(b"at most 64 films", body)
        for client in clients:
            client.sock.shutdown(socket.SHUT_WR)
        for client in clients:
            self.assertEqual(client.read_answer()[0], 503)
        self.assertEqual(len(self.film(SMALL + "&to=0.1").times), 3)

    def reads_nothing(self, query):
        """A client that has begun to be sent a film, and reads no more than that."""
        sock = socket.socket()
        self.addCleanup(sock.close)
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)  # before it connects: little leaves the server
        sock.settimeout(30)
        sock.connect(("127.0.0.1", self.server.port))
        sock.sendall(f"GET /scenes/main/clip.mp4?{query} HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n".encode())
        self.assertEqual(sock.recv(12), b"HTTP/1.1 200")
        return sock

    def test_slow_readers_keep_few_films_in_memory(self):
        side, random = 40, Random(1)
        indices = [v for y in range(side - 1) for x in range(side - 1) for a in (y * side + x,)
                   for v in (a, a + 1, a + side, a + 1, a + side + 1, a + side)]
        grids = [[v for y in range(side) for x in range(side) for v in (x / 4 - 5, y / 7 - 3, random.uniform(-1, 1))] for _ in "ab"]
        self.c.call("actor.add", actor="noise", mesh={"positions": grids[0], "indices": indices})
        for t, positions in enumerate(grids):
            self.c.call("keyframe.add", actor="noise", time=t, vertices={"positions": positions})
        held = [self.reads_nothing("width=640&height=360&fps=20&to=1&from=0") for _ in range(4)]
        fifth = self.waiting(SMALL + "&to=0")
        behind = self.waiting()  # once it has been found to be gone, a film would have been made
        behind.sock.shutdown(socket.SHUT_WR)
        self.assertEqual(behind.read_answer()[0], 503)
        self.assertEqual(select.select([fifth.sock], [], [], 0)[0], [])
        held[2].close()
        self.assertEqual(fifth.read_answer()[0], 200)

    def test_a_client_that_asks_for_more_meanwhile_is_still_there(self):
        first, client = self.waiting(), self.waiting(SMALL)
        client.send_raw(client.request_bytes("GET", "/healthz"))
        for other in (self.waiting(), first):  # once they have been found to be gone, it has been looked at, too
            other.sock.shutdown(socket.SHUT_WR)
            self.assertEqual(other.read_answer()[0], 503)
        status, headers, _ = client.read_answer()
        self.assertEqual((status, headers["content-type"]), (200, "video/mp4"))
        status, _, body = client.read_answer()
        self.assertEqual((status, body), (200, b"ok\n"))

    def test_the_bytes_it_may_take(self):
        server = self.serve("--max-film-bytes", 20_000, render=True)
        server.line().call("actor.add", actor="quad", mesh=QUAD)
        self.refuses(400, SMALL + "&to=60", "20000 bytes", "ask for part of it", server=server)
        self.assertEqual(server.http("GET", f"/scenes/main/clip.mp4?{SMALL}&to=0.1")[0], 200)


if __name__ == "__main__":
    harness.main()
