"""Does a dance keep time? The moments at which the body slows down, against the music's beats.

A kinematic beat is a local minimum of the mean joint speed: a stop between two moves. All times are
in seconds. A score means nothing without its chance level: at 110 to 120 BPM random stops get .23
to .25, like the best published scores. So `beat_scores` of a set of dances has beside the score
that with other songs' beats, the level of chance, kinematic beats per music beat (a figure that
stops all the time meets many beats), and the speed (a figure that hardly moves stops anywhere).

`aist_...` and `bailando_...` are the scores of the published tables as their code computes them,
with its faults. Use them only to compare with published scores. Both count in frames and assume 60
frames/s: at 20 frames/s the same code, with its sigma of 3 frames, gives a chance level of .68 and
not .25. Resample first (motion.resample).

                      AIST++'s authors                      Bailando; the formula of MoFusion eq. 10
averaged over         kinematic beats                       music beats, which rewards many stops
speed                 unsmoothed, so jitter makes stops     smoothed by 5 frames
minima                lowest within 10 frames either side   any local minimum
time of a minimum     half a frame late                     half a frame early
no kinematic beat     0                                     an error
Source: MoFusion eq. 10.   Notebook: 14
"""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy
from jaxtyping import Bool, Float, Int, Real

from ..motion.resample import DANCE_FPS, resample
from ..motion.root_frame import FPS
from .walks import mean_where

# ---- beats ---------------------------------------------------------------------------------------
SMOOTHING = 0.083  # s, for the speed: the papers' 5 frames at 60 frames/s
SIGMA = 0.05  # s, for the score: the papers' 3 frames at 60 frames/s
MIN_DEPTH = 1e-4  # m/s: a shallower minimum is rounding


class NoBeatsWarning(UserWarning):
    """A dance never slows down, so it has no beats to score; the score is NaN."""


def mean_speed(
    positions: Float[np.ndarray, "*B T J 3"], fps: float | int = FPS
) -> Float[np.ndarray, "*B T-1"]:
    """Mean over the joints of |p[t+1] - p[t]| fps, in m/s.

    Entry t belongs to the time (t + 1/2) / fps.

    Raises ValueError for fewer than two frames.  Source: MoFusion 4.1.  Notebook: 14
    """
    if positions.shape[-3] < 2:
        raise ValueError("a speed needs two frames, and this motion has one")
    return (
        np.linalg.norm(np.diff(np.asarray(positions, np.float64), axis=-3), axis=-1).mean(-1) * fps
    )


def smooth_speed(
    positions: Float[np.ndarray, "*B T J 3"],
    fps: float | int = FPS,
    smoothing: float | int = SMOOTHING,
) -> Float[np.ndarray, "*B T-1"]:
    """`mean_speed`, smoothed along time by a Gaussian of `smoothing` seconds."""
    return scipy.ndimage.gaussian_filter1d(mean_speed(positions, fps), smoothing * fps, axis=-1)


def kinematic_beats(
    positions: Float[np.ndarray, "T J 3"],
    fps: float | int = FPS,
    smoothing: float | int = SMOOTHING,
) -> Float[np.ndarray, "K"]:
    """Times in seconds at which the smoothed mean joint speed has a local minimum.

    Motion at a lower rate is first resampled to 60 frames/s. The speed between frames t and t+1
    belongs to t + 1/2. Each minimum is refined by the parabola through it and its neighbours. So 20
    and 60 frames/s give the same beats within milliseconds. The smoothing moves a stop between
    unequal moves by about 30 ms, towards the slower one. A figure that never slows down has no
    beats.
    Raises ValueError for NaN.  Source: MoFusion 4.1.   Notebook: 14
    """
    if fps < DANCE_FPS:
        positions, fps = resample(positions, fps), DANCE_FPS
    speed = smooth_speed(positions, fps, smoothing)
    if not np.isfinite(speed).all():
        raise ValueError(
            "positions contain NaN or infinity: fill or cut them before you look for beats"
        )
    low = scipy.signal.find_peaks(-speed, prominence=MIN_DEPTH)[0]
    before = speed[low - 1]
    here = speed[low]
    after = speed[low + 1]
    bend = before - 2 * here + after
    shift = np.divide(before - after, 2 * bend, out=np.zeros_like(bend), where=bend > 0)
    return (low + 0.5 + np.clip(shift, -0.5, 0.5)) / fps


def beat_alignment(
    kinematic: Float[np.ndarray, "K"], music: Float[np.ndarray, "M"], sigma: float | int = SIGMA
) -> float:
    """How close to a music beat the dance slows down, 0 to 1.

    Mean over *kinematic* beats b of exp(-d(b)^2 / 2 sigma^2).

    d(b) = min_m |b - m| over the music beats m. AIST++'s authors use this kinematic form, and so
    does MoFusion's text. MoFusion's formula and Bailando use the music form (`music_alignment`),
    which exchanges the arguments. Without kinematic beats the score is NaN, with a NoBeatsWarning.
    Raises ValueError for music without a beat, or sigma not positive.  Source: MoFusion eq. 10.
    Notebook: 14
    """
    if sigma <= 0:
        raise ValueError(f"sigma must be a time in seconds above 0, not {sigma}")
    _check_music(music)
    if len(kinematic) == 0:
        warnings.warn(
            "this dance never slows down, so its score is NaN", NoBeatsWarning, stacklevel=2
        )
        return float("nan")
    nearest = np.abs(np.asarray(kinematic)[:, None] - np.asarray(music)[None, :]).min(1)
    return float(np.exp(-(nearest**2) / (2 * sigma**2)).mean())


