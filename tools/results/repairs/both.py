"""Both papers' repairs on the same holes.

There-and-back by a walker (III-E), masking by the unconditional net (4.4).

Both see what is left of ten past frames, and where the walk goes during them and the ten after. The
walker has that as its control, the other network as the pelvis' own path (height and sway included)
in a window of 20 frames: so the pelvis is not scored.
Source: MoDiff III-E; MoFusion 4.4.  Notebook: 15
"""

from dataclasses import replace

import numpy as np
import torch
from jaxtyping import Bool, Float

from motiondiff_edu.beyond.back_with_known import masked_way_back
from motiondiff_edu.editing.inpaint import guide_and_blend, inpaint
from motiondiff_edu.motion.root_frame import to_world
from motiondiff_edu.motion.skeleton import HIPS, J
from motiondiff_edu.performers.dancer import STEPS, Dancer
from motiondiff_edu.performers.walker import Walker
from motiondiff_edu.pretrained import checkpoints
from motiondiff_edu.reconstruction import plain_way_back

from ..inbetweens.departures import Fill
from ..inbetweens.departures import masked as masked_and_corrected
from ..walks.parts import Bench, weights_digest
from ..walks.scores import Measure, measure_of
from ..walks.trials import UNSEEN, Trials
from .repair import FAULTS, RepairSize, repaired, root_nanmean, squared_errors

WALKER = "mend-dropout-0"
WINDOW, CLIPS = 20, 20  # frames that the masking network sees; pasts that are repaired


def masked_window(
    trials: Trials, known: Bool[np.ndarray, "N T_h J"]
) -> tuple[Float[np.ndarray, "N W J 3"], Bool[np.ndarray, "N W J"]]:
    """The same pasts in the world, what is known of them, and the pelvis' path.

    The path is as long as a walker has control.
    """
    T_h = known.shape[1]
    poses = np.concatenate([trials.past, trials.truth], 1)[:, :WINDOW]
    world = np.stack(
        [
            to_world(one, control[:WINDOW])
            for one, control in zip(poses, trials.control, strict=True)
        ]
    )
    seen = np.zeros((len(known), WINDOW, J), bool)
    seen[:, :T_h] = known
    seen[:, : 2 * T_h, HIPS] = True
    return world, seen


def masked(
    dancer: Dancer,
    world: Float[np.ndarray, "N W J 3"],
    known: Bool[np.ndarray, "N W J"],
    samples: int,
    fill: Fill = inpaint,
) -> Float[np.ndarray, "samples N W J 3"]:
    """So many repairs of each of `masked_window`'s pasts by masked sampling, or `fill`."""
    draw = torch.Generator().manual_seed(0)
    holes = np.where(known[..., None], world, np.nan)
    options = {"samples": samples, "steps": STEPS, "generator": draw}
    made = [fill(dancer, one, seen, **options) for one, seen in zip(holes, known, strict=True)]
    return np.stack(made, 1)


def both_measures(
    walker: Walker, dancer: Dancer, trials: Trials, size: RepairSize
) -> list[Measure]:
    """For each fault and way: the error of the mean of the repairs, and of one of them, cm."""
    few, corrected = trials.first(CLIPS), masked_and_corrected(guide_and_blend)
    found = []
    for fault, break_it in FAULTS.items():
        broken = break_it(few.past)
        world, known = masked_window(few, broken.known)
        T_h = few.past.shape[1]
        judged = replace(broken, known=broken.known | (np.arange(J) == HIPS))
        ways = {
            "there_and_back": (repaired(walker, few, broken, size, plain_way_back), few.past),
            "there_and_back_masked": (
                repaired(walker, few, broken, size, masked_way_back),
                few.past,
            ),
            "masked": (masked(dancer, world, known, size.samples)[:, :, :T_h], world[:, :T_h]),
            "masked_blended": (
                masked(dancer, world, known, size.samples, corrected)[:, :, :T_h],
                world[:, :T_h],
            ),
        }
        for way, (made, truth) in ways.items():
            for kind, guess in (("mean", made.mean(0)), ("one", made[0])):
                rows = squared_errors(guess, truth, judged)
                found.append(measure_of(f"{fault}.{way}.{kind}_cm", "cm", root_nanmean, rows))
    return found


def both_records(bench: Bench, dancer: Dancer, size: RepairSize, command: str) -> list[dict]:
    """The measures as records."""
    walker = checkpoints.load(bench.weights[WALKER])
    seeds = {"data": UNSEEN, "clips": CLIPS, "samples": size.samples, "rounds": size.rounds}
    seeds |= {
        "weights": [weights_digest(bench.weights[name]) for name in (WALKER, "unconditional")]
    }
    found = both_measures(walker, dancer, bench.trials, size)
    return [measure.as_record("mend-both.", seeds, command) for measure in found]
