"""Is this a figure, of human size, in metres, upright? What is wrong is said in words."""

import numpy as np
from jaxtyping import Float

from .skeleton import BONE_LENGTHS, BONES, COURSE, TOES, Skeleton, joint_index

HEAD = joint_index("Head")
# units by name, and how many make a metre
SHORT = {"m": 1.0, "cm": 100.0, "mm": 1000.0, "inches": 39.37, "feet": 3.281}
LONG = {"m": "metres", "cm": "centimetres", "mm": "millimetres"}
UNITS = {LONG.get(name, name): many for name, many in SHORT.items() if many != 1}


def bones_over_ours(positions: Float[np.ndarray, "T J 3"], skeleton: Skeleton = COURSE) -> float:
    """How long the bones of a figure are, all together, over the course's.

    NaN for another skeleton, and where no bone is seen.
    """
    if skeleton != COURSE:
        return np.nan
    bones = np.diff(positions[:, np.array(BONES)], axis=2)[:, :, 0]
    long = np.linalg.norm(bones, axis=-1)
    seen = np.isfinite(long)
    whole = np.broadcast_to(BONE_LENGTHS, long.shape)[seen].sum()
    return float(long[seen].sum() / whole) if seen.any() else np.nan


def unit_of(
    positions: Float[np.ndarray, "T J 3"], skeleton: Skeleton = COURSE
) -> tuple[str, float]:
    """The unit of a figure that is a person in another unit than metres, and how many make a metre.

    ("", 1.0) where none fits.
    """
    size = bones_over_ours(positions, skeleton)
    fits = (one for one in UNITS.items() if one[1] / 1.4 < size < 1.4 * one[1])
    return next(fits, ("", 1.0))


def unit_name(metres: float) -> str:
    """A unit of so many metres by its name, or by how many of it a metre has."""
    many = 1 / metres
    near = min(SHORT, key=lambda name: abs(np.log(many / SHORT[name])))
    if abs(np.log(many / SHORT[near])) < np.log(1.4):
        return near
    return f"{many:.3g} to the metre"


def unlike_a_body(positions: Float[np.ndarray, "T J 3"], skeleton: Skeleton = COURSE) -> str:
    """What is wrong with the size of a figure on the course's skeleton, in words; "" if nothing.

    Its bones, all together, must be half to twice as long as the course's.
    """
    size = bones_over_ours(positions, skeleton)
    if np.isnan(size) or 0.5 < size < 2:
        return ""
    if not size:
        return "all joints of a frame are in one place, so this is no figure"
    unit, many = unit_of(positions, skeleton)
    how = f"{unit.capitalize()}? Then" if unit else "For a figure of that size"
    return (
        f"the bones are {size:.3g} times as long as the course's, but positions are in metres and "
        f"the figure is 1.70 m tall. {how} pass {1 / (many if unit else size):.4g} * positions"
    )


# what turns a figure upright: {axis from its feet to its head, and whether it goes up that axis}
UPRIGHT = {
    (0, False): "[..., [1, 0, 2]] * [1, -1, 1]",
    (0, True): "[..., [1, 0, 2]] * [-1, 1, 1]",
    (1, False): " * [1, -1, -1]",
    (2, False): "[..., [0, 2, 1]] * [1, -1, 1]",
    (2, True): "[..., [0, 2, 1]] * [1, 1, -1]",
}


def lies_down(positions: Float[np.ndarray, "T J 3"], skeleton: Skeleton = COURSE) -> str:
    """What is wrong with the axes of a figure on the course's skeleton, in words; "" if nothing.

    From the feet to the head it must go up, along y, in most frames.
    """
    if skeleton != COURSE:
        return ""
    upright = positions[:, HEAD] - positions[:, list(TOES)].mean(1)
    upright = upright[np.isfinite(upright).all(1)]
    if not len(upright):
        return ""
    along = np.median(upright, axis=0)
    if along[1] > 0.5 or np.abs(along).max() < 1.0:
        return ""
    axis = int(np.abs(along).argmax())
    turn = f"try positions{UPRIGHT[axis, bool(along[axis] > 0)]}"
    if axis == 1:
        return f"the figure stands on its head: y points up. If that is wrong, {turn}"
    return f"the figure lies along {'xyz'[axis]}, but y points up: {turn}"


def check_finite(values: Float[np.ndarray, "*shape"], name: str) -> None:
    """Raise ValueError where a value is NaN or infinite.

    A comparison with NaN is False, so a measure that counts would give a plausible wrong number.
    """
    bad = np.argwhere(~np.isfinite(values))
    if len(bad):
        raise ValueError(
            f"{name} contain NaN or infinity ({len(bad)} values, the first at index "
            f"{tuple(bad[0].tolist())}): fill or cut them first"
        )
