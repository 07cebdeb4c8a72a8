"""The network's input from music: a log-Mel spectrogram, the times of its frames, and beats.

A Mel frame comes every 32 ms and a motion frame every 50 ms, so the two are matched by seconds,
never by index.
Notebook: 11
"""

from functools import lru_cache
from typing import Any

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor
from torch.nn import functional as F

# MoFusion 3.3
SAMPLE_RATE = 16_000
HOP = 512
BANDS = 80
F_MIN = 0.0
F_MAX = 8000.0
# 64 ms; the paper leaves it open. With 512 = HOP the windows would give little weight to sounds
# between two frames; 2048 would blur a beat more
N_FFT = 1024
FRAMES_AT_ONCE = 256  # so few spectra fit into the processor's cache, which is 2 x faster
FLOOR = 1e-5  # smallest power in the log, about 80 dB under a full-scale sine; the paper has none
FRAMES_PER_SECOND = SAMPLE_RATE / HOP  # 31.25

TRACKER_HOP = 256  # samples: beats to 16 ms
# the tracker's beats are late by 12-19 ms for drum hits, 22-30 ms in composed songs (tests)
TRACKER_LAG = 0.02

Samples = Float[Tensor, "*B N"] | Float[np.ndarray, "*B N"]


def hz_to_mel(hz: Float[Tensor, "*n"]) -> Float[Tensor, "*n"]:
    """Pitch on Slaney's Mel scale: linear up to 1000 Hz, then logarithmic.

    mel = 3 f / 200 below 1000 Hz; 15 + 27 log(f / 1000) / log(6.4) above.  Notebook: 11
    """
    return torch.where(
        hz < 1000, 3 * hz / 200, 15 + 27 * (hz.clamp(min=1000) / 1000).log() / np.log(6.4)
    )


def mel_to_hz(mel: Float[Tensor, "*n"]) -> Float[Tensor, "*n"]:
    """The frequency of a Mel value: the inverse of `hz_to_mel`.

    Notebook: 11
    """
    return torch.where(mel < 15, 200 * mel / 3, 1000 * ((mel - 15) * (np.log(6.4) / 27)).exp())


def fingerprint(mel: Float[Tensor, "M C"]) -> list[int]:
    """The mean of each band in tenths: whole numbers that differ from song to song.

    They hardly depend on how a file was decoded, as a hash of the samples would.
    """
    return (10 * mel.mean(0)).round().abs().long().tolist()


