"""What an eye finds, on motions for which the number follows by hand."""

import numpy as np
import pytest
from gaits import rest_pose

from data_synth.walking import walk
from motiondiff_edu.metrics import bodies
from motiondiff_edu.motion.skeleton import HEELS, HIPS, TOES, joint_index

FPS, T = 20, 100
SECONDS = np.arange(T) / FPS


def standing(frames: int = T) -> np.ndarray:
    return np.repeat(rest_pose()[None], frames, axis=0)


def test_a_toe_that_goes_up_and_down_each_frame_flutters_in_each():
    motion = standing()
    motion[::2, TOES[0], 1] += 0.011
    assert bodies.toe_flutter(motion) == pytest.approx(FPS)
    motion[::2, TOES[1], 1] += 0.011
    assert bodies.toe_flutter(motion) == pytest.approx(2 * FPS)
    motion = standing()
    motion[::2, TOES[0], 1] += 0.009  # under a centimetre
    assert bodies.toe_flutter(motion) == 0


def test_one_reversal_counts_once_and_by_the_second():
    motion = standing(42)  # 40 places where a toe can turn
    motion[20, TOES[1], 1] += 0.05
    assert bodies.toe_flutter(motion) == pytest.approx(20 / 40)
    slowly = standing(82)
    slowly[40, TOES[1], 1] += 0.05
    assert bodies.toe_flutter(slowly, fps=40) == pytest.approx(40 / 80)
    steps = standing()
    steps[:, TOES[0], 1] += 0.15 * np.sin(np.pi * SECONDS).clip(0)  # an ordinary swing
    assert bodies.toe_flutter(steps) == 0


def test_a_metronome_repeats_its_strides_and_a_drunkard_does_not():
    motion = standing(120)
    t = np.arange(120) / FPS
    motion[:, HIPS + 4, 2] += 0.2 * np.sin(2 * np.pi * t)  # a stride of a second
    assert bodies.stride_change(motion) < 0.05
    growing = motion.copy()
    growing[:, :, 0] += 0.5 * t[:, None]  # the way does not count
    assert bodies.stride_change(growing) < 0.05
    growing[:, 12, 1] += 0.1 * t  # 10 cm a second in one of 21 joints, and a stride of 0.7 s
    short = 100 * 0.1 * 0.7 / np.sqrt(21)
    assert short < bodies.stride_change(growing) < 100 * 0.1 * 1.1 / np.sqrt(21)


def test_hands_swing_as_far_as_they_go():
    motion = standing(200)
    swing = 0.25 * np.sin(2 * np.pi * np.arange(200) / 20)
    for hand, sign in zip(bodies.HANDS, (1, -1), strict=True):
        motion[:, hand, 2] += sign * swing
    # how much of 1 Hz passes a filter of 3 Hz
    gain = 1 / (1 + (np.tan(np.pi / 20) / np.tan(3 * np.pi / 20)) ** 4)  # of both directions
    wanted = 100 * gain * np.ptp(np.percentile(swing, [5, 95]))
    assert bodies.hand_swing(motion) == pytest.approx(wanted, rel=0.02)
    turned = motion[..., [2, 1, 0]] * [1, 1, -1]  # the same figure, facing x
    assert bodies.hand_swing(turned) == pytest.approx(bodies.hand_swing(motion), rel=1e-6)


def test_an_invented_gesture_is_as_high_as_it_rises():
    given, made = standing(), standing() + [3.0, 0.4, 1.0]  # elsewhere, and higher as a whole
    made[50, bodies.HANDS[1], 1] += 0.3
    assert bodies.hand_above_given(made, given) == pytest.approx(30)
    assert bodies.hand_above_given(given, made) == pytest.approx(0, abs=1e-9)


