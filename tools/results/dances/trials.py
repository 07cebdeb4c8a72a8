"""A dancer's dances to given songs."""

import numpy as np
import torch
from jaxtyping import Float

from motiondiff_edu.performers.dancer import Dancer


def dances_of(
    dancer: Dancer, mel: Float[torch.Tensor, "N M C"], frames: int, seed: int, batch: int = 25
) -> Float[np.ndarray, "N T 21 3"]:
    """One dance to each song; metres."""
    draw = torch.Generator().manual_seed(seed)
    parts = [dancer.dance_mel(part, frames, generator=draw) for part in mel.split(batch)]
    return torch.cat(parts).double().numpy()
