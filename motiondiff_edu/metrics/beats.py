"""Does the dance keep time?

Moments at which the body slows down, compared with the beats of the music.

A kinematic beat is a local minimum of the mean joint speed: a stop between two moves. Times are in
seconds throughout. A score without its chance level says nothing: the published ones, .23 to .25,
are what random stops get. The papers' own forms, with their faults: `published_beats.py`.  Source:
MoFusion eq. 10.   Notebook: 14
"""

import warnings

import numpy as np
from jaxtyping import Float
from scipy.ndimage import gaussian_filter1d
from scipy.signal import find_peaks
from scipy.special import erf

from ..motion.resample import DANCE_FPS, resample
from ..motion.root_frame import FPS

SMOOTHING = 0.083  # s, of the speed: at 60 frames/s the papers' 5 frames
SIGMA = 0.05  # s, of the score: at 60 frames/s the papers' 3 frames
DUST = 1e-4  # m/s: a dip less deep than this is rounding


class NoBeatsWarning(UserWarning):
    """A dance never slows down, so that its beats cannot be scored; the score is NaN."""


def mean_speed(
    positions: Float[np.ndarray, "*B T J 3"], fps: float | int = FPS
) -> Float[np.ndarray, "*B T-1"]:
    """Mean over the joints of |p[t+1] - p[t]| fps, in m/s.

    Entry t belongs to the time (t + 1/2) / fps.

    Raises ValueError for fewer than two frames.  Source: MoFusion 4.1.  Notebook: 14
    """
    if positions.shape[-3] < 2:
        raise ValueError("a speed takes two frames, and this motion has one")
    return (
        np.linalg.norm(np.diff(np.asarray(positions, np.float64), axis=-3), axis=-1).mean(-1) * fps
    )


def smooth_speed(
    positions: Float[np.ndarray, "*B T J 3"],
    fps: float | int = FPS,
    smoothing: float | int = SMOOTHING,
) -> Float[np.ndarray, "*B T-1"]:
    """`mean_speed`, smoothed along time by a Gaussian of `smoothing` seconds."""
    return gaussian_filter1d(mean_speed(positions, fps), smoothing * fps, axis=-1)


def kinematic_beats(
    positions: Float[np.ndarray, "T J 3"],
    fps: float | int = FPS,
    smoothing: float | int = SMOOTHING,
) -> Float[np.ndarray, "K"]:
    """Times in seconds at which the smoothed mean joint speed has a local minimum.

    Motion of fewer frames is brought to 60 a second first; the speed between frames t and t+1
    stands at t + 1/2; each minimum is refined by the parabola through it and its neighbours. So 20
    and 60 frames/s find the same beats, within milliseconds. The smoothing moves a stop between
    unequal moves by some 30 ms, towards the slower one. A figure that never slows down has none.
    Raises ValueError for NaN.  Source: MoFusion 4.1.   Notebook: 14
    """
    if fps < DANCE_FPS:
        positions, fps = resample(positions, fps), DANCE_FPS
    speed = smooth_speed(positions, fps, smoothing)
    if not np.isfinite(speed).all():
        raise ValueError(
            "positions hold NaN or infinity: fill or cut them before looking for beats"
        )
    low = find_peaks(-speed, prominence=DUST)[0]
    before = speed[low - 1]
    here = speed[low]
    after = speed[low + 1]
    bend = before - 2 * here + after
    shift = np.divide(before - after, 2 * bend, out=np.zeros_like(bend), where=bend > 0)
    return (low + 0.5 + np.clip(shift, -0.5, 0.5)) / fps


