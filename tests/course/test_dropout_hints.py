"""Notebook 09's batch: an answer in another wrapping is taken, and one array is not two."""

import pytest
import torch

from motiondiff_edu.course import checks
from motiondiff_edu.course.checks import zoo

CHECKS = checks.load_all()
_, OTHERS = zoo.load_all()


@pytest.mark.parametrize(
    "what, told",
    [
        ("the future changed in place", "your answer changes `future`, which it was given"),
        ("changed in place", "your answer changes `past`, which it was given"),
        ("noise of its own", "differs from call to call.* draw nothing"),
        ("lists of samples", "the past .* is a list of 4 tensors; torch.stack makes one"),
        ("a throw for each frame", "some frames of a past were noised and others not"),
    ],
)
def test_what_is_wrong_is_named(what, told):
    with pytest.raises(checks.CheckFailed, match=told) as caught:
        CHECKS["batch_with_dropout"](OTHERS["batch_with_dropout"][what])
    assert "should be" not in str(caught.value)  # a hint, not two numbers


def right(past, future, s, alpha_bar, rate, u, noise):
    a = alpha_bar[s][:, None, None] ** 0.5
    b = (1 - alpha_bar[s][:, None, None]) ** 0.5
    return torch.where(
        (u < rate)[:, None, None], a * past + b * noise[1], past
    ), a * future + b * noise[0]


@pytest.mark.parametrize(
    "wrap", [tuple, list, torch.stack, lambda pair: [part.numpy() for part in pair]]
)
def test_two_arrays_are_taken_in_any_wrapping(wrap, capsys):
    CHECKS["batch_with_dropout"](lambda *given: wrap(right(*given)))
    assert "batch_with_dropout: right." in capsys.readouterr().out


def test_one_array_is_not_two():
    with pytest.raises(checks.CheckFailed, match="return 2 things: the past"):
        CHECKS["batch_with_dropout"](lambda *given: right(*given)[0])
