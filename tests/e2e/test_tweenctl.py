"""tweenctl against a running server, as one would use it."""
import contextlib
import json
import os
import re
import shutil
import socket
import subprocess
import unittest

import harness
from harness import TRIANGLE, TWEENCTL, lifted, wait_until


class Remote(harness.TestCase):
    starts_server = False

    def setUp(self):
        folder = self.folder()
        harness.write_sequence(folder, "barb", {0: lifted(0), 10: lifted(1), 20: lifted(4), 30: lifted(9)})
        harness.write_obj(os.path.join(folder, "cup.obj"), lifted(3))
        self.server = self.serve(assets=[folder])
        self.c = self.server.line()

    def command(self, *arguments):
        return [TWEENCTL, "--server", f"127.0.0.1:{self.server.port}", *map(str, arguments)]

    def ctl(self, *arguments, code=0, stdin=None):
        """Runs it: what it prints. What is wrong is told in one line."""
        done = subprocess.run(self.command(*arguments), capture_output=True, text=True, timeout=60, input=stdin,
                              preexec_fn=harness.die_with_parent)
        self.assertEqual(done.returncode, code, f"{arguments}: {done.stdout}{done.stderr}")
        if code == 0:
            self.assertEqual(done.stderr, "", arguments)
        else:
            self.assertRegex(done.stderr, r"\A[^\n]+\n\Z", f"one line: {arguments}")
        self.errors = done.stderr
        return done.stdout

    def json(self, *arguments, **kw):
        return json.loads(self.ctl("--json", *arguments, **kw))

    def start(self, *arguments):
        """Runs it beside the test; it has asked what it asks at first when this returns."""
        before = self.c.call("server.stats")["tweend_requests_total"]
        asked = 0
        process = subprocess.Popen(self.command(*arguments), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                   preexec_fn=harness.die_with_parent)

        def end():
            process.kill()
            process.communicate()
        self.addCleanup(end)

        def has_asked():
            nonlocal asked
            asked += 1  # these questions count, too
            return self.c.call("server.stats")["tweend_requests_total"] > before + asked or process.poll() is not None
        wait_until(has_asked, "it asks")
        self.c.call("server.stats")  # a request that was taken before this one is carried out before it
        return process

    def output(self, process, code=0):
        out, err = process.communicate(timeout=60)
        self.assertEqual(process.returncode, code, out + err)
        return out

    def add_barb(self):
        self.ctl("add", "barb", "--asset", "barb", "--fps", 10)


