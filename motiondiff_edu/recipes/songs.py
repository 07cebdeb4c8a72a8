"""The songs that dancers are trained on, and what their scores say of each Mel frame."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Float, Int
from torch import Tensor

from ..beyond.hearing import counts
from ..conditions.music import frame_times, log_mel
from ..motion.scaler import Scaler
from ..performers.ear import GENRES


def training_songs(n: int, seed: int, seconds: float) -> Iterator:
    """Songs like real ones, with the sound of recordings (`data_synth.music`)."""
    from data_synth.music.recorded import recorded_song  # here: data_synth imports this package
    from data_synth.music.varied import varied_songs

    return (recorded_song(song, 0) for song in varied_songs(n, seed, seconds))


@dataclass(frozen=True, eq=False)
class HeardSongs:
    """Songs of one length for an ear: standardised Mel frames, and what their scores say."""

    mel: Float[Tensor, "N M C"]
    counts: Float[Tensor, "N M 2"]  # `beyond.hearing.counts`
    tempi: Float[Tensor, "N"]  # BPM
    genres: Int[Tensor, "N"]  # in the order of `performers.ear.GENRES`
    scaler: Scaler  # of the Mel frames

    @classmethod
    def of(cls, songs: Iterator) -> "HeardSongs":
        """The songs with their own scaler, which is that of dances to them."""
        mels = []
        told = []
        facts = []
        for song in songs:
            mels.append(log_mel(torch.from_numpy(song.audio).float()))
            times = frame_times(len(mels[-1])).numpy()
            told.append(counts(times, song.beats, song.bar_position, song.metre))
            facts.append((song.tempo, GENRES.index(song.genre)))
        return cls.told(mels, told, facts)

    @classmethod
    def told(
        cls,
        mels: list[Float[Tensor, "M C"]],
        told: list[Float[np.ndarray, "M 2"]],
        facts: list[tuple[float, int]],
    ) -> "HeardSongs":
        """The songs of these Mel frames, counts, tempi and genres."""
        mel = torch.stack(mels)
        scaler = Scaler.fit(mel)
        tempi, genres = zip(*facts, strict=True)
        every = torch.from_numpy(np.stack(told)).float()
        return cls(scaler.transform(mel), every, torch.tensor(tempi), torch.tensor(genres), scaler)

    def __len__(self) -> int:
        return len(self.mel)
