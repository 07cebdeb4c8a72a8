"""Sound files to mono samples at 16 kHz.

It reads wav, flac, ogg, mp3, aiff and every other format of libsndfile, at any sample rate. The
content decides the format, not the name. An AudioError says what is wrong with a file and what to
do.
Notebook: 11
"""

import re
import warnings
from contextlib import suppress
from io import BytesIO
from pathlib import Path
from shlex import quote
from tempfile import TemporaryDirectory
from typing import BinaryIO

import numpy as np
import soxr
import torch
from jaxtyping import Float
from torch import Tensor

from .._files import home
from ..motion.arguments import is_number
from .mp3_frames import frame_at, promised, with_length
from .music import SAMPLE_RATE

RATES = (1_000, 768_000)  # Hz: a sample rate in kHz is outside
SHORTEST = 1.0  # seconds
MOST = 3600.0  # seconds that are read; a damaged header may promise years
MOST_ADDED = 2 * 1152  # samples by which an MP3 may be longer than it says
PADDING = 0.1  # seconds at the end of an MP3 that its encoder added and the reader leaves out
# a file whose largest sample is below this, 80 dB under full scale, counts as silent
SILENT = 1e-4
LOUDEST = 10.0  # samples reach 1, or a little more; larger values have another unit
BLOCK = 4096  # samples read at a time from a file that cannot be read in one piece

# first bytes of formats that ffmpeg reads and libsndfile does not: (position, bytes): name
VIDEO_AND_PHONES = {
    (4, b"ftyp"): "an MP4 file (m4a, mp4, mov)",
    (0, b"\x1a\x45\xdf\xa3"): "a Matroska file (mkv, webm)",
    (0, b"\x30\x26\xb2\x75"): "a Windows Media file (wma)",
    (0, b"\xff\xf1"): "an AAC stream",
    (0, b"\xff\xf9"): "an AAC stream",
}
# in libsndfile's log: how many bytes the header claims, and how many the file has
PROMISED = re.compile(r"(?:data|SSND|Data Size)\s*: (\d+) \(should be (\d+)\)")


class AudioError(ValueError):
    """The sound cannot be used; the message names the file, the fault, and what to do."""


def read_audio(path: str | Path) -> Float[Tensor, "N"]:
    """A sound file as mono float32 samples at 16 kHz, without its constant offset.

    Channels are averaged. If the file is cut off, the readable part is returned with a UserWarning.
    Raises AudioError for a missing file, a folder, another kind of file, a file that is damaged,
    empty, silent or shorter than a second, and for samples that are not finite or lie far outside
    -1 to 1.
    Source: MoFusion 3.3.   Notebook: 11
    """
    path = home(path)
    if not path.is_file():
        what = (
            "is a folder; give the name of a sound file in it"
            if path.is_dir()
            else "does not exist; check the spelling"
        )
        raise AudioError(f"{path} {what}")
    channels, rate, loss = _decode(path)
    seconds = len(channels) / rate
    if seconds < SHORTEST:
        length = f"has only {seconds:.2f} s of sound" if len(channels) else "has no sound at all"
        length += f" and {loss}" if loss else ""
        raise AudioError(f"{path.name} {length}; at least {SHORTEST:g} s are needed")
    bad = np.flatnonzero(~np.isfinite(channels).all(1))
    if len(bad):
        raise AudioError(
            f"{path.name}: {len(bad)} samples are NaN or infinite, the first at "
            f"{bad[0] / rate:.3f} s; the program that wrote it probably divided by zero: "
            "export the sound again"
        )
    mono = _mono(channels, path.name)
    if loud := _too_loud(mono, rate):
        raise AudioError(
            f"{path.name}: {loud}. Export the sound again, from -1 to 1 or as 16-bit samples"
        )
    if loss:
        warnings.warn(
            f"{path.name} {loss}; the {seconds:.2f} s that could be read are used", stacklevel=2
        )
    return torch.from_numpy(resample(mono, rate).astype(np.float32))


def samples_of(
    sound: str | Path | bytes | bytearray | memoryview | BinaryIO | np.ndarray | Tensor,
    sample_rate: float | None = None,
) -> Float[Tensor, "N"]:
    """Sound as mono float32 samples at 16 kHz, without a file's constant offset.

    `sound` is the name of a sound file, its bytes (from an upload, for example), a file that is
    open for reading bytes, or mono samples (N,) from -1 to 1 with their `sample_rate` in Hz.
    Raises AudioError as `read_audio` does, for samples without their rate and a file with one, and
    for samples that have another shape, are whole numbers, are not finite, are silent, or lie far
    outside -1 to 1.  Notebook: 12
    """
    if isinstance(sound, Tensor):
        sound = sound.detach().cpu().numpy()
    if isinstance(sound, (np.ndarray, list)):
        return _checked_samples(np.asarray(sound), sample_rate)
    if sample_rate is not None:
        raise AudioError("a sound file has its own sample rate: leave sample_rate out")
    if isinstance(sound, (str, Path)):
        return read_audio(sound)
    content = sound.read() if hasattr(sound, "read") else sound
    if isinstance(content, str):
        raise AudioError('the file is open for reading text; open it with open(path, "rb")')
    if not isinstance(content, (bytes, bytearray, memoryview)):
        raise AudioError(
            "sound must be the name of a file, its bytes, or samples with their sample_rate, not "
            f"{type(sound).__name__}"
        )
    with TemporaryDirectory() as folder:
        path = Path(folder) / "the given file"
        path.write_bytes(content)
        return read_audio(path)


