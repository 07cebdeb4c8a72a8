"""In-betweens of motions in metres: known entries are kept, bit by bit, and the rest is generated.

An in-betweener fills in the rest, and then seams, bones and feet are cleaned up.
Source: MoFusion 4.4.  Notebook: 15
"""

import numpy as np
from jaxtyping import Bool, Float

from ..ddpm import Generators, timesteps
from ..inbetweening import resampling_steps
from ..motion.cleanup import clean_up
from ..motion.root_frame import FPS
from ..performers.inbetweener import Inbetweener
from ..performers.performer import STEPS


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
    """Generate what is not known of a motion (metres, 20 frames/s), and clean it up.

    The parameters and the errors are those of `Inbetweener.fill`. Known entries come back bit by
    bit as they were given. `resample`: how often each of the `steps` is made.
    Source: MoFusion 4.4.  Notebook: 15
    """
    visited = resampling_steps(timesteps(inbetweener.schedule.S, steps), resample)
    made = inbetweener.fill(positions, known, samples=samples, steps=visited, generator=generator)
    return clean_samples(made, known)


def clean_samples(
    made: Float[np.ndarray, "samples T 21 3"], known: Bool[np.ndarray, "T 21"]
) -> Float[np.ndarray, "samples T 21 3"]:
    """`motion.cleanup.clean_up` for several samples of one motion at 20 frames/s."""
    return np.stack([clean_up(one, FPS, known) for one in made])
