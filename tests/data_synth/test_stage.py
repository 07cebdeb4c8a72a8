"""The plan of the stage: ways lead over it and never off it; and the head turns before the body."""

import numpy as np
import pytest

from data_synth.dancing.follow import followed
from data_synth.dancing.gaze import CHEST, ahead_of_the_turn
from data_synth.dancing.script import REST, Script, Step
from data_synth.dancing.sheet import Counts, Sheet
from data_synth.dancing.stage import StagePlan, Way, way
from data_synth.dancing.steps import Roll, _softly_below, track


def ways(plan: StagePlan, n: int = 1000, size: float = 1.0, here=(0.0, 0.0), before: float = 1.0):
    rng = np.random.default_rng(0)
    return [way(plan, here, 8, 4, before, size, rng) for _ in range(n)]


def test_a_way_leads_over_the_stage_and_stays_there():
    rng = np.random.default_rng(0)
    plan = StagePlan(0.15, (45.0, 90.0), 0.1)
    here = (0.0, 0.0)
    before, reached = 0.0, []
    for _ in range(300):
        one = way(plan, here, 8, 4, before, 1.0, rng)
        x, z = one.travelled(8)
        here = (here[0] + x, here[1] + z)
        before = one.turn[-1]
        reached.append(here)
        assert np.hypot(*one.travel) <= 8 * 0.15 + 1e-9 and 0 <= one.low <= 0.1
        assert abs(np.degrees(one.turned(8))) in (pytest.approx(90.0), pytest.approx(180.0))
    far = np.linalg.norm(reached, axis=-1)
    assert far.max() <= 1.5 and far.mean() > 0.6


def test_the_farthest_of_three_places_is_gone_to():
    """Its distance from the middle is the root of the largest of three uniform numbers."""
    far = [np.hypot(*one.travel) for one in ways(StagePlan(9.0, (45.0,), 0.0), 4000)]
    assert np.mean(far) == pytest.approx(1.5 * 6 / 7, abs=0.01) and max(far) <= 1.5


def test_a_side_is_kept_as_often_as_the_plan_says():
    for before, stays in ((1.0, 0.75), (-1.0, 0.75), (1.0, 0.2)):
        plan = StagePlan(0.1, (45.0,), 0.0, stays)
        kept = [np.sign(one.turn[-1]) == np.sign(before) for one in ways(plan, before=before)]
        assert np.mean(kept) == pytest.approx(stays, abs=0.05)


def test_a_calm_move_travels_and_turns_less_and_a_large_one_turns_no_more():
    plan = StagePlan(0.1, (60.0,), 0.0)
    turned = {s: abs(np.degrees(ways(plan, 1, s)[0].turned(8))) for s in (0.5, 1.0, 1.4)}
    assert turned == pytest.approx({0.5: 60.0, 1.0: 120.0, 1.4: 120.0})
    gone = {s: max(np.hypot(*one.travel) for one in ways(plan, 50, s)) for s in (0.5, 1.0)}
    assert gone == pytest.approx({0.5: 0.4, 1.0: 0.8})


def test_who_was_led_off_the_stage_is_led_back():
    for one in ways(StagePlan(0.05, (45.0,), 0.0), 200, here=(2.5, 0.0)):
        assert np.hypot(*one.travel) == pytest.approx(8 * 0.05 + 1.0)
        assert one.travel[0] < -0.6


def test_a_way_turns_between_its_walls_and_sinks_half_way():
    one = Way((0.8, 0.0), (0.0, 0.5, 3.5, 4.0), (0.0, 0.0, 1.5, 1.5), 0.1)
    assert one.turned(0.4) == one.turned(-1.0) == 0.0 and one.turned(3.6) == one.turned(9.0) == 1.5
    assert one.turned(2.0) == pytest.approx(0.75) and one.travelled(2) == (0.4, 0.0)
    assert one.sunk(0) == 0.0 and one.sunk(2) == pytest.approx(0.1)
    assert one.sunk(4) == pytest.approx(0.0, abs=1e-12)
    assert one.travelled(9.0) == (0.8, 0.0) and one.travelled(-1.0) == (0.0, 0.0)
    assert Way().turned(3.0) == 0.0 and Way().travelled(3.0) == (0.0, 0.0) and Way().sunk(3) == 0.0


def sheet_of(script: Script) -> Sheet:
    rng = np.random.default_rng(0)
    return Sheet(script, Counts(0.0, 4, 1.0, 4), False, 1.0, 1.0, REST, rng)


def written(feet: tuple[int, ...]) -> Script:
    """The script of steps on every count."""
    script = Script()
    for name, value in REST.items():
        script.keys[name].append((-2.0, value))
    sheet = sheet_of(script)
    for count, foot in enumerate(feet):
        sheet.step(foot, count, 0.2 if foot == 0 else -0.2, 0.0)
    sheet.close()
    return script


def test_a_foot_that_steps_again_only_touched():
    """The weight does not jump to the other foot between two steps of one foot."""
    weight = dict(written((0, 1, 1)).keys["weight"])
    assert weight[1.06] > 0  # still on the left foot, after the right one touched
    assert dict(written((0, 1, 0)).keys["weight"])[1.06] < 0


