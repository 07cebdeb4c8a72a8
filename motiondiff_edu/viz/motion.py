"""Plots of the parts of motion: joints by number, poses in between, paths from above, windows.

The functions take plain arrays and return a Figure with a caption.  Notebook: 01
"""

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from ..motion.skeleton import BONES, JOINTS, LEFT, RIGHT
from .body import CENTRE_COLOUR, INK, LEFT_COLOUR, PATH_COLOUR, RIGHT_COLOUR
from .style import figure as captioned

SERIES = (
    INK,
    "#E69F00",
    LEFT_COLOUR,
    PATH_COLOUR,
)  # colour-blind readers can distinguish them, also by marker and label


def _side_colour(joint: int) -> str:
    return LEFT_COLOUR if joint in LEFT else RIGHT_COLOUR if joint in RIGHT else CENTRE_COLOUR


def _bones_2d(axes, pose: np.ndarray) -> None:
    """The bones of one pose (J, 2) on the given axes; the child's side gives the colour."""
    for parent, child in BONES:
        style = {"color": _side_colour(child), "lw": 3, "solid_capstyle": "round"}
        axes.plot(*pose[[parent, child]].T, **style)


def joint_map(pose: Float[np.ndarray, "21 3"], caption: str) -> Figure:
    """The skeleton from the front, with the number of every joint, and a list of their names."""
    figure, (drawn, listed) = captioned(9, 5.6, caption, 1, 2, widths=[2, 1])
    drawn.grid(False)
    _bones_2d(drawn, pose[:, :2])
    drawn.plot(*pose[:, :2].T, "o", ms=14, mfc="white", mec=INK)
    drawn.margins(0.12, 0.05)
    for j, (x, y) in enumerate(pose[:, :2]):
        drawn.text(x, y, str(j), ha="center", va="center", fontsize=8)
    drawn.set(aspect="equal", xlabel="x: to the figure's left (m)", ylabel="y: up (m)")
    listed.axis("off")
    for j, name in enumerate(JOINTS):
        row = 1 - j / len(JOINTS)
        listed.text(
            0,
            row,
            f"{j:2d} {name}",
            color=_side_colour(j),
            fontsize=11,
            family="monospace",
            va="top",
        )
    return figure


def limb_steps(
    ways: Mapping[str, Float[np.ndarray, "U K 2"]],
    lengths: Mapping[str, Float[np.ndarray, "N"]],
    true_length: float,
    caption: str,
) -> Figure:
    """A limb of K joints at U moments between two poses, with a panel for each interpolation.

    Below it is the length of the bone (m).
    """
    n = len(ways)
    figure, axes = captioned(3.2 * n, 5.8, caption, 2, n, share="rows", heights=[2.4, 1])
    reach = 1.3 * max(np.abs(limb).max() for limb in ways.values())
    for panel, curve, (name, limb) in zip(axes[:n], axes[n:], ways.items(), strict=True):
        for u, pose in zip(np.linspace(0, 1, len(limb)), limb, strict=True):
            panel.plot(*pose.T, "o-", color=INK, alpha=0.25 + 0.75 * (u in (0, 1)), ms=4, lw=2)
            beyond = pose[-1] + 0.08 * pose[-1] / np.linalg.norm(pose[-1])
            panel.text(
                *beyond, f"{u:.2g}", fontsize=10, color=RIGHT_COLOUR, ha="center", va="center"
            )
        panel.set(aspect="equal", title=name, xlabel="x (m)", xticks=(-0.5, 0, 0.5))
        panel.set(xlim=(-reach, reach), ylim=(-reach, reach))
        curve.plot(np.linspace(0, 1, len(lengths[name])), lengths[name], color=LEFT_COLOUR)
        curve.axhline(true_length, color=INK, lw=0.8, ls="--")
        curve.set(xlabel="fraction of the way, u", ylim=(0, 1.15 * true_length))
    axes[0].set_ylabel("y (m)")
    axes[n].set_ylabel("bone (m)")
    return figure


def paths_from_above(
    paths: Mapping[str, tuple[Float[np.ndarray, "_ 2"], Float[np.ndarray, "_"]]],
    caption: str,
    every: int = 10,
) -> Figure:
    """Root paths (x, z) seen from above, with headings (radians) as arrows.

    The figure's left is on the left.
    """
    spread = np.ptp(np.concatenate([root for root, _ in paths.values()]), axis=0)
    figure, (axes,) = captioned(
        9, 1.4 + 6.5 * min(max(spread[1] / max(spread[0], 1e-3), 0.3), 0.75), caption
    )
    for k, (name, (root, heading)) in enumerate(paths.items()):
        colour = SERIES[k % len(SERIES)]
        under = {"lw": 5, "alpha": 0.4} if k == 0 and len(paths) > 1 else {"lw": 2}
        axes.plot(*root.T, color=colour, label=name, ls="-" if k == 0 else "--", **under)
        axes.plot(*root[0], "o", color=colour, ms=8)
        arrows = 0.6 * np.stack([np.sin(heading[::every]), np.cos(heading[::every])], 1)  # metres
        axes.quiver(
            *root[::every].T,
            *arrows.T,
            color=colour,
            angles="xy",
            scale_units="xy",
            scale=1,
            width=0.005,
            zorder=3,
        )
        axes.update_datalim(root[::every] + arrows)
    axes.margins(0.1)
    axes.invert_xaxis()  # seen from above and along z, the figure's left is on the left
    axes.set(aspect="equal", xlabel="x: left (m)", ylabel="z: forward (m)")
    if len(paths) > 1:
        axes.legend(loc="center left", bbox_to_anchor=(1.02, 0.5), frameon=False)
    return figure


def windows_in_time(
    starts: Sequence[Sequence[int]],
    length: int,
    groups: Sequence[Sequence[str]],
    caption: str,
    fps: float = 20.0,
) -> Figure:
    """Training windows as bars over time.

    starts[k] are the first frames of the windows of recording k, groups[k] are "train" or "test".
    """
    figure, (axes,) = captioned(9, 1.3 + 0.6 * len(starts), caption)
    axes.grid(False)
    colours = {"train": LEFT_COLOUR, "test": RIGHT_COLOUR}
    for k, (firsts, names) in enumerate(zip(starts, groups, strict=True)):
        for n, (first, name) in enumerate(zip(firsts, names, strict=True)):
            axes.barh(
                k + 0.38 * (n % 2),
                length / fps,
                0.34,
                first / fps,
                color=colours[name],
                edgecolor="white",
            )
    keys = [Patch(color=colour, label=name) for name, colour in colours.items()]
    names = [f"recording {k}" for k in range(len(starts))]
    axes.set(yticks=np.arange(len(starts)) + 0.19, yticklabels=names, xlabel="time (s)")
    axes.legend(
        handles=keys, ncols=2, loc="lower right", fontsize=11, bbox_to_anchor=(1, 1), frameon=False
    )
    axes.invert_yaxis()
    return figure
