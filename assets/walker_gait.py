"""How the walker walks, runs and waves: poses as functions of the phase, 0 to 1 over a clip's loop.

A foot is led on a path and the leg follows by two-bone inverse kinematics. While it stands, the foot moves backwards over the
ground at one speed: first it rolls about its heel, then it lies flat, then it rolls about the joint of the toes, which stay
flat. In between it swings on a curve that leaves and meets the ground at the ground's own speed.
"""
import math

from mesh import add, cross, dot, lerp, mix, scale, smoothstep, sub, unit
from turning import STILL, X, Y, Z, about, after, back, of_axes, turned
from walker_skeleton import (ANKLE_HEIGHT_M, HIP_HEIGHT_M, HIP_WIDTH_M, KNEE_HEIGHT_M, NAMES, PARENTS, PLACES, TOES,
                             arm_direction, offset)

THIGH_M, SHANK_M = HIP_HEIGHT_M - KNEE_HEIGHT_M, KNEE_HEIGHT_M - ANKLE_HEIGHT_M
HEEL = (0.030, -0.045)  # what a foot rolls about when it lands: height, and how far it lies before the ankle
TAU = 2 * math.pi


class Gait:
    """What tells walking from running. Angles in degrees, positive: forwards, upwards or bent."""

    def __init__(self, **figures):
        self.__dict__.update(figures)

    def speed(self):
        """Of the ground, metres a second backwards."""
        return self.stride_m / self.duration_s


WALK = Gait(
    duration_s=1.0, stride_m=1.10, stance=0.62, strike_m=0.275, apart_m=0.072,
    strike_pitch=20, flat_from=0.10, heel_off=0.34, toe_off_pitch=-52, lift_m=0.115, heel_kick=-28, kick_at=0.22,
    hips_m=0.942, bob_m=0.016, bob_phase=0.06, sway_m=0.020, lean=2, yaw=7, roll=3.0, counter=14, chest_lean=1,
    arm_swing=25, arm_back=4, elbow=22, elbow_swing=12, arm_out=7, nod=1.0)

RUN = Gait(
    duration_s=0.64, stride_m=1.66, stance=0.36, strike_m=0.235, apart_m=0.050,
    strike_pitch=9, flat_from=0.07, heel_off=0.16, toe_off_pitch=-58, lift_m=0.36, heel_kick=-82, kick_at=0.36,
    hips_m=0.925, bob_m=0.032, bob_phase=0.17, sway_m=0.010, lean=7, yaw=9, roll=3.5, counter=22, chest_lean=8,
    arm_swing=38, arm_back=8, elbow=88, elbow_swing=14, arm_out=10, nod=2.0)


def gait_pose(gait, phase):
    """{joint: rotation relative to its parent}, and where the hips are. The left foot lands at phase 0, the right at 0.5."""
    a = TAU * phase
    hips_at = (gait.sway_m * math.sin(a - TAU * 0.05), gait.hips_m - gait.bob_m * math.cos(2 * (a - TAU * gait.bob_phase)), 0.0)
    yaw, roll = -radians(gait.yaw) * math.cos(a), -radians(gait.roll) * math.sin(a - TAU * 0.03)
    hips = after(about(Y, yaw), about(Z, roll), about(X, radians(gait.lean)))
    rotations = {"hips": hips}
    trunk(rotations, gait, a, yaw, roll)
    for suffix, side in (("l", 1), ("r", -1)):
        arm(rotations, gait, suffix, side, a)
        leg(rotations, suffix, side, hips_at, hips, foot(gait, side, phase if side > 0 else phase + 0.5))
    return rotations, hips_at


def radians(degrees):
    return math.radians(degrees)


def trunk(rotations, gait, a, yaw, roll):
    """The chest turns against the hips, the head looks ahead."""
    against = -yaw + radians(gait.counter) / 2 * math.cos(a)
    lean = radians(gait.chest_lean) + radians(gait.nod) * math.cos(2 * a - 1.0)
    rotations["spine"] = after(about(Y, against * 0.45), about(Z, -roll * 0.6), about(X, lean * 0.5))
    rotations["chest"] = after(about(Y, against * 0.55), about(Z, -roll * 0.6), about(X, lean * 0.5))
    chest_yaw = yaw + against
    up = -(lean + radians(gait.lean)) * 0.9
    rotations["neck"] = after(about(Y, -chest_yaw * 0.4), about(Z, roll * 0.1), about(X, up * 0.5))
    rotations["head"] = after(about(Y, -chest_yaw * 0.5), about(Z, roll * 0.1), about(X, up * 0.5))


