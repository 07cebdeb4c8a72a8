"""Do the synthetic dances lie where real ones do, and on the beat?

The table, and the ruler it is measured with.
"""

import re
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from data_synth.dancing import dance
from data_synth.dancing.acceptance import (
    FLOOR,
    OUTSIDE,
    OWN,
    UPRIGHT,
    acceptance,
    limits,
    means_outside,
)
from data_synth.dancing.moves import MANNERS
from data_synth.dancing.stage import StagePlan
from data_synth.dancing.statistics import (
    joint_speed,
    kinematic_beats,
    repeats,
    root_frame,
    statistics,
)
from data_synth.music.score import beat_song
from data_synth.music.song import GENRES
from data_synth.walking.acceptance import table
from motiondiff_edu.motion.kinematics import rot_y
from motiondiff_edu.motion.retarget import load_clip
from motiondiff_edu.motion.skeleton import joint_index

CARD = (Path(__file__).parents[2] / "data_synth" / "README.md").read_text(encoding="utf-8")
CARD = CARD.split("# Data card: synthetic dance")[1]


@pytest.fixture(scope="module")
def found():
    return acceptance(count=20, seconds=30.0)


def card(row: str) -> list[float]:
    """The numbers of a row of the card's tables, after its name."""
    line = re.search(rf"^\| {row} \|(.*)\|$", CARD, re.MULTILINE)
    return [float(number) for number in re.findall(r"-?\d[\d.]*(?:e-\d+)?", line[1])]


def test_what_lies_outside_is_known_and_explained(found):
    assert means_outside(*found) <= set(OUTSIDE)
    for name in OUTSIDE:
        assert f"`{name}`" in CARD, f"{name} is not explained in the data card"


def test_nearly_every_dance_is_inside(found):
    shares = {line[0]: line[6] for line in table(found[1], UPRIGHT)}
    assert np.mean(list(shares.values())) > 0.95 and min(shares.values()) > 0.8, shares


def test_dances_meet_their_own_song_and_no_other(found):
    """By chance exp(-d^2 / (2 0.05^2)) is some 0.05 sqrt(2 pi) / period.

    0.16 to 0.35 at 80 to 165 beats a minute.
    """
    lines = {line[0]: line for line in table(found[1], OWN)}
    assert 0.6 < lines["own_song"][1] < 0.85 and 0.15 < lines["other_song"][1] < 0.3
    assert lines["own_song"][2] > 0.4 and lines["beats_per_beat"][6] > 0.85
    for genre in {d.genre for d in found[0]}:
        own = [r["own_song"] for d, r in zip(*found, strict=True) if d.genre == genre]
        assert np.mean(own) > 0.55, genre


def test_every_genre_uses_the_floor(found):
    for genre in sorted({d.genre for d in found[0]}):
        rows = [r for d, r in zip(*found, strict=True) if d.genre == genre]
        for name, (low, high) in FLOOR.items():
            assert low <= np.mean([r[name] for r in rows]) <= high, (genre, name)


def test_dances_that_stay_on_the_spot_fail(monkeypatch):
    """The same moves with no way over the stage travel too little, in every genre."""
    for genre, manner in MANNERS.items():
        on_the_spot = replace(manner, stage=StagePlan(0.0, (0.0,), 0.0))
        monkeypatch.setitem(MANNERS, genre, on_the_spot)
    outside = means_outside(*acceptance(count=10, seconds=30.0))
    assert {"travel", *(f"{genre} travel" for genre in GENRES)} <= outside


def test_feet_point_where_a_leg_lets_them():
    for genre, (slowest, fastest, metre) in GENRES.items():
        manner = MANNERS[genre]
        for k, move in enumerate(dict.fromkeys((*manner.moves, *manner.calm))):
            song = beat_song(12.0, (slowest, fastest)[k % 2], metre, genre, k)
            out = feet_out(dance(song, k, only=move.__name__).positions)
            far = (out < -75) | (out > 100)
            assert far.mean() < 0.002, (move.__name__, out.min(), out.max())


def feet_out(world: np.ndarray) -> np.ndarray:
    """Degrees by which each foot points outwards of where the hips face, (T, 2)."""
    left = world[:, joint_index("LeftUpLeg")] - world[:, joint_index("RightUpLeg")]
    facing = np.arctan2(-left[:, 2], left[:, 0])
    found = []
    for name, side in (("Left", 1), ("Right", -1)):
        foot = world[:, joint_index(f"{name}ToeBase")] - world[:, joint_index(f"{name}Foot")]
        away = np.arctan2(foot[:, 0], foot[:, 2]) - facing
        found.append(side * np.degrees((away + np.pi) % (2 * np.pi) - np.pi))
    return np.stack(found, -1)


