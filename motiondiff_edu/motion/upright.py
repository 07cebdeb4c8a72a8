"""Which way is up in a file, and who says so.

Most files do not state it, and none of the witnesses is always right: a rest pose may stand in
other axes than the motion, and a person may lie, or stand on the hands. Four are asked:
    the rest pose, or the axis that the format prescribes
    the figure, if it is upright along one axis in most frames
    the feet, if they bear the figure: one at least stands still on the floor while the head moves
    the floor, if the lowest points of the motion are level, or at 0
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from .skeleton import HEELS, TOES, joint_index

HEAD = joint_index("Head")
AXES = ("+x", "-x", "+y", "-y", "+z", "-z")
CLEAR = 0.8  # of a unit vector: so much of it lies along one axis
# in lengths of a leg (0.835 m), and seconds:
MOVES = 0.03  # the speed of a head, at least
STILL = 0.42  # that of a foot that stands, at most
LOWEST = 0.15  # how far such a foot is from the lowest joint, at most
AT_ZERO = 0.07  # the height of a floor, at most
LEVEL = 0.5  # times as much as the lowest points, the highest ones of a figure go up and down
SLOWER = 3.0  # times as fast as the feet, a head moves that they bear
WEIGHTS = {"the feet": 2.0}  # of a witness; the others count 1


@dataclass(frozen=True)
class Up:
    """The axis that points up, such as "+z"; who says so; and what speaks against it, in words."""

    axis: str
    witnesses: tuple[str, ...]
    doubt: str = ""

    @property
    def words(self) -> str:
        """The axis and its witnesses, for a line."""
        said = agree(self.witnesses) if self.witnesses else "nobody says"
        return f"{self.axis.removeprefix('+')} up: {said} so"


def which_way_up(
    points: Float[np.ndarray, "T 21 3"],
    fps: float,
    rest: Float[np.ndarray, "21 3"] | None = None,
    stated: str = "",
    given: str = "",
) -> Up:
    """The axis that most witnesses name.

    Of two with as many it is that of the rest pose or the format, but where it is only upside down.

    points  the course's joints, in any unit and axes
    rest    the same joints as the skeleton stands
    stated  the axis that the format prescribes
    given   the axis that the user names, which is asked about no further
    """
    if given:
        return Up(given, ("as given",))
    said: dict[str, list[str]] = {}
    for axis, witness in ((clear_axis(rest), "the rest pose"), (stated, "the format")):
        if axis:
            said.setdefault(axis, []).append(witness)
    first = next(iter(said), "")
    upright = clear_axis(points)
    if upright:
        said.setdefault(upright, []).append("the figure")
    for axis in said:
        turned = rotate_y_up(points, axis) / leg_of(points)
        if feet_bear(turned, fps):
            said[axis].append("the feet")
        if abs(np.nanpercentile(lowest(turned), 5)) < AT_ZERO:
            said[axis].append("the floor at 0")
        if spread(lowest(turned)) < LEVEL * spread(lowest(-turned)):
            said[axis].append("level ground")
    if not said:
        return Up(nearest_axis(points), ())
    weights = {axis: weight_of(names) for axis, names in said.items()}
    # few stand on their heads for long, and a rest pose that does is no rarity; but many lie
    likely = upright if upright and upright[1:] == first[1:] else first
    best = max(weights, key=lambda axis: (weights[axis], axis == likely))
    return Up(best, tuple(said[best]), doubt(said, weights, best))


def weight_of(witnesses: list[str]) -> float:
    """How much they count together."""
    return sum(WEIGHTS.get(witness, 1.0) for witness in witnesses)


def doubt(said: Mapping[str, list[str]], weights: Mapping[str, float], best: str) -> str:
    """What speaks for another axis, in words; "" where it is clearly wrong."""
    for axis in said.keys() - {best}:
        lies = "the figure" in said[axis] and "the feet" not in said[best]
        if lies or weights[best] - weights[axis] < 1:
            return (
                f"{agree(said[best])} that {best} is up, but {agree(said[axis])} {axis}. {best} is "
                f'taken; if that is wrong, pass up="{axis}" (--up={axis})'
            )
    return ""


def agree(witnesses: Sequence[str]) -> str:
    """The witnesses, and that they say it."""
    *others, last = witnesses
    if not others:
        return f"{last} says"
    return f"{', '.join(others)} and {last} say"


def lowest(points: Float[np.ndarray, "T 21 3"]) -> Float[np.ndarray, "T"]:
    """The height of the lowest joint in each frame."""
    return np.nanmin(points[..., 1], axis=1)


def spread(heights: Float[np.ndarray, "T"]) -> float:
    """How far apart most heights are."""
    return float(np.ptp(np.percentile(heights, [10, 90])))


def body_axis(points: Float[np.ndarray, "T 21 3"]) -> Float[np.ndarray, "T 3"]:
    """Unit vector from the middle between the feet to the head."""
    axis = points[:, HEAD] - points[:, list(HEELS)].mean(1)
    return axis / np.maximum(np.linalg.norm(axis, axis=-1, keepdims=True), 1e-12)


def stands_upright(points: Float[np.ndarray, "T 21 3"]) -> bool:
    """Whether the figure is upright, along y, in most frames."""
    return float(np.nanmedian(body_axis(points)[:, 1])) > 0.5


def clear_axis(points: Float[np.ndarray, "*T 21 3"] | None) -> str:
    """The axis along which the figure is upright in most frames; "" if there is none."""
    if points is None:
        return ""
    along = np.nanmedian(body_axis(points.reshape(-1, *points.shape[-2:])), axis=0)
    return nearest_axis(points) if np.abs(along).max() > CLEAR else ""


def nearest_axis(points: Float[np.ndarray, "*T 21 3"]) -> str:
    """The axis that is nearest to the line from the feet to the head."""
    along = np.nanmedian(body_axis(points.reshape(-1, *points.shape[-2:])), axis=0)
    axis = int(np.abs(along).argmax())
    return "+-"[int(along[axis] < 0)] + "xyz"[axis]


def leg_of(points: Float[np.ndarray, "T 21 3"]) -> float:
    """The length of thigh and shank, in the unit of the points."""
    bones = [np.linalg.norm(points[:, j] - points[:, j - 1], axis=-1) for j in (2, 3, 6, 7)]
    return max(float(np.nanmedian(bones, axis=1).sum() / 2), 1e-12)


def feet_bear(points: Float[np.ndarray, "T 21 3"], fps: float) -> bool:
    """Whether one foot at least stands still, as the lowest of the figure, while the head moves.

    The points have y up, and legs of length 1.
    """
    feet = ground_points(points)
    if len(points) < 4 or np.isnan(feet).any():
        return False
    speeds, head = (
        np.linalg.norm(np.gradient(x, 1 / fps, axis=0), axis=-1) for x in (feet, points[:, HEAD])
    )
    slower = speeds.min(1)
    standing = np.take_along_axis(feet[..., 1], speeds.argmin(1)[:, None], 1)[:, 0]
    on_it = standing - lowest(points) < LOWEST
    bears = (slower < STILL) & on_it & (head > MOVES) & (head > SLOWER * slower)
    return bool(bears.mean() > 0.5)


def ground_points(points: Float[np.ndarray, "T 21 3"]) -> Float[np.ndarray, "T 2 3"]:
    """Toes, or ankles where a file has no toes."""
    toes = points[:, list(TOES)]
    return points[:, list(HEELS)] if np.isnan(toes).any() else toes


def rotate_y_up(points: Float[np.ndarray, "... 3"], up: str) -> Float[np.ndarray, "... 3"]:
    """Rotate (never mirror) so that the axis `up` becomes +y."""
    sign = -1.0 if up[0] == "-" else 1.0
    first, second = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[up[1]]
    turned = points[..., [second, "xyz".index(up[1]), first]] * np.array([1.0, sign, sign])
    return turned
