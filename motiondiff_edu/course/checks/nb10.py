"""Checks of notebook 10: there and back."""

import numpy as np
import torch

from ._report import check, expect, expect_close

T_H = 3


def walk_on(past: torch.Tensor, control: torch.Tensor) -> torch.Tensor:
    """A walker whose pose is two numbers, (B, 3, 2).

    Column 0 of the control changes the first number, column 2 the second.
    """
    steps = control[:, T_H - 1 : 2 * T_H - 1][..., [0, 2]]
    return past[:, -1:] + steps.cumsum(1)


class Watched:
    """A `walk_on` that counts its calls.

    It refuses a past or a control that is too short.
    """

    def __init__(self):
        self.calls = 0

    def __call__(self, past: torch.Tensor, control: torch.Tensor) -> torch.Tensor:
        self.calls += 1
        rows = control.shape[1]
        call = f"call {self.calls} of walk_on got"
        expect(
            past.shape == (2, T_H, 2),
            (f"{call} a past {tuple(past.shape)}; it needs all T_h = {T_H} frames, (2, {T_H}, 2)"),
        )
        expect(
            control.shape == (2, 2 * T_H, 3),
            (
                f"{call} {rows} rows of control; it needs all {2 * T_H}: "
                f"{T_H} for the past, {T_H} for the new frames"
            ),
        )
        return walk_on(past, control)


def back_in_time(control: torch.Tensor) -> torch.Tensor:
    """-control[T - 2 - t], the last row repeated."""
    reversed_ = -control[:, :-1].flip(1)
    return torch.cat([reversed_, reversed_[:, -1:]], dim=1)


def one_round(past, known, start, control, reverse=back_in_time, flip_ahead=True, flip_back=True):
    """One round from the filled past: what the walker gives for each of the past frames."""
    filled = torch.where(known, past, start)
    ahead = walk_on(filled, control)
    back = walk_on(ahead.flip(1) if flip_ahead else ahead, reverse(control))
    return back.flip(1) if flip_back else back


def material():
    """Past with NaN in its holes, mask, mean pose, control, and the result of one round.

    All are worked out by hand. The last frame of sample 0 is known: the way there ends at
    (12, 14.25), and the way back goes through the true places. In the last frame of sample 1 only
    the first number is known: the other starts at its mean 9 and comes back to 9.
    """
    nan = float("nan")
    past = torch.tensor(
        [[[1.0, nan], [nan, nan], [4.0, 5.0]], [[2.0, 7.0], [nan, 6.0], [5.0, nan]]]
    )
    control = torch.tensor(
        [[1.0, 0.4, 2], [2, 0.3, 0.5], [4, 0.2, 1], [3, 0.1, 0.25], [1, 0.6, 8], [16, 0.5, 32]]
    )
    wanted = torch.tensor([[[1.0, 2.5], [2, 4.5], [4, 5]], [[2.0, 7.0], [3, 6.0], [5, 9]]])
    return past, ~torch.isnan(past), torch.tensor([8.0, 9.0]), control.expand(2, -1, -1), wanted


@check
def time_reversal(mine):
    """mine(control (B, T, 3)): the control of the same walk played backwards."""
    control = (
        torch.tensor([[1.0, 0.5, 4], [2, 0.25, 8], [3, 0.125, 16], [7, 0.75, 32]])
        .expand(2, -1, -1)
        .clone()
    )
    control[1] *= -10
    kept = control.clone()
    wanted = torch.tensor([[-3.0, -0.125, -16], [-2, -0.25, -8], [-1, -0.5, -4], [-1, -0.5, -4]])
    wanted = torch.stack([wanted, -10 * wanted])
    flipped = control.flip(1)
    last = torch.cat([wanted[:, :3], -control[:, :1] * 0], dim=1)
    expect_close(
        mine(control),
        wanted,
        "the control of two walks, played backwards",
        mistakes={
            "only the order is reversed; a walk backwards has a negative speed": flipped,
            (
                "the signs are right; but control[t] leads from frame t to t + 1, "
                "so the rows move by one"
            ): -flipped,
            "order and shift are right, the signs are not": -wanted,
            "turning has a sign, too: a left turn is a right turn on the way back": wanted
            * torch.tensor([1, 1, -1.0]),
            "speed to the left has a sign, too": wanted * torch.tensor([1, -1.0, 1]),
            "the last row repeats the one before, it is not zero": last,
            "the signs are right, but the rows are in the old order": -control,
            "nothing has changed": kept,
            "the sample axis was reversed; time is axis 1": wanted.flip(0),
        },
    )
    expect(
        torch.equal(control, kept),
        "your function changes the control it was given; build a new one",
    )
    return "Backwards in time, all three velocities change their sign, and all rows move by one."


