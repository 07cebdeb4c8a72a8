"""What each departure from masked sampling gains: all of them, then all but one.

An in-betweener is shown what is given, and needs no guidance and no blending. So what these gain
is measured on the dancer without music, which is not shown it. The gaps, motions, noise, and the
number of steps are the same for every row; masked sampling needs more than the in-betweener.
Source: MoFusion 4.4, and `motiondiff_edu.beyond`.  Notebook: 15
"""

from collections.abc import Callable

import numpy as np
import torch
from jaxtyping import Bool, Float

from motiondiff_edu.beyond.guidance import guided
from motiondiff_edu.editing.inbetween import clean_samples, inbetween
from motiondiff_edu.editing.inpaint import WEIGHT, Steer, blend, guide_and_blend, inpaint
from motiondiff_edu.metrics.bodies import bone_lengths
from motiondiff_edu.metrics.keyframes import seam_jump, unknown_error
from motiondiff_edu.metrics.walks import skating
from motiondiff_edu.performers.dancer import Dancer
from motiondiff_edu.performers.inbetweener import Inbetweener

from ..sweep import Rows, Sweep, Variant, minus
from ..walks.scores import Kind, ratio, root_mean
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


def row(words: str, fill: Fill, network: str = SHOWN, base: str = "ours") -> Variant:
    """What a row is in words, its network and how it fills in, and the row that it departs from."""
    return Variant(words, (network, fill), {"base": base} if base else {})


VARIANTS = {
    "ours": row("all departures", inbetween, base=""),
    "no-clean-up": row("no clean-up of seams, bones and feet", Inbetweener.fill),
    "not-shown": row(
        "a network that is not shown what is given", masked(guide_and_blend), NOT_SHOWN
    ),
    "no-guidance": row("the same, no guidance", masked(blend), NOT_SHOWN, "not-shown"),
    "no-blending": row("the same, no blending", masked(guide), NOT_SHOWN, "not-shown"),
    "paper": row("none of them: masked sampling", inpaint, NOT_SHOWN),
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


def sweep(networks: dict[str, tuple[Inbetweener | Dancer, str]], size: InbetweenSize) -> Sweep:
    """Nothing is trained: `networks` has each network and the digest of its weights."""
    truth, known = trials(size.motions), middle(GAP)

    def measure(name: str, network: Inbetweener | Dancer, seed: int) -> Rows:
        draw = torch.Generator().manual_seed(GAP)
        how = {"samples": size.samples, "steps": size.masked_steps, "generator": draw}
        fill = VARIANTS[name].recipe[1]
        holes = np.where(known[..., None], truth, np.nan)
        made = np.stack([fill(network, one, known, **how) for one in holes], 1)
        return rows_of(made, truth, known)

    def about(name: str) -> dict:
        found = {"data": UNSEEN, "motions": size.motions, "samples": size.samples, "gap": GAP}
        return found | {
            "steps": size.masked_steps,
            "weights": networks[VARIANTS[name].recipe[0]][1],
        }

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
