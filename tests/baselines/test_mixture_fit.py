"""Mixtures fitted to points and to windows of walking: what was put in is found.

The fast denoiser is the exact one.
"""

import numpy as np
import pytest
import torch
from seeds import seeded

from data_synth.mixtures import crossed_bars
from data_synth.walking import random_control, walk
from motiondiff_edu.baselines.known_walks import fit_walks, holes, holes_in_the_past
from motiondiff_edu.baselines.mixture_fit import (
    WindowMixture,
    fit_mixture,
    fit_windows,
    responsibilities,
)
from motiondiff_edu.ddpm import cosine_schedule
from motiondiff_edu.exact import exact_denoiser, log_density, sample_mixture
from motiondiff_edu.motion.skeleton import JOINTS

SCHEDULE = cosine_schedule(50)


def test_em_finds_the_mixture_that_made_the_points():
    truth = crossed_bars()
    found = fit_mixture(sample_mixture(truth, 3000, seeded(1)), 2, ridge=0.0, generator=seeded(2))
    left = int(found.means[:, 0].argmin())
    assert found.weights[left].item() == pytest.approx(0.4, abs=0.03)
    torch.testing.assert_close(found.means[left], truth.means[0], atol=0.07, rtol=0)
    torch.testing.assert_close(found.variances[left], truth.variances[0], atol=0.05, rtol=0.15)
    fresh = sample_mixture(truth, 2000, seeded(3))
    assert (log_density(truth, fresh) - log_density(found, fresh)).mean() < 0.02


def test_the_same_generator_finds_the_same_parts():
    x = sample_mixture(crossed_bars(), 300, seeded(4))
    one, again = (fit_mixture(x, 3, generator=seeded(5)) for _ in range(2))
    assert torch.equal(one.means, again.means) and torch.equal(one.variances, again.variances)


def test_the_ridge_keeps_parts_wide_where_points_lie_on_a_line():
    line = torch.linspace(-1, 1, 40)[:, None] * torch.tensor([[1.0, 2.0]])
    found = fit_mixture(line, 2, ridge=0.01, generator=seeded(6))
    torch.testing.assert_close(found.variances[:, 0], torch.full((2,), 0.01, dtype=torch.float64))


def test_no_part_lies_where_no_point_is():
    with pytest.raises(ValueError, match="3 parts need at least 3 different points, not 1"):
        fit_mixture(torch.full((10, 2), 100.0), 3, generator=seeded(17))
    crowd = torch.cat([50 + torch.randn(40, 2, generator=seeded(18)), torch.full((3, 2), 90.0)])
    found = fit_mixture(crowd, 6, generator=seeded(19))
    low, high = crowd.amin(0), crowd.amax(0)
    assert ((found.means >= low) & (found.means <= high)).all()


def test_responsibilities_are_bayes_rule():
    truth = crossed_bars()
    x = torch.tensor([[0.3, -0.2], [-1.0, 0.5]], dtype=torch.float64)
    covariances = torch.einsum("kia,ka,kja->kij", truth.axes, truth.variances, truth.axes)
    normal = torch.distributions.MultivariateNormal
    joint = torch.stack(
        [normal(m, c).log_prob(x).exp() for m, c in zip(truth.means, covariances, strict=True)], 1
    )
    joint = joint * torch.tensor([0.4, 0.6])
    torch.testing.assert_close(responsibilities(truth, x), joint / joint.sum(1, keepdim=True))


def small() -> WindowMixture:
    x = torch.randn(60, 4, generator=seeded(7)) @ torch.randn(4, 9, generator=seeded(8))
    return fit_windows(
        x + 0.2 * torch.randn(60, 9, generator=seeded(9)), K=2, axes=3, generator=seeded(10)
    )


def test_the_denoiser_of_windows_is_the_exact_one_of_the_whole_mixture():
    fitted = small()
    x = torch.randn(4, 9, generator=seeded(11))
    s = torch.tensor([1, 9, 30, 50])
    torch.testing.assert_close(
        fitted.denoiser(SCHEDULE)(x, s), exact_denoiser(fitted.whole, SCHEDULE)(x, s)
    )
    with pytest.raises(IndexError, match="s = 0"):
        fitted.denoiser(SCHEDULE)(x, torch.zeros(4, dtype=torch.long))


def test_the_whole_mixture_has_the_windows_mean_and_variance():
    x = torch.randn(400, 4, generator=seeded(12)) @ torch.randn(4, 9, generator=seeded(13)) + 2.0
    fitted = fit_windows(x, K=1, axes=4, generator=seeded(14))
    torch.testing.assert_close(fitted.whole.mean(), x.double().mean(0))
    torch.testing.assert_close(
        fitted.whole.covariance(), x.double().T.cov(correction=0), atol=1e-3, rtol=1e-3
    )


def test_wrong_inputs():
    with pytest.raises(ValueError, match="3 parts need"):
        fit_mixture(torch.randn(2, 2), 3)
    with pytest.raises(ValueError, match="9 axes need more"):
        fit_windows(torch.randn(20, 9), axes=9)
    with pytest.raises(ValueError, match="no clip has 15 frames"):
        fit_walks([walk(random_control(0.5, np.random.default_rng(0), "turn"), 0)])


@pytest.fixture(scope="module")
def walks():
    clips = [walk(random_control(4.0, np.random.default_rng(k), "turn"), k) for k in range(6)]
    return clips, fit_walks(clips, frames=4, K=2, axes=6, generator=seeded(15))


def test_windows_of_walking_are_metres_in_the_root_frame(walks):
    clips, fitted = walks
    assert fitted.truth.means.shape == (2, 4 * 63)
    made = fitted.metres(sample_mixture(fitted.truth, 50, seeded(16)).float())
    real = np.stack([clip.poses[k : k + 8 : 2] for clip in clips for k in range(0, 60, 9)])
    assert made.shape == (50, 4, 21, 3)
    assert np.abs(made.mean((0, 1)) - real.mean((0, 1))).max() < 0.1
    assert np.abs(made.std((0, 1)) / real.std((0, 1)).clip(0.02) - 1).max() < 0.6


def test_questions_ask_for_the_joints_that_the_mask_leaves_open(walks):
    known = holes_in_the_past(4)["leg"]
    problem = walks[1].problem(torch.zeros(252), known, SCHEDULE, past=True)
    open_joints = problem.compared.reshape(4, 21, 3).any(-1)
    assert [JOINTS[j] for j in open_joints[0].nonzero()[:, 0]] == [
        "RightUpLeg",
        "RightLeg",
        "RightFoot",
        "RightToeBase",
    ]
    assert not open_joints[2:].any() and not problem.known.reshape(4, 63)[2:].any()
    assert holes_in_the_past(8)["frames"].any(1).nonzero()[0].tolist() == [0, 3]
    assert all(
        mask.shape == (8, 21) and mask.any() and not mask.all() for mask in holes(8).values()
    )
