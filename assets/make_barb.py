#!/usr/bin/env python3
"""Makes the demo asset `barb`: a spike that bends towards the ground and back. Run it to rewrite the folder barb/.

The recipe: a cube of 2 m whose top face is extruded, so that connected cubes stand one on top of each other; the rings
at 0, 2, 4 and 6 m of height are scaled 1, 0.75, 0.5 and 0, the topmost being four vertices in one tip. A chain of three
bones stands in it; the lowest stays put, the middle one (from 2 m) and the top one (from 4 m) bend towards +X.

Beyond the recipe, each cube has four rings instead of one and each edge of a ring two halves, so that the bends are
round and the texture is not sheared. The four sides are shaded smoothly along the spike and keep crisp edges.

Keyframes, for 24 frames a second: 0 upright, 10 bent, 20 bent to the ground, 30 as 10; at 40 the loop is back at 0.
Metres, right-handed, +Y up, bottom at y = 0, counter-clockwise fronts, triangles. Texture coordinates: the sides side by side
in the lower three quarters of the picture, the bottom above them, all at the same scale.
"""
import math
import os

from mesh import Mesh, lerp, mix, smoothstep
from obj_writer import write_asset

NAME = "barb"
RING_SCALES = [1.0, 0.75, 0.5, 0.0]  # at 0, 2, 4 and 6 m
CUBE_M = 2.0
ROWS_PER_CUBE = 4
HALVES = 2  # of a ring's edge
ROWS = 3 * ROWS_PER_CUBE  # the row of this number is the tip
AROUND = 4 * HALVES

FIRST_JOINT_M, SECOND_JOINT_M = 2.0, 4.0  # heights at which the middle and the top bone begin
JOINT_REACH_M = 1.1  # how far from a joint both its bones pull: about as far as automatic weights spread here
BENDS_DEG = {0: (0, 0), 10: (50, 66), 20: (90, 70), 30: (50, 66)}  # frame: the middle bone, the top bone against it

CORNERS = [(1, 1), (1, -1), (-1, -1), (-1, 1)]  # x, z: counter-clockwise seen from above
TEXTURE_M = 8.0  # the picture's width and height


def ring_scale(height_m):
    cube = min(2, int(height_m / CUBE_M))
    return lerp(RING_SCALES[cube], RING_SCALES[cube + 1], height_m / CUBE_M - cube)


def build_mesh():
    """Vertices: the rows from the bottom, each counter-clockwise from the corner (1, 1), four tips, the bottom's middle."""
    mesh = Mesh()
    tips = ROWS * AROUND
    mesh.vertex_count = tips + 4 + 1
    for side in range(4):
        add_side(mesh, side, tips + side)
    add_bottom(mesh, tips + 4)
    return mesh


def add_side(mesh, side, tip):
    columns = HALVES + 1
    first_vn = mesh.normal_count  # of this side alone: that keeps the edges crisp
    mesh.normal_count += ROWS * columns + 1

    def corner(row, column):
        height_m = CUBE_M * row / ROWS_PER_CUBE
        along = 2 * column / HALVES - 1
        u = (2 * side + 1 + along * ring_scale(height_m)) / TEXTURE_M
        vt = mesh.add_texcoord((u, height_m / TEXTURE_M))
        if row == ROWS:
            return tip, vt, first_vn + ROWS * columns
        return row * AROUND + (side * HALVES + column) % AROUND, vt, first_vn + row * columns + column

    corners = {(row, column): corner(row, column) for row in range(ROWS) for column in range(columns)}
    corners.update({(ROWS, column): corner(ROWS, 0) for column in range(columns)})
    for row in range(ROWS):
        for column in range(HALVES):
            a, b = corners[row, column], corners[row, column + 1]
            d, c = corners[row + 1, column], corners[row + 1, column + 1]
            mesh.faces += [[a, b, c], [a, c, d]] if row + 1 < ROWS else [[a, b, c]]


