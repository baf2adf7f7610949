"""Every method, every parameter: unknown names, wrong types, null, each refused naming the path, and nothing changes."""
import harness
from harness import TRIANGLE, lifted

# Good parameters of every method; a new method needs a row.
GOOD = {
    "server.hello": {}, "server.ping": {}, "server.stats": {}, "rpc.discover": {}, "asset.list": {}, "scene.list": {},
    "scene.create": {"scene": "new"}, "scene.remove": {"scene": "other"}, "scene.update": {"grid": True}, "scene.describe": {},
    "actor.add": {"actor": "new", "mesh": TRIANGLE}, "actor.update": {"visible": True}, "actor.remove": {"actor": "tri"},
    "keyframe.add": {"vertices": {"positions": lifted(1)}}, "keyframe.update": {"keyframe": 1}, "keyframe.move": {"keyframe": 1, "time": 9},
    "keyframe.remove": {"keyframe": 1}, "keyframe.list": {}, "clip.create": {"clip": "new"}, "clip.update": {"clip": "default"},
    "clip.remove": {"clip": "second"}, "edit.undo": {}, "edit.redo": {},
    "edit.apply": {"edits": [{"method": "light.set", "params": {"ambient": 1}}]}, "playback.play": {}, "playback.pause": {},
    "playback.stop": {}, "playback.seek": {"time": 1}, "playback.step": {"keyframes": 1}, "playback.set": {"speed": 2},
    "playback.get": {}, "camera.set": {"eye": [1, 2, 3]}, "light.set": {"ambient": 1}, "vertices.sample": {},
    "frame.render": {"width": 8, "height": 8},
    "stream.open": {"kind": "vertices"}, "stream.update": {"stream": 1, "rate": 5}, "stream.close": {"stream": 1}, "stream.request_key": {"stream": 1},
    "events.subscribe": {}, "events.unsubscribe": {}, "pose.set": {"actor": "rig", "pose": {}}, "pose.clear": {}, "pose.sample": {},
    "playback.queue": {"clips": [{"clip": "second"}]}, "marker.add": {"time": 1, "name": "here"}, "marker.remove": {"marker": 1},
    "marker.list": {}, "layer.set": {"layer": "new", "clip": "second"}, "layer.remove": {"layer": "top"}, "schedule.list": {},
    "schedule.cancel": {"scheduled": 1}, "asset.export": {"format": "glb", "name": "out.glb"},
    "record.start": {"name": "out.mp4", "width": 16, "height": 16}, "record.stop": {"record": 1}, "record.list": {},
}
# None of these is good for a parameter of another type.
SAMPLES = {"string": "¿", "number": 1.5, "boolean": True, "array": [[]], "object": {"¿": 1}}


def types_of(schema, components):
    """The JSON types that a schema allows."""
    if "$ref" in schema:
        return types_of(components[schema["$ref"].rsplit("/", 1)[1]], components)
    for word in ("anyOf", "oneOf"):
        if word in schema:
            return {t for s in schema[word] for t in types_of(s, components)}
    if "enum" in schema and "type" not in schema:
        return {"string"}
    found = schema.get("type", [])
    return {found} if isinstance(found, str) else set(found)