def beat_alignment(
    kinematic: Float[np.ndarray, "K"], music: Float[np.ndarray, "M"], sigma: float | int = SIGMA
) -> float:
    """How near to a music beat the dance slows down, 0 to 1.

    Mean over *kinematic* beats b of exp(-d(b)^2 / 2 sigma^2).

    d(b) = min_m |b - m|, m the music beats. The kinematic form: of AIST++'s authors, and of
    MoFusion's sentence. Exchange the arguments for the music form of MoFusion's formula and of
    Bailando (`music_alignment`). No kinematic beat gives NaN and a NoBeatsWarning.
    Raises ValueError for music without a beat, or sigma not positive.  Source: MoFusion eq. 10.
    Notebook: 14
    """
    if sigma <= 0:
        raise ValueError(f"sigma is a time in seconds above 0, got {sigma}")
    _some_music(music)
    if len(kinematic) == 0:
        warnings.warn("this dance never slows down: no score", NoBeatsWarning, stacklevel=2)
        return float("nan")
    nearest = np.abs(np.asarray(kinematic)[:, None] - np.asarray(music)[None, :]).min(1)
    return float(np.exp(-(nearest**2) / (2 * sigma**2)).mean())


def music_alignment(
    kinematic: Float[np.ndarray, "K"], music: Float[np.ndarray, "M"], sigma: float | int = SIGMA
) -> float:
    """The music form: mean over *music* beats m of exp(-min_b |b - m|^2 / 2 sigma^2).

    It rewards whoever stops often.

    No kinematic beat gives 0: no music beat was met. Raises ValueError for music without a beat.
    Source: MoFusion eq. 10.  Notebook: 14
    """
    _some_music(music)
    return beat_alignment(music, kinematic, sigma) if len(kinematic) else 0.0


def chance_level(
    music: Float[np.ndarray, "M"], seconds: float | int, sigma: float | int = SIGMA
) -> float:
    """What stops at random times within [0, seconds] score on average in the kinematic form; exact.

    (1 / seconds) * integral of exp(-min_m |t - m|^2 / 2 sigma^2) dt, by erf from beat to the middle
    between beats. For a steady beat of period P: sigma sqrt(2 pi) / P, less the tails. Faster
    music, better score.
    Raises ValueError for music without a beat, or no time.  Notebook: 14
    """
    _some_music(music)
    if seconds <= 0:
        raise ValueError(f"chance is counted over a time above 0, got {seconds} s")
    music = np.sort(np.asarray(music, np.float64))
    middle = (music[1:] + music[:-1]) / 2
    edges = np.clip(np.concatenate([[0.0], middle, [float(seconds)]]), 0.0, float(seconds))
    after, before = (erf((edge - music) / (np.sqrt(2) * sigma)) for edge in (edges[1:], edges[:-1]))
    return float(sigma * np.sqrt(np.pi / 2) * (after - before).sum() / seconds)


def shifted_level(
    score,
    kinematic: Float[np.ndarray, "K"],
    music: Float[np.ndarray, "M"],
    seconds: float | int,
    rng: np.random.Generator,
    times: int = 200,
) -> float:
    """The chance level of any score.

    Its mean when the dance begins at a random time, going round at `seconds`.

    `score` is `beat_alignment`, `music_alignment` ... The dance keeps its rhythm and loses its
    place in the music.
    Notebook: 14
    """
    shifts = rng.uniform(0, seconds, times)
    return float(
        np.mean([score(np.sort((np.asarray(kinematic) + s) % seconds), music) for s in shifts])
    )


def f_measure(
    found: Float[np.ndarray, "K"], true: Float[np.ndarray, "M"], window: float | int = 0.07
) -> float:
    """Beats found against true ones, 0 to 1.

    F = 2 hits / (K + M), a hit being a pair at most `window` seconds apart.

    Each beat is used once. 0 when one side is empty. Times must be in order.  Notebook: 11
    """
    hits = i = j = 0
    while i < len(found) and j < len(true):
        if abs(found[i] - true[j]) <= window:
            hits = hits + 1
            i = i + 1
            j = j + 1
        elif found[i] < true[j]:
            i += 1
        else:
            j += 1
    return 2 * hits / (len(found) + len(true)) if hits else 0.0


def _some_music(music: Float[np.ndarray, "M"]) -> None:
    if len(music) == 0:
        raise ValueError(
            "this music has no beat to be compared with: "
            "was it silent, or cut before its first beat?"
        )