class Session(Remote):
    def test_a_session(self):
        """Loading, playing, seeking, a keyframe, undoing it, and the vertices."""
        self.assertIn("barb", self.ctl("assets"))
        self.ctl("add", "barb", "--asset", "barb", "--fps", 10, "--closed", "--duration", 4)
        self.assertIn("barb", self.ctl("actors"))
        self.ctl("play", "--speed", 2)
        self.assertEqual((self.player()["playing"], self.player()["speed"]), (True, 2))
        self.assertIn("playing", self.ctl("status"))
        self.ctl("pause")
        self.ctl("seek", 1.5)
        self.assertEqual((self.player()["time"], self.player()["playing"]), (1.5, False))
        self.ctl("keyframe", "add", "--capture", "--time", 1.5)
        self.assertEqual(len(self.c.call("keyframe.list")["keyframes"]), 5)
        self.assertIn("1.5", self.ctl("keyframe", "list"))
        self.assertIn("keyframe.add", self.ctl("undo"))
        self.assertEqual(len(self.c.call("keyframe.list")["keyframes"]), 4)
        self.ctl("redo")
        self.ctl("play", "--speed", -1)
        lines = self.ctl("watch", "vertices", "--count", 20).splitlines()
        self.assertGreaterEqual(len(lines), 20)
        self.ctl("stop")
        self.assertEqual(self.player()["time"], 0)

    def test_playback(self):
        self.add_barb()
        self.ctl("play", "--loop", "once", "--time", 0.5, "--speed", 0.001)
        self.assertEqual((self.player()["loop"], self.player()["speed"]), ("once", 0.001))
        self.ctl("step")
        self.assertEqual((self.player()["time"], self.player()["playing"]), (1, False))
        self.ctl("step", "--keyframes", -1)
        self.assertEqual(self.player()["time"], 0)
        self.ctl("step", "--seconds", 0.25)
        self.assertEqual(self.player()["time"], 0.25)
        self.ctl("set", "--speed", -2, "--loop", "ping_pong", "--range", "1,2")
        self.assertEqual((self.player()["speed"], self.player()["loop"], self.player()["range"]), (-2, "ping_pong", [1, 2]))
        self.assertEqual(self.json("status")["players"], self.c.call("playback.get")["players"])

    def test_markers_queues_and_schedules(self):
        self.add_barb()
        self.ctl("clip", "create", "still", "--duration", 1)
        self.assertRegex(self.ctl("marker", "add", 0.5, "step"), r"^marker \d+ added: step at 0.5 s")
        marker = self.c.call("marker.list")["markers"][0]["marker"]
        self.assertIn("step", self.ctl("marker", "list"))
        process = self.start("events")
        self.ctl("queue", "default", "still:2:0.1")
        self.assertEqual(self.player()["clip"], "default")
        wait_until(lambda: self.player()["clip"] == "still", "the next clip")
        self.ctl("stop")
        printed = bytearray()
        os.set_blocking(process.stdout.fileno(), False)

        def has_printed():
            with contextlib.suppress(BlockingIOError):
                printed.extend(os.read(process.stdout.fileno(), 65536))
            return re.search(rb"marker.crossed +scene main, barb default: step at 0.5 s\n", printed)
        wait_until(has_printed, "the crossing is printed")
        self.ctl("marker", "remove", marker)
        self.assertEqual(self.ctl("marker", "list"), "no markers\n")

        self.assertRegex(self.ctl("seek", 1, "--at", "+3600"), r"^scheduled as \d+ for the reading \d+\n$")
        waiting = self.c.call("schedule.list")["scheduled"][0]
        self.assertIn("playback.seek", self.ctl("schedule", "list"))
        self.ctl("schedule", "cancel", waiting["scheduled"])
        self.assertEqual(self.ctl("schedule", "list"), "nothing waits\n")
        self.ctl("play", "--at", 1, "--late", "error", code=1)
        self.ctl("camera", "--fit", "--at", "+0.01")
        self.ctl("play", "--clip", "default", "--fade", 0.2)

    def test_layers(self):
        self.c.call("actor.add", actor="arm", skeleton={"joints": [{"name": "a"}, {"name": "b", "parent": "a"}]})
        self.c.call("keyframe.add", pose={"a": {"translation": [1, 0, 0]}})
        self.ctl("layer", "set", "l", "default", "--weight", 0.5, "--additive", "--mask", "a,b", "--fade", 0.1)
        self.assertEqual(self.c.call("scene.describe")["actors"][0]["layers"],
                         [{"layer": "l", "clip": "default", "weight": 0.5, "additive": True, "mask": ["a", "b"]}])
        self.ctl("layer", "remove", "l")
        self.assertEqual(self.c.call("scene.describe")["actors"][0]["layers"], [])

    def test_scenes(self):
        self.ctl("scene", "create", "two")
        self.assertIn("two", self.ctl("scenes"))
        self.ctl("--scene", "two", "add", "cup", "--asset", "cup.obj")
        self.assertEqual(len(self.c.call("scene.describe", scene="two")["actors"]), 1)
        self.assertEqual(len(self.c.call("scene.describe")["actors"]), 0)
        self.ctl("scene", "update", "two", "--grid", "--background", "1,0,0.5")
        d = self.c.call("scene.describe", scene="two")
        self.assertEqual((d["grid"], d["background"]), (True, [1, 0, 0.5]))
        self.assertIn("cup", self.ctl("scene", "show", "two"))
        self.ctl("scene", "remove", "two")
        self.assertEqual(self.json("scenes")["scenes"], self.c.call("scene.list")["scenes"])

    def test_actors(self):
        mesh = json.dumps(TRIANGLE)
        self.ctl("add", "tri", "--mesh", "-", "--translation", "1,2,3", "--interpolation", "catmull_rom", stdin=mesh)
        path = os.path.join(self.folder(), "mesh.json")
        with open(path, "w") as f:
            f.write(mesh)
        self.ctl("add", "tri2", "--mesh", path, "--scale", "-2,2,2")
        self.ctl("actor", "update", "tri", "--hidden", "--spin", -0.5, "--interpolation", "none")
        tri, tri2 = self.c.call("scene.describe")["actors"]
        self.assertEqual((tri["transform"]["translation"], tri["interpolation"], tri["visible"], tri["spin"]), ([1, 2, 3], None, False, -0.5))
        self.assertEqual(tri2["transform"]["scale"], [-2, 2, 2])
        self.ctl("remove", "tri")
        self.assertEqual([a["actor"] for a in self.c.call("scene.describe")["actors"]], ["tri2"])

    def test_keyframes_and_clips(self):
        self.add_barb()
        ids = [k["keyframe"] for k in self.c.call("keyframe.list")["keyframes"]]
        self.ctl("keyframe", "add", "--vertices", "-", "--time", 5, "--easing", "0.4,0,0.6,1", stdin=json.dumps({"positions": lifted(5)}))
        self.ctl("keyframe", "move", ids[0], 0.5)
        self.ctl("keyframe", "update", ids[1], "--interpolation", "step")
        self.ctl("keyframe", "remove", ids[2])
        self.assertEqual([(k["time"], k["interpolation"], k.get("easing")) for k in self.c.call("keyframe.list")["keyframes"]],
                         [(0.5, "linear", None), (1, "step", None), (3, "linear", None), (5, "linear", [0.4, 0, 0.6, 1])])
        self.assertEqual(self.json("keyframe", "list"), self.c.call("keyframe.list"))
        self.ctl("clip", "create", "cue", "--keys", f"{ids[3]},{ids[0]}", "--duration", 2, "--closed")
        self.ctl("clip", "update", "cue", "--interpolation", "step")
        self.assertIn("cue", self.ctl("clips"))
        self.assertEqual(self.c.call("keyframe.list", clip="cue")["closed"], True)
        self.ctl("clip", "remove", "cue")
        self.assertEqual(len(self.c.call("scene.describe")["actors"][0]["clips"]), 1)

    def test_camera_and_light(self):
        self.ctl("camera", "--eye", "-1,2,3", "--target", "0,0,0", "--fov-y", 1)
        self.assertEqual(self.c.call("scene.describe")["camera"]["eye"], [-1, 2, 3])
        self.ctl("light", "--ambient", 0.5)
        self.assertEqual(self.json("camera")["camera"], self.c.call("scene.describe")["camera"])
        self.assertIn("0.5", self.ctl("light"))
        self.add_barb()
        self.ctl("camera", "--fit")
        self.ctl("camera", "--orbit", "-0.5,0.25,10")

    def test_apply(self):
        self.add_barb()
        edits = [{"method": "keyframe.add", "params": {"capture": True}}, {"method": "camera.set", "params": {"fov_y": 1}}]
        self.ctl("apply", "-", stdin=json.dumps(edits))
        self.assertEqual(len(self.c.call("keyframe.list")["keyframes"]), 5)
        self.assertEqual(self.c.call("edit.undo")["undone"], "edit.apply")

    def test_call_and_methods(self):
        self.add_barb()
        self.assertEqual(json.loads(self.ctl("call", "keyframe.list")), self.c.call("keyframe.list"))
        self.assertEqual(json.loads(self.ctl("call", "playback.seek", "time=0.5"))["players"][0]["time"], 0.5)
        self.assertEqual(json.loads(self.ctl("call", "playback.seek", '{"time":0.75}'))["players"][0]["time"], 0.75)
        self.assertEqual(json.loads(self.ctl("call", "playback.seek", "-", stdin='{"time":0.25}'))["players"][0]["time"], 0.25)
        listed = self.ctl("methods")
        for method in (m["name"] for m in self.c.call("rpc.discover")["methods"]):
            self.assertIn(method, listed)
        self.assertIn("easing", self.ctl("methods", "keyframe.add"))

    def test_vertices(self):
        self.add_barb()
        self.assertEqual(self.json("vertices", "--time", 1.5), self.c.call("vertices.sample", time=1.5))
        self.assertIn("2.5", self.ctl("vertices", "--time", 1.5))

    def test_what_the_server_is(self):
        self.assertIn("tweend", self.ctl("info"))
        self.ctl("ping")
        self.assertIn("tweend_connections", self.ctl("stats"))
        self.assertEqual(self.json("info")["server"], "tweend")

    def test_base_revision_and_retry_key(self):
        first = self.json("camera", "--fov-y", 1, "--retry-key", "k")
        self.assertEqual(self.json("camera", "--fov-y", 1, "--retry-key", "k"), first)
        self.ctl("camera", "--fov-y", 2, "--base-revision", first["revision"])
        self.ctl("camera", "--fov-y", 3, "--base-revision", first["revision"], code=1)


