"""Classifier-free guidance: away from what the network makes without a condition, towards its own.

    eps_hat = (1 - w) eps_hat(x_s, s, nothing) + w eps_hat(x_s, s, condition)
w = 1 is the conditional network, as in the papers. A larger w follows a text or a song more
closely; the result is no sample of the conditional any more. In training, some conditions are left
out, so that one network is both. It costs two evaluations at every step.
A dancer is guided only in the middle (`while_between`), where the stops are put on the beat. At
first, in almost pure noise, guidance would make dances to one song alike; at the end it would
exaggerate what is fine, and feet would slide.
A mover that plans guides the timeline first. Where the text of the motion is left out, its timeline
stays, in training too, so for the motion a larger w stresses what the timeline does not say.
Gain: docs/RESULTS.md, *From MoFusion to our dancer*, for music: the beat, and variety
(`dancer-departures.guidable.*`); for texts, docs/RESULTS_ALL.md (`words.guided.*`).
Source: Ho and Salimans, 2022; in an interval of noise alone: Kynkäänniemi and others, 2024. Ours;
MoFusion has no guidance.
Notebook: 12, 16
"""

from dataclasses import replace

import torch
from jaxtyping import Bool
from torch import Tensor

from ..ddpm import Denoiser, Schedule, at
from ..mofusion import Music


def without(music: Music, left_out: Bool[Tensor, "B"] | None = None) -> Music:
    """The context of no music: tokens of 0, for all samples or for those that are left out.

    With them, attention says the same at each moment, whatever is played.
    """
    if left_out is None:
        return replace(music, tokens=torch.zeros_like(music.tokens))
    return replace(music, tokens=music.tokens.where(~left_out[:, None, None], 0.0))


def guided_by_condition(conditional: Denoiser, unconditional: Denoiser, w: float) -> Denoiser:
    """A denoiser between the two for w from 0 to 1, and beyond the conditional one above 1."""
    if w == 1:
        return conditional
    return lambda x_s, s: (1 - w) * unconditional(x_s, s) + w * conditional(x_s, s)


def while_between(
    inside: Denoiser, outside: Denoiser, schedule: Schedule, least: float, most: float
) -> Denoiser:
    """`inside` while alpha_bar, the share of the signal, is from `least` to `most`.

    Samples of a batch may be at different steps.
    """

    def denoise(x_s, s):
        share = at(schedule.alpha_bar, s, x_s)
        between = (least <= share) & (share <= most)
        if between.all():
            return inside(x_s, s)
        if not between.any():
            return outside(x_s, s)
        return torch.where(between, inside(x_s, s), outside(x_s, s))

    return denoise
