"""What the network hears.

The log-Mel spectrogram of a song, where its frames lie in time, and a tracker's beats.

A Mel frame comes every 32 ms and a motion frame every 50 ms: the two are matched by seconds, never
by index.
Notebook: 11
"""

from functools import lru_cache

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
# 64 ms; the paper leaves it open. 512 = HOP would be deaf between two frames, 2048 would blur a
# beat more
N_FFT = 1024
TOGETHER = (
    256  # frames at once: what lies between sound and bands then stays in the cache, 2 x faster
)
FLOOR = 1e-5  # power: the log's floor, about 80 dB under a full-scale sine; the paper names none
FRAMES_PER_SECOND = SAMPLE_RATE / HOP  # 31.25

TRACKER_HOP = 256  # samples: beats to 16 ms
# seconds its beats come too late: 12-19 ms for drum hits, 22-30 ms in composed songs (tests)
TRACKER_LAG = 0.02

Samples = Float[Tensor, "*B N"] | Float[np.ndarray, "*B N"]


def hz_to_mel(hz: Float[Tensor, "*n"]) -> Float[Tensor, "*n"]:
    """Pitch on Slaney's Mel scale: straight up to 1000 Hz, then a logarithm.

    mel = 3 f / 200 below 1000 Hz; 15 + 27 log(f / 1000) / log(6.4) above.  Notebook: 11
    """
    return torch.where(
        hz < 1000, 3 * hz / 200, 15 + 27 * (hz.clamp(min=1000) / 1000).log() / np.log(6.4)
    )


def mel_to_hz(mel: Float[Tensor, "*n"]) -> Float[Tensor, "*n"]:
    """The frequency of a Mel number: `hz_to_mel`, undone.

    Notebook: 11
    """
    return torch.where(mel < 15, 200 * mel / 3, 1000 * ((mel - 15) * (np.log(6.4) / 27)).exp())


def mel_filters(
    sample_rate: int = SAMPLE_RATE,
    n_fft: int = N_FFT,
    bands: int = BANDS,
    f_min: float | int = F_MIN,
    f_max: float | int = F_MAX,
) -> Float[Tensor, "bands bins"]:
    """Triangles over the frequencies of a spectrum, evenly spaced in Mel, each of area 1 in Hz.

    The spectrum has n_fft/2 + 1 frequencies.

    Band b rises from edge b to edge b+1 and falls to edge b+2, and is 2 / (edge[b+2] - edge[b])
    high.
    Raises ValueError for frequencies that do not ascend within 0 .. sample_rate/2, or a band too
    narrow for any bin.
    Source: MoFusion 3.3.  Notebook: 11
    """
    if not 0 <= f_min < f_max <= sample_rate / 2:
        raise ValueError(
            f"bands must lie within 0 and {sample_rate / 2:g} Hz, ascending; "
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
)  # else a first call within inference mode would leave tools that no gradient can pass
def _tools(device: torch.device, dtype: torch.dtype) -> tuple[Tensor, Tensor]:
    """The window and the filters (bins, bands), made once for each device and precision."""
    window = torch.hann_window(N_FFT, dtype=torch.float64).to(device, dtype)
    return window, mel_filters().T.contiguous().to(device, dtype)


def log_mel(audio: Samples) -> Float[Tensor, "*B M 80"]:
    """The log-Mel spectrogram of sound at 16 kHz, M = 1 + N // 512 frames.

    Frame m is centred on sample 512 m.

    log(max(FLOOR, filters @ |STFT|^2)), natural logarithm, Hann window of 1024 samples, zeros
    beyond both ends. A full-scale sine comes to 5 (high) or 8 (low), digital silence to log(1e-5) =
    -11.5.
    Raises ValueError for no samples, or whole numbers.
    Source: MoFusion 3.3.  Notebook: 11
    """
    audio = torch.as_tensor(audio)
    if not audio.is_floating_point() or not audio.shape[-1]:
        raise ValueError(
            f"sound is float samples between -1 and 1, not {tuple(audio.shape)} of {audio.dtype}"
        )
    window, filters = _tools(audio.device, audio.dtype)
    flat = F.pad(audio.reshape(-1, audio.shape[-1]), (N_FFT // 2, N_FFT // 2))
    M, bands = 1 + audio.shape[-1] // HOP, []
    for first in range(0, M, TOGETHER):
        last = min(first + TOGETHER, M) - 1
        piece = flat[:, first * HOP : last * HOP + N_FFT]
        spectrum = torch.stft(
            piece, N_FFT, HOP, window=window, center=False, return_complex=True
        ).mT
        bands.append((spectrum.real.square() + spectrum.imag.square()) @ filters)
    return torch.cat(bands, dim=1).clamp(min=FLOOR).log().reshape(*audio.shape[:-1], M, BANDS)


def frame_times(M: int) -> Float[Tensor, "M"]:
    """When each of M Mel frames sounds: the seconds of its centre, 31.25 a second.

    Notebook: 11
    """
    return torch.arange(M, dtype=torch.float64, device="cpu") / FRAMES_PER_SECOND


def crop_seconds(
    mel: Float[Tensor, "*B M bands"], start: float | int, seconds: float | int
) -> tuple[Float[Tensor, "*B n bands"], Float[Tensor, "n"]]:
    """The Mel frames within `seconds` from `start`, and their times counted from `start`.

    Always n = floor(31.25 seconds) of them, so that crops can be stacked; the first is at most 32
    ms after `start`.
    Raises ValueError where the span leaves the song.  Notebook: 11
    """
    first = int(np.ceil(start * FRAMES_PER_SECOND - 1e-6))
    n = int(np.floor(seconds * FRAMES_PER_SECOND + 1e-6))
    if first < 0 or n < 1 or first + n > mel.shape[-2]:
        lasts = (mel.shape[-2] - 1) / FRAMES_PER_SECOND
        raise ValueError(
            f"{seconds:g} s from {start:g} s are not within this song of {lasts:.2f} s; "
            "one frame is 32 ms"
        )
    return mel[..., first : first + n, :], frame_times(first + n)[first:] - start


def beats_of(
    audio: Float[Tensor, "N"] | Float[np.ndarray, "N"], lag: float = TRACKER_LAG
) -> Float[np.ndarray, "K"]:
    """The beats of a recording at 16 kHz, in seconds.

    As librosa's tracker hears them, with its `lag` taken out.

    The tracker takes steady tempo for granted and may follow every second or half beat; for silence
    it finds none. A beat is where something starts to sound. Source: Ellis 2007, by librosa.
    Notebook: 11
    """
    # slow to import, and needed for recordings only: a composed song knows its beats
    import librosa

    framing = {"sr": SAMPLE_RATE, "hop_length": TRACKER_HOP}
    onsets = librosa.onset.onset_strength(y=np.asarray(audio), n_fft=N_FFT, **framing)
    _, beats = librosa.beat.beat_track(onset_envelope=onsets, units="time", **framing)
    return np.maximum(np.asarray(beats, dtype=np.float64) - lag, 0)