def arm(rotations, gait, suffix, side, a):
    """Each swings with the other side's leg."""
    swing = -side * math.cos(a - 0.12)  # 1: in front
    rotations[f"shoulder_{suffix}"] = about(Y, -side * radians(3) * swing)
    forwards = radians(gait.arm_swing) * swing - radians(gait.arm_back)
    hanging(rotations, suffix, side, forwards, radians(gait.arm_out), radians(gait.elbow) + radians(gait.elbow_swing) * swing)


def hanging(rotations, suffix, side, forwards, out, elbow):
    """An arm beside the body, `forwards` and `out` of the vertical."""
    down = math.pi / 2 - math.acos(abs(arm_direction(side)[0])) - out
    rotations[f"upper_arm_{suffix}"] = after(about(X, -forwards), about(Z, -side * down), twist(side, 0.35))
    rotations[f"lower_arm_{suffix}"] = after(about(bend_axis(side), elbow), twist(side, 0.5))
    rotations[f"hand_{suffix}"] = about(bend_axis(side), 0.12)


def bend_axis(side):
    """About which an elbow brings the forearm forwards."""
    return cross(arm_direction(side), Z)


def twist(side, angle):
    """About the arm: the thumb inwards."""
    return about(arm_direction(side), -side * -angle)


def foot(gait, side, phase):
    """(ankle's place, pitch, bend of the toes) at a phase that counts from this foot's own landing."""
    phase %= 1.0
    if phase < gait.stance:
        return standing(gait, side, phase)
    return swinging(gait, side, (phase - gait.stance) / (1 - gait.stance))


def standing(gait, side, phase):
    place = (side * gait.apart_m, 0.0, gait.strike_m - gait.stride_m * phase)
    if phase < gait.flat_from:
        pitch = radians(gait.strike_pitch) * (1 - smoothstep(0.0, gait.flat_from, phase))
        return rolled(place, HEEL, pitch), pitch, 0.0
    raised = max(0.0, (phase - gait.heel_off) / (gait.stance - gait.heel_off))
    pitch = radians(gait.toe_off_pitch) * raised ** 1.8
    return rolled(place, TOES, pitch), pitch, -pitch


def rolled(place, pivot, pitch):
    """Where the ankle is when a foot that lies at `place` is turned about a point of it; pitch lifts the toes."""
    pivot = (0.0, *pivot)
    return add(place, add(pivot, turned(about(X, -pitch), sub((0.0, ANKLE_HEIGHT_M, 0.0), pivot))))


def swinging(gait, side, s):
    """From where the foot was left to where it will land: a cubic curve that begins and ends with the foot's own velocity."""
    step = 1e-4
    off, before = (standing(gait, side, gait.stance - x) for x in (0.0, step))
    on, later = standing(gait, side, 0.0), standing(gait, side, step)
    length = 1 - gait.stance
    leave, land = scale(sub(off[0], before[0]), length / step), scale(sub(later[0], on[0]), length / step)
    at = hermite(off[0], leave, on[0], land, s)
    lift = gait.lift_m * math.sin(math.pi * s ** 0.8) ** 2
    turn = (off[1] - before[1]) * length / step
    kick = gait.kick_at
    if s < kick:
        pitch = hermite((off[1],), (turn * kick,), (min(off[1], radians(gait.heel_kick)),), (0.0,), s / kick)[0]
    else:
        pitch = lerp(min(off[1], radians(gait.heel_kick)), on[1], smoothstep(kick, 1.0, s))
    toes = -off[1] * (1 - smoothstep(0.0, 0.45, s))
    return add(at, (0.0, lift, 0.0)), pitch, toes


def hermite(start, start_slope, end, end_slope, s):
    parts = (2 * s**3 - 3 * s**2 + 1, s**3 - 2 * s**2 + s, 3 * s**2 - 2 * s**3, s**3 - s**2)
    return tuple(sum(w * v for w, v in zip(parts, values)) for values in zip(start, start_slope, end, end_slope))


