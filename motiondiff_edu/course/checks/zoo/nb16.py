"""Wrong answers to the exercises of notebook 16."""

from typing import Any

import torch

from ....motion.skeleton import MIRROR

SIDES = {"left": "right", "right": "left"}


def _kept(tokens, mask):
    return tokens * mask[..., None]


def _count(mask):
    return mask.sum(1, keepdim=True)


def in_place(tokens, mask):
    """The right mean, but the padding is 0 afterwards."""
    tokens *= mask[..., None]
    return tokens.sum(1) / _count(mask)


def _mirrored(positions, words, flip=(-1.0, 1.0, 1.0), partner=MIRROR, other=SIDES):
    turned = positions[:, partner] * torch.tensor(flip, dtype=torch.float64).numpy()
    return turned, tuple(other.get(word, word) for word in words)


def one_after_the_other(positions, words):
    """First every left becomes right, then every right becomes left."""
    words = tuple("right" if word == "left" else word for word in words)
    words = tuple("left" if word == "right" else word for word in words)
    return _mirrored(positions, ())[0], words


def positions_in_place(positions, words):
    """Right, but the motion that was given is mirrored, too."""
    positions[:] = _mirrored(positions, ())[0]
    return positions, _mirrored(positions, words)[1]


MISTAKES: dict[str, dict[str, Any]] = {
    "bag": {
        "padding is in the mean; leave out what the mask does not have": lambda tokens, mask: (
            tokens.mean(1)
        ),
        "padding is in the sum; leave out what the mask does not have": lambda tokens, mask: (
            tokens.sum(1) / _count(mask)
        ),
        "divide by the number of words that are there, not by the longest text": (
            lambda tokens, mask: _kept(tokens, mask).mean(1)
        ),
        "divide by the number of words of each text, not of all texts": lambda tokens, mask: (
            _kept(tokens, mask).sum(1) / mask.sum()
        ),
        "take the mean of the words, not their sum": lambda tokens, mask: _kept(tokens, mask).sum(
            1
        ),
        "this is the first word alone": lambda tokens, mask: tokens[:, 0],
        "this is the largest of the words, number by number; take their mean": (
            lambda tokens, mask: tokens.masked_fill(~mask[..., None], -torch.inf).amax(1)
        ),
        "the mask is inverted: True is a word": lambda tokens, mask: (
            _kept(tokens, ~mask).sum(1) / (~mask).sum(1, keepdim=True).clamp(min=1)
        ),
        "one mean for each text; this is the mean of all texts": lambda tokens, mask: (
            _kept(tokens, mask).sum((0, 1)) / mask.sum()
        ),
    },
    "guided": {
        "text and no text are swapped": lambda a, b, w: a + w * (b - a),
        "that adds w times the difference to the guess *with* text; w = 1 must give it as it is": (
            lambda a, b, w: a + w * (a - b)
        ),
        "the weights must sum to one: 1 - w belongs to the guess without text": lambda a, b, w: (
            w * a + b
        ),
        "this scales the guess alone; where is the one without text?": lambda a, b, w: w * a,
        "the sign of the second weight: 1 - w, which is negative above 1": lambda a, b, w: (
            w * a - (1 - w) * b
        ),
        "this is w times the difference alone; it leads away from the guess without text": (
            lambda a, b, w: w * (a - b)
        ),
        "the difference is the guess with text minus the one without": lambda a, b, w: (
            b + w * (b - a)
        ),
        "this is the mean of both": lambda a, b, w: (a + b) / 2,
        "w is not used": lambda a, b, w: a.clone(),
    },
    "mirrored": {
        "x is negated, but the left arm is still called the left arm: exchange the joints": (
            lambda positions, words: _mirrored(positions, words, partner=slice(None))
        ),
        "the joints are exchanged, but nothing is reflected: negate x": lambda positions, words: (
            _mirrored(positions, words, flip=(1.0, 1.0, 1.0))
        ),
        "negate x, which points to the side": (
            lambda positions, words: _mirrored(positions, words, flip=(1.0, 1.0, -1.0)),
            lambda positions, words: _mirrored(positions, words, flip=(1.0, -1.0, 1.0)),
        ),
        "the positions are as they were": lambda positions, words: (
            positions.copy(),
            _mirrored(positions, words)[1],
        ),
        "the words are as they were, and now they are wrong: exchange the sides": (
            lambda positions, words: _mirrored(positions, words, other={})
        ),
        "one side has become the other, and then there are two alike: exchange both at once": (
            one_after_the_other,
            lambda positions, words: _mirrored(positions, words, other={"left": "right"}),
            lambda positions, words: _mirrored(positions, words, other={"right": "left"}),
        ),
        "the words come in the wrong order": lambda positions, words: (
            _mirrored(positions, ())[0],
            _mirrored(positions, words[::-1])[1],
        ),
    },
}
OTHERS = {
    "bag": {"in place": in_place},
    "mirrored": {
        "in place": positions_in_place,
        "only the motion": lambda positions, words: _mirrored(positions, ())[0],
    },
}
