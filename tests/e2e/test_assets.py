"""Assets: what is listed, what is read, and that nothing outside the assets folders can be (sections 3 and 8)."""
import os

import harness
from harness import lifted


class Assets(harness.TestCase):
    starts_server = False

    def setUp(self):
        self.root, self.outside = self.folder(), self.folder()
        self.obj = lambda name, **kw: harness.write_obj(os.path.join(self.root, name), lifted(1), **kw)
        self.obj("tri.obj")
        harness.write_sequence(self.root, "wave", {0: lifted(0), 10: lifted(1), 40: lifted(4)})
        harness.write_sequence(self.root, "deep/down/seq", {1: lifted(0), 2: lifted(1)})
        harness.write_obj(os.path.join(self.outside, "secret.obj"), lifted(7))
        harness.write_sequence(self.outside, "secret", {0: lifted(7), 1: lifted(8)})

    def start(self, *roots):
        self.server = self.serve(assets=roots or [self.root])
        self.c = self.server.line()

    def text(self, name, content):
        path = os.path.join(self.root, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "wb") as f:
            f.write(content)

    def refused_as_no_asset(self, name):
        """Nothing that could be read is there, be it called no asset or a bad one."""
        with self.assertRaises(harness.RpcError) as caught:
            self.c.call("actor.add", actor="a", asset=name)
        self.assertIn(caught.exception.code, (-32001, -32005), name)

    def bad(self, name, *words):
        with self.unchanged():
            error = self.refused(-32005, "actor.add", path="params.asset", actor="bad", asset=name)
            for word in words:
                self.assertIn(word, error.message)
        return error


class Listing(Assets):
    def test_list(self):
        self.text("notes.txt", b"no asset")
        self.start()
        listed = {a["name"]: a for a in self.c.call("asset.list")["assets"]}
        self.assertEqual({n: a["type"] for n, a in listed.items()}, {"tri.obj": "obj", "wave": "obj_sequence", "deep/down/seq": "obj_sequence"})
        self.assertEqual(listed["tri.obj"]["bytes"], os.path.getsize(os.path.join(self.root, "tri.obj")))
        wave = os.path.join(self.root, "wave")
        self.assertEqual(listed["wave"]["bytes"], sum(os.path.getsize(os.path.join(wave, f)) for f in os.listdir(wave)))

    def test_several_folders(self):
        second = self.folder()
        harness.write_obj(os.path.join(second, "tri.obj"), lifted(2))
        harness.write_obj(os.path.join(second, "more.obj"), lifted(3))
        self.start(self.root, second)
        names = [a["name"] for a in self.c.call("asset.list")["assets"]]
        self.assertEqual(names, sorted(names))
        self.assertEqual((names.count("tri.obj"), names.count("more.obj")), (1, 1))
        self.c.call("actor.add", actor="a", asset="tri.obj")
        self.assertEqual(self.c.call("vertices.sample")["positions"], lifted(1), "the first folder's")
        self.c.call("actor.add", actor="b", asset="more.obj")

    def test_without_any_folder(self):
        self.server = self.serve()
        self.c = self.server.line()
        self.assertEqual(self.c.call("asset.list"), {"assets": []})
        self.refused(-32001, "actor.add", path="params.asset", actor="a", asset="tri.obj")


class Loading(Assets):
    def test_a_sequence(self):
        self.start()
        added = self.c.call("actor.add", actor="wave", asset="wave", fps=10)
        self.assertEqual((added["clips"], added["vertices"], added["joints"]), (["default"], 3, 0))
        self.assertEqual([k["time"] for k in self.c.call("keyframe.list")["keyframes"]], [0, 1, 4], "frame numbers need not be even")
        self.assertEqual(self.c.call("vertices.sample", time=2.5)["positions"], lifted(2.5))
        actor, = self.c.call("scene.describe")["actors"]
        self.assertEqual(actor["source"], "wave")

    def test_frames_a_second_are_24_if_not_given(self):
        self.start()
        self.c.call("actor.add", actor="wave", asset="wave")
        self.near([k["time"] for k in self.c.call("keyframe.list")["keyframes"]], [0, 10 / 24, 40 / 24], 1e-9)

    def test_a_closed_sequence(self):
        self.start()
        self.c.call("actor.add", actor="wave", asset="wave", fps=10, closed=True, duration=5)
        self.assertEqual(self.c.call("vertices.sample", time=4.5)["positions"], lifted(2))
        self.refused(-32602, "actor.add", path="params.duration", actor="b", asset="wave", fps=10, closed=True, duration=4)

    def test_a_single_file(self):
        self.start()
        self.c.call("actor.add", actor="tri", asset="tri.obj")
        listed = self.c.call("keyframe.list")
        self.assertEqual([k["time"] for k in listed["keyframes"]], [0])
        self.assertEqual(self.c.call("vertices.sample")["positions"], lifted(1))
        self.c.call("actor.add", actor="seq", asset="deep/down/seq")

    def test_a_document_survives_the_files_removal(self):
        self.start()
        self.c.call("actor.add", actor="wave", asset="wave", fps=10)
        for name in os.listdir(os.path.join(self.root, "wave")):
            os.remove(os.path.join(self.root, "wave", name))
        self.assertEqual(self.c.call("vertices.sample", time=1)["positions"], lifted(1))
        self.c.call("edit.undo")
        self.c.call("edit.redo")
        self.assertEqual(self.c.call("vertices.sample", time=1)["positions"], lifted(1))
        self.refused_as_no_asset("wave")

    def test_what_obj_files_look_like_in_the_wild(self):
        self.text("wild.obj", b"\xef\xbb\xbf# comment\r\nmtllib x.mtl\r\no thing\r\ng a b\r\ns 1\r\nusemtl red\r\n"
                  b"v 0 0 0 1 1 1\r\nv 1.0e0 0 0\r\nv  1\t1 0\r\nv 0 1 -0.5e-1\r\nvt 0 0\r\nvn 0 0 1\r\n"
                  b"f -4//-1 -3//-1 -2//-1 -1//-1 # fanned\r\ns off\r\n\r\n")
        self.start()
        self.c.call("actor.add", actor="wild", asset="wild.obj")
        sample = self.c.call("vertices.sample", indices=True)
        self.assertEqual((sample["count"], sample["indices"]), (4, [0, 1, 2, 0, 2, 3]))
        self.assertEqual(sample["positions"], [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, -0.05])


