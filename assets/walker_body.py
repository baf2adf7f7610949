"""The walker's shape and colours: closed surfaces that stick in one another, one for each piece of cloth or skin, so that the
borders between colours are crisp. Metres, at rest."""
import copy
import math

from mesh import add, mix, scale, smoothstep
from surface import above, ball, both, joined, limb, net, puck
from walker_skeleton import (ANKLE_HEIGHT_M, HIP_HEIGHT_M, HIP_WIDTH_M, KNEE_HEIGHT_M, LOWER_ARM_M, SHOULDER, UPPER_ARM_M,
                             along_arm, arm_direction)

Y = (0.0, 1.0, 0.0)
SKIN, BLUSH, LIPS = (0.93, 0.68, 0.53), (0.93, 0.56, 0.45), (0.62, 0.24, 0.24)
HAIR, EYE, GLINT = (0.23, 0.13, 0.10), (0.10, 0.07, 0.09), (1.0, 1.0, 1.0)
SWEATER, TRIM = (0.97, 0.66, 0.20), (0.88, 0.34, 0.28)
DENIM, DENIM_SHADE, DENIM_INSIDE = (0.20, 0.31, 0.50), (0.15, 0.23, 0.40), (0.33, 0.46, 0.66)
SHOE, SOLE = (0.95, 0.93, 0.90), (0.30, 0.62, 0.62)

HEAD = (0.0, 1.662, 0.012)
EYE_AT = (0.043, 1.668, 0.120)  # the left one's
MOUTH_HEIGHT_M = 1.590
WRIST_M = UPPER_ARM_M + LOWER_ARM_M


class Part:
    """A surface with one paint. `arms`, `legs`, `head`: which of the joints pull at it, beside those of the trunk."""

    def __init__(self, name, shape, low, high, cell, paint, **pulled_by):
        self.name, self.paint, self.pulled_by = name, paint, pulled_by
        self.positions, self.normals, self.faces = net(shape, low, high, cell)

    def mirrored(self):
        """The same on the other side."""
        other = copy.copy(self)
        other.positions, other.normals = ([(-x, y, z) for x, y, z in rows] for rows in (self.positions, self.normals))
        other.faces = [(a, c, b) for a, b, c in self.faces]
        return other


def parts():
    """All of them; those of the limbs for one side after the other."""
    made = [
        Part("sweater", sweater(), (-0.62, 0.90, -0.17), (0.62, 1.56, 0.17), 0.0265, lambda p: SWEATER, arms=True, legs=True),
        Part("hem", puck((0, 0.958, 0.0), Y, 0.190, 0.147, 0.026), (-0.23, 0.90, -0.18), (0.23, 1.01, 0.18), 0.0260,
             lambda p: TRIM, legs=True),
        Part("collar", puck((0, 1.508, -0.010), Y, 0.073, 0.071, 0.017), (-0.1, 1.46, -0.1), (0.1, 1.55, 0.1), 0.0150,
             lambda p: TRIM),
        Part("trousers", trousers(), (-0.22, 0.05, -0.16), (0.22, 1.10, 0.16), 0.0275, denim, legs=True),
        Part("head", head(), (-0.15, 1.36, -0.15), (0.15, 1.82, 0.17), 0.0175, skin, head=True),
        Part("hair", hair(), (-0.16, 1.53, -0.16), (0.16, 1.84, 0.16), 0.0195, lambda p: HAIR, head=True),
        Part("mouth", mouth(), (-0.06, 1.56, 0.06), (0.06, 1.63, 0.15), 0.0050, lambda p: LIPS, head=True),
    ]
    left = limb_parts(1)
    return made + left + [part.mirrored() for part in left]


def limb_parts(side):
    hand_at, foot_at = along_arm(side, WRIST_M + 0.08), side * HIP_WIDTH_M
    turn_up = (foot_at, 0.106, 0.002)
    eye = (side * EYE_AT[0], *EYE_AT[1:])
    glint = add(eye, (0.0, 0.011, 0.0095))
    brow = limb(add(eye, (-side * 0.017, 0.0400, 0.003)), add(eye, (side * 0.019, 0.0405, -0.010)), 0.0058, 0.0045)
    return [
        Part("hand", hand(side), add(hand_at, (-0.14, -0.15, -0.08)), add(hand_at, (0.14, 0.13, 0.10)), 0.0145,
             lambda p: SKIN, arms=True),
        Part("cuff", puck(along_arm(side, WRIST_M - 0.022), arm_direction(side), 0.053, 0.053, 0.024), *around(along_arm(side, WRIST_M - 0.022), 0.075), 0.0150, lambda p: TRIM, arms=True),
        Part("turn-up", puck(turn_up, Y, 0.064, 0.072, 0.020), *around(turn_up, 0.09), 0.0185, lambda p: DENIM_INSIDE,
             legs=True),
        Part("shoe", shoe(side), (foot_at - 0.08, -0.01, -0.12), (foot_at + 0.08, 0.17, 0.25), 0.0170, lambda p: SHOE,
             foot=True),
        Part("sole", sole(side), (foot_at - 0.08, -0.01, -0.12), (foot_at + 0.08, 0.06, 0.25), 0.0165, lambda p: SOLE,
             foot=True),
        Part("eye", ball(eye, (0.0150, 0.0225, 0.0105)), *around(eye, 0.03), 0.0065, lambda p: EYE, head=True),
        Part("glint", ball(glint, (0.0042, 0.0050, 0.0030)), *around(glint, 0.01), 0.0030, lambda p: GLINT, head=True),
        Part("brow", brow, *around(add(eye, (0, 0.037, 0)), 0.04), 0.0052, lambda p: HAIR, head=True),
    ]


