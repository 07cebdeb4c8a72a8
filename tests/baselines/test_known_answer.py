"""Ways of filling in, against conditionals that are known.

Closed forms, and draws that have the right answer.
"""

import math
from dataclasses import replace

import pytest
import torch
from seeds import seeded

from data_synth.mixtures import crossed_bars, ring
from motiondiff_edu.baselines.known_answer import (
    ConditionalSampler,
    Method,
    Problem,
    by_method,
    conditional_errors,
    draw_samples,
    errors_of,
    there_and_back,
)
from motiondiff_edu.ddpm import cosine_schedule
from motiondiff_edu.exact import conditional, exact_denoiser, mixture, sample_mixture

SCHEDULE = cosine_schedule(40)
RHO = 0.8


def problem_of(truth, values, known, past=None):
    return Problem(
        truth,
        exact_denoiser(truth, SCHEDULE),
        SCHEDULE,
        torch.tensor(values, dtype=torch.float64),
        torch.tensor(known),
        None if past is None else torch.tensor(past),
    )


def correlated():
    return mixture(torch.ones(1), torch.zeros(1, 2), torch.tensor([[[1.0, RHO], [RHO, 1.0]]]))


def masked_by_hand(x: float, visited: list[int], resample: int) -> tuple[float, float]:
    """Mean and variance of the second coordinate, the first given.

    Every step of masked sampling is linear in it.
    """
    alpha_bar = SCHEDULE.alpha_bar.tolist()
    mean = 0.0
    variance = 1.0
    for s, after in zip(visited, [*visited[1:], 0], strict=True):
        now, then = alpha_bar[s], alpha_bar[after]
        # x_s has variances 1 and covariance now * RHO: the regression of the clean second
        # coordinate on both
        c = now * RHO
        of_x = math.sqrt(now) * (RHO - c) / (1 - c * c)
        of_y = math.sqrt(now) * (1 - RHO * c) / (1 - c * c)
        sigma = math.sqrt((1 - then) / (1 - now) * (1 - now / then))
        keep = math.sqrt(max(1 - then - sigma**2, 0.0) / (1 - now))
        to_x0 = math.sqrt(then) - keep * math.sqrt(now)
        B, C = to_x0 * of_x, to_x0 * of_y + keep
        for turn in range(resample if after else 1):
            if turn:  # back again
                mean = mean * math.sqrt(now / then)
                variance = variance * now / then + 1 - now / then
            mean = B * math.sqrt(now) * x + C * mean
            variance = B * B * (1 - now) + C * C * variance + sigma**2
    return mean, variance


