"""Kinematic losses: by hand, on the truth, under what must not matter, and the identity behind
their weight; and the whole of eq. 4, two samples by hand."""

from types import SimpleNamespace

import pytest
import torch

from motiondiff_edu.ddpm import cosine_schedule, make_schedule, q_sample
from motiondiff_edu.kinematic_loss import (
    OVER_TIME,
    Body,
    KinematicWeights,
    asymmetry_loss,
    bone_lengths,
    kinematic_parts,
    motion_loss,
    skeleton_loss,
    slide_loss,
    training_loss,
    weight_by_step,
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


def test_the_losses_of_two_motions_are_those_of_each_and_one_frame_has_no_variance():
    lengths, pairs = torch.rand(2, 7, 4), ((0, 1), (2, 3))
    x, y = torch.rand(2, 7, 3), torch.rand(2, 7, 3)
    for k in range(2):
        one = slice(k, k + 1)
        own = (lengths[k].var(0).mean(), lengths[k, :, ::2].sub(lengths[k, :, 1::2]).abs().mean())
        torch.testing.assert_close(skeleton_loss(lengths)[k], own[0])
        torch.testing.assert_close(asymmetry_loss(lengths, pairs)[k], own[1])
        torch.testing.assert_close(motion_loss(x, y)[one], motion_loss(x[one], y[one]))
    assert skeleton_loss(lengths[:, :1]).tolist() == [0, 0]


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


def test_the_step_that_ends_a_stance_is_no_slide():
    positions, planted = torch.zeros(1, 4, 21, 3), torch.zeros(1, 4, 2, dtype=torch.bool)
    positions[0, 2:, TOES[0], 0] = 0.5  # the toe stands in frames 0 and 1, and then goes
    planted[0, :2, 0] = True
    assert slide_loss(positions, planted, TOES).item() < 1e-5


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
    assert torch.equal(weight_by_step(schedule, "alpha_bar"), schedule.alpha_bar)
    assert (weight_by_step(schedule, "none") == 0).all() and (
        weight_by_step(schedule, "constant") == 1
    ).all()
    snr = weight_by_step(schedule, "snr")
    assert snr[0] == 5 and snr[25] == pytest.approx(
        float(schedule.alpha_bar[25] / (1 - schedule.alpha_bar[25]))
    )
    assert all((table(schedule.alpha_bar).diff() <= 0).all() for table in OVER_TIME.values())
    with pytest.raises(ValueError, match="alpha_bar"):
        weight_by_step(schedule, "linear")


class Says(torch.nn.Module):
    """A network that says `answer` whatever it is shown, and remembers what that was."""

    def __init__(self, answer: torch.Tensor, target: str):
        super().__init__()
        self.config, self.answer = SimpleNamespace(target=target), answer

    def forward(self, x_s, s, context):
        self.seen = (x_s, s, context)
        return self.answer


# beta 0.2, 0.5, 0.75 leave 0.8, 0.4 and 0.1 of the signal's power: unlike turned round, or averaged
STEPS = make_schedule(torch.tensor([0.2, 0.5, 0.75, 0.99]))
X0 = torch.tensor([[[3.0], [1.0]], [[-2.0], [4.0]]])  # two samples, two frames, one feature


def two_samples(seed: int = 3) -> tuple[list[int], torch.Tensor]:
    """The steps and the noise that a seed gives to a loss of two samples."""
    draws = torch.Generator().manual_seed(seed)
    return torch.randint(1, 5, (2,), generator=draws).tolist(), torch.randn(
        2, 2, 1, generator=draws
    )


def whole_loss(model, seed: int = 3, **options) -> float:
    draws = torch.Generator().manual_seed(seed)
    return training_loss(model, (X0, "the music"), STEPS, draws, **options).item()


def test_equation_4_of_two_samples_by_hand():
    """L = mean of (eps - eps_hat)^2 + mean of lambda(s) L_k(x0_hat, x0), x0_hat by eq. 5, with the
    paper's lambda(s) = alpha_bar_s."""
    (s_0, s_1), eps = two_samples()
    alpha_bar = [1.0, 0.8, 0.4, 0.1, 0.001]
    assert (s_0, s_1) == (3, 1)
    model = Says(torch.tensor([[[0.5], [0.0]], [[-1.0], [2.0]]]), "eps")
    found = whole_loss(model, kinematic=lambda x0_hat, x0: (x0_hat - 2 * x0)[:, 0, 0])

    L_da = sum(
        (eps[i, t, 0] - model.answer[i, t, 0]).item() ** 2 / 4 for i in range(2) for t in range(2)
    )
    L_k = []
    for i, s in enumerate((s_0, s_1)):
        a, b = alpha_bar[s] ** 0.5, (1 - alpha_bar[s]) ** 0.5
        x_s = a * X0[i, 0, 0].item() + b * eps[i, 0, 0].item()
        assert model.seen[0][i, 0, 0].item() == pytest.approx(x_s, rel=1e-5)
        x0_hat = (x_s - b * model.answer[i, 0, 0].item()) / a
        L_k.append(x0_hat - 2 * X0[i, 0, 0].item())
    wanted = L_da + (alpha_bar[s_0] * L_k[0] + alpha_bar[s_1] * L_k[1]) / 2
    assert found == pytest.approx(wanted, rel=1e-5)
    assert model.seen[1].tolist() == [s_0, s_1] and model.seen[2] == "the music"
    assert whole_loss(model) == pytest.approx(L_da, rel=1e-5)  # without L_k


@pytest.mark.parametrize("target", ["eps", "x0", "v"])
def test_equation_4_for_other_targets_and_weights(target):
    """A network that is right but for 0.1: x0_hat errs by 0.1 b / a, 0.1 or 0.1 b."""
    (s_0, s_1), eps = two_samples()
    a = STEPS.alpha_bar[[s_0, s_1]].float().sqrt()[:, None, None]
    b = (1 - a**2).sqrt()
    right = {"eps": eps, "x0": X0, "v": a * eps - b * X0}[target]
    # the last feature of x0_hat is wrong by
    off = {"eps": -0.1 * b / a, "x0": 0.1 * b / b, "v": -0.1 * b}[target][:, 0, 0]
    table = torch.tensor([9.0, 2.0, 3.0, 7.0, 11.0], dtype=torch.float64)
    found = whole_loss(
        Says(right + 0.1, target),
        kinematic=lambda x0_hat, x0: (x0_hat - x0).mean((1, 2)),
        lambda_k=table,
    )
    wanted = 0.01 + (table[s_0] * off[0] + table[s_1] * off[1]).item() / 2
    assert found == pytest.approx(wanted, rel=1e-4)


def test_another_loss_of_the_target_s_error():
    eps = two_samples()[1]
    found = whole_loss(Says(eps + 0.5, "eps"), loss=lambda error, s: error.sum() * s.sum())
    assert found == pytest.approx(-0.5 * 4 * (3 + 1), rel=1e-5)


def test_the_parts_of_a_body_and_their_weighted_sum():
    """Two bones in a chain; the features are positions in half metres."""
    body = Body(lambda x: x.unflatten(-1, (3, 3)) / 2, CHAIN, ((0, 1),), (1, 2))
    metres = chain([[1.0, 2.0], [3.0, 2.0], [2.0, 5.0]])
    x0_hat, planted = 2 * metres.flatten(2), torch.ones(1, 3, 2, dtype=torch.bool)
    parts = kinematic_parts(x0_hat, x0_hat + 0.5, body, planted)
    assert parts["skeleton"].item() == pytest.approx(2.0)
    assert parts["asymmetry"].item() == pytest.approx(5 / 3)
    assert parts["motion"].item() == pytest.approx(0.25)
    # joint 1 is at 1, 3, 2, joint 2 at 3, 5, 7
    assert parts["slide"].item() == pytest.approx((2 + 1 + 2 + 2) / 4)
    weights = KinematicWeights(10.0, 6.0, 2.0, 4.0, "alpha_bar")
    assert weights.total(parts).item() == pytest.approx(20 + 10 + 0.5 + 7)
