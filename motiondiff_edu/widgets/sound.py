"""Sound for the player: one channel as long as the motion, as a small file that browsers play.

The default is Opus in Ogg (10-40 KB for 10 s), or WAV (320 KB) if soundfile cannot write Opus.
`codec="flac"` (exact, about 200 KB) and "wav" also play in older Safaris. MP3 and Vorbis are not
used: in Chromium a jump misses its time by up to 70 ms (MP3) or 30 ms (Vorbis), and libsndfile cuts
off short Vorbis files.
Notebook: 12
"""

import io
import math
import os
import warnings
import wave
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int8

from ..viz.over_time import lows_and_highs

CODECS = {"ogg": ("OGG", "OPUS"), "flac": ("FLAC", "PCM_16"), "wav": ("WAV", "PCM_16")}
OPUS_RATES = (8_000, 12_000, 16_000, 24_000, 48_000)
RATES = (8_000, 96_000)  # Hz: the range that all browsers play
# samples written at once: libsndfile's Ogg encoders have overflowed their stack on long ones
BLOCK = 8192


@dataclass(frozen=True, eq=False)
class Sound:
    """A sound as samples, and as the bytes of a file with MIME type `mime`."""

    samples: Float[np.ndarray, "N"]
    sample_rate: int
    data: bytes
    mime: str

    @property
    def seconds(self) -> float:
        """Length of the sound."""
        return len(self.samples) / self.sample_rate


def as_sound(
    audio: object,
    sample_rate: int | float | None = None,
    seconds: float | None = None,
    codec: str = "ogg",
) -> Sound:
    """A Sound, cut or padded to `seconds`.

    `audio` is samples (N,) between -1 and 1 with their `sample_rate` in Hz, or the bytes of a WAV,
    FLAC, Ogg or MP3 file. Louder samples are scaled down together; channels of a file are averaged.
    A warning reports when more than 0.05 s are cut or added.
    Raises ValueError for samples without their rate, another shape, integers, samples that are not
    finite, unreadable bytes, and the name of a file.
    """
    if codec not in CODECS:
        raise ValueError(f"codec must be one of {', '.join(CODECS)}, not {codec!r}")
    if isinstance(audio, bytes | bytearray | memoryview):
        audio, sample_rate = _decoded(bytes(audio))
    if isinstance(audio, str | os.PathLike) or hasattr(audio, "read"):
        raise ValueError(
            "audio is the name of a file, or an open file: pass its bytes, Path(name).read_bytes()"
        )
    if sample_rate is None:
        raise ValueError(
            "the samples need their rate, in Hz: pass Soundtrack(audio, sample_rate=...)"
        )
    samples = _checked(audio, sample_rate)
    sample_rate = int(sample_rate)  # 16000.0 is a rate as well, but not to libsndfile
    samples = _fitted(samples, sample_rate, seconds)
    return Sound(samples, sample_rate, *encode(samples, sample_rate, codec))


def encode(
    samples: Float[np.ndarray, "N"], sample_rate: int, codec: str = "ogg"
) -> tuple[bytes, str]:
    """The bytes of a sound file and their MIME type; WAV if soundfile cannot write the codec."""
    try:
        import soundfile

        file = io.BytesIO()
        form, subtype = CODECS[codec]
        content, rate = samples, sample_rate
        if subtype == "OPUS" and rate not in OPUS_RATES:
            content, rate = _resampled(samples, rate)
        with soundfile.SoundFile(file, "w", rate, 1, subtype, format=form) as out:
            for start in range(0, len(content), BLOCK):
                out.write(content[start : start + BLOCK])
        return file.getvalue(), f"audio/{codec}"
    except (
        ImportError,
        OSError,
        RuntimeError,
        ValueError,
    ):  # no soundfile, or one without this codec
        return _wav(samples, sample_rate), "audio/wav"


