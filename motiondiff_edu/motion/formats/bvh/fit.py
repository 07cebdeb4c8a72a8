"""A constant-bone skeleton fitted to any motion: offsets, local rotations, continuous Euler angles.

In a network's raw output the bone lengths vary a little; a BVH file has constant bones. `fit` finds
a close motion with constant bones and reports how far the joints moved.
"""

import warnings
from dataclasses import dataclass

import numpy as np
import scipy
from jaxtyping import Float, Int

from ...directions import least_turn
from ...kinematics import forward_kinematics
from ...skeleton import HIPS, JOINTS, OFFSETS, PARENTS, joint_index

# Three joints of length zero, as in capture files: with them, spine and collars turn independently
# of hips and neck.
HELPERS = {
    "LowerBack": ("Hips", ("Spine",)),
    "LeftShoulder": ("Neck1", ("LeftArm",)),
    "RightShoulder": ("Neck1", ("RightArm",)),
}
END_SITES = {  # metres, so that programs draw toes, hands and head
    "LeftToeBase": (0.0, 0.0, 0.06),
    "RightToeBase": (0.0, 0.0, 0.06),
    "Head": (0.0, 0.16, 0.0),
    "LeftHandIndex1": (0.08, 0.0, 0.0),
    "RightHandIndex1": (-0.08, 0.0, 0.0),
}

EXACT = 0.01  # mm: less is not worth a word


@dataclass(frozen=True, eq=False)
class FitReport:
    """The fitted positions and how far each joint is from the given motion.

    `positions` are in metres. `shift_mm` is the distance per frame and joint. `bone_mm` is the mean
    standard deviation of the given bone lengths; no constant skeleton can avoid this part.
    """

    positions: Float[np.ndarray, "T 21 3"]
    shift_mm: Float[np.ndarray, "T 21"]
    bone_mm: float
    path: str = ""

    @property
    def mean_mm(self) -> float:
        """Mean joint shift, mm."""
        return float(self.shift_mm.mean())

    @property
    def max_mm(self) -> float:
        """Largest joint shift, mm."""
        return float(self.shift_mm.max())

    def __str__(self) -> str:
        begin = f"{self.path or 'fit'}: {len(self.positions)} frames"
        if self.max_mm < EXACT:
            return f"{begin}, the joints exactly where they were"
        frame, joint = np.unravel_index(int(self.shift_mm.argmax()), self.shift_mm.shape)
        return (
            f"{begin}, bones made constant; joints "
            f"shifted by {self.mean_mm:.2f} mm on average, "
            f"{self.max_mm:.2f} mm at most ({JOINTS[joint]}, frame {frame})"
        )


@dataclass(frozen=True, eq=False)
class Fit:
    """A hierarchy and its motion, ready to write. Lengths are in metres, angles in degrees."""

    names: tuple[str, ...]
    parents: np.ndarray
    offsets: Float[np.ndarray, "N 3"]
    root: Float[np.ndarray, "T 3"]
    angles: Float[np.ndarray, "T N 3"]
    report: FitReport


def fit(positions: Float[np.ndarray, "T 21 3"]) -> Fit:
    """Fit the course's skeleton to world positions (metres).

    The bones get the motion's median lengths. A joint with several children turns by the
    least-squares rotation (Kabsch). A joint with a single child turns by the smallest rotation from
    its parent, so that no twist is added.
    """
    bones = np.linalg.norm(positions[:, 1:] - positions[:, PARENTS[1:]], axis=-1)
    lengths, deviation = np.median(bones, axis=0), bones.std(axis=0)
    names, parents, offsets = hierarchy(scaled_offsets(lengths))
    turns, points = global_turns(positions, names, parents, offsets)
    local = turns.copy()
    local[:, 1:] = np.swapaxes(turns[:, parents[1:]], -1, -2) @ turns[:, 1:]
    world, _ = forward_kinematics(local, points[:, HIPS], offsets, parents)
    ours = world[:, [names.index(name) for name in JOINTS]]
    shift = 1000 * np.linalg.norm(ours - positions, axis=-1)
    report = FitReport(ours, shift, float(1000 * deviation.mean()))
    return Fit(names, parents, offsets, points[:, HIPS], euler_zxy(local), report)


def scaled_offsets(lengths: Float[np.ndarray, "20"]) -> Float[np.ndarray, "21 3"]:
    """The course's rest offsets with these bone lengths; the root's is zero."""
    offsets = OFFSETS.copy()
    offsets[HIPS] = 0
    offsets[1:] *= (lengths / np.linalg.norm(offsets[1:], axis=1))[:, None]
    return offsets


