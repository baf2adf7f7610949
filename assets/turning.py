"""Rotations as unit quaternions (x, y, z, w), as glTF has them. Angles in radians, right-handed."""
import math

from mesh import add, cross, dot, scale, unit

STILL = (0.0, 0.0, 0.0, 1.0)
X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


def about(axis, angle):
    s = math.sin(angle / 2)
    x, y, z = unit(axis)
    return x * s, y * s, z * s, math.cos(angle / 2)


def after(*turns):
    """One turn for several; the last is carried out first, as in a product of matrices."""
    total = STILL
    for turn in turns:
        a, b = total[:3], turn[:3]
        vector = add(add(scale(b, total[3]), scale(a, turn[3])), cross(a, b))
        total = (*vector, total[3] * turn[3] - dot(a, b))
    return total


def back(turn):
    x, y, z, w = turn
    return -x, -y, -z, w


def turned(turn, point):
    v, w = turn[:3], turn[3]
    twice = scale(cross(v, point), 2)
    return add(add(point, scale(twice, w)), cross(v, twice))


def of_axes(x, y, z):
    """The turn that takes the axes of the world to these three, which are right-handed and orthonormal."""
    trace = x[0] + y[1] + z[2]
    rows = ((x[0], y[0], z[0]), (x[1], y[1], z[1]), (x[2], y[2], z[2]))
    if trace > 0:
        s = math.sqrt(trace + 1) * 2
        return (rows[2][1] - rows[1][2]) / s, (rows[0][2] - rows[2][0]) / s, (rows[1][0] - rows[0][1]) / s, s / 4
    i = max(range(3), key=lambda axis: rows[axis][axis])
    j, k = (i + 1) % 3, (i + 2) % 3
    s = math.sqrt(1 + rows[i][i] - rows[j][j] - rows[k][k]) * 2
    q = [0.0, 0.0, 0.0, (rows[k][j] - rows[j][k]) / s]
    q[i], q[j], q[k] = s / 4, (rows[j][i] + rows[i][j]) / s, (rows[k][i] + rows[i][k]) / s
    return tuple(q)


def near(turn, before):
    """The same turn with the sign that is nearer to another: neighbours of a track should be."""
    return tuple(-c for c in turn) if sum(a * b for a, b in zip(turn, before)) < 0 else turn


def normalised(turn):
    length = math.sqrt(sum(c * c for c in turn))
    return tuple(c / length for c in turn)
