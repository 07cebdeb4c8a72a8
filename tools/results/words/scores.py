"""The measures of one row: what is recognised, how near texts and motions are, and the body."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product

import numpy as np
from jaxtyping import Float

from data_synth.actions.neighbours import KINDS
from motiondiff_edu.metrics import distributions
from motiondiff_edu.metrics.dances import mean_speed
from motiondiff_edu.metrics.distributions import TOP, mm_dist, r_precision
from motiondiff_edu.metrics.texts import SIDES, actions, confusion, rows_of
from motiondiff_edu.metrics.walks import skating
from motiondiff_edu.pretrained.judges import Judge

from ..walks.scores import Measure, measure_of, over_floor, ratio, root_mean, squared_bone_error
from .rows import sketch
from .trials import Pair, Positions, Trials, minimal_pairs

SHOWN = (*SIDES, "both", "none")  # how an act with one side may be recognised
REPLICATIONS = 20  # of the pools of R-Precision, as is usual


def recognised(trials: Trials, made: Sequence[Positions]) -> list[Measure]:
    """The recogniser's accuracies: each a mean over the clips where there is something to judge."""
    rows = rows_of(trials.phrases, [actions(positions) for positions in made])
    return [measure_of(f"{kind}_accuracy", "share", np.nanmean, x) for kind, x in rows.items()]


def sides(trials: Trials, made: Sequence[Positions]) -> list[Measure]:
    """The confusion of left and right: of acts asked for on one side, the shares of what is shown.

    `side_confused`: of the acts that are shown, the share on the other side or on both.
    """
    tables = [
        confusion([phrases], [actions(positions)])
        for phrases, positions in zip(trials.phrases, made, strict=True)
    ]
    cells = {pair: np.array([one.get(pair, 0) for one in tables]) for pair in product(SIDES, SHOWN)}
    asked = {side: sum(cells[side, shown] for shown in SHOWN) for side in SIDES}
    shares = [
        measure_of(f"asked_{side}_shown_{shown}", "share", ratio, count, asked[side])
        for (side, shown), count in cells.items()
    ]
    right = cells["left", "left"] + cells["right", "right"]
    seen = sum(asked[side] - cells[side, "none"] for side in SIDES)
    return [*shares, measure_of("side_confused", "share", ratio, seen - right, seen)]


@dataclass(frozen=True, eq=False)
class Points:
    """Captions and motions in the space of one judge."""

    texts: Float[np.ndarray, "N E"]
    motions: Float[np.ndarray, "N E"]


@dataclass(frozen=True, eq=False)
class Panel:
    """Judges and trials; what does not depend on the row is put into their spaces once."""

    judges: Sequence[Judge]
    trials: Trials

    @cached_property
    def data(self) -> list[Points]:
        """The trials with the data's own motions, for each judge."""
        texts, truth = self.trials.plain, self.trials.truth
        return [Points(judge.of_texts(texts), judge.of_motions(truth)) for judge in self.judges]

    def row(self, made: Sequence[Positions]) -> list[Points]:
        """The trials with the motions of a row, for each judge."""
        return [
            replace(data, motions=judge.of_motions(made))
            for judge, data in zip(self.judges, self.data, strict=True)
        ]

    @cached_property
    def pairs(self) -> list[Pair]:
        return minimal_pairs(self.trials)

    @cached_property
    def pair_texts(self) -> list[tuple[Float[np.ndarray, "P E"], Float[np.ndarray, "P E"]]]:
        """The own and the other caption of each pair, for each judge."""
        both = [pair.own for pair in self.pairs], [pair.other for pair in self.pairs]
        return [tuple(map(judge.of_texts, both)) for judge in self.judges]


def retrieved(panel: Panel, row: Sequence[Points]) -> list[Measure]:
    """R-Precision, MM-Dist, FID and Diversity; the mean over judges and over pools.

    The interval has 95 % of the values of the single judges and pools.
    """
    found = {name: [] for name in RETRIEVED}
    for mine, data in zip(row, panel.data, strict=True):
        for draw in range(REPLICATIONS):
            own, real = (
                r_precision(x.texts, x.motions, panel.trials.sentences, np.random.default_rng(draw))
                for x in (mine, data)
            )
            for k, top in enumerate(TOPS):
                found[top].append(own[k])
                found[f"{top}_over_real"].append(own[k] / real[k])
        found["mm_dist"].append(mm_dist(mine.texts, mine.motions))
        found["mm_dist_over_real"].append(found["mm_dist"][-1] / mm_dist(data.texts, data.motions))
        found["fid"].append(distributions.fid(mine.motions, data.motions))
        found["diversity"].append(distributions.diversity(mine.motions))
    return [spread(name, values, RETRIEVED[name]) for name, values in found.items()]


TOPS = tuple(f"r_precision_top{k}" for k in range(1, TOP + 1))
RETRIEVED = {  # and their units
    **{f"{top}{end}": "share" for end in ("", "_over_real") for top in TOPS},
    "mm_dist": "distance", "mm_dist_over_real": "share", "fid": "FID", "diversity": "distance",
}  # fmt: skip


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
        both.append(np.mean([distributions.diversity(one) for one in points], axis=0))
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
    return float(mean_speed(positions).mean())


def pairs(panel: Panel, row: Sequence[Points]) -> list[Measure]:
    """How often a motion is nearer to its own caption than to one that differs in one thing."""
    return [
        measure_of(f"minimal_pair{name}", "share", ratio, right, there)
        for name, (right, there) in by_trial(panel, nearer(panel, row)).items()
    ]


def by_trial(
    panel: Panel, right: Float[np.ndarray, "P"]
) -> dict[str, tuple[Float[np.ndarray, "N"], Float[np.ndarray, "N"]]]:
    """For all pairs and for each kind: of each trial the sum over its pairs, and their number.

    Pairs of one trial share its motion, so that intervals are over trials.
    """
    which = np.array([pair.trial for pair in panel.pairs])
    kinds = np.array([pair.kind for pair in panel.pairs])
    chosen = {"": np.full(len(kinds), True)} | {f".{kind}": kinds == kind for kind in KINDS}
    n = len(panel.trials)
    return {
        name: (np.bincount(which[x], right[x], n), np.bincount(which[x], minlength=n).astype(float))
        for name, x in chosen.items()
        if x.any()
    }


def nearer(panel: Panel, row: Sequence[Points]) -> Float[np.ndarray, "P"]:
    """For each pair of captions the share of judges that put the motion nearer to its own."""
    which = [pair.trial for pair in panel.pairs]
    right = np.zeros(len(which))
    for mine, texts in zip(row, panel.pair_texts, strict=True):
        own, other = (np.linalg.norm(text - mine.motions[which], axis=-1) for text in texts)
        right += (own < other) / len(row)
    return right


def nearest_training(own: Float[np.ndarray, "N"], data: Float[np.ndarray, "N"]) -> list[Measure]:
    """The distance to the nearest training motion (`to_nearest`), over that of the data's own."""
    return [
        measure_of("nearest_training_m", "m", np.nanmean, own),
        measure_of("nearest_training_data_m", "m", np.nanmean, data),
        measure_of("nearest_training_over_data", "ratio", ratio, own, data),
    ]


def to_nearest(made: Sequence[Positions], sketches: Sequence[Positions]) -> Float[np.ndarray, "N"]:
    """The distance of each motion to the nearest training motion that lasts as long.

    `sketches` are those of the training (`rows.sketch`); longer ones are cut. RMS over joints and
    time, in metres, of motions that begin at one place. A copy has 0; NaN where none is as long.
    """
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