def test_a_step_without_time_ends_the_flight_before():
    script = Script()
    sheet = sheet_of(script)
    sheet.kick(0, 1.0, 0.0, 0.3, 0.2, half=0.4)
    assert script.steps[0][-1].x == pytest.approx(0.1)
    sheet.step(0, 1.6, 0.3, 0.1)  # the foot came down at 1.4
    (kick,) = script.steps[0]
    assert kick.land == pytest.approx(1.4) and kick.x == pytest.approx(0.3, abs=0.02)
    assert script.toes[0][0] == kick.x
    sheet.step(0, 3.0, 0.2, 0.0)
    assert len(script.steps[0]) == 2


def test_a_step_without_time_does_not_move_what_is_long_over_or_a_pivot():
    script = Script()
    sheet = sheet_of(script)
    sheet.step(0, 1.0, 0.2, 0.0)
    sheet.step(1, 2.9, -0.2, 0.0)
    before = list(script.steps[0])
    sheet.step(0, 3.0, 0.3, 0.3)  # the right foot has just come down
    assert script.steps[0] == before
    sheet.pivot(0, 3.4, 30)
    before = list(script.steps[0])
    sheet.step(0, 3.6, 0.3, 0.3)
    assert script.steps[0] == before and before[-1].pivot


def test_which_way_the_middle_of_the_stage_lies():
    script = Script()
    for home, inward in (
        ((0, 1, 0.1), -1),
        ((0, -1, 0.1), 1),
        ((1, 0, 1.5), -1),
        ((1, 0, -1.5), 1),
    ):
        script.home = home
        assert sheet_of(script).inward() == inward


def test_a_heel_rises_less_and_less_below_the_steepest_pitch():
    degrees = np.linspace(-20, 120, 300)
    soft = _softly_below(degrees, 50.0)
    assert soft[degrees < 37] == pytest.approx(degrees[degrees < 37])
    assert soft.max() < 50 and soft[degrees > 90].min() > 49.5 and (np.diff(soft) > 0).all()
    assert np.array_equal(_softly_below(degrees, np.inf), degrees)
    t = np.arange(60) / 20
    one = track([], (0.1, 0.1, 0.0), np.empty((0, 2)), t, np.full(60, 80.0), Roll(steepest=50.0))
    assert np.degrees(one.pitch).max() < 50


def test_a_hop_without_time_is_none():
    script = Script()
    sheet = sheet_of(script)
    sheet.step(0, 1.0, 0.2, 0.0)
    before = dict(sheet.keys)
    sheet.hop(0, 1.3)
    assert len(script.steps[0]) == 1 and sheet.keys == before


def turning(radians: float) -> Script:
    """A figure that stands, and turns by so much between beats 4 and 6."""
    script = Script()
    script.keys["heading"] += [(-2.0, 0.0), (4.0, 0.0), (6.0, radians), (20.0, radians)]
    return script


@pytest.mark.parametrize("degrees", [30, 150, 720, -150, -720])
def test_standing_feet_pivot_when_the_body_turns(degrees):
    script = turning(np.radians(degrees))
    start = tuple(script.toes)
    feet = followed(script, start, (-2.0, 12.0))
    for side, toe, steps in zip((1, -1), start, feet, strict=True):
        assert all(one.pivot and (one.x, one.z) == toe[:2] for one in steps)
        assert all(a.land < b.lift for a, b in zip(steps, steps[1:], strict=False))
        yaw = steps[-1].yaw if steps else toe[2]
        assert -36 < side * np.degrees(yaw - np.radians(degrees)) < 56
        if abs(degrees) == 30:
            assert not steps, "a foot need not move at once"
        else:
            assert 3.5 < steps[0].lift and steps[-1].land < 7


def test_a_foot_lands_as_the_body_faces_and_where_it_was_put():
    script = turning(np.radians(170))
    script.steps[0].append(Step(6.2, 7.0, 0.3, 0.4, 0.12, 0.1))
    (left, _) = followed(script, tuple(script.toes), (-2.0, 12.0))
    (step,) = [one for one in left if not one.pivot]
    assert (step.x, step.z, step.lift, step.land) == (0.3, 0.4, 6.2, 7.0)
    assert np.degrees(step.yaw) == pytest.approx(170 - 35), "as far in as a leg allows"
    assert -36 < np.degrees(left[-1].yaw) - 170 < 56


def test_the_head_and_the_chest_lead_a_turn_within_a_neck():
    heading = np.concatenate([np.zeros(40), np.linspace(0, np.pi, 20), np.full(40, np.pi)])
    head, chest = ahead_of_the_turn(heading, 20.0)
    assert head[34] > 3 and heading[34] == 0  # a quarter of a second before the body begins
    assert not head[:32].any(), "and not much earlier"
    assert (head >= 0).all() and 40 < (head + chest).max() < 50
    assert chest == pytest.approx(CHEST / (1 - CHEST) * head)
    assert np.abs(ahead_of_the_turn(-heading, 20.0)[0] + head).max() < 1e-12
    assert not ahead_of_the_turn(np.full(9, 1.3), 20.0)[0].any()
