"""Measures of repairs, on motions whose errors are put there by hand."""

import numpy as np
import pytest

from data_synth.walking import walk
from motiondiff_edu.metrics import keyframes
from motiondiff_edu.motion.skeleton import joint_index

TRUTH = walk(np.tile([1.1, 0.0, 0.0], (12, 1)), seed=4).poses[:7]
HAND = joint_index("RightHand")
FOREARM = joint_index("RightForeArm")
KNOWN = np.ones((7, 21), bool)
KNOWN[2:5, HAND] = False


def test_only_what_was_missing_is_measured():
    made = TRUTH + 1.0  # far off everywhere: what was given does not count
    made[2:5, HAND] = TRUTH[2:5, HAND] + [0.03, 0.0, 0.04]
    assert keyframes.missing_error(made, TRUTH, KNOWN) == pytest.approx(5.0)
    made[4, HAND] = TRUTH[4, HAND]
    assert keyframes.missing_error(made, TRUTH, KNOWN) == pytest.approx(10 / 3)


def test_several_repairs_share_a_mask_and_their_mean_is_never_farther():
    rng = np.random.default_rng(0)
    samples = TRUTH + rng.normal(0, 0.05, (5, *TRUTH.shape))
    one, mean = (keyframes.missing_error(x, TRUTH, KNOWN) for x in (samples, samples.mean(0)))
    each = [keyframes.missing_error(x, TRUTH, KNOWN) for x in samples]
    assert one == pytest.approx(np.mean(each)) and mean < one


def test_bones_with_a_missing_end_are_those_of_the_hand():
    made = TRUTH.copy()
    elbow = TRUTH[:, FOREARM]
    made[:, HAND] = elbow + 1.2 * (
        TRUTH[:, HAND] - elbow
    )  # the forearm a fifth too long: 25 cm, so 5 cm
    fingers = np.linalg.norm(made[2:5, HAND + 1] - made[2:5, HAND], axis=-1) - 0.09
    wanted = 100 * np.sqrt((3 * 0.05**2 + (fingers**2).sum()) / 6)
    assert keyframes.joined_bones(made, KNOWN) == pytest.approx(wanted)
    assert keyframes.joined_bones(TRUTH, KNOWN) < 1e-9


def test_a_still_hand_takes_no_steps():
    made = TRUTH.copy()
    made[:, HAND] = [0.1, 1.0, 0.2]
    assert keyframes.missing_step(made, KNOWN) == 0
    made[3, HAND, 1] += 0.06  # up and down again: two of the four steps that begin or end in a hole
    assert keyframes.missing_step(made, KNOWN) == pytest.approx(3.0)


def test_spread_is_the_deviation_from_the_mean():
    samples = np.stack([TRUTH, TRUTH, TRUTH])
    samples[0, :, HAND] += [0.02, 0, 0]
    samples[2, :, HAND] -= [0.02, 0, 0]
    assert keyframes.missing_spread(samples, KNOWN) == pytest.approx(2.0)
    with pytest.raises(ValueError, match="at least 2 repairs"):
        keyframes.missing_spread(samples[:1], KNOWN)


@pytest.mark.parametrize(
    "measure",
    [
        lambda known: keyframes.missing_error(TRUTH, TRUTH, known),
        lambda known: keyframes.joined_bones(TRUTH, known),
        lambda known: keyframes.missing_step(TRUTH, known),
        lambda known: keyframes.missing_spread(np.stack([TRUTH, TRUTH]), known),
    ],
)
def test_without_holes_there_is_nothing_to_measure(measure):
    with pytest.raises(ValueError, match="nothing is missing"):
        measure(np.ones_like(KNOWN))
