"""Reads what assets/obj_writer.py and assets/png_writer.py write; no code shared with them."""
import struct
import zlib


class ObjFile:
    """positions, texcoords, normals: tuples of floats; faces: corners (v, vt, vn), indices from 0; other: what is left."""

    def __init__(self, text):
        rows = {"v": [], "vt": [], "vn": [], "f": []}
        self.other = []
        for line in text.splitlines():
            word, *rest = line.split()
            rows[word].append(rest) if word in rows else self.other.append(line)
        self.positions, self.texcoords, self.normals = ([tuple(map(float, row)) for row in rows[k]] for k in ("v", "vt", "vn"))
        self.faces = [[tuple(int(i) - 1 for i in corner.split("/")) for corner in row] for row in rows["f"]]


def png_pixels(data):
    """Width, height and the filtered rows: equal for equal pictures, however this machine's zlib packs them."""
    width, height = struct.unpack(">II", data[16:24])
    packed, place = b"", 8
    while place < len(data):
        size, kind = struct.unpack(">I4s", data[place:place + 8])
        if zlib.crc32(data[place + 4:place + 8 + size]) != struct.unpack(">I", data[place + 8 + size:place + 12 + size])[0]:
            raise ValueError(f"a chunk {kind} with a wrong checksum")
        packed += data[place + 8:place + 8 + size] if kind == b"IDAT" else b""
        place += 12 + size
    return width, height, zlib.decompress(packed)
