"""Checks of notebook 16: a bag of words, guidance by text, and a mirrored motion with its words."""

import numpy as np
import torch

from ...motion.skeleton import MIRROR
from ._report import check, expect, expect_close


@check
def bag(mine):
    """mine(tokens, mask): the mean of the tokens that are there, (B, C)."""
    tokens = torch.arange(2 * 4 * 3).float().reshape(2, 4, 3) ** 1.5
    mask = torch.tensor([[True, True, False, False], [True, True, True, True]])
    right = torch.stack([tokens[0, :2].mean(0), tokens[1].mean(0)])
    inverted = torch.stack([tokens[0, 2:].mean(0), tokens[1].mean(0) * 0])
    kept = tokens * mask[..., None]
    expect_close(
        mine(tokens.clone(), mask.clone()),
        right,
        "the bags of two texts, of two and of four words",
        mistakes={
            "padding is in the mean; leave out what the mask does not have": tokens.mean(1),
            "divide by the number of words that are there, not by the longest text": kept.mean(1),
            "take the mean of the words, not their sum": kept.sum(1),
            "this is the first word alone": tokens[:, 0],
            "the mask is inverted: True is a word": inverted,
        },
    )
    turned = torch.flip(tokens[1:], dims=[1])
    expect_close(
        mine(turned, mask[1:]), right[1:], "the bag of the second text with its words turned round"
    )
    return "The order of the words is lost, so no network can get it back from a bag."


@check
def guided(mine):
    """mine(with_text, without, w): eps_hat of classifier-free guidance."""
    a, b = torch.tensor([[1.0, -2.0, 0.5]]), torch.tensor([[0.5, 1.0, 0.25]])
    for w in (2.5, 0.4):
        expect_close(
            mine(a, b, w),
            b + w * (a - b),
            f"eps_hat for w = {w}",
            mistakes={
                "text and no text are swapped": a + w * (b - a),
                "that adds w times the difference to the guess *with* text; w = 1 must give it as "
                "it is": a + w * (a - b),
                "the weights must sum to one: 1 - w belongs to the guess without text": w * a + b,
                "this scales the guess alone; where is the one without text?": w * a,
                "the sign of the second weight: 1 - w, which is negative above 1": w * a
                - (1 - w) * b,
                "this is the mean of both": (a + b) / 2,
            },
        )
    expect_close(mine(a, b, 1.0), a, "eps_hat for w = 1, the conditional")
    expect_close(mine(a, b, 0.0), b, "eps_hat for w = 0, without the text")
    return "Above 1 it goes beyond the text, away from what the network makes without one."


@check
def mirrored(mine):
    """mine(positions, words): the motion in a mirror, and the words that describe it."""
    positions = np.random.default_rng(0).normal(size=(5, 21, 3))
    words = ("kick", "left", "foot", "then", "wave", "right", "hand")
    swapped = ("kick", "right", "foot", "then", "wave", "left", "hand")
    flip = np.array([-1.0, 1.0, 1.0])
    got = mine(positions.copy(), words)
    expect(
        isinstance(got, tuple) and len(got) == 2, "return two things: the positions and the words"
    )
    expect_close(
        got[0],
        positions[:, MIRROR] * flip,
        "the mirrored positions",
        mistakes={
            "x is negated, but the left arm is still called the left arm: exchange the joints": (
                positions * flip
            ),
            "the joints are exchanged, but nothing is reflected: negate x": positions[:, MIRROR],
            "negate x, which points to the side, not z": positions[:, MIRROR]
            * np.array([1.0, 1.0, -1.0]),
            "the positions are as they were": positions,
        },
    )
    told = tuple(got[1])
    expect(told != words, "the words are as they were, and now they are wrong: exchange the sides")
    expect(
        told != tuple("right" if w == "left" else w for w in words)
        and told != tuple("left" if w == "right" else w for w in words),
        "one side has become the other, and then there are two alike: exchange both at once",
    )
    expect(told == swapped, f"the words should be {' '.join(swapped)!r}, not {' '.join(told)!r}")
    return "Half of the training's clips are made in this way, at no extra cost."
