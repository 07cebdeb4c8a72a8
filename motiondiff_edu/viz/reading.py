"""Plots of attention: buckets of time distance, sharpness, and weight against measured effect.

The functions take plain arrays and return a Figure with a caption.  Notebook: 06
"""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float, Int
from matplotlib.figure import Figure

from .body import GREY
from .style import OKABE_ITO, figure, legend


def bucket_map(
    distance: Int[np.ndarray, "N"], bucket: Int[np.ndarray, "N"], window: int, words: str
) -> Figure:
    """Bucket over time distance (frames, key minus query); distances within +-window are shaded."""
    fig, (axis,) = figure(9, 3.8, words)
    for past, colour, name in (
        (True, OKABE_ITO[0], "key in the past"),
        (False, OKABE_ITO[1], "key in the future"),
    ):
        side = distance <= 0 if past else distance > 0
        axis.plot(
            distance[side], bucket[side], "o" if past else "s", color=colour, ms=3, label=name
        )
    axis.axvspan(-window, window, color=GREY, alpha=0.12, label="within MoDiff's window")
    axis.set(xlabel="time of the key minus time of the query (frames)", ylabel="bucket")
    legend(axis, loc="center right")
    return fig


def sharpness(
    sizes: Int[np.ndarray, "N"],
    curves: Mapping[str, Float[np.ndarray, "N"]],
    floor: float,
    words: str,
) -> Figure:
    """The largest weight of a row over the size d of queries and keys.

    `floor` is its value for equal weights.
    """
    fig, (axis,) = figure(9, 3.8, words)
    for k, (name, values) in enumerate(curves.items()):
        axis.plot(
            sizes,
            values,
            color=OKABE_ITO[k % 7],
            marker="os"[k % 2],
            ls=("-", "--")[k % 2],
            label=name,
        )
    axis.axhline(floor, color=GREY, lw=1.2, ls=":", label="all weights equal")
    axis.set(xlabel="size d of queries and keys", ylabel="largest weight (mean)", ylim=(0, 1.02))
    axis.set_xscale("log", base=2)
    legend(axis)
    return fig


def weight_against_effect(
    weight: Float[np.ndarray, "B M"],
    effect: Float[np.ndarray, "B M"],
    groups: list[tuple[str, int]],
    words: str,
) -> Figure:
    """The attention to each key of each example, against the effect of hiding the key.

    Both are divided by their group's mean in the example, because some examples move more than
    others, whichever key is hidden.
    """
    fig, axes = figure(4.4 * len(groups), 4.2, words, 1, len(groups), share="y")
    first = 0
    for k, (axis, (name, count)) in enumerate(zip(axes, groups, strict=True)):
        x, y = (values[:, first : first + count] for values in (weight, effect))
        x, y = x / x.mean(1, keepdims=True), y / y.mean(1, keepdims=True)
        axis.plot([0, x.max()], [0, x.max()], color=GREY, lw=1.2, ls=":")
        axis.plot(x.ravel(), y.ravel(), ".", color=OKABE_ITO[k % 7], alpha=0.35, ms=6)
        axis.set(title=name, xlabel="attention / mean", ylim=(0, None))
        first += count
    axes[0].set_ylabel("effect of hiding / mean")
    return fig
