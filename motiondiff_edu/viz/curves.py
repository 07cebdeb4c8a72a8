"""Plots for several notebooks: losses, and control over time.

Every line has its own colour and its own dashes.  Notebook: 05
"""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .body import GREY
from .style import DASHES, OKABE_ITO, SMALL, figure, legend

Curves = Mapping[str, tuple]  # name -> (x, y), equally long


def running_mean(y: Float[np.ndarray, "T"], window: int) -> Float[np.ndarray, "T"]:
    """Mean of the last `window` values; at the start, of all values so far."""
    total = np.concatenate([[0.0], np.cumsum(y)])
    last = np.arange(1, len(y) + 1)
    first = np.maximum(0, last - window)
    return (total[last] - total[first]) / (last - first)


def _lines(axis: Axes, curves: Curves, smooth: int = 1) -> None:
    for k, (name, (x, y)) in enumerate(curves.items()):
        x = np.asarray(x, dtype=np.float64)
        y = np.asarray(y, dtype=np.float64)
        if x.shape != y.shape:
            raise ValueError(f"curve {name!r}: x has shape {x.shape}, y has {y.shape}")
        style = {"color": OKABE_ITO[k % 7], "ls": DASHES[k % 8]}
        if smooth > 1:
            axis.plot(x, y, color=style["color"], alpha=0.18, lw=1)
        axis.plot(x, running_mean(y, smooth) if smooth > 1 else y, label=name, **style)


def loss_curves(
    curves: Curves, smooth: int = 1, log: bool = True, title: str = "", ylabel: str = "loss"
) -> Figure:
    """Training losses over steps.

    `smooth` > 1 draws the running mean, with the raw values faint behind it.
    """
    which = f": {', '.join(curves)}" if len(curves) > 1 else ""
    words = f"{title or 'Loss'} over training steps{which}."
    fig, (axis,) = figure(
        9, 4.4, words + (f" Running mean of {smooth} steps." if smooth > 1 else "")
    )
    _lines(axis, curves, smooth)
    axis.set(xlabel="training step", ylabel=ylabel, title=title)
    if log:
        axis.set_yscale("log")
    legend(axis)
    return fig


def control_curves(
    controls: Mapping[str, Float[np.ndarray, "_ 3"]], fps: float | int = 20.0, past: int = 0
) -> Figure:
    """Forward, left and yaw over time, one row each; the given past is shaded."""
    which = f": {', '.join(controls)}" if len(controls) > 1 else ""
    words = f"Control over time{which}; forward, left and yaw."
    fig, axes = figure(9, 5.4, words, 3, 1, share="x")
    for k, (axis, name) in enumerate(
        zip(axes, ("forward (m/s)", "left (m/s)", "yaw (rad/s)"), strict=True)
    ):
        _lines(axis, {n: (np.arange(len(c)) / fps, c[:, k]) for n, c in controls.items()})
        axis.set_ylabel(name)
        axis.margins(y=0.1)
        low, high = axis.get_ylim()
        axis.set_ylim(min(low, -0.3), max(high, 0.3))
        if past:
            axis.axvspan(
                0, past / fps, color=GREY, alpha=0.15, label="past (given)" if k == 0 else None
            )
    axes[-1].set_xlabel("time (s)")
    if len(controls) > 1 or past:
        fig.legend(
            *axes[0].get_legend_handles_labels(),
            loc="outside upper right",
            ncols=4,
            frameon=False,
            fontsize=SMALL,
        )
    return fig
