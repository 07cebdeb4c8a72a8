"""Plots of what is filled in: repairs round by round, faults against methods, in-betweens.

The functions take plain arrays and return a Figure with a caption.  Notebook: 10, 15
"""

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Bool, Float
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import LogLocator, NullFormatter

from ..motion.skeleton import BONES, HIPS
from . import body
from .body import GREY, INK
from .noise import histogram
from .skeleton import SIDES, draw_pose, name_row
from .style import DASHES, LARGE, MARKERS, MEDIUM, OKABE_ITO, SMALL, figure, legend

# ---- repairs -------------------------------------------------------------------------------------
GHOST = "#009E73"
_CAMERA, _SIZE = body.Camera(focal=2.3), (270, 420)  # as in `draw_pose`


def by_round(
    panels: Mapping[str, Mapping[str, Sequence[float]]],
    words: str,
    marks: Mapping[str, tuple[str, float]] | None = None,
) -> Figure:
    """One panel for each measure, with a line for each fault and a point for each round.

    `marks` are dotted horizontal lines.
    """
    fig, axes = figure(5.2 * len(panels), 4, words, 1, len(panels))
    for axis, (measure, lines) in zip(axes, panels.items(), strict=True):
        for i, (label, values) in enumerate(lines.items()):
            axis.plot(
                np.arange(1, len(values) + 1),
                values,
                ls=DASHES[i % 8],
                marker=MARKERS[i % 8],
                label=label,
            )
        if measure in (marks or {}):
            name, level = marks[measure]
            axis.axhline(
                level, color=body.INK, ls=":", lw=1.2, label=name
            )  # its name is in the legend, because points lie near the line
        axis.set(xlabel="round", title=measure, ylim=(0, None))
        axis.xaxis.get_major_locator().set_params(integer=True)
    legend(axes[0])
    return fig