def waveform(samples: Float[np.ndarray, "N"], bins: int = 1000) -> Int8[np.ndarray, "_ 2"]:
    """The waveform: lowest and highest sample of each of (at most) `bins` equal pieces.

    The largest absolute sample becomes 127.
    """
    both = np.stack(lows_and_highs(samples, bins)[1:], 1)
    return np.rint(both / max(np.abs(both).max(), 1e-9) * 127).astype(np.int8)


def as_times(times: object, name: str, seconds: float) -> list[float]:
    """Increasing times in seconds, without those beyond the end.

    Raises ValueError for anything but increasing times.
    """
    values = np.asarray([] if times is None else times, dtype=np.float64)
    if (
        values.ndim != 1
        or not np.isfinite(values).all()
        or (np.diff(values) <= 0).any()
        or (values < 0).any()
    ):
        raise ValueError(
            f"`{name}` must be increasing times in seconds from the start, one number each: "
            f"got {times!r:.80}"
        )
    return values[values < seconds].round(4).tolist()


def _checked(audio: object, sample_rate: int | float) -> Float[np.ndarray, "N"]:
    if not RATES[0] <= sample_rate <= RATES[1] or int(sample_rate) != sample_rate:
        raise ValueError(
            f"sample_rate must be a whole number from {RATES[0]} to {RATES[1]} Hz, not "
            f"{sample_rate}"
        )
    samples = np.asarray(audio)
    if samples.ndim != 1:
        raise ValueError(
            f"audio has shape {samples.shape}; "
            "pass one channel (N,), for example the mean of several"
        )
    if not len(samples):
        raise ValueError("audio has no samples")
    if not np.issubdtype(samples.dtype, np.floating):
        raise ValueError(
            f"audio is {samples.dtype}; pass floats from -1 to 1 (16-bit samples divided by 32768)"
        )
    bad = ~np.isfinite(samples)
    if bad.any():
        at = int(np.argmax(bad))
        raise ValueError(
            f"audio is not finite at sample {at} ({at / sample_rate:.2f} s); "
            f"{int(bad.sum())} samples in all"
        )
    return (samples / max(1.0, float(np.abs(samples).max()))).astype(np.float32)


def _fitted(samples: np.ndarray, sample_rate: int, seconds: float | None) -> np.ndarray:
    if seconds is None:
        return samples
    wanted, given = round(seconds * sample_rate), len(samples)
    if abs(given - wanted) > 0.05 * sample_rate:
        lengths = f"the sound lasts {given / sample_rate:.2f} s, the motion {seconds:.2f} s: "
        left = (wanted - given) / sample_rate
        warnings.warn(
            lengths + (f"the last {left:.2f} s are silent" if left > 0 else "the rest is cut off"),
            stacklevel=5,
        )
    return np.pad(samples, (0, max(0, wanted - given)))[:wanted]


def _decoded(data: bytes) -> tuple[np.ndarray, int]:
    import soundfile

    try:
        samples, sample_rate = soundfile.read(io.BytesIO(data), dtype="float32", always_2d=True)
    except (OSError, RuntimeError) as error:
        raise ValueError(
            f"these {len(data)} bytes are not a WAV, FLAC, Ogg or MP3 file: {error}"
        ) from error
    return samples.mean(1), sample_rate


def _resampled(samples: np.ndarray, sample_rate: int) -> tuple[np.ndarray, int]:
    """Resample to the next rate that Opus supports."""
    from scipy.signal import resample_poly

    rate = next((r for r in OPUS_RATES if r >= sample_rate), OPUS_RATES[-1])
    common = math.gcd(rate, sample_rate)
    return resample_poly(samples, rate // common, sample_rate // common).astype(np.float32), rate


def _wav(samples: np.ndarray, sample_rate: int) -> bytes:
    file = io.BytesIO()
    with wave.open(file, "wb") as out:
        out.setnchannels(1)
        out.setsampwidth(2)
        out.setframerate(sample_rate)
        out.writeframes(np.rint(np.clip(samples, -1, 1) * 32767).astype("<i2").tobytes())
    return file.getvalue()
