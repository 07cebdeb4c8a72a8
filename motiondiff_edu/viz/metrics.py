"""Figures of measured walks: footstep curves, drift over time, what a planted foot does, scores beside each other.

Notebook: 08
"""

from collections.abc import Mapping

import matplotlib.pyplot as plt
import numpy as np
from jaxtyping import Bool, Float
from matplotlib.figure import Figure

from .body import INK, LEFT_COLOUR, RIGHT_COLOUR

COLOURS = ("#1F2933", "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")


def footstep_curves(
    curves: Mapping[str, Float[np.ndarray, "V"]], marks: Mapping[str, float] | None = None, first: float = 1.0
) -> Figure:
    """Number of footsteps against the tolerance (cm/s, from `first` in steps of 1), a dot at each v95.

    Without `marks` the dots stand where a curve first reaches 95 % of its maximum. Source: MoDiff Fig. 3.
    """
    figure, axes = plt.subplots(figsize=(8, 4), layout="constrained")
    for (label, counts), colour in zip(curves.items(), COLOURS * 2, strict=False):
        tolerance = first + np.arange(len(counts))
        at = (marks or {}).get(label, first + int(np.argmax(counts >= 0.95 * counts.max())))
        axes.plot(tolerance, counts, label=label, color=colour)
        axes.plot([at], [counts[int(at - first)]], "o", color=colour)
    axes.set(xlabel="tolerance v, cm/s", ylabel="footsteps f_est(v)", ylim=(0, None))
    axes.legend(frameon=False)
    return _tidy(figure)


def over_time(
    seconds: Float[np.ndarray, "n"], values: Mapping[str, Float[np.ndarray, "n"]], ylabel: str, title: str = ""
) -> Figure:
    """One line for each label over the seconds of a rollout: does it get worse the longer it walks?"""
    figure, axes = plt.subplots(figsize=(8, 3.4), layout="constrained")
    for (label, line), colour in zip(values.items(), COLOURS * 2, strict=False):
        axes.plot(seconds, line, label=label, color=colour, marker=".")
    axes.set(xlabel="seconds of rollout", ylabel=ylabel, title=title, ylim=(0, None))
    axes.legend(frameon=False)
    return _tidy(figure)


def toe_heights(
    height: Float[np.ndarray, "T 2"], planted: Bool[np.ndarray, "T"], fps: float = 20.0, below: float = 0.03
) -> Figure:
    """Height of the left and right toe over time, in cm; grey where a toe counts as planted."""
    figure, axes = plt.subplots(figsize=(8, 3), layout="constrained")
    seconds = np.arange(len(height)) / fps
    axes.fill_between(seconds, 0, 1, where=planted, transform=axes.get_xaxis_transform(), color="0.9", step="post")
    for side, (label, colour) in enumerate((("left toe", LEFT_COLOUR), ("right toe", RIGHT_COLOUR))):
        axes.plot(seconds, 100 * height[:, side], label=label, color=colour)
    axes.axhline(100 * below, color=INK, lw=0.8, ls=":")
    axes.set(xlabel="seconds", ylabel="height, cm")
    axes.legend(frameon=False, loc="upper right")
    return _tidy(figure)


def score_table(scores: Mapping[str, Mapping[str, float]], title: str = "") -> Figure:
    """Rows of motions, columns of measures; a cell is darker the larger it is within its column."""
    rows, columns = list(scores), list(next(iter(scores.values())))
    values = np.array([[scores[row][column] for column in columns] for row in rows])
    shade = values / np.maximum(np.nanmax(values, axis=0), 1e-12)
    figure, axes = plt.subplots(figsize=(1.6 + 1.5 * len(columns), 0.9 + 0.42 * len(rows)), layout="constrained")
    axes.imshow(np.nan_to_num(shade), cmap="Blues", vmin=0, vmax=1.6, aspect="auto")
    for (i, j), value in np.ndenumerate(values):
        axes.text(j, i, "none" if np.isnan(value) else f"{value:.3g}", ha="center", va="center", color=INK)
    axes.set_xticks(range(len(columns)), columns)
    axes.set_yticks(range(len(rows)), rows)
    axes.tick_params(length=0, top=True, labeltop=True, bottom=False, labelbottom=False)
    axes.set_title(title)
    return _tidy(figure, ())


def _tidy(figure: Figure, keep: tuple[str, ...] = ("left", "bottom")) -> Figure:
    for axes in figure.axes:
        for side, spine in axes.spines.items():
            spine.set_visible(side in keep)
    plt.close(figure)  # a figure that is returned is shown once, not twice
    return figure
