"""The walker's joints. At rest every joint's axes are the world's, so only places are needed: metres, +Y up, facing +Z.

The arms are held down by 40 degrees from level, halfway between hanging and raised, where a shoulder bends best.
"""
import math

from mesh import scale, sub

ARM_DOWN = math.radians(40)
HIP_WIDTH_M, HIP_HEIGHT_M = 0.095, 0.925
KNEE_HEIGHT_M, ANKLE_HEIGHT_M = 0.505, 0.085
TOES = (0.030, 0.105)  # the height of the joint of the toes, and how far it lies before the ankle
UPPER_ARM_M, LOWER_ARM_M = 0.275, 0.245
SHOULDER = (0.175, 1.415, -0.01)


def arm_direction(side):
    """From the shoulder to the hand at rest; `side` is 1 on the left, which is +X, and -1 on the right."""
    return side * math.cos(ARM_DOWN), -math.sin(ARM_DOWN), 0.0


def along_arm(side, metres):
    return tuple(a + b for a, b in zip((side * SHOULDER[0], *SHOULDER[1:]), scale(arm_direction(side), metres)))


def limbs(suffix, side):
    hip = side * HIP_WIDTH_M
    return [
        (f"shoulder_{suffix}", "chest", (side * 0.035, 1.425, 0.0)),
        (f"upper_arm_{suffix}", f"shoulder_{suffix}", along_arm(side, 0.0)),
        (f"lower_arm_{suffix}", f"upper_arm_{suffix}", along_arm(side, UPPER_ARM_M)),
        (f"hand_{suffix}", f"lower_arm_{suffix}", along_arm(side, UPPER_ARM_M + LOWER_ARM_M)),
        (f"upper_leg_{suffix}", "hips", (hip, HIP_HEIGHT_M, 0.0)),
        (f"lower_leg_{suffix}", f"upper_leg_{suffix}", (hip, KNEE_HEIGHT_M, 0.0)),
        (f"foot_{suffix}", f"lower_leg_{suffix}", (hip, ANKLE_HEIGHT_M, 0.0)),
        (f"toes_{suffix}", f"foot_{suffix}", (hip, *TOES)),
    ]


JOINTS = [  # name, parent, place; parents stand before their children
    ("hips", None, (0.0, 0.965, 0.0)),
    ("spine", "hips", (0.0, 1.06, 0.0)),
    ("chest", "spine", (0.0, 1.21, 0.0)),
    ("neck", "chest", (0.0, 1.465, -0.012)),
    ("head", "neck", (0.0, 1.545, 0.0)),
    *limbs("l", 1), *limbs("r", -1),
]
NAMES = [name for name, _, _ in JOINTS]
PARENTS = {name: parent for name, parent, _ in JOINTS}
PLACES = {name: place for name, _, place in JOINTS}


def offset(name):
    """From the parent's place."""
    parent = PARENTS[name]
    return sub(PLACES[name], PLACES[parent]) if parent else PLACES[name]