def leg(rotations, suffix, side, hips_at, hips, led):
    """Bends hip and knee so that the ankle is where the foot is led; the knee points ahead."""
    ankle, pitch, toes = led
    hip = add(hips_at, turned(hips, offset(f"upper_leg_{suffix}")))
    way = sub(ankle, hip)
    far = min(math.sqrt(dot(way, way)), 0.9995 * (THIGH_M + SHANK_M))
    up = scale(unit(way), -1)
    left = unit(cross(up, Z))
    ahead = cross(left, up)
    bend = math.acos((THIGH_M ** 2 + far ** 2 - SHANK_M ** 2) / (2 * THIGH_M * far))
    knee = add(scale(up, -THIGH_M * math.cos(bend)), scale(ahead, THIGH_M * math.sin(bend)))
    thigh = bone_turn(left, scale(knee, -1))
    shank = bone_turn(left, sub(knee, scale(up, -far)))
    sole = about(X, -pitch)
    rotations[f"upper_leg_{suffix}"] = after(back(hips), thigh)
    rotations[f"lower_leg_{suffix}"] = after(back(thigh), shank)
    rotations[f"foot_{suffix}"] = after(back(shank), sole)
    rotations[f"toes_{suffix}"] = about(X, -toes)


def bone_turn(left, upwards):
    up = unit(upwards)
    return of_axes(left, up, cross(left, up))


def wave_pose(phase):
    """Stands, sways a little, and waves with the right hand; three times in a loop."""
    a = TAU * phase
    hips_at = (-0.018 + 0.010 * math.sin(a), 0.955 - 0.004 * math.cos(2 * a), 0.0)
    hips = after(about(Y, 0.05 * math.sin(a)), about(Z, 0.035))
    rotations = {"hips": hips,
                 "spine": after(about(Z, -0.05 - 0.02 * math.sin(a)), about(X, 0.01 * math.sin(2 * a))),
                 "chest": after(about(Z, -0.03), about(Y, 0.04 * math.sin(a))),
                 "neck": after(about(Z, 0.05), about(Y, -0.05)),
                 "head": after(about(Z, 0.09 + 0.05 * math.sin(a)), about(Y, -0.06 - 0.04 * math.sin(a)), about(X, -0.04)),
                 "shoulder_l": STILL, "shoulder_r": about(Z, -0.16)}
    hanging(rotations, "l", 1, -0.02 + 0.03 * math.sin(a), radians(9), radians(14))
    raised(rotations, math.sin(3 * a))
    for suffix, side in (("l", 1), ("r", -1)):
        leg(rotations, suffix, side, hips_at, hips, ((side * 0.105, ANKLE_HEIGHT_M, 0.0), 0.0, 0.0))
    return rotations, hips_at


def raised(rotations, beat):
    """The right arm up and out, the forearm swinging from side to side as `beat` goes from -1 to 1."""
    out = arm_direction(-1)
    upper = unit((-0.92, 0.18 + 0.05 * beat, 0.34))
    fore = unit((-0.10 - 0.36 * beat, 0.95, 0.20))
    palm = unit((0.25, 0.0, 0.97))
    upper_turn = turn_between((out, Z), (upper, palm))
    fore_turn = turn_between((out, cross(Z, out)), (fore, palm))
    shoulder = after(*(rotations[name] for name in ("hips", "spine", "chest", "shoulder_r")))
    rotations["upper_arm_r"] = after(back(shoulder), upper_turn)
    rotations["lower_arm_r"] = after(back(upper_turn), fore_turn)
    rotations["hand_r"] = about(cross(out, cross(Z, out)), 0.22 * beat)


def turn_between(rest, wanted):
    """The turn that takes one pair of directions to another; of the second of a pair only what is across the first counts."""
    def axes(pair):
        first = unit(pair[0])
        third = unit(cross(first, pair[1]))
        return of_axes(first, cross(third, first), third)
    return after(axes(wanted), back(axes(rest)))


def world(rotations, hips_at):
    """{joint: (rotation, place)} in the world."""
    placed = {}
    for name in NAMES:
        parent = PARENTS[name]
        if parent is None:
            placed[name] = rotations[name], hips_at
        else:
            turn, at = placed[parent]
            placed[name] = after(turn, rotations.get(name, STILL)), add(at, turned(turn, offset(name)))
    return placed
