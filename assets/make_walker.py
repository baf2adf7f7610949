#!/usr/bin/env python3
"""Makes the demo asset `walker.glb`: a person who walks, runs and waves. Run it to rewrite the file.

A skinned mesh with 21 joints, painted by vertex colours, and two morph targets (blink, smile). 1.8 m tall, standing on y = 0,
facing +Z, the left side at +X; walking, it stays in place and the ground goes by. Clips, each a loop whose last key is its
first again: `walk` (1 s, the left foot lands at 0 and the right at 0.5 s), `run` (0.64 s, likewise at 0 and 0.32 s), both with
linear keys, and `wave` (2 s) with cubic ones.
"""
import os

from glb_writer import BYTE, INDICES, SHORT, VERTICES, GlbWriter
from mesh import scale
from turning import near, normalised
from walker_body import EYE_AT, parts
from walker_gait import RUN, WALK, gait_pose, wave_pose
from walker_skeleton import JOINTS, NAMES, PLACES, offset
from walker_skin import stored, weights

NAME = "walker.glb"
DECIMALS = 5  # what differs in a last bit of a sine is rounded away
WAVE_S = 2.0
EYES = ("eye", "glint")
CLIPS = [  # name, seconds, keys in a loop, pose of a phase, whether the keys have tangents
    ("walk", WALK.duration_s, 48, lambda phase: gait_pose(WALK, phase), False),
    ("run", RUN.duration_s, 48, lambda phase: gait_pose(RUN, phase), False),
    ("wave", WAVE_S, 24, wave_pose, True),
]
WAVE_FACE = [(0.0, 0, 1), (0.9, 0, 1), (1.0, 1, 1), (1.1, 0, 1), (2.0, 0, 1)]  # time, blink, smile


