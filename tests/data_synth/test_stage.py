"""The plan of the stage: ways lead over it and never off it; and the head turns before the body."""

import numpy as np
import pytest

from data_synth.dancing.gaze import CHEST, FARTHEST, ahead_of_the_turn
from data_synth.dancing.script import REST, Script
from data_synth.dancing.sheet import Counts, Sheet
from data_synth.dancing.stage import ROOM, Stage, Way, way


def test_a_way_leads_over_the_stage_and_stays_there():
    rng = np.random.default_rng(0)
    stage = Stage(0.15, (45.0, 90.0), 0.1)
    here = (0.0, 0.0)
    before, reached = 0.0, []
    for _ in range(300):
        one = way(stage, here, 8, 4, before, 1.0, rng)
        x, z = one.travelled(8)
        here = (here[0] + x, here[1] + z)
        before = one.turn[-1]
        reached.append(here)
        assert np.hypot(*one.travel) <= 8 * 0.15 + 1e-9 and 0 <= one.low <= 0.1
        assert abs(np.degrees(one.turned(8))) in (pytest.approx(90.0), pytest.approx(180.0))
    far = np.linalg.norm(reached, axis=-1)
    assert far.max() <= ROOM and far.mean() > 0.4 * ROOM


def test_a_way_turns_between_its_walls_and_sinks_half_way():
    one = Way((0.8, 0.0), (0.0, 0.5, 3.5, 4.0), (0.0, 0.0, 1.5, 1.5), 0.1)
    assert one.turned(0.4) == one.turned(-1.0) == 0.0 and one.turned(3.6) == one.turned(9.0) == 1.5
    assert one.turned(2.0) == pytest.approx(0.75) and one.travelled(2) == (0.4, 0.0)
    assert one.sunk(0) == 0.0 and one.sunk(2) == pytest.approx(0.1)
    assert one.sunk(4) == pytest.approx(0.0, abs=1e-12)
    assert Way().turned(3.0) == 0.0 and Way().travelled(3.0) == (0.0, 0.0) and Way().sunk(3) == 0.0


def written(feet: tuple[int, ...]) -> Script:
    """The script of steps on every count."""
    script = Script()
    for name, value in REST.items():
        script.keys[name].append((-2.0, value))
    rng = np.random.default_rng(0)
    sheet = Sheet(script, Counts(0.0, 4, 1.0, 4), False, 1.0, 1.0, REST, rng)
    for count, foot in enumerate(feet):
        sheet.step(foot, count, 0.2 if foot == 0 else -0.2, 0.0)
    sheet.close()
    return script


def test_a_foot_that_steps_again_only_touched():
    """The weight does not jump to the other foot between two steps of one foot."""
    weight = dict(written((0, 1, 1)).keys["weight"])
    assert weight[1.06] > 0  # still on the left foot, after the right one touched
    assert dict(written((0, 1, 0)).keys["weight"])[1.06] < 0


def test_the_head_and_the_chest_lead_a_turn_within_a_neck():
    heading = np.concatenate([np.zeros(40), np.linspace(0, np.pi, 20), np.full(40, np.pi)])
    head, chest = ahead_of_the_turn(heading, 20.0)
    assert head[36] > 3 and heading[36] == 0  # before the body begins
    assert (head >= 0).all() and (head + chest).max() < FARTHEST
    assert chest == pytest.approx(CHEST / (1 - CHEST) * head)
    assert np.abs(ahead_of_the_turn(-heading, 20.0)[0] + head).max() < 1e-12
    assert not ahead_of_the_turn(np.full(9, 1.3), 20.0)[0].any()