def around(middle, reach):
    return add(middle, (-reach,) * 3), add(middle, (reach,) * 3)


def sweater():
    trunk = joined([
        ball((0, 1.29, 0.004), (0.178, 0.215, 0.122)),
        limb((0, 0.95, 0.0), (0, 1.22, 0.0), 0.180, 0.152, (1.0, 1.0, 0.76)),
        limb((-0.125, 1.405, -0.008), (0.125, 1.405, -0.008), 0.066, 0.066),
        limb((0, 1.36, -0.01), (0, 1.44, -0.01), 0.085, 0.058),
    ], 0.09)
    sleeves = [limb(along_arm(side, -0.01), along_arm(side, WRIST_M - 0.045), 0.068, 0.043) for side in (1, -1)]
    return above(joined([trunk, *sleeves], 0.055), 0.945, 0.012)


def trousers():
    legs = []
    for side in (1, -1):
        hip, knee, ankle = ((side * HIP_WIDTH_M, y, 0.0) for y in (HIP_HEIGHT_M, KNEE_HEIGHT_M, ANKLE_HEIGHT_M))
        upper = limb(add(hip, (-side * 0.006, -0.02, -0.004)), knee, 0.084, 0.066)
        lower = limb(knee, add(ankle, (0, 0.0, -0.008)), 0.066, 0.057)
        calf = ball(add(knee, (0, -0.12, -0.016)), (0.058, 0.13, 0.058))
        legs.append(joined([upper, lower, calf], 0.04))
    seat = ball((0, 0.965, -0.008), (0.158, 0.112, 0.115))
    return above(joined([seat, *legs], 0.04), 0.080, 0.010)


def head():
    return joined([
        ball(HEAD, (0.108, 0.136, 0.120)),
        ball((0, 1.600, 0.030), (0.078, 0.076, 0.082)),
        limb((0, 1.44, -0.014), (0, 1.58, -0.004), 0.056, 0.052),
        limb((0, 1.652, 0.128), (0, 1.634, 0.137), 0.009, 0.0135),
        ball((0.110, 1.648, -0.004), (0.016, 0.031, 0.021)),
        ball((-0.110, 1.648, -0.004), (0.016, 0.031, 0.021)),
    ], 0.022)


def hair():
    """A cap that leaves the face free, with a parting's volume above the forehead."""
    whole = joined([
        ball((0, 1.682, -0.006), (0.122, 0.134, 0.124)),
        limb((-0.060, 1.772, 0.062), (0.058, 1.778, 0.066), 0.036, 0.044),
    ], 0.05)
    face = limb((0, 1.60, 0.16), (0, 1.700, 0.13), 0.115, 0.098, (1.0, 1.0, 0.92))
    below = 1.585

    def distance(p):
        lowest = below + 0.06 * smoothstep(-0.06, 0.06, p[2])  # higher before the ears
        return -joined([lambda q: -max(whole(q), (lowest - q[1]) * 0.8), face], 0.02)(p)
    return distance


def mouth():
    """A smile's arc on the face."""
    face = head()

    def distance(p):
        end = max(0.0, abs(p[0]) - 0.028)
        return (math.hypot(p[1] - smile(p[0]), face(p) - 0.001, end) - 0.0056) * 0.8
    return distance


def smile(x):
    return MOUTH_HEIGHT_M + 9.0 * x * x


def hand(side):
    forwards = (0.0, 0.0, 1.0)
    out = arm_direction(side)
    wrist = along_arm(side, WRIST_M)

    def at(metres, front):
        return add(wrist, add(scale(out, metres), scale(forwards, front)))

    fingers = [limb(at(0.085, 0.027 - 0.018 * i), at(length, 0.030 - 0.0185 * i), 0.0145, 0.0115)
               for i, length in enumerate((0.152, 0.166, 0.160, 0.138))]
    return joined([
        limb(at(-0.06, 0.0), at(0.02, 0.0), 0.030, 0.028),
        limb(at(0.03, 0.012), at(0.075, 0.010), 0.031, 0.028, (1.0, 1.0, 1.0)),
        limb(at(0.03, -0.008), at(0.075, -0.016), 0.029, 0.025),
        limb(at(0.025, 0.025), at(0.085, 0.062), 0.018, 0.0125),
        *fingers,
    ], 0.018)


def shoe(side):
    x = side * HIP_WIDTH_M
    return above(joined([
        limb((x, 0.045, -0.025), (x, 0.030, 0.155), 0.046, 0.042, (0.98, 1.0, 1.0)),
        limb((x, 0.110, -0.008), (x, 0.050, 0.010), 0.046, 0.049),
        limb((x, 0.075, 0.03), (x, 0.040, 0.13), 0.042, 0.036),
    ], 0.035), 0.012, 0.010)


def sole(side):
    x, thick = side * HIP_WIDTH_M, 0.014
    flat = limb((x, thick, -0.027), (x, thick, 0.157), 0.0500, 0.0475)
    return lambda p: both(flat(p), abs(p[1] - thick) - thick, 0.010)


def skin(p):
    cheek = min(math.dist(p, (side * 0.066, 1.622, 0.098)) for side in (1, -1))
    return mix(BLUSH, SKIN, smoothstep(0.008, 0.046, cheek))


def denim(p):
    """A little darker inside and below."""
    return mix(DENIM_SHADE, DENIM, smoothstep(0.02, 0.11, abs(p[0])) * smoothstep(0.05, 0.35, p[1]))