class Exits(Remote):
    def test_refused_is_1(self):
        self.add_barb()
        for arguments, words in ((("seek", 1, "--actor", "none"), ("none",)), (("add", "barb", "--asset", "barb"), ("barb",)),
                                 (("add", "x", "--asset", "../../etc/passwd"), ()), (("call", "no.such"), ("no.such",)),
                                 (("call", "playback.seek", "tiem=1"), ("params.tiem",)), (("play", "--clip", "none"), ("none",)),
                                 (("keyframe", "remove", 999), ("999",)), (("--scene", "none", "status"), ("none",)), (("redo",), ())):
            self.ctl(*arguments, code=1)
            for word in words:
                self.assertIn(word, self.errors)

    def test_refused_as_json(self):
        done = subprocess.run(self.command("--json", "call", "playback.seek", "tiem=1"), capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 1)
        error = json.loads(done.stdout)
        self.assertEqual((error["code"], error["data"]["path"]), (-32602, "params.tiem"))

    def test_wrong_usage_is_2(self):
        for arguments in (("nope",), ("seek",), ("seek", "soon"), ("play", "--nope"), ("set", "--range", "1"), ("camera", "--eye", "1,2"), ("add",),
                          ("call",), ("keyframe",), ("play", "--loop", "twice"), ("watch", "vertices", "--count", "x"), ()):
            done = subprocess.run(self.command(*arguments), capture_output=True, text=True, timeout=60)
            self.assertEqual((done.returncode, done.stdout), (2, ""), arguments)
            self.assertTrue(done.stderr)
        self.assertEqual(subprocess.run([TWEENCTL, "--server", "127.0.0.1:x", "status"], capture_output=True, timeout=60).returncode, 2)

    def test_no_server_is_3(self):
        self.assertEqual(self.server.stop(), 0)
        for arguments in (("status",), ("watch", "vertices"), ("wait", "ended"), ("events",), ("call", "server.ping"), ("--json", "status")):
            self.ctl(*arguments, code=3)
            self.assertIn(str(self.server.port), self.errors)

    def test_a_server_that_goes_is_3(self):
        self.add_barb()
        waiting = self.start("wait", "ended")
        events = self.start("events")
        self.assertEqual(self.server.stop(), 0)
        self.output(waiting, code=3)
        self.output(events, code=3)

    def test_what_is_no_tweend_is_3(self):
        with socket.create_server(("127.0.0.1", 0)) as quiet:
            done = subprocess.run([TWEENCTL, "--server", f"127.0.0.1:{quiet.getsockname()[1]}", "--timeout", "0.3", "status"],
                                  capture_output=True, text=True, timeout=60)
            self.assertEqual(done.returncode, 3, done)

    def test_help(self):
        for arguments in ((), ("play",), ("keyframe",), ("keyframe", "add"), ("watch", "vertices")):
            self.assertIn("Usage", self.ctl(*arguments, "--help"))

    def test_the_address_from_the_environment(self):
        done = subprocess.run([TWEENCTL, "scenes"], capture_output=True, text=True, timeout=60,
                              env=os.environ | {"TWEEND_SERVER": f"127.0.0.1:{self.server.port}"})
        self.assertEqual(done.returncode, 0, done)
        self.assertIn("main", done.stdout)