def _checked_samples(samples: np.ndarray, sample_rate: float | None) -> Float[Tensor, "N"]:
    """Samples at 16 kHz, of samples at another rate.  Raises AudioError as `samples_of` does."""
    if sample_rate is None:
        raise AudioError(
            "samples do not say how fast they are played: pass sample_rate, in Hz. "
            "librosa.load returns it beside the samples"
        )
    if not is_number(sample_rate) or not RATES[0] <= sample_rate <= RATES[1]:
        raise AudioError(
            f"sample_rate must be from {RATES[0]} to {RATES[1]} Hz, not {sample_rate!r:.40}"
        )
    if samples.ndim != 1 or not len(samples):
        raise AudioError(
            f"sound must be one channel of samples (N,), not {samples.shape}; average the "
            "channels first"
        )
    if not np.issubdtype(samples.dtype, np.floating):
        raise AudioError(
            f"sound must be floating-point samples from -1 to 1, not {samples.dtype}; divide "
            "16-bit samples by 32768"
        )
    bad = np.flatnonzero(~np.isfinite(samples))
    if len(bad):
        raise AudioError(
            f"{len(bad)} samples are NaN or infinite, the first at {bad[0] / sample_rate:.3f} s"
        )
    if np.abs(samples).max() < SILENT:
        raise AudioError(
            "the samples are silent from start to end, so there is nothing to dance to"
        )
    if loud := _too_loud(samples, sample_rate):
        raise AudioError(f"{loud}. Divide the sound by its largest absolute sample")
    return torch.from_numpy(resample(samples.astype(np.float32), sample_rate))


def _too_loud(samples: Float[np.ndarray, "N"], rate: float) -> str:
    """What says that samples have another unit, or "" for those that have not."""
    where = int(np.abs(samples).argmax())
    if abs(samples[where]) <= LOUDEST:
        return ""
    return (
        f"samples must lie between -1 and 1; the one at {where / rate:.3f} s is "
        f"{samples[where]:.3g}"
    )


def resample(audio: Float[np.ndarray, "N"], rate: float) -> Float[np.ndarray, "n"]:
    """The same sound at 16 kHz, resampled by soxr at very high quality, without aliasing."""
    return audio if rate == SAMPLE_RATE else soxr.resample(audio, rate, SAMPLE_RATE, "VHQ")


def _decode(path: Path) -> tuple[Float[np.ndarray, "N channels"], int, str]:
    """All channels, the rate, and a message about lost sound (empty for a complete file)."""
    import soundfile

    try:
        if (counted := _decode_counted(path)) is not None:
            return counted
        with soundfile.SoundFile(path) as file:
            if file.frames > MOST * file.samplerate:
                channels = _in_blocks(path)
                complete = len(channels) >= MOST * file.samplerate
                loss = "is longer than an hour" if complete else _lost(file, len(channels))
                return channels, file.samplerate, loss
            try:
                channels = file.read(dtype="float32", always_2d=True)
            except soundfile.LibsndfileError:
                return _in_blocks(path), file.samplerate, "is damaged: the rest cannot be read"
            except (ValueError, RuntimeError):  # an encoding in which it cannot seek
                return _in_order(path), file.samplerate, ""
            if not len(channels) and (whole := finished_wav(path.read_bytes())):
                with soundfile.SoundFile(BytesIO(whole)) as mended:
                    channels = mended.read(dtype="float32", always_2d=True)
                return channels, mended.samplerate, ""
            return channels, file.samplerate, _lost(file, len(channels))
    except soundfile.LibsndfileError as error:
        raise AudioError(f"{path.name} {_other_kind(path, error)}") from None


def _decode_counted(path: Path) -> tuple[Float[np.ndarray, "N channels"], int, str] | None:
    """The same for an MP3 whose first frame says nothing of its length, or what is not so.

    None for other files.
    """
    import soundfile

    with path.open("rb") as file:
        head = file.read(10)
    if not (head[:3] == b"ID3" or frame_at(head + bytes(4), 0)):
        return None
    raw = path.read_bytes()
    whole, samples = with_length(raw)
    said = promised(raw)
    if not whole or abs(said - samples) <= MOST_ADDED:
        return None
    with soundfile.SoundFile(BytesIO(whole)) as file:
        rate, most = file.samplerate, round(MOST * file.samplerate)
        channels = file.read(min(samples, most), dtype="float32", always_2d=True)
    if samples > most:
        return channels, rate, "is longer than an hour"
    if said > samples:
        return channels, rate, f"is cut off: its header promises {said / rate:.2f} s"
    return channels, rate, ""


