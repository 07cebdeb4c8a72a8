"""The network's own dances, and the same dances as `Dancer.dance` returns them."""

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from motiondiff_edu.performers.dance_windows import FPS
from motiondiff_edu.performers.finished import finished

from ..walks.scores import Measure, measure_of, root_mean, squared_stretch
from .scores import Beats, beat_measures, rows_of

OWN, FINISHED = "own.", "finished."
KINDS = ("bas_share", "speed_over_data", "skating_mps", "bone_rmse_within_clip_cm")


def finishing_measures(
    made: Float[np.ndarray, "R N T 21 3"], data: dict[str, Float[np.ndarray, "N"]], beats: Beats
) -> list[Measure]:
    """KINDS of both, named `own.KIND` and `finished.KIND`; R dances to each song."""
    whole = np.stack([[finished(one, FPS) for one in song] for song in made])
    return [
        replace(measure, name=f"{who}{measure.name}")
        for who, dances in ((OWN, made), (FINISHED, whole))
        for measure in (*beat_measures(rows_of(dances, beats), data), _stretch(dances))
        if measure.name in KINDS
    ]


def _stretch(dances: Float[np.ndarray, "R N T 21 3"]) -> Measure:
    squares = np.mean([squared_stretch(one) for one in dances], axis=0)
    return measure_of("bone_rmse_within_clip_cm", "cm", root_mean, squares)
