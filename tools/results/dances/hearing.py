"""What the shipped dancer's ear hears of songs that it never heard, beside librosa's tracker.

Nothing dances here. The songs are those on which the dancers are judged, and songs at tempi that
are kept out of training.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from data_synth.music.song import Song
from data_synth.music.tempi import HELD_OUT_TEMPI
from motiondiff_edu.conditions.music import beats_of
from motiondiff_edu.course.analyses.heard_by import Heard, heard_by
from motiondiff_edu.metrics.dances import f_measure
from motiondiff_edu.performers.dancer import Dancer

from ..walks.parts import weights_digest
from ..walks.scores import Measure, measure_of, ratio
from .parts import Stage
from .songs import JUDGED, UNSEEN, mel_of, songs_like_real

AT_KEPT_OUT_TEMPI = replace(JUDGED, tempi=HELD_OUT_TEMPI)


@dataclass(frozen=True, eq=False)
class Hearing:
    """For each song: F-measures of beats and downbeats, and whether the genre was heard."""

    beats: Float[np.ndarray, "N"]
    tracker: Float[np.ndarray, "N"]  # librosa's beats
    downbeats: Float[np.ndarray, "N"]
    genre: Float[np.ndarray, "N"]


def hearing_of(dancer: Dancer, songs: Sequence[Song]) -> Hearing:
    """What the ear and the tracker find of the songs' beats."""
    heard = [heard_by(dancer, mel_of(song)) for song in songs]
    pairs = list(zip(heard, songs, strict=True))
    return Hearing(
        np.array([f_measure(own.beats, song.beats) for own, song in pairs]),
        np.array([f_measure(beats_of(song.audio, song.sample_rate), song.beats) for song in songs]),
        np.array([f_measure(own.downbeats, song.downbeats) for own, song in pairs]),
        np.array([float(loudest(own) == song.genre) for own, song in pairs]),
    )


def loudest(heard: Heard) -> str:
    """The likeliest genre."""
    return max(heard.genres, key=heard.genres.get)


def hearing_measures(found: Hearing) -> list[Measure]:
    """Means over songs, with their intervals."""
    return [
        measure_of("beats_f", "", np.mean, found.beats),
        measure_of("tracker_f", "", np.mean, found.tracker),
        measure_of("beats_f_over_tracker", "", ratio, found.beats, found.tracker),
        measure_of("downbeats_f", "", np.mean, found.downbeats),
        measure_of("genre_accuracy", "share", np.mean, found.genre),
    ]


def hearing_records(stage: Stage, command: str) -> list[dict]:
    """The records `ear.*`, and `ear.kept_out.*` at tempi that are kept out of training."""
    dancer = stage.dancer("dancer")
    kept_out = songs_like_real(stage.size.songs, UNSEEN + 6, AT_KEPT_OUT_TEMPI)
    measures = hearing_measures(hearing_of(dancer, stage.songs.songs)) + [
        replace(one, name=f"kept_out.{one.name}")
        for one in hearing_measures(hearing_of(dancer, kept_out))
    ]
    seeds = {"data": UNSEEN, "songs": stage.size.songs}
    seeds["weights"] = weights_digest(stage.weights["dancer"])
    return [one.as_record("ear.", seeds, command) for one in measures]
