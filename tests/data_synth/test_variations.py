"""Motion with other poses: legs and bones stay, the upper body is turned or another's."""

import numpy as np
import pytest

from data_synth.levels import LEGS
from data_synth.mixed import motions
from data_synth.variations import UPPER, below_of, limbs_turned, with_upper_body_of
from motiondiff_edu.metrics.bone_lengths import bone_lengths
from motiondiff_edu.motion.dance_frame import facing
from motiondiff_edu.motion.skeleton import HIPS, JOINTS, J, joint_index


@pytest.fixture(scope="module")
def two() -> list[np.ndarray]:
    """A walk of eight seconds, and a dance of six."""
    walk, dance = (positions for positions, _ in motions(2, 5, 8.0))
    return [walk, dance[:120]]


def test_what_hangs_on_a_joint_is_all_of_its_limb():
    assert [JOINTS[joint] for joint in below_of(joint_index("LeftArm"))] == [
        "LeftForeArm", "LeftHand", "LeftHandIndex1",
    ]  # fmt: skip
    assert set(below_of(joint_index("Spine"))) == set(UPPER) - {joint_index("Spine")}


def test_limbs_turn_and_legs_and_bones_stay(two):
    for seed, positions in enumerate(two):
        moved = limbs_turned(positions, np.random.default_rng(seed))
        np.testing.assert_allclose(moved[:, [HIPS, *LEGS]], positions[:, [HIPS, *LEGS]], atol=1e-9)
        np.testing.assert_allclose(bone_lengths(moved), bone_lengths(positions), atol=1e-9)
        hands = [joint_index("LeftHand"), joint_index("RightHand")]
        assert np.linalg.norm(moved - positions, axis=-1)[:, hands].max(0).min() > 0.03
        assert np.array_equal(moved, limbs_turned(positions, np.random.default_rng(seed)))
        fastest = [np.abs(np.diff(one, n=2, axis=0)).max() for one in (positions, moved)]
        assert fastest[1] < fastest[0] + 0.1, "turns come and go smoothly"


def test_the_upper_body_is_the_others_and_faces_the_way_of_the_legs(two):
    legs, upper = two
    moved = with_upper_body_of(legs, upper)
    assert len(moved) == 160 and len(with_upper_body_of(upper, legs)) == 120
    np.testing.assert_allclose(moved[:, [HIPS, *LEGS]], legs[:, [HIPS, *LEGS]], atol=1e-9)
    np.testing.assert_allclose(bone_lengths(moved), bone_lengths(legs), atol=1e-9)
    moved = moved[:120]
    head = joint_index("Head")
    ahead = [
        np.einsum(
            "ti,ti->t", one[:, head] - one[:, HIPS], np.stack([np.sin(f), 0 * f, np.cos(f)], -1)
        )
        for one, f in ((moved, facing(moved)), (upper, facing(upper)))
    ]
    np.testing.assert_allclose(*ahead, atol=1e-9)
    assert len(UPPER) + len(LEGS) + 1 == J
