"""Checks of notebook 09.

The batch of Algorithm 1 with its dropped past, what a linear fit sees of it, and the rate.
"""

import torch

from ._report import check, expect, expect_close

ALPHA_BAR = torch.tensor(
    [1.0, 0.64, 0.36, 0.0784], dtype=torch.float64
)  # a, b: (1, 0), (.8, .6), (.6, .8), (.28, .96)


@check
def batch_with_dropout(mine):
    """Check mine(past, future, s, alpha_bar, rate, u, noise).

    (past as the network sees it, noised future).
    """
    draw = torch.Generator().manual_seed(9)
    past, future, first, second = torch.randn(4, 4, 3, 2, generator=draw, dtype=torch.float64)
    s = torch.tensor([2, 1, 3, 2])
    u = torch.tensor([0.1, 0.7, 0.25, 0.9])
    rate = 0.3
    noise = torch.stack([first, second])
    given = past.clone(), future.clone()
    seen, x_s = _two(mine(*given, s, ALPHA_BAR, rate, u, noise))
    expect(
        torch.equal(given[0], past) and torch.equal(given[1], future),
        "the data themselves were changed; write the noised values into new arrays",
    )
    again = _two(mine(past.clone(), future.clone(), s, ALPHA_BAR, rate, u, noise))
    expect(
        all(
            torch.equal(one.nan_to_num(), two.nan_to_num())
            for one, two in zip((seen, x_s), again, strict=True)
        ),
        (
            "what you return differs from call to call; "
            "`u` and `noise` are given, so draw nothing yourself"
        ),
    )
    a = torch.tensor([0.6, 0.8, 0.28, 0.6]).double()[:, None, None]
    b = torch.tensor([0.8, 0.6, 0.96, 0.8]).double()[:, None, None]
    hit = torch.tensor([True, False, True, False])[:, None, None]
    mistakes = {
        "past and future are swapped in what you return": torch.where(
            hit, a * past + b * second, past
        ),
        "the first noise belongs to the future, the second to the past": a * future + b * second,
        "the future is always noised, not with probability `rate`": torch.where(
            hit, a * future + b * first, future
        ),
        **_wrong_noise(future, first, a, b),
    }
    expect_close(x_s, a * future + b * first, "the noised future", mistakes)
    touched = seen.shape == past.shape and (seen != past).all(-1)
    if touched is not False and (touched.any(1) != touched.all(1)).any():
        expect(
            False,
            (
                "some frames of a past were noised and others not; "
                "one u decides for the whole past of a sample"
            ),
        )
    noised = a * past + b * second
    mistakes = {
        "the mask is inverted: the pasts with `u < rate` are noised": torch.where(
            hit, past, noised
        ),
        ("every past is noised; each sample has its own u, and only u < rate means noise"): noised,
        "no past is noised yet": past,
        (
            "past and future have the same noise: the network could read the answer off the past"
        ): torch.where(hit, a * past + b * first, past),
        "this sets the past to zero; eq. 12 scales it and adds noise": torch.where(
            hit, 0 * past, past
        ),
        "do not divide by 1 - rate: only nn.Dropout does that": torch.where(hit, noised, past)
        / (1 - rate),
        "pasts without noise stay as they are: only nn.Dropout divides by 1 - rate": torch.where(
            hit, noised, past / (1 - rate)
        ),
        **{
            hint: torch.where(hit, wrong, past)
            for hint, wrong in _wrong_noise(past, second, a, b).items()
        },
    }
    expect_close(seen, torch.where(hit, noised, past), "the past as the network sees it", mistakes)
    return (
        "Each sample decides for itself, its whole past is noised, and the noise is its own: "
        "a mistake in any of these three raises no error."
    )


def _two(got) -> list[torch.Tensor]:
    """Past and future of an answer, however they are wrapped."""
    pair = isinstance(got, tuple | list | torch.Tensor) and len(got) == 2
    expect(pair, "return two arrays: the past as it is seen, and the noised future")
    for part, what in zip(
        got, ("the past as the network sees it", "the noised future"), strict=True
    ):
        loose = isinstance(part, tuple | list) and any(
            isinstance(one, torch.Tensor) for one in part
        )
        expect(not loose, f"{what} is a list of {len(part)} tensors; torch.stack makes one of them")
    return [torch.as_tensor(part) for part in got]


def _wrong_noise(x, noise, a, b) -> dict:
    """Eq. 12 on all samples, with one thing wrong in each."""
    early = torch.tensor([0.8, 1.0, 0.6, 0.8]).double()[:, None, None]
    return {
        "square roots are missing: alpha_bar is a share of power, not of amplitude": a**2 * x
        + b**2 * noise,
        "the root of alpha_bar is missing": a**2 * x + b * noise,
        "the root of 1 - alpha_bar is missing": a * x + b**2 * noise,
        "the signal is not scaled: multiply it by the root of alpha_bar": x + b * noise,
        "the noise is missing": a * x,
        "the noise is added, not subtracted": a * x - b * noise,
        "every sample has its own step; this uses the first one's for all": 0.6 * x + 0.8 * noise,
        "this takes alpha_bar one step too early; the table begins at s = 0": early * x
        + (1 - early**2).sqrt() * noise,
    }


