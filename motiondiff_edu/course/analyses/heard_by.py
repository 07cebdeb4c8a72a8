"""What a dancer's ear hears in a song: its beats, its bars, and its genre.

Notebook: 12
"""

from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor

from ...conditions.music import frame_times
from ...performers.dancer import Dancer
from ...performers.ear import GENRES, EarOutput

NEAREST = 0.2  # seconds between two beats, at least; 180 BPM have .33


@dataclass(frozen=True, eq=False)
class Heard:
    """What an ear says of a song, at its tokens, 15.6 a second.

    `beat` and `bar` are places from 0 to 1; `sounds` is the probability that there is a beat.
    """

    times: Float[np.ndarray, "M"]  # seconds
    beat: Float[np.ndarray, "M"]
    bar: Float[np.ndarray, "M"]
    sounds: Float[np.ndarray, "M"]
    genres: dict[str, float]  # probabilities, for the whole song

    @property
    def beats(self) -> Float[np.ndarray, "K"]:
        """The times of the beats (seconds), where the place in the beat comes round to 0."""
        return crossings(self.times, self.beat, self.sounds > 0.5)

    @property
    def downbeats(self) -> Float[np.ndarray, "K"]:
        """The times of the first beats of bars (seconds)."""
        return crossings(self.times, self.bar, self.sounds > 0.5)


@torch.inference_mode()
def heard_by(dancer: Dancer, mel: Float[Tensor, "M 80"]) -> Heard:
    """What this dancer's ear says of a log-Mel spectrogram (`conditions.music.log_mel`).

    Raises ValueError for a dancer without an ear.
    """
    ear = getattr(dancer.model, "ear", None)
    if ear is None:
        raise ValueError(f'{dancer!r} has no ear: md.load("dancer") has one')
    times = frame_times(len(mel)).float().to(dancer.device)
    tokens = ear(dancer.mel_scaler.transform(mel.to(dancer.device))[None], times)
    return as_heard(ear.read(tokens), times[:: ear.stride])


def as_heard(said: EarOutput, times: Float[Tensor, "M"]) -> Heard:
    """Places and probabilities of what an ear says of the only piece of a batch."""
    genre = said.genre[0].mean(0).softmax(-1).tolist()
    return Heard(
        times.double().cpu().numpy(),
        place_of(said.beat[0]),
        place_of(said.bar[0]),
        said.sounds[0].sigmoid().cpu().numpy(),
        dict(zip(GENRES, genre, strict=True)),
    )


def place_of(circle: Float[Tensor, "M 2"]) -> Float[np.ndarray, "M"]:
    """The place, from 0 to 1, of a cosine and a sine; their length does not matter."""
    cosine, sine = circle.double().cpu().numpy().T
    return np.arctan2(sine, cosine) / (2 * np.pi) % 1


def crossings(
    times: Float[np.ndarray, "M"], place: Float[np.ndarray, "M"], known: np.ndarray
) -> Float[np.ndarray, "K"]:
    """When the place comes round to 0, on straight lines between two moments that are known.

    A place that trembles around 0 passes it once.
    """
    ahead = (np.diff(place) + 0.5) % 1 - 0.5  # the shorter way round
    comes = (ahead > 0) & (place[:-1] + ahead >= 1) & known[:-1] & known[1:]
    starts = (place[:-1] == 0) & known[:-1] & ~np.append(False, known[:-2])
    share = np.where(comes, (1 - place[:-1]) / np.where(comes, ahead, 1), 0)
    at = (times[:-1] + share * np.diff(times))[comes | starts]
    kept = []
    for t in at:
        if not kept or t >= kept[-1] + NEAREST:
            kept.append(t)
    return np.array(kept)
