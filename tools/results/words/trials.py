"""What a mover is tried on: unseen clips with captions, and captions that differ in one thing.

No motion here was seen in training. A sentence may have been, in another clip: sentences are drawn
alike for all splits. `clips` of `data_synth.actions` says what each split leaves out.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from data_synth.actions import Sentence, act_out, caption, clips
from data_synth.actions.dataset import worded
from data_synth.actions.neighbours import KINDS, changed
from motiondiff_edu.metrics.texts import Asked, Phrases
from motiondiff_edu.motion.root_frame import FPS
from motiondiff_edu.performers.described_windows import GRID

Positions = Float[np.ndarray, "_ 21 3"]
UNSEEN = 77  # the seed of all trials; the training has another one


@dataclass(frozen=True, eq=False)
class Trials:
    """Captions with what they mean, and the data's own motion for each (metres, 20 frames/s).

    `plain`: captions by known verbs, for the judges; the same ones, unless verbs are held out.
    """

    sentences: list[Sentence]
    captions: list[str]
    plain: list[str]
    truth: list[Positions]
    seed: int

    def __len__(self) -> int:
        return len(self.captions)

    @property
    def frames(self) -> list[int]:
        return [len(one) for one in self.truth]

    @property
    def phrases(self) -> list[Phrases]:
        """The sentences as `metrics.texts` takes them; standing is not asked for."""
        return [asked(sentence) for sentence in self.sentences]

    def chosen(self, which: Sequence[int]) -> "Trials":
        """Some of the trials."""
        lists = (self.sentences, self.captions, self.plain, self.truth)
        return Trials(*([one[k] for k in which] for one in lists), self.seed)

    def second(self, draw: int = 1) -> list[Positions]:
        """Other motions of the data for the same sentences, as long as the first."""
        return [
            act_out(sentence, frames / FPS, seed=1_000_003 * draw + k).positions
            for k, (sentence, frames) in enumerate(zip(self.sentences, self.frames, strict=True))
        ]


def unseen(n: int, split: str = "test", new_verbs: bool = False, seed: int = UNSEEN) -> Trials:
    """n clips of a split; with `new_verbs`, in wordings whose verbs no training caption has."""
    made = list(clips(n, seed, split))
    plain = texts = [one.captions[0] for one in made]
    if new_verbs:
        rng = np.random.default_rng([seed, 5])
        texts = [worded(one.acted.sentence, rng, new_verbs=True)[0] for one in made]
    truth = [one.acted.positions[: len(one.acted) // GRID * GRID] for one in made]
    return Trials([one.acted.sentence for one in made], texts, plain, truth, seed)


def asked(sentence: Sentence) -> Phrases:
    """What the recogniser should find in a motion of this sentence."""
    return [
        [
            Asked(act.verb, act.side, act.count, act.direction)
            for act in phrase.acts
            if act.verb != "stand"
        ]
        for phrase in sentence
    ]


@dataclass(frozen=True)
class Pair:
    """Two captions of a trial that differ in one thing: its own, and the other one."""

    trial: int
    kind: str
    own: str
    other: str


def minimal_pairs(trials: Trials) -> list[Pair]:
    """For each trial and each kind, a pair where the sentence has one; both in the same wording."""
    found = []
    for k, sentence in enumerate(trials.sentences):
        for kind in KINDS:
            other = changed(sentence, kind, np.random.default_rng([trials.seed, k, 1]))
            if other is None or other == sentence:
                continue
            texts = (
                caption(one, np.random.default_rng([trials.seed, k, 2]))
                for one in (sentence, other)
            )
            found.append(Pair(k, kind, *texts))
    return found


def other_captions(trials: Trials, rng: np.random.Generator) -> Sequence[int]:
    """For each trial another one, of which it will get the motion."""
    order = rng.permutation(len(trials))
    where = np.empty(len(trials), int)
    where[order] = np.roll(order, 1)
    return where.tolist()
