"""Plots of repairs: round by round, poses with all their repairs, and faults against methods.

Notebook: 10
"""

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Bool, Float
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from ..motion.skeleton import BONES, HIPS
from . import body
from .skeleton import SIDES, draw_pose
from .style import DASHES, LARGE, MARKERS, MEDIUM, OKABE_ITO, SMALL, figure, legend

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
            axis.text(
                -0.05,
                0.5,
                name,
                rotation=90,
                va="center",
                ha="right",
                transform=axis.transAxes,
                fontsize=MEDIUM,
            )
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
