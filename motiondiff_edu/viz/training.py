"""Plots of training: losses with their floor, samples and guesses in the plane; kinematic losses.

Notebook: 05, 07, 13
"""

import math
from collections.abc import Mapping, Sequence

import matplotlib
import numpy as np
from jaxtyping import Float, Int
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from ..metrics.bodies import bone_lengths
from ..motion.skeleton import BONE_LENGTHS, BONES, HIPS
from .body import INK
from .style import DASHES, MEDIUM, OKABE_ITO, SMALL, figure, legend, table

# ---- training a denoiser -------------------------------------------------------------------------
FAINT = "#B8BEC7"


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
            *np.asarray(points).T, ".", ms=2.5, alpha=0.5, color=INK if k == 0 else OKABE_ITO[k - 1]
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


# ---- kinematic losses ----------------------------------------------------------------------------
SHORT_TO_LONG = matplotlib.colors.LinearSegmentedColormap.from_list(
    "bones", ["#0072B2", "#C9CDD4", "#D55E00"]
)
STRETCH = Normalize(-0.3, 0.3, clip=True)  # a bone's length / its true length - 1
ROUNDING = 1e-10  # smaller values are rounding of float32 and not drawn
REACH = 1.15  # smallest distance from the hips to the edge of a picture, metres


def pose_rows(
    rows: Mapping[str, Float[np.ndarray, "_ 21 3"]],
    words: str,
    n: int = 6,
    fps: float | int | None = None,
    widest: float | int = math.inf,
) -> Figure:
    """A row of n poses for each motion, seen from the front.

    Bones that are too short are blue, those that are too long are orange.

    With `fps`, the times in seconds stand above the first row. Pictures are at most `widest` metres
    wide; everything outside is cut off.
    """
    fig, axes = figure(1.45 * n + 1.0, 1.5 * len(rows) + 0.3, words, len(rows), n)
    for row, (name, motion) in enumerate(rows.items()):
        draw_row(axes[row * n : row * n + n], motion, name, widest)
    if fps:
        for axis, frame in zip(axes[:n], _evenly_spaced(next(iter(rows.values())), n), strict=True):
            axis.set_title(f"{frame / fps:.1f} s", fontsize=SMALL)
    colours = ScalarMappable(STRETCH, SHORT_TO_LONG)
    bar = fig.colorbar(
        colours, ax=axes, location="right", shrink=0.6, aspect=25, ticks=[-0.3, 0, 0.3]
    )
    bar.ax.set_yticklabels(["30 % short", "true length", "30 % long"], fontsize=SMALL)
    return fig


def _evenly_spaced(motion: Float[np.ndarray, "_ 21 3"], n: int) -> Int[np.ndarray, "n"]:
    return np.linspace(0, len(motion) - 1, n).round().astype(int)


def draw_row(
    axes: Sequence[Axes],
    motion: Float[np.ndarray, "_ 21 3"],
    name: str,
    widest: float | int = math.inf,
) -> None:
    """One motion, with a pose in each axis, all at one scale.

    The row's name includes the scale if it is not the usual one.
    """
    poses = np.asarray(motion, np.float64)[_evenly_spaced(motion, len(axes))]
    far = float(np.abs(poses - poses[:, HIPS : HIPS + 1])[..., :2].max())
    reach = REACH if far <= REACH else min(1.05 * far, widest / 2)
    for axis, pose in zip(axes, poses, strict=True):
        _sticks(axis, pose, reach)
    cut = "" if reach > far else f" of {2 * far:.1f} m"
    shown = f"shows {2 * reach:.1f} m{cut}"
    label = name if reach == REACH else f"{name}\n({shown})"
    axes[0].text(
        -0.04,
        0.5,
        label,
        rotation=90,
        va="center",
        ha="right",
        transform=axes[0].transAxes,
        fontsize=SMALL,
    )


