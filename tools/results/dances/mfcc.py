"""The rival of raw Mel: what earlier dancers were given, MFCC by librosa and the beats themselves.

Here the beats are the song's true ones, which no tracker could beat.  Source: MoFusion 3.3 names
the rival
"""

from dataclasses import replace

import numpy as np
import torch
from jaxtyping import Float

from data_synth.music import songs
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

from .trials import Hear

COEFFICIENTS = 20  # as AI Choreographer has them
CHANNELS = COEFFICIENTS + 2


def mfcc_and_beats(song: Song) -> Float[torch.Tensor, "M 22"]:
    """20 MFCC at the times of the Mel frames, then two channels that mark beats and downbeats."""
    import librosa  # slow to import

    framing = {"n_fft": N_FFT, "hop_length": HOP, "n_mels": BANDS, "fmin": F_MIN, "fmax": F_MAX}
    framing |= {"sr": SAMPLE_RATE, "n_mfcc": COEFFICIENTS, "pad_mode": "constant"}
    spectrum = librosa.feature.mfcc(y=song.audio.astype(np.float32), **framing).T
    told = [marks(times, len(spectrum)) for times in (song.beats, song.downbeats)]
    return torch.from_numpy(np.column_stack([spectrum, *told])).float()


def marks(times: Float[np.ndarray, "K"], frames: int) -> Float[np.ndarray, "{frames}"]:
    """A 1 for each time (seconds).

    It is shared by the two frames around it, so that its place is not rounded.
    """
    where = times * FRAMES_PER_SECOND
    first = np.floor(where).astype(int)
    row = np.zeros(frames + 1)
    inside = (first >= 0) & (first < frames)
    np.add.at(row, first[inside], 1 - (where - first)[inside])
    np.add.at(row, first[inside] + 1, (where - first)[inside])
    return row[:frames]


def heard_instead(
    windows: DanceWindows, hear: Hear, count: int, seed: int, seconds: float
) -> DanceWindows:
    """The same windows of the same dances, with another sound beside them.

    `songs(count, seed, seconds)` gives it.

    Raises ValueError where it has not the frames of the Mel spectrograms.
    """
    heard = torch.cat([hear(song) for song in songs(count, seed, seconds)])
    if len(heard) != len(windows.mel):
        raise ValueError(
            f"{len(heard)} frames are heard, and the windows were cut for {len(windows.mel)}"
        )
    scaler = Scaler.fit(heard)
    return replace(windows, mel=scaler.transform(heard), mel_scaler=scaler)
