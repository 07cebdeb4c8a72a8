"""Bones that keep their length.

A network's joints are free points, so its bones are only nearly right. Here the generated joints
are moved until every bone has the length that it has where it is given. Given joints stay where
they are. Errors and seams stay as they are; only the bones gain.
Gain: docs/RESULTS.md, *In-betweens* (`inbetween-departures.no-bones.*`).
Source: position-based dynamics (Müller and others, 2007), distances only; MoFusion eq. 6 has the
same aim, as a loss.
"""

import numpy as np
from jaxtyping import Bool, Float

from ..motion.skeleton import BONES

# rounds through all bones; errors of centimetres fall below .1 mm, unless the given joints
# contradict the lengths
ROUNDS = 30


def given_lengths(
    positions: Float[np.ndarray, "T J 3"], known: Bool[np.ndarray, "T J"]
) -> Float[np.ndarray, "20"]:
    """The median length of each bone over the frames that give both of its ends, in metres.

    It is NaN for a bone that no frame gives.
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
    """Move the joints that are not known until the bones have these lengths (NaN: any length).

    Each of `rounds` rounds corrects one bone after the other. If both joints of a bone are free,
    each moves by half of the error; if one is known, the free joint moves by all of it. If known
    joints are farther apart than the bones reach, the remaining error is shared between the bones.
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
