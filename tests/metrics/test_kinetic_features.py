"""Kinetic features.

Values of the public code, movements whose energy is known, and the fault in plain view.
"""

import numpy as np
import pytest

from motiondiff_edu.metrics.distributions import (
    from_the_origin,
    kinetic_features,
    published_kinetic_features,
)
from motiondiff_edu.motion.formats.aist import read_keypoints

TIMES = np.arange(91) / 60


def straight(velocity, start=(0.0, 0.0, 0.0)):
    """One joint at constant velocity, 60 frames/s."""
    return (np.array(start) + TIMES[:, None] * velocity)[:, None]


def circle(radius=0.3, hz=1.0, centre=(0.0, 0.0, 0.0)):
    angle = 2 * np.pi * hz * TIMES
    return (np.array(centre) + radius * np.stack([np.cos(angle), np.zeros(91), np.sin(angle)], -1))[
        :, None
    ]


def test_the_public_codes_values_of_a_recorded_dance(real_data):
    clip = read_keypoints(real_data / "aist" / "keypoints3d" / "gBR_sBM_cAll_d06_mBR2_ch06.pkl")
    stored = clip.positions + [
        0.0,
        clip.floor,
        0.0,
    ]  # the published value is of the file's own heights
    features = published_kinetic_features(stored[:120], 60)
    assert features.shape == (51,)
    np.testing.assert_allclose(features[:3], [0.597739, 0.441263, 7159.05], rtol=1e-3)
    np.testing.assert_allclose(features.sum(), 100400.234, rtol=1e-3)
    mended = kinetic_features(stored[:120], 60).reshape(-1, 3)
    np.testing.assert_allclose(mended[:, :2], features.reshape(-1, 3)[:, :2], rtol=1e-12)
    assert (mended[:, 2] < 100).all() and (
        features[2::3] > 1000
    ).all()  # m/s^2, and what is called so


@pytest.mark.parametrize("features", [kinetic_features, published_kinetic_features])
def test_constant_velocities_have_known_energies(features):
    np.testing.assert_allclose(features(straight([2.0, 0.0, 0.0]), 60)[:2], [4.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(features(straight([0.0, 1.0, 0.0]), 60)[:2], [0.0, 1.0], atol=1e-9)
    np.testing.assert_allclose(features(straight([1.2, 0.5, 1.6]), 60)[:2], [4.0, 0.25], atol=1e-9)


def test_constant_velocity_takes_no_acceleration_but_has_some_as_published():
    assert kinetic_features(straight([2.0, 0.0, 0.0]), 60)[2] < 1e-9
    # by hand: a[k] = (v - (p[k] - 60 p[k-1])) 60 = 60 (59 p[k-1] + v - v/60), which grows with p
    a = 60 * (59 * 2 * TIMES[:-2] + 2 - 2 / 60)
    within = np.arange(len(a))[None] - np.arange(90)[:, None]
    windows = np.where(np.abs(within) <= 2, 1.0, 0.0)
    by_hand = (windows @ a / windows.sum(1)).mean()
    assert published_kinetic_features(straight([2.0, 0.0, 0.0]), 60)[2] == pytest.approx(
        by_hand, rel=1e-9
    )


def test_a_circle_has_the_energies_and_the_acceleration_of_a_circle():
    speed, acceleration = 2 * np.pi * 0.3, 4 * np.pi**2 * 0.3
    horizontal, vertical, expenditure = kinetic_features(circle(), 60)
    assert horizontal == pytest.approx(speed**2, rel=0.03) and vertical == 0
    assert expenditure == pytest.approx(
        acceleration, rel=0.03
    )  # the average over five frames takes some of it off


def test_where_the_dancer_stands_matters_to_the_published_form_alone():
    near, far = circle(), circle(centre=(3.0, 0.0, 0.0))
    np.testing.assert_allclose(kinetic_features(near, 60), kinetic_features(far, 60), rtol=1e-9)
    low = published_kinetic_features(near, 60)
    high = published_kinetic_features(far, 60)
    np.testing.assert_allclose(low[:2], high[:2], rtol=1e-9)
    assert high[2] / low[2] > 8
    # 59 * 60 * |p| for a joint that does not move at all
    still = np.tile([3.0, 0.0, 4.0], (91, 1))[:, None]
    assert published_kinetic_features(still, 60)[2] == pytest.approx(59 * 60 * 5.0)
    assert np.abs(kinetic_features(still, 60)).max() == 0


def test_the_origin_put_under_the_first_root_takes_away_the_place_but_not_the_way():
    moved = from_the_origin(circle(centre=(3.0, 1.0, -2.0)))
    np.testing.assert_allclose(moved, from_the_origin(circle()), atol=1e-12)
    assert np.abs(moved[0, 0]).max() == 0
    away = published_kinetic_features(
        from_the_origin(straight([2.0, 0.0, 0.0], (5.0, 1.0, 0.0))), 60
    )
    assert away[2] > 1000


def test_features_go_joint_by_joint_and_twenty_frames_a_second_are_resampled():
    two = np.concatenate([straight([2.0, 0.0, 0.0]), straight([0.0, 1.0, 0.0])], 1)
    features = kinetic_features(two, 60)
    np.testing.assert_allclose(features[[0, 1, 3, 4]], [4.0, 0.0, 0.0, 1.0], atol=1e-9)
    coarse = np.concatenate([circle(hz=0.7), circle(hz=1.3)], 1)
    np.testing.assert_allclose(
        kinetic_features(coarse[::3], 20), kinetic_features(coarse, 60), rtol=0.01, atol=1e-6
    )


def test_two_frames_have_no_acceleration():
    with pytest.raises(ValueError, match="three frames"):
        kinetic_features(circle()[:2], 60)
