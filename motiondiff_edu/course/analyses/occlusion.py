"""What changes in a dance when one sound is removed? The dance with it and without, from the same
noise.

Source: ours; MoFusion Fig. 4 shows attention instead.  Notebook: 12
"""

from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Float

from ...conditions.music import SAMPLE_RATE, log_mel
from ...conditions.silence import WIDTH, silence_hit
from ...performers.dancer import Dancer


@dataclass(frozen=True, eq=False)
class Occlusion:
    """A dance, and for each silenced sound the dance `without` it, from the same noise.

    `moved` is the distance between the two in each frame, in metres, averaged over the joints.
    """

    times: Float[np.ndarray, "K"]
    dance: Float[np.ndarray, "T 21 3"]
    without: Float[np.ndarray, "K T 21 3"]

    @property
    def moved(self) -> Float[np.ndarray, "K T"]:
        return np.linalg.norm(self.without - self.dance, axis=-1).mean(-1)


def occlusion(
    dancer: Dancer,
    audio: Float[np.ndarray, "N"],
    times: Float[np.ndarray, "K"],
    frames: int,
    *,
    generator: torch.Generator | None = None,
    width: float = WIDTH,
    steps: int = 20,
    batch: int = 6,
) -> Occlusion:
    """Dance to the song (16 kHz), and again with the sound at each of `times` (seconds) silenced.

    The start noise is the same, and DDIM adds none (eta = 0), so only the music differs. `batch`
    songs are danced to at once. Without a `generator` the seed is 0.
    Raises ValueError as `silence_hit` and `Dancer.dance` do.   Notebook: 12
    """
    generator = generator or torch.Generator().manual_seed(0)
    start = torch.randn(1, frames, dancer.config.D, generator=generator)
    quieter = [silence_hit(audio, float(time), width) for time in times]
    mels = log_mel(np.stack([audio, *quieter]), SAMPLE_RATE)
    dances = [
        dancer.dance_mel(mel, frames, start=start.expand(len(mel), -1, -1), steps=steps, eta=0.0)
        for mel in mels.split(batch)
    ]
    whole = torch.cat(dances).double().cpu().numpy()
    return Occlusion(np.asarray(times, np.float64), whole[0], whole[1:])
