"""Around lines: the lines by hand, the same samples as of the remainder, and the exact answer."""

import pytest
import torch
from two_numbers import correlated

from motiondiff_edu.beyond.around_lines import Shown, around_lines, lines_through
from motiondiff_edu.ddpm import cosine_schedule, ddim_steps, final, q_sample
from motiondiff_edu.exact import conditional, exact_denoiser, mixture
from motiondiff_edu.inbetweening import inpaint_steps
from motiondiff_edu.prediction import x0_from_eps

SCHEDULE = cosine_schedule(100)


def seeded(seed: int = 0) -> torch.Generator:
    return torch.Generator().manual_seed(seed)


def test_lines_go_from_each_given_entry_to_the_next_and_stay_outside():
    given = torch.full((1, 7, 3), float("nan"))
    given[0, 1, 0], given[0, 5, 0] = 2.0, 4.0
    given[0, 3, 1] = -1.0
    lines = lines_through(given, ~given.isnan())[0]
    torch.testing.assert_close(lines[:, 0], torch.tensor([2, 2, 2.5, 3, 3.5, 4, 4]))
    torch.testing.assert_close(lines[:, 1], torch.full((7,), -1.0))
    assert torch.equal(lines[:, 2], torch.zeros(7))


def test_the_remainder_is_zero_where_something_is_given():
    x0, known = torch.randn(4, 20, 6, generator=seeded()), torch.rand(4, 20, 6) < 0.3
    shown = Shown.of(x0, known)
    assert ((x0 - shown.lines)[known]).abs().max() < 1e-6
    nothing = Shown.of(x0, torch.zeros_like(known))
    assert torch.equal(nothing.lines, torch.zeros_like(x0))


@pytest.mark.parametrize("s", [1, 40, 100])
def test_guess_and_noise_are_those_of_the_remainder(s):
    x0, lines, eps = torch.randn(3, 2, 5, 4, generator=seeded()).unbind()
    steps = torch.full((2,), s)
    asked = []

    def perfect(r_s, steps):  # it is asked about the remainder's own noised version
        asked.append(r_s)
        return eps

    x_s = q_sample(x0, s, SCHEDULE, eps)
    eps_hat = around_lines(perfect, SCHEDULE, lines)(x_s, steps)
    torch.testing.assert_close(asked[0], q_sample(x0 - lines, s, SCHEDULE, eps))
    if s < 100:
        torch.testing.assert_close(
            x0_from_eps(x_s, steps, eps_hat, SCHEDULE), x0, atol=1e-4, rtol=0
        )


def test_an_exact_remainder_gives_exact_samples_of_the_rest():
    """Two correlated numbers as two frames, of which the first is given."""
    first, n = 0.8, 4000
    rest = conditional(correlated(), torch.tensor([first, 0.0]), torch.tensor([True, False]))
    mean, variance = float(rest.means[0, 0]), float(rest.variances[0, 0])
    assert (mean, variance) == pytest.approx((-0.2 + 0.9 * 0.5, 1 - 0.9**2))
    known = torch.tensor([True, False]).view(1, 2, 1).expand(n, 2, 1)
    given = torch.tensor([first, 0.0]).view(1, 2, 1).expand(n, 2, 1)
    lines = lines_through(given, known)
    moved = mixture(rest.weights, rest.means - first, rest.variances[..., None])
    exact = exact_denoiser(moved, SCHEDULE)

    def remainder(r_s, s):
        eps_hat = torch.zeros_like(r_s)
        eps_hat[:, 1] = exact(r_s[:, 1].to(moved.means), s).to(r_s)
        alpha_bar = SCHEDULE.alpha_bar[s].view(-1, 1).to(r_s)
        eps_hat[:, 0] = r_s[:, 0] / (1 - alpha_bar).sqrt()  # it is 0 at the given frame
        return eps_hat

    denoise = around_lines(remainder, SCHEDULE, lines)
    start = torch.randn(n, 2, 1, generator=seeded())
    loop = inpaint_steps(denoise, start, SCHEDULE, given, known, steps=100, generator=seeded(1))
    made = final(loop).x_s
    assert torch.equal(made[:, 0], given[:, 0])
    assert float(made[:, 1].mean()) == pytest.approx(mean, abs=0.03)
    assert float(made[:, 1].var()) == pytest.approx(variance, rel=0.1)
    whole = final(ddim_steps(denoise, start, SCHEDULE, 100, 1.0, generator=seeded(1))).x_s
    assert float((whole[:, 0] - first).abs().max()) < 1e-3  # it comes to the given by itself
