"""Gait cycles of a walk given as world positions.

It finds foot contact by height and speed, and angles over the cycle.

It works for real and synthetic clips: contact comes from the motion, not from the truth.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d

from motiondiff_edu.motion.skeleton import joint_index

GRID = np.linspace(0, 1, 51)
SIDES = ("Left", "Right")


@dataclass(frozen=True)
class Walk:
    """World positions with the direction of travel and facing per frame."""

    world: Float[np.ndarray, "T 21 3"]
    fps: float
    travel: Float[np.ndarray, "T 2"]  # unit (x, z)
    speed: Float[np.ndarray, "T"]
    facing: Float[np.ndarray, "T 2"]
    down: Bool[np.ndarray, "T 2"]
    level: Float[np.ndarray, "2"]  # stance height of the Foot joints

    def joint(self, name: str) -> Float[np.ndarray, "T 3"]:
        """World positions of this joint."""
        return self.world[:, joint_index(name)]

    def sagittal(self, frm: str, to: str, up: float = -1.0) -> Float[np.ndarray, "T"]:
        """Angle (degrees, forward positive) of a bone from the vertical in the facing plane."""
        d = self.joint(to) - self.joint(frm)
        ahead = (d[:, [0, 2]] * self.facing).sum(-1)
        return np.degrees(np.arctan2(ahead, up * d[:, 1]))


@dataclass(frozen=True)
class Cycle:
    """One cycle, from heel strike to the next of the same foot, in frame numbers."""

    side: int
    start: int
    toe_off: int
    other_strike: int
    end: int


def _speed(p: np.ndarray, fps: float) -> np.ndarray:
    return np.linalg.norm(np.gradient(p, axis=0), axis=-1) * fps


def _tidy(down: np.ndarray) -> np.ndarray:
    """Flip runs and gaps of one frame."""
    d = down.copy()
    lonely = (d[1:-1] != d[:-2]) & (d[1:-1] != d[2:])
    d[1:-1][lonely] = d[:-2][lonely]
    return d


def analyse(world: Float[np.ndarray, "T 21 3"], fps: float = 20.0) -> Walk:
    """Directions and contacts of a clip.

    A foot is down when it is low and slower than the pelvis.
    """
    hips = world[:, 0][:, [0, 2]]
    v = gaussian_filter1d(np.gradient(hips, axis=0) * fps, 0.25 * fps, axis=0, mode="nearest")
    speed = np.linalg.norm(v, axis=-1)
    j = joint_index
    across = (
        world[:, j("LeftUpLeg")]
        - world[:, j("RightUpLeg")]
        + world[:, j("LeftArm")]
        - world[:, j("RightArm")]
    )
    across = gaussian_filter1d(across[:, [0, 2]], 0.1 * fps, axis=0, mode="nearest")
    facing = np.stack([-across[:, 1], across[:, 0]], -1)
    facing /= np.linalg.norm(facing, axis=-1, keepdims=True)
    travel = np.where(speed[:, None] > 0.35, v / np.maximum(speed[:, None], 1e-6), facing)
    down, level = [], []
    for side in SIDES:
        foot = world[:, j(side + "Foot")]
        toe = world[:, j(side + "ToeBase")]
        slow = _speed(toe, fps) < 0.3
        level.append(
            np.percentile(foot[slow, 1], 25) if slow.sum() > 3 else np.percentile(foot[:, 1], 10)
        )
        ground = np.percentile(toe[slow, 1], 25) if slow.sum() > 3 else np.percentile(toe[:, 1], 10)
        w = np.clip(speed, 0.5, 3.0)
        low = (toe[:, 1] - ground < 0.06) & (_speed(toe, fps) < w)
        down.append(_tidy(low | ((foot[:, 1] < level[-1] + 0.05) & (_speed(foot, fps) < w))))
    return Walk(world, fps, travel, speed, facing, np.stack(down, -1), np.array(level))


def cycles(walk: Walk, steady: bool = True) -> list[Cycle]:
    """Cycles of both feet with one toe-off and one strike of the other foot.

    `steady`: straight and even.
    """
    strikes = [np.flatnonzero(~walk.down[:-1, s] & walk.down[1:, s]) + 1 for s in (0, 1)]
    offs = [np.flatnonzero(walk.down[:-1, s] & ~walk.down[1:, s]) + 1 for s in (0, 1)]
    found = []
    for s in (0, 1):
        for a, b in zip(strikes[s][:-1].tolist(), strikes[s][1:].tolist(), strict=True):
            off = offs[s][(offs[s] > a) & (offs[s] < b)]
            other = strikes[1 - s][(strikes[1 - s] > a) & (strikes[1 - s] < b)]
            ok = (
                0.45 < (b - a) / walk.fps < 1.9
                and len(off) == len(other) == 1
                and walk.speed[a:b].mean() > 0.4
            )
            if ok and (not steady or _steady(walk, a, b)):
                found.append(Cycle(s, int(a), int(off[0]), int(other[0]), int(b)))
    return found


def _steady(walk: Walk, a: int, b: int) -> bool:
    turn = np.unwrap(np.arctan2(walk.travel[a : b + 1, 0], walk.travel[a : b + 1, 1]))
    change = abs(walk.speed[b] - walk.speed[a]) / walk.speed[a:b].mean()
    return bool(np.ptp(turn) < np.radians(15) and change < 0.2)


def curves(walk: Walk) -> dict[str, np.ndarray]:
    """Angles (degrees) and heights (m) per frame.

    The names that end in 0 or 1 belong to the left or right side.
    """
    out = {"hips_y": walk.joint("Hips")[:, 1], "lean": walk.sagittal("Hips", "Neck1", 1.0)}
    out["head"] = walk.sagittal("Neck1", "Head", 1.0)
    heading = np.arctan2(walk.facing[:, 0], walk.facing[:, 1])
    for s, side in enumerate(SIDES):
        thigh = walk.sagittal(side + "UpLeg", side + "Leg")
        out[f"thigh{s}"] = thigh
        out[f"knee{s}"] = thigh - walk.sagittal(side + "Leg", side + "Foot")
        out[f"ankle{s}"] = _between(walk, side + "Leg", side + "Foot", side + "ToeBase")
        out[f"hand{s}"] = walk.sagittal(side + "Arm", side + "Hand")
        out[f"elbow{s}"] = _between(walk, side + "Arm", side + "ForeArm", side + "Hand")
        out[f"toe_y{s}"] = walk.joint(side + "ToeBase")[:, 1]
        out[f"foot_y{s}"] = walk.joint(side + "Foot")[:, 1]
        for name, joints in (("pelvis", "UpLeg"), ("thorax", "Arm")):
            d = walk.joint(side + joints) - walk.joint(SIDES[1 - s] + joints)
            own = 1.0 if s == 0 else -1.0  # ahead of a line that runs to one's own side
            line = np.arctan2(d[:, 0] * own, d[:, 2] * own) - np.pi / 2
            out[f"{name}_yaw{s}"] = -own * np.degrees(
                (line - _smooth_heading(heading, walk.fps) + np.pi) % (2 * np.pi) - np.pi
            )
            out[f"{name}_roll{s}"] = np.degrees(np.arcsin(d[:, 1] / np.linalg.norm(d, axis=-1)))
    return out


def _smooth_heading(heading: np.ndarray, fps: float) -> np.ndarray:
    return gaussian_filter1d(np.unwrap(heading), 0.5 * fps, mode="nearest")


def _between(walk: Walk, a: str, b: str, c: str) -> np.ndarray:
    """Angle between the bones a-b and b-c, degrees."""
    p, q = walk.joint(b) - walk.joint(a), walk.joint(c) - walk.joint(b)
    cos = (p * q).sum(-1) / np.linalg.norm(p, axis=-1) / np.linalg.norm(q, axis=-1)
    return np.degrees(np.arccos(np.clip(cos, -1, 1)))


def over_cycle(values: Float[np.ndarray, "T *D"], cycle: Cycle) -> Float[np.ndarray, "P *D"]:
    """The curve at GRID phases of the cycle (cubic spline)."""
    a, b = max(cycle.start - 2, 0), min(cycle.end + 3, len(values))
    return CubicSpline(np.arange(a, b), values[a:b], axis=0)(
        cycle.start + GRID * (cycle.end - cycle.start)
    )