def music_alignment(
    kinematic: Float[np.ndarray, "K"], music: Float[np.ndarray, "M"], sigma: float | int = SIGMA
) -> float:
    """The music form: mean over *music* beats m of exp(-min_b |b - m|^2 / 2 sigma^2).

    It rewards a figure that stops often.

    Without kinematic beats the score is 0. Raises ValueError for music without a beat.
    Source: MoFusion eq. 10.  Notebook: 14
    """
    _check_music(music)
    return beat_alignment(music, kinematic, sigma) if len(kinematic) else 0.0


def chance_level(
    music: Float[np.ndarray, "M"], seconds: float | int, sigma: float | int = SIGMA
) -> float:
    """The exact mean score, in the kinematic form, of stops at random times within [0, seconds].

    (1 / seconds) * integral of exp(-min_m |t - m|^2 / 2 sigma^2) dt, by erf between each beat and
    the middle to the next. For a steady beat of period P it is sigma sqrt(2 pi) / P, less the
    tails: faster music gives a better score.
    Raises ValueError for music without a beat, or seconds not positive.  Notebook: 14
    """
    _check_music(music)
    if seconds <= 0:
        raise ValueError(f"the length must be above 0 s, not {seconds}")
    music = np.sort(np.asarray(music, np.float64))
    middle = (music[1:] + music[:-1]) / 2
    edges = np.clip(np.concatenate([[0.0], middle, [float(seconds)]]), 0.0, float(seconds))
    after, before = (
        scipy.special.erf((edge - music) / (np.sqrt(2) * sigma)) for edge in (edges[1:], edges[:-1])
    )
    return float(sigma * np.sqrt(np.pi / 2) * (after - before).sum() / seconds)


def shifted_level(
    score,
    kinematic: Float[np.ndarray, "K"],
    music: Float[np.ndarray, "M"],
    seconds: float | int,
    rng: np.random.Generator,
    times: int = 200,
) -> float:
    """The chance level of any score: its mean after random shifts of the dance in time.

    `score` is `beat_alignment`, `music_alignment` or another function. The shift is circular with
    period `seconds`: the dance keeps its rhythm and loses its place in the music.
    Notebook: 14
    """
    shifts = rng.uniform(0, seconds, times)
    return float(
        np.mean([score(np.sort((np.asarray(kinematic) + s) % seconds), music) for s in shifts])
    )


