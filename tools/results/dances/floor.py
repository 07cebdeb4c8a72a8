"""How dances use the floor, beside the data's dances to the same songs."""

import numpy as np
from jaxtyping import Float

from motiondiff_edu.metrics.bodies import standing_feet, travel, turning

from ..walks.scores import Measure, measure_of, ratio

# the measure's name, its unit, and the function of one dance
FLOOR = {
    "standing_feet": ("share", standing_feet),
    "turn_8s_deg": ("deg", turning),
    "travel_mps": ("m/s", travel),
}
OVER_DATA = {  # the names of the ratios
    "standing_feet": "standing_feet_over_data",
    "turn_8s_deg": "turning_over_data",
    "travel_mps": "travel_over_data",
}


def floor_rows(dances: Float[np.ndarray, "N T 21 3"]) -> dict[str, Float[np.ndarray, "N"]]:
    """The measures of each dance, which must last more than 8 s."""
    return {name: np.array([of(one) for one in dances]) for name, (_, of) in FLOOR.items()}


def floor_measures(own: dict[str, np.ndarray], data: dict[str, np.ndarray]) -> list[Measure]:
    """A dancer's means, and those over the data's; rows of `floor_rows`, one for each song."""
    means = [measure_of(name, FLOOR[name][0], np.mean, own[name]) for name in FLOOR]
    ratios = [
        measure_of(over, "ratio", ratio, own[name], data[name]) for name, over in OVER_DATA.items()
    ]
    return means + ratios


def over_genres(values: Float[np.ndarray, "N"], genres: np.ndarray) -> float:
    """The mean over genres of each genre's mean: a frequent genre counts no more than a rare one.

    A genre without a value is left out.
    """
    there = np.isfinite(values)
    means = [values[there & (genres == genre)].mean() for genre in np.unique(genres[there])]
    return float(np.mean(means))


def data_floor_measures(dances: Float[np.ndarray, "N T 21 3"], genres: np.ndarray) -> list[Measure]:
    """The data's own measures, means over genres, and below them those of each genre."""
    rows = floor_rows(dances)
    found = [
        measure_of(name, unit, over_genres, rows[name], genres) for name, (unit, _) in FLOOR.items()
    ]
    return found + [
        measure_of(f"{genre}.{name}", unit, np.mean, rows[name][genres == genre])
        for genre in np.unique(genres)
        for name, (unit, _) in FLOOR.items()
    ]
