"""Plots of measured dances: where they slow down, scores with their chance level, repetition.

The functions take plain arrays and return a Figure with a caption.  Notebook: 14
"""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator

from ..metrics.dances import kinematic_beats, smooth_speed
from ..motion.resample import DANCE_FPS, resample
from .body import GREY, INK
from .style import DASHES, MARKERS, OKABE_ITO, SMALL, figure, legend


def stops_and_beats(
    dances: Mapping[str, Float[np.ndarray, "_ J 3"]],
    music: Float[np.ndarray, "M"],
    words: str,
    fps: float | int = 20,
) -> Figure:
    """Each dance's smoothed mean joint speed, dots where it slows down, lines at music beats.

    Each dance has one row.
    """
    fig, axes = figure(10, 0.9 + 1.9 * len(dances), words, rows=len(dances), share="x")
    for axis, (name, positions) in zip(axes, dances.items(), strict=True):
        fine = resample(positions, fps) if fps < DANCE_FPS else positions
        rate = max(fps, DANCE_FPS)
        speed = smooth_speed(fine, rate)
        stops = kinematic_beats(positions, fps)
        times = (np.arange(len(speed)) + 0.5) / rate
        shown = music[(music >= 0) & (music <= times[-1])]
        axis.vlines(
            shown,
            0,
            1,
            GREY,
            ls=":",
            lw=1.4,
            transform=axis.get_xaxis_transform(),
            label="beat of the music",
        )
        axis.plot(times, speed, color=OKABE_ITO[0], label="mean joint speed")
        axis.plot(
            stops,
            np.interp(stops, times, speed),
            "o",
            color=OKABE_ITO[1],
            ms=8,
            label="kinematic beat",
        )
        axis.set(title=name, ylabel="m/s", ylim=(0, None))
        axis.grid(False)
    axes[-1].set_xlabel("time (s)")
    fig.legend(
        *axes[0].get_legend_handles_labels(),
        loc="outside lower right",
        ncols=3,
        frameon=False,
        fontsize=SMALL,
    )
    return fig


Pairs = Mapping[str, Mapping[str, tuple[float, float]]]  # panel -> row -> (value, reference)


def beside_chance(panels: Pairs, words: str) -> Figure:
    """A panel for each score, with a bar for each dance and a line at its chance level.

    panels[score][dance] = (value, chance).
    """
    fig, axes = _bars(panels, words, "chance", "{:.2f}")
    for axis in axes:
        axis.set_xlim(0, 1.15)
    return fig


def beside_floor(panels: Pairs, words: str) -> Figure:
    """The same for distances; the line is their floor.

    Distances have no upper limit, so the axis is logarithmic above 1.
    """
    fig, axes = _bars(panels, words, "data against data", "{:.0f}")
    highest = max(max(pair) for rows in panels.values() for pair in rows.values())
    for axis in axes:
        axis.set_xscale("symlog", linthresh=1.0)
        axis.set_xlim(0, 12 * highest)
        ticks = [0, *(10**k for k in range(0, int(np.log10(highest)) + 1))]
        axis.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        axis.minorticks_off()
    return fig


def _bars(panels: Pairs, words: str, mark: str, form: str) -> tuple[Figure, list[Axes]]:
    rows = list(next(iter(panels.values())))
    fig, axes = figure(
        2.4 + 4.2 * len(panels), 1.5 + 0.5 * len(rows), words, 1, len(panels), share="y"
    )
    for axis, (title, pairs) in zip(axes, panels.items(), strict=True):
        for k, (value, beside) in enumerate(pairs.values()):
            axis.barh(k, value, height=0.6, color=OKABE_ITO[5])
            place = {"xytext": (6, 0), "textcoords": "offset points", "va": "center", "color": INK}
            axis.annotate(
                form.format(value),
                (max(value, beside) if value > 0.8 * beside else value, k),
                **place,
            )
            axis.plot(
                [beside] * 2,
                [k - 0.4, k + 0.4],
                color=OKABE_ITO[1],
                lw=3,
                label=mark if k == 0 else None,
            )
        axis.set(title=title, ylim=(len(rows) - 0.5, -0.5))
        axis.grid(False)
    axes[0].set_yticks(range(len(rows)), rows)
    fig.legend(
        *axes[0].get_legend_handles_labels(),
        loc="outside lower right",
        frameon=False,
        fontsize=SMALL,
    )
    return fig, axes


def chance_over_tempo(
    tempo: Float[np.ndarray, "N"],
    chance: Float[np.ndarray, "N"],
    published: Mapping[str, float],
    words: str,
) -> Figure:
    """The chance level over the music's tempo, with published scores as horizontal lines."""
    fig, (axis,) = figure(9, 4.2, words)
    axis.plot(tempo, chance, color=OKABE_ITO[1], lw=3, label="stops at random times")
    for k, (name, score) in enumerate(published.items()):
        axis.axhline(
            score,
            color=OKABE_ITO[(0, 2, 3, 4)[k % 4]],
            ls=DASHES[1 + k % 7],
            label=f"{name}: {score:g}",
        )
    axis.set(
        xlabel="tempo of the music (BPM)", ylabel="beat alignment", ylim=(0, 1.4 * chance.max())
    )
    legend(axis, loc="lower right")
    return fig


def over_clips(
    sizes: Float[np.ndarray, "N"],
    curves: Mapping[str, tuple[Float[np.ndarray, "N"], Float[np.ndarray, "N"]]],
    words: str,
) -> Figure:
    """A distance over the number of clips, with a band of one standard deviation.

    Both axes are logarithmic.
    """
    fig, (axis,) = figure(9, 4.2, words)
    for k, (name, (mean, std)) in enumerate(curves.items()):
        axis.plot(
            sizes, mean, color=OKABE_ITO[k % 7], ls=DASHES[k % 8], marker=MARKERS[k % 8], label=name
        )
        axis.fill_between(
            sizes,
            np.maximum(mean - std, mean / 10),
            mean + std,
            color=OKABE_ITO[k % 7],
            alpha=0.15,
            lw=0,
        )
    axis.set(xlabel="clips", ylabel="Frechet distance", xscale="log", yscale="log")
    axis.set_xticks(sizes, [f"{n:g}" for n in sizes])
    axis.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.minorticks_off()
    legend(axis)
    return fig


def similarity_matrices(
    matrices: Mapping[str, Float[np.ndarray, "_ _"]], words: str, fps: float | int = 20
) -> Figure:
    """Self-similarity of several dances side by side, time against time.

    Dark blue means equal poses, red opposite ones.
    """
    fig, axes = figure(4.1 * len(matrices) + 0.8, 4.4, words, 1, len(matrices))
    for k, (axis, (name, matrix)) in enumerate(zip(axes, matrices.items(), strict=True)):
        seconds = len(matrix) / fps
        extent = (0.0, seconds, seconds, 0.0)
        image = axis.imshow(
            matrix, cmap="RdBu", vmin=-1, vmax=1, extent=extent, interpolation="nearest"
        )
        axis.set(title=name, xlabel="time (s)", ylabel="time (s)" if k == 0 else "")
        axis.grid(False)
    fig.colorbar(image, ax=axes, label="similarity", shrink=0.8)
    return fig
