"""metrics.walks, on a gait whose steps are known.

The true count, and what noise and sliding do to the paper's count.
"""

import numpy as np
import pytest
from gaits import FPS, STANCE, control_of, gait, rest_pose

from motiondiff_edu.metrics.walks import (
    PAPER,
    ROBUST,
    StepRule,
    footsteps,
    heel_speed,
    runs,
    step_durations,
    steps_of_heel,
)
from motiondiff_edu.motion.skeleton import joint_index


def set_of_gaits(noise=0.0, slide=0.0, seed=1):
    rng = np.random.default_rng(seed)
    control = control_of(4)
    phases, cycles = rng.uniform(size=50), rng.uniform(1.0, 1.1, 50)
    poses = np.stack([gait(control, p, c, slide) for p, c in zip(phases, cycles, strict=True)])
    poses = poses + rng.normal(0, noise, poses.shape) if noise else poses
    return list(heel_speed(poses, np.broadcast_to(control, (50, 80, 3))))


CLEAN = footsteps(set_of_gaits())


def at(result, *tolerances):
    return [result.counts[v - 1] for v in tolerances]


def test_a_gait_of_known_steps_is_counted_exactly():
    control = control_of(10.4)
    found = footsteps([heel_speed(gait(control, phase=0.25, cycle=1.04), control)])
    # ten cycles of two feet; the left foot is cut in mid-air, the right foot in mid-stance: one
    # step is counted twice
    assert found.count == 20 + 1 and found.v95 == 1 and (found.counts[:20] == 21).all()
    speed = heel_speed(gait(control, phase=0.25, cycle=1.04), control)
    steps = np.concatenate([steps_of_heel(speed[:, heel], 1.0) for heel in (0, 1)])
    whole = np.diff(steps[(steps[:, 0] > 0) & (steps[:, 1] < len(speed))])[:, 0] / FPS
    assert whole.mean() == pytest.approx(STANCE, abs=1 / FPS) and whole.std() < 1 / FPS


def test_clean_gaits_give_one_count_at_every_tolerance():
    assert (
        CLEAN.v95 <= 2
        and CLEAN.counts.min() > 0.95 * CLEAN.counts.max()
        and 0.45 < CLEAN.mean_s < STANCE
    )


@pytest.mark.parametrize("noise, v95, peak", [(0.001, 3, 5), (0.003, 9, 10)])
def test_noise_breaks_steps_into_crumbs_and_v95_follows_the_noise(noise, v95, peak):
    found = footsteps(set_of_gaits(noise=noise))
    assert found.count > 2 * CLEAN.count and found.mean_s < 0.15
    assert (
        abs(found.v95 - v95) <= 2
        and abs(float(found.tolerances[found.counts.argmax()]) - peak) <= 3
    )
    assert at(found, 60)[0] == pytest.approx(CLEAN.count, rel=0.06)  # the plateau is the true count


def test_sliding_moves_the_peak_to_the_speed_of_the_slide():
    found = footsteps(set_of_gaits(slide=0.2, noise=1e-5))
    assert at(found, 1, 5, 10) == [0, 0, 0] and found.v95 == 20 and found.count > 2 * CLEAN.count
    assert found.mean_s < 0.1 and at(found, 30)[0] == pytest.approx(CLEAN.count, rel=0.05)


@pytest.mark.parametrize("noise", [0.001, 0.003])
def test_the_robust_rule_brings_the_count_back(noise):
    speeds = set_of_gaits(noise=noise)
    paper, robust = footsteps(speeds, PAPER), footsteps(speeds, ROBUST)
    assert abs(robust.count - CLEAN.count) < 0.25 * abs(paper.count - CLEAN.count)


def test_runs_and_each_change_of_the_rule_by_hand():
    speed = np.array([9.0, 1, 1, 9, 1, 6, 1, 1, 9, 9, 9, 1.0])  # cm/s, one value a frame at 20 fps
    assert runs(speed < 5).tolist() == [[1, 3], [4, 5], [6, 8], [11, 12]]
    assert steps_of_heel(speed, 5.0, StepRule(merge_gap_s=0.05)).tolist() == [[1, 8], [11, 12]]
    assert steps_of_heel(speed, 5.0, StepRule(min_duration_s=0.1)).tolist() == [[1, 3], [6, 8]]
    assert steps_of_heel(speed, 0.5, StepRule(merge_gap_s=1.0)).tolist() == []


def test_durations_and_v95_by_hand():
    slow, fast = np.full((7, 2), 3.5), np.full((7, 2), 90.0)
    slow[2] = 90.0  # two steps of 2 and 4 frames for each heel
    found = footsteps([slow, fast])
    assert found.count == 4 and found.v95 == 4 and found.mean_s == pytest.approx(0.15)
    assert found.std_s == pytest.approx(0.05)
    assert sorted(step_durations([slow], 4.0)) == pytest.approx([0.1, 0.1, 0.2, 0.2])


def test_no_steps_and_no_clips():
    nothing = footsteps([np.full((5, 2), 400.0)])
    assert nothing.count == 0 and np.isnan(nothing.v95) and np.isnan(nothing.mean_s)
    with pytest.raises(ValueError, match="at least one clip"):
        footsteps([])


def test_v95_is_where_95_of_100_are_found():
    """90 steps below 1 cm/s, then 4, 2 and 4 more: 94 are too few, 96 enough."""
    lowest = np.repeat([0.5, 1.5, 2.5, 3.5], [90, 4, 2, 4])
    speed = np.stack([lowest, np.full(100, 99.0)], 1).ravel()  # slow for one frame, fast for one
    found = footsteps([np.stack([speed, np.full(200, 99.0)], 1)])
    assert found.counts[:4].tolist() == [90, 94, 96, 100] and found.v95 == 3 and found.count == 96


def test_it_is_the_heel_that_counts_and_not_the_toe():
    """The left heel swings about a toe that stays: 1.8 m/s for five steps of 9 cm."""
    poses = np.tile(rest_pose(), (21, 1, 1))
    swung = np.clip(np.arange(21) - 8, 0, 5)
    poses[:, joint_index("LeftFoot"), 2] += 0.09 * swung
    poses[:, joint_index("LeftFoot"), 1] += 0.02 * swung
    speed = heel_speed(poses, np.zeros((21, 3)))
    np.testing.assert_allclose(speed[:, 0], 180 * (np.diff(swung) > 0), atol=1e-9)
    assert (speed[:, 1] == 0).all() and footsteps([speed]).count == 2 + 1


def test_a_gait_with_holes_is_refused_and_not_cut_into_more_steps():
    control = control_of(4)
    poses = gait(control)
    speed = heel_speed(poses, control)
    speed[::10] = np.nan
    with pytest.raises(ValueError, match="heel speeds of clip 1 contain NaN or infinity"):
        footsteps([heel_speed(poses, control), speed])
    poses[::10] = np.nan
    with pytest.raises(ValueError, match="x and z of the points contain NaN"):
        heel_speed(poses, control)
