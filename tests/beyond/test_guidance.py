"""Guidance and blending by hand, on tasks whose answer is known, and what they refuse."""

import pytest
import torch
from two_numbers import correlated, given_first

from motiondiff_edu.beyond.guidance import blended, blended_guess, guided, guided_guess, with_guess
from motiondiff_edu.ddpm import cosine_schedule
from motiondiff_edu.exact import conditional, exact_denoiser, mixture
from motiondiff_edu.inbetweening import inpaint_steps
from motiondiff_edu.prediction import x0_from_eps

SCHEDULE = cosine_schedule(100)


def seeded(seed: int = 0) -> torch.Generator:
    return torch.Generator().manual_seed(seed)


def last(loop):
    *_, end = loop
    return end.x_s


def test_blending_carries_the_correction_and_fades():
    made, given = torch.zeros(1, 9, 2), torch.full((1, 9, 2), float("nan"))
    given[0, 4, 0] = 1.0
    given[0, 2, 1], given[0, 6, 1] = 1.0, 3.0
    out = blended_guess(made, given, ~given.isnan(), 3)[0]
    torch.testing.assert_close(out[:, 0], torch.tensor([0, 0.25, 0.5, 0.75, 1, 0.75, 0.5, 0.25, 0]))
    torch.testing.assert_close(out[:, 1], torch.tensor([0.5, 0.75, 1, 1.5, 2, 2.5, 3, 2.25, 1.5]))
    assert torch.equal(blended_guess(made, given, torch.zeros(1, 9, 2, dtype=torch.bool), 3), made)
    stays = blended_guess(made, given, ~given.isnan(), torch.tensor([torch.inf, 0.0]))[0]
    torch.testing.assert_close(stays[:, 0], torch.ones(9))
    torch.testing.assert_close(stays[:, 1], torch.tensor([0, 0, 1, 1.5, 2, 2.5, 3, 0, 0]))
    right = torch.randn(1, 9, 2)
    assert torch.equal(blended_guess(right, right, ~given.isnan(), 3), right)
    with torch.device("meta"):  # another default device: what is made must go by the inputs
        assert torch.equal(blended_guess(made, given, ~given.isnan(), 3)[0], out)


def test_blending_at_every_step_leaves_no_jump_where_masking_does():
    """A denoiser that knows nothing of the given (its guess is 1 everywhere).

    Masking pops, blending does not.
    """
    given = torch.linspace(3, 5, 30).view(1, 30, 1)
    known = torch.ones(1, 30, 1, dtype=torch.bool)
    known[:, 10:20] = False

    def denoise(x, s):
        alpha_bar = SCHEDULE.alpha_bar[s].view(-1, 1, 1).float()
        return (x - alpha_bar.sqrt()) / (1 - alpha_bar).sqrt()

    options = {"steps": 10, "generator": seeded()}
    drawn = blended(denoise, SCHEDULE, given, known, fade=3)
    plain, blent = (
        last(inpaint_steps(who, torch.randn(1, 30, 1), SCHEDULE, given, known, **options))
        for who in (denoise, drawn)
    )
    assert plain.diff(dim=1).abs().max() > 2 and blent.diff(dim=1).abs().max() < 0.2


@pytest.mark.parametrize("eta, wild, tame", [(0.0, 4.0, 1.1), (0.5, 2.0, 1.1)])
def test_a_bounded_guess_does_not_blow_up_an_error_of_one_percent(eta, wild, tame):
    """At s = S an error of eps counts b / a times: the made entries are five times too wide."""
    schedule, n = cosine_schedule(1000), 2000
    exact = exact_denoiser(correlated(0.3), schedule)
    known, given = torch.tensor([True, False]).expand(n, 2), torch.randn(n, 2, generator=seeded(1))

    def off(x, s):
        return 1.01 * exact(x, s)

    held = with_guess(off, schedule, lambda x0: x0.clamp(-5, 5))
    free, bounded = (
        last(inpaint_steps(who, start, schedule, given, known, eta=eta, generator=seeded(3)))
        for who, start in ((who, torch.randn(n, 2, generator=seeded(2))) for who in (off, held))
    )
    assert free[:, 1].std() > wild and 0.7 < bounded[:, 1].std() < tame