class Refusals(Assets):
    def test_bad_files(self):
        for name, content in (("empty.obj", b""), ("nofaces.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n"), ("nan.obj", b"v 0 0 nan\nf 1 1 1\n"),
                              ("inf.obj", b"v 0 0 1e999\nv 0 0 0\nv 0 0 0\nf 1 2 3\n"), ("short.obj", b"v 0 0\n"), ("word.obj", b"v 0 0 x\n"),
                              ("range.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n"), ("zero.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n"),
                              ("two.obj", b"v 0 0 0\nv 1 0 0\nf 1 2\n"), ("binary.obj", bytes(range(256)) * 4)):
            self.text(name, content)
        self.start()
        for name, line in (("empty.obj", ""), ("nofaces.obj", ""), ("nan.obj", ":1"), ("inf.obj", ":1"), ("short.obj", ":1"), ("word.obj", ":1"),
                           ("range.obj", ":4"), ("zero.obj", ":4"), ("two.obj", ":3"), ("binary.obj", "")):
            self.bad(name, name + line)

    def test_bad_sequences(self):
        harness.write_sequence(self.root, "counts", {0: lifted(0), 10: lifted(1) + [5, 5, 5]})
        harness.write_obj(os.path.join(self.root, "faces", "faces_000000.obj"), lifted(0), [(1, 2, 3)])
        harness.write_obj(os.path.join(self.root, "faces", "faces_000010.obj"), lifted(0), [(1, 2, 3), (1, 3, 2)])
        harness.write_obj(os.path.join(self.root, "order", "order_000000.obj"), lifted(0), [(1, 2, 3)])
        harness.write_obj(os.path.join(self.root, "order", "order_000010.obj"), lifted(0), [(1, 3, 2)])
        self.start()
        self.bad("counts", "counts_000000.obj", "counts_000010.obj", "3", "4")
        self.bad("faces", "faces_000000.obj", "faces_000010.obj", "1", "2")
        self.bad("order", "order_000010.obj")

    def test_names_never_leave_the_folder(self):
        os.symlink(os.path.join(self.outside, "secret.obj"), os.path.join(self.root, "link.obj"))
        os.symlink(self.outside, os.path.join(self.root, "linked"))
        os.symlink(os.path.join(self.outside, "secret"), os.path.join(self.root, "secret"))
        os.symlink("../../../../../../../../etc", os.path.join(self.root, "etc"))
        os.makedirs(os.path.join(self.root, "half"))
        for i in range(2):
            os.symlink(os.path.join(self.outside, "secret", f"secret_{i:06d}.obj"), os.path.join(self.root, "half", f"half_{i:06d}.obj"))
        os.mkfifo(os.path.join(self.root, "pipe.obj"))
        self.start()
        outside = os.path.relpath(self.outside, self.root)
        with self.unchanged():
            for name in (f"{outside}/secret.obj", f"{self.outside}/secret.obj", f"{outside}/secret", f"{self.outside}/secret", "link.obj",
                         "linked/secret.obj", "linked/secret", "secret", "etc/passwd", "../../etc/passwd", "/etc/passwd", "..", ".", "",
                         "/", "wave/..", "wave/../tri.obj", "./tri.obj", "deep/../../" + os.path.basename(self.outside) + "/secret.obj",
                         "tri.obj/", "tri.obj\0", "wave/../../" + os.path.basename(self.root) + "/tri.obj", "//tri.obj", "~/x.obj",
                         "\\..\\x.obj", "x" * 5000, "a/" * 2000, "none", "TRI.OBJ", "%2e%2e/secret.obj"):
                error = self.refused(-32001, "actor.add", path="params.asset", actor="a", asset=name)
                self.assertNotIn(self.outside, error.message.replace(name, ""), "no path of the machine is told")
            self.refused_as_no_asset("half")
            self.refused_as_no_asset("deep")
            self.refused_as_no_asset("pipe.obj")
        self.assertEqual({a["name"] for a in self.c.call("asset.list")["assets"]} & {"link.obj", "secret", "half", "linked/secret.obj", "pipe.obj"}, set())

    def test_hidden_files_and_folders_without_frames(self):
        self.obj(".hidden.obj")
        self.obj("plain/a.obj")
        self.start()
        self.assertNotIn("plain", [a["name"] for a in self.c.call("asset.list")["assets"]])
        with self.unchanged():
            self.refused_as_no_asset("plain")


if __name__ == "__main__":
    harness.main()
