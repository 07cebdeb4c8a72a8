"""In-betweens of motions in metres: known entries are kept, bit by bit, and the rest is generated.

An in-betweener fills in the rest, and then bones and feet are corrected.
Source: MoFusion 4.4.  Notebook: 15
"""

import numpy as np
from jaxtyping import Bool, Float

from ..beyond.above_floor import feet_above_floor, lowest_given
from ..beyond.constant_bones import Lengths, steady_bones
from ..beyond.dragged_feet import lift_dragged_feet
from ..beyond.foot_lock import steady_feet
from ..beyond.kept_places import kept_places
from ..beyond.step_clearance import clear_steps
from ..ddpm import Generators, timesteps
from ..inbetweening import resampled
from ..performers.inbetweener import STEPS, Inbetweener


def inbetween(
    inbetweener: Inbetweener,
    positions: Float[np.ndarray, "T 21 3"],
    known: Bool[np.ndarray, "T 21"],
    *,
    samples: int = 1,
    steps: int = STEPS,
    resample: int = 1,
    generator: Generators | None = None,
) -> Float[np.ndarray, "samples T 21 3"]:
    """Generate what is not known of a motion (metres, 20 frames/s), and correct bones and feet.

    The parameters and the errors are those of `Inbetweener.fill`. Known entries come back bit by
    bit as they were given. `resample`: how often each of the `steps` is made.
    Source: MoFusion 4.4.  Notebook: 15
    """
    visited = resampled(timesteps(inbetweener.schedule.S, steps), resample)
    made = inbetweener.fill(positions, known, samples=samples, steps=visited, generator=generator)
    return finished(made, positions, known)


def finished(
    made: Float[np.ndarray, "samples T 21 3"],
    given: Float[np.ndarray, "T 21 3"],
    known: Bool[np.ndarray, "T 21"],
    *,
    bones: bool = True,
    feet: bool = True,
    clearance: bool = True,
) -> Float[np.ndarray, "samples T 21 3"]:
    """Generated motions with the bones and the standing feet of what is given, over the floor.

    If nothing is known, they are not changed.
    bones     generated bones get the lengths of the given ones, or those that suit them
              (`beyond.constant_bones`)
    feet      planted feet do not slide (`beyond.foot_lock`), and a foot that is given twice at the
              same place stays there (`beyond.kept_places`)
    clearance planted feet lie on the floor, y = 0, and swinging ones are higher
              (`beyond.step_clearance`); none is lower than the floor and all given joints
              (`beyond.above_floor`), and one that is dragged takes a step (`beyond.dragged_feet`)
    """
    if not known.any():
        return made
    if bones:
        made = steady_bones(made, known, Lengths.of(given, known).completed())
    if feet:
        made = steady_feet(kept_places(made, given, known), known)
    if clearance:
        lowest = lowest_given(given, known)
        steps = [feet_above_floor(clear_steps(one, known), known, lowest) for one in made]
        made = np.stack([lift_dragged_feet(one, known, floor=lowest) for one in steps])
    return made
