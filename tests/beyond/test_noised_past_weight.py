"""Windows with a noised past weigh less, and nothing else changes."""

from dataclasses import replace

import pytest
import torch

from motiondiff_edu.beyond.noised_past_weight import NoisedPastWeight
from motiondiff_edu.ddpm import linear_schedule, squared_error
from motiondiff_edu.diffusion_dropout import Dropout, diffusion_dropout
from motiondiff_edu.modiff import MoDiff, MoDiffConfig, training_loss

S, B = 9, 40
D = 5
T_H, T_P = 4, 3


@pytest.fixture
def dropout() -> Dropout:
    return Dropout(linear_schedule(S, 0.1, 0.9), lambda done: 0.4, 1, done=0.0)


def batch(seed: int = 0):
    generator = torch.Generator().manual_seed(seed)
    past = torch.randn(B, T_H, D, generator=generator)
    s = torch.randint(1, S + 1, (B,), generator=generator)
    return past, s, torch.randn(B, T_P, D, generator=generator)


def seeded() -> torch.Generator:
    return torch.Generator().manual_seed(3)


def test_the_pasts_are_those_of_the_dropout(dropout):
    past, s, _ = batch()
    light = NoisedPastWeight(dropout, 0.1)
    plain = diffusion_dropout(past, s, dropout.schedule, 0.4, seeded())
    assert torch.equal(light(past, s, seeded()), plain)
    assert 0 < light.noised.sum() < B
    assert torch.equal(light.noised, (plain != past).any(2).any(1))


@pytest.mark.parametrize("weight", [0.0, 0.1, 1.0, 2.5])
def test_squares_of_dropped_windows_have_the_weight(dropout, weight):
    past, s, error = batch()
    light = NoisedPastWeight(dropout, weight)
    light(past, s, seeded())
    squares = error.square().mean((1, 2))
    by_hand = (squares * torch.tensor([weight if x else 1.0 for x in light.noised])).mean()
    assert light.weighted(squared_error)(error, s).item() == pytest.approx(by_hand.item(), rel=1e-5)


def test_a_loss_of_steps_still_gets_the_steps(dropout):
    past, s, error = batch()
    light = NoisedPastWeight(dropout, 0.0)
    light(past, s, seeded())
    assert light.weighted(lambda error, s: s.float().mean())(error, s) == s.float().mean()


def test_weight_1_is_algorithm_1(dropout):
    torch.manual_seed(0)
    sizes = dict(D=D, T_h=T_H, T_p=T_P, S=S, width=16, heads=2, hidden=24)
    model = MoDiff(MoDiffConfig(**sizes, cross_layers=1, decoder_layers=1))
    past, _, future = batch()
    data = (past, future, torch.randn(B, T_H + T_P, 3, generator=torch.Generator().manual_seed(1)))
    plain = training_loss(model, data, dropout.schedule, seeded(), dropout=dropout)
    for weight, same in ((1.0, True), (0.1, False)):
        light = NoisedPastWeight(replace(dropout), weight)
        loss = light.weighted(squared_error)
        now = training_loss(model, data, dropout.schedule, seeded(), dropout=light, loss=loss)
        assert (now.item() == pytest.approx(plain.item(), rel=1e-6)) is same


def test_what_is_wrong_is_said(dropout):
    past, s, error = batch()
    with pytest.raises(ValueError, match="must not be negative, not -0.5"):
        NoisedPastWeight(dropout, -0.5)
    with pytest.raises(RuntimeError, match="needs the dropout of the same batch"):
        NoisedPastWeight(dropout, 0.1).weighted(squared_error)(error, s)