def test_feet_are_measured_by_hand():
    pose = np.zeros((1, 21, 3))
    pose[0, joint_index("LeftUpLeg")], pose[0, joint_index("RightUpLeg")] = [1, 0, 0], [-1, 0, 0]
    for name in ("Left", "Right"):
        pose[0, joint_index(f"{name}ToeBase")] = [1, 0, 1]
    assert feet_out(pose)[0] == pytest.approx([45, -45])


def test_a_dance_of_minutes_stays_on_its_stage():
    for k, (genre, (slowest, fastest, metre)) in enumerate(GENRES.items()):
        song = beat_song(120.0, (slowest + fastest) / 2, metre, genre, k)
        far = np.linalg.norm(dance(song, k).positions[:, 0, [0, 2]], axis=-1)
        assert far.max() < (3.3 if genre == "waltz" else 2.0), genre  # metres


def test_no_dance_is_a_loop(found):
    assert max(row["repeats"] for row in found[1]) < 0.9


def test_no_dance_exceeds_the_limits_of_the_card(found):
    worst = limits(found[0])
    assert (
        worst["planted_toe_mm_a_frame"] < card("planted toe")[0]
        and worst["bone_error_m"] < card("bones")[0]
    )
    assert abs(worst["lowest_joint_mm"] - card("lowest joint")[0]) < 1e-3
    low, high = card("knees")[:2]
    assert (
        low - 0.5 < worst["knee_smallest_deg"] < low + 1.5
        and high - 20 < worst["knee_largest_deg"] < high + 0.5
    )
    assert (
        card("fastest joint")[0] - 4 < worst["fastest_joint_mps"] < card("fastest joint")[0] + 0.1
    )


def test_no_pelvis_is_thrown(found):
    """Recorded dancers carry theirs at 2 m/s at most, in quick songs too."""
    worst = limits(found[0])
    assert worst["fastest_pelvis_mps"] < 2.6
    assert worst["fastest_pelvis_median_mps"] < 2


def test_the_card_has_these_dances_figures(found):
    """Twenty dances here, thirty in the card."""
    for name, mean, *_ in table(found[1], UPRIGHT | FLOOR | OWN):
        assert card(name)[0] == pytest.approx(mean, rel=0.2), name


# the ruler


def shaking(period: float, fps: float = 20.0, seconds: float = 12.0) -> np.ndarray:
    """A figure whose left hand goes to and fro, at rest every `period` seconds from `period` on."""
    t = np.arange(round(seconds * fps)) / fps
    world = np.random.default_rng(0).normal(size=(1, 21, 3)).repeat(len(t), 0)
    world[:, 15, 0] += 0.3 * np.cos(np.pi * t / period)
    return world


def test_kinematic_beats_are_where_a_movement_turns():
    for period in (0.4, 0.63):
        beats = kinematic_beats(shaking(period))
        wanted = period * np.arange(1, 12 / period)
        inner = beats[(beats > 1) & (beats < 11)]
        assert np.abs(inner[:, None] - wanted).min(1).max() < 0.02
        assert np.diff(inner) == pytest.approx(period, abs=0.035)


def test_speed_by_hand():
    world = np.zeros((5, 21, 3))
    world[:, 4, 1] = [0.0, 0.1, 0.2, 0.2, 0.2]
    assert joint_speed(world, 20.0) == pytest.approx(np.array([2.0, 1.0, 0.0]) / 21)


def test_a_loop_repeats_and_turning_does_not_hide_it():
    rng = np.random.default_rng(1)
    phrase = np.cumsum(rng.normal(size=(20, 21, 3)), 0) * 0.01
    pose = rng.normal(size=(21, 3)) + [0.0, 1.0, 0.0]
    pose[[1, 13], 0], pose[[5, 17], 0] = 1.0, -1.0
    loop = pose + np.tile(np.concatenate([phrase, phrase[::-1]]), (4, 1, 1))
    assert repeats(loop) > 0.99
    turned = np.einsum("ij,tkj->tki", rot_y(1.1), loop) + [3.0, 0.0, -2.0]
    assert root_frame(turned, 20.0) == pytest.approx(root_frame(loop, 20.0), abs=1e-9)


def test_the_ruler_finds_real_dances_inside(real_data):
    """Two upright dances of CMU.

    A third clip, of a dab, crouches more than any of the eight that made the range.
    """
    for name, cut in (("cmu_05_06_dance", 0), ("cmu_acrnn_salsa_10", 70)):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            row = statistics(load_clip(real_data / "bvh" / f"{name}.bvh").world()[cut:])
        assert row["standing_feet"] < 0.4 and row["turn_8s"] > 120 and row["travel"] > 0.28, name
        for key, (low, high) in UPRIGHT.items():
            assert low - 0.1 * (high - low) <= row[key] <= high + 0.1 * (high - low), (
                name,
                key,
                row[key],
            )
