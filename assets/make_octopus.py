#!/usr/bin/env python3
"""Makes the demo asset `octopus`: it dances a pirouette, its eight arms flung out. Run it to rewrite the folder octopus/.

It shows why the interpolation matters: there are only five keyframes for a whole turn, 60 to 85 degrees apart. Linear,
every vertex cuts the corners, so that arms and head shrink between two keyframes; Catmull-Rom leads them round.

Keyframes, for 18 frames a second: 0 crouched with its arms on the ground, 12 up on the tips of its arms, 24 in a leap with
the arms flung out, 36 still in the air with the arms up, 48 coming down; at 60 the loop is back at 0.
Metres, right-handed, +Y up, the lowest point of all keyframes a hand above y = 0, the axis on x = z = 0, eyes towards +Z at
frame 0; counter-clockwise fronts, quads and triangles. All is made of closed, smooth tubes that stick in one another: the
body, eight arms, two eyes. Texture coordinates: the picture's upper half goes around the body (its seam at the back);
below lies one arm, which all eight share, then an eye.
"""
import math
import os

from mesh import Mesh, add, cross, lerp, scale, smoothstep, tube_points, unit
from obj_writer import write_asset
from octopus_skin import ARM_BAND, ARM_LENGTH_M, BODY_BAND, EYE_DISC, arm_radius, texture

NAME = "octopus"
FRAMES = [0, 12, 24, 36, 48]
# The dance, a number for each keyframe. The steps of the turn are uneven on purpose: it winds up, then flings itself round.
TURN_DEG = [0, 60, 130, 215, 300]
HUB_M = [0.62, 1.30, 1.36, 1.16, 0.78]  # the height at which the arms meet
STRETCH = [0.90, 1.08, 1.06, 1.00, 0.97]  # of the body's height
PITCH_DEG = [-34, -62, -12, 14, -22]  # of the arms, up from level
TRAIL_DEG = [-8, 16, 52, 44, 12]  # how far the tips stay behind the turn, or run ahead of it
LEAN_DEG = (4, -10)  # of the body forwards, below and above: the head lies back

ARMS, ARM_RINGS, ARM_SIDES = 8, 22, 12
BODY_RINGS, BODY_SIDES = 24, 32
EYE_RINGS, EYE_SIDES, EYE_RADIUS_M = 9, 14, 0.15
GROUND_GAP_M = 0.1  # room for what Catmull-Rom swings out beyond the keyframes
EYES = [((side * 0.34, 0.30, 0.27), unit((side * 0.62, 0.12, 1.0))) for side in (-1, 1)]  # middle, where it looks

# The body's outline from below upwards: radius and height above the hub in metres.
OUTLINE = [(0.0, -0.24), (0.30, -0.19), (0.46, -0.03), (0.45, 0.14), (0.40, 0.30), (0.42, 0.48), (0.56, 0.74), (0.64, 1.00),
           (0.58, 1.24), (0.40, 1.42), (0.20, 1.50), (0.0, 1.52)]


class Pose:
    def __init__(self, key):
        self.turn = math.radians(TURN_DEG[key])
        self.hub_m = HUB_M[key]
        self.stretch = STRETCH[key]
        self.pitch = math.radians(PITCH_DEG[key])
        self.trail = math.radians(TRAIL_DEG[key])

    def place(self, point):
        """From the resting body to the world: stretched, leaning, turned, lifted."""
        x, y, z = point
        x, y, z = x / math.sqrt(self.stretch), y * self.stretch, z / math.sqrt(self.stretch)
        leaning = lean((x, y, z), math.radians(lerp(*LEAN_DEG, smoothstep(0.0, 1.3, y))))
        return add(turn(leaning, self.turn), (0.0, self.hub_m, 0.0))


def turn(point, angle):
    """About +Y, from +Z towards +X."""
    x, y, z = point
    c, s = math.cos(angle), math.sin(angle)
    return c * x + s * z, y, c * z - s * x


def lean(point, angle):
    """About +X, from +Y towards +Z."""
    x, y, z = point
    c, s = math.cos(angle), math.sin(angle)
    return x, c * y - s * z, c * z + s * y


def build_mesh():
    mesh = Mesh()
    mesh.add_tube(BODY_RINGS, BODY_SIDES, lambda row, side: (side / BODY_SIDES, lerp(*BODY_BAND, row / (BODY_RINGS + 1))))
    for _ in range(ARMS):
        mesh.add_tube(ARM_RINGS, ARM_SIDES, lambda row, side: (along_arm(row), lerp(*ARM_BAND, side / ARM_SIDES)))
    for _ in EYES:
        mesh.add_tube(EYE_RINGS, EYE_SIDES, eye_texcoord)
    return mesh


