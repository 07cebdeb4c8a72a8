"""The linear-Gaussian walker finds the numbers of a linear world.

It draws that world's noise, and tells when it would run away.
"""

import numpy as np
import pytest
import torch

from motiondiff_edu.baselines.linear_gaussian import LinearGaussian, fit
from motiondiff_edu.motion.clip import Clip
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.performers.windows import Windows
from motiondiff_edu.rollout import generate

T_H, D = 2, 63


def linear_world(frames: int = 4000, noise: float = 0.3) -> Clip:
    """One step of a linear world, in every coordinate.

    pose[t+1] = 0.6 pose[t] - 0.3 pose[t-1] + 0.5 (first control) + noise.
    """
    rng = np.random.default_rng(0)
    control = rng.normal(size=(frames, 3))
    x = np.zeros((frames, D))
    for t in range(1, frames - 1):
        x[t + 1] = 0.6 * x[t] - 0.3 * x[t - 1] + 0.5 * control[t, :1] + noise * rng.normal(size=D)
    return Clip(x.reshape(frames, 21, 3), control)


@pytest.fixture(scope="module")
def fitted() -> LinearGaussian:
    unit = (Scaler(torch.zeros(D), torch.ones(D)), Scaler(torch.zeros(3), torch.ones(3)))
    return fit(Windows.of([linear_world()], T_H, 1, unit), ridge=1e-6)


def test_it_finds_the_numbers_of_a_linear_world(fitted: LinearGaussian):
    before = fitted.weight[:D]
    last = fitted.weight[D : 2 * D]
    control = fitted.weight[2 * D : -1]
    assert torch.allclose(last, 0.6 * torch.eye(D), atol=0.08)
    assert torch.allclose(before, -0.3 * torch.eye(D), atol=0.08)
    assert torch.allclose(
        control[3], torch.tensor(0.5), atol=0.05
    )  # forward, beside the last given pose
    assert torch.allclose(control[[0, 1, 2, 4, 5]], torch.tensor(0.0), atol=0.05)


def test_its_noise_has_the_spread_of_what_the_fit_leaves_over(fitted: LinearGaussian):
    past, control = torch.randn(1, T_H, D), torch.randn(1, T_H + 1, 3)
    many = past.expand(5000, -1, -1), control.expand(5000, -1, -1)
    drawn = fitted.window_sampler()(*many, torch.Generator().manual_seed(1))
    assert drawn.shape == (5000, 1, D)
    assert torch.allclose(drawn.std(0), torch.tensor(0.3), atol=0.03)
    assert torch.allclose(drawn.mean(0)[0], fitted.mean(past, control)[0], atol=0.03)
    still = fitted.window_sampler(noise_scale=0.0)(*many, torch.Generator().manual_seed(1))
    assert torch.allclose(still.std(0), torch.tensor(0.0), atol=1e-6)


def test_growth_is_the_largest_root(fitted: LinearGaussian):
    assert fitted.growth() == pytest.approx(np.sqrt(0.3), abs=0.15)  # roots of z^2 - 0.6 z + 0.3
    runaway = LinearGaussian(
        fitted.weight * 3, fitted.noise_factor, T_H, fitted.pose_scaler, fitted.control_scaler
    )
    assert runaway.growth() > 1


def test_generate_lets_it_walk(fitted: LinearGaussian):
    past, control = torch.zeros(T_H, D), torch.zeros(T_H + 7, 3)
    control[:, 0] = 1.0
    new = generate(fitted, past, control, seed=3)
    assert new.shape == (7, D)
    assert torch.equal(new, generate(fitted, past, control, seed=3))
    far = generate(fitted, past, torch.cat([control, control[-1:].repeat(300, 1)]), seed=3)[100:]
    assert far.mean().item() == pytest.approx(
        0.5 / (1 - 0.6 + 0.3), abs=0.05
    )  # the fixed point under this control


def test_windows_of_several_futures_are_refused():
    with pytest.raises(ValueError, match="make the windows with T_p=1, not 4"):
        fit(Windows.of([linear_world(50)], T_H, 4))
