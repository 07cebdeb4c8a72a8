"""The songs on which dancers are judged, in one place, with the data's own dances to them.

Songs like real ones: varied ones at the tempi of training, as a recording sounds. Their seeds are
in no training set. A song can begin with silence, pause, and end with silence; it has no beats
there.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import islice

import numpy as np
import torch
from jaxtyping import Float

from data_synth.dancing import dances_to
from data_synth.dancing.performance import DANCES_A_SEED
from data_synth.music import SONGS_A_SEED
from data_synth.music.recorded import recorded_song
from data_synth.music.song import Song
from data_synth.music.varied import VARIED, Variety, varied_songs
from motiondiff_edu.conditions.music import log_mel
from motiondiff_edu.performers.dancer import Dancer

from ..walks.scores import FPS
from ..walks.trials import UNSEEN

LONGEST = 400  # frames that a dancer is asked for, at most
SECONDS = LONGEST / FPS + 1.0  # of every song
TRAINED = 100  # frames of a dance in training
MARGIN = 0.25  # s: beats just outside of a clip are kept, a stop may be near them
# in the first TRAINED frames: a song that is silent for longer has too few beats to be judged by,
# and the slowest one, of 60 BPM, has five
FEWEST = 4
JUDGED = VARIED  # as those of training

Hear = Callable[[Song], Float[torch.Tensor, "M C"]]  # what a network is given of a song


def mel_of(song: Song) -> Float[torch.Tensor, "M 80"]:
    """The log-Mel spectrogram: all that the dancers hear."""
    return log_mel(torch.from_numpy(song.audio).float(), song.sample_rate)


@dataclass(frozen=True, eq=False)
class Songs:
    """N songs: log-Mel (or what is heard instead), and `draws` dances of the data to each."""

    songs: list[Song]
    mel: Float[torch.Tensor, "N M C"]
    truth: Float[np.ndarray, "N K T 21 3"]

    @property
    def genres(self) -> np.ndarray:
        """The genre of every song."""
        return np.array([song.genre for song in self.songs])

    def beats(self, frames: int) -> list[Float[np.ndarray, "_"]]:
        """The true beats of every song within so many frames, and just outside."""
        end = (frames - 1) / FPS
        return [
            song.beats[(song.beats > -MARGIN) & (song.beats < end + MARGIN)] for song in self.songs
        ]


def judged_songs(
    n: int = 50,
    draws: int = 1,
    frames: int = LONGEST,
    seed: int = UNSEEN,
    hear: Hear = mel_of,
    variety: Variety = JUDGED,
) -> Songs:
    """n songs that no dancer was trained on, with `draws` dances of the data to each."""
    return danced_by_the_data(songs_like_real(n, seed, variety), draws, frames, seed, hear)


def songs_like_real(n: int, seed: int, variety: Variety = JUDGED) -> list[Song]:
    """The first n varied songs of this seed that soon have beats, with the sound of recordings."""
    return list(islice(_with_beats(varied_songs(SONGS_A_SEED, seed, SECONDS, variety), seed), n))


def _with_beats(songs: Iterator[Song], seed: int) -> Iterator[Song]:
    for song in songs:
        if (song.beats < TRAINED / FPS).sum() >= FEWEST:
            yield recorded_song(song, seed)


def danced_by_the_data(
    songs: Sequence[Song], draws: int, frames: int, seed: int, hear: Hear = mel_of
) -> Songs:
    """The songs with `draws` dances of the data to each, of so many frames."""
    truth = dances_by_the_data(songs, draws, frames, seed)
    return Songs(list(songs), torch.stack([hear(song) for song in songs]), truth)


def dances_by_the_data(
    songs: Sequence[Song], draws: int, frames: int, seed: int
) -> Float[np.ndarray, "N K T 21 3"]:
    """`draws` dances of the data to each of the songs, of so many frames."""
    danced = dances_to(songs, seed * DANCES_A_SEED, draws)
    positions = np.stack([dance.positions[:frames] for _, dance in danced])
    return positions.reshape(len(songs), draws, *positions.shape[1:])


def dances_of(
    dancer: Dancer, mel: Float[torch.Tensor, "N M C"], frames: int, seed: int, batch: int = 25
) -> Float[np.ndarray, "N T 21 3"]:
    """One dance to each song; metres."""
    draw = torch.Generator().manual_seed(seed)
    parts = [dancer.dance_mel(part, frames, generator=draw) for part in mel.split(batch)]
    return torch.cat(parts).double().numpy()
