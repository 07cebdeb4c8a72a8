"""Checks of notebook 05.

Back to x0 from any target, the averaged weights, and the weight between two losses.
"""

import numpy as np
import torch

from ._report import check, expect, expect_close


@check
def back_to_x0(mine):
    """Check mine(output, x_s, alpha_bar, target).

    Each of eps, x0 and v leads back to the same x0, worked out by hand.
    """
    # a = 0.8, b = 0.6 and a = 0.6, b = 0.8; x0 = 2, -1 and eps = -1, 3 by hand
    alpha_bar = torch.tensor([0.64, 0.36])
    x0, x_s = torch.tensor([2.0, -1.0]), torch.tensor([1.0, 1.8])
    outputs = {"eps": torch.tensor([-1.0, 3.0]), "x0": x0, "v": torch.tensor([-2.0, 2.6])}
    a, b = torch.tensor([0.8, 0.6]), torch.tensor([0.6, 0.8])
    for target, output in outputs.items():
        roots_dropped = _convert(output, x_s, alpha_bar, 1 - alpha_bar)[target]
        mistakes = {
            "a is the square root of alpha_bar, b that of 1 - alpha_bar": roots_dropped,
            "a and b are swapped": _convert(output, x_s, b, a)[target],
            "check the sign: x_s = a x0 + b eps, v = a eps - b x0": (
                _convert(-output, x_s, a, b)[target]
            ),
            "this is the noise; return x0": {
                "eps": output,
                "x0": (x_s - a * x0) / b,
                "v": a * output + b * x_s,
            }[target],
            "undo the mixing completely: divide by a": x_s - b * output,
        }
        expect_close(
            mine(output, x_s, alpha_bar, target),
            x0,
            f"x0 from a network that predicts {target}",
            mistakes,
        )
    return "The three targets differ by one rotation: its angle has the cosine a."


def _convert(output, x_s, a, b) -> dict:
    return {"eps": (x_s - b * output) / a, "x0": output, "v": a * x_s - b * output}


@check
def averaged_weights(mine):
    """mine(means, new, decay) -> new averages; the old ones stay as they are."""
    means = [np.array([1.0, -2.0]), np.zeros(3)]
    new = [np.array([2.0, 2.0]), np.array([10.0, 0.0, -5.0])]
    got = mine(means, new, 0.9)
    expect(got is not None, "your answer returns nothing; return the new list of averages")
    expect(len(got) == 2, f"two arrays went in, {len(got)} came out")
    mistakes = {
        "the shares are swapped: with decay 0.9, nine tenths of the old average stay": 0.1
        * means[0]
        + 0.9 * new[0],
        "this adds the new weights in full; they get the share 1 - decay": 0.9 * means[0] + new[0],
        "this is the plain mean of the two": 0.5 * (means[0] + new[0]),
    }
    expect_close(got[0], [1.1, -1.6], "the average of (1, -2) and (2, 2) with decay 0.9", mistakes)
    expect_close(got[1], [1.0, 0.0, -0.5], "the second array")
    expect_close(means[0], [1.0, -2.0], "the old average (it must not be changed in place)")
    return "After 1 / (1 - decay) steps about a third of the old average is left."


@check
def weight_between_losses(mine):
    """mine(alpha_bar): the squared error of x0 over that of eps, for each alpha_bar."""
    alpha_bar = torch.tensor([0.9, 0.5, 0.2, 0.01])
    wanted = torch.tensor([1 / 9, 1.0, 4.0, 99.0])
    mistakes = {
        "this is the error of eps over that of x0; take the inverse": 1 / wanted,
        "the errors are squared, so the factor is squared, too": wanted.sqrt(),
        "this is squared once too often: alpha_bar is already a square": wanted**2,
        "x0_hat - x0 has a in the denominator as well": 1 - alpha_bar,
    }
    expect_close(mine(alpha_bar), wanted, "the weight at alpha_bar = 0.9, 0.5, 0.2, 0.01", mistakes)
    return (
        "The target decides which steps count: "
        "an unweighted eps loss gives little weight to high noise."
    )
