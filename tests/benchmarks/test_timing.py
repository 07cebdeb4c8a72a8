"""Timing in turn, by a clock that only the runs themselves move on."""

import sys
from itertools import count
from pathlib import Path

import numpy as np
import pytest

sys.path.append(str(Path(__file__).parents[2] / "benchmarks"))
import timing  # noqa: E402


@pytest.fixture
def runs(monkeypatch):
    """Two runs, and the order in which they were called.

    They take 1, 2, 3 ... and 10, 20, 30 ... seconds.
    """
    now, order = [0.0], []
    monkeypatch.setattr(timing.time, "perf_counter", lambda: now[0])

    def taking(name: str, unit: float):
        times = count(1)

        def run() -> None:
            order.append(name)
            now[0] += unit * next(times)

        return run

    return {"a": taking("a", 1.0), "b": taking("b", 10.0)}, order


def test_the_first_repeats_are_thrown_away_and_all_take_turns(runs):
    times = timing.in_turn(runs[0], 4)
    np.testing.assert_allclose(times["a"], [2000, 3000, 4000, 5000])
    np.testing.assert_allclose(times["b"], [20_000, 30_000, 40_000, 50_000])
    turns = ["".join(runs[1][k : k + 2]) for k in range(0, 10, 2)]
    assert len(runs[1]) == 10 and set(turns) == {
        "ab",
        "ba",
    }  # each once a repeat, not always in one order


def test_the_best_of_three_counts(runs):
    times = timing.in_turn(runs[0], 2, best_of=3, warmup=2)
    np.testing.assert_allclose(
        times["a"], [7000, 10_000]
    )  # of 7, 8, 9 and of 10, 11, 12; 1 to 6 were thrown away
    np.testing.assert_allclose(times["b"], [70_000, 100_000])
