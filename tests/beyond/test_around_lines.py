"""Around lines: lines and scale by hand and by data, and the exact answer for what remains."""

import numpy as np
import pytest
import torch
from two_numbers import correlated

from data_synth.mixed import motions
from motiondiff_edu.beyond.around_lines import HALF, GivenLines
from motiondiff_edu.ddpm import cosine_schedule, final
from motiondiff_edu.exact import conditional, exact_denoiser, mixture
from motiondiff_edu.inbetweening import inpaint_steps
from motiondiff_edu.motion.dance_frame import placed_features
from motiondiff_edu.motion.scaler import Scaler

SCHEDULE = cosine_schedule(100)


def seeded(seed: int = 0) -> torch.Generator:
    return torch.Generator().manual_seed(seed)


def test_the_scale_is_nothing_where_a_motion_is_given_and_grows_with_the_distance():
    known = torch.zeros(1, 7, 3, dtype=torch.bool)
    known[0, [1, 5], 0], known[0, 6, 1] = True, True
    scale = GivenLines.of(torch.zeros(1, 7, 3), known).scale[0]
    between = [1 / (1 + HALF * (1 / k + 1 / (4 - k))) for k in (1, 2, 3)]
    outside = 1 / (1 + HALF)
    wanted = torch.tensor([outside, 0, *between, 0, outside])
    torch.testing.assert_close(scale[:, 0], wanted)
    assert scale[5, 1] == pytest.approx(outside) and scale[0, 1] == pytest.approx(6 / (6 + HALF))
    assert torch.equal(scale[:, 2], torch.ones(7))


def test_scales_are_those_of_motions():
    """As far as motions are from the lines: within a factor of two, at every distance."""
    motion = torch.from_numpy(
        np.stack([placed_features(positions[:101]) for positions, _ in motions(12, 5, 5.1)])
    ).float()
    x0 = Scaler.fit(motion).transform(motion)
    x0 = x0[..., [column for column in range(63) if column not in (0, 2)]]  # without the path
    for every in (5, 10, 20, 50):
        known = torch.zeros(x0.shape, dtype=torch.bool)
        known[:, ::every] = True
        shown = GivenLines.of(x0, known)
        middle = slice(every // 2, None, every)
        size = float(shown.remainder(x0)[:, middle].square().mean().sqrt())
        assert 0.5 < size < 2, every


def test_lines_and_remainder_are_the_motion():
    x0, known = torch.randn(4, 20, 6, generator=seeded()), torch.rand(4, 20, 6) < 0.3
    shown = GivenLines.of(torch.where(known, x0, torch.nan), known)
    remainder = shown.remainder(x0)
    assert (remainder[known] == 0).all()
    torch.testing.assert_close(shown.whole(remainder), x0)
    nothing = GivenLines.of(x0, torch.zeros_like(known))
    assert torch.equal(nothing.remainder(x0), x0) and torch.equal(nothing.whole(x0), x0)


def test_an_exact_remainder_gives_exact_samples_of_the_rest():
    """Two correlated numbers as two frames, of which the first is given."""
    first, n = 0.8, 4000
    rest = conditional(correlated(), torch.tensor([first, 0.0]), torch.tensor([True, False]))
    mean, variance = float(rest.means[0, 0]), float(rest.variances[0, 0])
    assert (mean, variance) == pytest.approx((-0.2 + 0.9 * 0.5, 1 - 0.9**2))
    known = torch.tensor([True, False]).view(1, 2, 1).expand(n, 2, 1)
    given = torch.tensor([first, 0.0]).view(1, 2, 1).expand(n, 2, 1)
    shown = GivenLines.of(given, known)
    scale = float(shown.scale[0, 1])
    moved = mixture(
        rest.weights, (rest.means - first) / scale, rest.variances[..., None] / scale**2
    )
    exact = exact_denoiser(moved, SCHEDULE)

    def remainder(r_s, s):
        eps_hat = torch.zeros_like(r_s)
        eps_hat[:, 1] = exact(r_s[:, 1].to(moved.means), s).to(r_s)
        alpha_bar = SCHEDULE.alpha_bar[s].view(-1, 1).to(r_s)
        eps_hat[:, 0] = r_s[:, 0] / (1 - alpha_bar).sqrt()  # it is 0 at the given frame
        return eps_hat

    start = torch.randn(n, 2, 1, generator=seeded())
    nothing = torch.zeros(n, 2, 1)
    how = {"steps": 100, "generator": seeded(1)}
    made = shown.whole(final(inpaint_steps(remainder, start, SCHEDULE, nothing, known, **how)).x_s)
    assert torch.equal(made[:, 0], given[:, 0])
    assert float(made[:, 1].mean()) == pytest.approx(mean, abs=0.03)
    assert float(made[:, 1].var()) == pytest.approx(variance, rel=0.1)
