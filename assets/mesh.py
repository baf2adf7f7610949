"""A mesh whose faces never change while its vertices move: what every keyframe of an asset has in common.

Right-handed, +Y up, metres. A face is a list of corners `(v, vt, vn)`, indices from 0, counter-clockwise seen from outside.
Which corners share a `vn` decides what is shaded smoothly; the normals themselves follow from each keyframe's positions.
"""
import math


class Mesh:
    def __init__(self):
        self.faces = []
        self.texcoords = []  # (u, v), v upwards
        self.vertex_count = 0
        self.normal_count = 0

    def add_texcoord(self, uv):
        self.texcoords.append(uv)
        return len(self.texcoords) - 1

    def add_tube(self, rings, sides, texcoord):
        """A closed, smooth tube: a pole, `rings` rings of `sides` vertices around an axis, another pole, in this order.

        Angles turn right-handed about the axis from the first pole to the second. `texcoord(row, side)` is asked for rows 0
        (the first pole) to rings + 1 and for sides 0 to `sides`, the last being the seam; at a pole, for half sides.
        Returns the number of its first vertex; `tube_points` makes positions in the same order.
        """
        first = self.vertex_count
        self.vertex_count += rings * sides + 2
        self.normal_count = self.vertex_count
        last = self.vertex_count - 1
        seams = [[self.add_texcoord(texcoord(row, side)) for side in range(sides + 1)] for row in range(1, rings + 1)]

        def corner(row, side):
            v = first + 1 + (row - 1) * sides + side % sides
            return v, seams[row - 1][side], v

        for side in range(sides):
            for pole, row, a, b in ((first, 1, side + 1, side), (last, rings, side, side + 1)):
                vt = self.add_texcoord(texcoord(0 if pole == first else rings + 1, side + 0.5))
                self.faces.append([corner(row, a), corner(row, b), (pole, vt, pole)])
        for row in range(1, rings):
            for side in range(sides):
                self.faces.append([corner(row, side), corner(row, side + 1), corner(row + 1, side + 1), corner(row + 1, side)])
        return first

    def normals(self, positions):
        """A unit normal for each `vn`: its faces' normals, weighted by area."""
        sums = [[0.0, 0.0, 0.0] for _ in range(self.normal_count)]
        for face in self.faces:
            n = area_vector([positions[v] for v, _, _ in face])
            for _, _, vn in face:
                for axis in range(3):
                    sums[vn][axis] += n[axis]
        return [unit(n) for n in sums]


def tube_points(rings, sides, point):
    """Positions of a tube: `point(row, angle)` for each vertex of `Mesh.add_tube`, the angle in radians, 0 at the poles."""
    points = [point(0, 0.0)]
    for row in range(1, rings + 1):
        points += [point(row, 2 * math.pi * side / sides) for side in range(sides)]
    return points + [point(rings + 1, 0.0)]


def area_vector(polygon):
    """Along the polygon's normal (right-handed), as long as its area."""
    total = (0.0, 0.0, 0.0)
    for b, c in zip(polygon[1:], polygon[2:]):
        total = add(total, cross(sub(b, polygon[0]), sub(c, polygon[0])))
    return scale(total, 0.5)


def signed_volume(positions, faces):
    """Cubic metres; positive where the faces of a closed mesh look outwards. A face is a list of position indices."""
    volume = 0.0
    for face in faces:
        a = positions[face[0]]
        for b, c in zip(face[1:], face[2:]):
            volume += dot(a, cross(positions[b], positions[c])) / 6
    return volume


def add(a, b):
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def sub(a, b):
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def scale(a, factor):
    return a[0] * factor, a[1] * factor, a[2] * factor


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def unit(a):
    length = math.sqrt(dot(a, a))
    return scale(a, 1 / length)


def lerp(a, b, weight):
    """From a (weight 0) to b (weight 1)."""
    return a + (b - a) * weight


def mix(a, b, weight):
    """As lerp, componentwise; points and colours alike."""
    return tuple(lerp(x, y, weight) for x, y in zip(a, b))


def smoothstep(low, high, x):
    """0 below low, 1 above high, and without a kink in between."""
    t = min(1.0, max(0.0, (x - low) / (high - low)))
    return t * t * (3 - 2 * t)
