"""One sound removed from a song: the hit at one moment is silenced, everything else stays.

Notebook: 12
"""

import numpy as np
import scipy
from jaxtyping import Bool, Float

from .music import SAMPLE_RATE

WIDTH = 0.12  # s of sound that is changed
BESIDE = 0.08  # s on either side that give the levels before and after
EDGE = 0.02  # s of cross-fade
TINY = 1e-9  # a smaller magnitude is silence


def silence_hit(
    audio: Float[np.ndarray, "N"], time: float, width: float = WIDTH
) -> Float[np.ndarray, "N"]:
    """The song (16 kHz) without the sound that starts at `time` seconds.

    For `width` seconds, the level of each frequency is limited to a straight line in decibels, from
    its level before to its level after. So a sustained note continues, and the samples outside the
    span do not change.
    Raises ValueError for a time outside the song, or a width that is not positive.  Notebook: 12
    """
    if not 0 <= time < len(audio) / SAMPLE_RATE:
        raise ValueError(
            f"there is no sound at {time:g} s: this song has {len(audio) / SAMPLE_RATE:g} s"
        )
    if width <= 0:
        raise ValueError(f"width must be above 0 s, not {width:g}")
    shape = {"fs": SAMPLE_RATE, "nperseg": 512, "noverlap": 384}
    _, centres, spectrum = scipy.signal.stft(audio, **shape)
    away, loud = centres - time, np.abs(spectrum)

    def usual(span: Bool[np.ndarray, "F"]) -> Float[np.ndarray, "K"]:
        return (
            np.log(np.median(loud[:, span], axis=1) + TINY)
            if span.any()
            else np.full(len(loud), np.log(TINY))
        )

    before = usual((-BESIDE <= away) & (away < -EDGE))[:, None]
    after = usual((width <= away) & (away < width + BESIDE))[:, None]
    most = np.exp(before + np.clip(away / width, 0, 1) * (after - before))
    softer = spectrum * np.minimum(1.0, most / np.maximum(loud, TINY))
    quiet = scipy.signal.istft(softer, **shape)[1][: len(audio)]
    t = np.arange(len(audio)) / SAMPLE_RATE - time
    share = np.interp(t, [-EDGE, -EDGE / 2, width, width + EDGE], [0, 1, 1, 0])
    return (audio + share * (quiet - audio)).astype(audio.dtype)
