"""Plots of diffusion dropout: curves side by side, a linear walker's weights, noise of the past.

Notebook: 09
"""

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float
from matplotlib.figure import Figure

from .body import INK
from .style import DASHES, MARKERS, MEDIUM, OKABE_ITO, SMALL, figure

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
