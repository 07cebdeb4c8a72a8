"""In-betweens of unseen walks and dances at gaps of 5 to 60 frames.

They are compared with interpolation and with sampling without a mask.

The network of `md.inbetween` is shown what is given (`performers.inbetweener`). The paper's masked
sampling, of the network that knows nothing of it, is measured as well.
Source: MoFusion 4.4; what is measured, `metrics.keyframes`.  Notebook: 15
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import torch
from jaxtyping import Bool, Float

from data_synth.mixed import motions
from motiondiff_edu.baselines.interpolation import linear, spherical
from motiondiff_edu.editing.inbetween import inbetween
from motiondiff_edu.editing.inpaint import inpaint
from motiondiff_edu.editing.masks import gap
from motiondiff_edu.metrics.keyframes import keyframe_error, npss_parts, seam_jump, unknown_error
from motiondiff_edu.metrics.walks import skating
from motiondiff_edu.motion.dance_frame import at_origin
from motiondiff_edu.performers import dancer
from motiondiff_edu.performers.dancer import Dancer
from motiondiff_edu.performers.inbetweener import Inbetweener
from motiondiff_edu.performers.performer import STEPS

from ..walks.scores import Measure, measure_of, ratio
from ..walks.trials import MORE_STEPS, UNSEEN

T = 100  # frames, as trained
GAPS = (5, 15, 30, 60)
BARS = (15, 30, 60)  # gaps that have a bar
COMPARED = 30  # frames of the gaps that are also filled with MORE_STEPS
OF_SAMPLES = ("error_cm", "error_one_cm", "error_best_cm", "seam_jump_over_data", "skating_mps")


@dataclass(frozen=True)
class InbetweenSize:
    """The amount of measurement.

    It has the number of motions (half walks, half dances), of samples of each and of DDIM's steps.
    """

    motions: int = 12
    samples: int = 10
    steps: int = STEPS
    masked_steps: int = dancer.STEPS  # of masked sampling


FULL = InbetweenSize()
QUICK = InbetweenSize(motions=4, samples=3, steps=4, masked_steps=4)


def trials(n: int) -> Float[np.ndarray, "N T J 3"]:
    """Unseen motions, from their own beginning; walks and dances alternate."""
    made = motions(n, UNSEEN, seconds=8.0)
    return np.stack([at_origin(positions[30 : 30 + T]) for positions, _ in made])


def middle(length: int) -> Bool[np.ndarray, "T J"]:
    """The mask of a gap of `length` frames in the middle."""
    return gap(T, (T - length) // 2, length)


@dataclass(frozen=True, eq=False)
class Filled:
    """The results for gaps of one length: samples (samples, motions, frames, joints, 3), and those
    of interpolation.
    """

    known: Bool[np.ndarray, "T J"]
    truth: Float[np.ndarray, "N T J 3"]
    made: Float[np.ndarray, "S N T J 3"]
    masked: Float[np.ndarray, "N T J 3"]  # one sample as in the paper, nothing blended
    free: Float[np.ndarray, "N T J 3"]  # sampled without the mask
    lines: Float[np.ndarray, "N T J 3"]
    arcs: Float[np.ndarray, "N T J 3"]


def filled(
    shown: Inbetweener,
    masked: Dancer,
    truth: Float[np.ndarray, "N T J 3"],
    length: int,
    size: InbetweenSize,
) -> Filled:
    """The gap of every motion, filled by all methods.

    `shown`: the network that is shown what is given; `masked`: the one of masked sampling.
    """
    known, draw = middle(length), torch.Generator().manual_seed(length)
    options = {"steps": size.masked_steps, "generator": draw}
    made = samples_of(shown, truth, known, size, draw)
    holes = np.where(known[..., None], truth, np.nan)
    paper = [inpaint(masked, one, known, **options)[0] for one in holes]
    free = [inpaint(masked, one, np.zeros_like(known), **options)[0] for one in truth]
    flat = [[fill(one, known) for one in truth] for fill in (linear, spherical)]
    return Filled(known, truth, made, *map(np.stack, (paper, free, *flat)))


def samples_of(
    shown: Inbetweener,
    truth: Float[np.ndarray, "N T J 3"],
    known: Bool[np.ndarray, "T J"],
    size: InbetweenSize,
    draw: torch.Generator,
) -> Float[np.ndarray, "S N T J 3"]:
    """What the network that is shown what is given makes of every motion."""
    how = {"samples": size.samples, "steps": size.steps, "generator": draw}
    holes = np.where(known[..., None], truth, np.nan)
    return np.stack([inbetween(shown, one, known, **how) for one in holes], 1)


def measures_of(one: Filled) -> list[Measure]:
    """Errors, spectra and seams of one gap, each with its interval over motions.

    Errors in metres become centimetres.
    """

    def error(made: np.ndarray) -> np.ndarray:
        return 100 * unknown_error(made, one.truth, one.known)

    single = np.stack([error(sample) for sample in one.made])
    mean = error(one.made.mean(0))
    straight = error(one.lines)
    arcs = error(one.arcs)
    rival, rival_rows = min((("lines", straight), ("arcs", arcs)), key=lambda pair: pair[1].mean())
    own, straight_seam, masked_seam = (
        seam_jump(x, one.known) for x in (one.truth, one.lines, one.masked)
    )
    seam = np.mean([seam_jump(sample, one.known) for sample in one.made], 0)
    kept = np.max([keyframe_error(sample, one.truth, one.known) for sample in one.made], 0)
    found = [
        measure_of("error_cm", "cm", np.mean, mean),
        measure_of("error_one_cm", "cm", np.mean, single.mean(0)),
        measure_of("error_best_cm", "cm", np.mean, single.min(0)),
        measure_of("error_lines_cm", "cm", np.mean, straight),
        measure_of("error_arcs_cm", "cm", np.mean, arcs),
        measure_of("error_masked_cm", "cm", np.mean, error(one.masked)),
        measure_of("error_free_cm", "cm", np.mean, error(one.free)),
        measure_of("error_over_interpolation", "ratio", ratio, mean, rival_rows),
        measure_of("error_one_over_interpolation", "ratio", ratio, single.mean(0), rival_rows),
        measure_of("error_best_over_interpolation", "ratio", ratio, single.min(0), rival_rows),
        measure_of("seam_jump_over_data", "ratio", ratio, seam, own),
        measure_of("seam_jump_lines_over_data", "ratio", ratio, straight_seam, own),
        measure_of("seam_jump_masked_over_data", "ratio", ratio, masked_seam, own),
        measure_of("keyframe_error_cm", "cm", lambda x: 100 * np.max(x), kept),
        *spectra(one, rival),
        *sliding(one),
    ]
    return found


def within(one: Filled, positions: np.ndarray) -> np.ndarray:
    """The gap, and a frame on either side of it."""
    first, last = np.flatnonzero(~one.known.any(1))[[0, -1]]
    return positions[..., first - 1 : last + 2, :, :]


def sliding(one: Filled) -> list[Measure]:
    """How fast planted toes slide within the gap, m/s, in one sample of each motion.

    Clips without planted toes are left out.
    """
    made = {"": one.made[0], "_masked": one.masked, "_lines": one.lines, "_data": one.truth}
    return [
        measure_of(f"skating{name}_mps", "m/s", np.nanmean, skating(x, np.zeros((*x.shape[:2], 3))))
        for name, x in ((name, within(one, x)) for name, x in made.items())
    ]


def spectra(one: Filled, rival: str) -> list[Measure]:
    """NPSS of single samples (their mean), of interpolation, and their ratio.

    NPSS is of joint positions. There the mean position outweighs all movement, so the ratio is
    also given for velocities within the gap.
    """
    arrays = (one.truth, getattr(one, rival), *one.made)
    places, weight = parts(arrays)
    velocities, weight_v = parts([np.diff(within(one, x), axis=1) for x in arrays])
    return [
        measure_of("npss", "", ratio_of_sums, places[1], weight),
        measure_of("npss_interpolation", "", ratio_of_sums, places[0], weight),
        measure_of("npss_over_interpolation", "ratio", ratio_of_sums, *places[::-1]),
        measure_of("npss_velocity_over_interpolation", "ratio", ratio_of_sums, *velocities[::-1]),
    ]


def parts(arrays: Sequence[np.ndarray]) -> tuple[tuple[np.ndarray, np.ndarray], np.ndarray]:
    """NPSS' sums over each motion and their weights, for interpolation and for the samples' mean.

    The bootstrap can draw sums a thousand times; it could not recompute spectra.
    """
    truth, *others = (x.reshape(*x.shape[:2], -1) for x in arrays)
    sums = [npss_parts(x, truth) for x in others]
    return (sums[0][0], np.mean([moved for moved, _ in sums[1:]], 0)), sums[0][1]


def ratio_of_sums(above: np.ndarray, below: np.ndarray) -> float:
    return float(above.sum() / below.sum())


def inbetween_records(
    shown: tuple[Inbetweener, str], masked: tuple[Dancer, str], size: InbetweenSize, command: str
) -> list[dict]:
    """The records of all gaps; the worst spectrum and seam also have their own names.

    Each network with the digest of its weights.
    """
    truth = trials(size.motions)
    (ours, weights), (paper, paper_weights) = shown, masked
    seeds = {"data": UNSEEN, "motions": size.motions, "samples": size.samples, "weights": weights}
    seeds |= {"masked": paper_weights}
    seeds |= {"steps": size.steps, "masked_steps": size.masked_steps}
    records: list[dict] = []
    every, fills = {}, {}
    for length in GAPS:
        fills[length] = filled(ours, paper, truth, length, size)
        every[length] = {measure.name: measure for measure in measures_of(fills[length])}
        records += [
            f.as_record(f"inbetween.gap{length}.", seeds, command) for f in every[length].values()
        ]
    draw, finer = torch.Generator().manual_seed(COMPARED), replace(size, steps=MORE_STEPS)
    made = samples_of(ours, truth, middle(COMPARED), finer, draw)
    prefix = f"inbetween.steps{MORE_STEPS}.gap{COMPARED}."
    records += [
        one.as_record(prefix, seeds | {"steps": MORE_STEPS}, command)
        for one in measures_of(replace(fills[COMPARED], made=made))
        if one.name in OF_SAMPLES
    ]
    barred = {
        f"gap{length}_error_over_interpolation": every[length]["error_over_interpolation"]
        for length in BARS
    }
    for kind in ("npss_over_interpolation", "seam_jump_over_data", "keyframe_error_cm"):
        barred[kind] = max(
            (found[kind] for found in every.values()), key=lambda measure: measure.value
        )
    return records + [
        f.as_record("inbetween.", seeds, command) | {"name": f"inbetween.{n}"}
        for n, f in barred.items()
    ]
