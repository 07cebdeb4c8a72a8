"""Notebook 09's checks name the likely mistakes.

An answer in another wrapping is taken.
"""

import pytest
import torch

from motiondiff_edu.course import checks
from motiondiff_edu.course.checks import zoo

CHECKS, WRONG = checks.load_all(), zoo.load_all()

NAMED = [
    ("batch_with_dropout", "the future changed in place", "the data themselves were changed"),
    ("batch_with_dropout", "changed in place", "the data themselves were changed"),
    (
        "batch_with_dropout",
        "noise subtracted",
        "the noised future: the noise is added, not subtracted",
    ),
    (
        "batch_with_dropout",
        "noise subtracted from the past",
        "the past as .* the noise is added, not subtracted",
    ),
    ("batch_with_dropout", "noise of its own", "differs from call to call.* draw nothing"),
    (
        "batch_with_dropout",
        "lists of samples",
        "the past .* is a list of 4 tensors; torch.stack makes one",
    ),
    (
        "dropped_products",
        "noise subtracted",
        "the variance of the noise is added, whatever the noise's sign",
    ),
    ("dropped_products", "mean squared", "not the square of the mean"),
]


@pytest.mark.parametrize(
    "check, what, told", NAMED, ids=[f"{check}: {what}" for check, what, _ in NAMED]
)
def test_the_mistake_is_named(check, what, told):
    with pytest.raises(checks.CheckFailed, match=told) as caught:
        CHECKS[check](WRONG[check][what])
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
    with pytest.raises(checks.CheckFailed, match="return two arrays"):
        CHECKS["batch_with_dropout"](lambda *given: right(*given)[0])
