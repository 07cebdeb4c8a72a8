"""Plots of sound, and of attention over it: waves, spectra, filters, onsets, tempo, beats.

The functions take plain arrays and return a Figure with a caption.  Notebook: 11, 12
"""

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter
from numpy.typing import ArrayLike

from .body import GREY
from .over_time import draw_waveform, time_map
from .style import DASHES, OKABE_ITO, SMALL, figure, legend

# ---- sound ---------------------------------------------------------------------------------------
BLUE, ORANGE, GREEN, PURPLE, YELLOW, SKY, INK = OKABE_ITO[:7]
HEAT = "magma"


def _beats(axis: Axes, beats: Sequence, low: float, high: float, colour: str, name: str) -> None:
    """Dashed lines at the beats within the plot; the first one has a name in the legend."""
    for i, beat in enumerate(beat for beat in beats if low <= beat <= high):
        axis.axvline(beat, color=colour, lw=1.5, ls="--", label=name if i == 0 else None)


def waveform(seconds: ArrayLike, audio: ArrayLike, caption: str, beats: Sequence = ()) -> Figure:
    """Samples over time, with lines at the beats."""
    fig, (axis,) = figure(10, 2.8, caption)
    axis.plot(seconds, audio, color=BLUE, lw=0.7)
    _beats(axis, beats, seconds[0], seconds[-1], ORANGE, "beat")
    axis.set_xlim(seconds[0], seconds[-1])
    axis.set_xlabel("time (s)")
    axis.set_ylabel("sample")
    legend(axis, loc="upper right", frameon=True)
    return fig


def spectra(
    hz: ArrayLike, curves: Mapping[str, np.ndarray], caption: str, *, mark: float | None = None
) -> Figure:
    """Magnitude spectra in decibels, relative to the loudest bin of each."""
    fig, (axis,) = figure(9, 3.4, caption)
    for i, (name, magnitude) in enumerate(curves.items()):
        magnitude = np.asarray(magnitude)
        level = 20 * np.log10(np.maximum(magnitude / magnitude.max(), 1e-6))
        axis.plot(
            hz,
            level,
            color=OKABE_ITO[i % 7],
            ls=DASHES[i % 8],
            label=name,
            marker="." if len(hz) < 120 else None,
        )
    if mark is not None:
        axis.axvline(mark, color=INK, lw=1, ls=":", label=f"{mark:g} Hz")
    axis.set_ylim(-100, 6)
    axis.set_xlabel("frequency (Hz)")
    axis.set_ylabel("level (dB)")
    legend(axis)
    return fig


def filters(hz: ArrayLike, triangles: ArrayLike, caption: str, every: int = 1) -> Figure:
    """Filters (bands, bins) over frequency, one in `every`, each in its own colour."""
    fig, (axis,) = figure(10, 3.2, caption)
    for i, band in enumerate(np.asarray(triangles)[::every]):
        inside = np.flatnonzero(band)
        reach = slice(max(inside[0] - 1, 0), inside[-1] + 2)
        axis.plot(np.asarray(hz)[reach], band[reach], color=OKABE_ITO[i % 7], lw=1.6)
    axis.set_xlabel("frequency (Hz)")
    axis.set_ylabel("weight")
    axis.set_ylim(bottom=0)
    return fig


def spectrogram(
    seconds: ArrayLike,
    frequencies: ArrayLike,
    values: ArrayLike,
    caption: str,
    *,
    beats: Sequence = (),
    top: float | None = None,
    title: str = "",
) -> Figure:
    """Values (M, bins) as colours over time and frequency (Hz, rising).

    `top` is the highest frequency shown.
    """
    fig, (axis,) = figure(10, 3.6, caption)
    _heat(fig, axis, seconds, frequencies, values)
    _beats(axis, beats, seconds[0], seconds[-1], "white", "beat")
    if top is not None:
        axis.set_ylim(frequencies[0], top)
    axis.set_title(title)
    return fig


def mel_spectrogram(
    seconds: ArrayLike,
    centres: ArrayLike,
    values: ArrayLike,
    caption: str,
    *,
    beats: Sequence = (),
    title: str = "",
) -> Figure:
    """Log-Mel values (M, bands) as colours, one row for each band; `centres` are in Hz."""
    fig, (axis,) = figure(10, 3.6, caption)
    rows = np.arange(len(centres))
    marks = (100, 500, 1000, 2000, 4000, 7000)
    _heat(fig, axis, seconds, rows, values)
    axis.set_yticks(np.interp(marks, centres, rows), [str(hz) for hz in marks])
    _beats(axis, beats, seconds[0], seconds[-1], "white", "beat")
    axis.set_title(title)
    return fig


