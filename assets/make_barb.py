#!/usr/bin/env python3
"""Makes the demo keyframe set `barb`: a spike that bends towards the ground and back, as an OBJ sequence.

The recipe: a cube of 2 m whose top face is extruded twice more, its four rings scaled 1, 0.75, 0.5 and 0; two bones, at 2 m and
4 m of height, bend the upper parts towards +X. Keyframes at frames 0, 10, 20, 30 and 40 (the last like the first, so that
the clip repeats without a seam), flat normals, one texture coordinate for each corner of a side.
"""
import math
import os
import sys

RINGS = [(0.0, 1.0), (2.0, 0.75), (4.0, 0.5), (6.0, 0.0)]  # height in metres, scale of the 2 m square
BENDS = {0: 0.0, 10: 0.35, 20: 0.7, 30: 0.35, 40: 0.0}  # frame: radians at each bone
BONES = (2.0, 4.0)


def bend(point, angle):
    """Turns what lies above each bone about it; the upper bone rides on the lower one."""
    x, y, z = point
    for bone in reversed(BONES):
        if y > bone or (y == bone and bone != BONES[0]):
            c, s = math.cos(angle), math.sin(angle)
            # A turn about -Z through (0, bone, z): +Y leans towards +X.
            x, y = c * x + s * (y - bone), bone - s * x + c * (y - bone)
    return x, y, z


def skeleton_mesh():
    """Positions of the rings, and triangles with a texture coordinate index for each corner."""
    points = [(sx * scale, height, sz * scale) for height, scale in RINGS for sx, sz in ((1, 1), (1, -1), (-1, -1), (-1, 1))]
    faces = [((3, 0), (2, 1), (1, 2)), ((3, 0), (1, 2), (0, 3))]  # the bottom, seen from below
    for ring in range(3):
        for side in range(4):
            a, b = 4 * ring + side, 4 * ring + (side + 1) % 4
            faces += [((a, 0), (b, 3), (b + 4, 2)), ((a, 0), (b + 4, 2), (a + 4, 1))]
    return points, faces


def normal(points, face):
    a, b, c = (points[i] for i, _ in face)
    u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
    n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    length = math.sqrt(sum(x * x for x in n))
    return tuple(x / length for x in n) if length > 1e-9 else (0.0, 1.0, 0.0)


def obj_text(points, faces):
    lines = ["# The demo keyframe set of tweend, made by make_barb.py", "o barb"]
    lines += [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in points]
    lines += ["vt 0 0", "vt 0 1", "vt 1 1", "vt 1 0"]
    lines += ["vn {:.6f} {:.6f} {:.6f}".format(*normal(points, face)) for face in faces]
    for number, face in enumerate(faces, 1):
        lines.append("f " + " ".join(f"{v + 1}/{vt + 1}/{number}" for v, vt in face))
    return "\n".join(lines) + "\n"


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(os.path.abspath(__file__)), "barb")
    os.makedirs(folder, exist_ok=True)
    points, faces = skeleton_mesh()
    for frame, angle in BENDS.items():
        with open(os.path.join(folder, f"barb_{frame:06d}.obj"), "w", encoding="ascii") as out:
            out.write(obj_text([bend(p, angle) for p in points], faces))


if __name__ == "__main__":
    main()