def positions(key):
    pose = Pose(key)
    points = tube_points(BODY_RINGS, BODY_SIDES, lambda row, angle: pose.place(body_point(row, angle)))
    for arm in range(ARMS):
        points += arm_points(pose, arm)
    for middle, gaze in EYES:
        points += tube_points(EYE_RINGS, EYE_SIDES, lambda row, angle: pose.place(eye_point(middle, gaze, row, angle)))
    return points


def body_point(row, angle):
    """The outline through its points, smoothly, once around from the back (-Z)."""
    place = row / (BODY_RINGS + 1) * (len(OUTLINE) - 1)
    i = min(int(place), len(OUTLINE) - 2)
    near = [OUTLINE[min(max(j, 0), len(OUTLINE) - 1)] for j in range(i - 1, i + 3)]
    u = place - i
    radius, height = (b + 0.5 * u * (c - a + u * (2 * a - 5 * b + 4 * c - d + u * (3 * (b - c) + d - a)))
                      for a, b, c, d in zip(*near))
    return -radius * math.sin(angle), height, -radius * math.cos(angle)


def arm_points(pose, arm):
    """An arm is a tube around a chain of short steps, each in a direction of its own."""
    azimuth = 2 * math.pi * (arm + 0.5) / ARMS
    steps = 4 * (ARM_RINGS + 1)
    at = (0.30 * math.sin(azimuth), -0.04, 0.30 * math.cos(azimuth))
    rings = []
    for step in range(steps + 1):
        s = step / steps
        ahead, back = arm_direction(pose, azimuth, s, 1 if arm % 2 else -1)
        if step % 4 == 0:
            rings.append((at, back, cross(ahead, back), arm_radius(along_arm(step // 4))))
        at = add(at, scale(ahead, ARM_LENGTH_M / steps))

    def point(row, angle):
        middle, back, sideways, radius = rings[row]
        offset = add(scale(back, radius * math.cos(angle)), scale(sideways, radius * math.sin(angle)))
        return pose.place(add(middle, offset))

    return tube_points(ARM_RINGS, ARM_SIDES, point)


def along_arm(row):
    return row / (ARM_RINGS + 1)


def arm_direction(pose, azimuth, s, other):
    """Unit vectors at s of the arm's length (0 to 1): ahead along it, and out of its back (the side without suckers).

    Every other arm (`other` is 1 or -1) is held higher, so that they don't all lie in one plane; the tips curl up.
    """
    pitch = pose.pitch + math.radians(13 * other + 14 - 40 * s + 62 * s ** 3)
    sideways = azimuth - pose.trail * s * (1 + 0.15 * other)
    flat = (math.sin(sideways), 0.0, math.cos(sideways))
    ahead = add(scale(flat, math.cos(pitch)), (0.0, math.sin(pitch), 0.0))
    back = add(scale(flat, -math.sin(pitch)), (0.0, math.cos(pitch), 0.0))
    return ahead, back


def eye_point(middle, gaze, row, angle):
    """A ball whose tube runs from the back of the eye to its pupil."""
    right = unit(cross((0.0, 1.0, 0.0), gaze))
    up = cross(gaze, right)
    polar = math.pi * (1 - row / (EYE_RINGS + 1))  # from the pupil
    around = add(scale(right, math.cos(angle)), scale(up, math.sin(angle)))
    direction = add(scale(gaze, math.cos(polar)), scale(around, math.sin(polar)))
    return add(middle, scale(direction, EYE_RADIUS_M))


def eye_texcoord(row, side):
    u, v, radius = EYE_DISC
    angle, out = 2 * math.pi * side / EYE_SIDES, radius * (1 - row / (EYE_RINGS + 1))
    return u + out * math.cos(angle), v + out * math.sin(angle)


def keyframes():
    poses = [positions(key) for key in range(len(FRAMES))]
    lowest = min(y for pose in poses for _, y, _ in pose)
    return {frame: [(x, y - lowest + GROUND_GAP_M, z) for x, y, z in pose] for frame, pose in zip(FRAMES, poses)}


if __name__ == "__main__":
    write_asset(os.path.join(os.path.dirname(os.path.abspath(__file__)), NAME), NAME, build_mesh(), keyframes(), texture())
