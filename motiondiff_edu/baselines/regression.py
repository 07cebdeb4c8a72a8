"""Dance by regression: one dance for each song, the mean of all its possible dances.

The network gets no noise, so the same song gives the same dance. If many continuations are right,
their mean minimises the squared error, and a mean of dances hardly moves.
Source: the idea of AI Choreographer, a baseline in MoFusion's Table 1.  Notebook: 14
"""

from collections.abc import Callable

import torch
from torch import Tensor, nn

from ..performers.dance_windows import DanceWindows
from .transformer import TransformerConfig

REGRESSION = TransformerConfig(deterministic=True)


def regression_loss(
    windows: DanceWindows, *, batch: int = 32, gain_noise: float = 0.0
) -> Callable[[nn.Module, torch.Generator], Tensor]:
    """Mean squared error of the motion itself, as a `loss_fn` for `training.train_steps`."""

    def loss_fn(model: nn.Module, generator: torch.Generator) -> Tensor:
        device = next(model.parameters()).device
        x0, mel, _ = (part.to(device) for part in windows.draw(batch, generator, gain_noise))
        s = torch.zeros(batch, dtype=torch.long, device=device)
        out = model(torch.zeros_like(x0), s, model.listen(mel, windows.mel_times.to(device)))
        return (out - x0).square().mean()

    return loss_fn
