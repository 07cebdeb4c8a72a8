"""What each departure from masked sampling gains: all of them, then all but one.

The gaps, motions and noise are the same for every row.
Source: MoFusion 4.4, and `motiondiff_edu.beyond`.  Notebook: 15
"""

from dataclasses import replace

import numpy as np
import torch
from jaxtyping import Bool, Float

from motiondiff_edu.editing.inbetween import OURS, PAPER, inbetween
from motiondiff_edu.metrics.bone_lengths import bone_lengths
from motiondiff_edu.metrics.keyframes import seam_jump, unknown_error
from motiondiff_edu.metrics.skating import skating
from motiondiff_edu.performers.dancer import Dancer

from ..walks.scores import Measure, measure_of, ratio, root_mean
from ..walks.trials import UNSEEN
from .inbetween import InbetweenSize, middle, trials

GAP = 30  # frames

# name: (what it is, departures)
ROWS = {
    "ours": ("all departures", OURS),
    "no-guidance": ("no guidance", replace(OURS, guidance=0.0)),
    "no-blending": ("no blending", replace(OURS, blend=None)),
    "no-bones": ("bones may change their length", replace(OURS, bones=False)),
    "no-feet": ("feet may slide", replace(OURS, feet=False)),
    "no-clearance": ("feet at any height", replace(OURS, clearance=False)),
    "paper": ("none of them: masked sampling", PAPER),
}


def departure_records(
    dancer: Dancer, weights: str, size: InbetweenSize, command: str
) -> list[dict]:
    """The measures of every row, and those minus the row with all departures."""
    truth, known = trials(size.motions), middle(GAP)
    seeds = {"data": UNSEEN, "motions": size.motions, "samples": size.samples, "weights": weights}
    seeds |= {"steps": size.steps, "gap": GAP}
    base, records = None, []
    for name, (_, departures) in ROWS.items():
        draw = torch.Generator().manual_seed(GAP)
        made = [
            inbetween(
                dancer, np.where(known[..., None], one, np.nan), known, samples=size.samples,
                steps=size.steps, departures=departures, generator=draw,
            )
            for one in truth
        ]  # fmt: skip
        rows = rows_of(np.stack(made, 1), truth, known)
        base = base or rows
        records += [
            one.as_record(f"inbetween-departures.{name}.", seeds, command)
            for one in measures_of(rows, base)
        ]
    return records


def rows_of(
    made: Float[np.ndarray, "S N T J 3"],
    truth: Float[np.ndarray, "N T J 3"],
    known: Bool[np.ndarray, "T J"],
) -> dict[str, np.ndarray]:
    """What is measured of each motion: means over its samples."""
    hole = ~known.any(1)
    given = bone_lengths(truth[:, ~hole]).mean(1)  # (N, bones)
    wrong = 1e4 * ((bone_lengths(made[:, :, hole]) - given[:, None]) ** 2).mean((0, 2, 3))
    first, last = np.flatnonzero(hole)[[0, -1]]
    inside = made[:, :, first - 1 : last + 2]
    sliding = np.stack([skating(one, np.zeros((*one.shape[:2], 3))) for one in inside])
    return {
        "error": np.mean([100 * unknown_error(one, truth, known) for one in made], 0),
        "seam": np.mean([seam_jump(one, known) for one in made], 0),
        "seam_data": seam_jump(truth, known),
        "bones": wrong,
        "skating": np.nanmean(sliding, 0),
    }


def measures_of(rows: dict[str, np.ndarray], base: dict[str, np.ndarray]) -> list[Measure]:
    """Error of a sample, jump at the seams over the data's, bone error, sliding of planted feet."""
    return [
        measure_of("error_one_cm", "cm", np.mean, rows["error"]),
        measure_of("seam_jump_over_data", "ratio", ratio, rows["seam"], rows["seam_data"]),
        measure_of("bone_rmse_cm", "cm", root_mean, rows["bones"]),
        measure_of("skating_mps", "m/s", np.nanmean, rows["skating"]),
        measure_of("error_one_minus_ours_cm", "cm", np.mean, rows["error"] - base["error"]),
        measure_of("skating_minus_ours_mps", "m/s", np.nanmean, rows["skating"] - base["skating"]),
    ]
