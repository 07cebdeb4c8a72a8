"""The measurements of the dancers by `make results`.

There is one part for each of the shipped weights, one for music unlike that of training, and one
for the data's own dances.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import islice
from pathlib import Path

import numpy as np
import torch
from jaxtyping import Float

from data_synth.music import songs
from data_synth.music.recorded import recorded_song
from data_synth.music.tempi import HELD_OUT_TEMPI, held_out
from data_synth.music.varied import varied_songs
from motiondiff_edu.motion.cleanup import Body, clean_up
from motiondiff_edu.performers.dancer import STEPS, Dancer
from motiondiff_edu.pretrained import checkpoints

from ..walks.parts import weights_digest
from ..walks.scores import FPS, Measure, measure_of, measures
from ..walks.trials import MORE_STEPS
from .floor import data_floor_measures, floor_measures, floor_rows
from .genres import SEED, GenreJudge, features_by_window, genre_measures, judge_of
from .scores import (
    BEATS,
    BONES,
    SHARE,
    VARIETY,
    beat_rows,
    bone_gain,
    bone_rows,
    features_of,
    longer,
    repeat_measure,
    rows_of,
    variety_rows,
    worst_share,
)
from .songs import (
    JUDGED,
    SECONDS,
    TRAINED,
    UNSEEN,
    Hear,
    Songs,
    danced_by_the_data,
    dances_by_the_data,
    dances_of,
    judged_songs,
    mel_of,
)

LONG = (200, 400)
WAYS: dict[str, dict] = {  # options of `dance_mel`; guidance 1 is none, and `dancer` has 4
    **{f"guided.{weight}": {"guidance": weight} for weight in (1, 2)},
    **{f"steps{n}": {"steps": n} for n in (10, MORE_STEPS)},
}
FINISHED = ("bas_share", "speed_over_data", "skating_mps", "bone_rmse_cm")
DANCES = {
    "dancer": "dancer",
    "dancer-plain": "dancer-plain",
    "regression": "regression",
    "unheard": "dancer",
}  # weights
# properties that no song of training has. These songs are the composer's own, in one feel, and so
# differ from those of training in more than their name says
UNHEARD = {"metre5": {"metre": 5}, "mallets": {"timbre": "mallets"}}
TEMPI_KEPT_OUT = {f"tempo{low:g}-{high:g}": ((low, high),) for low, high in HELD_OUT_TEMPI}


@dataclass(frozen=True)
class DanceSize:
    """The amount of measurement: the goals' 50 songs and 3 sampling seeds, or a quick try."""

    songs: int = 50
    seeds: int = 3
    pieces: int = 20  # of music, for the variety of dances to one piece
    each: int = 10
    taught: int = 200  # songs from which the judge of genres learns


DANCE_FULL = DanceSize()
DANCE_QUICK = DanceSize(songs=6, seeds=1, pieces=3, each=3, taught=30)


class Stage:
    """The songs, made once, the data's own dances to them, and the dancers by name."""

    def __init__(
        self, size: DanceSize, weights: dict[str, Path] | None = None, hear: Hear = mel_of
    ):
        self.size = size
        self.weights = checkpoints.available() | (weights or {})
        self.hear = hear

    @cached_property
    def songs(self) -> Songs:
        return judged_songs(self.size.songs, hear=self.hear)

    @cached_property
    def pieces(self) -> Songs:
        return judged_songs(
            self.size.pieces, self.size.each, TRAINED, seed=UNSEEN + 1, hear=self.hear
        )

    @cached_property
    def data_features(self) -> np.ndarray:
        """Kinetic features of the data's dances to the songs.

        All features are normalised by these.
        """
        return features_of(self.songs.truth[:, :, :TRAINED])[:, 0]

    @cached_property
    def judge(self) -> GenreJudge:
        """The classifier of genres; it has learnt from songs of the training split."""
        taught = list(varied_songs(self.size.taught, SEED, SECONDS, JUDGED))
        dances = dances_by_the_data(taught, 1, self.songs.truth.shape[2], SEED)
        return judge_of(dances[:, 0], taught)

    def dancer(self, name: str) -> Dancer:
        return checkpoints.load(self.weights[name])

    def data_rows(self, frames: int) -> dict[str, np.ndarray]:
        return rows_of(self.songs.truth[:, 0, :frames][None], self.songs.beats(frames))