def make():
    """The file's bytes."""
    glb = GlbWriter("tweend's assets/make_walker.py")
    document = glb.document
    joints = len(JOINTS)
    document["nodes"] = nodes() + [{"name": "walker", "mesh": 0, "skin": 0}]
    document["scenes"], document["scene"] = [{"name": "walker", "nodes": [0, joints]}], 0
    document["materials"] = [{"name": "cloth", "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.8}}]
    document["meshes"] = [mesh(glb)]
    document["skins"] = [{"joints": list(range(joints)), "skeleton": 0, "inverseBindMatrices": glb.add(
        [inverse_bind(name) for name in NAMES], "MAT4")}]
    document["animations"] = [clip(glb, *row) for row in CLIPS]
    return glb.content()


def nodes():
    made = [{"name": name, "translation": rounded(offset(name))} for name in NAMES]
    for number, (_, parent, _) in enumerate(JOINTS):
        if parent:
            made[NAMES.index(parent)].setdefault("children", []).append(number)
    return made


def inverse_bind(name):
    x, y, z = rounded(scale(PLACES[name], -1))
    return 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1


def rounded(row, decimals=DECIMALS):
    return [round(x, decimals) + 0.0 for x in row]  # no -0


def mesh(glb):
    columns = {"POSITION": [], "NORMAL": [], "COLOR_0": [], "JOINTS_0": [], "WEIGHTS_0": []}
    morphs, faces = {"blink": [], "smile": []}, []
    for part in parts():
        first = len(columns["POSITION"])
        faces += [(first + corner,) for face in part.faces for corner in face]
        for p, n in zip(part.positions, part.normals):
            pulled = stored(weights(p, part.pulled_by))
            row = rounded(p), rounded(n), colour_bytes(part.paint(p)), *pulled
            for column, value in zip(columns.values(), row):
                column.append(value)
            morphs["blink"].append(rounded(blink(part, p)))
            morphs["smile"].append(rounded(smile(part, p)))
    attributes = {name: attribute(glb, name, rows) for name, rows in columns.items()}
    targets = [{"POSITION": glb.add_sparse(rows, "VEC3")} for rows in morphs.values()]
    primitive = {"attributes": attributes, "indices": glb.add(faces, "SCALAR", SHORT, target=INDICES), "material": 0,
                 "targets": targets}
    return {"name": "walker", "primitives": [primitive], "weights": [0, 0], "extras": {"targetNames": list(morphs)}}


def attribute(glb, name, rows):
    if name in ("POSITION", "NORMAL"):
        return glb.add(rows, "VEC3", target=VERTICES)
    return glb.add(rows, "VEC4", BYTE, normalized=name != "JOINTS_0", target=VERTICES)


def colour_bytes(colour):
    """glTF's vertex colours are linear, paints are sRGB."""
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in colour]
    return [int(255 * c + 0.5) for c in linear] + [255]


def blink(part, p):
    """Eyes close towards their lower halves."""
    if part.name not in EYES:
        return 0.0, 0.0, 0.0
    middle = EYE_AT[1] - 0.006
    return 0.0, (middle - p[1]) * 0.90, 0.0 if part.name == "eye" else -0.012


def smile(part, p):
    """The mouth's corners go up and out, the brows follow a little."""
    if part.name == "brow":
        return 0.0, 0.006, 0.0
    if part.name != "mouth":
        return 0.0, 0.0, 0.0
    out = abs(p[0]) / 0.03
    return 0.22 * p[0], 0.010 * out * out - 0.003, -0.004 * out * out


def clip(glb, name, duration_s, keys, pose, tangents):
    """Every joint's rotation and the hips' place; where nothing of a joint moves, one key at each end is enough."""
    poses = [pose(key / keys) for key in range(keys)]
    times = glb.add([(round(duration_s * key / keys, 6),) for key in range(keys + 1)], "SCALAR")
    ends = glb.add([(0.0,), (duration_s,)], "SCALAR")
    animation = {"name": name, "samplers": [], "channels": []}

    def track(node, path, rows, kind, times, interpolation):
        animation["channels"].append({"sampler": len(animation["samplers"]), "target": {"node": node, "path": path}})
        animation["samplers"].append({"input": times, "interpolation": interpolation, "output": glb.add(rows, kind)})

    def loop(node, path, rows, kind):
        if all(row == rows[0] for row in rows):
            return track(node, path, rows[:1] * 2, kind, ends, "LINEAR")
        rows = closed(rows, path == "rotation")
        if tangents:
            return track(node, path, with_tangents(rows, duration_s / keys), kind, times, "CUBICSPLINE")
        return track(node, path, rows, kind, times, "LINEAR")

    loop(0, "translation", [tuple(rounded(at)) for _, at in poses], "VEC3")
    for node, joint in enumerate(NAMES):
        loop(node, "rotation", [short(rotations[joint]) for rotations, _ in poses], "VEC4")
    if tangents:
        face = glb.add([(time,) for time, _, _ in WAVE_FACE], "SCALAR")
        track(len(JOINTS), "weights", [(w,) for _, *row in WAVE_FACE for w in row], "SCALAR", face, "LINEAR")
    return animation


def short(turn):
    """Rounded, and of unit length all the same as far as floats go."""
    return normalised(rounded(turn, 7))


def closed(rows, turns):
    """With the first key again at the end; rotations each with the sign that is nearer to the one before."""
    rows = list(rows)
    if turns:
        for key in range(1, len(rows)):
            rows[key] = near(rows[key], rows[key - 1])
    return rows + rows[:1]


def with_tangents(rows, step_s):
    """As glTF's CUBICSPLINE stores keys: in-tangent, value, out-tangent; the tangents of Catmull and Rom, around the seam."""
    loop, stored_rows = rows[:-1], []
    for key, row in enumerate(rows):
        ahead, behind = loop[(key + 1) % len(loop)], loop[(key - 1) % len(loop)]
        slope = tuple(rounded(((a - b) / (2 * step_s) for a, b in zip(ahead, behind)), 6))
        stored_rows += [slope, row, slope]
    return stored_rows


if __name__ == "__main__":
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), NAME), "wb") as out:
        out.write(make())