class Errors(harness.TestCase):
    def setUp(self):
        super().setUp()
        self.add_moving()
        self.c.call("clip.create", clip="second")
        self.c.call("scene.create", scene="other")
        self.stream = self.c.call("stream.open", kind="vertices")["stream"]
        document = self.c.call("rpc.discover")
        self.components = document.get("components", {}).get("schemas", {})
        self.methods = {m["name"]: {p["name"]: p for p in m["params"]} for m in document["methods"]}

    def test_every_method_has_a_row(self):
        self.assertEqual(set(GOOD), set(self.methods))
        for method, params in GOOD.items():
            self.assertLessEqual(set(params), set(self.methods[method]), method)

    def test_unknown_parameters(self):
        with self.unchanged():
            for method, params in GOOD.items():
                for name in ("nope", "Scene", "", "scene "):
                    self.refused(-32602, method, path=f"params.{name}", **params | {name: 1})

    def test_required_parameters(self):
        with self.unchanged():
            for method, params in GOOD.items():
                for name, parameter in self.methods[method].items():
                    if parameter.get("required"):
                        rest = {k: v for k, v in params.items() if k != name}
                        self.refused(-32602, method, path=f"params.{name}", **rest)

    def test_wrong_types_and_null(self):
        checked = 0
        with self.unchanged():
            for method, parameters in self.methods.items():
                for name, parameter in parameters.items():
                    allowed = types_of(parameter["schema"], self.components)
                    wrong = [v for t, v in SAMPLES.items() if t not in allowed]
                    if "null" not in allowed:
                        wrong.append(None)
                    if "integer" in allowed and "number" not in allowed:
                        self.assertIn(1.5, wrong)
                    if "number" in allowed and "string" not in allowed:
                        wrong.append("1.5")
                    for value in wrong if allowed else []:
                        error = self.refused(-32602, method, **GOOD[method] | {name: value})
                        self.assertTrue(error.path == f"params.{name}" or error.path.startswith((f"params.{name}[", f"params.{name}.")),
                                        f"{method} {name}={value}: {error}")
                        checked += 1
        self.assertGreater(checked, 400)

    def test_unknown_scenes_actors_and_clips(self):
        with self.unchanged():
            for method, parameters in self.methods.items():
                for name in ("scene", "actor", "clip"):
                    if name in parameters and GOOD[method].get(name) != "new" and method != "events.unsubscribe":
                        self.refused(-32001, method, path=f"params.{name}", **GOOD[method] | {name: "none"})

    def test_methods_that_are_not_there(self):
        for method in ("no.such", "", "server", "SERVER.PING", "server.ping ", "pose.get", "rpc.", "__class__"):
            error = self.refused(-32601, method)
            self.assertTrue(error.message)

    def test_messages_say_what_was_expected_and_found(self):
        for method, params in (("playback.seek", {"time": "soon"}), ("keyframe.add", {"vertices": {"positions": [0] * 21}}),
                               ("playback.play", {"loop": "twice"}), ("actor.remove", {"actor": "none"}), ("playback.set", {"range": [2, 1]})):
            try:
                self.c.call(method, **params)
                self.fail(method)
            except harness.RpcError as error:
                self.assertRegex(error.message, "(?i)expected .*found ")

    def test_numbers_out_of_range(self):
        cases = [("stream.open", {"kind": "vertices", "rate": r}, "rate") for r in (0, -1, 241, 1e300)]
        cases += [("stream.update", {"stream": self.stream, "rate": r}, "rate") for r in (0, 241)]
        cases += [("actor.add", {"actor": "a", "mesh": TRIANGLE, "duration": d}, "duration") for d in (0, -1)]
        cases += [("clip.create", {"clip": "a", "duration": d}, "duration") for d in (0, -1)]
        cases += [("playback.set", {"range": r}, "range") for r in ([1, 1], [2, 1], [-1, 1], [0, 3], [0], [0, 1, 2])]
        cases += [("playback.step", {}, ""), ("playback.step", {"seconds": 1, "keyframes": 1}, "")]
        with self.unchanged():
            for method, params, path in cases:
                error = self.refused(-32602, method, **params)
                self.assertTrue(error.path.startswith(f"params.{path}"), f"{method} {params}: {error}")
        self.refused(-32001, "stream.close", path="params.stream", stream=99)
        self.refused(-32001, "stream.update", path="params.stream", stream=99, rate=5)

    def test_kinds_and_encodings_that_are_not_there(self):
        for params, path in (({"kind": "sound"}, "kind"), ({"kind": "vertices", "encoding": "f64"}, "encoding"),
                             ({"kind": "vertices", "delivery": "sometimes"}, "delivery")):
            self.refused(-32602, "stream.open", path=f"params.{path}", **params)


if __name__ == "__main__":
    harness.main()
