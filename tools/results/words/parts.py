"""The measurements of the movers by `make results`: Table 2, its fools, held-out trials, edits."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from operator import call
from pathlib import Path

import numpy as np
from jaxtyping import Float

from motiondiff_edu.performers.mover import Mover
from motiondiff_edu.performers.performer import STEPS
from motiondiff_edu.pretrained import checkpoints
from motiondiff_edu.pretrained.judges import Judge, judges

from ..walks.parts import weights_digest
from ..walks.scores import Measure, measure_of
from ..walks.trials import MORE_STEPS
from .edits import edit_measures, edit_trials
from .looking import SEED, looked_at_measures
from .looking import STEPS as LOOKED_AT_STEPS
from .rows import Make, TrainingClips, noise, performed, shuffled, understood
from .scores import (
    Panel,
    bodies,
    multimodality,
    nearest_training,
    pairs,
    recognised,
    retrieved,
    sides,
    to_nearest,
)
from .trials import UNSEEN, Positions, Trials, unseen

GUIDANCE = 2.5
VARIETY = UNSEEN + 2  # the seed of the captions with several motions each
HELD_OUT = {"heldout": {"split": "combinations"}, "wording": {"new_verbs": True}}


@dataclass(frozen=True)
class WordSize:
    """The amount of measurement."""

    trials: int = 512
    held_out: int = 320
    texts: int = 32  # for the variety of motions to one caption
    each: int = 10
    edits: int = 100
    training: int = 12_000


WORD_FULL = WordSize()
WORD_QUICK = WordSize(trials=64, held_out=40, texts=4, each=3, edits=4, training=200)


def size_of(quick: bool) -> WordSize:
    """The amount of a full or a quick measurement."""
    return WORD_QUICK if quick else WORD_FULL


def panel_of(trials: int) -> Panel:
    """The judges and so many trials."""
    return Panel(judges(), unseen(trials))


class Studio:
    """The trials, made once, the judges, and the movers by name."""

    def __init__(self, size: WordSize, weights: dict[str, Path] | None = None):
        self.size = size
        self.weights = weights or checkpoints.available()

    @property
    def judges(self) -> Sequence[Judge]:
        return self.panel.judges

    @cached_property
    def panel(self) -> Panel:
        """The judges and the trials of Table 2."""
        return panel_of(self.size.trials)

    @property
    def trials(self) -> Trials:
        return self.panel.trials

    @cached_property
    def training(self) -> TrainingClips:
        return TrainingClips(self.size.training)

    def mover(self, name: str) -> Mover:
        return checkpoints.load(self.weights[name])

    def scored(self, made: list[Positions], panel: Panel | None = None) -> list[Measure]:
        """What is measured of every row."""
        panel = panel or self.panel
        row = panel.row(made)
        return [
            *recognised(panel.trials, made),
            *retrieved(panel, row),
            *bodies(panel.trials, made),
            *pairs(panel, row),
        ]

    def of_new_sentences(self, made: list[Positions]) -> list[Measure]:
        """What is recognised in the trials whose sentence no training clip has, mirrored or not."""
        known = self.training.sentences
        new = np.array([one not in known for one in self.trials.sentences])
        which = np.flatnonzero(new)
        found = recognised(self.trials.chosen(which), [made[k] for k in which])
        found.append(measure_of("sentences", "share", np.mean, new))
        return [replace(one, name=f"new_{one.name}") for one in found]

    def varied(self, make: Make) -> list[Measure]:
        """The variety of motions to one caption."""
        some = unseen(self.size.texts, seed=VARIETY)
        made = [make(some, draw) for draw in range(self.size.each)]
        data = [some.second(draw) for draw in range(1, self.size.each + 1)]
        return multimodality(self.judges, made, data)

    def copied(self, made: list[Positions]) -> list[Measure]:
        """How near the training motions are."""
        return nearest_training(to_nearest(made, self.training.sketches), self.data_to_training)

    @cached_property
    def data_to_training(self) -> Float[np.ndarray, "N"]:
        """How near the training motions the data's own are, metres."""
        return to_nearest(self.trials.truth, self.training.sketches)


