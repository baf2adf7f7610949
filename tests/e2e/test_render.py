"""`tweend render` and `tweend doctor`, the programs without a port; and a server on a machine where nothing draws."""
import contextlib
import json
import os
import re
import resource
import stat
import struct
import subprocess
import unittest
import zlib
from fractions import Fraction

import harness
from client import HttpClient, LineClient
from films import Film, distance
from harness import TWEEND, lifted, wait_until
from pictures import Picture

NO_DEVICE = {"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent"}
SMALL = ("--size", "64x48")


def run_program(*arguments, cwd=None, environment=None):
    return subprocess.run([TWEEND, *map(str, arguments)], capture_output=True, text=True, timeout=60, cwd=cwd,
                          env={**os.environ, **(environment or {})}, preexec_fn=harness.die_with_parent)


def draws():
    return run_program("doctor").returncode == 0


def read_png(path):
    """(width, height, rows without their filters' bytes) of a PNG: enough to tell pictures apart."""
    with open(path, "rb") as f:
        data = f.read()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", data[:8]
    width, height, depth, color = struct.unpack_from(">IIBB", data, 16)
    assert (depth, color) == (8, 2)
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + size]
        at += 12 + size
    return width, height, unfiltered(zlib.decompress(packed), 3 * width)


def unfiltered(data, row_bytes):
    rows, before = [], bytearray(row_bytes)
    for at in range(0, len(data), row_bytes + 1):
        kind, line = data[at], bytearray(data[at + 1:at + 1 + row_bytes])
        for i in range(row_bytes):
            left, corner, up = (line[i - 3], before[i - 3], before[i]) if i >= 3 else (0, 0, before[i])
            guess = left + up - corner
            paeth = min((left, up, corner), key=lambda v: abs(guess - v))
            line[i] = (line[i] + (0, left, up, (left + up) // 2, paeth)[kind]) & 255
        rows.append(bytes(line))
        before = line
    return rows


class Rendering(harness.TestCase):
    starts_server = False

    def setUp(self):
        self.root = self.folder()
        self.out = os.path.join(self.root, "out")
        os.mkdir(self.out)
        flat = [0, 0, 0, 1, 0, 0, 0, 1, 0]
        grown = [0, 0, 0, 2, 0, 0, 0, 2, 0]
        harness.write_sequence(self.root, "wave", {0: flat, 24: grown, 48: flat})
        harness.write_obj(f"{self.root}/cup.obj", lifted(1))

    def render(self, *arguments):
        """Draws; what the program printed."""
        done = run_program("render", *arguments, cwd=self.out)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr, "")
        return done.stdout

    def refuses(self, *arguments, code=1, says=()):
        done = run_program("render", *arguments, cwd=self.out)
        self.assertEqual(done.returncode, code, done)
        self.assertEqual(done.stdout, "")
        for word in says:
            self.assertIn(word, done.stderr)
        self.assertEqual(os.listdir(self.out), [])
        return done.stderr

    def read(self, name):
        return read_png(os.path.join(self.out, name))


class Films(Rendering):
    def film(self, *arguments):
        self.render(*arguments, "--mp4", "a.mp4")
        self.assertEqual(os.listdir(self.out), ["a.mp4"])
        return Film(f"{self.out}/a.mp4")

    def test_a_film_has_exactly_the_pictures_of_its_clip(self):
        film = self.film(f"{self.root}/wave", *SMALL, "--fps", 25)  # 48 frames at 24 a second
        self.assertEqual(film.times, [Fraction(k, 25) for k in range(50)])
        self.assertEqual((film.duration, film.size), (2, (64, 48)))
        self.assertEqual(len(self.film(f"{self.root}/wave", *SMALL, "--closed", "--duration", 2.5).times), 75)
        self.assertEqual(len(self.film(f"{self.root}/wave", *SMALL, "--sequence-fps", 48, "--fps", 10).times), 10)
        self.assertEqual(len(self.film(f"{self.root}/cup.obj", *SMALL).times), 1)
        self.assertIn(" 1 picture at 30 ", self.render(f"{self.root}/cup.obj", *SMALL, "--mp4", "a.mp4"))

    def test_it_shows_what_pictures_of_its_times_show(self):
        film = self.film(f"{self.root}/wave", *SMALL, "--from", 0.5, "--to", 1.5, "--fps", 10)
        decoded = film.pictures()
        self.assertEqual(len(decoded), 10)
        for k in (0, 5, 9):
            self.render(f"{self.root}/wave", *SMALL, "--at", 0.5 + k / 10, "-o", "one.png")
            with open(f"{self.out}/one.png", "rb") as f:
                self.assertLess(distance(decoded[k], Picture.of_png(f.read())), 3, k)

    def test_a_file_of_edits_finds_its_assets_beside_it(self):
        edits = [{"method": "actor.add", "params": {"actor": "w", "asset": "wave", "fps": 24}},
                 {"method": "camera.set", "params": {"eye": [0.5, 0.5, 4], "target": [0.5, 0.5, 0]}}]
        for folder, more in ((self.root, ()), (self.folder(), ("--assets", self.root))):
            with open(f"{folder}/scene.json", "w") as f:
                json.dump(edits, f)
            film = self.film(f"{folder}/scene.json", *SMALL, "--fps", 12, *more)
            self.assertEqual(len(film.times), 24)
        os.remove(f"{self.out}/a.mp4")
        self.refuses(f"{self.folder()}/none.json", "--mp4", "a.mp4", says=("none.json",))
        self.refuses(f"{folder}/scene.json", "--mp4", "a.mp4", says=("scene.json: edits[0].params.asset: ", "wave"))
        self.refuses(f"{folder}/scene.json", f"{self.root}/wave", "--mp4", "a.mp4", says=("file of edits alone", "scene.json"))
        self.refuses(f"{folder}/scene.json", "--closed", says=("--closed",))

    def test_refusals(self):
        wave = f"{self.root}/wave"
        self.refuses(wave, "--mp4", "a.avi", says=(".mp4", "a.avi"))
        self.refuses(wave, "--mp4", "a.mp4", "--size", "63x48", says=("63x48", "even"))
        for fps in ("1e-13", "241", "1000000000"):
            self.refuses(wave, "--mp4", "a.mp4", "--fps", fps, says=("--fps", "0.001 to 240", fps))
        self.refuses(wave, "--mp4", "a.mp4", "--size", "16386x2", says=("16384", "16386x2"))
        self.assertLess(len(self.refuses(wave, "--mp4", "a.mp4", "--to", "1e300", says=("89478314", "ask for part"))), 200)
        self.refuses(wave, "--mp4", "a.mp4", "--from", 3, says=("--from", "2"))
        self.refuses(wave, "--mp4", "a.mp4", "--from", 1, "--to", 0.5, says=("--to",))
        self.refuses(wave, "--mp4", "none/a.mp4", says=("none/a.mp4", "No such file", "make the folder none"))
        for more in (("--at", 0), ("-o", "a.png"), ("--sheet",)):
            self.refuses(wave, "--mp4", "a.mp4", *more, code=2)
        self.refuses(wave, "--from", 1, code=2)

    def test_another_film_is_replaced_when_the_new_one_is_whole(self):
        with open(f"{self.out}/a.mp4", "w") as f:
            f.write("old")
        self.assertEqual(len(self.film(f"{self.root}/wave", *SMALL).times), 60)

    def test_a_link_stays_and_what_it_names_is_written(self):
        elsewhere = self.folder()
        for target in ("there.mp4", "new.mp4"):
            with open(f"{elsewhere}/there.mp4", "w") as f:
                f.write("old")
            os.symlink(f"{elsewhere}/{target}", f"{self.out}/a.mp4")
            self.assertEqual(len(self.film(f"{self.root}/cup.obj", *SMALL).times), 1)
            self.assertTrue(os.path.islink(f"{self.out}/a.mp4"))
            self.assertFalse(os.path.islink(f"{elsewhere}/{target}"))
            self.assertEqual(len(Film(f"{elsewhere}/{target}").times), 1)
            os.remove(f"{self.out}/a.mp4")
        self.assertEqual(sorted(os.listdir(elsewhere)), ["new.mp4", "there.mp4"])

    def test_places_where_no_film_can_be(self):
        elsewhere, cup = self.folder(), f"{self.root}/cup.obj"
        os.mkfifo(f"{elsewhere}/fifo.mp4")
        os.mkdir(f"{elsewhere}/folder.mp4")
        os.symlink("round.mp4", f"{elsewhere}/round.mp4")
        os.symlink("fifo.mp4", f"{elsewhere}/link.mp4")
        before = sorted(os.listdir(elsewhere))
        for name, reason in (("fifo", "no regular file"), ("link", "no regular file"), ("folder", "Is a directory"),
                             ("round", "symbolic links"), (300 * "a", "File name too long")):
            self.refuses(cup, "--mp4", f"{elsewhere}/{name}.mp4", says=(name, reason, "choose another"))
        self.assertEqual(sorted(os.listdir(elsewhere)), before)
        self.assertTrue(stat.S_ISFIFO(os.stat(f"{elsewhere}/fifo.mp4").st_mode))

    def test_a_file_that_may_not_get_so_long_is_an_error(self):
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
        done = subprocess.run([TWEEND, "render", f"{self.root}/cup.obj", *SMALL, "--mp4", "a.mp4"], capture_output=True,
                              text=True, timeout=60, cwd=self.out, preexec_fn=limit)
        self.assertEqual(done.returncode, 1, done)
        self.assertIn("File too large", done.stderr)
        self.assertEqual(os.listdir(self.out), [])

    def test_one_that_is_killed_leaves_nothing_under_the_name(self):
        program = subprocess.Popen([TWEEND, "render", f"{self.root}/wave", "--mp4", "a.mp4", "--to", "100000"], cwd=self.out,
                                   preexec_fn=harness.die_with_parent)
        descriptors = f"/proc/{program.pid}/fd"

        def is_here(fd):
            with contextlib.suppress(FileNotFoundError):  # closed just now
                return os.readlink(f"{descriptors}/{fd}").startswith(self.out)
            return False
        wait_until(lambda: any(map(is_here, os.listdir(descriptors))), "a file")
        program.kill()
        program.wait()
        self.assertEqual([n for n in os.listdir(self.out) if not n.startswith(".")], [])


class Refusals(Rendering):
    def test_what_is_not_there(self):
        self.refuses(f"{self.root}/none.obj", says=("expected a file or a folder", "none.obj", "No such file"))
        self.refuses("/", says=("root folder",))
        self.refuses(f"{self.root}/out", says=("out",))

    def test_a_corrupt_file_is_told_of_by_its_line(self):
        harness.write_obj(f"{self.root}/bad.obj", lifted(0), tail="v 1 two 3\n")
        self.refuses(f"{self.root}/bad.obj", says=("bad.obj:5",))
        harness.write_obj(f"{self.root}/beyond.obj", lifted(0), faces=((1, 2, 9),))
        self.refuses(f"{self.root}/beyond.obj", says=("beyond.obj:4",))
        harness.write_sequence(self.root, "uneven", {0: lifted(0), 10: lifted(0) + [1, 1, 1]})
        self.refuses(f"{self.root}/uneven", says=("uneven_000010.obj",))

    def test_names_that_can_not_be_numbered(self):
        for pattern in ("a.png", "%d%d.png", "a%x.png", "a%"):
            self.refuses(f"{self.root}/wave", "--at", "0,1", "-o", pattern, says=("%04d", pattern))

    def test_names_of_what_is_no_picture(self):
        for name in ("a.gif", "a", "png", "a.png.txt"):
            self.refuses(f"{self.root}/wave", "-o", name, says=(".png", name))

    def test_two_assets_of_one_name(self):
        harness.write_obj(f"{self.root}/other/cup.obj", lifted(1))
        self.refuses(f"{self.root}/cup.obj", f"{self.root}/other/cup.obj", says=("different names", "cup.obj"))

    def test_more_interpolations_than_assets(self):
        self.refuses(f"{self.root}/wave", "--interpolation", "step,linear", says=("--interpolation",))

    def test_wrong_usage_is_2(self):
        for option in (("--size", "640"), ("--at", "a"), ("--eye", "1,2"), ("--orbit", "1"), ("--interpolation", "smooth"), ("--nope",)):
            self.refuses(f"{self.root}/wave", *option, code=2, says=(option[0],))
        self.refuses(code=2, says=("ASSET",))


@unittest.skipUnless(draws(), "nothing draws here")
class Pictures(Rendering):
    def test_a_picture_for_each_time(self):
        said = self.render(f"{self.root}/wave", "--at", "0,0.5,1,2", *SMALL, "-o", "p%02d.png")
        self.assertEqual(sorted(os.listdir(self.out)), ["p00.png", "p01.png", "p02.png", "p03.png"])
        self.assertEqual([line.split(":")[0] for line in said.splitlines()], sorted(os.listdir(self.out)))
        pictures = [self.read(name) for name in sorted(os.listdir(self.out))]
        for width, height, rows in pictures:
            self.assertEqual((width, height, len(rows)), (64, 48, 48))
        self.assertNotEqual(pictures[0], pictures[1])
        self.assertNotEqual(pictures[1], pictures[2])
        self.assertEqual(pictures[0], pictures[3], "the end of the clip is as its beginning")

    def test_one_picture_by_default(self):
        self.render(f"{self.root}/cup.obj")
        self.assertEqual(self.read("frame-0000.png")[:2], (1280, 720))

    def test_a_sheet_holds_them_all(self):
        times = ["0", "0.5", "1", "1.25", "2"]
        self.render(f"{self.root}/wave", "--at", ",".join(times), *SMALL, "--sheet", "-o", "sheet.png")
        self.render(f"{self.root}/wave", "--at", ",".join(times), *SMALL, "-o", "p%d.png")
        width, height, rows = self.read("sheet.png")
        self.assertEqual((width, height), (3 * 64 + 2 * 2, 2 * 48 + 2))
        for i in range(5):
            left, top = i % 3 * 66, i // 3 * 50
            cut = [row[3 * left:3 * (left + 64)] for row in rows[top:top + 48]]
            self.assertEqual(cut, self.read(f"p{i}.png")[2], f"picture {i}")

    def test_jpeg_by_the_names_ending(self):
        for name in ("a.jpg", "b.jpeg", "C.JPG"):
            self.render(f"{self.root}/wave", *SMALL, "-o", name)
            with open(os.path.join(self.out, name), "rb") as f:
                self.assertEqual(f.read(3), b"\xff\xd8\xff", name)
        self.render(f"{self.root}/wave", "-o", "fine.jpg", "--quality", "100")
        self.render(f"{self.root}/wave", "-o", "coarse.jpg", "--quality", "5")
        self.assertGreater(os.path.getsize(f"{self.out}/fine.jpg"), os.path.getsize(f"{self.out}/coarse.jpg"))

    def test_assets_stand_side_by_side_each_with_its_interpolation(self):
        wave = f"{self.root}/wave"
        rows = {}
        for name, modes in (("mixed", "step,linear"), ("step", "step"), ("linear", "linear"), ("both", "linear,linear")):
            self.render(wave, wave, "--at", "0.5", "--size", "128x48", "--interpolation", modes, "--orbit", "0,0", "-o", f"{name}.png")
            rows[name] = self.read(f"{name}.png")[2]
        half = {name: ([r[:192] for r in picture], [r[192:] for r in picture]) for name, picture in rows.items()}
        self.assertEqual(rows["linear"], rows["both"], "one is for all")
        self.assertEqual(half["mixed"][0], half["step"][0])
        self.assertEqual(half["mixed"][1], half["linear"][1])
        self.assertNotEqual(half["step"][0], half["linear"][0])
        background = half["mixed"][0][0][:3]
        for side in half["mixed"]:
            self.assertTrue(any(row[i:i + 3] != background for row in side for i in range(0, len(row), 3)), "one on each side")

    def test_from_right_above_and_below(self):
        harness.write_obj(f"{self.root}/floor.obj", [-1, 0, -1, -1, 0, 1, 1, 0, 1, 1, 0, -1], faces=((1, 2, 3), (1, 3, 4)))
        for elevation in (90, -90):
            self.render(f"{self.root}/floor.obj", *SMALL, "--orbit", f"0,{elevation}", "-o", "top.png")
            _, _, rows = self.read("top.png")
            self.assertNotEqual(rows[24][96:99], rows[0][:3], "what lies flat is seen in the middle")

    def test_a_camera_that_can_show_nothing(self):
        self.refuses(f"{self.root}/wave", "--eye", "1,1,1", "--target", "1,1,1", says=("eye and target",))

    def test_background_and_eye(self):
        self.render(f"{self.root}/wave", *SMALL, "--background", "1,0,0.2", "--eye", "0,0,100", "--target", "0,0,200", "-o", "red.png")
        self.assertEqual({row[i:i + 3] for row in self.read("red.png")[2] for i in range(0, 192, 3)}, {bytes((255, 0, 51))})

    def test_a_picture_that_the_device_can_not_draw(self):
        said = self.refuses(f"{self.root}/wave", "--size", "65535x1", says=("most this device draws", "65535 x 1"))
        most = int(re.search(r"to (\d+) x \d+ pixels", said)[1])
        self.refuses(f"{self.root}/wave", "--size", f"{most + 1}x1", says=(f"{most + 1} x 1",))
        self.render(f"{self.root}/wave", "--size", "4097x3", "-o", "wide.png")
        self.assertEqual(self.read("wide.png")[:2], (4097, 3), "a server's limits are not those of this program")

    def test_a_folder_that_can_not_be_written(self):
        self.refuses(f"{self.root}/wave", *SMALL, "-o", "none/a.png", says=("expected a file that can be written at none/a.png", "found: No such file"))
        self.refuses(f"{self.root}/wave", *SMALL, "-o", f"{self.root}/cup.obj/a.png", says=("expected", "found: Not a directory"))
        self.refuses(f"{self.root}/wave", *SMALL, "-o", "/proc/a.png", says=("expected", "found: "))

    def test_a_warning_comes_once(self):
        harness.write_obj(f"{self.root}/bare.obj", lifted(0), tail="mtllib none.mtl\n")
        done = run_program("render", f"{self.root}/bare.obj", "--at", "0,1,2", *SMALL, "-o", "w%d.png", cwd=self.out)
        self.assertEqual(done.returncode, 0)
        self.assertEqual(done.stderr.count("none.mtl"), 1, done.stderr)

    def test_the_same_bytes_every_time(self):
        for name in ("a.png", "b.png"):
            self.render(f"{self.root}/wave", "--at", "0.7", "-o", name)
        self.assertEqual(self.read("a.png"), self.read("b.png"))


class Doctor(harness.TestCase):
    starts_server = False

    @unittest.skipUnless(draws(), "nothing draws here")
    def test_what_draws_is_told(self):
        done = run_program("doctor")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(len(re.findall(r"^  taken ", done.stdout, re.M)), 1, done.stdout)
        self.assertIn("drawing with", done.stdout)
        self.assertIn("Page\n", done.stdout)

    def test_where_nothing_draws_it_says_why(self):
        done = run_program("doctor", environment=NO_DEVICE)
        self.assertEqual((done.returncode, done.stderr), (1, ""))
        self.assertNotRegex(done.stdout, r"(?m)^  taken ")
        self.assertRegex(done.stdout, r"(?m)^  not taken  .*: .+")
        self.assertIn("nothing draws", done.stdout)

    def test_where_nothing_draws_render_says_so(self):
        folder = self.folder()
        harness.write_obj(f"{folder}/cup.obj", lifted(1))
        done = run_program("render", f"{folder}/cup.obj", cwd=folder, environment=NO_DEVICE)
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("tweend: expected", done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)


class WithoutADevice(harness.TestCase):
    """A server that would draw, on a machine where nothing does."""
    starts_server = False

    def setUp(self):
        folder = self.folder()
        self.log, port_file = f"{folder}/log", f"{folder}/port"
        harness.write_obj(f"{folder}/bare.obj", lifted(0), tail="mtllib none.mtl\n")
        with open(self.log, "wb") as log:
            self.process = subprocess.Popen([TWEEND, "serve", "--no-auth", "--listen", "127.0.0.1:0", "--port-file", port_file,
                                             "--assets", folder], stdout=log, stderr=log, env={**os.environ, **NO_DEVICE},
                                            preexec_fn=harness.die_with_parent)
        self.addCleanup(self.process.wait, 30)
        self.addCleanup(self.process.terminate)
        wait_until(lambda: os.path.exists(port_file), "the port file")
        with open(port_file) as f:
            self.port = int(f.read())
        self.c = LineClient(self.port)
        self.addCleanup(self.c.close)

    def log_text(self):
        with open(self.log) as f:
            return f.read()

    def test_it_serves_vertices_and_refuses_pictures(self):
        self.add_moving()
        self.near(self.c.call("vertices.sample", time=1)["positions"], lifted(1))
        stream = self.c.call("stream.open", kind="vertices", actor="tri", encoding="f32", rate=30)["stream"]
        self.assertIsInstance(stream, int)
        for _ in range(3):
            error = self.refused(-32006, "frame.render")
            self.assertIn("expected", str(error))
        warnings = [line for line in self.log_text().splitlines() if " warning " in line]
        self.assertEqual(len(warnings), 1, warnings)
        self.assertIn("no pictures", warnings[0])

    def test_it_is_not_ready_but_healthy(self):
        client = HttpClient(self.port)
        self.addCleanup(client.close)
        self.assertEqual(client.ask("GET", "/healthz")[0], 200)
        self.assertEqual(client.ask("GET", "/readyz")[0], 503)
        self.assertEqual(client.ask("GET", "/scenes/main/frame.png")[0], 503)

    def test_warnings_of_assets_are_logged_once(self):
        self.c.call("actor.add", actor="bare", asset="bare.obj")
        for _ in range(3):
            self.c.call("scene.describe")
            self.c.call("vertices.sample")
        self.assertEqual(self.log_text().count("none.mtl"), 1, self.log_text())


if __name__ == "__main__":
    harness.main()
