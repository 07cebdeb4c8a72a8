"""Editing by words, measured: other arms for a figure on its way, without a mask and with one.

What was asked for should be there, and the legs and the path should stay as they were.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import islice

import numpy as np
import torch

from data_synth.actions import Act, Described, Phrase, Sentence, caption, clips
from data_synth.actions.acts import VERBS
from data_synth.actions.sentences import ARMS, in_training
from motiondiff_edu.editing.by_words import STRENGTH, edit_by_words
from motiondiff_edu.editing.masks import body_part
from motiondiff_edu.metrics.texts import actions
from motiondiff_edu.performers.described_windows import GRID
from motiondiff_edu.performers.mover import Mover

from ..walks.scores import Measure, measure_of, ratio
from .trials import UNSEEN, Positions, asked

ON_THE_WAY = ("walk", "run", "back", "aside")
STAYS = "lower body"  # and the pelvis
LEAST = 80  # frames


@dataclass(frozen=True, eq=False)
class EditTrial:
    """A motion of the data, and a sentence with the same legs and other arms."""

    positions: Positions
    sentence: Sentence
    text: str


def edit_trials(n: int, seed: int = UNSEEN + 1) -> list[EditTrial]:
    """n unseen clips of one phrase on the way, each with a sentence of trained combinations."""
    rng = np.random.default_rng([seed, 9])
    return list(islice(_edit_trials(clips(100 * n, seed, "test"), rng), n))


def _edit_trials(made: Iterable[Described], rng: np.random.Generator) -> Iterator[EditTrial]:
    for one in made:
        (phrase, *more), frames = one.acted.sentence, len(one.acted) // GRID * GRID
        if more or frames < LEAST or phrase.legs is None or phrase.legs.verb not in ON_THE_WAY:
            continue
        sentence = with_other_arms(phrase, rng)
        yield EditTrial(one.acted.positions[:frames], sentence, caption(sentence, rng))


def with_other_arms(phrase: Phrase, rng: np.random.Generator) -> Sentence:
    """The phrase with another act of the arms, once."""
    others = [verb for verb in ARMS if phrase.arms is None or verb != phrase.arms.verb]
    while True:
        verb = str(rng.choice(others))
        act = Act(
            verb,
            side=str(rng.choice(VERBS[verb].sides)),
            count=int(rng.integers(1, VERBS[verb].most + 1)),
            direction=str(rng.choice(VERBS[verb].directions)),
        )
        sentence = (Phrase(phrase.legs, act),)
        if in_training(sentence):
            return sentence


def edit_measures(mover: Mover, trials: list[EditTrial]) -> list[Measure]:
    """`edit_changes` and `edit_keeps_over_resampled`: the legs kept by a mask, and without one."""
    measures = []
    plain = np.array([kept_error(t, edited(mover, t, k, 1.0)) for k, t in enumerate(trials)])
    for prefix, masked in (("edit", True), ("edit_free", False)):
        made = [edited(mover, t, k, STRENGTH, masked) for k, t in enumerate(trials)]
        there = np.array([shows(t, one) for t, one in zip(trials, made, strict=True)])
        kept = np.array([kept_error(t, one) for t, one in zip(trials, made, strict=True)])
        measures += [
            measure_of(f"{prefix}_changes", "share", np.mean, there),
            measure_of(f"{prefix}_keeps_m", "m", np.mean, kept),
            measure_of(f"{prefix}_keeps_over_resampled", "ratio", ratio, kept, plain),
        ]
    before = np.array([shows(t, t.positions) for t in trials])
    return [*measures, measure_of("edit_changes_before", "share", np.mean, before)]


def edited(
    mover: Mover, trial: EditTrial, seed: int, strength: float, masked: bool = False
) -> Positions:
    """One edit; with strength 1 it is plain sampling under the new sentence."""
    known = body_part(len(trial.positions), STAYS) if masked else None
    draws = torch.Generator().manual_seed(seed)
    made = edit_by_words(
        mover, trial.positions, trial.text, known, strength=strength, generator=draws
    )
    return made[0]


def shows(trial: EditTrial, positions: Positions) -> bool:
    """Is the new act of the arms recognised, with its side?"""
    wanted = asked(trial.sentence)[0][-1]
    return any(one.verb == wanted.verb and one.side == wanted.side for one in actions(positions))


def kept_error(trial: EditTrial, positions: Positions) -> float:
    """The RMS distance of legs and pelvis from where they were, in the world, metres."""
    apart = (positions - trial.positions)[body_part(len(positions), STAYS)]
    return float(np.sqrt(np.square(apart).sum(-1).mean()))
