"""Dance by regression: one dance for each song, the mean of all its possible dances.

The network gets no noise, so the same song gives the same dance. If many continuations are right,
their mean minimises the squared error, and a mean of dances hardly moves.
Source: the idea of AI Choreographer, a baseline in MoFusion's Table 1.  Notebook: 14
"""

import torch
from jaxtyping import Float
from torch import Tensor, nn


def regression_loss(
    model: nn.Module,
    x0: Float[Tensor, "B T D"],
    mel: Float[Tensor, "B M C"],
    mel_times: Float[Tensor, "M"],
) -> Float[Tensor, ""]:
    """Mean squared error of the motion itself, from no noise at step 0.

    mel_times  seconds of each row of the log-Mel spectrogram
    """
    s = torch.zeros(len(x0), dtype=torch.long, device=x0.device)
    music = model.listen(mel, mel_times)  # type: ignore[operator]  # a method, as MoFusion's
    out = model(torch.zeros_like(x0), s, music)
    return (out - x0).square().mean()
