"""The alternative to raw Mel: MFCC by librosa and the beats, the input of earlier dancers.

Here the beats are the song's true ones, which are better than any tracker's.  Source: MoFusion 3.3
names the alternative
"""

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
import torch
from jaxtyping import Float

from data_synth.music.song import Song
from motiondiff_edu.conditions.music import (
    BANDS,
    F_MAX,
    F_MIN,
    FRAMES_PER_SECOND,
    HOP,
    N_FFT,
    SAMPLE_RATE,
)
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.performers.dance_windows import DanceWindows

from .songs import Hear

COEFFICIENTS = 20  # as in AI Choreographer
CHANNELS = COEFFICIENTS + 2


def mfcc_and_beats(song: Song) -> Float[torch.Tensor, "M 22"]:
    """20 MFCC at the times of the Mel frames, then two channels that mark beats and downbeats."""
    import librosa  # slow to import

    framing = {"n_fft": N_FFT, "hop_length": HOP, "n_mels": BANDS, "fmin": F_MIN, "fmax": F_MAX}
    framing |= {"sr": SAMPLE_RATE, "n_mfcc": COEFFICIENTS, "pad_mode": "constant"}
    spectrum = librosa.feature.mfcc(y=song.audio.astype(np.float32), **framing).T
    beat_channels = [marks(times, len(spectrum)) for times in (song.beats, song.downbeats)]
    return torch.from_numpy(np.column_stack([spectrum, *beat_channels])).float()


def marks(times: Float[np.ndarray, "K"], frames: int) -> Float[np.ndarray, "{frames}"]:
    """A 1 for each time (seconds).

    It is divided between the two frames around it, so that its time is not rounded.
    """
    where = times * FRAMES_PER_SECOND
    first = np.floor(where).astype(int)
    row = np.zeros(frames + 1)
    inside = (first >= 0) & (first < frames)
    np.add.at(row, first[inside], 1 - (where - first)[inside])
    np.add.at(row, first[inside] + 1, (where - first)[inside])
    return row[:frames]


def with_music_features(windows: DanceWindows, hear: Hear, songs: Iterable[Song]) -> DanceWindows:
    """The same windows of the same dances, with other features of their music.

    `songs` are those of the windows, in their order.

    Raises ValueError unless there are as many frames as in the Mel spectrograms.
    """
    features = torch.cat([hear(song) for song in songs])
    if len(features) != len(windows.mel):
        raise ValueError(
            f"{len(features)} frames of features do not fit windows of {len(windows.mel)}"
        )
    scaler = Scaler.fit(features)
    return replace(windows, mel=scaler.transform(features), mel_scaler=scaler)
