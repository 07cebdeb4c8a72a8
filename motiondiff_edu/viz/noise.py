"""Plots of noise that is added and removed: curves, densities, paths and terms of the bound.

The functions take plain arrays. They return a Figure that is shown once; its caption says what to
see.
"""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from .style import DASHES, OKABE_ITO, add_caption, figure, legend

BLUE, ORANGE, GREEN, PURPLE, _, SKY, INK = OKABE_ITO[:7]
COLOURS = (BLUE, ORANGE, GREEN, PURPLE, SKY, INK)
GREY = "#767676"


def panels(
    n: int = 1,
    width: float = 9.0,
    height: float = 3.6,
    *,
    share: str = "",
    widths: Sequence[float] | None = None,
) -> tuple[Figure, list[Axes]]:
    """A figure of n panels side by side, and its axes; `finish` adds the caption.

    `share` and `widths` are as in `style.figure`.
    """
    return figure(width, height, "", 1, n, share=share, widths=widths)


def finish(fig: Figure, words: str, labels: tuple[str, str] | None = None) -> Figure:
    """Add a caption to the figure, and label the axes."""
    for axis in fig.axes if labels else ():
        axis.set_xlabel(labels[0])
    if labels:
        fig.axes[0].set_ylabel(labels[1])
    return add_caption(fig, words)


def lines(
    x: ArrayLike,
    curves: dict,
    caption: str,
    labels: tuple[str, str],
    *,
    log: tuple[bool, bool] = (False, False),
    marks: dict | None = None,
    ylim: tuple[float, float] | None = None,
) -> Figure:
    """Several named curves over x; `marks` are named horizontal lines."""
    fig, (axis,) = panels()
    for i, (name, y) in enumerate(curves.items()):
        axis.plot(
            x,
            y,
            label=name,
            color=COLOURS[i % 6],
            ls=DASHES[i % 6],
            marker="o" if len(x) < 12 else None,
        )
    for name, level in (marks or {}).items():
        axis.axhline(level, color=GREY, lw=1.3, ls=":")
        axis.annotate(
            name,
            (1.01, level),
            xycoords=("axes fraction", "data"),
            ha="left",
            va="center",
            color="#555555",
        )
    axis.set_xscale("log" if log[0] else "linear")
    axis.set_yscale("log" if log[1] else "linear")
    if ylim:
        axis.set_ylim(*ylim)
    if len(curves) > 1:
        legend(axis, handlelength=2.6)
    return finish(fig, caption, labels)


def noised_curve(
    seconds: ArrayLike,
    clean: ArrayLike,
    noised: ArrayLike,
    s: int,
    signal: float,
    caption: str | None = None,
    *,
    name: str,
) -> Figure:
    """One coordinate over time, clean and at diffusion step s; `name` labels its axis.

    The caption says which fraction of the amplitude is left.
    """
    fig, (axis,) = panels(height=3.2)
    axis.plot(seconds, noised, color=ORANGE, lw=1.4, marker=".", label=f"x_s at s = {s}")
    axis.plot(
        seconds,
        signal * np.asarray(clean),
        color=BLUE,
        label=f"what is left of x0: {100 * signal:.0f} %",
    )
    axis.set_ylim(-3.6, 3.6)
    legend(axis, loc="upper right", ncols=2)
    caption = caption or (
        f"Step {s}: the blue curve is the clean one times {signal:.2f}; "
        f"the orange one adds noise of standard deviation {np.sqrt(1 - signal**2):.2f}."
    )
    return finish(fig, caption, ("time (s)", name))


def noise_ladder(
    seconds: ArrayLike, clean: ArrayLike, noised: dict, caption: str, *, name: str
) -> Figure:
    """The curve `name` at several diffusion steps, side by side: {s: x_s}."""
    fig, axes = panels(len(noised), width=11, height=2.9, share="y")
    for axis, (s, curve) in zip(axes, noised.items(), strict=True):
        axis.plot(seconds, clean, color=SKY, lw=1.2)
        axis.plot(seconds, curve, color=ORANGE, lw=1.2)
        axis.set_title(f"s = {s}")
    return finish(fig, caption, ("time (s)", name))


def densities(
    grid: ArrayLike,
    curves: dict,
    caption: str,
    labels: tuple[str, str] = ("value", "density"),
    *,
    points: dict | None = None,
) -> Figure:
    """Named densities over one grid, lightly filled; `points` are named values on the axis."""
    fig, (axis,) = panels()
    for i, (name, y) in enumerate(curves.items()):
        axis.plot(grid, y, label=name, color=COLOURS[i % 6], ls=DASHES[i % 8])
        axis.fill_between(grid, y, color=COLOURS[i % 6], alpha=0.10)
    for i, (name, value) in enumerate((points or {}).items()):
        axis.plot(
            [value],
            [0],
            marker="^",
            ms=11,
            color=INK if i == 0 else GREY,
            ls="none",
            label=name,
            clip_on=False,
        )
    axis.set_ylim(bottom=0)
    legend(axis)
    return finish(fig, caption, labels)


