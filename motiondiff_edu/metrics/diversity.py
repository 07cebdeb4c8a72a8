"""How different are several continuations of one past under one control? More is not better: the data have a spread.

Notebook: 08
"""

import numpy as np
from jaxtyping import Float

from ..motion.root_frame import FPS


def spread(
    rollouts: Float[np.ndarray, "*B n T J 3"], fps: float | int = FPS, skip_s: float | int = 1.0
) -> float | Float[np.ndarray, "*B"]:
    """Root-frame RMS spread of n rollouts, in metres, from `skip_s` seconds on (before, the shared past still rules).

    spread^2 = 1 / (n - 1) * sum_i mean_{t, j} |p_i[t, j] - mean_i p_i[t, j]|^2
    Noise spreads as well as choice does: read it as a ratio to the spread of the data's own continuations, which a
    good model has at 1. Raises ValueError for fewer than two rollouts, or none left after `skip_s`.  Notebook: 08
    """
    n, first = rollouts.shape[-4], round(skip_s * fps)
    if n < 2:
        raise ValueError("a spread needs at least 2 rollouts of the same past and control, got 1")
    if rollouts.shape[-3] <= first:
        raise ValueError(f"rollouts of {rollouts.shape[-3]} frames end before the spread begins, at frame {first}")
    late = np.asarray(rollouts, np.float64)[..., first:, :, :]
    deviation = late - late.mean(-4, keepdims=True)
    return np.sqrt((deviation**2).sum(-1).mean((-2, -1)).sum(-1) / (n - 1))