def with_ghosts(
    poses: Mapping[str, Float[np.ndarray, "T 21 3"]],
    samples: Mapping[str, Float[np.ndarray, "n T 21 3"]],
    known: Bool[np.ndarray, "T 21"],
    words: str,
    frames: Sequence[int],
) -> Figure:
    """A row of poses for each name; for names in `samples`, a second row with single repairs.

    The second row draws the limbs with a missing end, thin and green. They have their own row so
    that they do not cover the pose.
    """
    rows = [row for name in poses for row in [(name, False), (name, True)][: 1 + (name in samples)]]
    n = len(frames)
    fig, axes = figure(1.5 * n, 2.3 * len(rows) + 0.6, words, len(rows), n)
    for i, axis in enumerate(axes):
        (name, ghosts), t = rows[i // n], frames[i % n]
        draw_pose(axis, poses[name][t], washed=ghosts)
        if ghosts:
            _draw_ghosts(
                axis, samples[name][:, t], known[t], _CAMERA.at(*poses[name][t, HIPS, [0, 2]])
            )
        if i < n:
            axis.set_title(f"frame {t}", fontsize=SMALL)
        if i % n == 0:
            name = "each of them" if ghosts else name
            name_row(axis, name)
    fig.legend(handles=SIDES, loc="outside lower right", ncols=2, frameon=False, fontsize=SMALL)
    return fig


def _draw_ghosts(
    axis: Axes,
    samples: Float[np.ndarray, "n 21 3"],
    known: Bool[np.ndarray, "21"],
    camera: body.Camera,
):
    for sample in samples:
        pixels, _ = body.project(np.asarray(sample, np.float64), camera, _SIZE)
        for a, b in BONES:
            if not (known[a] and known[b]):
                axis.plot(*pixels[[a, b]].T, color=GHOST, lw=1, alpha=0.6, zorder=4)


def faults_and_methods(
    panels: Mapping[str, Mapping[str, Mapping[str, float]]], words: str, log: bool = True
) -> Figure:
    """A panel for each measure, with a row for each fault and a mark for each method.

    A NaN value has no mark.
    """
    faults = list(next(iter(panels.values())))
    fig, axes = figure(5.4 * len(panels), 1.4 + 0.8 * len(faults), words, 1, len(panels), share="y")
    for axis, (measure, rows) in zip(axes, panels.items(), strict=True):
        methods = len(rows[faults[0]])
        apart = min(
            0.2, 0.7 / methods
        )  # methods at different heights within a fault's row, so that marks do not overlap
        for k, method in enumerate(rows[faults[0]]):
            values = [rows[fault][method] for fault in faults]
            rows_at = np.arange(len(faults)) + apart * (k - (methods - 1) / 2)
            axis.plot(
                values,
                rows_at,
                MARKERS[k % 8],
                color=OKABE_ITO[k % 7],
                ms=9,
                ls="none",
                label=method,
            )
        axis.set_title(measure, fontsize=LARGE)
        axis.set_ylim(len(faults) - 0.5, -0.5)
        if log:
            axis.set_xscale("log")
            axis.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            axis.xaxis.set_major_formatter("{x:g}")
            axis.xaxis.set_minor_formatter(NullFormatter())
    axes[0].set_yticks(range(len(faults)), faults)
    fig.legend(
        *axes[0].get_legend_handles_labels(),
        loc="outside lower center",
        ncols=5,
        frameon=False,
        fontsize=SMALL,
    )
    return fig


# ---- gaps and faults -----------------------------------------------------------------------------
Line = tuple[
    Sequence[float], Sequence[float], Sequence[float], Sequence[float]
]  # x, value, low, high


def over_gaps(
    panels: Mapping[str, Mapping[str, Line]],
    words: str,
    xlabel: str = "length of the gap (frames of 1/20 s)",
    log: Sequence[str] = (),
) -> Figure:
    """One panel for each measure, with a line for each method and its 95 % interval shaded.

    Measures in `log` have a logarithmic axis.
    """
    fig, axes = figure(4.8 * len(panels), 6.0, words, 1, len(panels))
    for axis, (measure, lines) in zip(axes, panels.items(), strict=True):
        for i, (name, (x, value, low, high)) in enumerate(lines.items()):
            line = axis.plot(x, value, ls=DASHES[i % 8], marker=MARKERS[i % 8], label=name)[0]
            axis.fill_between(x, low, high, color=line.get_color(), alpha=0.15, lw=0)
        axis.set(
            xlabel=xlabel,
            title=measure,
            **({"yscale": "log"} if measure in log else {"ylim": (0, None)}),
        )
        axis.set_xticks(x)
        legend(axis, loc="upper center", bbox_to_anchor=(0.5, -0.16), fontsize=MEDIUM)
    return fig


def by_fault(
    panels: Mapping[str, Mapping[str, tuple[float, float, float]]], words: str, xlabel: str
) -> Figure:
    """A panel for each fault, with a row (value, low, high) for each method of repair.

    The axis is logarithmic; further left is better.
    """
    fig, axes = figure(4.6 * len(panels), 4.2, words, 1, len(panels))
    names = list(dict.fromkeys(name for ways in panels.values() for name in ways))
    for axis, (fault, ways) in zip(axes, panels.items(), strict=True):
        for name, (value, low, high) in ways.items():
            row = names.index(name)
            style = {"fmt": MARKERS[row % 8], "color": OKABE_ITO[row % 7], "capsize": 4}
            axis.errorbar(value, row, xerr=[[value - low], [high - value]], **style)
        axis.set(
            xscale="log",
            xlabel=xlabel,
            title=fault,
            yticks=range(len(names)),
            ylim=(len(names) - 0.5, -0.5),
        )
        axis.set_xticks([1, 2, 5, 10, 20], ["1", "2", "5", "10", "20"])
        axis.set_xticks([], minor=True)
        axis.set_yticklabels(names if axis is axes[0] else [])
    return fig


# ---- in-betweens ---------------------------------------------------------------------------------
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


def value_over_time(
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
