"""A set of dances against their songs: the beat score, and numbers that show what it means.

These are the score with other songs' beats, the level of chance, kinematic beats per music beat (a
figure that stops all the time meets many beats), and the speed (a figure that hardly moves stops
anywhere).   Notebook: 14
"""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from ..motion.root_frame import FPS
from .beats import SIGMA, NoBeatsWarning, beat_alignment, chance_level, kinematic_beats, mean_speed
from .skating import mean_where


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