def test_feet_are_apart_along_the_way_one_faces():
    motion = standing()
    motion[:, HEELS[0], 2] += 0.25
    stands = np.zeros(T, bool)
    stands[60:] = True
    wanted = 100 * abs(motion[0, HEELS[0], 2] - motion[0, HEELS[1], 2])
    assert bodies.feet_apart(motion, stands) == pytest.approx(wanted)
    motion[:60, HEELS[0], 2] += 1.0  # while it walks
    motion[:, HEELS[0], 0] += 0.3  # aside
    assert bodies.feet_apart(motion, stands) == pytest.approx(wanted, rel=1e-6)
    with pytest.raises(ValueError, match="stands in no frame"):
        bodies.feet_apart(motion, np.zeros(T, bool))


def test_stiff_elbows_do_not_spread_and_bent_ones_by_their_angle():
    assert bodies.elbow_spread(standing()) < 1e-6
    motion, (shoulder, elbow, hand) = standing(400), bodies.ELBOWS[0]
    angle = np.radians(30) * np.sin(2 * np.pi * 0.25 * np.arange(400) / FPS)  # 0.25 Hz
    upper = motion[0, elbow] - motion[0, shoulder]
    ahead, across = upper / np.linalg.norm(upper), np.array([0.0, 0.0, 1.0])
    along = np.cos(angle)[:, None] * ahead + np.sin(angle)[:, None] * across
    motion[:, hand] = motion[:, elbow] + 0.25 * along
    # the elbow's angle is 180 degrees minus the size of the bend
    wanted = np.degrees(np.abs(angle)).std() / 2  # of two elbows one moves
    assert bodies.elbow_spread(motion) == pytest.approx(wanted, rel=0.05)


def test_a_trunk_leans_by_its_angle():
    motion = standing()
    up = motion[0, bodies.NECK, 1] - motion[0, HIPS, 1]
    motion[:, bodies.NECK] = motion[:, HIPS] + [up * np.tan(np.radians(20)), up, 0]
    assert bodies.trunk_lean(motion) == pytest.approx(20)


def test_accents_are_the_spread_of_speed_between_beats():
    beats = np.arange(0, 10.1, 1.0)
    motion = standing(201)
    speed = np.where(np.arange(200) // 20 % 2, 1.5, 0.5)  # m/s, by turns
    motion[1:, :, 0] += np.cumsum(speed)[:, None] / FPS
    assert bodies.accents(motion, beats) == pytest.approx(0.5, abs=0.1)
    even = standing(201)
    even[:, :, 0] += np.arange(201)[:, None] / FPS
    assert bodies.accents(even, beats) < 0.01
    with pytest.raises(ValueError, match="2 spans between beats"):
        bodies.accents(even, beats[:3])


def test_a_tick_is_the_acceleration_where_keyframes_are():
    t = np.arange(T)
    keys = t % 20 == 0
    motion = standing()
    motion[:, :, 0] += (0.01 * t**2 / 2)[:, None]  # evenly accelerated
    assert bodies.tick_at_keyframes(motion, keys) == pytest.approx(1, rel=1e-6)
    corners = motion + (0.03 * np.cumsum(np.cumsum(keys)))[:, None, None] * [1.0, 0, 0]
    # the second sum bends a frame before the frame that it is added in
    assert bodies.tick_at_keyframes(corners, np.roll(keys, -1)) == pytest.approx(4, rel=1e-6)
    assert bodies.tick_at_keyframes(corners, np.roll(keys, 3)) == pytest.approx(1, rel=1e-6)


def test_a_figure_that_stands_is_still_and_a_walk_is_not():
    assert bodies.still_share(standing()) == 1
    clip = walk(np.tile([1.2, 0.0, 0.0], (T, 1)), seed=0)
    assert bodies.still_share(clip.world()) == 0


@pytest.mark.parametrize(
    "measure",
    [bodies.toe_flutter, bodies.stride_change, bodies.hand_swing, bodies.elbow_spread,
     bodies.trunk_lean, bodies.still_share],
)  # fmt: skip
def test_holes_are_refused(measure):
    motion = standing()
    motion[3, joint_index("LeftHand")] = np.nan
    with pytest.raises(ValueError, match="NaN"):
        measure(motion)
