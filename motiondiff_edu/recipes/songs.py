"""The songs that dancers are trained on, and what their scores say of each Mel frame."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
import torch
from jaxtyping import Float, Int
from torch import Tensor

from ..beyond.hearing import beat_counts
from ..conditions.music import frame_times, log_mel
from ..motion.scaler import Scaler
from ..performers.ear import GENRES

if TYPE_CHECKING:  # data_synth imports this package
    from data_synth.music.song import Song

MelSong = tuple["Song", Tensor]  # a song without its sound, and its log-Mel (M, C)


def training_songs(n: int, seed: int, seconds: float) -> "Iterator[Song]":
    """Songs like real ones, with the sound of recordings (`data_synth.music`)."""
    from data_synth.music.recorded import recorded_song
    from data_synth.music.varied import varied_songs

    return (recorded_song(song, 0) for song in varied_songs(n, seed, seconds))


@lru_cache(maxsize=1)
def songs_as_mel(n: int, seed: int, seconds: float) -> list[MelSong]:
    """The same songs as log-Mel; the last ones are kept, because they take minutes.

    An ear and the dancers that have it learn from the same ones.
    """
    return [without_sound(song) for song in training_songs(n, seed, seconds)]


def without_sound(song: "Song") -> MelSong:
    """The score of a song, which keeps its length, and its log-Mel."""
    silence = np.broadcast_to(np.zeros(1, np.float32), song.audio.shape)  # it takes no memory
    return replace(song, audio=silence), log_mel(
        torch.from_numpy(song.audio).float(), song.sample_rate
    )


@dataclass(frozen=True, eq=False)
class HeardSongs:
    """Songs of one length for an ear: standardised Mel frames, and what their scores say."""

    mel: Float[Tensor, "N M C"]
    counts: Float[Tensor, "N M 2"]  # `beyond.hearing.beat_counts`
    tempi: Float[Tensor, "N"]  # BPM
    genres: Int[Tensor, "N"]  # in the order of `performers.ear.GENRES`
    scaler: Scaler  # of the Mel frames

    @classmethod
    def of(cls, songs: Sequence[MelSong]) -> "HeardSongs":
        """The songs of `songs_as_mel`, with their own scaler."""
        mel = torch.stack([one for _, one in songs])
        times = frame_times(mel.shape[1]).numpy()
        counts = [
            beat_counts(times, song.beats, song.bar_position, song.metre) for song, _ in songs
        ]
        scaler = Scaler.fit(mel)
        return cls(
            scaler.transform(mel),
            torch.from_numpy(np.stack(counts)).float(),
            torch.tensor([song.tempo for song, _ in songs]),
            torch.tensor([GENRES.index(song.genre) for song, _ in songs]),
            scaler,
        )

    def __len__(self) -> int:
        return len(self.mel)
