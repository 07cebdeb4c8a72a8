"""Measures of repairs.

How far are the reconstructed joints from the truth? How well do they join the rest? Do they move?

Positions are in metres, results in centimetres. `known` is True for each joint of each frame that
was given. Several repairs of the same past share it; they have a leading axis, (n, ..., T, J, 3).
Source: MoDiff IV-B (its RMSE_re is of bones; the distance to the truth is ours, because here the
truth is known).   Notebook: 10
"""

import numpy as np
from jaxtyping import Bool, Float

from ..motion.skeleton import BONE_LENGTHS, BONES
from .bone_lengths import CM_PER_METRE, bone_lengths

Poses = Float[np.ndarray, "*N T J 3"]
Known = Bool[np.ndarray, "*B T J"]


def missing_error(made: Poses, truth: Float[np.ndarray, "*B T J 3"], known: Known) -> float:
    """Mean distance of the missing joints from the truth, in cm.

    The mean of several repairs always scores at least as well as they do on average:
    |mean_i x_i - truth| <= mean_i |x_i - truth|.
    Raises ValueError when nothing is missing.  Notebook: 10
    """
    distance = np.linalg.norm(np.asarray(made, np.float64) - truth, axis=-1)
    return float(CM_PER_METRE * _where(~known, distance).mean())


def joined_bones(made: Poses, known: Known) -> float:
    """RMS error of the length of bones with a missing end, in cm.

    The paper does not say whether its RMSE_re also counts the other bones, whose length is given;
    `bone_rmse` counts all.
    Raises ValueError when nothing is missing.  Source: MoDiff Table II.  Notebook: 10
    """
    parents, children = np.array(BONES).T
    off = bone_lengths(made) - BONE_LENGTHS
    return float(
        CM_PER_METRE
        * np.sqrt((_where(~(known[..., parents] & known[..., children]), off) ** 2).mean())
    )


def missing_step(made: Poses, known: Known) -> float:
    """Mean movement of a joint from one frame to the next where either is missing, in cm.

    A mean of several motions moves too little: compare with the truth's own value.
    Raises ValueError when nothing is missing.  Notebook: 10
    """
    step = np.linalg.norm(np.diff(np.asarray(made, np.float64), axis=-3), axis=-1)
    return float(CM_PER_METRE * _where(~(known[..., 1:, :] & known[..., :-1, :]), step).mean())


def missing_spread(samples: Float[np.ndarray, "n *B T J 3"], known: Known) -> float:
    """RMS distance of n repairs of the same past from their mean, in cm, with n - 1.

    Calibrated repairs spread about as far as the truth is from their mean.
    Raises ValueError for fewer than two repairs, and when nothing is missing.  Notebook: 10
    """
    if len(samples) < 2:
        raise ValueError("a spread needs at least 2 repairs of the same past, got 1")
    variance = np.asarray(samples, np.float64).var(axis=0, ddof=1).sum(-1)
    return float(CM_PER_METRE * np.sqrt(_where(~known, variance).mean()))


def _where(
    counted: Bool[np.ndarray, "..."], values: Float[np.ndarray, "..."]
) -> Float[np.ndarray, "K"]:
    """The values where `counted` is True; one mask serves all repairs of a motion."""
    if not counted.any():
        raise ValueError("nothing is missing: there is no repair to measure")
    return values[np.broadcast_to(counted, values.shape)]
