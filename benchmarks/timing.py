"""Time runs in turn, in changing order.

So other load of the machine affects all of them alike.
"""

import time
from collections.abc import Callable, Mapping

import numpy as np


def in_turn(
    runs: Mapping[str, Callable[[], object]], repeats: int, *, best_of: int = 1, warmup: int = 1
) -> dict[str, np.ndarray]:
    """Milliseconds of every run in every repeat: the best of `best_of`.

    The `warmup` repeats before them are not counted.
    """
    times, rng = {name: [] for name in runs}, np.random.default_rng(0)
    for repeat in range(-warmup, repeats):
        for name in rng.permutation(list(runs)):
            best = min(seconds(runs[name]) for _ in range(best_of))
            if repeat >= 0:
                times[name].append(1000 * best)
    return {name: np.array(values) for name, values in times.items()}


def seconds(run: Callable[[], object]) -> float:
    """Wall-clock seconds of one call."""
    start = time.perf_counter()
    run()
    return time.perf_counter() - start