def _in_blocks(path: Path) -> Float[np.ndarray, "N channels"]:
    """The samples before a damage, or of the first hour, read block by block.

    Complete files are not read this way, because seeking in an MP3 is not exact.
    """
    import soundfile

    with soundfile.SoundFile(path) as file:
        blocks = [np.zeros((0, file.channels), np.float32)]
        left = round(MOST * file.samplerate)
        with suppress(soundfile.LibsndfileError):
            while len(block := file.read(min(BLOCK, left), dtype="float32", always_2d=True)):
                blocks.append(block)
                left -= len(block)
    return np.concatenate(blocks)


def _in_order(path: Path) -> Float[np.ndarray, "N channels"]:
    """The samples of a file in which one cannot seek, from the first to the last."""
    import soundfile

    with soundfile.SoundFile(path) as file:
        blocks = [np.zeros((0, file.channels), np.float32)]
        left = round(MOST * file.samplerate)
        while left > 0:
            block = np.empty((min(BLOCK, left), file.channels), np.float32)
            count = file.buffer_read_into(block, "float32")
            if not count:
                break
            blocks.append(block[:count])
            left -= count
    return np.concatenate(blocks)


def finished_wav(raw: bytes) -> bytes:
    """A WAV whose header was never finished, with the lengths that it has; b"" for another file.

    A program that is stopped while it records leaves a length of 0 for the sound that follows.
    """
    at = raw.find(b"data", 12)
    there = len(raw) - at - 8
    if raw[:4] != b"RIFF" or at < 0 or there < 1 or any(raw[at + 4 : at + 8]):
        return b""
    size = (len(raw) - 8).to_bytes(4, "little")
    return raw[:4] + size + raw[8 : at + 4] + there.to_bytes(4, "little") + raw[at + 8 :]


def _lost(file, there: int) -> str:
    """What a file's header promises but the file lacks; only libsndfile's log shows it."""
    promised, log = file.frames, file.extra_info
    if found := PROMISED.search(log):
        claimed, actual = int(found[1]), max(int(found[2]), 1)
        promised = (
            there * claimed // actual if claimed < 2**31 - 1 else there
        )  # otherwise the header was written before the length was known
    if "reports a hole" in log:
        return (
            f"is damaged: {(promised - there) / file.samplerate:.2f} s are missing from its middle"
        )
    slack = PADDING * file.samplerate if file.format == "MP3" else 0
    if promised > there + slack:
        return f"is cut off: its header promises {promised / file.samplerate:.2f} s"
    if "lacks an end-of-stream" in log:
        return "is cut off: its last page is missing"
    return ""


def _mono(channels: Float[np.ndarray, "N channels"], name: str) -> Float[np.ndarray, "N"]:
    """The mean of the channels without its offset; if they cancel, the loudest channel."""
    channels = channels - channels.mean(0, dtype=np.float64).astype(np.float32)
    mono, peaks = channels.mean(1), np.abs(channels).max(0)
    if np.abs(mono).max() < SILENT:
        mono = channels[:, peaks.argmax()]
    if peaks.max() < SILENT:
        raise AudioError(f"{name} is silent from start to end, so there is nothing to dance to")
    return mono


def _other_kind(path: Path, error: Exception) -> str:
    """The kind of a file that libsndfile cannot read, and what to do with it."""
    with path.open("rb") as file:
        head = file.read(64)
    for (where, mark), kind in VIDEO_AND_PHONES.items():
        if head[where : where + len(mark)] == mark:
            return (
                f"is {kind}, which needs ffmpeg. Convert it first: "
                f"ffmpeg -i {quote(str(path))} {quote(str(path.with_suffix('.wav')))}"
            )
    if not head:
        return "is an empty file (0 bytes): copy or download it again"
    if head.lstrip().startswith(b"HIERARCHY"):
        return "is a motion (BVH), not sound; md.read_motion(path) reads it"
    if head.isascii() and b"\0" not in head:
        return (
            f"is text, not sound; it begins with {head[:20].decode()!r}. "
            "Was a web page downloaded instead of the sound?"
        )
    reason = getattr(error, "error_string", str(error)).rstrip(".")
    # libsndfile says this of an mp3 file in which it finds no sound
    why = "" if "does not exist" in reason else f" ({reason})"
    return f"cannot be read as a sound file{why}. Save it again as wav, flac, ogg or mp3"
