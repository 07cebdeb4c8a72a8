"""What each departure from masked sampling gains: all of them, then all but one.

An in-betweener is shown what is given, and needs no guidance and no blending. So what these gain
is measured on the dancer without music, which is not shown it. The gaps, motions and noise are the
same for every row.
Source: MoFusion 4.4, and `motiondiff_edu.beyond`.  Notebook: 15
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Bool, Float

from motiondiff_edu.beyond.guidance import guided
from motiondiff_edu.editing.inbetween import clean_samples, inbetween
from motiondiff_edu.editing.inpaint import WEIGHT, Steer, blend, guide_and_blend, inpaint
from motiondiff_edu.metrics.bone_lengths import bone_lengths
from motiondiff_edu.metrics.keyframes import seam_jump, unknown_error
from motiondiff_edu.metrics.skating import skating
from motiondiff_edu.performers.dancer import Dancer
from motiondiff_edu.performers.inbetweener import Inbetweener

from ..walks.scores import Measure, measure_of, ratio, root_mean
from ..walks.trials import UNSEEN
from .inbetween import InbetweenSize, middle, trials

GAP = 30  # frames

SHOWN, NOT_SHOWN = "inbetweener", "unconditional"  # the networks' names
# (network, positions, known, samples=, steps=, generator=)
Fill = Callable[..., Float[np.ndarray, "S T J 3"]]


def masked(steer: Steer) -> Fill:
    """Masked sampling with a steered denoiser, and the clean-up."""

    def fill(network: Dancer, positions, known, *, samples, steps, generator):
        how = {"samples": samples, "steps": steps, "generator": generator}
        made = inpaint(network, positions, known, steer=steer, **how)
        return clean_samples(made, known)

    return fill


def guide(denoise, schedule, given, known):
    """The guidance of `guide_and_blend` alone."""
    return guided(denoise, schedule, given, known, WEIGHT)


@dataclass(frozen=True)
class Row:
    """What a row is in words, how it fills in, its network, and the row that it departs from."""

    words: str
    fill: Fill
    network: str = SHOWN
    base: str = "ours"


ROWS = {
    "ours": Row("all departures", inbetween),
    "no-clean-up": Row("no clean-up of seams, bones and feet", Inbetweener.fill),
    "not-shown": Row(
        "a network that is not shown what is given", masked(guide_and_blend), NOT_SHOWN
    ),
    "no-guidance": Row("the same, no guidance", masked(blend), NOT_SHOWN, "not-shown"),
    "no-blending": Row("the same, no blending", masked(guide), NOT_SHOWN, "not-shown"),
    "paper": Row("none of them: masked sampling", inpaint, NOT_SHOWN),
}


def departure_records(
    networks: dict[str, tuple[Inbetweener | Dancer, str]], size: InbetweenSize, command: str
) -> list[dict]:
    """The measures of every row, and those minus the row that it departs from.

    `networks` has each network and the digest of its weights.
    """
    truth, known = trials(size.motions), middle(GAP)
    seeds = {"data": UNSEEN, "motions": size.motions, "samples": size.samples}
    seeds |= {"steps": size.steps, "gap": GAP}
    rows, records = {}, []
    for name, row in ROWS.items():
        network, weights = networks[row.network]
        draw = torch.Generator().manual_seed(GAP)
        made = [
            row.fill(
                network, np.where(known[..., None], one, np.nan), known, samples=size.samples,
                steps=size.steps, generator=draw,
            )
            for one in truth
        ]  # fmt: skip
        rows[name] = rows_of(np.stack(made, 1), truth, known)
        records += [
            one.as_record(f"inbetween-departures.{name}.", seeds | {"weights": weights}, command)
            for one in measures_of(rows[name], rows[row.base])
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
        measure_of("error_one_minus_base_cm", "cm", np.mean, rows["error"] - base["error"]),
        measure_of("skating_minus_base_mps", "m/s", np.nanmean, rows["skating"] - base["skating"]),
    ]
