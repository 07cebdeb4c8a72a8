"""Plots of measured walks and of diffusion dropout.

Footstep curves, drift over time, planted feet, tables of scores; curves side by side, a linear
walker's weights, noise of the past.
Notebook: 07, 08, 09
"""

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Bool, Float
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..metrics.walks import PLANTED_BELOW, runs
from .body import INK, LEFT_COLOUR, RIGHT_COLOUR
from .style import DASHES, MARKERS, MEDIUM, OKABE_ITO, SMALL, figure, legend, table


# ---- measured walks ------------------------------------------------------------------------------
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


def measures_over_time(
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


def treads(
    walks: Mapping[str, Float[np.ndarray, "_ 2"]], words: str, fps: float | int = 20
) -> Figure:
    """How far along its way each toe has come (metres), a panel for each walk.

    A toe that stands makes a flat tread, one that slides a sloping one.
    """
    fig, axes = figure(3.4 * len(walks), 3.8, words, 1, len(walks), share="xy")
    for axis, (label, toes) in zip(axes, walks.items(), strict=True):
        seconds = np.arange(len(toes)) / fps
        axis.plot(seconds, toes[:, 0], "-", color=LEFT_COLOUR, label="left toe")
        axis.plot(seconds, toes[:, 1], "--", color=RIGHT_COLOUR, label="right toe")
        axis.set(xlabel="time (s)", title=label)
    axes[0].set_ylabel("along the way (m)")
    legend(axes[0])
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


# ---- diffusion dropout ---------------------------------------------------------------------------
Curves = Mapping[str, tuple]  # name -> (x, y), equally long
HATCHES = ("", "//", "..", "xx", "\\\\")


def beside(
    panels: Mapping[str, Curves], words: str, xlabel: str, log: Sequence[str] = ()
) -> Figure:
    """Panels of named curves, with one x axis and a y axis for each panel.

    The y axis begins at 0, or is logarithmic for panels named in `log`. A name has the same colour
    and marker in all panels. If there are several names, one legend stands above the panels.
    """
    fig, axes = figure(4.6 * len(panels), 4.1, words, 1, len(panels), share="x")
    names = list(dict.fromkeys(name for curves in panels.values() for name in curves))
    for axis, (title, curves) in zip(axes, panels.items(), strict=True):
        for name, (x, y) in curves.items():
            k = names.index(name)
            few = MARKERS[k % 8] if len(x) < 15 else None
            axis.plot(x, y, color=OKABE_ITO[k % 7], ls=DASHES[k % 8], marker=few, ms=6, label=name)
        axis.set_title(title, fontsize=MEDIUM)
        if title in log:
            axis.set_yscale("log")
        else:
            axis.set_ylim(0, 1.08 * max(float(np.asarray(y).max()) for _, y in curves.values()))
    handles = {h.get_label(): h for axis in axes for h in axis.get_lines()}
    if len(handles) > 1:
        fig.legend(
            handles.values(),
            handles,
            loc="outside upper center",
            ncols=4,
            frameon=False,
            fontsize=MEDIUM,
        )
    fig.supxlabel(xlabel, fontsize=MEDIUM)
    return fig


def weights_by_input(
    weights: Mapping[str, Float[np.ndarray, "F D"]], T_h: int, words: str
) -> Figure:
    """For each linear walker, the size of its weights on each past frame and on the control.

    The size is the root of the sum of squared weights.
    """
    fig, (axis,) = figure(10, 4.2, words)
    width = 0.84 / len(weights)
    for k, (name, weight) in enumerate(weights.items()):
        squares = np.square(np.asarray(weight, dtype=np.float64)).sum(1)
        past = T_h * weight.shape[1]
        sizes = np.sqrt([*squares[:past].reshape(T_h, -1).sum(1), squares[past:-1].sum()])
        place = np.arange(T_h + 1) + (k + 0.5) * width - 0.42
        style = {"color": OKABE_ITO[k % 7], "hatch": HATCHES[k % 5], "edgecolor": "white"}
        axis.bar(place, sizes, width=0.95 * width, label=name, **style)
    axis.axvline(T_h - 0.5, color=INK, lw=1)
    axis.set_xticks(
        range(T_h + 1), [*(f"{t}" if t else "last" for t in range(1 - T_h, 1)), "control"]
    )
    axis.set(xlabel="past pose (frames before the last)", ylabel="size of the weights")
    axis.set_yscale("log")
    handles, names = axis.get_legend_handles_labels()
    fig.legend(handles, names, loc="outside upper center", ncols=4, frameon=False, fontsize=MEDIUM)
    return fig


def noise_pairs(
    meetings: Mapping[str, tuple[Float[np.ndarray, "N"], Float[np.ndarray, "N"]]], words: str
) -> Figure:
    """The noise of the target (x axis) and of its past (y axis), 0..1, in training windows.

    Each way of dropping has one panel. The line at the bottom is what sampling needs: a clean past
    at every step.
    """
    fig, axes = figure(4.7 * len(meetings), 4.1, words, 1, len(meetings), share="xy")
    for axis, (name, (target, past)) in zip(axes, meetings.items(), strict=True):
        axis.axhline(0, color=OKABE_ITO[1], lw=5, alpha=0.5, label="needed in sampling")
        axis.plot(target, past, "o", ms=4, alpha=0.6, color=OKABE_ITO[0], label="seen in training")
        axis.set(title=name, xlim=(-0.03, 1.03), ylim=(-0.06, 1.06))
    axes[0].set_ylabel("noise of its past", fontsize=MEDIUM)
    fig.supxlabel("noise of the target: sqrt(1 - alpha_bar)", fontsize=MEDIUM)
    handles, names = axes[0].get_legend_handles_labels()
    fig.legend(handles, names, loc="outside upper center", ncols=2, frameon=False, fontsize=SMALL)
    return fig
