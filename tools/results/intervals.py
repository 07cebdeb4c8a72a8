"""A number with its interval: what it would be on other clips, and with other training seeds."""

from collections.abc import Callable

import numpy as np
from jaxtyping import Float

DRAWS = 2000


def interval(
    value_of: Callable[..., float],
    *per_clip: np.ndarray,
    groups: np.ndarray | None = None,
    draws: int = DRAWS,
) -> tuple[float, float, float]:
    """`value_of` of the rows and its 95 % bootstrap interval over clips.

    Arrays have one row for each clip and are drawn together. `groups`: whose each clip is; all
    clips of one person are drawn together, for they are not independent. Draws for which the
    number is NaN (no planted toe in any drawn clip) are left out; scipy.stats.bootstrap then has no
    interval, and it refuses a single clip.
    """
    rng, blocks = np.random.default_rng(0), _blocks(len(per_clip[0]), groups)
    values = []
    for _ in range(draws):
        chosen = _drawn(blocks, rng)
        values.append(value_of(*(rows[chosen] for rows in per_clip)))
    return float(value_of(*per_clip)), *_middle(values)


def interval_over_seeds(
    value_of: Callable[..., float],
    *rows: Float[np.ndarray, "seeds _ *any"],
    groups: np.ndarray | None = None,
    draws: int = DRAWS,
) -> tuple[float, float, float]:
    """`value_of` of the rows and its 95 % bootstrap interval over training seeds and clips.

    Arrays have a row for each training seed and a column for each clip. One draw serves all arrays,
    so that a difference of two variants is paired. Arrays with another number of columns (a number
    of the whole training has one) share the draw of the seeds. `groups`: whose each clip is; all
    clips of one person are drawn together.
    """
    rng, K = np.random.default_rng(0), rows[0].shape[0]
    lengths = list(dict.fromkeys(x.shape[1] for x in rows))
    blocks = {n: _blocks(n, groups) for n in lengths}
    values = []
    for _ in range(draws):
        seeds = rng.integers(K, size=K)
        clips = {n: _drawn(one, rng) for n, one in blocks.items()}
        values.append(value_of(*(x[np.ix_(seeds, clips[x.shape[1]])] for x in rows)))
    return float(value_of(*rows)), *_middle(values)


def _blocks(n: int, groups: np.ndarray | None) -> list[np.ndarray]:
    """The columns that are drawn together."""
    if groups is None or len(groups) != n:
        return list(np.arange(n)[:, None])
    return [np.flatnonzero(groups == one) for one in sorted(set(groups.tolist()))]


def _drawn(blocks: list[np.ndarray], rng: np.random.Generator) -> np.ndarray:
    """As many blocks as there are, with replacement."""
    return np.concatenate([blocks[k] for k in rng.integers(len(blocks), size=len(blocks))])


def _middle(values: list[float]) -> tuple[float, float]:
    """The middle 95 % of the numbers; NaN where there are none."""
    if not np.isfinite(values).any():
        return np.nan, np.nan
    low, high = np.nanpercentile(values, [2.5, 97.5])
    return float(low), float(high)