@pytest.mark.parametrize("steps, resample", [(5, 1), (40, 1), (20, 3)])
def test_masked_sampling_of_a_gaussian_is_a_recursion_done_by_hand(steps, resample):
    problem = problem_of(correlated(), [1.5, math.nan], [True, False])
    mean, variance = masked_by_hand(1.5, [40 - i * 40 // steps for i in range(steps)], resample)
    x = draw_samples(problem, Method("masked", steps, resample), 3000, seeded(1))[:, 1]
    assert x.mean().item() == pytest.approx(mean, abs=4 * math.sqrt(variance / 3000))
    assert x.var().item() == pytest.approx(variance, rel=0.12)


def test_a_blended_way_draws_the_guess_through_what_is_given():
    """One step of independent entries.

    The guess is next to nothing, and what is left is the correction, by hand.
    """
    truth = mixture(torch.ones(1), torch.zeros(1, 6), torch.eye(6)[None])
    problem = problem_of(truth, [1.0, 0, 3.0, 0, 0, 0], [True, False, True, False, False, False])
    problem = replace(problem, frames=6)
    plain, blended = (
        draw_samples(problem, Method("masked", 1, blend=b), 500, seeded(7)).mean(0).tolist()
        for b in (None, 3)
    )
    assert plain == pytest.approx([1, 0, 3, 0, 0, 0], abs=0.02)
    assert blended == pytest.approx([1, 2, 3, 3 * 0.75, 3 * 0.5, 3 * 0.25], abs=0.02)


def test_a_guided_way_hears_of_what_is_given():
    problem = problem_of(correlated(), [1.5, math.nan], [True, False])
    ways = Method("masked", 40), Method("masked", 40, guidance=1.0)
    plain, guided = (e.mean for _, _, e in conditional_errors(problem, ways, seeds=[8], n=1000))
    assert guided < 0.5 * plain


def test_by_hand_masking_misses_and_resampling_mends():
    wanted, deviation = 1.5 * RHO, math.sqrt(1 - RHO**2)
    every = list(range(40, 0, -1))
    off = {r: (wanted - masked_by_hand(1.5, every, r)[0]) / deviation for r in (1, 3, 30)}
    assert off[1] > 0.5 and off[3] < 0.5 * off[1] and abs(off[30]) < 0.05


def test_errors_are_in_units_of_the_wanted():
    problem = problem_of(correlated(), [1.0, 0.0], [True, False])
    deviation = math.sqrt(1 - RHO**2)
    z = torch.tensor([-1.0, 1.0], dtype=torch.float64)
    x = torch.stack(
        [torch.ones(2, dtype=torch.float64), RHO + deviation * (0.5 + 3 * z / math.sqrt(2))], 1
    )
    found = errors_of(x, problem)
    assert (found.mean, found.spread, found.share) == pytest.approx((0.5, 3.0, 0.0))


def test_shares_of_the_parts_are_compared():
    """All samples in one hill, where the wanted has two that are alike.

    Half of the mass is in the wrong place.
    """
    problem = problem_of(ring(6), [0.75, 0.0], [True, False])
    low = torch.tensor([[0.75, -1.3]], dtype=torch.float64).expand(7, 2)
    assert errors_of(low, problem).share == pytest.approx(0.5, abs=0.01)


def test_the_rest_is_drawn_from_the_conditional():
    truth, known = crossed_bars(), torch.tensor([True, False])
    x = torch.tensor([[-0.9, 9.0], [0.6, 9.0]], dtype=torch.float64).repeat(4000, 1)
    drawn = ConditionalSampler(truth, known).draw(x, seeded(2))
    assert torch.equal(drawn[:, 0], x[:, 0])
    for i, value in enumerate((-0.9, 0.6)):
        wanted = conditional(truth, torch.tensor([value, 0.0]), known)
        mine = drawn[i::2, 1]
        assert mine.mean().item() == pytest.approx(wanted.mean().item(), abs=0.03)
        assert mine.std().item() == pytest.approx(wanted.covariance().item() ** 0.5, rel=0.06)


def chain(seen: float = 0.6):
    """Known, hole, future.

    Neighbours correlate by `seen`, and known and future through the hole only.
    """
    c = torch.tensor([[[1.0, seen, seen**2], [seen, 1.0, seen], [seen**2, seen, 1.0]]])
    return mixture(torch.ones(1), torch.zeros(1, 3), c)


def test_there_and_back_hears_of_the_known_through_the_future_only_and_gibbs_does_not():
    """In this chain the future hears nothing but the hole.

    There-and-back forgets the known wholly, by hand.
    """
    problem = problem_of(chain(), [2.0, 0.0, 0.0], [True, False, False], [True, True, False])
    found = {
        way.kind: e
        for way, _, e in conditional_errors(
            problem, (Method("there-and-back"), Method("gibbs")), seeds=[3], n=4000
        )
    }
    deviation = math.sqrt(1 - 0.36)
    assert found["there-and-back"].mean == pytest.approx(0.6 * 2 / deviation, rel=0.05)
    assert found["there-and-back"].spread == pytest.approx(1 / deviation, rel=0.05)
    assert found["gibbs"].mean < 0.06 and found["gibbs"].spread == pytest.approx(1, abs=0.06)


@pytest.mark.parametrize("kind", ["there-and-back", "gibbs"])
@pytest.mark.parametrize("past", [[True, False, False], [True, True, False]])
def test_what_is_known_of_the_future_is_given_too(kind, past):
    """The last entry is known.

    With nothing known of the past both ways are Gibbs sampling, and come to the wanted.
    """
    problem = problem_of(chain(), [math.nan, math.nan, 2.0], [False, False, True], past)
    x = draw_samples(problem, Method(kind), 4000, seeded(6))
    assert (x[:, 2] == 2).all()
    assert x.mean(0).tolist() == pytest.approx([2 * 0.36, 2 * 0.6, 2.0], abs=0.06)
    assert x.var(0).tolist() == pytest.approx([1 - 0.36**2, 1 - 0.6**2, 0.0], abs=0.06)


def test_exact_draws_have_no_error_but_that_of_counting():
    problem = problem_of(crossed_bars(), [-0.9, math.nan], [True, False])
    ((way, seed, found),) = conditional_errors(problem, [Method("exact")], seeds=[4], n=4000)
    assert (way.name, seed) == ("exact", 4)
    assert found.mean < 0.06 and found.spread == pytest.approx(1, abs=0.05) and found.share < 0.02


def test_what_is_known_stays_and_seeds_repeat():
    problem = problem_of(
        chain(), [2.0, math.nan, math.nan], [True, False, False], [True, True, False]
    )
    ways = (
        Method("exact"),
        Method("masked", 10, 2),
        Method("there-and-back", rounds=2),
        Method("gibbs", rounds=2),
    )
    for way in ways:
        x, again = (draw_samples(problem, way, 5, seeded(5)) for _ in range(2))
        assert torch.equal(x, again) and (x[:, 0] == 2).all() and torch.isfinite(x).all(), way
    table = by_method(conditional_errors(problem, ways, seeds=[0, 1], n=5))
    assert list(table) == ["exact", "masked.10.x2", "there-and-back.2", "gibbs.2"]
    assert all(len(values) == 2 for row in table.values() for values in row.values())


def test_wrong_inputs():
    with pytest.raises(ValueError, match="not 'repaint'"):
        Method("repaint")
    problem = replace(problem_of(chain(), [2.0, 0.0, 0.0], [True, False, False]))
    with pytest.raises(ValueError, match="set `past`"):
        there_and_back(problem, sample_mixture(chain(), 2), 1, seeded())
