"""Plots of in-betweens: conditionals in the plane, methods against the right answer, masks, joints.

The functions take plain arrays and return a Figure with a caption.  Notebook: 15
"""

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Bool, Float
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from .body import GREY, INK
from .noise import histogram
from .style import DASHES, OKABE_ITO, SMALL, figure, legend

GIVEN, OPEN = "#9BC4E2", "#F4F4F4"


def slice_of_plane(
    data: Float[np.ndarray, "N 2"],
    at: float,
    made: Mapping[str, Float[np.ndarray, "_"]],
    grid: Float[np.ndarray, "M"],
    density: Float[np.ndarray, "M"],
    words: str,
) -> Figure:
    """Points of a plane, and what several methods fill in on one vertical line of it.

    The line's first coordinate is `at`. The plane shows the samples of the first method. Beside it,
    each method has a histogram under the true conditional density.
    """
    fig, (plane, *beside) = figure(4.0 + 2.5 * len(made), 4.2, words, 1, 1 + len(made), share="y",
                                   widths=[1.7, *[1] * len(made)])  # fmt: skip
    plane.plot(*np.asarray(data).T, ".", ms=3, color=GREY, alpha=0.4)
    plane.axvline(at, color=OKABE_ITO[1], lw=1.5)
    first = np.asarray(next(iter(made.values())))[:300]
    plane.plot(np.full(len(first), at), first, "_", ms=9, color=OKABE_ITO[1], alpha=0.5)
    plane.set(title="the data", xlabel="x, given", ylabel="y, unknown")
    for k, (axis, (name, y)) in enumerate(zip(beside, made.items(), strict=True)):
        histogram(axis, y, grid, 60, OKABE_ITO[(1, 0, 2)[k % 3]], "horizontal")
        axis.plot(density, grid, color=INK, lw=2, label="p(y | x), exact" if k == 0 else None)
        axis.set(title=name, xlim=(0, 1.7 * float(max(density))), xlabel="density")
    plane.set_ylim(float(grid[0]), float(grid[-1]))
    legend(beside[0], loc="upper right")
    return fig


def ways(
    found: Mapping[str, Mapping[str, Sequence[float]]],
    right: Mapping[str, float],
    titles: Mapping[str, str],
    words: str,
) -> Figure:
    """A panel for each measure, with a row for each method.

    Each seed has a dot; a line marks the right answer.
    """
    fig, axes = figure(
        3.0 + 3.4 * len(right), 1.4 + 0.45 * len(found), words, 1, len(right), share="y"
    )
    for k, (axis, (name, value)) in enumerate(zip(axes, right.items(), strict=True)):
        axis.axvline(value, color=INK, lw=1.4, ls=":")
        for row, figures in enumerate(found.values()):
            axis.plot(
                figures[name],
                [row] * len(figures[name]),
                "o",
                ms=8,
                color=OKABE_ITO[k % 7],
                alpha=0.75,
            )
        axis.set(title=titles[name], ylim=(len(found) - 0.5, -0.5))
        low, high = axis.get_xlim()
        axis.set_xlim(min(low, 0), max(high, 1.2 * value))
    axes[0].set_yticks(range(len(found)), list(found))
    return fig


def masks(
    known: Mapping[str, Bool[np.ndarray, "T J"]], words: str, fps: float | int = 20
) -> Figure:
    """A panel for each mask, three in a row: joints from top to bottom, time to the right."""
    rows = -(-len(known) // 3)
    columns = min(len(known), 3)
    fig, axes = figure(10, 0.5 + 2.6 * rows, words, rows, columns, share="xy")
    for axis in axes[len(known) :]:
        axis.remove()
    for axis, (name, mask) in zip(axes, known.items(), strict=False):
        extent = (0, len(mask) / fps, mask.shape[1] - 0.5, -0.5)
        colours = ListedColormap([OPEN, GIVEN])
        axis.imshow(
            mask.T,
            cmap=colours,
            vmin=0,
            vmax=1,
            extent=extent,
            aspect="auto",
            interpolation="nearest",
        )
        axis.set_title(name)
        axis.grid(False)
    fig.supxlabel("time (s)")
    fig.supylabel("joint")
    keys = [Patch(color=GIVEN, label="given"), Patch(fc=OPEN, ec=GREY, label="to be generated")]
    fig.legend(handles=keys, loc="outside lower right", ncols=2, frameon=False, fontsize=SMALL)
    return fig


def over_time(
    samples: Float[np.ndarray, "N T"],
    lines: Mapping[str, Float[np.ndarray, "T"]],
    given: Bool[np.ndarray, "T"],
    words: str,
    ylabel: str,
    fps: float | int = 20,
) -> Figure:
    """One value of a pose over time: samples as thin lines, other motions as named lines.

    Given frames are shaded.
    """
    fig, (axis,) = figure(9, 3.8, words)
    seconds = np.arange(len(given)) / fps
    edge = np.flatnonzero(np.diff(np.pad(given.astype(int), 1)))
    for k, (first, last) in enumerate(edge.reshape(-1, 2)):
        ends = (first - 0.5) / fps, (last - 0.5) / fps
        axis.axvspan(*ends, color=GIVEN, alpha=0.6, lw=0, label="given" if k == 0 else None)
    for k, sample in enumerate(samples):
        axis.plot(
            seconds,
            sample,
            color=OKABE_ITO[0],
            lw=1.1,
            alpha=0.6,
            label="samples" if k == 0 else None,
        )
    for k, (name, line) in enumerate(lines.items()):
        axis.plot(seconds, line, color=(INK, *OKABE_ITO[1:4])[k % 4], ls=DASHES[k % 8], label=name)
    axis.set(xlabel="time (s)", ylabel=ylabel, xlim=(seconds[0], seconds[-1]))
    fig.legend(
        *axis.get_legend_handles_labels(),
        loc="outside lower right",
        ncols=5,
        frameon=False,
        fontsize=SMALL,
    )
    return fig
