"""Reads a binary glTF 2.0 file, and evaluates its skeleton, as plainly as the specification says it; no code shared with
assets/glb_writer.py."""
import json
import math
import struct

COMPONENTS = {5121: ("B", 255), 5123: ("H", 65535), 5125: ("I", 1), 5126: ("f", 1)}
TYPES = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class GlbFile:
    def __init__(self, data):
        magic, version, length = struct.unpack_from("<4sII", data)
        if (magic, version, length) != (b"glTF", 2, len(data)):
            raise ValueError(f"expected a whole glb 2, found {magic} {version} with {length} of {len(data)} bytes")
        size, kind = struct.unpack_from("<I4s", data, 12)
        self.json = json.loads(data[20:20 + size])
        binary_size, binary_kind = struct.unpack_from("<I4s", data, 20 + size)
        if (kind, binary_kind, 28 + size + binary_size) != (b"JSON", b"BIN\0", length):
            raise ValueError("expected a JSON and a BIN chunk and nothing else")
        self._binary = data[28 + size:]
        self.nodes = self.json["nodes"]
        self.parents = {child: i for i, node in enumerate(self.nodes) for child in node.get("children", [])}

    def rows(self, number):
        """An accessor's values: tuples of numbers; normalized integers as 0 to 1."""
        accessor = self.json["accessors"][number]
        width = TYPES[accessor["type"]]
        rows = [(0.0,) * width] * accessor["count"]
        if "bufferView" in accessor:
            rows = self._read(accessor["bufferView"], accessor["componentType"], width, accessor["count"])
        if "sparse" in accessor:
            sparse = accessor["sparse"]
            places = self._read(sparse["indices"]["bufferView"], sparse["indices"]["componentType"], 1, sparse["count"])
            values = self._read(sparse["values"]["bufferView"], accessor["componentType"], width, sparse["count"])
            for (place,), value in zip(places, values):
                rows[place] = value
        if accessor.get("normalized"):
            most = COMPONENTS[accessor["componentType"]][1]
            rows = [tuple(x / most for x in row) for row in rows]
        return rows

    def _read(self, view, component, width, count):
        offset = self.json["bufferViews"][view]["byteOffset"]
        letter, _ = COMPONENTS[component]
        if offset % struct.calcsize(letter):
            raise ValueError(f"view {view} is not aligned")
        return list(struct.iter_unpack(f"<{width}{letter}", self._binary[offset:offset + count * width * struct.calcsize(letter)]))

    def node(self, name):
        return next(i for i, node in enumerate(self.nodes) if node.get("name") == name)

    def clip(self, name):
        return Clip(self, next(a for a in self.json["animations"] if a["name"] == name))

    def places(self, clip, time):
        """{node: (rotation, translation)} in the world, scales being all 1."""
        placed = {}

        def place(node):
            if node not in placed:
                local = clip.sample(node, "rotation", time), clip.sample(node, "translation", time)
                rotation = local[0] or tuple(self.nodes[node].get("rotation", (0, 0, 0, 1)))
                translation = local[1] or tuple(self.nodes[node].get("translation", (0, 0, 0)))
                if node in self.parents:
                    outer, at = place(self.parents[node])
                    rotation, translation = product(outer, rotation), moved(outer, at, translation)
                placed[node] = rotation, translation
            return placed[node]

        for node in range(len(self.nodes)):
            place(node)
        return placed

    def skinned(self, placed):
        """The mesh's positions in a pose."""
        attributes = self.json["meshes"][0]["primitives"][0]["attributes"]
        skin = self.json["skins"][0]
        binds = [row[12:15] for row in self.rows(skin["inverseBindMatrices"])]  # nothing but places: checked by a test
        points = []
        for p, joints, weights in zip(*(self.rows(attributes[name]) for name in ("POSITION", "JOINTS_0", "WEIGHTS_0"))):
            total = [0.0, 0.0, 0.0]
            for joint, weight in zip(joints, weights):
                if weight > 0:
                    at = moved(*placed[skin["joints"][joint]], tuple(a + b for a, b in zip(p, binds[joint])))
                    total = [a + weight * b for a, b in zip(total, at)]
            points.append(tuple(total))
        return points


class Clip:
    def __init__(self, file, animation):
        self.tracks = {}
        for channel in animation["channels"]:
            sampler = animation["samplers"][channel["sampler"]]
            times = [t for (t,) in file.rows(sampler["input"])]
            target = channel["target"]["node"], channel["target"]["path"]
            self.tracks[target] = times, file.rows(sampler["output"]), sampler["interpolation"]
        self.duration = max(times[-1] for times, _, _ in self.tracks.values())

    def sample(self, node, path, time):
        """A value by glTF's rules; None where the clip leaves it alone."""
        if (node, path) not in self.tracks:
            return None
        times, rows, mode = self.tracks[node, path]
        after = next((i for i, t in enumerate(times) if t > time), len(times) - 1)
        span = times[after] - times[after - 1]
        u = min(1.0, (time - times[after - 1]) / span)
        if mode == "CUBICSPLINE":
            value = cubic(rows[3 * after - 2], rows[3 * after - 1], rows[3 * after], rows[3 * after + 1], u, span)
        elif path == "rotation":
            value = slerp(rows[after - 1], rows[after], u)
        else:
            value = tuple(a + (b - a) * u for a, b in zip(rows[after - 1], rows[after]))
        length = math.hypot(*value) if path == "rotation" else 1.0
        return tuple(x / length for x in value)


def cubic(start, leave, arrive, end, u, span):
    a, b, c, d = 2 * u**3 - 3 * u**2 + 1, u**3 - 2 * u**2 + u, u**3 - u**2, 3 * u**2 - 2 * u**3
    return tuple(a * p + b * span * m + c * span * n + d * q for p, m, n, q in zip(start, leave, arrive, end))


def slerp(a, b, u):
    along = sum(x * y for x, y in zip(a, b))
    if along < 0:
        b, along = tuple(-x for x in b), -along
    angle = math.acos(min(1.0, along))
    if angle < 1e-6:
        return tuple(x + (y - x) * u for x, y in zip(a, b))
    return tuple((math.sin((1 - u) * angle) * x + math.sin(u * angle) * y) / math.sin(angle) for x, y in zip(a, b))


def product(a, b):
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def moved(rotation, translation, point):
    turned = product(product(rotation, (*point, 0.0)), tuple(-x for x in rotation[:3]) + rotation[3:])
    return tuple(a + b for a, b in zip(turned, translation))