class Watching(Remote):
    def setUp(self):
        super().setUp()
        self.add_barb()

    def test_watch_vertices(self):
        self.ctl("play")
        lines = self.ctl("--json", "watch", "vertices", "--count", 20, "--rate", 120).splitlines()
        packets = [json.loads(text) for text in lines]
        self.assertEqual(len(packets), 20)
        self.assertEqual([p["sequence"] for p in packets], sorted({p["sequence"] for p in packets}))
        self.assertEqual({p["vertices"] for p in packets}, {3})

    def test_watch_compressed_vertices(self):
        self.ctl("seek", 0.05)
        box = lambda *options: [float(x) for x in re.findall(r"-?[\d.e-]+", self.ctl("watch", "vertices", "--count", 1, *options).split("vertices, ")[1])]
        plain = box()
        self.assertEqual(len(plain), 6)
        for encoding in ("q16", "meshopt"):
            for found, expected in zip(box("--encoding", encoding), plain, strict=True):
                self.assertAlmostEqual(found, expected, delta=1e-3, msg=encoding)
        self.ctl("play")
        for encoding in ("q16", "meshopt"):
            lines = self.ctl("--json", "watch", "vertices", "--encoding", encoding, "--count", 10, "--rate", 120).splitlines()
            self.assertEqual({json.loads(text)["vertices"] for text in lines}, {3})

    def test_watch_what_does_not_move(self):
        self.assertEqual(len(self.ctl("--json", "watch", "vertices", "--count", 1).splitlines()), 1)

    def test_watch_until_the_stream_ends(self):
        watching = self.start("watch", "vertices")
        watching.stdout.readline()
        self.c.call("actor.remove", actor="barb")
        out, err = watching.communicate(timeout=60)
        self.assertIn(watching.returncode, (0, 1), out + err)
        self.assertTrue(out or err)

    def test_wait_for_the_end(self):
        waiting = self.start("wait", "ended")
        self.c.call("playback.play", loop="once", time=2.9, speed=5)
        self.assertIn("barb", self.output(waiting))

    def test_wait_for_an_edit_or_a_change(self):
        for what, act in (("edited", lambda: self.c.call("camera.set", fov_y=1)), ("changed", lambda: self.c.call("playback.seek", time=1))):
            waiting = self.start("--json", "wait", what)
            act()
            json.loads(self.output(waiting))

    def test_waiting_has_an_end(self):
        self.ctl("wait", "ended", "--timeout", 0.1, code=1)

    def test_events(self):
        events = self.start("--json", "events", "--count", 3)
        self.c.call("playback.seek", time=1)
        self.c.call("camera.set", fov_y=1)
        self.c.call("playback.play", loop="once", time=2.9, speed=5)
        told = [json.loads(text)["method"] for text in self.output(events).splitlines()]
        self.assertEqual(told, ["playback.changed", "scene.changed", "playback.changed"])