def hierarchy(
    offsets: Float[np.ndarray, "21 3"],
) -> tuple[tuple[str, ...], np.ndarray, Float[np.ndarray, "N 3"]]:
    """Names, parents and offsets with the helper joints inserted, each before its child."""
    names = []
    above: dict[str, str | None] = {}
    table = []
    helper_of = {child: helper for helper, (_, children) in HELPERS.items() for child in children}
    for joint, name in enumerate(JOINTS):
        helper = helper_of.get(name)
        if helper:
            names.append(helper)
            above[helper] = HELPERS[helper][0]
            table.append(np.zeros(3))
        names.append(name)
        above[name] = helper or (JOINTS[PARENTS[joint]] if joint else None)
        table.append(offsets[joint])
    parents = np.array([names.index(at) if (at := above[name]) else -1 for name in names])
    return tuple(names), parents, np.array(table)


def global_turns(
    positions: Float[np.ndarray, "T 21 3"],
    names: tuple[str, ...],
    parents: Int[np.ndarray, "N"],
    offsets: Float[np.ndarray, "N 3"],
) -> tuple[Float[np.ndarray, "T N 3 3"], Float[np.ndarray, "T N 3"]]:
    """Global rotation and position of every node, root first.

    A bone points from the fitted position of its parent to the given position of its child, so
    errors do not add up along a limb.
    """
    turns = np.zeros((len(positions), len(names), 3, 3))
    points = np.zeros((len(positions), len(names), 3))
    points[:, 0] = positions[:, HIPS]
    for node, parent in enumerate(parents):
        before = turns[:, parent] if parent >= 0 else np.broadcast_to(np.eye(3), turns[:, 0].shape)
        if parent >= 0:
            points[:, node] = points[:, parent] + before @ offsets[node]
        children = guiding_children(node, names, parents)
        rest = np.array([OFFSETS[joint_index(names[c])] for c in children])
        aims = np.array([positions[:, joint_index(names[c])] - points[:, node] for c in children])
        if len(children) > 1:
            turns[:, node] = kabsch(rest, aims.swapaxes(0, 1))
        else:
            turns[:, node] = least_turn(before @ rest[0], aims[0]) @ before if children else before
    return turns, points


def guiding_children(node: int, names: tuple[str, ...], parents: Int[np.ndarray, "N"]) -> list[int]:
    """The joints that determine a node's rotation: its children without helper joints."""
    return [c for c in range(len(names)) if parents[c] == node and names[c] not in HELPERS]


def kabsch(
    rest: Float[np.ndarray, "K 3"], aims: Float[np.ndarray, "T K 3"]
) -> Float[np.ndarray, "T 3 3"]:
    """R minimising sum |R rest_k - aim_k|^2 for each frame."""
    u, _, vt = np.linalg.svd(np.einsum("tki,kj->tij", aims, rest))
    flip = np.ones((len(aims), 3))
    flip[:, 2] = np.linalg.det(u @ vt)
    return (u * flip[:, None]) @ vt


def euler_zxy(local: Float[np.ndarray, "T N 3 3"]) -> Float[np.ndarray, "T N 3"]:
    """Degrees for the channels Zrotation Xrotation Yrotation, without jumps between frames.

    (z, x, y) and (z + 180, 180 - x, y + 180) are the same rotation; the one closer to the frame
    before is chosen.
    """
    frames, nodes = local.shape[:2]
    turns = scipy.spatial.transform.Rotation.from_matrix(local.reshape(-1, 3, 3))
    with warnings.catch_warnings():  # at 90 degrees two angles do the same, and scipy chooses
        warnings.filterwarnings("ignore", "Gimbal lock")
        angles = turns.as_euler("ZXY").reshape(frames, nodes, 3)
    twin = angles * [1, -1, 1] + np.pi
    for t in range(1, frames):
        near, far = (wrap_to(other[t], angles[t - 1]) for other in (angles, twin))
        closer = np.abs(far - angles[t - 1]).sum(-1) < np.abs(near - angles[t - 1]).sum(-1)
        angles[t] = np.where(closer[:, None], far, near)
    return np.degrees(angles)


def wrap_to(
    angles: Float[np.ndarray, "N 3"], reference: Float[np.ndarray, "N 3"]
) -> Float[np.ndarray, "N 3"]:
    """Add whole turns (radians) so that each angle is within half a turn of the reference."""
    return angles - 2 * np.pi * np.round((angles - reference) / (2 * np.pi))