def dances(stage: Stage, dancer: Dancer, frames: int, seeds: int) -> np.ndarray:
    """(seeds, songs, frames, 21, 3)"""
    return np.stack([dances_of(dancer, stage.songs.mel, frames, seed) for seed in range(seeds)])


@dataclass(frozen=True, eq=False)
class Danced:
    """One dancer's dances, and the rows (one number for each song) of DANCED."""

    made: np.ndarray  # (seeds, songs, frames, 21, 3)
    rows: dict[str, np.ndarray]

    @property
    def measures(self) -> list[Measure]:
        return measures(DANCED, self.rows)


DANCED = BEATS | BONES | VARIETY


def danced(stage: Stage, dancer: Dancer) -> Danced:
    """The dances of any dancer to the songs of the stage."""
    made = dances(stage, dancer, TRAINED, stage.size.seeds)
    beats = beat_rows(rows_of(made, stage.songs.beats(TRAINED)), stage.data_rows(TRAINED))
    return Danced(made, beats | bone_rows(made) | variety(stage, dancer))


def dancer_measures(stage: Stage, name: str) -> list[Measure]:
    """All measures of one set of weights."""
    dancer = stage.dancer(name)
    found = danced(stage, dancer)
    if name != "dancer":
        return found.measures + repeats(stage, dances(stage, dancer, max(LONG), 1)[0])
    gain = []
    if "dancer-plain" in stage.weights:
        plain = dances(stage, stage.dancer("dancer-plain"), TRAINED, stage.size.seeds)
        bones = found.rows["bones"], bone_rows(plain)["bones"]
        gain = [measure_of("bone_gain", "share", bone_gain, *bones)]
    return [*found.measures, *gain, *finished(stage, dancer, found),
            *long_measures(stage, dancer, found)]  # fmt: skip


def finished(stage: Stage, dancer: Dancer, found: Danced) -> list[Measure]:
    """Some measures of the same dances as `Dancer.dance` returns them, named finished.*"""
    whole = np.stack(
        [
            [clean_up(one, FPS, body=Body.of(one, bones=dancer.bones)) for one in song]
            for song in found.made
        ]
    )
    beats = rows_of(whole, stage.songs.beats(TRAINED))
    rows = beat_rows(beats, stage.data_rows(TRAINED)) | bone_rows(whole)
    return [
        replace(one, name=f"finished.{one.name}")
        for one in measures({kind: DANCED[kind] for kind in FINISHED}, rows)
    ]


def long_measures(stage: Stage, dancer: Dancer, found: Danced) -> list[Measure]:
    """The alignment of dances two and four times as long as in training, and their repetition."""
    short, ratios = [found.rows[name] for name in SHARE], []
    for frames in LONG:
        made = dances(stage, dancer, frames, 1)
        rows = beat_rows(rows_of(made, stage.songs.beats(frames)), stage.data_rows(frames))
        ratios.append(longer(f"long{frames}_over_100", [rows[name] for name in SHARE], short))
    return ratios + repeats(stage, made[0]) + floor_and_genre(stage, made[0])


def floor_and_genre(stage: Stage, made: np.ndarray) -> list[Measure]:
    """How the longest dances use the floor, and whether their genre can be seen."""
    truth, genres = stage.songs.truth[:, 0], stage.songs.genres
    seen = [stage.judge.right(features_by_window(x), genres) for x in (made, truth)]
    return floor_measures(floor_rows(made), floor_rows(truth)) + genre_measures(*seen, genres)


def repeats(stage: Stage, made: np.ndarray) -> list[Measure]:
    """Repetition in the longest dances, and in the data's."""
    return [
        repeat_measure(made),
        replace(repeat_measure(stage.songs.truth[:, 0]), name="repeat_data"),
    ]


