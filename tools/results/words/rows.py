"""The rows of Table 2: what is shown for each caption, by data, fools and networks."""

from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import cached_property, partial
from multiprocessing import get_context

import numpy as np
import torch
from sklearn.feature_extraction.text import TfidfVectorizer

from data_synth.actions import Sentence, mirror
from data_synth.actions.dataset import WORDINGS_EACH, clip_of
from motiondiff_edu.conditions.text import TextError
from motiondiff_edu.motion import moving_frame
from motiondiff_edu.motion.dance_frame import at_origin
from motiondiff_edu.performers.mover import ETA, Mover
from motiondiff_edu.performers.performer import STEPS
from motiondiff_edu.recipes.mover import MOVER

from .trials import Positions, Trials, other_captions

EVERY = 4  # frames: distances to training motions compare five frames a second
BATCH_FRAMES = 6000  # of one batch, all motions together

Make = Callable[[Trials, int], list[Positions]]  # of trials and a seed


def performed(mover: Mover, guidance: float = 1.0, steps: int = STEPS) -> Make:
    """A row of a network: one motion for each caption, as long as the data's.

    A caption that the network refuses counts as the empty text.
    """

    def make(trials: Trials, seed: int) -> list[Positions]:
        words = [understood(text, mover) for text in trials.captions]
        made: list[Positions | None] = [None] * len(trials)
        draws = torch.Generator().manual_seed(seed)
        for frames, members in by_length(trials.frames):
            texts = mover.reader.encoded([words[k] for k in members])
            poses = mover.act_ids(
                texts, frames, generator=draws, steps=steps, eta=ETA, guidance=guidance
            )
            for k, positions in zip(members, poses.double().cpu().numpy(), strict=True):
                made[k] = positions
        return made

    return make


def understood(text: str, mover: Mover) -> tuple[str, ...]:
    """The words of a caption; none where the network refuses it."""
    try:
        return mover.reader.read(text).words
    except TextError:
        return ()


def by_length(frames: Sequence[int]) -> list[tuple[int, list[int]]]:
    """Indices of equal length in batches of about BATCH_FRAMES frames."""
    batches = []
    for n in sorted(set(frames)):
        members = [k for k, one in enumerate(frames) if one == n]
        size = max(1, BATCH_FRAMES // n)
        batches += [(n, members[i : i + size]) for i in range(0, len(members), size)]
    return batches


def shuffled(trials: Trials, seed: int) -> list[Positions]:
    """The data's motions, each beside another caption."""
    where = other_captions(trials, np.random.default_rng(seed))
    return [trials.truth[k] for k in where]


def noise(mover: Mover) -> Make:
    """Normal noise in the network's units."""

    def make(trials: Trials, seed: int) -> list[Positions]:
        draws = torch.Generator().manual_seed(seed)
        units = [torch.randn(n, moving_frame.D, generator=draws) for n in trials.frames]
        return [mover.positions_of(x).double().numpy() for x in units]

    return make


@dataclass(frozen=True, eq=False)
class TrainingClips:
    """The clips that the movers were trained on, each followed by its mirrored twin."""

    clips: int = MOVER.clips
    seed: int = MOVER.data_seed

    @cached_property
    def _read(self) -> tuple[list[str], list[Positions], set[Sentence]]:
        """All captions, a sketch of each motion (a frame in EVERY, from the origin), sentences."""
        texts, sketches = [], []
        sentences = set()
        with ProcessPoolExecutor(mp_context=get_context("spawn")) as processes:
            numbers = range(self.clips)
            for both in processes.map(partial(sketched, seed=self.seed), numbers, chunksize=100):
                for captions, sentence, outline in both:
                    texts += captions
                    sketches.append(outline)
                    sentences.add(sentence)
        return texts, sketches, sentences

    @property
    def sentences(self) -> set[Sentence]:
        return self._read[2]

    @property
    def captions(self) -> list[str]:
        return self._read[0]

    @property
    def sketches(self) -> list[Positions]:
        return self._read[1]

    @cached_property
    def _words(self) -> tuple[TfidfVectorizer, object]:
        words = TfidfVectorizer(ngram_range=(1, 2), token_pattern=r"\w+")
        return words, words.fit_transform(self.captions)

    def nearest_caption(self, trials: Trials) -> list[Positions]:
        """The training clip whose caption has most words and pairs of words in common."""
        words, there = self._words
        alike = (words.transform(trials.captions) @ there.T).toarray()
        return [self.motion(int(k) // WORDINGS_EACH) for k in alike.argmax(1)]

    def motion(self, k: int) -> Positions:
        """The motion number k, made again; odd ones are mirrored."""
        one = clip_of(k // 2, self.seed)
        return (mirror(one) if k % 2 else one).acted.positions


def sketched(k: int, seed: int) -> list[tuple[tuple[str, ...], Sentence, Positions]]:
    """Captions, sentence and sketch of the training clip number k and of its mirrored twin."""
    one = clip_of(k, seed)
    return [
        (twin.captions, twin.acted.sentence, sketch(twin.acted.positions))
        for twin in (one, mirror(one))
    ]


def sketch(positions: Positions) -> Positions:
    """A frame in EVERY of a motion that begins at the origin, facing z."""
    return at_origin(positions)[::EVERY].astype(np.float32)
