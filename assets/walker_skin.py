"""Which joints pull at a vertex of the walker, and how strongly.

Going out from the hips, each joint takes a share of what its parent is left with, rising smoothly across the place of the
joint; what is not passed on stays. So the weights of a vertex sum to 1 and change smoothly over the skin.
"""
import math

from mesh import dot, scale, smoothstep, sub
from walker_skeleton import JOINTS, PLACES, arm_direction

INFLUENCES = 4  # as glTF's first set has them
STEPS = 255  # weights are stored as bytes


def rise(x, width):
    """From 0 to 1 over `width` before and behind 0."""
    return smoothstep(-width, width, x)


def share(joint, p, pulled_by):
    """What a joint takes of its parent's share at p, 0 to 1."""
    name, side = (joint[:-2], 1 if joint.endswith("_l") else -1) if joint[-2:] in ("_l", "_r") else (joint, 0)
    off = sub(p, PLACES[joint])
    if name in ("spine", "chest"):
        return 1.0 if pulled_by.get("head") or in_arm(p, pulled_by) > 0.5 else rise(off[1], 0.08)
    if name in ("neck", "head"):
        return rise(off[1], 0.03) if pulled_by.get("head") else 0.0
    if name == "shoulder":
        return max(0.6 * rise(side * p[0] - 0.09, 0.06) * rise(p[1] - 1.36, 0.06), in_arm(p, pulled_by, side))
    if name == "upper_arm":
        return in_arm(p, pulled_by, side)
    if name in ("lower_arm", "hand"):
        return rise(dot(off, arm_direction(side)), 0.05 if name == "lower_arm" else 0.022)
    return leg_share(name, side, p, off, pulled_by)


def in_arm(p, pulled_by, side=0):
    """Whether p belongs to an arm, 0 to 1: beyond the shoulder, and not far from the arm's middle."""
    if not pulled_by.get("arms"):
        return 0.0
    if side == 0:
        return in_arm(p, pulled_by, 1 if p[0] > 0 else -1)
    off = sub(p, PLACES["upper_arm_l" if side > 0 else "upper_arm_r"])
    along = dot(off, arm_direction(side))
    radial = math.sqrt(max(0.0, dot(off, off) - along * along))
    return rise(along - 0.005, 0.065) * (1 - smoothstep(0.085, 0.15, radial))


def leg_share(name, side, p, off, pulled_by):
    if pulled_by.get("foot"):
        return rise(off[2], 0.022) if name == "toes" else 1.0 if side * p[0] > 0 else 0.0
    if name in ("foot", "toes") or not pulled_by.get("legs"):
        return 0.0
    if name == "lower_leg":
        return rise(-off[1], 0.065)
    return rise(0.905 - p[1], 0.085) * rise(side * p[0], 0.028) * (1 - in_arm(p, pulled_by))


def weights(p, pulled_by):
    """{number of the joint: weight}; the weights sum to 1."""
    left, found = {"hips": 1.0}, {}
    for number, (joint, parent, _) in enumerate(JOINTS):
        if parent is not None:
            taken = min(left[parent], given[parent] * share(joint, p, pulled_by)) if left[parent] > 0 else 0.0
            left[parent] -= taken
            left[joint] = taken
        given = {**given, joint: left[joint]} if parent is not None else {joint: 1.0}
    for number, (joint, _, _) in enumerate(JOINTS):
        if left[joint] > 0:
            found[number] = left[joint]
    return found


def stored(found):
    """The strongest as (joints, weights), four of each: bytes whose sum is exactly 255."""
    strongest = sorted(found.items(), key=lambda pair: (-pair[1], pair[0]))[:INFLUENCES]
    total = sum(weight for _, weight in strongest)
    bytes_ = [int(STEPS * weight / total + 0.5) for _, weight in strongest]
    bytes_[0] += STEPS - sum(bytes_)
    kept = [(joint, weight) for (joint, _), weight in zip(strongest, bytes_) if weight > 0]
    kept += [(0, 0)] * (INFLUENCES - len(kept))
    return tuple(joint for joint, _ in kept), tuple(weight for _, weight in kept)
