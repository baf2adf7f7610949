"""Writes small glTF files for tests, and samples them by the formulas of the specification in plain doubles."""
import base64
import json
import math
import struct

FORMATS = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
IDENTITY = [1.0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]


class GltfFile:
    """One buffer; `json` may be changed at will before it is written."""

    def __init__(self):
        self.blob = bytearray()
        self.json = {"asset": {"version": "2.0"}, "nodes": [], "accessors": [], "bufferViews": []}

    def view(self, data):
        self.blob += b"\0" * (-len(self.blob) % 4)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.blob), "byteLength": len(data)})
        self.blob += data
        return len(self.json["bufferViews"]) - 1

    def accessor(self, kind, values, component=5126, normalized=False):
        data = struct.pack(f"<{len(values)}{FORMATS[component]}", *values)
        self.json["accessors"].append({"bufferView": self.view(data), "componentType": component, "type": kind,
                                       "count": len(values) // WIDTHS[kind], **({"normalized": True} if normalized else {})})
        return len(self.json["accessors"]) - 1

    def animation(self, name, *channels):
        """channels: (node, path, interpolation, times, values[, component])"""
        samplers, targets = [], []
        for node, path, interpolation, times, values, *component in channels:
            kind = {"rotation": "VEC4", "weights": "SCALAR"}.get(path, "VEC3")
            samplers.append({"input": self.accessor("SCALAR", times), "interpolation": interpolation,
                             "output": self.accessor(kind, values, *component, normalized=bool(component))})
            targets.append({"sampler": len(samplers) - 1, "target": {"node": node, "path": path}})
        self.json.setdefault("animations", []).append({"name": name, "samplers": samplers, "channels": targets})

    def glb(self):
        whole = {k: v for k, v in self.json.items() if v != []}
        whole.setdefault("buffers", [{"byteLength": len(self.blob)}])
        text = json.dumps(whole).encode()
        text += b" " * (-len(text) % 4)
        blob = bytes(self.blob) + b"\0" * (-len(self.blob) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text
        if blob:
            chunks += struct.pack("<I4s", len(blob), b"BIN\0") + blob
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks

    def gltf(self, uri=None):
        uri = uri or "data:application/octet-stream;base64," + base64.b64encode(self.blob).decode()
        whole = {k: v for k, v in self.json.items() if v != []}
        return json.dumps({**whole, "buffers": [{"byteLength": len(self.blob), "uri": uri}]}).encode()


def about_z(angle):
    return [0.0, 0.0, math.sin(angle / 2), math.cos(angle / 2)]


def arm():
    """A bar of six vertices on the joints `shoulder` and `elbow`, 1 m above it; the clip `bend` turns the elbow by 90 degrees."""
    f = GltfFile()
    f.json["nodes"] = [{"name": "bar", "mesh": 0, "skin": 0, "children": [1]}, {"name": "shoulder", "children": [2]},
                       {"name": "elbow", "translation": [0, 1, 0]}]
    attributes = {"POSITION": f.accessor("VEC3", [c for y in (0, 1, 2) for x in (-0.25, 0.25) for c in (x, y, 0)]),
                  "NORMAL": f.accessor("VEC3", [0, 0, 1] * 6),
                  "JOINTS_0": f.accessor("VEC4", [0, 1, 0, 0] * 6, 5121),
                  "WEIGHTS_0": f.accessor("VEC4", [c for w in (0, 0.5, 1) for _ in range(2) for c in (1 - w, w, 0, 0)])}
    indices = f.accessor("SCALAR", [0, 1, 3, 0, 3, 2, 2, 3, 5, 2, 5, 4], 5123)
    f.json["meshes"] = [{"primitives": [{"attributes": attributes, "indices": indices}]}]
    f.json["skins"] = [{"joints": [1, 2], "inverseBindMatrices": f.accessor("MAT4", IDENTITY + IDENTITY[:13] + [-1, 0, 1])}]
    f.animation("bend", (2, "rotation", "LINEAR", [0, 1], about_z(0) + about_z(math.pi / 2)))
    f.animation("still", (1, "translation", "STEP", [0, 1], [0, 0, 0, 0, 0, 0]))
    return f


# ------------------------------------------------------------------------------------------ glTF 2.0, appendix C, in doubles

def unit(q):
    length = math.sqrt(sum(x * x for x in q))
    return [x / length for x in q]


def slerp(a, b, t):
    dot = sum(x * y for x, y in zip(a, b))
    s = -1.0 if dot < 0 else 1.0
    angle = math.acos(min(1.0, abs(dot)))
    if angle < 1e-9:
        return unit([x * (1 - t) + s * y * t for x, y in zip(a, b)])
    return [(math.sin(angle * (1 - t)) * x + s * math.sin(angle * t) * y) / math.sin(angle) for x, y in zip(a, b)]


def sample(times, values, width, interpolation, rotation, time):
    """values: rows as they stand in the file, of CUBICSPLINE three a key."""
    rows = [values[i:i + width] for i in range(0, len(values), width)]
    key = rows[1::3] if interpolation == "CUBICSPLINE" else rows
    if time <= times[0] or len(times) == 1:
        return unit(key[0]) if rotation else key[0]
    if time >= times[-1]:
        return unit(key[-1]) if rotation else key[-1]
    k = max(i for i, t in enumerate(times) if t <= time)
    span = times[k + 1] - times[k]
    t = (time - times[k]) / span
    if interpolation == "STEP":
        return key[k]
    if interpolation == "LINEAR":
        return slerp(unit(key[k]), unit(key[k + 1]), t) if rotation else [a * (1 - t) + b * t for a, b in zip(key[k], key[k + 1])]
    out_tangent, in_tangent = rows[3 * k + 2], rows[3 * (k + 1)]
    h = (2 * t ** 3 - 3 * t ** 2 + 1, span * (t ** 3 - 2 * t ** 2 + t), -2 * t ** 3 + 3 * t ** 2, span * (t ** 3 - t ** 2))
    value = [h[0] * a + h[1] * b + h[2] * c + h[3] * d for a, b, c, d in zip(key[k], out_tangent, key[k + 1], in_tangent)]
    return unit(value) if rotation else value
