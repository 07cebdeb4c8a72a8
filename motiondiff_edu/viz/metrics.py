"""Plots of measured walks: footstep curves, drift over time, planted feet, tables of scores.

Notebook: 08
"""

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Bool, Float
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..metrics.walks import PLANTED_BELOW, runs
from .body import INK, LEFT_COLOUR, RIGHT_COLOUR
from .style import DASHES, MARKERS, figure, legend, table


def footstep_curves(
    curves: Mapping[str, Float[np.ndarray, "V"]],
    words: str = (
        "Number of footsteps against the velocity tolerance; a dot at 95 % of the maximum."
    ),
) -> Figure:
    """Number of footsteps against the tolerance 1, 2, 3 ... cm/s, with a dot at each v95.

    Source: MoDiff Fig. 3.
    """
    fig, (axis,) = figure(9, 4.6, words)
    for i, (label, counts) in enumerate(curves.items()):
        at = int(np.argmax(counts >= 0.95 * counts.max()))
        dash = DASHES[i % len(DASHES)]  # a name or a pattern, which is no format string
        (line,) = axis.plot(np.arange(1, len(counts) + 1), counts, linestyle=dash, label=label)
        marker = MARKERS[i % len(MARKERS)]
        axis.plot([at + 1], [counts[at]], marker, color=line.get_color(), ms=9)
    axis.set(xlabel="tolerance v (cm/s)", ylabel="footsteps f_est(v)", ylim=(0, None))
    legend(axis)
    return fig


def over_time(
    panels: Mapping[str, Mapping[str, Float[np.ndarray, "_"]]],
    words: str,
    shade_to: float | int = 0,
) -> Figure:
    """One panel for each measure, with a line for each motion and a point for each second."""
    fig, axes = figure(5.2 * len(panels), 4, words, 1, len(panels))
    for axis, (measure, lines) in zip(axes, panels.items(), strict=True):
        for i, (label, values) in enumerate(lines.items()):
            axis.plot(
                np.arange(len(values)) + 0.5,
                values,
                ls=DASHES[i % 8],
                marker=MARKERS[i % 8],
                label=label,
            )
        if shade_to:
            axis.axvspan(0, shade_to, color="0.9")
        axis.set(xlabel="time (s)", title=measure, ylim=(0, None))
    legend(axes[0])
    return fig


def toe_heights(
    height: Float[np.ndarray, "T 2"],
    planted: Bool[np.ndarray, "_"],
    words: str,
    fps: float | int = 20,
    below: float = PLANTED_BELOW,
) -> Figure:
    """Height of the toes over time, in cm.

    The background is grey while the lower toe is planted, under `below` metres.
    """
    fig, (axis,) = figure(9, 3.4, words)
    seconds = np.arange(len(height)) / fps
    _shade(axis, planted, fps)
    for side, (label, colour) in enumerate(
        (("left toe", LEFT_COLOUR), ("right toe", RIGHT_COLOUR))
    ):
        axis.plot(
            seconds, 100 * height[:, side], "-" if side == 0 else "--", label=label, color=colour
        )
    axis.axhline(100 * below, color=INK, lw=1, ls=":", label=f"{100 * below:g} cm")
    axis.set(xlabel="time (s)", ylabel="height (cm)")
    legend(axis, loc="upper right", ncols=3)
    axis.set_ylim(None, 1.35 * 100 * height.max())
    return fig


def gates(
    gate: Float[np.ndarray, "T 2"],
    planted: Bool[np.ndarray, "T 2"],
    words: str,
    fps: float | int = 20,
) -> Figure:
    """How far the gates of the two feet are open (0 to 1), left above right.

    The background is grey while that foot is planted in the data.
    """
    fig, axes = figure(9, 3.8, words, rows=2, share="xy")
    seconds = np.arange(len(gate)) / fps
    for side, (axis, label, colour) in enumerate(
        zip(axes, ("gate, left toe", "gate, right toe"), (LEFT_COLOUR, RIGHT_COLOUR), strict=True)
    ):
        _shade(axis, planted[:, side], fps)
        axis.plot(seconds, gate[:, side], color=colour)
        axis.set(ylabel=label, ylim=(-0.05, 1.05), yticks=(0, 0.5, 1))
    axes[-1].set_xlabel("time (s)")
    return fig


def _shade(axis: Axes, planted: np.ndarray, fps: float | int) -> None:
    """Draw a grey background while a foot is planted."""
    for begin, end in runs(planted):
        axis.axvspan(begin / fps, end / fps, color="0.9", lw=0)


def score_table(
    scores: Mapping[str, Mapping[str, float]], words: str, digits: int = 2, log: Sequence[str] = ()
) -> Figure:
    """A table with motions in rows and measures in columns; larger values are darker.

    The shade is proportional to the value within its column. For columns in `log`, it goes with the
    logarithm, from the smallest value on.
    """
    rows, columns = list(scores), list(next(iter(scores.values())))
    values = np.array([[scores[row][column] for column in columns] for row in rows], dtype=float)
    shades = np.array(
        [_shades(of, name in log) for name, of in zip(columns, values.T, strict=True)]
    ).T
    fig, (axis,) = figure(2.6 + 1.75 * len(columns), 1.1 + 0.5 * len(rows), words)
    axis.imshow(shades, cmap="Blues", vmin=0, vmax=1.8, aspect="auto")
    for (i, j), value in np.ndenumerate(values):
        text = "none" if np.isnan(value) else f"{0 if abs(value) < 5e-4 else value:.{digits}g}"
        axis.text(j, i, text, ha="center", va="center", color=INK)
    table(axis, rows, columns)
    return fig


def _shades(column: Float[np.ndarray, "R"], log: bool) -> Float[np.ndarray, "R"]:
    """How dark each value is, 0 to 1 for the largest.

    It is 0 without a value, and for a logarithm also for values that are not positive.
    """
    if not log:
        return np.nan_to_num(column) / max(float(np.nan_to_num(column).max()), 1e-12)
    powers = np.log10(np.where(column > 0, column, np.nan))
    if np.isnan(powers).all():
        return np.zeros(len(column))
    low, high = float(np.nanmin(powers)), float(np.nanmax(powers))
    return np.nan_to_num((powers - low) / max(high - low, 1e-12))