@check
def dropped_products(mine):
    """Check mine(xx, past, rate, alpha_bar).

    The past has 2 entries and the control 1; the rate is 1/2, with two steps.
    """
    xx = torch.tensor([[2.0, 0.5, 1.0], [0.5, 3.0, -1.0], [1.0, -1.0, 4.0]], dtype=torch.float64)
    alpha_bar, rate = ALPHA_BAR[1:3], 0.5  # roots 0.8 and 0.6
    before = xx.clone()
    got = mine(xx, 2, rate, alpha_bar)
    expect(torch.equal(xx, before), "the products of the clean pasts were changed; work on a copy")
    # keep = 0.5 + 0.5 * 0.7, share = 0.5 + 0.5 * 0.5, floor = 0.5 * 0.5
    wanted = _products(xx, 0.85, 0.75, 0.25)
    mistakes = {
        (
            "past times past has two factors sqrt(alpha_bar): their product is alpha_bar itself"
        ): _products(xx, 0.85, 0.85, 0.25),
        "past times control has one factor sqrt(alpha_bar), not two": _products(
            xx, 0.75, 0.75, 0.25
        ),
        "this is the root of the mean; take the mean of the roots": _products(
            xx, 0.5 + 0.5 * 0.5**0.5, 0.75, 0.25
        ),
        "past times control is scaled as well": _products(xx, 1.0, 0.75, 0.25),
        "past times past has the mean of squares, not the square of the mean root": _products(
            xx, 0.85, 0.85**2, 0.25
        ),
        "the variance of the noise is added, whatever the noise's sign": _products(
            xx, 0.85, 0.75, -0.25
        ),
        "past times past is not scaled": _products(xx, 0.85, 1.0, 0.25),
        "the noise is missing: add its variance on the diagonal": _products(xx, 0.85, 0.75, 0.0),
        "only a share `rate` of the pasts is noised": _products(xx, 0.7, 0.5, 0.5),
        "the noise is there only with probability `rate`, too": _products(xx, 0.85, 0.75, 0.5),
        "the variance of the noise is 1 - alpha_bar, without a root": _products(
            xx, 0.85, 0.75, 0.5 * 0.7
        ),
        "the mask is inverted: 1 - rate of the pasts are clean": _products(
            xx, 0.5 + 0.5 * 0.7, 0.75, 0.75
        ),
        "only the past has noise; the control's diagonal stays": wanted
        + torch.diag(torch.tensor([0, 0, 0.25])),
        "the noises are independent: only the diagonal gets their variance": wanted
        + 0.25 * torch.tensor([[0.0, 1, 0], [1, 0, 0], [0, 0, 0]]),
        "the control is never dropped: its products stay": torch.diag(
            torch.tensor([0.25, 0.25, 0.0])
        ).double()
        + 0.75 * xx,
    }
    expect_close(got, wanted, "the products of half-dropped pasts", mistakes)
    few = mine(xx, 2, 0.25, torch.tensor([0.36], dtype=torch.float64))
    wrong = {"1 - rate and rate are swapped": _products(xx, 0.7, 0.52, 0.48)}
    expect_close(
        few, _products(xx, 0.9, 0.84, 0.16), "the products at a rate of 1/4 and one step", wrong
    )
    return "For least squares, the noise is no more than a diagonal: a ridge."


def _products(xx, keep: float, share: float, floor: float):
    past = share * xx[:2, :2] + floor * torch.eye(2)
    return torch.cat(
        [torch.cat([past, keep * xx[:2, 2:]], 1), torch.cat([keep * xx[2:, :2], xx[2:, 2:]], 1)], 0
    )


@check
def rate_schedule(mine):
    """mine(done, rates, start): 0 until `start`, then the rates one after the other."""
    rates, times = (0.1, 0.2, 0.4), torch.tensor([0.0, 0.39, 0.41, 0.59, 0.61, 0.79, 0.81, 0.999])
    got = [float(mine(float(t), rates, 0.4)) for t in times]
    steps = torch.tensor([0, 0, 0.1, 0.1, 0.2, 0.2, 0.4, 0.4])
    evenly = ((times - 0.4).clamp(min=0) / 0.6) * 0.4
    mistakes = {
        "the rates begin at once: until `start` the rate is 0": torch.tensor(
            [0.1, 0.2, 0.2, 0.2, 0.2, 0.4, 0.4, 0.4]
        ),
        "the rate jumps to the last one at once; it rises step by step": torch.where(
            steps > 0, 0.4, 0.0
        ),
        "the rates go down from the highest one; they should rise": torch.tensor(
            [0, 0, 0.4, 0.4, 0.2, 0.2, 0.1, 0.1]
        ),
        "the rate rises in steps, not continuously": evenly,
        (
            "the first rate is missing, or comes too late: each rate has a third of the time left"
        ): torch.tensor([0, 0, 0, 0, 0.1, 0.1, 0.2, 0.2]),
        "the rates share the time after `start`, not the whole training": torch.tensor(
            [0, 0, 0.2, 0.2, 0.2, 0.4, 0.4, 0.4]
        ),
        "the rates are 0 after `start` and not before it": torch.tensor(
            [0.1, 0.1, 0, 0, 0, 0, 0, 0]
        ),
    }
    expect_close(
        got,
        steps,
        "the rate at 0, .39, .41, .59, .61, .79, .81 and .999, with start = .4",
        mistakes,
    )
    expect_close(
        mine(1.0, rates, 0.4),
        0.4,
        "the rate at the end of training",
        {"the last rate stays until the end": 0.0},
    )
    return (
        "With the paper's rates, .05 to .25, and start = .5, "
        "half of the training has no noised pasts."
    )