def _heat(fig: Figure, axis: Axes, seconds: ArrayLike, rows: ArrayLike, values: ArrayLike) -> None:
    image = axis.pcolormesh(
        seconds, rows, np.asarray(values).T, cmap=HEAT, shading="nearest", rasterized=True
    )
    fig.colorbar(image, ax=axis, pad=0.01).set_label("log power")
    axis.grid(False)
    axis.set_xlabel("time (s)")
    axis.set_ylabel("frequency (Hz)")


def two_clocks(seconds: ArrayLike, errors: Mapping[str, np.ndarray], caption: str) -> Figure:
    """The error in seconds of each way to match sound frames to motion frames, over time."""
    fig, (axis,) = figure(9, 3.2, caption)
    for i, (name, error) in enumerate(errors.items()):
        axis.plot(seconds, error, color=OKABE_ITO[i % 7], ls=DASHES[i % 8], label=name)
    axis.set_xlabel("time of the motion frame (s)")
    axis.set_ylabel("time of the matched sound\nminus that time (s)")
    legend(axis)
    return fig


def onsets(
    seconds: ArrayLike,
    strength: ArrayLike,
    caption: str,
    beats: Sequence = (),
    found: Sequence = (),
) -> Figure:
    """Onset strength over time, with true beats as lines and the tracker's beats as triangles."""
    fig, (axis,) = figure(10, 3, caption)
    axis.plot(seconds, strength, color=BLUE, lw=1.3, label="onset strength")
    _beats(axis, beats, seconds[0], seconds[-1], ORANGE, "beat, from the score")
    inside = [beat for beat in found if seconds[0] <= beat <= seconds[-1]]
    high = float(np.max(strength))
    if inside:
        axis.plot(
            inside,
            np.full(len(inside), 1.08 * high),
            "v",
            color=GREEN,
            ms=9,
            label="beat, from the tracker",
        )
    axis.set_ylim(0, 1.5 * high)
    axis.set_xlim(seconds[0], seconds[-1])
    axis.set_xlabel("time (s)")
    axis.set_ylabel("strength")
    legend(axis, ncols=3, loc="upper right", frameon=True)
    return fig


def tempogram(
    seconds: ArrayLike,
    tempi: ArrayLike,
    values: ArrayLike,
    tempo: float,
    caption: str,
    lowest: float = 30,
    highest: float = 320,
) -> Figure:
    """How strongly onsets repeat at each tempo (values: tempi, M), over time and on average.

    A dashed line marks the true tempo.
    """
    tempi, values = np.asarray(tempi), np.asarray(values)
    keep = (tempi >= lowest) & (tempi <= highest)
    fig, (left, right) = figure(10, 3.8, caption, 1, 2, share="y", widths=[3, 1])
    left.pcolormesh(
        seconds, tempi[keep], values[keep], cmap=HEAT, shading="nearest", rasterized=True
    )
    left.grid(False)
    left.axhline(tempo, color="white", ls="--", lw=1.5)
    right.plot(values[keep].mean(1), tempi[keep], color=BLUE)
    right.axhline(tempo, color=ORANGE, ls="--", lw=1.5, label=f"{tempo:.0f}, from the score")
    left.set_yscale("log", base=2)
    left.set_yticks([40, 60, 80, 120, 160, 240])
    left.yaxis.set_major_formatter(FuncFormatter(lambda y, _: f"{y:g}"))
    left.set_xlabel("time (s)")
    left.set_ylabel("beats per minute")
    right.set_xlabel("mean")
    legend(right, loc="lower center", bbox_to_anchor=(0.5, 1.0))  # above: the curve is wide
    return fig


def lags(offsets: Mapping[str, np.ndarray], caption: str, lag: float, reach: float = 120) -> Figure:
    """For each song, the delay in ms of each found beat after the nearest true beat.

    A line marks `lag`.
    """
    fig, (axis,) = figure(9, 0.5 * len(offsets) + 1.6, caption)
    for row, values in enumerate(offsets.values()):
        values = np.clip(np.asarray(values), -reach, reach)
        axis.plot(
            values, row + np.linspace(-0.2, 0.2, len(values)), ".", color=BLUE, ms=5, alpha=0.5
        )
        axis.plot(
            [np.median(values)],
            [row],
            "D",
            color=ORANGE,
            ms=9,
            label="median" if row == 0 else None,
        )
    axis.axvline(0, color=INK, lw=1)
    axis.axvline(lag, color=GREEN, ls="--", label=f"{lag:.0f} ms")
    axis.set_yticks(range(len(offsets)), list(offsets))
    axis.set_xlim(-1.04 * reach, 1.04 * reach)
    axis.set_xlabel(f"tracker's beat minus nearest true beat (ms, cut off at {reach:.0f})")
    legend(axis, loc="lower right", frameon=True)
    return fig


# ---- attention over the music --------------------------------------------------------------------
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
    draw_waveform(axes[0], audio, sample_rate)
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