def variety(stage: Stage, dancer: Dancer) -> dict[str, np.ndarray]:
    """The rows of VARIETY: dances to one piece, and the distance of all from the data's."""
    mel = stage.pieces.mel.repeat_interleave(stage.size.each, dim=0)
    made = dances_of(dancer, mel, TRAINED, seed=0).reshape(stage.pieces.truth.shape)
    return variety_rows(features_of(made), features_of(stage.pieces.truth), stage.data_features)


def unheard_measures(stage: Stage) -> list[Measure]:
    """Alignment with music of a metre, a timbre and tempi that no training song has."""
    n, dancer = stage.size.songs, stage.dancer("dancer")
    found, shares = [], []
    for k, (name, changes) in enumerate(UNHEARD.items()):
        seed = UNSEEN + 2 + k
        tempi_of_training = (
            song for song in songs(2 * n, seed, SECONDS, **changes) if not held_out(song.tempo)
        )
        made = [recorded_song(song, seed) for song in islice(tempi_of_training, n)]
        rows = _heard(dancer, danced_by_the_data(made, 1, TRAINED, seed))
        found += _named(name, rows)
    for k, (name, tempi) in enumerate(TEMPI_KEPT_OUT.items()):
        seed = UNSEEN + 2 + len(UNHEARD) + k
        heard = judged_songs(n, 1, TRAINED, seed, variety=replace(JUDGED, tempi=tempi))
        rows = _heard(dancer, heard)
        found += _named(name, rows)
        shares.append([rows[kind] for kind in SHARE])
    return [*found, worst_share("unheard_tempo_worst_share", shares)]


def _heard(dancer: Dancer, heard: Songs) -> dict[str, np.ndarray]:
    """The rows of BEATS."""
    beats = heard.beats(TRAINED)
    made = dances_of(dancer, heard.mel, TRAINED, seed=0)
    return beat_rows(rows_of(made[None], beats), rows_of(heard.truth[:, 0][None], beats))


def _named(name: str, rows: dict[str, np.ndarray]) -> list[Measure]:
    return [replace(one, name=f"unheard.{name}.{one.name}") for one in measures(BEATS, rows)]


@dataclass(frozen=True, eq=False)
class Otherwise:
    """A dancer that always dances with these options; it is called as a dancer is."""

    dancer: Dancer
    options: dict

    def dance_mel(
        self, mel: Float[torch.Tensor, "B M C"], frames: int, *, generator: torch.Generator
    ) -> Float[torch.Tensor, "B T 21 3"]:
        return self.dancer.dance_mel(mel, frames, generator=generator, **self.options)


def way_records(stage: Stage, command: str) -> list[dict]:
    """The records `dancer.WAY.*` of the shipped dancer, with other options of `dance_mel`."""
    dancer, found = stage.dancer("dancer"), []
    for way, options in WAYS.items():
        measured = danced(stage, Otherwise(dancer, options)).measures
        found += as_records(stage, "dancer", measured, f"dancer.{way}.", command, options)
    return found


def data_records(stage: Stage, command: str) -> list[dict]:
    """The records of the data's own dances to the songs: how they use the floor."""
    seeds = {"data": UNSEEN, "songs": stage.size.songs}
    found = data_floor_measures(stage.songs.truth[:, 0], stage.songs.genres)
    return [measure.as_record("dance_data.", seeds, command) for measure in found]


def dance_records(stage: Stage, part: str, command: str) -> list[dict]:
    """The records of a part: "dancer", "dancer-plain", "regression", or "unheard"."""
    unheard = part == "unheard"
    found = unheard_measures(stage) if unheard else dancer_measures(stage, part)
    return as_records(stage, DANCES[part], found, "dancer." if unheard else f"{part}.", command, {})


def as_records(
    stage: Stage, name: str, found: list[Measure], prefix: str, command: str, options: dict
) -> list[dict]:
    """The measures of the weights of this name as records; `options`: other ones of `dance_mel`."""
    seeds = {
        "data": UNSEEN,
        "songs": stage.size.songs,
        "sampling": list(range(stage.size.seeds)),
        "steps": STEPS,
        "weights": weights_digest(stage.weights[name]),
    } | options
    return [measure.as_record(prefix, seeds, command) for measure in found]
