"""Checks of notebook 17: R-Precision, the start of an edit, and two texts for two parts."""

import math

import numpy as np
import torch

from ._report import check, expect_close


@check
def r_precision(mine):
    """mine(distances, k): the share of texts (rows) whose own motion is among the k nearest."""
    distances = np.array(
        [
            [0.2, 0.9, 0.8, 0.7, 0.6],
            [0.1, 0.5, 0.9, 0.8, 0.7],
            [0.6, 0.3, 0.4, 0.2, 0.9],
            [0.9, 0.8, 0.7, 0.6, 0.1],
            [0.1, 0.2, 0.3, 0.4, 0.9],
        ]
    )
    ranks = np.array([0, 1, 2, 1, 4])
    by_motion = (distances < np.diagonal(distances)[None]).sum(0)
    for k in (1, 2, 3):
        expect_close(
            mine(distances.copy(), k),
            (ranks < k).mean(),
            f"R-Precision (top {k}) of five texts",
            mistakes={
                "a rank of 0 is the nearest: the own motion must be among the first k": (
                    ranks <= k
                ).mean(),
                "this is exactly the k-th nearest; nearer ones count, too": (ranks == k - 1).mean(),
                "take the share, not the number": (ranks < k).sum(),
                "rows are texts: choose a motion for each text, not a text for each motion": (
                    by_motion < k
                ).mean(),
                "the nearest has the *smallest* distance": (4 - ranks < k).mean(),
            },
        )
    expect_close(
        mine(np.ones((4, 4)), 1),
        0.25,
        "R-Precision (top 1) where all four motions are the same",
        mistakes={
            "a network that always makes the same motion must not win: of motions that are equally "
            "near, each has an equal share": 1.0,
            "the own motion is as near as the others, so it is the nearest in a quarter of the "
            "cases": 0.0,
        },
    )
    return "Among 32 motions, chance gives k/32: print it beside the score."


@check
def edit_start(mine):
    """mine(x0, alpha_bar, noise): where an edit begins."""
    x0, noise = torch.tensor([[2.0, -1.0, 0.5]]), torch.tensor([[0.5, 3.0, -1.0]])
    for alpha_bar in (0.36, 0.01):
        a, b = math.sqrt(alpha_bar), math.sqrt(1 - alpha_bar)
        expect_close(
            mine(x0, alpha_bar, noise),
            a * x0 + b * noise,
            f"x_s for alpha_bar = {alpha_bar}",
            mistakes={
                "that is noise alone: nothing of the motion is left": noise,
                "that is noise alone, scaled: where is the motion?": b * noise,
                "the motion keeps its size, but it must shrink as in training": x0 + b * noise,
                "take the roots of alpha_bar and of 1 - alpha_bar": alpha_bar * x0
                + (1 - alpha_bar) * noise,
                "signal and noise are swapped": b * x0 + a * noise,
            },
        )
    return "It is q_sample: an edit begins where a training example of step s is."


@check
def composed(mine):
    """mine(eps_lower, eps_upper, lower): one eps_hat of two texts, by columns."""
    low, up = torch.full((2, 3, 4), 1.0), torch.full((2, 3, 4), 5.0)
    lower = torch.tensor([True, False, False, True])
    expect_close(
        mine(low, up, lower),
        torch.tensor([1.0, 5.0, 5.0, 1.0]).expand(2, 3, 4),
        "eps_hat of two texts",
        mistakes={
            "the mask is inverted: True is the lower body": torch.tensor(
                [5.0, 1.0, 1.0, 5.0]
            ).expand(2, 3, 4),
            "this is the mean of both texts in every column": torch.full((2, 3, 4), 3.0),
            "this is their sum": torch.full((2, 3, 4), 6.0),
            "the other part is zero; it belongs to the other text": low * lower,
            "only the text of the lower body is left": low,
        },
    )
    return "Both texts see the whole x_s, so that each part knows of the other."
