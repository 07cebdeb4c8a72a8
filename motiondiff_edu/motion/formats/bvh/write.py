"""Writing a motion as BVH: `write_bvh(path, clip.world(), fps=20)`.

The file is in centimetres, y up, with channels Zrotation Xrotation Yrotation. The root's OFFSET is
zero: some programs add it to the position channels, others replace it by them, and with zero they
agree. Three joints of length zero (LowerBack, LeftShoulder, RightShoulder) let spine and collars
turn freely, as in files of the CMU library.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from ...._files import replacing
from ...skeleton import J
from .fit import END_SITES, Fit, FitReport, fit
from .frames import FASTEST, SLOWEST
from .tokens import BvhError

CM = 100.0
TURN = "Zrotation Xrotation Yrotation"


def write_bvh(
    path: str | Path, positions: Float[np.ndarray, "T 21 3"], fps: float | int = 20.0
) -> FitReport:
    """Write world positions (metres) as a BVH file.

    Prints and returns how far the constant-bone fit moves the joints.

    The file is written completely or not at all. Raises BvhError for an empty or non-finite motion,
    another shape, and a frame rate outside the range that readers accept.
    """
    path = Path(path)
    positions = np.asarray(positions, dtype=np.float64)
    if not len(positions) or not np.isfinite(positions).all():
        what = "has no frames" if not len(positions) else "has values that are not finite"
        raise BvhError(f"the motion {what}; nothing was written.", path)
    if positions.shape[1:] != (J, 3):
        raise BvhError(
            f"positions must be (T, {J}, 3), world positions in metres; these are "
            f"{positions.shape}. For a walker's output use "
            f"root_frame.to_world(new.reshape(-1, {J}, 3), control). Nothing was written.",
            path,
        )
    if not 1 / SLOWEST <= fps <= 1 / FASTEST:
        limits = f"{1 / SLOWEST:g} to {1 / FASTEST:g}"
        raise BvhError(
            f"fps must be {limits} frames a second, not {fps:g}; nothing was written.", path
        )
    fitted = fit(positions)
    with replacing(path) as aside:
        aside.write_text(text(fitted, float(fps)), encoding="ascii", newline="\n")
    report = replace(fitted.report, path=path.name)
    print(report)
    return report


def text(fitted: Fit, fps: float) -> str:
    """The text of the whole file."""
    columns = [CM * fitted.root, *np.moveaxis(fitted.angles, 1, 0)]
    rows = np.concatenate(columns, axis=1)
    lines = [" ".join(f"{value:.6f}" for value in row) for row in rows]
    head = [
        "HIERARCHY",
        *joint_lines(fitted, 0, 0),
        "MOTION",
        f"Frames: {len(rows)}",
        f"Frame Time: {1 / fps:.8f}",
    ]
    return "\n".join(head + lines) + "\n"


def joint_lines(fitted: Fit, node: int, depth: int) -> list[str]:
    """The lines of a joint and of all joints below it.

    The columns of the motion have the same order as these nodes.
    """
    name, pad = fitted.names[node], "\t" * depth
    kind = "ROOT" if depth == 0 else "JOINT"
    channels = f"6 Xposition Yposition Zposition {TURN}" if depth == 0 else f"3 {TURN}"
    inner = [f"{pad}\tOFFSET {triple(fitted.offsets[node])}", f"{pad}\tCHANNELS {channels}"]
    for child in np.flatnonzero(fitted.parents == node):
        inner += joint_lines(fitted, int(child), depth + 1)
    if name in END_SITES:
        inner += [
            f"{pad}\tEnd Site",
            f"{pad}\t{{",
            f"{pad}\t\tOFFSET {triple(END_SITES[name])}",
            f"{pad}\t}}",
        ]
    return [f"{pad}{kind} {name}", f"{pad}{{", *inner, f"{pad}}}"]


def triple(offset: Float[np.ndarray, "3"] | tuple[float, float, float]) -> str:
    """Three numbers in centimetres."""
    return " ".join(f"{CM * value:.6f}" for value in offset)
