"""Closed, smooth triangle meshes of shapes that are described by their distance.

A shape is a function of a point (x, y, z) in metres: about the distance to the surface, negative inside, and nowhere steeper
than that. `net` walks a grid and puts one vertex into each cell which the surface crosses (Gibson's surface nets), then moves
it onto the surface itself, so that the grid is seen in the triangles' size only.
"""
import math

from mesh import add, dot, scale, sub, unit

BLOCK = 4  # cells: where the surface is far from a block's middle, none of them is looked at
CORNERS = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
EDGES = [(a, b) for a in range(8) for b in range(a + 1, 8) if sum(i != j for i, j in zip(CORNERS[a], CORNERS[b])) == 1]


def ball(middle, radii):
    """An ellipsoid along the axes."""
    def distance(p):
        x, y, z = ((p[i] - middle[i]) / radii[i] for i in range(3))
        outer, steep = math.sqrt(x * x + y * y + z * z), math.sqrt(sum((c / r) ** 2 for c, r in zip((x, y, z), radii)))
        return outer * (outer - 1) / steep if steep > 1e-9 else -min(radii)
    return distance


def limb(start, end, start_radius, end_radius, flat=(1.0, 1.0, 1.0)):
    """Round and tapering between two points; `flat` squeezes it about its start, by factors below 1, along the axes."""
    def squeeze(p):
        return tuple((p[i] - start[i]) / flat[i] for i in range(3))

    along = squeeze(end)
    length2 = dot(along, along)
    least = min(flat)

    def distance(p):
        off = squeeze(p)
        s = min(1.0, max(0.0, dot(off, along) / length2))
        return (math.dist(off, scale(along, s)) - (start_radius + (end_radius - start_radius) * s)) * least
    return distance


def puck(middle, axis, radius_x, radius_z, height):
    """A disc with a round edge across an axis, as a hem or a cuff; `height` is half of its own. Unless the radii are equal, the
    axis is +Y."""
    def distance(p):
        off = sub(p, middle)
        along = dot(off, axis)
        x, y, z = sub(off, scale(axis, along))
        outer = (math.hypot(x / radius_x, y / radius_x, z / radius_z) - 1) * min(radius_x, radius_z)
        return both(outer, abs(along) - height, 0.8 * height)
    return distance


def joined(shapes, softness):
    """The union; what is nearer than `softness` metres flows into one another."""
    def distance(p):
        nearest = shapes[0](p)
        for shape in shapes[1:]:
            other = shape(p)
            blend = max(0.0, softness - abs(nearest - other)) / softness
            nearest = min(nearest, other) - blend * blend * softness / 4
        return nearest
    return distance


def above(shape, height, rounding):
    """What of a shape lies above a level plane; the edge is rounded."""
    return lambda p: both(shape(p), height - p[1], rounding)


def both(a, b, rounding):
    """The distance to what two shapes have in common, from the distances to each; the edge is rounded."""
    a, b = a + rounding, b + rounding
    return min(max(a, b), 0.0) + math.hypot(max(a, 0.0), max(b, 0.0)) - rounding


def slope(shape, p, step=1e-4):
    """The unit normal of a shape's surface near p."""
    n = (0.0, 0.0, 0.0)
    for way in ((1, -1, -1), (-1, -1, 1), (-1, 1, -1), (1, 1, 1)):
        n = add(n, scale(way, shape(add(p, scale(way, step)))))
    return unit(n)


def net(shape, low, high, cell):
    """The surface within the box from `low` to `high`: positions, normals, triangles (counter-clockwise from outside)."""
    values = {}

    def value(i, j, k):
        key = (i, j, k)
        if key not in values:
            values[key] = shape((low[0] + i * cell, low[1] + j * cell, low[2] + k * cell))
        return values[key]

    places, vertices = {}, []
    for at in crossed_cells(shape, low, high, cell):
        inside = [value(at[0] + x, at[1] + y, at[2] + z) for x, y, z in CORNERS]
        if min(inside) < 0 <= max(inside):
            places[at] = len(vertices)
            vertices.append(onto(shape, add(low, scale(add(at, middle_of(inside)), cell))))
    normals = [slope(shape, p) for p in vertices]
    return vertices, normals, triangles(places, vertices, value)


def crossed_cells(shape, low, high, cell):
    """The cells that the surface may cross, in a fixed order."""
    blocks = [math.ceil((high[axis] - low[axis]) / cell / BLOCK) for axis in range(3)]
    reach = BLOCK * cell * math.sqrt(3) / 2 * 1.3  # half a block's diagonal, and some for distances that are not exact
    for bx in range(blocks[0]):
        for by in range(blocks[1]):
            for bz in range(blocks[2]):
                corner = (bx * BLOCK, by * BLOCK, bz * BLOCK)
                middle = add(low, scale(add(corner, (BLOCK / 2,) * 3), cell))
                if abs(shape(middle)) < reach:
                    yield from (add(corner, (x, y, z)) for x in range(BLOCK) for y in range(BLOCK) for z in range(BLOCK))


def middle_of(inside):
    """Of the points where a cell's edges are crossed, in cells."""
    total, count = (0.0, 0.0, 0.0), 0
    for a, b in EDGES:
        if (inside[a] < 0) != (inside[b] < 0):
            s = inside[a] / (inside[a] - inside[b])
            total = add(total, add(CORNERS[a], scale(sub(CORNERS[b], CORNERS[a]), s)))
            count += 1
    return scale(total, 1 / count)


def onto(shape, p):
    for _ in range(3):
        p = sub(p, scale(slope(shape, p), shape(p)))
    return p


def triangles(places, vertices, value):
    """Two for each edge of the grid that is crossed: the four cells around it have a vertex each."""
    found = []
    for i, j, k in places:
        for axis in range(3):
            u, v = [(axis + 1) % 3, (axis + 2) % 3]
            step = [0, 0, 0]
            step[axis] = 1
            first, last = value(i, j, k) < 0, value(i + step[0], j + step[1], k + step[2]) < 0
            if first == last:
                continue
            around = []
            for back_u, back_v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                at = [i, j, k]
                at[u] -= back_u
                at[v] -= back_v
                around.append(places[tuple(at)])
            found += halves(around if first else around[::-1], vertices)
    return found


def halves(quad, vertices):
    a, b, c, d = quad
    if math.dist(vertices[a], vertices[c]) <= math.dist(vertices[b], vertices[d]):
        return [(a, b, c), (a, c, d)]
    return [(a, b, d), (b, c, d)]