def mel_filters(
    sample_rate: int = SAMPLE_RATE,
    n_fft: int = N_FFT,
    bands: int = BANDS,
    f_min: float | int = F_MIN,
    f_max: float | int = F_MAX,
) -> Float[Tensor, "bands bins"]:
    """Triangular filters over the n_fft/2 + 1 frequencies of a spectrum, evenly spaced in Mel.

    Band b rises from edge b to edge b+1 and falls to edge b+2. Its height is
    2 / (edge[b+2] - edge[b]), so its area is 1 in Hz.
    Raises ValueError unless 0 <= f_min < f_max <= sample_rate/2, or if a band has no frequency.
    Source: MoFusion 3.3.  Notebook: 11
    """
    if not 0 <= f_min < f_max <= sample_rate / 2:
        raise ValueError(
            f"f_min and f_max must ascend within 0 and {sample_rate / 2:g} Hz; "
            f"got {f_min:g} to {f_max:g}"
        )
    ends = hz_to_mel(torch.tensor([f_min, f_max], dtype=torch.float64))
    edges = mel_to_hz(
        torch.linspace(float(ends[0]), float(ends[1]), bands + 2, dtype=torch.float64)
    )[:, None]
    hz = torch.linspace(0, sample_rate / 2, n_fft // 2 + 1, dtype=torch.float64)
    low = edges[:-2]
    middle = edges[1:-1]
    high = edges[2:]
    triangles = torch.minimum((hz - low) / (middle - low), (high - hz) / (high - middle)).clamp(
        min=0
    )
    if not (triangles > 0).any(1).all():
        raise ValueError(
            f"{bands} bands are too many for n_fft = {n_fft}: some lie between two frequencies"
        )
    return triangles * 2 / (high - low)


@lru_cache
@torch.inference_mode(
    False
)  # otherwise a first call in inference mode would cache tensors that gradients cannot pass
def _tools(device: torch.device, dtype: torch.dtype) -> tuple[Tensor, Tensor]:
    """The window and the filters (bins, bands), computed once for each device and precision."""
    window = torch.hann_window(N_FFT, dtype=torch.float64).to(device, dtype)
    return window, mel_filters().T.contiguous().to(device, dtype)


def log_mel(audio: Samples, sample_rate: int) -> Float[Tensor, "*B M 80"]:
    """The log-Mel spectrogram of sound at 16 kHz, the rate of the paper: M = 1 + N // 512 frames.

    Frame m is centred on sample 512 m.

    log(max(FLOOR, filters @ |STFT|^2)), with the natural logarithm, a Hann window of 1024 samples,
    and zeros beyond both ends. A full-scale sine gives 5 (high pitch) to 8 (low pitch), digital
    silence log(1e-5) = -11.5.
    Raises ValueError for another rate, no samples, or whole numbers.
    Source: MoFusion 3.3.  Notebook: 11
    """
    check_sample_rate(sample_rate)
    audio = torch.as_tensor(audio)
    if not audio.is_floating_point() or not audio.shape[-1]:
        raise ValueError(
            f"sound must be float samples from -1 to 1, not {tuple(audio.shape)} of {audio.dtype}"
        )
    window, filters = _tools(audio.device, audio.dtype)
    flat = F.pad(audio.reshape(-1, audio.shape[-1]), (N_FFT // 2, N_FFT // 2))
    M, bands = 1 + audio.shape[-1] // HOP, []
    for first in range(0, M, FRAMES_AT_ONCE):
        last = min(first + FRAMES_AT_ONCE, M) - 1
        piece = flat[:, first * HOP : last * HOP + N_FFT]
        spectrum = torch.stft(
            piece, N_FFT, HOP, window=window, center=False, return_complex=True
        ).mT
        bands.append((spectrum.real.square() + spectrum.imag.square()) @ filters)
    return torch.cat(bands, dim=1).clamp(min=FLOOR).log().reshape(*audio.shape[:-1], M, BANDS)


def check_sample_rate(sample_rate: int) -> None:
    """Raise ValueError unless samples are at 16 kHz, with what to do."""
    if sample_rate != SAMPLE_RATE:
        raise ValueError(
            f"the sound is at {sample_rate!r:.40} Hz, and this needs {SAMPLE_RATE} Hz: "
            "conditions.audio_files.samples_of(sound, sample_rate) resamples it"
        )


def frame_times(M: int) -> Float[Tensor, "M"]:
    """The centres of M Mel frames in seconds; there are 31.25 frames per second.

    Notebook: 11
    """
    return torch.arange(M, dtype=torch.float64, device="cpu") / FRAMES_PER_SECOND


def beats_of(
    audio: Float[Tensor, "N"] | Float[np.ndarray, "N"], sample_rate: int, lag: float = TRACKER_LAG
) -> Float[np.ndarray, "K"]:
    """The beats of a recording at 16 kHz, in seconds, by librosa's tracker with its `lag` removed.

    The tracker assumes a steady tempo. It can follow every second beat, or half beats; in silence
    it finds none. A beat is the time at which something starts to sound.
    Raises ValueError for another rate.
    Source: Ellis 2007, by librosa.  Notebook: 11
    """
    check_sample_rate(sample_rate)
    # slow to import, and needed only for recordings: a composed song has its beats
    from .compiled import librosa

    framing: dict[str, Any] = {"sr": SAMPLE_RATE, "hop_length": TRACKER_HOP}
    onsets = librosa.onset.onset_strength(y=np.asarray(audio), n_fft=N_FFT, **framing)
    _, beats = librosa.beat.beat_track(onset_envelope=onsets, units="time", **framing)
    return np.maximum(np.asarray(beats, dtype=np.float64) - lag, 0)