def f_measure(
    found: Float[np.ndarray, "K"], true: Float[np.ndarray, "M"], window: float | int = 0.07
) -> float:
    """F-measure of found beats against true ones, 0 to 1.

    F = 2 hits / (K + M); a hit is a pair at most `window` seconds apart.

    Each beat is used once. F is 0 when one side is empty. Times must be sorted.  Notebook: 11
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


def _check_music(music: Float[np.ndarray, "M"]) -> None:
    if len(music) == 0:
        raise ValueError(
            "this music has no beat to compare with: is it silent, or cut before its first beat?"
        )


# ---- sets of dances ------------------------------------------------------------------------------
@dataclass(frozen=True, eq=False)
class BeatScores:
    """One value per clip (`..._clips`, for intervals), and their means over clips as properties.

    bas             beat alignment, in the kinematic form
    bas_shuffled    its mean with the beats of each other song (songs with the same beats are one)
    bas_chance      the same for stops at random times
    beats_per_beat  kinematic beats per music beat
    speed           mean joint speed in m/s
    A clip without kinematic beats has NaN in bas and bas_shuffled; their means leave it out.
    """

    bas_clips: Float[np.ndarray, "B"]
    bas_shuffled_clips: Float[np.ndarray, "B"]
    bas_chance_clips: Float[np.ndarray, "B"]
    beats_per_beat_clips: Float[np.ndarray, "B"]
    speed_clips: Float[np.ndarray, "B"]

    @property
    def bas(self) -> float:
        return float(mean_where(self.bas_clips))

    @property
    def bas_shuffled(self) -> float:
        return float(mean_where(self.bas_shuffled_clips))

    @property
    def bas_chance(self) -> float:
        return float(self.bas_chance_clips.mean())

    @property
    def beats_per_beat(self) -> float:
        return float(self.beats_per_beat_clips.mean())

    @property
    def speed(self) -> float:
        return float(self.speed_clips.mean())


def beat_scores(
    positions: Float[np.ndarray, "B T J 3"],
    music: Sequence[Float[np.ndarray, "_"]],
    fps: float | int = FPS,
    sigma: float | int = SIGMA,
) -> BeatScores:
    """Score B dances, each against the beats of its song.

    `music` are times in seconds from the clip's first frame. Beats before the first and after the
    last frame can be included, because a stop can be near them; only beats within the clip count as
    music beats. One NoBeatsWarning says how many clips never slow down. For a single clip
    `bas_shuffled` is NaN.
    Raises ValueError unless there is one list of beats for each dance, each with a beat within the
    clip.
    Source: MoFusion eq. 10, Table 1.  Notebook: 14
    """
    seconds = (positions.shape[1] - 1) / fps
    within = [int(((beats >= 0) & (beats <= seconds)).sum()) for beats in music]
    if len(music) != len(positions):
        raise ValueError(
            f"{len(positions)} dances and the beats of {len(music)} songs: "
            "each dance needs its song"
        )
    if 0 in within:
        raise ValueError(
            f"song {within.index(0)} has no beat in the {seconds:g} s of its dance; "
            "are its times seconds?"
        )
    found = [kinematic_beats(dance, fps) for dance in positions]
    every = _every_pair(found, music, sigma)
    return BeatScores(
        bas_clips=np.diagonal(every).copy(),
        bas_shuffled_clips=np.asarray(mean_where(np.where(_same_song(music), np.nan, every))),
        bas_chance_clips=np.array([chance_level(beats, seconds, sigma) for beats in music]),
        beats_per_beat_clips=np.array([len(k) / m for k, m in zip(found, within, strict=True)]),
        speed_clips=mean_speed(positions, fps).mean(-1),
    )


def _same_song(music: Sequence[np.ndarray]) -> Bool[np.ndarray, "B B"]:
    """Entry (i, j) says whether songs i and j have the same beats."""
    return np.array([[np.array_equal(one, other) for other in music] for one in music])


def _every_pair(
    found: Sequence[np.ndarray], music: Sequence[np.ndarray], sigma: float | int
) -> np.ndarray:
    """Entry (i, j) is the score of dance i with song j."""
    still = sum(len(beats) == 0 for beats in found)
    if still:
        warnings.warn(
            f"{still} of {len(found)} dances never slow down: no score",
            NoBeatsWarning,
            stacklevel=3,
        )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", NoBeatsWarning)
        return np.array(
            [[beat_alignment(kinematic, beats, sigma) for beats in music] for kinematic in found]
        )


# ---- the scores of the published tables ----------------------------------------------------------
SIGMA_FRAMES = 3.0


def aist_beats(positions: Float[np.ndarray, "T J 3"]) -> Int[np.ndarray, "K"]:
    """Kinematic beats as AIST++'s authors find them: frame numbers at 60 frames/s.

    A beat is a minimum of the unsmoothed sum of joint speeds. A 0 is put before the speeds, so
    entry t is the step from t-1 to t.  Source: MoFusion 4.1.  Notebook: 14
    """
    speed = np.concatenate(
        [[0.0], mean_speed(positions, 1)]
    )  # a mean has its minima where the sum has them
    return scipy.signal.argrelextrema(speed, np.less, order=10)[0]


def aist_score(
    kinematic: Real[np.ndarray, "K"],
    music: Real[np.ndarray, "M"],
    sigma: float | int = SIGMA_FRAMES,
) -> float:
    """Mean over kinematic beats (frames at 60 frames/s) of exp(-min_m |b - m|^2 / 2 sigma^2).

    It is 0 without kinematic beats. Raises ValueError for music without a beat.
    Source: MoFusion 4.1.  Notebook: 14
    """
    return _mean_over(kinematic, music, sigma) if len(kinematic) else 0.0


def bailando_beats(positions: Float[np.ndarray, "T J 3"]) -> Int[np.ndarray, "K"]:
    """Kinematic beats as Bailando finds them: frame numbers at 60 frames/s.

    A beat is a minimum of the mean joint speed, smoothed by 5 frames. Entry t is the step from t to
    t+1.  Source: MoFusion 4.1.  Notebook: 14
    """
    return scipy.signal.argrelextrema(
        scipy.ndimage.gaussian_filter1d(mean_speed(positions, 1), 5), np.less
    )[0]


def bailando_score(
    kinematic: Real[np.ndarray, "K"],
    music: Real[np.ndarray, "M"],
    sigma: float | int = SIGMA_FRAMES,
) -> float:
    """Mean over music beats (frames at 60 frames/s) of exp(-min_b |b - m|^2 / 2 sigma^2).

    Raises ValueError where either side has no beat, as Bailando's code does.
    Source: MoFusion eq. 10.  Notebook: 14
    """
    return _mean_over(music, kinematic, sigma)


def _mean_over(
    these: Real[np.ndarray, "K"], others: Real[np.ndarray, "M"], sigma: float | int
) -> float:
    if len(these) == 0 or len(others) == 0:
        raise ValueError(
            "one side has no beats, and this form of the score is then undefined; "
            "metrics.dances has one that is defined"
        )
    nearest = np.abs(these[:, None] - others[None, :]).min(1)
    return float(np.exp(-(nearest**2) / (2 * sigma**2)).mean())
