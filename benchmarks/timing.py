"""Runs timed in turn, in changing order.

What else goes on in the machine befalls all of them alike.
"""

import time
from collections.abc import Callable, Mapping

import numpy as np


def in_turn(
    runs: Mapping[str, Callable[[], object]], repeats: int, *, best_of: int = 1, warmup: int = 1
) -> dict[str, np.ndarray]:
    """Milliseconds of every run in every repeat: the best of `best_of`.

    `warmup` repeats before are thrown away.
    """
    times, rng = {name: [] for name in runs}, np.random.default_rng(0)
    for repeat in range(-warmup, repeats):
        for name in rng.permutation(list(runs)):
            best = min(seconds(runs[name]) for _ in range(best_of))
            if repeat >= 0:
                times[name].append(1000 * best)
    return {name: np.array(values) for name, values in times.items()}


def seconds(run: Callable[[], object]) -> float:
    """By the clock on the wall."""
    start = time.perf_counter()
    run()
    return time.perf_counter() - start
