"""What a dancer is tried on.

Songs no dancer was trained on, their true beats, and the data's own dances to them.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Float

from data_synth.dancing import dance
from data_synth.music import songs
from data_synth.music.song import Song
from motiondiff_edu.conditions.music import log_mel
from motiondiff_edu.performers.dancer import Dancer

from ..walks.scores import FPS
from ..walks.trials import UNSEEN

LONGEST = 400  # frames
MARGIN = 0.25  # s: beats just outside of a clip are kept, a stop may be near them

Hear = Callable[[Song], Float[torch.Tensor, "M C"]]  # what a network is given of a song


def mel_of(song: Song) -> Float[torch.Tensor, "M 80"]:
    """The log-Mel spectrogram: all that the dancers hear."""
    return log_mel(torch.from_numpy(song.audio).float())


@dataclass(frozen=True, eq=False)
class Songs:
    """N songs: log-Mel (or what is heard instead), and `draws` dances of the data to each."""

    songs: list[Song]
    mel: Float[torch.Tensor, "N M C"]
    truth: Float[np.ndarray, "N K T 21 3"]

    def beats(self, frames: int) -> list[Float[np.ndarray, "_"]]:
        """The true beats of every song within so many frames, and just outside."""
        end = (frames - 1) / FPS
        return [
            song.beats[(song.beats > -MARGIN) & (song.beats < end + MARGIN)] for song in self.songs
        ]


def unseen_songs(
    n: int = 50,
    draws: int = 1,
    frames: int = LONGEST,
    seed: int = UNSEEN,
    hear: Hear = mel_of,
    *,
    tempo: float | None = None,
    metre: int | None = None,
    timbre: str | None = None,
) -> Songs:
    """n songs long enough for `frames`, with `draws` dances of the data to each.

    Tempo, metre and timbre are the composer's own choice where they are None.
    """
    made = list(songs(n, seed, frames / FPS + 1.0, tempo=tempo, metre=metre, timbre=timbre))
    mel = torch.stack([hear(song) for song in made])
    truth = [
        [dance(song, seed + 1000 * k + i).positions[:frames] for k in range(draws)]
        for i, song in enumerate(made)
    ]
    return Songs(made, mel, np.stack([np.stack(row) for row in truth]))


def dances_of(
    dancer: Dancer, mel: Float[torch.Tensor, "N M C"], frames: int, seed: int, batch: int = 25
) -> Float[np.ndarray, "N T 21 3"]:
    """One dance to each song; metres."""
    draw = torch.Generator().manual_seed(seed)
    parts = [dancer.dance_mel(part, frames, generator=draw) for part in mel.split(batch)]
    return torch.cat(parts).double().numpy()