def add_bottom(mesh, middle):
    vn = mesh.normal_count
    mesh.normal_count += 1
    rim = []
    for v in range(AROUND):
        x, z = ring_point(0.0, v)
        rim.append((v, mesh.add_texcoord(((x + 1) / TEXTURE_M, (z + 7) / TEXTURE_M)), vn))
    middle = (middle, mesh.add_texcoord((1 / TEXTURE_M, 7 / TEXTURE_M)), vn)
    for a, b in zip(rim, rim[1:] + rim[:1]):
        mesh.faces.append([b, a, middle])


def ring_point(height_m, place):
    """x and z of a ring's vertex while the spike is upright."""
    side, half = divmod(place, HALVES)
    x, z = mix(CORNERS[side], CORNERS[(side + 1) % 4], half / HALVES)
    return x * ring_scale(height_m), z * ring_scale(height_m)


def positions(middle_deg, top_deg):
    points = []
    for row in range(ROWS + 1):
        height_m = CUBE_M * row / ROWS_PER_CUBE
        for place in range(AROUND if row < ROWS else 4):
            x, z = ring_point(height_m, place)
            points.append(skin((x, height_m, z), math.radians(middle_deg), math.radians(top_deg)))
    return points + [(0.0, 0.0, 0.0)]


def skin(point, middle_rad, top_rad):
    """Linear blend skinning: the mean of where the three bones take the point, weighted by how near it is to each."""
    x, y, z = point
    above_first = smoothstep(FIRST_JOINT_M - JOINT_REACH_M, FIRST_JOINT_M + JOINT_REACH_M, y)
    above_second = smoothstep(SECOND_JOINT_M - JOINT_REACH_M, SECOND_JOINT_M + JOINT_REACH_M, y)
    by_middle = lean(point, FIRST_JOINT_M, middle_rad)
    by_top = lean(lean(point, SECOND_JOINT_M, top_rad), FIRST_JOINT_M, middle_rad)
    return mix(mix(point, by_middle, above_first), by_top, above_second)


def lean(point, joint_m, angle):
    """A turn about the joint from +Y towards +X."""
    x, y, z = point
    c, s = math.cos(angle), math.sin(angle)
    return c * x + s * (y - joint_m), joint_m - s * x + c * (y - joint_m), z


def texture(size=512):
    """Night blue at the bottom, sand at the tip; a line every half metre shows how the spike stretches."""
    return [[texel((column + 0.5) / size * TEXTURE_M, (size - row - 0.5) / size * TEXTURE_M) for column in range(size)]
            for row in range(size)]


def texel(x_m, y_m):
    if y_m > 6.0:  # the bottom
        return mix((0.10, 0.13, 0.22), (0.16, 0.22, 0.33), abs(x_m - 1) / 8)
    stops = [(0.13, 0.20, 0.36), (0.10, 0.45, 0.52), (0.47, 0.70, 0.55), (0.97, 0.80, 0.46), (0.99, 0.93, 0.80)]
    place = y_m / 6.0 * (len(stops) - 1)
    stop = min(len(stops) - 2, int(place))
    colour = mix(stops[stop], stops[stop + 1], place - stop)
    colour = mix(colour, (0.04, 0.07, 0.14), 0.45 * line(y_m, 0.5, 0.03) + 0.4 * line(y_m, 2.0, 0.07))
    across = abs(x_m % 2 - 1) / max(ring_scale(y_m), 1e-3)  # 0 in the middle of a side, 1 at its edges
    colour = mix(colour, (0.04, 0.07, 0.14), 0.35 * (1 - smoothstep(0.012, 0.03, across * ring_scale(y_m))))
    return mix(colour, (1.0, 0.97, 0.88), 0.5 * smoothstep(0.90, 0.97, across))


def line(x_m, every_m, half_width_m):
    """1 on lines a distance apart, 0 between them."""
    off = abs((x_m + every_m / 2) % every_m - every_m / 2)
    return 1 - smoothstep(half_width_m * 0.6, half_width_m * 1.2, off)


def keyframes():
    return {frame: positions(*bend) for frame, bend in BENDS_DEG.items()}


if __name__ == "__main__":
    write_asset(os.path.join(os.path.dirname(os.path.abspath(__file__)), NAME), NAME, build_mesh(), keyframes(), texture())
