"""Plots of attention: maps, buckets of time distance, sharpness, weight against measured effect.

A row of a map is a query and sums to one. Groups of keys are named and separated by lines. A map
shows where values are read, not why: a weight is not an explanation.  Notebook: 06
"""

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float, Int
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .body import GREY, INK
from .style import OKABE_ITO, SMALL, figure, legend

Groups = Sequence[tuple[str, int]]  # (name, how many keys), in the order of the keys


def modiff_groups(T_h: int = 10, T_p: int = 10) -> list[tuple[str, int]]:
    """The keys of MoDiff's memory in order: past poses, control of the past and of the future."""
    return [("past poses", T_h), ("control, past", T_h), ("control, future", T_p)]


def attention_map(
    weights: Float[np.ndarray, "T M"],
    groups: Groups | None = None,
    query_labels: Sequence[str] | None = None,
    key_labels: Sequence[str] | None = None,
    title: str = "",
    query_name: str = "future frame (query)",
    key_name: str = "key",
) -> Figure:
    """One attention map; larger weights are darker.

    For several heads pass one of them or their mean.

    Raises ValueError if groups or labels do not fit the map.
    """
    _check(weights.shape, groups, query_labels, key_labels)
    T, M = weights.shape
    words = f"Attention of {T} queries over {M} keys; each row sums to one, darker is more."
    fig, (axis,) = figure(
        min(12, 3.2 + 0.3 * M), min(9, 2.4 + 0.3 * T), f"{title}: {words}" if title else words
    )
    image = _paint(axis, weights, groups, float(weights.max()))
    axis.set(xlabel=key_name, ylabel=query_name)
    axis.set_title(title, pad=34 if groups else 8)
    _label(axis.set_xticks, M, key_labels)
    _label(axis.set_yticks, T, query_labels)
    fig.colorbar(image, ax=axis, label="weight", shrink=0.85)
    return fig


def _check(
    shape: tuple, groups: Groups | None, query_labels: Sequence | None, key_labels: Sequence | None
) -> None:
    T, M = shape
    if groups is not None and sum(count for _, count in groups) != M:
        raise ValueError(f"the groups have {sum(c for _, c in groups)} keys, but the map has {M}")
    for labels, size, what in ((query_labels, T, "query"), (key_labels, M, "key")):
        if labels is not None and len(labels) != size:
            raise ValueError(f"{len(labels)} {what} labels for {size} {what} positions")


def _paint(axis: Axes, weights: np.ndarray, groups: Groups | None, top: float):
    image = axis.imshow(
        weights, cmap="Blues", vmin=0, vmax=top, aspect="auto", interpolation="nearest"
    )
    axis.grid(False)
    first = 0
    for name, count in groups or []:
        if first:
            axis.axvline(first - 0.5, color=INK, lw=1.2)
        axis.text(first + count / 2 - 0.5, -0.75, name, ha="center", va="bottom", fontsize=SMALL)
        first += count
    return image


def _label(set_ticks, size: int, labels: Sequence[str] | None) -> None:
    """All labels if they fit, else every few; without labels, frames are counted from 1."""
    every = 1 if size <= 12 else 2 if size <= 24 else 5
    ticks = np.arange(0 if every == 1 or labels is not None else every - 1, size, every)
    set_ticks(ticks, [labels[i] if labels is not None else str(i + 1) for i in ticks], fontsize=10)


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
