"""MoFusion's Fig. 4 as a statistic.

Does attention fall on the beats, more than by chance?

Over many unseen songs we take the share of a level's attention within 0.1 s of a beat. It is
divided by the share near the beats of other songs (with other tempi and times), and by the share
near its own beats after they are moved.
Source: MoFusion 4.1, Fig. 4; the measure is ours
"""

import numpy as np
import torch
from jaxtyping import Float
from matplotlib.figure import Figure as Picture

from motiondiff_edu.conditions.music import SAMPLE_RATE
from motiondiff_edu.course.analyses.attention_on_beats import (
    attention_maps,
    beat_mass,
    beat_mass_by_chance,
    seconds_read,
)
from motiondiff_edu.performers.dancer import STEPS, Dancer
from motiondiff_edu.viz.sound import levels_over_sound

from ..walks.parts import weights_digest
from ..walks.scores import Measure, measure_of, ratio
from .parts import Stage
from .songs import FPS, TRAINED, UNSEEN, Songs, dances_of

NOISE = (0.25, 0.5, 0.75)  # diffusion steps over which the maps are averaged
SHIFTS = 100
KINDS = ("own", "shuffled", "shifted", "read")
Maps = tuple[dict[str, np.ndarray], np.ndarray]


def maps_of(
    dancer: Dancer, mel: Float[torch.Tensor, "M C"], dance: Float[np.ndarray, "T 21 3"], seed: int
) -> Maps:
    """Attention of each level while the song's own dance is denoised, and the columns' times."""
    draw = torch.Generator().manual_seed(seed)
    steps = [max(1, round(share * dancer.schedule.S)) for share in NOISE]
    found = [attention_maps(dancer, mel, dance, s, generator=draw) for s in steps]
    return {
        name: np.mean([maps[name] for maps, _ in found], axis=0) for name in found[0][0]
    }, found[0][1]


def masses(
    maps: dict[str, np.ndarray],
    times: Float[np.ndarray, "M"],
    beats: list[np.ndarray],
    own: int,
    seed: int,
) -> dict[str, tuple[float, ...]]:
    """The KINDS for each level:
    the shares near the beats of song `own`, of the others, and of its own after a shift;
    and the seconds that are read.
    """
    found = {}
    for name, weights in maps.items():
        others = [beat_mass(weights, times, other) for i, other in enumerate(beats) if i != own]
        moved = beat_mass_by_chance(weights, times, beats[own], np.random.default_rng(seed), SHIFTS)
        here = beat_mass(weights, times, beats[own])
        read = seconds_read(weights, times)
        found[name] = here, float(np.mean(others)), float(moved.mean()), read
    return found


def rows_of(
    dancer: Dancer, songs: Songs, frames: int = TRAINED
) -> dict[str, dict[str, Float[np.ndarray, "N"]]]:
    """{level: {kind of KINDS: one number for each song}}, and "all", the mean over the levels."""
    beats = songs.beats(frames)
    danced = dances_of(dancer, songs.mel, frames, seed=0)
    every = [
        masses(*maps_of(dancer, mel, danced[i], i), beats, i, i) for i, mel in enumerate(songs.mel)
    ]
    names = list(every[0])
    table = np.array([[one[name] for name in names] for one in every])  # (songs, levels, kinds)
    levels = {"all": table.mean(1)} | {short(name): table[:, k] for k, name in enumerate(names)}
    return {level: dict(zip(KINDS, rows.T, strict=True)) for level, rows in levels.items()}


def short(name: str) -> str:
    """ "down, 20 a second" -> "down-20": a level's name within that of a record."""
    where, rate = name.removesuffix(" a second").split(", ")
    return where if where == "bottom" else f"{where}-{rate.replace('.', '_')}"


def attention_measures(rows: dict[str, dict[str, np.ndarray]]) -> list[Measure]:
    """Shares and ratios with intervals over songs.

    Those without a level's name are means over the levels.
    """
    measures = []
    for level, row in rows.items():
        place = "" if level == "all" else f"{level}."
        measures += [
            measure_of(f"{place}beat_mass", "share", np.mean, row["own"]),
            measure_of(
                f"{place}beat_mass_over_shuffled", "ratio", ratio, row["own"], row["shuffled"]
            ),
            measure_of(
                f"{place}beat_mass_over_shifted", "ratio", ratio, row["own"], row["shifted"]
            ),
            measure_of(f"{place}seconds_read", "s", np.mean, row["read"]),
        ]
    top = next(level for level in rows if level.startswith("down"))
    measures.append(
        measure_of(
            "bottom_over_top_seconds", "ratio", ratio, rows["bottom"]["read"], rows[top]["read"]
        )
    )
    return measures


def attention_records(stage: Stage, command: str) -> list[dict]:
    """The statistic of Fig. 4 for the shipped dancer."""
    measures = attention_measures(rows_of(stage.dancer("dancer"), stage.songs))
    seeds = {
        "data": UNSEEN,
        "songs": stage.size.songs,
        "sampling": [0],
        "steps": STEPS,
        "noise": list(NOISE),
    }
    seeds["weights"] = weights_digest(stage.weights["dancer"])
    return [measure.as_record("attention.", seeds, command) for measure in measures]


def attention_picture(stage: Stage, song: int = 0, frames: int = TRAINED) -> Picture:
    """Levels over the sound of one unseen song, as in the paper.

    It has the levels on the way down, the bottom, and the last level on the way up.
    """
    dancer, songs = stage.dancer("dancer"), stage.songs
    dance = dances_of(dancer, songs.mel[song : song + 1], frames, seed=0)[0]
    maps, times = maps_of(dancer, songs.mel[song], dance, song)
    levels = len(maps) // 2
    shown = {name: maps[name] for k, name in enumerate(maps) if k <= levels or k == len(maps) - 1}
    audio, seconds = songs.songs[song].audio, frames / FPS
    words = (
        "Where each level of the U-Net reads in the music while its dance is denoised, heads "
        "averaged. Rows are moments of the dance; darker is more. Dotted lines are beats; "
        "an upright stripe is read by all moments."
    )
    return levels_over_sound(
        audio[: round(seconds * SAMPLE_RATE)], SAMPLE_RATE, shown, times,
        songs.songs[song].beats, seconds, words,
    )  # fmt: skip
