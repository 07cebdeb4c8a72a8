"""In-betweens without a model: straight lines between given joints, or arcs that keep the bones.

Before the first and after the last given frame its pose is held.
Source: every paper on in-betweening compares with these; arcs are spherical interpolation (slerp)
of the bones' directions.
Notebook: 15
"""

import numpy as np
from jaxtyping import Bool, Float

from ..motion.skeleton import BONES


def linear(
    positions: Float[np.ndarray, "T J 3"], known: Bool[np.ndarray, "T J"]
) -> Float[np.ndarray, "T J 3"]:
    """Each joint moves in a straight line from one given position to the next.

    Raises ValueError for a joint that is never given.

    Notebook: 15
    """
    _each_is_given(known)
    filled, times = np.array(positions, np.float64), np.arange(len(positions))
    for joint in range(positions.shape[1]):
        here = known[:, joint]
        for axis in range(3):
            filled[~here, joint, axis] = np.interp(
                times[~here], times[here], positions[here, joint, axis]
            )
    return filled


def spherical(
    positions: Float[np.ndarray, "T J 3"], known: Bool[np.ndarray, "T J"]
) -> Float[np.ndarray, "T J 3"]:
    """The pelvis moves in straight lines; every bone turns evenly and keeps its length.

    A bone turns from one given direction to the next. It is given where both of its ends are. Given
    joints stay where they are.
    Raises ValueError for a joint that is never given.  Notebook: 15
    """
    _each_is_given(known)
    straight = linear(positions, known)
    filled = np.array(straight)
    for parent, child in BONES:
        both = known[:, parent] & known[:, child]
        if not both.any():
            continue
        bone = positions[both, child] - positions[both, parent]
        turned = _slerp(bone, np.flatnonzero(both), np.arange(len(positions)))
        filled[:, child] = np.where(
            known[:, child, None], positions[:, child], filled[:, parent] + turned
        )
    return filled


def _slerp(
    vectors: Float[np.ndarray, "K 3"], at: np.ndarray, times: np.ndarray
) -> Float[np.ndarray, "T 3"]:
    """Interpolate vectors given at the frames `at`: directions on a great circle, lengths linearly.

    Opposite directions turn along any of the great circles between them.
    """
    length = np.linalg.norm(vectors, axis=-1)
    unit = vectors / np.maximum(length, 1e-12)[:, None]
    after = np.clip(np.searchsorted(at, times, side="right"), 1, max(len(at) - 1, 1))
    first, second = after - 1, np.minimum(after, len(at) - 1)
    span = np.maximum(at[second] - at[first], 1)
    share = np.clip((times - at[first]) / span, 0, 1)[:, None]
    start, end = unit[first], unit[second]
    cos = (start * end).sum(-1, keepdims=True)
    aside = end - cos * start  # at right angles to the start; its length is the sine
    sin = np.linalg.norm(aside, axis=-1, keepdims=True)
    any_side = np.cross(start, np.eye(3)[np.abs(start).argmin(-1)])
    aside = np.where(sin > 1e-9, aside, any_side)
    aside /= np.maximum(np.linalg.norm(aside, axis=-1, keepdims=True), 1e-12)
    turn = share * np.arctan2(sin, cos)
    return (np.cos(turn) * start + np.sin(turn) * aside) * np.interp(times, at, length)[:, None]


def _each_is_given(known: Bool[np.ndarray, "T J"]) -> None:
    never = np.flatnonzero(~known.any(0))
    if len(never):
        raise ValueError(f"joint {int(never[0])} is never given, so it cannot be interpolated")
