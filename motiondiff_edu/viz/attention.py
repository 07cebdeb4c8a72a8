"""Attention maps: which query reads which keys.

A row is a query and sums to one. Groups of keys are named and separated by lines. A map shows where
values are read, not why: a weight is not an explanation.  Notebook: 06
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .body import INK
from .style import SMALL, figure

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
        axis.text(
            first + count / 2 - 0.5,
            -0.75,
            name,
            ha="center",
            va="bottom",
            fontsize=SMALL,
        )
        first += count
    return image


def _label(set_ticks, size: int, labels: Sequence[str] | None) -> None:
    """All labels if they fit, else every few; without labels, frames are counted from 1."""
    every = 1 if size <= 12 else 2 if size <= 24 else 5
    ticks = np.arange(0 if every == 1 or labels is not None else every - 1, size, every)
    set_ticks(ticks, [labels[i] if labels is not None else str(i + 1) for i in ticks], fontsize=10)
