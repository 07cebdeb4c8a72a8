"""MoDiff's Table I and Fig. 3 on the course's data.

Each set of motions has a footstep curve, and a row that is read from it.

The bootstrap draws clips. So every clip is reduced to a table (number of steps, sum and sum of
squares of their durations) at every tolerance; these tables can be added.
"""

import numpy as np
from jaxtyping import Float

from motiondiff_edu.metrics.walks import PAPER, TOLERANCES, StepRule, heel_speed, step_durations

from .scores import Measure, measure_of


def tables(
    poses: Float[np.ndarray, "N T J 3"], control: Float[np.ndarray, "N T 3"], rule: StepRule = PAPER
) -> Float[np.ndarray, "N V 3"]:
    """Number of steps, sum of durations and sum of their squares, for every clip and tolerance."""
    speeds = heel_speed(poses, control)
    durations = [[step_durations([speed], float(v), rule) for v in TOLERANCES] for speed in speeds]
    return np.array([[(len(d), d.sum(), (d**2).sum()) for d in clip] for clip in durations])


def curve(table: Float[np.ndarray, "N V 3"]) -> Float[np.ndarray, "V"]:
    """f_est(v) over all clips."""
    return table[..., 0].sum(0)


def row(table: Float[np.ndarray, "N V 3"]) -> tuple[float, float, float, float]:
    """f_est, v95, mean and std of the durations at v95.

    The same as `metrics.walks.footsteps` on these clips.
    """
    count, total, squares = table.sum(0).T
    at = int(np.argmax(count >= 0.95 * count.max()))
    if count.max() == 0:
        return 0.0, np.nan, np.nan, np.nan
    mean = total[at] / count[at]
    return (
        float(count[at]),
        float(TOLERANCES[at]),
        mean,
        float(np.sqrt(max(squares[at] / count[at] - mean**2, 0))),
    )


def measures(table: Float[np.ndarray, "N V 3"]) -> list[Measure]:
    """The row of Table I as measures with intervals."""
    names = (("f_est", "steps"), ("v95_cmps", "cm/s"), ("mean_s", "s"), ("std_s", "s"))
    return [
        measure_of(name, unit, lambda t, i=i: row(t)[i], table)
        for i, (name, unit) in enumerate(names)
    ]
