"""Gain noise: in training, music as from different loudspeakers.

The level of the music and its balance of low and high frequencies change at random from window to
window, so that a dancer does not depend on how a song was mastered.
Gain: docs/RESULTS.md, *From MoFusion to our dancer* (`dancer-departures.gain-noise.*`): none was
seen; bones are worse.
Ours; the paper does not change the music.
"""

import torch
from jaxtyping import Float
from torch import Tensor


def gain_noise(
    mel: Float[Tensor, "B M C"], amount: float, generator: torch.Generator
) -> Float[Tensor, "B M C"]:
    """The music plus a level and a tilt over the bands, both of standard deviation `amount`.

    `mel` is standardised. The change is the same at all times of a window.
    """
    level, tilt = amount * torch.randn(2, len(mel), 1, 1, generator=generator)
    return mel + level + tilt * torch.linspace(-1, 1, mel.shape[-1])
