"""Plots of training: losses with their floor, clouds of samples, a denoiser's guesses in the plane.

Notebook: 05, 07
"""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float
from matplotlib.figure import Figure

from .style import DASHES, OKABE_ITO, SMALL, figure, legend

FAINT, INK = "#B8BEC7", "#222222"


def over_s(
    curves: Mapping[str, tuple],
    words: str,
    ylabel: str,
    log: bool = True,
    marks: Mapping[str, float] | None = None,
) -> Figure:
    """Named curves (s, y) over the diffusion step; `marks` are named horizontal lines."""
    fig, (axis,) = figure(9, 4.4, words)
    for k, (name, (s, y)) in enumerate(curves.items()):
        axis.plot(
            np.asarray(s), np.asarray(y), label=name, color=OKABE_ITO[k % 7], ls=DASHES[k % 8]
        )
    for name, level in (marks or {}).items():
        axis.axhline(level, color="#666666", lw=1.2, ls=":")
        axis.annotate(
            name, (0.01, level), xycoords=("axes fraction", "data"), va="bottom", color="#444444"
        )
    axis.set(xlabel="diffusion step s (1: almost no noise)", ylabel=ylabel)
    if log:
        axis.set_yscale("log")
    legend(axis)
    return fig


def loss_above_floor(
    losses: Mapping[str, float], floors: Mapping[str, float], words: str
) -> Figure:
    """A bar for each loss; the grey part is the loss that even the exact denoiser has."""
    fig, (axis,) = figure(9, 1.4 + 0.6 * len(losses), words)
    for k, name in enumerate(losses):
        axis.barh(
            k,
            floors[name],
            color=FAINT,
            label="floor: the exact denoiser's loss" if k == 0 else None,
        )
        axis.barh(k, max(losses[name] - floors[name], 0.0), left=floors[name], color=OKABE_ITO[1],
                  label="what could still be learnt" if k == 0 else None)  # fmt: skip
        axis.text(max(losses[name], floors[name]) + 0.01, k, f"{losses[name]:.3f}", va="center")
    axis.set_yticks(range(len(losses)), list(losses))
    axis.set(
        xlabel="mean loss over all s",
        ylim=(len(losses) - 0.5, -0.5),
        xlim=(0, 1.32 * max(losses.values())),
    )
    fig.legend(loc="outside upper center", ncols=2, frameon=False, fontsize=SMALL)
    return fig


def clouds(
    panels: Mapping[str, Float[np.ndarray, "_ 2"]], words: str, reach: float = 2.6
) -> Figure:
    """Sets of points in the plane, one panel each, all with the same axes from -reach to reach.

    Points outside are not drawn; the caption `words` is followed by their number.
    """
    outside = sum(int((np.abs(points) > reach).any(-1).sum()) for points in panels.values())
    words += f" Outside of the frame: {outside}." if outside else ""
    fig, axes = figure(3.1 * len(panels), 3.7, words, 1, len(panels), share="xy")
    for k, (axis, (name, points)) in enumerate(zip(axes, panels.items(), strict=True)):
        axis.plot(
            *np.asarray(points).T,
            ".",
            ms=2.5,
            alpha=0.5,
            color=INK if k == 0 else OKABE_ITO[k - 1],
        )
        _plane(axis, name, reach, k == 0)
    return fig


def _plane(axis, name: str, reach: float, first: bool) -> None:
    """Name a panel of points in the plane, and its axes."""
    axis.set(title=name, aspect="equal", xlim=(-reach, reach), ylim=(-reach, reach), xlabel="x")
    if first:
        axis.set_ylabel("y")


def guesses(
    data: Float[np.ndarray, "_ 2"], x_s: Float[np.ndarray, "N 2"], right: Float[np.ndarray, "N 2"],
    panels: Mapping[str, Float[np.ndarray, "N 2"]], words: str, reach: float = 3.0,
) -> Figure:  # fmt: skip
    """One panel for each network: noised points (dots), its guesses of x0 (ends of the lines), and
    the exact guesses (circles).
    """
    fig, axes = figure(3.6 * len(panels), 4.1, words, 1, len(panels), share="xy")
    for k, (axis, (name, guess)) in enumerate(zip(axes, panels.items(), strict=True)):
        axis.plot(*data.T, ".", ms=1.5, color=FAINT, zorder=0)
        axis.plot(*np.stack([x_s, guess], 1).transpose(2, 1, 0), color=OKABE_ITO[k % 7], lw=0.9)
        axis.plot(*x_s.T, ".", ms=5, color=OKABE_ITO[k % 7], label="x_s")
        axis.plot(*right.T, "o", ms=8, mfc="none", mec=INK, label="exact guess")
        _plane(axis, name, reach, k == 0)
    legend(axes[0], loc="upper left", handletextpad=0.1)
    return fig
