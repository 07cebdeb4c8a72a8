"""In-betweens by a network that was not trained for them: masked sampling, in metres.

A dancer samples a whole motion, and known entries are put back at each step. Its guess x0_hat can
disagree with them; then the motion jumps where they meet. So `inpaint` can be given a function that
makes the denoiser respect them: `blend`, or `guide_and_blend`. Bones and feet are corrected by
`editing.inbetween.clean_samples`.
Gain: docs/RESULTS_ALL.md (`inbetween-departures.no-guidance.*`, `.no-blending.*`).
Source: MoFusion 4.4.  Notebook: 15
"""

import math
from collections.abc import Callable, Sequence

import numpy as np
import torch
from jaxtyping import Bool, Float
from torch import Tensor

from ..beyond.guidance import blended, guided
from ..ddpm import Denoiser, Generators, Schedule, draw, final
from ..inbetweening import inpaint_steps
from ..motion.dance_frame import PATH
from ..motion.known import checked_given, given_features, with_given
from ..motion.skeleton import J
from ..performers.dancer import STEPS, Dancer
from ..performers.performer import float32

# of `guided`; a larger value follows sparse keyframes better, but the motion jumps more at the ends
# of a gap
WEIGHT = 0.5
FADE = 10  # frames within which a correction fades before the first and after the last given entry
Given = Float[Tensor, "B T 63"]
Known = Bool[Tensor, "B T 63"]
# (denoiser, schedule, given, known) -> a denoiser that respects what is given
Steer = Callable[[Denoiser, Schedule, Tensor, Tensor], Denoiser]


@float32()
def inpaint(
    dancer: Dancer,
    positions: Float[np.ndarray, "T 21 3"],
    known: Bool[np.ndarray, "T 21"],
    mel: Float[Tensor, "M C"] | None = None,
    *,
    samples: int = 1,
    steps: int | Sequence[int] = STEPS,
    steer: Steer | None = None,
    generator: Generators | None = None,
) -> Float[np.ndarray, "samples T 21 3"]:
    """Generate what is not known of a motion (metres, 20 frames/s), `samples` times.

    Known entries come back bit by bit as they were given; the others may be NaN. The network sees
    the motion from its first known pose. If nothing is known, the result is a plain sample.

    mel       the log-Mel spectrogram of the song, for a dancer with music
    steps     of DDIM: how many, or which to visit (`inbetweening.resampling_steps`)
    steer     `blend` or `guide_and_blend`; None: masked sampling as printed
    generator without one, the seed is 0
    Raises ValueError where a joint is given without the pelvis, or is given but NaN or infinite,
    for music and a network without, and for shapes that do not fit.
    Source: MoFusion 4.4.  Notebook: 15
    """
    positions, known = checked_given(positions, known)
    generator = generator or torch.Generator().manual_seed(0)
    place, features, columns = given_features(positions, known)
    given = dancer.motion_scaler.transform(features.to(dancer.device)).expand(samples, -1, -1)
    columns = columns.to(dancer.device).expand(samples, -1, -1)
    music = None if mel is None else mel[None].expand(samples, -1, -1)
    start, schedule = draw(given, generator), dancer.schedule
    denoise = dancer.denoiser(music, len(features))
    if steer is not None:
        denoise = steer(denoise, schedule, given, columns)
    loop = inpaint_steps(denoise, start, schedule, given, columns, steps=steps, generator=generator)
    made = dancer.motion_scaler.inverse(final(loop).x_s)
    return with_given(place, made, positions, known)


def blend(denoise: Denoiser, schedule: Schedule, given: Given, known: Known) -> Denoiser:
    """The denoiser, corrected so that its guess goes through the given entries."""
    return blended(denoise, schedule, given, known, fade_lengths(FADE).to(given.device))


def guide_and_blend(denoise: Denoiser, schedule: Schedule, given: Given, known: Known) -> Denoiser:
    """The same, with a guess that the network's own gradient moves first, at twice the cost."""
    if known.any():
        denoise = guided(denoise, schedule, given, known, WEIGHT)
    return blend(denoise, schedule, given, known)


def fade_lengths(frames: int) -> Float[Tensor, "63"]:
    """Fade lengths for `blended`: `frames` for every column, infinity for the pelvis' x and z.

    So the figure does not return to where it started.
    """
    fade = torch.full((3 * J,), float(frames))
    fade[PATH] = math.inf
    return fade
