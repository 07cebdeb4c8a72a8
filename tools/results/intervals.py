"""A number with its interval: what it would be on other clips, and with other training seeds."""

import warnings
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
    blocks = _blocks(len(per_clip[0]), groups)

    def drawn(rng: np.random.Generator) -> list[np.ndarray]:
        chosen = _chosen(blocks, rng)
        return [rows[chosen] for rows in per_clip]

    return _bootstrap(value_of, per_clip, drawn, draws)


def interval_over_seeds(
    value_of: Callable[..., float],
    *rows: Float[np.ndarray, "seeds _ *any"],
    groups: np.ndarray | None = None,
    draws: int = DRAWS,
) -> tuple[float, float, float]:
    """The same over training seeds and clips: a row for each seed and a column for each clip.

    One draw serves all arrays, so that a difference of two variants is paired. Arrays with another
    number of columns (a number of the whole training has one) share the draw of the seeds.
    """
    K, lengths = len(rows[0]), dict.fromkeys(x.shape[1] for x in rows)
    blocks = {n: _blocks(n, groups) for n in lengths}

    def drawn(rng: np.random.Generator) -> list[np.ndarray]:
        seeds = rng.integers(K, size=K)
        clips = {n: _chosen(one, rng) for n, one in blocks.items()}
        return [x[np.ix_(seeds, clips[x.shape[1]])] for x in rows]

    return _bootstrap(value_of, rows, drawn, draws)


def _blocks(n: int, groups: np.ndarray | None) -> list[np.ndarray]:
    """The columns that are drawn together."""
    if groups is None or len(groups) != n:
        return list(np.arange(n)[:, None])
    return [np.flatnonzero(groups == one) for one in sorted(set(groups.tolist()))]


def _chosen(blocks: list[np.ndarray], rng: np.random.Generator) -> np.ndarray:
    """As many blocks as there are, with replacement."""
    return np.concatenate([blocks[k] for k in rng.integers(len(blocks), size=len(blocks))])


def _bootstrap(value_of: Callable, rows, drawn: Callable, draws: int) -> tuple[float, float, float]:
    """The value, and the middle 95 % of those of the draws; NaN where there is none."""
    rng = np.random.default_rng(0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # the mean of no numbers
        value = float(value_of(*rows))
        values = [value_of(*drawn(rng)) for _ in range(draws)]
    if not np.isfinite(values).any():
        return value, np.nan, np.nan
    low, high = np.nanpercentile(values, [2.5, 97.5])
    return value, float(low), float(high)
