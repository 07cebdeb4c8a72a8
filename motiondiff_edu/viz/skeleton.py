"""Plots of skeletons: a strip of poses, several motions side by side, a path on the floor.

Positions are world positions in metres, (T, 21, 3), y up.  Notebook: 01
"""

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Polygon

from ..motion.skeleton import HIPS
from . import body
from .style import LARGE, MEDIUM, OKABE_ITO, SMALL, figure, legend

SIDES = [Patch(color=body.LEFT_COLOUR, label="left"), Patch(color=body.RIGHT_COLOUR, label="right")]


def pose_strip(
    positions: Float[np.ndarray, "T 21 3"],
    n: int = 8,
    fps: float | int = 20.0,
    past: int | None = None,
    title: str = "",
    camera: body.Camera | None = None,
) -> Figure:
    """n poses, evenly spaced from the first frame to the last.

    The first `past` frames are paler, because they were given.
    """
    words = f"{n} poses over {len(positions) / fps:.1f} s, left limbs blue, right limbs orange"
    words += "." if past is None else f"; the paler ones, up to {past / fps:.1f} s, were given."
    fig, axes = figure(
        1.35 * n, 2.75 + 0.4 * bool(title), f"{title}: {words}" if title else words, 1, n
    )
    for axis, t in zip(
        axes, np.linspace(0, len(positions) - 1, n).round().astype(int), strict=True
    ):
        draw_pose(axis, positions[t], camera, washed=bool(past is not None and t < past))
        axis.set_title(f"{t / fps:.1f} s", fontsize=SMALL)
    if title:
        fig.suptitle(title, fontsize=LARGE)
    fig.legend(handles=SIDES, loc="outside lower right", ncols=2, frameon=False, fontsize=SMALL)
    return fig


def side_by_side(
    motions: Sequence[Float[np.ndarray, "_ 21 3"]],
    labels: Sequence[str] | None = None,
    n: int = 6,
    fps: float | int = 20.0,
    past: int | None = None,
) -> Figure:
    """A row of n poses for each motion, at the same times; after its end a row is empty."""
    names = (
        list(labels) if labels is not None else [f"motion {i}" for i in range(1, len(motions) + 1)]
    )
    frames = np.linspace(0, max(map(len, motions)) - 1, n).round().astype(int)
    words = (
        f"Rows: {', '.join(names)}. {n} poses of each at the same times, left limbs blue, right "
        "limbs orange."
    )
    fig, axes = figure(1.4 * n, 2.2 * len(motions) + 0.8, words, len(motions), n)
    for i, axis in enumerate(axes):
        row, t = i // n, frames[i % n]
        if t < len(motions[row]):
            draw_pose(axis, motions[row][t], None, washed=bool(past is not None and t < past))
        else:
            axis.set_axis_off()
        if row == 0:
            axis.set_title(f"{t / fps:.1f} s", fontsize=SMALL)
        if i % n == 0:
            name_row(axis, names[row])
    fig.legend(handles=SIDES, loc="outside lower right", ncols=2, frameon=False, fontsize=SMALL)
    return fig


def noise_to_motion(
    moments: Mapping[int, Float[np.ndarray, "T 21 3"]], words: str, n: int = 4
) -> Figure:
    """A row for each diffusion step, in the order of `moments`, with n poses of the window.

    Source: MoDiff Fig. 1; MoFusion Fig. 2.  Notebook: 07
    """
    fig, axes = figure(1.4 * n, 1.75 * len(moments) + 0.5, words, len(moments), n)
    for row, (s, poses) in enumerate(moments.items()):
        for column, t in enumerate(np.linspace(0, len(poses) - 1, n).round().astype(int)):
            axis = axes[row * n + column]
            draw_pose(axis, poses[t])
            if row == 0:
                axis.set_title(f"pose {t + 1}", fontsize=SMALL)
        name_row(axes[row * n], f"s = {s}")
    fig.legend(handles=SIDES, loc="outside lower right", ncols=2, frameon=False, fontsize=SMALL)
    return fig


def name_row(axis: Axes, name: str) -> None:
    """Write the name vertically, to the left of the first axis of a row."""
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


def draw_pose(
    axis: Axes,
    pose: Float[np.ndarray, "21 3"],
    camera: body.Camera | None = None,
    washed: bool = False,
) -> None:
    """One figure in one axis, on a piece of floor, seen from its right and a little ahead."""
    size = (270, 420)
    pose = np.asarray(pose, np.float64)
    camera = (camera or body.Camera(focal=2.3)).at(*pose[HIPS, [0, 2]])
    for polygon in body.shadow_polygons(pose, camera, size):
        axis.add_patch(Polygon(polygon, color="#D5D9DF", lw=0, zorder=1))
    wash = body.PAST_WASH if washed else 0.0
    for order, (polygon, colour, is_outline) in enumerate(
        body.body_polygons(pose, camera, size, wash=wash)
    ):
        edge = {"ec": body.PAPER, "lw": 0.8} if is_outline else {"lw": 0}
        axis.add_patch(Polygon(polygon, fc=colour, zorder=2 + order / 100, **edge))
    axis.set(xlim=(0, size[0]), ylim=(size[1], 0), aspect="equal")
    axis.set_axis_off()


def top_view(path: Float[np.ndarray, "_ 2"]) -> Figure:
    """The floor from above, x to the left, with a path of points [x, z]."""
    words = "The floor from above; a square is one metre wide, and the arrow marks the start."
    fig, (axis,) = figure(6.2, 6.2, words)
    axis.plot(path[:, 0], path[:, 1], "-", color=OKABE_ITO[2], lw=3, label="path")
    axis.plot(0, 0, marker="^", color=body.INK, ms=11, ls="none")
    axis.set_aspect("equal", adjustable="datalim")
    axis.margins(0.08)
    axis.update_datalim([(-1.2, -0.6), (1.2, 1.2)])
    axis.autoscale_view()
    axis.invert_xaxis()  # x is the figure's left, so it grows to the left
    axis.set(xlabel="x, left (m)", ylabel="z, ahead (m)")
    legend(axis, loc="best")
    return fig
