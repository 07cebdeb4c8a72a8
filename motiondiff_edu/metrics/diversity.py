"""How different are several motions with the same past and control, or the same music?

More is not better: noise scores highest in every measure here. Compare with the data's own value.
Notebook: 08, 14
"""

import numpy as np
from jaxtyping import Float

from ..motion.root_frame import FPS


def spread(
    rollouts: Float[np.ndarray, "*B n T J 3"], fps: float | int = FPS, skip_s: float | int = 1.0
) -> float | Float[np.ndarray, "*B"]:
    """Root-frame RMS spread of n rollouts, in metres, from `skip_s` seconds on.

    Before that the shared past still dominates.

    spread^2 = 1 / (n - 1) * sum_i mean_{t, j} |p_i[t, j] - mean_i p_i[t, j]|^2

    Noise increases the spread as well as choice does. So divide it by the spread of the data's own
    continuations; a good model has the ratio 1. Raises ValueError for fewer than two rollouts, or
    no frames after `skip_s`.
    Notebook: 08
    """
    n, first = rollouts.shape[-4], round(skip_s * fps)
    if n < 2:
        raise ValueError("a spread needs at least 2 rollouts of the same past and control, got 1")
    if rollouts.shape[-3] <= first:
        raise ValueError(
            f"rollouts of {rollouts.shape[-3]} frames end before the spread begins, "
            f"at frame {first}"
        )
    late = np.asarray(rollouts, np.float64)[..., first:, :, :]
    deviation = late - late.mean(-4, keepdims=True)
    return np.sqrt((deviation**2).sum(-1).mean((-2, -1)).sum(-1) / (n - 1))


def diversity(features: Float[np.ndarray, "*B N F"]) -> float | Float[np.ndarray, "*B"]:
    """Mean distance over all N (N - 1) / 2 pairs of (normalised) feature vectors: the papers' Div.

    Normalise by the data first: `frechet.normalise(features, data)`.
    Raises ValueError for fewer than two vectors.
    Source: MoFusion 4.1, Table 1, Table 2.  Notebook: 14
    """
    n = features.shape[-2]
    if n < 2:
        raise ValueError(f"a distance needs at least 2 motions, not {n}")
    first, second = np.triu_indices(n, 1)
    return np.linalg.norm(features[..., first, :] - features[..., second, :], axis=-1).mean(-1)[()]


def multimodality(features: Float[np.ndarray, "B K F"]) -> float:
    """How different the K dances to one piece of music are: the mean distance of their pairs.

    The result is the average over B pieces. The paper uses K = 50 and leaves the rest open; here
    all pairs count, and the features are normalised by the data before.
    Raises ValueError for fewer than two dances per piece.
    Source: MoFusion 4.1, Table 1, Table 2.   Notebook: 14
    """
    return float(np.mean(diversity(features)))
