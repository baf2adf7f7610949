"""The octopus' texture, painted where its mesh puts body, arms and eyes in the picture."""
import math
import random

from mesh import mix, smoothstep

BODY_BAND = (0.51, 0.99)  # v from the bottom of the body to its top; u goes once around it
ARM_BAND = (0.20, 0.49)  # v once around an arm, its underside in the middle; u from the body to the tip
EYE_DISC = (0.10, 0.09, 0.08)  # the middle's u and v, and the radius: a ball flattened around its pupil
ARM_LENGTH_M = 1.75

PLUM, CORAL, APRICOT, CREAM = (0.36, 0.10, 0.30), (0.88, 0.34, 0.28), (0.98, 0.62, 0.40), (1.0, 0.88, 0.74)


def arm_radius(s):
    """Metres, at s of the arm's length (0 to 1)."""
    return 0.20 * (0.12 + 0.86 * (1 - s) ** 1.1) * math.sqrt(max(0.0, 1 - s ** 12))


def texture(size=512):
    rows = []
    for row in range(size):
        v = 1 - (row + 0.5) / size
        paint = body_colour if v > 0.5 else arm_colour if v > 0.19 else eye_colour
        rows.append([paint((column + 0.5) / size, v) for column in range(size)])
    paint_spots(rows, size)
    return rows


def body_colour(u, v):
    height = (v - BODY_BAND[0]) / (BODY_BAND[1] - BODY_BAND[0])
    colour = mix(CREAM, CORAL, smoothstep(0.05, 0.22, height))
    return mix(colour, PLUM, 0.8 * smoothstep(0.45, 1.0, height))


def arm_colour(u, v):
    """Coral at the body as the body is there, plum towards the tip; cream below, with two rows of suckers."""
    around = (v - ARM_BAND[0]) / (ARM_BAND[1] - ARM_BAND[0])
    below = 1 - smoothstep(0.17, 0.25, abs(around - 0.5))
    back = mix(CORAL, PLUM, smoothstep(0.15, 1.0, u))
    colour = mix(back, mix(CREAM, APRICOT, u), below)
    radius = max(arm_radius(min(u, 0.97)), 0.01)
    # Round on the arm, not in the picture: distances are metres on its skin.
    off_m = abs(around - 0.5) * 2 * math.pi * radius - 0.47 * radius  # from the middle of the sucker's row
    along_m = nearest_sucker(u, around > 0.5) * ARM_LENGTH_M
    out = math.hypot(off_m, along_m) / (0.34 * radius)
    rim = 1 - smoothstep(0.82, 1.0, out)
    colour = mix(colour, (0.78, 0.36, 0.38), 0.8 * rim)
    return mix(colour, (1.0, 0.84, 0.74), 1 - smoothstep(0.50, 0.68, out))


SUCKERS = [0.06]  # at which parts of the arm's length; closer where the arm is thinner
while SUCKERS[-1] < 0.93:
    SUCKERS.append(SUCKERS[-1] + 0.85 * arm_radius(SUCKERS[-1]) / ARM_LENGTH_M)


def nearest_sucker(u, second_row):
    """How far the nearest sucker is, in arm lengths; the rows alternate."""
    return min(abs(u - place) for place in SUCKERS[second_row::2])


def eye_colour(u, v):
    """A golden eye with a lying pupil, the skin's colour around it."""
    x, y = (u - EYE_DISC[0]) / EYE_DISC[2], (v - EYE_DISC[1]) / EYE_DISC[2]
    out = math.hypot(x, y)
    iris = mix((1.0, 0.86, 0.45), (0.86, 0.52, 0.16), smoothstep(0.05, 0.36, out))
    pupil = math.hypot(max(0.0, abs(x) - 0.14), y)
    colour = mix((0.05, 0.03, 0.06), iris, smoothstep(0.075, 0.10, pupil))
    colour = mix(colour, (0.98, 0.96, 0.90), smoothstep(0.34, 0.38, out))
    return mix(colour, mix(CORAL, PLUM, 0.35), smoothstep(0.48, 0.53, out))


def paint_spots(rows, size):
    """Pale rings and dark freckles on the body's upper part and the arms' backs, the same at each run."""
    dice = random.Random(8)
    for _ in range(70):
        stamp(rows, size, dice.random(), 0.70 + 0.24 * dice.random(), 0.010 + 0.014 * dice.random(), APRICOT, 0.55)
    for _ in range(90):
        stamp(rows, size, dice.random(), 0.60 + 0.30 * dice.random(), 0.004 + 0.004 * dice.random(), PLUM, 0.5)
    for _ in range(60):
        around = 0.055 * dice.random()
        v = ARM_BAND[0] + around if dice.random() < 0.5 else ARM_BAND[1] - around
        stamp(rows, size, 0.12 + 0.75 * dice.random(), v, 0.005 + 0.008 * dice.random(), APRICOT, 0.5)


def stamp(rows, size, u, v, radius, colour, strength):
    """A soft dot; it wraps around in u."""
    column, row, reach = u * size, (1 - v) * size, radius * size
    for y in range(int(row - reach), int(row + reach) + 2):
        for x in range(int(column - reach), int(column + reach) + 2):
            out = math.hypot(x + 0.5 - column, y + 0.5 - row) / reach
            rows[y][x % size] = mix(rows[y][x % size], colour, strength * (1 - smoothstep(0.7, 1.0, out)))
