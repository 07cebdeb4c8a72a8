"""What does not fit a walker is refused in its own words, before the network sees it."""

import warnings
from types import SimpleNamespace

import numpy as np
import pytest
import torch

from data_synth.walking import walk
from motiondiff_edu.motion.motion import Motion
from motiondiff_edu.pretrained.checkpoints import load
from motiondiff_edu.rollout import check_range, generate

WALKER = SimpleNamespace(config=SimpleNamespace(T_h=4, T_p=2, D=6, C=3))


@pytest.mark.parametrize(
    "past, control, told",
    [
        ((2, 4, 6), (3, 9, 3), r"past \(2, 4, 6\) and control \(3, 9, 3\) do not fit together"),
        ((2, 4, 5), (2, 9, 3), r"the walker takes \(B, 4, 6\)"),
        ((4, 5), (9, 3), r"the walker takes \(B, 4, 6\)"),
        ((4, 6), (1, 9, 3), r"past \(4, 6\) and control \(1, 9, 3\) do not fit together"),
        ((4, 6), (3,), r"past \(4, 6\) and control \(3,\) do not fit together"),
        ((2, 4, 6), (2, 1, 9, 3), r"control \(2, 1, 9, 3\) do not fit together"),
        ((2, 5, 6), (2, 9, 3), "continues 4 past poses, not 5"),
        ((2, 4, 6), (2, 4, 3), "there is none for the future"),
    ],
)
def test_past_and_control_that_do_not_fit_are_named(past, control, told):
    unchecked = getattr(
        generate, "__wrapped__", generate
    )  # as a user calls it, without the tests' type check
    with pytest.raises(ValueError, match=told):
        unchecked(WALKER, torch.zeros(past), torch.zeros(control))


def test_arrays_are_taken_as_they_are_and_the_same_walk_comes_back():
    clip = walk(np.tile([1.0, 0.0, 0.2], (14, 1)), seed=5)
    walker, past = load("walker"), clip.features()[:10]
    new = generate(walker, past, clip.control, seed=1, steps=3)  # float32 poses, float64 control
    same = generate(
        walker, torch.from_numpy(past), torch.from_numpy(clip.control).float(), seed=1, steps=3
    )
    assert new.shape == (4, 63) and torch.equal(new, same)


def test_a_control_beyond_the_training_is_named_by_the_frame_that_it_leads_to():
    """Rows of the past are the recording's own, and nobody can change them."""
    clip = walk(np.tile([1.0, 0.0, 0.2], (14, 1)), seed=5)
    control = clip.control.copy()
    control[3] = 40.0
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        generate(load("walker"), clip.features()[:10], control, steps=1)
    control[12] = 40.0
    with pytest.raises(ValueError, match="a forward speed of 40 in frame 3 of the future"):
        generate(load("walker"), clip.features()[:10], control, steps=1)
    seen = load("walker").card["control_range"]
    with pytest.raises(ValueError, match="a forward speed of 20 in frame 3 .*rate of 40 "):
        check_range(torch.from_numpy(control).float()[None], 10, seen, size=0.5)


def test_own_columns_leave_the_others_their_names():
    seen = {"low": [-1.0, -1, -1, 0.5], "high": [2.0, 1, 1, 0.9]}
    control = torch.zeros(1, 9, 4)
    control[..., 0], control[..., 3] = 3.0, 0.7
    with pytest.warns(UserWarning, match=r"a forward speed of 6 in .*training: -2 to 4"):
        check_range(control, 4, seen, size=2.0)
    control[..., 0], control[..., 3] = 1.0, 1.0
    with pytest.warns(UserWarning, match=r"a column 3 of 1 in .*training: 0.5 to 0.9"):
        check_range(control, 4, seen, size=2.0)


def test_a_small_figure_is_told_of_its_own_speeds():
    motion = Motion(0.6 * walk(np.tile([1.0, 0.0, 0.0], (40, 1)), seed=5).world(), 20.0)
    walker = load("walker")
    with pytest.raises(ValueError, match=r"a forward speed of 6 in frame .*to 1\.8"):
        walker.walk(motion, np.tile([6.0, 0.0, 0.0], (20, 1)), steps=1)
    assert walker.card["control_range"], "the walker itself stays as it was"
