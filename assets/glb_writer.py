"""Writes glTF 2.0 as one binary file (.glb): accessors with their bounds, each in an aligned view of its own."""
import json
import struct

FLOAT, BYTE, SHORT = 5126, 5121, 5123  # of glTF; the integers are unsigned
FORMATS = {FLOAT: "f", BYTE: "B", SHORT: "H"}
SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
VERTICES, INDICES = 34962, 34963  # what a view is for


class GlbWriter:
    """Collects accessors in `document`, to which the caller adds nodes, meshes and what else there is."""

    def __init__(self, generator):
        self.document = {"asset": {"version": "2.0", "generator": generator}, "accessors": [], "bufferViews": []}
        self._bytes = bytearray()

    def add_view(self, data, target=None):
        self._bytes += b"\0" * (-len(self._bytes) % 4)
        view = {"buffer": 0, "byteOffset": len(self._bytes), "byteLength": len(data)}
        self._bytes += data
        self.document["bufferViews"].append({**view, "target": target} if target else view)
        return len(self.document["bufferViews"]) - 1

    def add(self, rows, kind, component=FLOAT, normalized=False, target=None):
        """`rows` are tuples, of SCALAR one number long. Returns the accessor's number."""
        view = self.add_view(packed(rows, component), target)
        return self._add(rows, {"bufferView": view, "componentType": component, "count": len(rows), "type": kind,
                                **({"normalized": True} if normalized else {})})

    def add_sparse(self, rows, kind):
        """Of floats, most of which are 0: only the others are stored."""
        places = [i for i, row in enumerate(rows) if any(row)]
        indices = self.add_view(packed([(i,) for i in places], SHORT))
        values = self.add_view(packed([rows[i] for i in places], FLOAT))
        return self._add(rows, {
            "componentType": FLOAT, "count": len(rows), "type": kind, "sparse": {
                "count": len(places), "indices": {"bufferView": indices, "componentType": SHORT},
                "values": {"bufferView": values}}})

    def _add(self, rows, accessor):
        if any(len(row) != SIZES[accessor["type"]] for row in rows):
            raise ValueError(f"expected rows of {SIZES[accessor['type']]} numbers for {accessor['type']}")
        stored = [[stored_number(x, accessor["componentType"]) for x in row] for row in rows]
        columns = list(zip(*stored))
        accessor["min"], accessor["max"] = [min(c) for c in columns], [max(c) for c in columns]
        self.document["accessors"].append(accessor)
        return len(self.document["accessors"]) - 1

    def content(self):
        """The file's bytes."""
        document = {**self.document, "buffers": [{"byteLength": len(self._bytes)}]}
        text = json.dumps(document, separators=(",", ":"), sort_keys=True).encode("ascii")
        chunks = chunk(b"JSON", text, b" ") + chunk(b"BIN\0", bytes(self._bytes), b"\0")
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def packed(rows, component):
    numbers = [x for row in rows for x in row]
    return struct.pack(f"<{len(numbers)}{FORMATS[component]}", *numbers)


def stored_number(x, component):
    """As it is read back: bounds have to be those of what the file holds."""
    return struct.unpack("<f", struct.pack("<f", x))[0] if component == FLOAT else x


def chunk(kind, data, filler):
    data += filler * (-len(data) % 4)
    return struct.pack("<I4s", len(data), kind) + data
