"""The figures of the exercises' checks, on two exercises; a check that is too lax is seen."""

from contextlib import suppress

import notebook_cells
import pytest

from motiondiff_edu.course import checks
from tools import mutants
from tools.results.course.exercises import Tally, hint_of, tallied


@pytest.fixture
def exercise():
    path = next(path for path in notebook_cells.sources() if path.stem.startswith("02"))
    return next(one for one in mutants.exercises(path) if one.check == "constant_beta")


def test_a_good_check_has_no_faults(exercise):
    tally = Tally()
    tallied(exercise, tally, most=10)
    assert tally.faults == []
    assert tally.counts["mutants"] >= 8 and tally.counts["zoo"] >= 5
    assert tally.counts["right answers"] >= 3 and tally.counts["diagnoses"] >= 6


def test_a_check_that_lets_everything_pass_is_seen(exercise, monkeypatch):
    def lax(mine):
        with suppress(Exception):
            mine(10, 0.3)

    monkeypatch.setitem(checks.load_all(), "constant_beta", lax)
    tally = Tally()
    tallied(exercise, tally, most=10)
    assert 0 < tally.counts["mutants failed"] <= tally.counts["mutants"]
    assert tally.share("zoo") == 1 and tally.share("right answers") == 0
    monkeypatch.setitem(checks.load_all(), "constant_beta", lambda mine: None)
    with pytest.raises(AssertionError, match="constant_beta never asks for an answer"):
        tallied(exercise, Tally(), most=10)


def test_a_check_that_refuses_everything_with_one_hint_is_seen(exercise, monkeypatch):
    def strict(mine):
        raise checks.CheckFailed("constant_beta: beta: that is the amplitude that one step keeps")

    tally = Tally()
    calls = exercise.calls([1])
    monkeypatch.setattr(exercise, "calls", lambda seeds: calls)
    monkeypatch.setitem(checks.load_all(), "constant_beta", strict)
    tallied(exercise, tally, most=10)
    assert tally.counts["right answers failed"] == tally.counts["right answers"] > 0
    assert tally.share("diagnoses") > 0.2


def test_a_hint_is_the_whole_end_of_a_message():
    assert hint_of("q: x_s: take the root", {"take the root": 1, "root": 2}) == "take the root"
    assert hint_of("q: x_s is 3, and should be 4", {"take the root": 1}) is None