def _sticks(axis: Axes, pose: Float[np.ndarray, "21 3"], reach: float) -> None:
    about = pose[:, :2] - pose[HIPS, :2]
    stretch = bone_lengths(pose[None])[0] / BONE_LENGTHS - 1
    for (parent, child), much in zip(BONES, stretch, strict=True):
        colour = SHORT_TO_LONG(STRETCH(much))
        axis.plot(*about[[parent, child]].T, color=colour, lw=3.5, solid_capstyle="round")
    axis.plot(*about.T, ".", color=INK, ms=3)
    axis.set(
        xlim=(reach, -reach), ylim=(-reach, reach), aspect="equal"
    )  # x is the figure's left; the view is from the front
    axis.set_axis_off()


def loss_table(
    values: Float[np.ndarray, "R K"], rows: Sequence[str], columns: Sequence[str], words: str
) -> Figure:
    """A table of losses; in each column the shade goes from white (0) to the largest value."""
    fig, (axis,) = figure(2.6 + 1.9 * len(columns), 0.9 + 0.52 * len(rows), words)
    share = values / np.maximum(values.max(axis=0), 1e-30)
    axis.imshow(np.sqrt(share), cmap="Oranges", vmin=0, vmax=1.6, aspect="auto")
    for (i, j), value in np.ndenumerate(values):
        text = "0" if share[i, j] < 1e-3 else f"{value:.2g}"
        axis.text(
            j, i, text, ha="center", va="center", color="#999999" if text == "0" else "#111111"
        )
    table(axis, rows, columns)
    return fig


def over_steps(
    panels: Mapping[str, Mapping[str, tuple]],
    words: str,
    ylabel: str = "",
    at: int | None = None,
    columns: int = 2,
) -> Figure:
    """Panels of named curves (s, y) over the diffusion step; each panel has its own log axis.

    `at` marks one step.
    """
    columns = min(columns, len(panels))
    rows = -(-len(panels) // columns)
    fig, axes = figure(
        4.7 * columns if columns > 1 else 8, 3.3 * rows + 0.4, words, rows, columns, share="x"
    )
    for axis, (name, curves) in zip(axes, panels.items(), strict=False):
        _log_curves(axis, curves, at)
        axis.set_title(name)
    for axis in axes[len(panels) :]:
        axis.set_axis_off()
    legend(axes[0])
    fig.supxlabel("diffusion step s (1: almost no noise)", fontsize=MEDIUM)
    if ylabel:
        fig.supylabel(ylabel, fontsize=MEDIUM)
    return fig


def _log_curves(axis: Axes, curves: Mapping[str, tuple], at: int | None = None) -> None:
    for k, (name, (s, y)) in enumerate(curves.items()):
        s, y = np.asarray(s), np.asarray(y, np.float64)
        axis.plot(
            s, np.where(y > 0, y, np.nan), label=name, color=OKABE_ITO[k % 7], ls=DASHES[k % 8]
        )
        if at is not None and at in s:
            axis.plot(at, y[s == at], "o", color=OKABE_ITO[k % 7], ms=9)
    axis.set_yscale("log")
    low, high = axis.get_ylim()
    axis.set_ylim(max(low, ROUNDING), max(high, 10 * ROUNDING))


def guess_and_losses(
    motion: Float[np.ndarray, "T 21 3"],
    panels: Mapping[str, Mapping[str, tuple]],
    s: int,
    words: str,
    n: int = 4,
) -> Figure:
    """The network's guess at step s: n poses of x0_hat, and below them each loss over s.

    Step s is marked.
    """
    fig, axes = figure(11, 5.6, words, 2, max(n, len(panels)), heights=[1.25, 1])
    width = max(n, len(panels))
    draw_row(axes[:n], motion, f"x0_hat, s = {s}")
    for axis, (name, curves) in zip(axes[width:], panels.items(), strict=False):
        _log_curves(axis, curves, s)
        axis.set_title(name, fontsize=MEDIUM)
        axis.set_xlabel("s", fontsize=SMALL)
    for axis in [*axes[n:width], *axes[width + len(panels) :]]:
        axis.set_axis_off()
    handles = axes[width].get_legend_handles_labels()
    fig.legend(*handles, loc="outside lower center", ncols=4, frameon=False, fontsize=SMALL)
    return fig
