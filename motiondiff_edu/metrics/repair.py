"""Measures of repairs.

How far what was missing is from the truth, how well it joins the rest, and whether it moves.

Positions in metres, results in centimetres. `known` says of each joint in each frame whether it was
given; several repairs of the same past stand in front, (n, ..., T, J, 3), and share it.
Source: MoDiff IV-C (RMSE_re is of bones; the distance to the truth is ours: here the truth is
known).   Notebook: 10
"""

import numpy as np
from jaxtyping import Bool, Float

from ..motion.skeleton import BONE_LENGTHS, BONES
from .bone_lengths import CM_PER_METRE, bone_lengths

Poses = Float[np.ndarray, "*N T J 3"]
Known = Bool[np.ndarray, "*B T J"]


def missing_error(made: Poses, truth: Float[np.ndarray, "*B T J 3"], known: Known) -> float:
    """Mean distance of the missing joints from the truth, cm.

    Over all of them, in all frames and motions.

    A mean of repairs can only win here: |mean_i x_i - truth| <= mean_i |x_i - truth|.
    Raises ValueError when nothing is missing.  Notebook: 10
    """
    distance = np.linalg.norm(np.asarray(made, np.float64) - truth, axis=-1)
    return float(CM_PER_METRE * _where(~known, distance).mean())


def joined_bones(made: Poses, known: Known) -> float:
    """The error of bones that have a missing end, cm.

    RMS against the true lengths.

    The paper's RMSE_re does not say whether it counts the others, whose length is given;
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
    """How far joints move from one frame to the next where either of the two is missing, mean, cm.

    A motion that is a mean of motions moves too little: set the truth's own step beside it.
    Raises ValueError when nothing is missing.  Notebook: 10
    """
    step = np.linalg.norm(np.diff(np.asarray(made, np.float64), axis=-3), axis=-1)
    return float(CM_PER_METRE * _where(~(known[..., 1:, :] & known[..., :-1, :]), step).mean())


def missing_spread(samples: Float[np.ndarray, "n *B T J 3"], known: Known) -> float:
    """How far n repairs of the same past lie from their mean, cm.

    RMS over the missing joints, with n - 1.

    Repairs that know how uncertain they are spread about as far as the truth is from their mean.
    Raises ValueError for fewer than two repairs, and when nothing is missing.  Notebook: 10
    """
    if len(samples) < 2:
        raise ValueError("a spread needs at least 2 repairs of the same past, got 1")
    variance = np.asarray(samples, np.float64).var(axis=0, ddof=1).sum(-1)
    return float(CM_PER_METRE * np.sqrt(_where(~known, variance).mean()))


def _where(
    counted: Bool[np.ndarray, "..."], values: Float[np.ndarray, "..."]
) -> Float[np.ndarray, "K"]:
    """The values that count; masks of single motions serve all repairs in front."""
    if not counted.any():
        raise ValueError("nothing is missing: there is no repair to measure")
    return values[np.broadcast_to(counted, values.shape)]