def fools(studio: Studio, mover: Mover) -> dict[str, list[Positions]]:
    """The rows of Table 2 without a network."""
    trials = studio.trials
    return {
        "data": trials.truth,
        "second": trials.second(),
        "shuffled": shuffled(trials, 0),
        "noise": noise(mover)(trials, 0),
        "nearest": studio.training.nearest_caption(trials),
    }


Found = dict[str, list[Measure]]  # by the beginning of their names
Part = Callable[[Studio], Found]


def as_shipped(studio: Studio) -> Found:
    """The shipped mover on the trials of Table 2, and the rows without a network."""
    mover = studio.mover("mover")
    made = performed(mover)(studio.trials, 0)
    found = {"words.": [*studio.scored(made), *studio.copied(made)]}
    found["words."] += [*studio.of_new_sentences(made), *sides(studio.trials, made)]
    without_network = fools(studio, mover)
    for name, motions in without_network.items():
        found[f"words.{name}."] = studio.scored(motions)
    found["words.nearest."] += studio.copied(without_network["nearest"])
    return found


def guided(studio: Studio) -> Found:
    """The same trials with guidance."""
    make = performed(studio.mover("mover"), GUIDANCE)
    return {"words.guided.": studio.scored(make(studio.trials, 0))}


def guided_variety(studio: Studio) -> Found:
    """Several motions to one caption with guidance."""
    return {"words.guided.": studio.varied(performed(studio.mover("mover"), GUIDANCE))}


WITH_MORE_STEPS = f"words.steps{MORE_STEPS}."


def more_steps(studio: Studio) -> Found:
    """The trials of Table 2 with more steps of DDIM."""
    make = performed(studio.mover("mover"), steps=MORE_STEPS)
    return {WITH_MORE_STEPS: studio.scored(make(studio.trials, 0))}


def variety(studio: Studio) -> Found:
    """Several motions to one caption."""
    return {"words.": studio.varied(performed(studio.mover("mover")))}


def without_text(studio: Studio) -> Found:
    """The trials without their captions."""
    silent = replace(studio.trials, captions=[""] * len(studio.trials))
    make = performed(studio.mover("mover"))
    return {"words.no-text.": studio.scored(make(silent, 0))}


def held_out(studio: Studio) -> Found:
    """Combinations and verbs that no training caption has."""
    mover, found = studio.mover("mover"), []
    for name, how in HELD_OUT.items():
        panel = Panel(studio.judges, unseen(studio.size.held_out, **how))
        rows = studio.scored(performed(mover)(panel.trials, 0), panel)
        told = np.array([bool(understood(text, mover)) for text in panel.trials.captions])
        rows.append(measure_of("understood", "share", np.mean, told))
        found += [replace(one, name=f"{name}_{one.name}") for one in rows]
    return {"words.": found}


def edited_by_words(studio: Studio) -> Found:
    """Edits of motions of the data."""
    return {"words.": edit_measures(studio.mover("mover"), edit_trials(studio.size.edits))}


LOOKED_AT = "words.looked_"


def looked_at(studio: Studio) -> Found:
    """The recogniser beside eyes."""
    digest = weights_digest(studio.weights["mover"])
    return {LOOKED_AT: looked_at_measures(studio.mover("mover"), digest)}


PARTS = (  # the longest first
    more_steps, guided, as_shipped, guided_variety, held_out, without_text, edited_by_words,
    variety, looked_at,
)  # fmt: skip


def word_records(studio: Studio, command: str, each: Callable = map) -> list[dict]:
    """All measures of the shipped mover, and of the rows without a network.

    `each`: `map`, or a function that calls its function for several parts at once.
    """
    size = studio.size
    seeds = {"data": UNSEEN, "edits": UNSEEN + 1, "variety": VARIETY, "looked_at": SEED}
    seeds |= {"trials": size.trials, "sampling": 0}
    steps = {WITH_MORE_STEPS: MORE_STEPS, LOOKED_AT: LOOKED_AT_STEPS}
    # here the trials are made, once: every process gets them with the studio
    seeds |= {"weights": weights_digest(studio.weights["mover"]), "judges": len(studio.judges)}
    return [
        measure.as_record(prefix, seeds | {"steps": steps.get(prefix, STEPS)}, command)
        for found in each(call, [partial(part, studio) for part in PARTS])
        for prefix, measures in found.items()
        for measure in measures
        if np.isfinite(measure.value)
    ]
