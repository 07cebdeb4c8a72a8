"""Bones that keep their length.

Joints that were made up are moved until every bone is as long as where it is given.

A network's joints are free points; its bones come out nearly right. Given joints stay where they
are.
Source: position-based dynamics (Müller and others, 2007), distances only; MoFusion eq. 6 asks the
same of the network.
"""

import numpy as np
from jaxtyping import Bool, Float

from ..motion.skeleton import BONES

# through all bones; errors of centimetres fall below .1 mm unless the given joints contradict
ROUNDS = 30


def given_lengths(
    positions: Float[np.ndarray, "T J 3"], known: Bool[np.ndarray, "T J"]
) -> Float[np.ndarray, "20"]:
    """Of each bone the median length over the frames that give both of its ends, in metres.

    NaN where none does.
    """
    found = np.full(len(BONES), np.nan)
    for k, (parent, child) in enumerate(BONES):
        both = known[:, parent] & known[:, child]
        if both.any():
            found[k] = np.median(
                np.linalg.norm(positions[both, child] - positions[both, parent], axis=-1)
            )
    return found


def steady_bones(
    positions: Float[np.ndarray, "*B T J 3"],
    known: Bool[np.ndarray, "*#B T J"],
    lengths: Float[np.ndarray, "*#B 20"],
    rounds: int = ROUNDS,
) -> Float[np.ndarray, "*B T J 3"]:
    """Move the joints that are not known until bones have these lengths (NaN: any).

    They move bone by bone, and again.

    A bone between two free joints moves both by half of what is wrong, beside a known one the free
    joint by all of it. Where known joints are farther apart than bones reach, what remains wrong is
    shared.
    """
    moved, free = np.array(positions, np.float64), (~known).astype(np.float64)
    for _ in range(rounds):
        for k, (parent, child) in enumerate(BONES):
            length, mobile = lengths[..., k, None], free[..., parent] + free[..., child]
            if np.isnan(length).all() or not mobile.any():
                continue
            bone = moved[..., child, :] - moved[..., parent, :]
            now = np.maximum(np.linalg.norm(bone, axis=-1), 1e-9)
            share = np.nan_to_num(1 - length / now) / np.maximum(mobile, 1.0)
            moved[..., parent, :] += (free[..., parent] * share)[..., None] * bone
            moved[..., child, :] -= (free[..., child] * share)[..., None] * bone
    return np.where(known[..., None], positions, moved)
