"""Lossy coding like MP3's: the spectrum of short blocks is rounded coarsely.

The blocks overlap by half (a modified discrete cosine transform, MDCT): without rounding the sound
comes back exactly. There is no delay. `as_mp3` is a real encoder, several times slower.
"""

import io

import numpy as np
import scipy
from jaxtyping import Float

from .song import SAMPLE_RATE

LINES = 576  # frequencies in a block, as in MP3
BANDS = 22  # scale factor bands: each has its own step of rounding

WINDOW = np.sin(np.pi * (np.arange(2 * LINES) + 0.5) / (2 * LINES))


def mdct(audio: Float[np.ndarray, "N"]) -> Float[np.ndarray, "blocks lines"]:
    """The spectra of overlapping blocks; the mean power of the sound is kept."""
    blocks = -(-len(audio) // LINES) + 1
    padded = np.pad(audio, (LINES, (blocks + 1) * LINES - LINES - len(audio)))
    pieces = padded.reshape(blocks + 1, LINES)
    pieces = np.concatenate([pieces[:-1], pieces[1:]], 1) * WINDOW
    a, b, c, d = np.split(pieces, 4, axis=1)
    folded = np.concatenate([-c[:, ::-1] - d, a - b[:, ::-1]], 1)
    return scipy.fft.dct(folded, type=4, norm="ortho", axis=1)


def inverse_mdct(spectrum: Float[np.ndarray, "blocks lines"], n: int) -> Float[np.ndarray, "n"]:
    """The n samples whose `mdct` is this spectrum."""
    folded = scipy.fft.dct(spectrum, type=4, norm="ortho", axis=1)
    first, second = np.split(folded, 2, axis=1)
    pieces = np.concatenate([second, -second[:, ::-1], -first[:, ::-1], -first], 1) * WINDOW
    sound = np.zeros((len(spectrum) + 1, LINES))
    sound[:-1] += pieces[:, :LINES]
    sound[1:] += pieces[:, LINES:]
    return sound.ravel()[LINES : LINES + n]


def coded(
    audio: Float[np.ndarray, "N"], coarseness: float, highest: float
) -> Float[np.ndarray, "N"]:
    """The sound after lossy coding.

    coarseness  step of the rounding, as a fraction of the root mean square of the band in its
                block: at 0.1 nothing is heard, at 1 music bubbles, at 2 most lines are gone
    highest     Hz, above which the coder drops everything
    """
    spectrum = mdct(audio)
    edges = np.unique(np.round(np.geomspace(4, LINES, BANDS)).astype(int))
    starts = np.concatenate([[0], edges[:-1]])
    sizes = np.diff(np.append(starts, LINES))
    power = np.add.reduceat(spectrum**2, starts, axis=1) / sizes
    step = np.repeat(coarseness * np.sqrt(power) + 1e-12, sizes, axis=1)
    rounded = step * np.round(spectrum / step)
    rounded[:, round(highest / SAMPLE_RATE * 2 * LINES) :] = 0.0
    return inverse_mdct(rounded, len(audio))


def as_mp3(audio: Float[np.ndarray, "N"], compression: float = 0.5) -> Float[np.ndarray, "N"]:
    """The sound after a real MP3 encoder and decoder (soundfile's), which costs seconds.

    compression  0 (about 20 kbit/s at this rate) to 0.9 (13 kbit/s)
    """
    import soundfile

    file = io.BytesIO()
    soundfile.write(
        file,
        audio,
        SAMPLE_RATE,
        format="MP3",
        subtype="MPEG_LAYER_III",
        compression_level=compression,
    )
    file.seek(0)
    decoded, _ = soundfile.read(file)
    return np.pad(decoded, (0, max(0, len(audio) - len(decoded))))[: len(audio)]
