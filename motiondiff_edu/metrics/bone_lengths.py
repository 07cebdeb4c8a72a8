"""Do the limbs keep their length? The networks generate 21 free points; no rule fixes the bones.

Positions are in metres, errors in centimetres, as in the papers' tables. Root frame and world give
the same numbers.
Source: MoDiff IV-B, Tables I and II.  Notebook: 08
"""

import numpy as np
from jaxtyping import Float

from ..motion.skeleton import BONE_LENGTHS, PARENTS

CM_PER_METRE = 100.0


def bone_lengths(positions: Float[np.ndarray, "*B T J 3"]) -> Float[np.ndarray, "*B T bones"]:
    """Length of every bone in every frame, in metres.

    l_b(t) = |p[t, b] - p[t, parent(b)]|, b = 1..20.

    Raises ValueError when the positions are not those of the course's 21 joints.  Notebook: 08
    """
    if positions.shape[-2] != len(PARENTS):
        raise ValueError(
            f"bones are measured on the course's {len(PARENTS)} joints, but these positions have "
            f"{positions.shape[-2]}: retarget the motion first (motion.retarget)"
        )
    positions = np.asarray(positions, np.float64)
    return np.linalg.norm(positions[..., 1:, :] - positions[..., PARENTS[1:], :], axis=-1)


def bone_rmse(
    positions: Float[np.ndarray, "*B T J 3"], reference: Float[np.ndarray, "bones"] = BONE_LENGTHS
) -> float:
    """The bone-length error in cm, over all clips, frames and bones together.

    RMSE = 100 * sqrt( mean over clips, t, b of (l_b(t) - reference_b)^2 ), lengths in metres.
    Constant errors and jitter both count. The paper says "RMSE (cm) of the bone length"; the
    formula is ours.
    Source: MoDiff IV-B, Table I.  Notebook: 08
    """
    return float(CM_PER_METRE * np.sqrt(np.mean((bone_lengths(positions) - reference) ** 2)))


def bone_rmse_within_clip(positions: Float[np.ndarray, "*B T J 3"]) -> float:
    """How much the bone lengths vary within a clip, in cm: the error against the clip's own means.

    RMSE = 100 * sqrt( mean over clips, t, b of (l_b(t) - mean_t l_b)^2 ). A figure that is too
    large but rigid has 0. This measure is ours, beside the paper's.
    """
    lengths = bone_lengths(positions)
    return float(CM_PER_METRE * np.sqrt(np.mean((lengths - lengths.mean(-2, keepdims=True)) ** 2)))