def test_guidance_moves_what_goes_with_the_given():
    """With the exact denoiser of two numbers that agree, the given one moves the other.

    The unknown one comes nearer to where the known one says.
    """
    truth, n = correlated(0.9), 2000
    given, known = given_first(1.8, n)
    wanted = conditional(truth, given[0].nan_to_num(), known[0]).mean().item()
    start = torch.randn(n, 2, generator=seeded(1))
    denoise = exact_denoiser(truth, SCHEDULE)
    off = {}
    for guidance in (0.0, 1.0):
        who = guided(denoise, SCHEDULE, given, known, guidance) if guidance else denoise
        loop = inpaint_steps(who, start, SCHEDULE, given, known, generator=seeded(2))
        off[guidance] = abs(last(loop)[:, 1].mean().item() - wanted)
    assert off[1.0] < 0.5 * off[0.0], off


def test_one_guided_guess_by_hand():
    """J is known for a linear denoiser.

    x0_hat = M x, so the pull is M^T r, as long as leaves least wrong.
    """
    M = torch.tensor([[0.5, 0.3], [0.3, 0.5]])
    x = torch.tensor([[1.0, 2.0]])
    known = torch.tensor([[True, False]])
    alpha_bar = SCHEDULE.alpha_bar[40].item()

    def denoise(x, s):
        return (x - alpha_bar**0.5 * x @ M.T) / (1 - alpha_bar) ** 0.5

    given, s = torch.tensor([[3.0, 0.0]]), torch.tensor([40])
    out = guided_guess(denoise, x, s, SCHEDULE, given, known, 1.0)
    x0_hat = torch.tensor([1.1, 1.3])
    pull = M.T @ torch.tensor([3.0 - 1.1, 0.0])
    torch.testing.assert_close(out[0], x0_hat + pull * (3.0 - 1.1) / pull[0])
    assert out[0, 0] == pytest.approx(3.0)  # one given entry is met at once
    eps_hat = guided(denoise, SCHEDULE, given, known)(x, s)
    torch.testing.assert_close(alpha_bar**0.5 * out + (1 - alpha_bar) ** 0.5 * eps_hat, x)


def test_many_moves_of_guidance_solve_for_all_given_entries():
    """For a Gaussian J is a covariance C, so the end is x0_hat + C_uk C_kk^-1 error."""
    root = torch.randn(6, 6, generator=seeded(3), dtype=torch.float64)
    covariance = root @ root.T / 6 + 0.3 * torch.eye(6)
    truth = mixture(torch.ones(1), torch.randn(1, 6, generator=seeded(4)), covariance[None])
    denoise, s = exact_denoiser(truth, SCHEDULE), torch.full((7,), 40)
    x, given = (torch.randn(7, 6, generator=seeded(k), dtype=torch.float64) for k in (5, 6))
    known = torch.tensor([True, False, True, False, False, True]).expand(7, 6)

    def guess(moves: int, weight: float = 1.0):
        return guided_guess(denoise, x, s, SCHEDULE, given, known, weight, moves)

    a = SCHEDULE.alpha_bar[40].item()
    plain = x0_from_eps(x, s, denoise(x, s), SCHEDULE)
    J = a**0.5 * covariance @ torch.linalg.inv(a * covariance + (1 - a) * torch.eye(6))
    here = known[0]
    pull = J[:, here] @ torch.linalg.solve(J[here][:, here], (given - plain)[:, here].T)
    torch.testing.assert_close(guess(300), plain + pull.T, atol=1e-3, rtol=1e-3)
    torch.testing.assert_close(guess(300, 0.5), plain + 0.5 * pull.T, atol=1e-3, rtol=1e-3)
    missed = [(guess(moves) - given)[known].norm() for moves in (1, 2, 4, 8)]
    assert all(later < 0.9 * sooner for sooner, later in zip(missed, missed[1:], strict=False))


def test_a_move_that_would_lead_away_is_not_made():
    """The Jacobian of a network need not be that of a covariance: here J J^T is, and J is not."""
    J = torch.tensor([[0.0, -0.5], [-0.5, 0.0]])
    x, s = torch.tensor([[1.0, 2.0]]), torch.tensor([40])
    alpha_bar = SCHEDULE.alpha_bar[40].item()

    def denoise(turn):
        return lambda x, s: (x - alpha_bar**0.5 * x @ turn.T) / (1 - alpha_bar) ** 0.5

    given, known = torch.tensor([[3.0, 2.0]]), torch.tensor([[True, True]])
    plain = x @ J.T  # [-1, -0.5]: errors 4 and 2.5, and J^T error is [-1.25, -2]
    out = guided_guess(denoise(J), x, s, SCHEDULE, given, known, 1.0)
    torch.testing.assert_close(out, plain)
    back = guided_guess(denoise(-J), x, s, SCHEDULE, given, known, 1.0)  # [1, .5]: it leads there
    assert (back - given).norm() < 0.8 * (x @ -J.T - given).norm()
