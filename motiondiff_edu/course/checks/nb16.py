"""Checks of notebook 16: a bag of words, guidance by text, and a mirrored motion with its words."""

import numpy as np
import torch

from ._compare import compare
from ._drawn import tensors
from ._report import check, expect
from .nb01 import in_the_mirror
from .zoo import Wrong, several
from .zoo.nb16 import MISTAKES


def _texts(rng: np.random.Generator):
    """Texts of two and of four words; others; words turned round."""
    tokens = torch.arange(2 * 4 * 3).float().reshape(2, 4, 3) ** 1.5
    mask = torch.tensor([[True, True, False, False], [True, True, True, True]])
    yield tokens, mask
    yield torch.flip(tokens[1:], dims=[1]), mask[1:]
    mask = torch.arange(5)[None] < torch.tensor([1, 3, 5])[:, None]
    yield tensors(rng, 3, 5, 4), mask


def text_by_text(tokens, mask) -> torch.Tensor:
    """Only the words that are there, one text after the other."""
    return torch.stack([text[there].mean(0) for text, there in zip(tokens, mask, strict=True)])


@check
def bag(mine):
    """mine(tokens, mask): the mean of the tokens that are there, (B, C)."""
    compare(mine, text_by_text, _texts, "the bag of each text", MISTAKES["bag"])
    return "The order of the words is lost, so no network can get it back from a bag."


def _guesses(rng: np.random.Generator):
    """w above and below 1; 1 is the conditional, 0 the guess without a text."""
    for w in (2.5, 0.4, 1.0, 0.0):
        yield tensors(rng, 2, 3), tensors(rng, 2, 3), w


def weighted(with_text, without, w: float) -> torch.Tensor:
    """Two weights that sum to one."""
    return torch.lerp(without, with_text, w)


@check
def guided(mine):
    """mine(with_text, without, w): eps_hat of classifier-free guidance."""
    compare(mine, weighted, _guesses, "eps_hat", MISTAKES["guided"])
    return "Above 1 it goes beyond the text, away from what the network makes without one."


SENTENCES = (
    ("kick", "left", "foot", "then", "wave", "right", "hand"),
    ("right", "right", "left"),
    ("jump", "then", "turn"),
)


@check
def mirrored(mine):
    """mine(positions, words): the motion in a mirror, and the words that describe it."""
    answers = {}

    def motion(positions):
        answers[len(positions)] = mine(positions, SENTENCES[len(positions) - 3])
        got = answers[len(positions)]
        pair = isinstance(got, tuple | list) and len(got) == 2
        expect(pair, "return two things: the positions and the words")
        return got[0]

    def motions(rng: np.random.Generator):
        for T in (3, 4, 5):
            yield (rng.normal(size=(T, 21, 3)),)

    def seen(answer):
        """The positions of an answer in `MISTAKES`."""
        return lambda positions: answer(positions, SENTENCES[len(positions) - 3])[0]

    mistakes = MISTAKES["mirrored"].items()
    of_motion: Wrong = {hint: tuple(map(seen, several(wrong))) for hint, wrong in mistakes}
    compare(
        motion,
        lambda positions: in_the_mirror(positions, np.zeros((1, 3)))[0],
        motions,
        "the mirrored positions",
        of_motion,
    )
    _expect_words({T: tuple(got[1]) for T, got in answers.items()})
    return "Half of the training's clips are made in this way, at no extra cost."


def _expect_words(told: dict[int, tuple]) -> None:
    """Whether each sentence has its sides exchanged; `told` is by the number of frames."""
    other = {"left": "right", "right": "left"}
    right = {T: tuple(other.get(word, word) for word in SENTENCES[T - 3]) for T in told}
    if told == right:
        return
    positions = np.zeros((1, 21, 3))
    for hint, wrong in MISTAKES["mirrored"].items():
        for one in several(wrong):
            same = {T: tuple(one(positions, SENTENCES[T - 3])[1]) for T in told}
            expect(same != told, f"the words: {hint}")
    T = next(T for T in told if told[T] != right[T])
    expect(
        False, f"the words should be {' '.join(right[T])!r}, not {' '.join(map(str, told[T]))!r}"
    )