@check
def there_and_back(mine):
    """mine(walk_on, past, known, mean, control): one round; past has NaN in its holes."""
    past, known, mean, control, wanted = material()
    given = past.clone()
    watched = Watched()
    answer = mine(watched, past, known, mean, control)
    expect(
        np.shape(answer) == (2, 3, 2),
        f"the past has shape (2, 3, 2), your answer {np.shape(answer)}",
    )
    expect(
        torch.equal(past.nan_to_num(-1), given.nan_to_num(-1)),
        "your function changes the past it was given",
    )
    answer = torch.as_tensor(answer)
    expect(
        not torch.isnan(answer[~known]).any(),
        "there is NaN in the holes. Either the walker got NaN, or the holes were not filled from "
        "the way back (known * past is NaN, too: use torch.where)",
    )
    expect(
        watched.calls == 2,
        (
            f"calls of walk_on: {watched.calls}; one round takes two: "
            "there, and back from the result"
        ),
    )

    def variant(reverse=back_in_time, flip_ahead=True, flip_back=True):
        how = (reverse, flip_ahead, flip_back)
        return torch.where(known, past, one_round(past, known, mean, control, *how))

    right = one_round(past, known, mean, control)
    zero = torch.where(known, past, one_round(past, known, torch.zeros(2), control))
    expect_close(
        answer,
        wanted,
        "the past after one round",
        mistakes={
            "the control is reversed in order only; its signs must change": variant(
                reverse=lambda c: c.flip(1)
            ),
            "the control is negated, but not shifted by its one frame": variant(
                reverse=lambda c: -c.flip(1)
            ),
            "the control of the way back is that of the way there": variant(reverse=lambda c: c),
            "turning (column 2) keeps its sign on your way back": variant(
                reverse=lambda c: back_in_time(c) * torch.tensor([1, 1, -1.0])
            ),
            "the new frames are not reversed before they go into the walker again": variant(
                flip_ahead=False
            ),
            "the result of the way back is reversed in time; reverse it before you fill": variant(
                flip_back=False
            ),
            "time was never reversed: walking on twice leads farther ahead": variant(
                flip_ahead=False, flip_back=False
            ),
            (
                "neither time nor the control was reversed: walking on twice leads farther ahead"
            ): variant(reverse=lambda c: c, flip_ahead=False, flip_back=False),
            "the mask is inverted: known is True where something was given": torch.where(
                known, right, torch.where(known, past, mean)
            ),
            "the given entries are overwritten by the walker's": right,
            "holes start at 0 metres, which is on the floor; start them at the mean pose": zero,
            "the holes still have their starting values": torch.where(known, past, mean),
        },
    )
    return (
        "One number of sample 1 is still its mean: the toy walker of this check knows nothing of "
        "bodies, and has nothing better for it."
    )


@check
def moved_by(mine):
    """mine(before, after, known): how far the holes moved, RMS, one number for each sample."""
    before = torch.zeros(2, 4, 3)
    known = torch.ones(2, 4, 3, dtype=torch.bool)
    known[0, 1] = False  # three holes that move by 3, 4 and 0; in sample 1 two that move by 1 and 7
    known[1, 2:, 0] = False
    after = before + 100.0
    after[0, 1] = torch.tensor([3.0, 4.0, 0.0])
    after[1, 2:, 0] = torch.tensor([1.0, 7.0])
    moved = (after - before).square()
    missing = ~known
    wanted = [(25 / 3) ** 0.5, 5.0]
    given = {"before": before, "after": after, "known": known}
    kept = {name: x.clone() for name, x in given.items()}
    answer = mine(before, after, known)
    expect_close(
        answer,
        wanted,
        "the change of two samples",
        mistakes={
            "that is the mean of squares; take its root": [25 / 3, 25.0],
            "known entries are counted, too; measure only the holes": moved.flatten(1)
            .mean(1)
            .sqrt(),
            "the known entries were measured instead of the holes": (moved * known)
            .flatten(1)
            .sum(1)
            .sqrt()
            / known.flatten(1).sum(1).sqrt(),
            "this is divided by the number of all entries; divide by the number of holes": (
                (moved * missing).flatten(1).mean(1)
            ).sqrt(),
            "this is one number for both samples; return one for each": (
                moved[missing].mean()
            ).sqrt(),
            "that is the mean distance; the rule takes the root of the mean square": [7 / 3, 4.0],
            "that is the root of the sum; divide by the number of holes first": [5.0, 50.0**0.5],
        },
    )
    for name, x in given.items():
        expect(
            torch.equal(x, kept[name]),
            f"your function changes the `{name}` it was given; build a new tensor",
        )
    whole = mine(before, after, torch.ones_like(known))
    expect(
        torch.equal(torch.as_tensor(whole), torch.zeros(2)),
        "where nothing is missing the change is 0; yours is not (0 / 0?)",
    )
    return "Each sample has its own change, but the loop runs until all of them are small."
