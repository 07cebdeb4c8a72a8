"""In-betweens around straight lines: the network is shown what is given, and generates the rest.

    remainder = x0 - lines,   r_s = x_s - sqrt(alpha_bar_s) lines
    x0_hat = lines + net(r_s, s, lines, known)
Lines go straight from each given entry to the next. A network that was trained with masks denoises
what remains of a motion without them. On poses unlike its training it adds little, and the result
stays near the lines; a network that must generate the poses themselves jumps there. If nothing is
given, the lines are 0, and so the same network samples whole motions.
Gain: not measured yet; it will be `real.inbetween_over_interpolation.*` in docs/RESULTS.md. No
shipped network sees the lines.
Source: masks in training after CondMDI (Cohan and others, 2024); the lines are ours.
"""

import math
from dataclasses import dataclass

import torch
from jaxtyping import Bool, Float, Int
from torch import Tensor

from ..ddpm import Denoiser, Schedule, at
from .guidance import blended_guess


@dataclass(frozen=True, eq=False)
class Shown:
    """What the network is shown beside x_s and s: the lines, and which entries are given."""

    lines: Float[Tensor, "B T D"]
    known: Bool[Tensor, "B T D"]

    @classmethod
    def of(cls, given: Float[Tensor, "B T D"], known: Bool[Tensor, "B T D"]) -> "Shown":
        """The lines through the given entries; unknown entries of `given` can be anything."""
        return cls(lines_through(given, known), known)


def lines_through(
    given: Float[Tensor, "B T D"], known: Bool[Tensor, "B T D"]
) -> Float[Tensor, "B T D"]:
    """Straight lines from each given entry of a column to the next.

    Before the first and after the last one its value stays. A column without a given entry is 0,
    the mean of standardised features.
    """
    given = given.where(known, 0.0)
    return blended_guess(torch.zeros_like(given), given, known, fade=math.inf)


def around_lines(denoise: Denoiser, schedule: Schedule, lines: Float[Tensor, "B T D"]) -> Denoiser:
    """The denoiser of motions that belongs to a denoiser of their remainders.

    Both have the same noise, so eps_hat is that of the remainder.
    """

    def around(x_s: Float[Tensor, "B T D"], s: Int[Tensor, "B"]) -> Float[Tensor, "B T D"]:
        return denoise(x_s - at(schedule.alpha_bar.sqrt(), s, x_s) * lines, s)

    return around
