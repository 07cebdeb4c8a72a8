"""Checks of notebook 01: lengths of bones, a pose placed in the world, a walk in the mirror."""

import math

import numpy as np

from ...motion.skeleton import JOINTS
from ._compare import compare
from ._report import check
from .zoo.nb01 import MISTAKES


def _skeletons(rng: np.random.Generator):
    """Bones of 5, 12 and 3, then twice as large; then any skeleton."""
    positions = np.zeros((2, 4, 3))
    positions[:, 1:] = [[3, 4, 0], [3, 4, 12], [1, 2, 2]]
    positions[1] *= 2
    positions[1] += [1.0, -2, 0.5]
    yield positions, [(0, 1), (1, 2), (0, 3)]
    yield rng.normal(size=(5, 6, 3)), [(0, 1), (0, 2), (2, 3), (1, 4), (4, 5)]


def measured(positions: np.ndarray, bones: list) -> np.ndarray:
    """Bone by bone with `math.dist`."""
    return np.array([[math.dist(pose[p], pose[c]) for p, c in bones] for pose in positions])


@check
def lengths_of_bones(mine):
    """mine(positions, bones) on small skeletons, the first with bones 5, 12 and 3 long."""
    compare(mine, measured, _skeletons, "the lengths of bones", MISTAKES["lengths_of_bones"])
    return (
        "A bone should have one length. Nothing in the 63 coordinates of a pose makes sure of that."
    )


def _placements(rng: np.random.Generator):
    """By 30 degrees, by a quarter to the left (facing +x), and by any angle."""
    pose = np.array([[0.0, 1.0, 0.0], [0.2, 1.5, 0.0], [0.0, 0.1, 0.3], [-0.1, 0.4, 0.05]])
    yield pose, 0.0, 0.0, np.pi / 6
    yield pose, 2.0, 5.0, np.pi / 2
    yield rng.normal(size=(5, 3)), *rng.normal(size=2), float(rng.uniform(-3, 3))


def placed(pose: np.ndarray, x: float, z: float, heading: float) -> np.ndarray:
    """Each joint as a complex number: ahead is real, left is imaginary; a turn is a product."""
    turned = (pose[:, 2] + 1j * pose[:, 0]) * np.exp(1j * heading)
    return np.stack([x + turned.imag, pose[:, 1], z + turned.real], -1)


@check
def place_in_world(mine):
    """Check mine(pose, x, z, heading)."""
    compare(mine, placed, _placements, "a pose in the world", MISTAKES["place_in_world"])
    return "One turn and one shift for each pose lead from the root frame to the world."


def _walks(rng: np.random.Generator):
    """Poses of the 21 joints, no two numbers alike, and their control."""
    for T in (6, 4):
        yield rng.normal(size=(T, 21, 3)), rng.normal(size=(T, 3))


def in_the_mirror(poses: np.ndarray, control: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Joint by joint: its partner has the other side's name."""
    other = {"Left": "Right", "Right": "Left"}
    seen = np.empty_like(poses)
    for j, name in enumerate(JOINTS):
        side = next((side for side in other if name.startswith(side)), "")
        partner = other.get(side, "") + name.removeprefix(side)
        seen[:, j] = poses[:, JOINTS.index(partner)]
        seen[:, j, 0] = -seen[:, j, 0]
    forward, aside, yaw = control.T
    return seen, np.stack([forward, -aside, -yaw], -1)


@check
def mirror_walk(mine):
    """mine(poses, control): every joint changes side, and so do two columns of the control."""
    parts = ("the mirrored poses", "the mirrored control")
    compare(mine, in_the_mirror, _walks, parts, MISTAKES["mirror_walk"])
    return "One sign and one permutation give twice as much data, if every joint takes part."
