"""What each departure from masked sampling gains: all of them, then all but one.

A network that is shown what is given needs no guidance and no blending. So what these gain is
measured on the network that is not shown it. The gaps, motions and noise are the same for every
row.
Source: MoFusion 4.4, and `motiondiff_edu.beyond`.  Notebook: 15
"""

from dataclasses import replace

import numpy as np
import torch
from jaxtyping import Bool, Float

from motiondiff_edu.editing.inbetween import OURS, PAPER, Departures, inbetween
from motiondiff_edu.metrics.bone_lengths import bone_lengths
from motiondiff_edu.metrics.keyframes import seam_jump, unknown_error
from motiondiff_edu.metrics.skating import skating
from motiondiff_edu.performers.dancer import Dancer

from ..sweep import Rows, Sweep, Variant, minus
from ..walks.scores import Kind, ratio, root_mean
from ..walks.trials import UNSEEN
from .inbetween import InbetweenSize, middle, trials

GAP = 30  # frames

SHOWN, NOT_SHOWN = "inbetweens", "unconditional"  # the networks' names


def row(words: str, departures: Departures, network: str = SHOWN, base: str = "ours") -> Variant:
    """What a row is in words, its network and departures, and the row that it departs from."""
    return Variant(words, (network, departures), {"base": base} if base else {})


VARIANTS = {
    "ours": row("all departures", OURS, base=""),
    "no-bones": row("bones may change their length", replace(OURS, bones=False)),
    "no-feet": row("feet may slide", replace(OURS, feet=False)),
    "no-clearance": row("feet at any height", replace(OURS, clearance=False)),
    "not-shown": row("a network that is not shown what is given", OURS, NOT_SHOWN),
    "no-guidance": row(
        "the same, no guidance", replace(OURS, guidance=0.0), NOT_SHOWN, "not-shown"
    ),
    "no-blending": row("the same, no blending", replace(OURS, blend=None), NOT_SHOWN, "not-shown"),
    "paper": row("none of them: masked sampling", PAPER, NOT_SHOWN),
}
ERROR = Kind("cm", ("error",), np.mean)
SLIDING = Kind("m/s", ("skating",), np.nanmean)
KINDS = {
    "error_one_cm": ERROR,
    "seam_jump_over_data": Kind("ratio", ("seam", "seam_data"), ratio),
    "bone_rmse_cm": Kind("cm", ("bones",), root_mean),
    "skating_mps": SLIDING,
}
DIFFERENCES = {"error_one_minus_{}_cm": minus(ERROR), "skating_minus_{}_mps": minus(SLIDING)}


def sweep(networks: dict[str, tuple[Dancer, str]], size: InbetweenSize) -> Sweep:
    """Nothing is trained: `networks` has each network's dancer and the digest of its weights."""
    truth, known = trials(size.motions), middle(GAP)

    def measure(name: str, dancer: Dancer, seed: int) -> Rows:
        draw = torch.Generator().manual_seed(GAP)
        how = {"samples": size.samples, "steps": size.steps, "generator": draw}
        how["departures"] = VARIANTS[name].recipe[1]
        holes = np.where(known[..., None], truth, np.nan)
        made = np.stack([inbetween(dancer, one, known, **how) for one in holes], 1)
        return rows_of(made, truth, known)

    def about(name: str) -> dict:
        found = {"data": UNSEEN, "motions": size.motions, "samples": size.samples, "gap": GAP}
        return found | {"steps": size.steps, "weights": networks[VARIANTS[name].recipe[0]][1]}

    return Sweep(
        "inbetween-departures", VARIANTS, lambda name, seed: networks[VARIANTS[name].recipe[0]][0],
        measure, KINDS, DIFFERENCES, about,
    )  # fmt: skip


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
