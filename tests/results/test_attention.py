"""The statistic of Fig. 4.

A reader of beats is told from an even one, and from one that reads the wrong beats.
"""

from functools import partial

import numpy as np
import pytest
import torch
from small_dancers import dancer_to_mel as dancer

from tools.results.dances.attention import (
    attention_measures,
    attention_picture,
    masses,
    rows_of,
    short,
)
from tools.results.dances.parts import DanceSize, Stage
from tools.results.intervals import interval
from tools.results.walks import scores

TIMES = np.arange(78) * 0.064
BEATS = [
    np.arange(start, 5.0, period)
    for start, period in ((0.1, 0.5), (0.35, 0.62), (0.0, 0.71), (0.2, 0.44))
]


def reader_of(beats: np.ndarray) -> np.ndarray:
    """A map whose weights all lie within 0.1 s of a beat."""
    near = np.abs(TIMES[:, None] - beats).min(1) <= 0.1
    return np.tile(near / near.sum(), (6, 1))


@pytest.fixture(autouse=True)
def few_draws(monkeypatch):
    monkeypatch.setattr(scores, "interval", partial(interval, draws=30))


def named(rows) -> dict[str, float]:
    return {measure.name: measure.value for measure in attention_measures(rows)}


def table(weights_of) -> dict:
    """Rows as `rows_of` makes them, of two levels."""
    found = []
    for i in range(len(BEATS)):
        maps = {"down, 20 a second": weights_of(i), "bottom, 5 a second": np.full((6, 78), 1 / 78)}
        found.append(masses(maps, TIMES, BEATS, i, seed=i))
    rows = {short(name): np.array([one[name] for one in found]).T for name in found[0]}
    rows = {"all": np.mean(list(rows.values()), axis=0), **rows}
    return {
        level: dict(zip(("own", "shuffled", "shifted", "read"), row, strict=True))
        for level, row in rows.items()
    }


def test_a_reader_of_the_beats_is_told_from_an_even_one():
    found = named(table(lambda i: reader_of(BEATS[i])))
    assert found["down-20.beat_mass"] == pytest.approx(1)
    assert (
        found["down-20.beat_mass_over_shuffled"] > 1.7
        and found["down-20.beat_mass_over_shifted"] > 1.7
    )
    assert found["bottom.beat_mass_over_shifted"] == pytest.approx(1, abs=0.1)
    assert found["bottom.beat_mass"] == pytest.approx(0.4, abs=0.1)  # 0.2 s of each half second
    low, high = sorted(found[f"{level}.beat_mass_over_shuffled"] for level in ("bottom", "down-20"))
    assert low < found["beat_mass_over_shuffled"] < high
    assert found["bottom_over_top_seconds"] > 1.5  # the even one reads all of it
    assert found["bottom.seconds_read"] == pytest.approx(78 * 0.064)


def test_a_reader_of_other_beats_gets_less_than_chance():
    found = named(table(lambda i: reader_of(BEATS[(i + 1) % 4])))
    assert found["down-20.beat_mass_over_shuffled"] < 0.8 and found["down-20.beat_mass"] < 0.7


def test_names_of_levels():
    assert [short(f"{name} a second") for name in ("down, 20", "bottom, 2.5", "up, 2.5")] == [
        "down-20",
        "bottom",
        "up-2_5",
    ]


@pytest.fixture(scope="module")
def stage():
    made = Stage(DanceSize(songs=3, seeds=1, pieces=2, each=2))
    made.dancer = lambda name: dancer(S=60)
    return made


def test_maps_of_a_dancer_become_a_row_for_each_song(stage):
    one = dancer(S=60)
    rows = rows_of(one, stage.songs)  # a song that begins with silence has no beat in 2 s
    assert list(rows) == ["all", "down-20", "down-10", "bottom", "up-10", "up-20"]
    for kinds in rows.values():
        assert all(values.shape == (3,) and np.isfinite(values).all() for values in kinds.values())
        assert ((kinds["own"] > 0) & (kinds["own"] < 1)).all() and (kinds["read"] <= 5.1).all()
    again = rows_of(one, stage.songs)
    assert all(
        np.array_equal(again[level][kind], rows[level][kind])
        for level in rows
        for kind in rows[level]
    )


def test_the_picture_has_the_sound_and_four_levels(stage):
    with torch.inference_mode():
        picture = attention_picture(stage, song=1, frames=40)
    titles = [axis.get_title() for axis in picture.axes]
    assert titles[1:] == [
        "down, 20 a second",
        "down, 10 a second",
        "bottom, 5 a second",
        "up, 20 a second",
    ]
    inside = int((stage.songs.songs[1].beats < 2.0).sum())
    assert [len(axis.lines) for axis in picture.axes] == [inside] * 5
