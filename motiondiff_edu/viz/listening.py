"""What is read in the music, over the sound itself; and beside it what a silenced sound changes.

Plain arrays in, a captioned Figure out.  Notebook: 12
"""

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .style import SMALL, figure

GREY = "#5B6472"


def levels_over_sound(
    audio: Float[np.ndarray, "N"],
    maps: Mapping[str, Float[np.ndarray, "_ M"]],
    token_times: Float[np.ndarray, "M"],
    beats: Float[np.ndarray, "K"],
    seconds: float,
    words: str,
    sample_rate: int = 16_000,
) -> Figure:
    """A song with its beats, and below it where each level reads while the dance of `seconds` goes on, as in the paper.

    Across: the music's time. Downwards: the dance's. Each map has its own scale; one alone, larger, is drawn by
    `attention.attention_over_sound`.  Source: MoFusion Fig. 4.
    """
    fig, axes = figure(10, 1.6 + 2.3 * len(maps), words, 1 + len(maps), 1, sharex=True,
                       gridspec_kw={"height_ratios": [1.1, *[2] * len(maps)]})  # fmt: skip
    waves(axes[0], audio, sample_rate)
    axes[0].set(title="the song; dotted lines are beats", yticks=[], xlim=(0, seconds))
    for axis, (name, weights) in zip(axes[1:], maps.items(), strict=True):
        paint(axis, weights, token_times, seconds)
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
    """Maps side by side, each on its own scale: rows over `seconds`, columns at their times; dashed: one moment."""
    fig, axes = figure(4.6 * len(maps), 4.4, words, 1, len(maps), sharey=True)
    for axis, (name, values) in zip(axes, maps.items(), strict=True):
        paint(axis, values, columns, seconds)
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
    """For each sound at `times`: left how much attention each moment of the dance gives it, right how far it moves
    that moment (cm) when it is silenced."""
    fig, axes = figure(11, 4.8, words, 1, 2, sharey=True)
    pictures = ((shares, "attention to the sound", "share"), (100 * moved.T, "moved when it is silenced", "cm"))
    for axis, (values, title, unit) in zip(axes, pictures, strict=True):
        image = paint(axis, values, np.arange(float(len(times))), seconds)
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
    fig, axes = figure(5 * len(pictures), 3.6, words, 1, len(pictures), sharey=True)
    low, top = min(p.min() for p in pictures.values()), max(p.max() for p in pictures.values())
    for axis, (name, picture) in zip(axes, pictures.items(), strict=True):
        axis.pcolormesh(
            times, np.arange(picture.shape[1]), picture.T, cmap="magma", vmin=low, vmax=top, shading="nearest"
        )
        for mark in marks:
            axis.axvline(mark, color="white", lw=1.4, ls="--")
        axis.grid(False)
        axis.set(title=name, xlabel="seconds")
    axes[0].set_ylabel("Mel band")
    return fig


def waves(axis: Axes, audio: Float[np.ndarray, "N"], sample_rate: int, bins: int = 1200) -> None:
    """A waveform: the lowest and highest sample of each of `bins` stretches."""
    stretches = np.array_split(audio, min(bins, len(audio)))
    low, high = (np.array([pick(part) for part in stretches]) for pick in (np.min, np.max))
    axis.fill_between(np.linspace(0, len(audio) / sample_rate, len(low)), low, high, color="#1F2933", lw=0)
    axis.grid(False)


def paint(axis: Axes, values: Float[np.ndarray, "T M"], columns: Float[np.ndarray, "M"], seconds: float):
    """A map whose rows share `seconds` evenly, from the top down; the larger, the darker."""
    middle = (columns[1:] + columns[:-1]) / 2 if len(columns) > 1 else columns
    edges = np.concatenate([[2 * columns[0] - middle[0]], middle, [2 * columns[-1] - middle[-1]]])
    if len(columns) == 1:
        edges = np.array([columns[0] - 0.5, columns[0] + 0.5])
    rows = np.linspace(0, seconds, len(values) + 1)
    image = axis.pcolormesh(edges, rows, values, cmap="Purples", vmin=min(0, values.min()), vmax=values.max())
    axis.set_ylim(seconds, 0)
    axis.grid(False)
    return image
