"""Typical faults of motion capture: dead joints, dropped frames, bursts and jitter.

A fault takes clean positions and returns (faulty positions, known), so the truth is there. A
missing position is NaN, and False in `known`; a position with jitter is True in `known`.
Source: MoDiff III-E; IV-B names the first two.  Notebook: 10
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from motiondiff_edu.motion.skeleton import JOINTS, joint_index

ARM = ("RightArm", "RightForeArm", "RightHand", "RightHandIndex1")  # missing in MoDiff's Fig. 6
LEG = ("RightUpLeg", "RightLeg", "RightFoot", "RightToeBase")


@dataclass(frozen=True, eq=False)
class Imperfect:
    """A motion with a fault: positions with NaN where nothing is known, and the mask of these."""

    positions: Float[np.ndarray, "*B T J 3"]
    known: Bool[np.ndarray, "*B T J"]


def dead_joints(positions: Float[np.ndarray, "*B T J 3"], names: Sequence[str] = ARM) -> Imperfect:
    """The named joints are missing throughout.  Raises KeyError for a name that no joint has.
    Notebook: 10"""
    known = np.ones(positions.shape[:-1], bool)
    known[..., [joint_index(name) for name in names]] = False
    return _without(positions, known)


def random_joints(
    positions: Float[np.ndarray, "*B T J 3"], share: float, rng: np.random.Generator
) -> Imperfect:
    """In each motion `share` of the joints, drawn at random, are missing throughout (Table II).

    Raises ValueError for a share outside 0..1.  Source: MoDiff IV-B, Table II.  Notebook: 10
    """
    _share(share)
    J = positions.shape[-2]
    order = rng.random((*positions.shape[:-3], J)).argsort(axis=-1)
    known = np.broadcast_to((order >= round(share * J))[..., None, :], positions.shape[:-1]).copy()
    return _without(positions, known)


def dropped_frames(positions: Float[np.ndarray, "*B T J 3"], first: int, count: int) -> Imperfect:
    """All joints are missing in `count` frames from `first` on.

    Notebook: 10

    Raises ValueError unless these frames lie within the motion.
    """
    T = positions.shape[-3]
    if not (0 <= first and 1 <= count and first + count <= T):
        raise ValueError(
            f"frames {first} to {first + count - 1} are not within a motion of {T} frames"
        )
    known = np.ones(positions.shape[:-1], bool)
    known[..., first : first + count, :] = False
    return _without(positions, known)


def bursts(
    positions: Float[np.ndarray, "*B T J 3"],
    rng: np.random.Generator,
    every: float = 20.0,
    longest: int = 6,
) -> Imperfect:
    """Now and then a joint is lost for a few frames, like a hidden marker.

    On average each joint is lost once in `every` frames. Each loss lasts 1 to `longest` frames.
    Notebook: 10
    """
    known = np.ones(positions.shape[:-1], bool)
    flat = np.moveaxis(known, -2, -1).reshape(
        -1, positions.shape[-3]
    )  # a copy: one row for each joint
    for row in flat:
        for start in np.flatnonzero(rng.random(len(row)) < 1 / every):
            row[start : start + rng.integers(1, longest + 1)] = False
    shape = (*positions.shape[:-3], positions.shape[-2], positions.shape[-3])
    return _without(positions, np.moveaxis(flat.reshape(shape), -1, -2))


def jitter(
    positions: Float[np.ndarray, "*B T J 3"], size: float, rng: np.random.Generator
) -> Imperfect:
    """Gaussian noise on every coordinate, with a standard deviation of `size` metres.

    Nothing is missing, so everything is "known".
    """
    noisy = positions + size * rng.standard_normal(positions.shape)
    return Imperfect(noisy, np.ones(positions.shape[:-1], bool))


def _without(
    positions: Float[np.ndarray, "*B T J 3"], known: Bool[np.ndarray, "*B T J"]
) -> Imperfect:
    if positions.shape[-2] != len(JOINTS):
        raise ValueError(
            f"the course's skeleton has {len(JOINTS)} joints, not {positions.shape[-2]}"
        )
    return Imperfect(np.where(known[..., None], positions, np.nan), known)


def _share(share: float) -> None:
    if not 0 <= share <= 1:
        raise ValueError(f"a share lies between 0 and 1, not {share:g}")
