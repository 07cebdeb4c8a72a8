"""Attention maps: who looks where. A row is a query and sums to one; groups of keys are named and parted by lines.

A map says where values were read, not why: a weight is not an explanation.  Notebook: 06
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .style import MEDIUM, OKABE_ITO, SMALL, figure

Groups = Sequence[tuple[str, int]]  # (name, how many keys), in the order of the keys


def modiff_groups(T_h: int = 10, T_p: int = 10) -> list[tuple[str, int]]:
    """The keys of MoDiff's memory, in order: past poses, control of the past, control of the future."""
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
    """One map, dark where much is read. `weights` of several heads: take one, or their mean, or `attention_heads`.

    Raises ValueError where groups or labels do not fit the map.
    """
    _check(weights.shape, groups, query_labels, key_labels)
    T, M = weights.shape
    words = f"Attention of {T} queries over {M} keys; each row sums to one, darker is more."
    fig, (axis,) = figure(min(12, 3.2 + 0.3 * M), min(9, 2.4 + 0.3 * T), f"{title}: {words}" if title else words)
    image = _paint(axis, weights, groups, float(weights.max()))
    axis.set(xlabel=key_name, ylabel=query_name)
    axis.set_title(title, pad=34 if groups else 8)
    _label(axis.set_xticks, M, key_labels)
    _label(axis.set_yticks, T, query_labels)
    fig.colorbar(image, ax=axis, label="weight", shrink=0.85)
    return fig


