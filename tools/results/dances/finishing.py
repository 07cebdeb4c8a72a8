"""The network's dances as `Dancer.dance` returns them."""

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from motiondiff_edu.motion.cleanup import Body, clean_up
from motiondiff_edu.performers.dance_windows import FPS

from ..walks.scores import Measure
from .scores import Beats, beat_measures, bone_measure, rows_of

FINISHED = "finished."
KINDS = ("bas_share", "speed_over_data", "skating_mps", "bone_rmse_cm")


def finishing_measures(
    made: Float[np.ndarray, "R N T 21 3"],
    bones: Float[np.ndarray, "20"] | None,
    data: dict[str, Float[np.ndarray, "N"]],
    beats: Beats,
) -> list[Measure]:
    """The KINDS of finished dances, named `finished.KIND`; R dances to each song."""
    whole = np.stack(
        [[clean_up(one, FPS, body=Body.of(one, bones=bones)) for one in song] for song in made]
    )
    return [
        replace(measure, name=f"{FINISHED}{measure.name}")
        for measure in (*beat_measures(rows_of(whole, beats), data), bone_measure(whole)[0])
        if measure.name in KINDS
    ]
