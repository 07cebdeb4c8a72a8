"""The measures of one row: what is recognised, how near texts and motions are, and the body."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from data_synth.actions.neighbours import KINDS
from motiondiff_edu.metrics import diversity, frechet
from motiondiff_edu.metrics.actions import actions
from motiondiff_edu.metrics.retrieval import TOP, mm_dist, r_precision
from motiondiff_edu.metrics.sentences import rows_of
from motiondiff_edu.metrics.skating import skating
from motiondiff_edu.pretrained.judges import Judge

from ..walks.scores import (
    FPS,
    Measure,
    measure_of,
    over_floor,
    ratio,
    root_mean,
    squared_bone_error,
)
from .rows import sketch
from .trials import Positions, Trials, minimal_pairs

REPLICATIONS = 20  # of the pools of R-Precision, as is usual


def recognised(trials: Trials, made: Sequence[Positions]) -> list[Measure]:
    """The recogniser's accuracies: each a mean over the clips where there is something to judge."""
    rows = rows_of(trials.phrases, [actions(positions) for positions in made])
    return [measure_of(f"{kind}_accuracy", "share", np.nanmean, x) for kind, x in rows.items()]


@dataclass(frozen=True, eq=False)
class Points:
    """Trials and a row in the space of one judge."""

    texts: Float[np.ndarray, "N E"]
    motions: Float[np.ndarray, "N E"]

    @classmethod
    def of(cls, judge: Judge, trials: Trials, made: Sequence[Positions]) -> "Points":
        return cls(judge.of_texts(trials.plain), judge.of_motions(made))


def retrieved(judges: Sequence[Judge], trials: Trials, made: Sequence[Positions]) -> list[Measure]:
    """R-Precision, MM-Dist, FID and Diversity; the mean over judges and over pools.

    The interval has 95 % of the values of the single judges and pools.
    """
    found = {name: [] for name in (*TOPS, *(f"{top}_over_real" for top in TOPS), *OTHERS)}
    for judge in judges:
        row, data = (Points.of(judge, trials, one) for one in (made, trials.truth))
        for draw in range(REPLICATIONS):
            own, real = (
                r_precision(x.texts, x.motions, trials.sentences, np.random.default_rng(draw))
                for x in (row, data)
            )
            for k, top in enumerate(TOPS):
                found[top].append(own[k])
                found[f"{top}_over_real"].append(own[k] / real[k])
        found["mm_dist"].append(mm_dist(row.texts, row.motions))
        found["mm_dist_over_real"].append(found["mm_dist"][-1] / mm_dist(data.texts, data.motions))
        found["fid"].append(frechet.fid(row.motions, data.motions))
        found["diversity"].append(diversity.diversity(row.motions))
    units = {"mm_dist": "distance", "fid": "FID", "diversity": "distance"}
    return [spread(name, values, units.get(name, "share")) for name, values in found.items()]


TOPS = tuple(f"r_precision_top{k}" for k in range(1, TOP + 1))
OTHERS = ("mm_dist", "mm_dist_over_real", "fid", "diversity")


def spread(name: str, values: Sequence[float], unit: str) -> Measure:
    """The mean, and the range of 95 % of the values."""
    low, high = np.percentile(values, [2.5, 97.5])
    return Measure(name, float(np.mean(values)), float(low), float(high), unit)


def multimodality(
    judges: Sequence[Judge],
    made: Sequence[Sequence[Positions]],
    data: Sequence[Sequence[Positions]],
) -> list[Measure]:
    """How different several motions of a caption are, beside the data's; made[draw][caption]."""
    both = []
    for every in (made, data):
        points = [np.stack([judge.of_motions(one) for one in every], 1) for judge in judges]
        both.append(np.mean([diversity.diversity(one) for one in points], axis=0))
    own, real = both
    return [
        measure_of("multimodality", "distance", np.mean, own),
        measure_of("multimodality_data", "distance", np.mean, real),
        measure_of("multimodality_over_data", "ratio", ratio, own, real),
    ]


def bodies(trials: Trials, made: Sequence[Positions]) -> list[Measure]:
    """Bones, sliding feet and speed; the last two beside the data's own."""
    bones = np.array([squared_bone_error(one[None])[0] for one in made])
    slides, speeds = (
        [np.array([of(one) for one in every]) for every in (made, trials.truth)]
        for of in (sliding, speed)
    )
    return [
        measure_of("bone_rmse_cm", "cm", root_mean, bones),
        measure_of("skating_mps", "m/s", np.nanmean, slides[0]),
        measure_of("skating_data_mps", "m/s", np.nanmean, slides[1]),
        measure_of("skating_over_data", "ratio", over_floor, *slides),
        measure_of("speed_over_data", "ratio", ratio, *speeds),
    ]


def sliding(positions: Positions) -> float:
    """How fast standing toes slide, m/s."""
    return float(skating(positions[None], np.zeros((1, len(positions), 3)))[0])


def speed(positions: Positions) -> float:
    """The mean speed of all joints, m/s."""
    return float(np.linalg.norm(np.diff(positions, axis=0), axis=-1).mean() * FPS)


def pairs(judges: Sequence[Judge], trials: Trials, made: Sequence[Positions]) -> list[Measure]:
    """How often a motion is nearer to its own caption than to one that differs in one thing."""
    every = minimal_pairs(trials)
    right = np.zeros(len(every))
    for judge in judges:
        motions = judge.of_motions(made)[[pair.trial for pair in every]]
        own, other = (
            np.linalg.norm(judge.of_texts([getattr(p, which) for p in every]) - motions, axis=-1)
            for which in ("own", "other")
        )
        right += (own < other) / len(judges)
    kinds = np.array([pair.kind for pair in every])
    parts = {f".{kind}": right[kinds == kind] for kind in KINDS if (kinds == kind).any()}
    return [
        measure_of(f"minimal_pair{name}", "share", np.mean, x)
        for name, x in {"": right, **parts}.items()
    ]


def nearest_training(
    trials: Trials, made: Sequence[Positions], sketches: Sequence[Positions]
) -> list[Measure]:
    """The distance to the nearest training motion that lasts as long, over that of the data.

    `sketches` are those of the training (`rows.sketch`); longer ones are cut. RMS over joints and
    time, in metres, of motions that begin at one place. A copy has 0.
    """
    own, data = (to_nearest(every, sketches) for every in (made, trials.truth))
    return [
        measure_of("nearest_training_m", "m", np.nanmean, own),
        measure_of("nearest_training_data_m", "m", np.nanmean, data),
        measure_of("nearest_training_over_data", "ratio", ratio, own, data),
    ]


def to_nearest(made: Sequence[Positions], sketches: Sequence[Positions]) -> Float[np.ndarray, "N"]:
    """The distance of each motion to the nearest sketch; NaN where none is as long."""
    own, found = [sketch(one) for one in made], np.full(len(made), np.nan)
    for n in sorted({len(one) for one in own}):
        there = [one[:n].ravel() for one in sketches if len(one) >= n]
        if there:
            members = [k for k, one in enumerate(own) if len(one) == n]
            every = np.stack(there)
            found[members] = [nearest(own[k], every) for k in members]
    return found


def nearest(one: Positions, every: Float[np.ndarray, "N F"]) -> float:
    """The RMS distance of joints to the nearest of many motions, metres."""
    squares = (every * every).sum(1) - 2 * every @ one.ravel() + np.square(one).sum()
    return float(np.sqrt(max(float(squares.min()), 0.0) * 3 / one.size))
