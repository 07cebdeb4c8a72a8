"""A number with its interval.

Clips are drawn with replacement, and the number is computed again each time.
"""

from collections.abc import Callable

import numpy as np

DRAWS = 2000


def interval(
    value_of: Callable[..., float], *per_clip: np.ndarray, draws: int = DRAWS
) -> tuple[float, float, float]:
    """`value_of` of the rows and its 95 % bootstrap interval.

    Arrays have one row for each clip and are drawn together.

    Draws for which it is NaN (no planted toe in any drawn clip) are left out;
    scipy.stats.bootstrap then has no interval, and it refuses a single clip.
    """
    rng, n = np.random.default_rng(0), len(per_clip[0])
    values = []
    for _ in range(draws):
        chosen = rng.integers(n, size=n)
        values.append(value_of(*(rows[chosen] for rows in per_clip)))
    value = float(value_of(*per_clip))
    low, high = (
        np.nanpercentile(values, [2.5, 97.5]) if np.isfinite(values).any() else (np.nan, np.nan)
    )
    return value, float(low), float(high)