def histograms(
    samples: dict,
    grid: ArrayLike,
    density: ArrayLike,
    caption: str,
    label: str = "value",
    top: float = 1.35,
) -> Figure:
    """A histogram for each named set of samples, each under the same exact density.

    The y axis ends at `top` times the peak of the density. Values off the grid count, and are not
    drawn.
    """
    fig, axes = panels(len(samples), width=4.2 * max(len(samples), 2), height=3.4, share="y")
    for i, (axis, (name, values)) in enumerate(zip(axes, samples.items(), strict=True)):
        histogram(axis, values, grid, 80, COLOURS[i % 6])
        axis.plot(grid, density, color=INK, lw=1.8)
        axis.set_title(name)
        axis.set_ylim(0, top * float(max(density)))
    return finish(fig, caption, (label, "density"))


def histogram(
    axis, values: ArrayLike, grid: ArrayLike, bins: int, color: str, orientation: str = "vertical"
) -> None:
    """Draw the density of values over the grid; those off the grid count, and are not drawn."""
    values, ends = np.asarray(values).ravel(), (float(grid[0]), float(grid[-1]))
    share = np.full(len(values), bins / (len(values) * (ends[1] - ends[0])))
    bars = {"bins": bins, "range": ends, "weights": share, "orientation": orientation}
    axis.hist(values, color=color, alpha=0.5, **bars)


def paths(
    steps: ArrayLike,
    x: ArrayLike,
    grid: ArrayLike,
    at_start: ArrayLike,
    at_end: ArrayLike,
    caption: str,
    show: int = 60,
) -> Figure:
    """Sampling paths x (steps, n) from noise on the left to samples on the right.

    Each end has a density.
    """
    x = np.asarray(x)
    fig, (left, middle, right) = panels(3, 10.5, 4, share="y", widths=[1, 5, 1])
    middle.plot(steps, x[:, :show], color=BLUE, lw=0.8, alpha=0.45)
    middle.plot(steps, x[:, 0], color=ORANGE, lw=2)
    middle.invert_xaxis()
    for axis, density, values, name in (
        (left, at_start, x[0], "at S"),
        (right, at_end, x[-1], "at 0"),
    ):
        histogram(axis, values, grid, 60, SKY, "horizontal")
        axis.plot(density, grid, color=INK, lw=1.6)
        axis.set_title(name)
        axis.set_xticks([])
    left.invert_xaxis()
    left.set_ylim(float(grid[0]), float(grid[-1]))
    middle.set_xlabel("diffusion step s")
    left.set_ylabel("x_s")
    return finish(fig, caption)


def one_moment(
    grid: ArrayLike, density: ArrayLike, values: ArrayLike, guesses: ArrayLike, s: int, caption: str
) -> Figure:
    """All samples at one step: the values of x_s, and the denoiser's guesses of x0."""
    fig, (left, right) = panels(2, width=10, height=3.4, share="y")
    for axis, data, colour, name in (
        (left, values, BLUE, f"x_s at s = {s}"),
        (right, guesses, ORANGE, "x0_hat there"),
    ):
        histogram(axis, data, grid, 90, colour)
        axis.plot(grid, density, color=INK, lw=1.6)
        axis.set_title(name)
        axis.set_ylim(0, 2.4)
    return finish(fig, caption, ("value", "density"))


def bound(terms: ArrayLike, exact: float, caption: str) -> Figure:
    """Terms of the negative bound over s, and their running sum with -E log q(x0).

    terms[0] is the term of the prior.
    """
    fig, (left, right) = panels(2, width=10.5, height=4)
    terms, s = np.asarray(terms), np.arange(1, len(terms))
    left.bar(s, terms[1:], width=1.0, color=np.where(s == 1, ORANGE, BLUE))
    left.bar([len(terms)], [terms[0]], width=1.0, color=GREEN)
    left.set_yscale("symlog", linthresh=0.02)
    left.axhline(0, color=INK, lw=0.8)
    left.set_title("each term, in nats (log scale beyond 0.02)")
    total = np.cumsum(np.concatenate([terms[:1], terms[:0:-1]]))
    right.plot(np.arange(len(terms), 0, -1), total, color=BLUE, label="sum so far, from S down")
    right.plot([1], total[-1:], "o", color=ORANGE, ms=9, label=f"negative bound {total[-1]:.3f}")
    right.axhline(exact, color=INK, ls="--", lw=1.6, label=f"exact -E log q(x0) {exact:.3f}")
    right.invert_xaxis()
    legend(right)
    return finish(fig, caption, ("diffusion step s", "nats"))


def maps(start: ArrayLike, ends: dict, caption: str) -> Figure:
    """The sample of each starting noise, for several samplers side by side: {name: samples}."""
    fig, axes = panels(len(ends), width=4.4 * len(ends), height=3.6, share="y")
    for axis, (name, end), colour in zip(axes, ends.items(), COLOURS, strict=False):
        axis.plot(start, end, ".", ms=3, alpha=0.4, color=colour)
        axis.set_title(name)
    return finish(fig, caption, ("x_S, the starting noise", "x_0, the sample"))