class Completion(Remote):
    def complete(self, line):
        """What bash offers at the end of the line, from the program's own script."""
        patient = os.path.join(self.folder(), "tweenctl")  # at a prompt nobody waits longer than a second
        with open(patient, "w") as f:
            f.write(f'#!/bin/sh\n[ "$1 $2" = "--timeout 1" ] && shift 2\nexec {TWEENCTL} --timeout 60 "$@"\n')
        os.chmod(patient, 0o700)
        script = f"""
            source <({TWEENCTL} --server 127.0.0.1:{self.server.port} completion bash)
            f=$(complete -p tweenctl | sed 's/.*-F \\([^ ]*\\).*/\\1/')
            COMP_LINE=$1 COMP_POINT=${{#1}} COMP_WORDS=($1) COMP_TYPE=9
            [[ $1 == *' ' ]] && COMP_WORDS+=('')
            COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1))
            "$f" {patient} "${{COMP_WORDS[COMP_CWORD]}}" "${{COMP_WORDS[COMP_CWORD-1]:-}}"
            printf '%s\\n' "${{COMPREPLY[@]}}" """
        done = subprocess.run(["bash", "-c", script, "bash", line], capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 0, done)
        return set(done.stdout.split())

    @unittest.skipUnless(shutil.which("bash"), "needs bash")
    def test_commands_options_and_names(self):
        self.add_barb()
        self.c.call("clip.create", clip="wave")
        self.c.call("scene.create", scene="second")
        here = f"tweenctl --server 127.0.0.1:{self.server.port} "
        for line, some, none in ((here, {"play", "keyframe", "watch"}, {"server.ping"}), (here + "pl", {"play"}, {"pause", "watch"}),
                                 (here + "keyframe ", {"add", "list"}, {"play"}), (here + "play --", {"--speed", "--loop"}, {"play"}),
                                 (here + "play --loop ", {"once", "repeat", "ping_pong"}, {"play"}), (here + "play --clip ", {"default", "wave"}, set()),
                                 (here + "seek 1 --actor ", {"barb"}, {"cup.obj"}), (here + "add x --asset ", {"barb", "cup.obj"}, set()),
                                 (here + "--scene ", {"main", "second"}, set()), (here + "call play", {"playback.play", "playback.seek"}, {"camera.set"}),
                                 (here + "call playback.seek ", {"time=", "actor=", "scene="}, {"speed="}), (here + "remove ", {"barb"}, set())):
            offered = self.complete(line)
            self.assertLessEqual(some, offered, line)
            self.assertFalse(none & offered, f"{line}: {offered}")

    @unittest.skipUnless(shutil.which("bash"), "needs bash")
    def test_every_method_of_the_server_is_offered(self):
        offered = self.complete(f"tweenctl --server 127.0.0.1:{self.server.port} call ")
        self.assertLessEqual({m["name"] for m in self.c.call("rpc.discover")["methods"]}, offered)


if __name__ == "__main__":
    harness.main()