def attention_heads(
    weights: Float[np.ndarray, "H T M"], groups: Groups | None = None, titles: Sequence[str] | None = None
) -> Figure:
    """A map for each head, all on one scale."""
    _check(weights.shape[1:], groups, None, None)
    heads = len(weights)
    columns = min(heads, 4)
    rows = -(-heads // columns)
    words = f"Attention maps of {heads} heads on one scale; rows are queries, darker is more."
    fig, axes = figure(3.6 * columns, 3.4 * rows + 0.4, words, rows, columns)
    for i, axis in enumerate(axes):
        if i >= heads:
            axis.set_axis_off()
            continue
        image = _paint(axis, weights[i], groups, float(weights.max()), short=True)
        axis.set_title(titles[i] if titles else f"head {i + 1}", pad=36 if groups else 6)
        _label(axis.set_xticks, weights.shape[2], None)
        _label(axis.set_yticks, weights.shape[1], None)
    fig.colorbar(image, ax=axes, label="weight", shrink=0.8)
    fig.supxlabel("key", fontsize=MEDIUM)
    fig.supylabel("query", fontsize=MEDIUM)
    return fig


def group_shares(weights: Float[np.ndarray, "T M"], groups: Groups, title: str = "") -> Figure:
    """How much of each query's attention goes to each group of keys: stacked bars that reach one."""
    _check(weights.shape, groups, None, None)
    words = "Share of each query's attention that goes to " + ", ".join(name for name, _ in groups) + "."
    fig, (axis,) = figure(9, 3.8, words)
    bottom, first = np.zeros(len(weights)), 0
    hatches = ("", "//", "..", "xx", "\\\\")
    for k, (name, count) in enumerate(groups):
        share = weights[:, first : first + count].sum(1)
        style = {"color": OKABE_ITO[k % 7], "hatch": hatches[k % 5], "edgecolor": "white"}
        axis.bar(np.arange(1, len(weights) + 1), share, bottom=bottom, label=name, width=0.85, **style)
        bottom, first = bottom + share, first + count
    axis.set(xlabel="future frame (query)", ylabel="share", ylim=(0, 1), title=title)
    axis.set_xticks(np.arange(1, len(weights) + 1, -(-len(weights) // 20)))
    axis.legend(frameon=False, fontsize=SMALL, loc="center left", bbox_to_anchor=(1, 0.5))
    return fig


def attention_over_sound(
    weights: Float[np.ndarray, "T M"],
    token_times: Float[np.ndarray, "M"],
    audio: Float[np.ndarray, "N"],
    sample_rate: float | int = 16_000,
    fps: float | int = 20.0,
    beats: Float[np.ndarray, "K"] | None = None,
    downbeats: Float[np.ndarray, "K2"] | None = None,
    title: str = "",
) -> Figure:
    """The waveform with its beats above the map of who looks where in it, on one axis of time.

    A row of the map is a moment of the motion (`fps` rows a second), a column a token at its time in seconds. On the
    dashed line a moment looks at itself. Raises ValueError where times do not fit the map.
    Source: MoFusion Fig. 4  Notebook: 12
    """
    if token_times.shape != weights.shape[1:] or len(token_times) < 2 or (np.diff(token_times) <= 0).any():
        raise ValueError(f"token_times are {weights.shape[1]} (two or more) increasing seconds: {token_times!r:.80}")
    T, seconds = len(weights), len(audio) / sample_rate
    words = (
        f"Attention of {T / fps:.1f} s of motion over {seconds:.1f} s of music, below its waveform; a row sums to one, "
        "darker is more; on the dashed line motion and music are at the same moment; upright lines are beats."
    )
    fig, (wave, axis) = figure(10, 6.6, f"{title}: {words}" if title else words, 2, sharex=True, height_ratios=(1, 3))
    _waveform(wave, audio, sample_rate)
    middle = (token_times[1:] + token_times[:-1]) / 2
    edges = np.concatenate([2 * token_times[:1] - middle[:1], middle, 2 * token_times[-1:] - middle[-1:]])
    rows = np.arange(T + 1) / fps
    image = axis.pcolormesh(edges, rows, weights, cmap="Blues", vmin=0, rasterized=True)
    for panel, alpha in ((wave, 0.6), (axis, 0.3)):
        panel.grid(False)
        for times, width in ((beats, 0.8), (downbeats, 2.0)):
            for t in () if times is None else times:
                panel.axvline(t, color=OKABE_ITO[1], lw=width, alpha=alpha)
    axis.plot([0, T / fps], [0, T / fps], "--", color="#1F2933", lw=1.2)
    axis.set(xlabel="music, s", ylabel="motion, s", ylim=(T / fps, 0), xlim=(0, seconds))
    wave.set_title(title)
    fig.colorbar(image, ax=axis, label="weight", shrink=0.85)
    return fig


def _waveform(axis: Axes, audio: np.ndarray, sample_rate: float | int, bins: int = 1200) -> None:
    starts = np.linspace(0, len(audio), min(bins, len(audio)) + 1).astype(int)[:-1]
    low, high = np.minimum.reduceat(audio, starts), np.maximum.reduceat(audio, starts)
    axis.fill_between(starts / sample_rate, low, high, color="#5B6472", lw=0.3)
    axis.set(yticks=[], ylabel="sound")


def _check(shape: tuple, groups: Groups | None, query_labels: Sequence | None, key_labels: Sequence | None) -> None:
    T, M = shape
    if groups is not None and sum(count for _, count in groups) != M:
        raise ValueError(f"the groups have {sum(c for _, c in groups)} keys, the map has {M}")
    for labels, size, what in ((query_labels, T, "query"), (key_labels, M, "key")):
        if labels is not None and len(labels) != size:
            raise ValueError(f"{len(labels)} {what} labels for {size} {what} positions")


def _paint(axis: Axes, weights: np.ndarray, groups: Groups | None, top: float, short: bool = False):
    image = axis.imshow(weights, cmap="Blues", vmin=0, vmax=top, aspect="auto", interpolation="nearest")
    axis.grid(False)
    first = 0
    for name, count in groups or []:
        if first:
            axis.axvline(first - 0.5, color="#1F2933", lw=1.2)
        words = name.replace(", ", "\n").replace(" ", "\n") if short else name
        axis.text(first + count / 2 - 0.5, -0.75, words, ha="center", va="bottom", fontsize=9 if short else SMALL)
        first += count
    return image


def _label(set_ticks, size: int, labels: Sequence[str] | None) -> None:
    """All labels where they fit, else every few; frames are counted from 1."""
    every = 1 if size <= 12 else 2 if size <= 24 else 5
    ticks = np.arange(0 if every == 1 or labels is not None else every - 1, size, every)
    set_ticks(ticks, [labels[i] if labels is not None else str(i + 1) for i in ticks], fontsize=10)
