"""Clips with their sentences and captions; mirrored ones; three splits that share no clip."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from motiondiff_edu.motion import dance_frame

from .acts import Phrase, Sentence, mirrored
from .captions import caption, exchanged
from .performance import Acted, act_out
from .sentences import draw, in_training

SPLITS = {"train": 0, "validation": 1, "test": 2, "combinations": 3}
WORDINGS_EACH = 4


@dataclass(frozen=True, eq=False)
class Described:
    """A clip with several captions."""

    acted: Acted
    captions: tuple[str, ...]


def clips(
    n: int, seed: int, split: str = "train", seconds: float | None = None
) -> Iterator[Described]:
    """n clips of a split, each with WORDINGS_EACH captions.

    train, validation, test  sentences without a held-out pair
    combinations             sentences with one: each word is seen in training, the pair never
    Raises ValueError for an unknown split.
    """
    return (clip_of(k, seed, split, seconds) for k in range(n))


def clip_of(k: int, seed: int, split: str = "train", seconds: float | None = None) -> Described:
    """The clip number k of `clips`, by itself.  Raises ValueError for an unknown split."""
    if split not in SPLITS:
        raise ValueError(f"no split is called {split!r}; there are {', '.join(SPLITS)}")
    rng = np.random.default_rng([seed, SPLITS[split], k, 13])
    sentence, length = draw(rng, seconds)
    while in_training(sentence) == (split == "combinations"):
        sentence, length = draw(rng, seconds)
    acted = act_out(sentence, length, int(rng.integers(2**31)))
    return Described(acted, worded(sentence, rng))


def worded(
    sentence: Sentence, rng: np.random.Generator, new_verbs: bool = False
) -> tuple[str, ...]:
    """WORDINGS_EACH different captions of a sentence; `new_verbs`: by the held-out verbs."""
    found: dict[str, None] = {}
    while len(found) < WORDINGS_EACH:
        found[caption(sentence, rng, new_verbs)] = None
    return tuple(found)


def mirror(clip: Described) -> Described:
    """Left and right exchanged in motion, truth and words."""
    acted = clip.acted
    positions, contacts = dance_frame.mirror(acted.positions), acted.contacts[:, ::-1].copy()
    sentence = mirrored_sentence(acted.sentence)
    spans = tuple(
        replace(span, act=mirrored(span.act))  # type: ignore[arg-type]  # a span has an act
        for span in acted.spans
    )
    turned = replace(acted, positions=positions, contacts=contacts, spans=spans, sentence=sentence)
    return Described(turned, tuple(exchanged(text) for text in clip.captions))


def mirrored_sentence(sentence: Sentence) -> Sentence:
    """The same sentence with left and right exchanged."""
    return tuple(Phrase(mirrored(phrase.legs), mirrored(phrase.arms)) for phrase in sentence)
