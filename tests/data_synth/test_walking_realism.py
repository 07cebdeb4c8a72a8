"""Do the synthetic walks lie where real ones do?

The acceptance table, and the ruler it is measured with.
"""

import re
from pathlib import Path

import numpy as np
import pytest

from data_synth.walking import random_control, walk
from data_synth.walking.acceptance import (
    NEUTRAL,
    OUTSIDE,
    RUN,
    acceptance,
    means_outside,
    show,
    steady_walk,
)
from data_synth.walking.gait_cycles import GRID, analyse, cycles
from data_synth.walking.gait_statistics import mean_curves, statistics, turning_lean
from data_synth.walking.own_measures import limits, own_measures
from motiondiff_edu.metrics.walks import adherence, skating
from motiondiff_edu.motion.retarget import load_clip

CARD = (Path(__file__).parents[2] / "data_synth" / "README.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def tables():
    return acceptance(walks=12, runs=3)


def test_what_lies_outside_is_known_and_explained(tables):
    assert means_outside(*tables) <= set(OUTSIDE)
    assert "slip" in means_outside(
        *tables
    )  # exactly still feet are outside of what captures show, on purpose
    for name in OUTSIDE:
        assert f"`{name}`" in CARD, f"{name} is not explained in the data card"


def test_nearly_every_walker_is_inside(tables):
    shares = {line[0]: line[6] for line in tables[0] if line[0] not in OUTSIDE}
    assert np.mean(list(shares.values())) > 0.93
    assert min(shares.values()) > 0.5, shares


def test_the_table_has_every_statistic_and_shows_it(tables):
    assert [len(t) for t in tables] == [len(NEUTRAL), len(RUN)]
    assert show(tables[0]).count("\n") == len(NEUTRAL) + 2 and "**mean out**" in show(tables[0])


def test_the_knee_has_two_bumps_and_the_toe_lifts_twice():
    curve = mean_curves(walk(np.tile([1.2, 0.0, 0.0], (250, 1)), 3, "neutral").world())
    knee, toe = curve["knee"], curve["toe_y"]
    loading = knee[:15].max()
    dip = knee[15:25].min()
    swing = knee[30:45].max()
    assert loading > knee[0] + 4 and dip < loading - 7 and swing > 55
    assert toe[33:36].max() > toe[42:45].min() + 0.03 and toe[-1] > toe[42:45].min() + 0.01
    assert 0.20 < GRID[curve["hips_y"][:25].argmax()] < 0.40


def test_arms_swing_with_the_opposite_thigh():
    curve = mean_curves(walk(np.tile([1.1, 0.0, 0.0], (250, 1)), 5, "neutral").world())
    opposite = np.roll(curve["thigh"][:-1], 25)
    assert np.corrcoef(curve["hand"][:-1], opposite)[0, 1] > 0.75
    assert np.corrcoef(curve["hand"], curve["thigh"])[0, 1] < -0.5


def test_the_body_leans_into_turns():
    turns = [random_control(15.0, np.random.default_rng([2, k]), "turn") for k in range(4)]
    slopes, r = np.array(
        [turning_lean(walk(c, k, "neutral").world()) for k, c in enumerate(turns)]
    ).T
    assert 0.55 < slopes.mean() < 0.9 and r.mean() > 0.8


def test_cadence_follows_speed():
    slow, quick = steady_walk(1.0, 2), steady_walk(1.5, 2)
    assert quick["cadence"] - slow["cadence"] == pytest.approx(27 * 0.5, abs=6)
    assert quick["step_length"] > slow["step_length"] + 0.1


def test_the_data_obey_their_own_control():
    clips = [walk(random_control(8.0, np.random.default_rng(k), "mixed"), k) for k in range(5)]
    assert np.mean([adherence(c.poses, c.control) for c in clips]) < 0.01
    assert np.nanmean([skating(c.poses, c.control) for c in clips]) < 0.01


def card(row: str) -> list[float]:
    """The numbers in the second column of a row of the card's own numbers."""
    line = re.search(
        rf"^\| {row} \|([^|]*)\|",
        CARD.split("## Its own numbers")[1].split("\n## ")[0],
        re.MULTILINE,
    )
    return [float(number) for number in re.findall(r"-?\d[\d.]*(?:e-\d+)?", line[1])]


def test_the_data_score_what_the_card_says():
    """Ten pasts with five continuations each, not twenty with fifty: their spread is 0.078 m."""
    found = own_measures(clips=20, pasts=10, n=5)
    mean, smallest, largest = card("spread of continuations")
    assert smallest < mean < largest and found["spread_m"] == pytest.approx(mean, rel=0.25)
    assert found["adherence_mps"] == pytest.approx(card("adherence")[0], abs=0.0005)
    assert found["skating_mps"] == pytest.approx(card("skating")[0], abs=0.0005)
    lean = found["turning_lean_slope"], found["turning_lean_r"]
    assert lean == pytest.approx(card("lean in turns"), abs=0.006)


def test_no_walk_exceeds_the_limits_of_the_card():
    """Sixty of the card's 600 walks: within its limits, and not far from them."""
    found = limits(clips=60, spots=20)
    low, high = card("knees")
    assert (
        low - 0.5 < found["knee_smallest_deg"] < low + 0.5
        and high - 3 < found["knee_largest_deg"] < high + 0.5
    )
    slowest, fastest, aside, turning = card("commanded")
    assert slowest - 0.005 < found["ahead_slowest_mps"] < slowest + 0.02
    assert fastest - 0.02 < found["ahead_fastest_mps"] < fastest + 0.005
    assert aside - 0.02 < found["aside_mps"] < aside + 0.005
    assert turning - 3 < found["turning_dps"] < turning + 0.5
    assert found["speed_times_turning_mps2"] < card("speed x turning")[0]
    assert found["planted_toe_mm_a_frame"] < card("planted toe")[0]
    assert found["bone_error_m"] < card("bones")[0]
    assert abs(found["lowest_joint_mm"] - card("lowest joint")[0]) < 1e-3
    share = re.search(r"within 4 cm of each other in (\d+) %", CARD)
    assert 100 * found["feet_within_4cm"] == pytest.approx(float(share[1]), abs=1)


def test_a_walk_that_stands_has_no_cycle():
    with pytest.raises(ValueError, match="no steady gait cycle"):
        statistics(walk(np.zeros((100, 3)), 1, "neutral").world())


@pytest.mark.parametrize(
    ("name", "v", "cadence", "step", "stance"),
    [("cmu_02_01_walk", 1.27, 109, 0.69, 0.64), ("cmu_12_01_walk_pybvh", 0.96, 94, 0.61, 0.67)],
)
def test_the_ruler_agrees_with_published_figures_of_real_walks(
    real_data, name, v, cadence, step, stance
):
    found = statistics(load_clip(real_data / "bvh" / f"{name}.bvh").world())
    assert found["v"] == pytest.approx(v, abs=0.03) and found["cadence"] == pytest.approx(
        cadence, abs=3
    )
    assert found["step_length"] == pytest.approx(step, abs=0.03) and found[
        "stance"
    ] == pytest.approx(stance, abs=0.03)


def test_contact_found_from_motion_agrees_with_the_truth():
    clip = walk(np.tile([1.2, 0.0, 0.0], (200, 1)), 6, "neutral")
    found = analyse(clip.world())
    assert (found.down | ~clip.contacts).mean() > 0.97  # what is planted is seen down
    assert 12 <= len(cycles(found)) <= 20
