"""Past noise: in training the past gets errors like those that a rollout makes.

A walker continues its own poses, which are never quite right. If it was trained on clean
pasts alone, small errors grow. The paper's remedy is diffusion dropout (MoDiff III-D); this one is
ours, and `walker` and `walker-plain` have it.
Gain: docs/RESULTS.md, *From the paper's walker to ours* (`walker-departures.past-noise.*`): bone
errors are smaller, the control is kept better, feet slide less.
"""

import torch
from jaxtyping import Float
from torch import Tensor

FRESH = 0.3  # at this amount, the fresh error of a frame is as large as its change from the last


def past_noise(
    past: Float[Tensor, "B T_h D"],
    amount: float,
    change: Float[Tensor, "D"],
    generator: torch.Generator,
) -> Float[Tensor, "B T_h D"]:
    """The past plus two errors: a steady one, the same in all frames, and a fresh one in each.

    The steady error has a standard deviation of up to `amount`, in the units of `past`
    (standardised). The fresh one has up to amount / 0.3 times `change`, which is how far each
    column moves in one frame. Each past has its own two levels, drawn evenly on a log scale over
    two decades: the network must keep small errors small, and correct large ones.
    """
    B, T_h, D = past.shape
    steady, fresh = amount * 10 ** (-2 * torch.rand(2, B, 1, 1, generator=generator))
    noise = steady * torch.randn(B, 1, D, generator=generator)
    noise = noise + fresh / FRESH * change.cpu() * torch.randn(B, T_h, D, generator=generator)
    return past + noise.to(past)
