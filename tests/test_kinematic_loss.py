"""Kinematic losses.

By hand, on the truth, under what must not matter, and the identity behind their weight.
"""

import pytest
import torch

from motiondiff_edu.ddpm import cosine_schedule, q_sample
from motiondiff_edu.kinematic_loss import (
    OVER_TIME,
    asymmetry_loss,
    bone_lengths,
    motion_loss,
    over_time,
    skeleton_loss,
    slide_loss,
)
from motiondiff_edu.motion.skeleton import BONE_LENGTHS, BONES, TOES
from motiondiff_edu.prediction import x0_from_eps

CHAIN = ((0, 1), (1, 2))


def chain(lengths: list[list[float]]) -> torch.Tensor:
    """Three joints in a row with these two bones, one row a frame: (1, T, 3, 3)."""
    along = torch.tensor([[0.0, a, a + b] for a, b in lengths])
    return torch.stack([along, 0 * along, 0 * along], -1)[None]


def walk(seed: int = 0) -> torch.Tensor:
    import numpy as np

    from data_synth.walking import random_control, walk

    rng = np.random.default_rng(seed)
    return torch.from_numpy(walk(random_control(2, rng, "turn"), seed).poses)[None]


def test_by_hand():
    lengths = bone_lengths(chain([[1.0, 2.0], [3.0, 2.0], [2.0, 5.0]]), CHAIN)
    assert lengths[0].tolist() == [[1, 2], [3, 2], [2, 5]]
    # bone 0: 1, 3, 2 -> variance 1; bone 1: 2, 2, 5 -> variance 3
    assert skeleton_loss(lengths).item() == pytest.approx(2.0)
    assert skeleton_loss(lengths).item() == pytest.approx(torch.var(lengths, dim=1).mean().item())
    assert asymmetry_loss(lengths, ((0, 1),)).item() == pytest.approx((1 + 1 + 3) / 3)
    assert motion_loss(torch.ones(1, 4, 3), torch.zeros(1, 4, 3)).item() == 1


def test_nothing_is_wrong_with_the_truth():
    truth = walk()
    lengths = bone_lengths(truth, BONES)
    torch.testing.assert_close(lengths[0, 5], torch.from_numpy(BONE_LENGTHS))
    assert skeleton_loss(lengths).item() < 1e-12
    pairs = ((0, 4), (1, 5), (2, 6), (12, 16))
    assert asymmetry_loss(lengths, pairs).item() < 1e-9


def test_moving_and_turning_the_figure_changes_nothing_and_shaking_it_does():
    truth = walk(1)
    turn = torch.tensor([[0.6, 0.0, 0.8], [0.0, 1.0, 0.0], [-0.8, 0.0, 0.6]], dtype=torch.float64)
    rough = truth + 0.02 * torch.randn(truth.shape, generator=torch.Generator().manual_seed(0))
    moved = rough @ turn.T + torch.tensor([5.0, 1.0, -3.0])
    for loss in (skeleton_loss, lambda x: asymmetry_loss(x, ((0, 4), (1, 5)))):
        before = loss(bone_lengths(rough, BONES))
        after = loss(bone_lengths(moved, BONES))
        torch.testing.assert_close(before, after)
        assert before > 1e-4


def test_frames_that_are_not_there_do_not_count():
    lengths = torch.rand(2, 7, 4)
    present = torch.arange(7) < torch.tensor([7, 4])[:, None]
    for loss in (skeleton_loss, lambda x, p=None: asymmetry_loss(x, ((0, 1), (2, 3)), p)):
        torch.testing.assert_close(loss(lengths, present)[1:], loss(lengths[1:, :4]))
        torch.testing.assert_close(loss(lengths, present)[:1], loss(lengths[:1]))
    x, y = torch.rand(2, 7, 3), torch.rand(2, 7, 3)
    torch.testing.assert_close(motion_loss(x, y, present)[1:], motion_loss(x[1:, :4], y[1:, :4]))


