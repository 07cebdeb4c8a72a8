"""How the tests check shapes: a function's first calls in each test, then one of many."""

from dataclasses import dataclass

import jaxtyping
import numpy as np
import pytest
import torch
from jaxtyping import Float
from typecheck import EVERY, FIRST, checked

from motiondiff_edu.ddpm import make_schedule


@jaxtyping.jaxtyped(typechecker=checked)
def doubled(x: Float[np.ndarray, "n"]) -> Float[np.ndarray, "n"]:
    return x * 2


def wrong() -> bool:
    """Whether a wrong shape is noticed, or an error for want of it comes from the sum."""
    try:
        doubled(np.zeros((2, 2)))
    except jaxtyping.TypeCheckError:
        return True
    return False


@pytest.mark.parametrize("again", [1, 2])
def test_the_first_calls_in_each_test_are_checked(again):
    assert all(wrong() for _ in range(FIRST)) and not wrong()


def test_of_later_calls_one_in_many_is_checked():
    noticed = [wrong() for _ in range(FIRST + 4 * EVERY)]
    assert sum(noticed[FIRST:]) == 4


def test_what_comes_back_is_checked():
    @jaxtyping.jaxtyped(typechecker=checked)
    def longer(x: Float[np.ndarray, "n"]) -> Float[np.ndarray, "n"]:
        return np.append(x, 0.0)

    with pytest.raises(jaxtyping.TypeCheckError):
        longer(np.zeros(3))


def test_what_a_dataclass_is_made_of_is_checked_likewise():
    @jaxtyping.jaxtyped(typechecker=checked)
    @dataclass
    class Row:
        x: Float[np.ndarray, "n"]

    for _ in range(FIRST):
        with pytest.raises(jaxtyping.TypeCheckError):
            Row(np.zeros((2, 2)))
    assert Row(np.zeros((2, 2))).x.shape == (2, 2)
    assert Row(x=np.ones(3)) and Row.__init__.__wrapped__


def test_a_wrong_shape_in_the_package_is_noticed():
    with pytest.raises(jaxtyping.TypeCheckError):
        make_schedule(torch.full((3, 2), 0.1))
