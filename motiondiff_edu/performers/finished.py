"""What is done to a generated motion in the end, so that bones are rigid and feet do not slide.

A network's joints are free points. Its bones stretch by centimetres, and its standing feet slide.
`Dancer.dance`, `Mover.act`, continuations and `md.edit` return finished motions; `Dancer.dance_mel`
and `Mover.act_ids` return the network's own.
Source: Kovar and others, 2002 (feet), Müller and others, 2007 (bones).
"""

import numpy as np
from jaxtyping import Bool, Float

from ..beyond.above_floor import feet_above_floor, lowest_given
from ..beyond.constant_bones import Lengths, steady_bones
from ..beyond.dragged_feet import lift_dragged_feet
from ..beyond.foot_lock import LOW, steady_feet

GLIDE = 0.2  # m: a foot that goes farther than this from its place is not held there
# m above its floor: a dancer's toe is lifted by 3 to 6 cm in a small step, and must not be held
STEP_LOW = 0.02


def finished_performance(
    positions: Float[np.ndarray, "T 21 3"],
    fps: float,
    bones: Float[np.ndarray, "20"] | None = None,
) -> Float[np.ndarray, "T 21 3"]:
    """A generated dance or act (metres) whose bones have these lengths, and whose feet stand.

    bones  the lengths that the network was taught (default: the medians of this motion)
    """
    nothing = np.zeros(positions.shape[:2], bool)
    lengths = Lengths.of(positions, ~nothing)
    lengths = lengths if bones is None else lengths.with_bones(bones)
    return _finished(positions, fps, nothing, lengths, STEP_LOW, 0.0)


def finished_continuation(
    positions: Float[np.ndarray, "T 21 3"], fps: float, known: Bool[np.ndarray, "T 21"]
) -> Float[np.ndarray, "T 21 3"]:
    """Given and generated frames (metres, world): what is `known` stays, the rest follows it.

    As `held_continuation` has it; and a foot that is still dragged over the floor takes a step.
    """
    whole = held_continuation(positions, fps, known)
    return lift_dragged_feet(whole, known, fps, lowest_given(positions, known))


def held_continuation(
    positions: Float[np.ndarray, "T 21 3"], fps: float, known: Bool[np.ndarray, "T 21"]
) -> Float[np.ndarray, "T 21 3"]:
    """Given and generated frames (metres, world), in which feet that stand are held.

    Bones get the lengths that they have where they are given, and no foot is lower than the given
    joints, or than 0 if these are higher.
    """
    lengths, floor = Lengths.of(positions, known), lowest_given(positions, known)
    return _finished(positions, fps, known, lengths, LOW, floor)


def finished_edit(
    positions: Float[np.ndarray, "T 21 3"],
    given: Float[np.ndarray, "T 21 3"],
    fps: float,
    known: Bool[np.ndarray, "T 21"],
) -> Float[np.ndarray, "T 21 3"]:
    """An edited motion (metres, world) with the body and the floor of the given one.

    What is `known` stays where it is.
    """
    everything = np.ones(known.shape, bool)
    lengths, floor = Lengths.of(given, everything), lowest_given(given, everything)
    return _finished(positions, fps, known, lengths, LOW, floor)


def _finished(positions, fps, known, lengths, low: float, floor: float) -> np.ndarray:
    whole = steady_bones(positions, known, lengths)
    whole = steady_feet(whole, known, fps, farthest=GLIDE, low=low)
    return feet_above_floor(whole, known, floor)
