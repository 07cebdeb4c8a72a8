"""What is done to a generated motion in the end, so that bones are rigid and feet do not slide.

A network's joints are free points. Its bones stretch by centimetres, and its standing feet slide.
`Dancer.dance` and continuations return finished motions; `Dancer.dance_mel` returns the network's
own.
Source: Kovar and others, 2002 (feet), Müller and others, 2007 (bones).
"""

import numpy as np
from jaxtyping import Bool, Float

from ..beyond.above_floor import feet_above_floor
from ..beyond.constant_bones import given_lengths, steady_bones
from ..beyond.foot_lock import steady_feet

GLIDE = 0.2  # m: a foot that goes farther than this from its place is not held there


def finished(
    positions: Float[np.ndarray, "T 21 3"],
    fps: float,
    known: Bool[np.ndarray, "T 21"] | None = None,
) -> Float[np.ndarray, "T 21 3"]:
    """A generated motion (metres, world) with bones of one length, and with feet that stand.

    Joints that are `known` stay where they are, and bones have the lengths that they have there.
    Where nothing is known, each bone has its median length.
    """
    nothing = np.zeros(positions.shape[:2], bool)
    known = nothing if known is None else known
    lengths = given_lengths(positions, known if known.any() else ~nothing)
    whole = steady_bones(positions, known, lengths)
    whole = steady_feet(whole, known, fps, farthest=GLIDE)
    return feet_above_floor(whole, known)
