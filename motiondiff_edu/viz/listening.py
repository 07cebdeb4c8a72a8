"""Plots of attention over the music, and of the change when a sound is silenced.

The functions take plain arrays and return a Figure with a caption.  Notebook: 12
"""

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float
from matplotlib.figure import Figure

from .body import GREY
from .over_time import time_map, waves
from .style import SMALL, figure


def levels_over_sound(
    audio: Float[np.ndarray, "N"],
    sample_rate: int,
    maps: Mapping[str, Float[np.ndarray, "_ M"]],
    token_times: Float[np.ndarray, "M"],
    beats: Float[np.ndarray, "K"],
    seconds: float,
    words: str,
) -> Figure:
    """A song with its beats, and below it where each level reads.

    The x axis is the time of the music, the y axis the time of the dance, which lasts `seconds`.
    Each map has its own scale.
    Source: MoFusion Fig. 4.
    """
    fig, axes = figure(10, 1.6 + 2.3 * len(maps), words, 1 + len(maps), 1, share="x",
                       heights=[1.1, *[2] * len(maps)])  # fmt: skip
    waves(axes[0], audio, sample_rate)
    axes[0].set(title="the song; dotted lines are beats", xlim=(0, seconds))
    for axis, (name, weights) in zip(axes[1:], maps.items(), strict=True):
        time_map(axis, weights, token_times, seconds)
        axis.set(title=name, ylabel="dance (s)")
    for axis in axes:
        for beat in beats[beats < seconds]:
            axis.axvline(beat, color=GREY, lw=1, ls=":")
    axes[-1].set_xlabel("music (s)")
    return fig


def time_maps(
    maps: Mapping[str, Float[np.ndarray, "T M"]],
    columns: Float[np.ndarray, "M"],
    seconds: float,
    words: str,
    labels: tuple[str, str] = ("music (s)", "dance (s)"),
) -> Figure:
    """Maps side by side, each on its own scale: rows over `seconds`, columns at their times.

    On the dashed line both times are equal.
    """
    fig, axes = figure(4.6 * len(maps), 4.4, words, 1, len(maps), share="y")
    for axis, (name, values) in zip(axes, maps.items(), strict=True):
        time_map(axis, values, columns, seconds)
        axis.plot([0, seconds], [0, seconds], color="#D55E00", lw=1.4, ls="--")
        axis.set(title=name, xlabel=labels[0], xlim=(columns[0], columns[-1]), ylim=(seconds, 0))
    axes[0].set_ylabel(labels[1])
    return fig


def weight_and_effect(
    shares: Float[np.ndarray, "T K"],
    moved: Float[np.ndarray, "K T2"],
    times: Float[np.ndarray, "K"],
    seconds: float,
    words: str,
) -> Figure:
    """For each sound at `times`, the attention to it and its effect on the dance.

    Left: the share of attention to the sound in each frame of the dance. Right: how far that frame
    moves (cm) when the sound is silenced.
    """
    fig, axes = figure(11, 4.8, words, 1, 2, share="y")
    pictures = (
        (shares, "attention to the sound", "share"),
        (100 * moved.T, "moved when it is silenced", "cm"),
    )
    for axis, (values, title, unit) in zip(axes, pictures, strict=True):
        image = time_map(axis, values, np.arange(float(len(times))), seconds)
        axis.plot(np.arange(len(times)), times, "D", color="#D55E00", ms=4, mew=0)
        every = -(-len(times) // 8)
        axis.set_xticks(np.arange(0, len(times), every), [f"{t:.1f}" for t in times[::every]])
        axis.set(title=title, xlabel="the sound (s)", ylim=(seconds, 0))
        fig.colorbar(image, ax=axis, shrink=0.85).set_label(unit, fontsize=SMALL)
    axes[0].set_ylabel("dance (s)")
    return fig


def before_and_after(
    pictures: Mapping[str, Float[np.ndarray, "M bands"]],
    times: Float[np.ndarray, "M"],
    marks: Sequence[float],
    words: str,
) -> Figure:
    """Log-Mel spectrograms on one scale, low bands below; dashed lines at `marks` (seconds)."""
    fig, axes = figure(5 * len(pictures), 3.6, words, 1, len(pictures), share="y")
    low = min(p.min() for p in pictures.values())
    top = max(p.max() for p in pictures.values())
    for axis, (name, picture) in zip(axes, pictures.items(), strict=True):
        axis.pcolormesh(
            times,
            np.arange(picture.shape[1]),
            picture.T,
            cmap="magma",
            vmin=low,
            vmax=top,
            shading="nearest",
        )
        for mark in marks:
            axis.axvline(mark, color="white", lw=1.4, ls="--")
        axis.grid(False)
        axis.set(title=name, xlabel="seconds")
    axes[0].set_ylabel("Mel band")
    return fig