def test_a_motion_of_padding_alone_costs_nothing():
    lengths = torch.rand(2, 7, 4)
    nobody = torch.tensor([[True], [False]]).expand(2, 7)
    found = (skeleton_loss(lengths, nobody), asymmetry_loss(lengths, ((0, 1), (2, 3)), nobody))
    assert all(loss[0] > 0 and loss[1] == 0 for loss in found)


def test_a_foot_slides_only_where_it_should_stand():
    T = 6
    positions = torch.zeros(1, T, 21, 3)
    positions[0, :, TOES[0], 0] = 0.1 * torch.arange(T)  # the left toe slides 10 cm a frame
    positions[0, :, TOES[1], 1] = 0.3 * torch.arange(T)  # the right one only rises
    left = torch.zeros(1, T, 2, dtype=torch.bool)
    right = torch.zeros(1, T, 2, dtype=torch.bool)
    left[..., 0], right[..., 1] = True, True
    assert slide_loss(positions, left, TOES).item() == pytest.approx(0.1)
    assert slide_loss(positions, right, TOES).item() == pytest.approx(0, abs=1e-5)
    assert slide_loss(positions, left & right, TOES).item() == 0
    short = torch.arange(T)[None] < 3
    assert slide_loss(positions, left | right, TOES, short).item() == pytest.approx(0.05, abs=1e-5)


def test_gradients_are_finite_even_where_a_bone_has_no_length():
    positions = torch.zeros(1, 5, 3, 3, requires_grad=True)
    lengths = bone_lengths(positions, CHAIN)
    (skeleton_loss(lengths) + asymmetry_loss(lengths, ((0, 1),))).sum().backward()
    assert torch.isfinite(positions.grad).all()


def test_gradient_of_the_skeleton_loss_pulls_a_long_frame_back():
    positions = chain([[1.0, 1.0], [1.0, 1.0], [1.5, 1.0]]).requires_grad_()
    skeleton_loss(bone_lengths(positions, CHAIN)).sum().backward()
    assert (
        positions.grad[0, 2, 1, 0] > 0 > positions.grad[0, 0, 1, 0]
    )  # against the gradient: shorter, and longer


def test_the_identity_behind_the_papers_weight():
    """alpha_bar |x0_hat - x0|^2 = (1 - alpha_bar) |eps_hat - eps|^2.

    With L_m the weight asks most at high noise.
    """
    schedule = cosine_schedule(1000)
    draw = torch.Generator().manual_seed(0)
    x0, eps, wrong = (torch.randn(3, 8, 5, generator=draw, dtype=torch.float64) for _ in range(3))
    for s in (1, 250, 500, 900, 990):
        at = torch.full((3,), s)
        x_s = q_sample(x0, at, schedule, eps)
        eps_hat = eps + 0.05 * wrong
        x0_hat = x0_from_eps(x_s, at, eps_hat, schedule)
        share = schedule.alpha_bar[s]
        left = share * motion_loss(x0_hat, x0)
        torch.testing.assert_close(
            left, (1 - share) * motion_loss(eps_hat, eps), rtol=1e-6, atol=1e-12
        )


def test_weights_over_time():
    schedule = cosine_schedule(50)
    assert torch.equal(over_time(schedule, "alpha_bar"), schedule.alpha_bar)
    assert (over_time(schedule, "none") == 0).all() and (over_time(schedule, "constant") == 1).all()
    snr = over_time(schedule, "snr")
    assert snr[0] == 5 and snr[25] == pytest.approx(
        float(schedule.alpha_bar[25] / (1 - schedule.alpha_bar[25]))
    )
    assert all((table(schedule.alpha_bar).diff() <= 0).all() for table in OVER_TIME.values())
    with pytest.raises(ValueError, match="alpha_bar"):
        over_time(schedule, "linear")
