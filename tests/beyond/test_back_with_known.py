"""Ways back that heed what is known: held frame by frame, or the whole window under a mask."""

from types import SimpleNamespace

import pytest
import torch

from motiondiff_edu import exact
from motiondiff_edu.beyond import back_with_known
from motiondiff_edu.beyond.back_with_known import (
    FADE,
    MOVES,
    WEIGHT,
    blended_way_back,
    masked_way_back,
)
from motiondiff_edu.ddpm import linear_schedule
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.reconstruction import Rollout, Stop, plain_way_back, reconstruct

T_H = 5
T_P = 7
D = 2


class Halving:
    """A walker that predicts half of the last pose, k times over.

    What it is told in between decides what follows.
    """

    def __init__(self):
        self.config = SimpleNamespace(T_h=T_H, T_p=T_P, D=D, C=3)
        self.pose_scaler = Scaler(torch.full((D,), 0.5), torch.full((D,), 2.0))
        self.control_scaler = Scaler.nothing(3)

    def window_sampler(self, steps=None):
        return lambda past, control, generator: torch.stack(
            [past[:, -1] / 2**k for k in range(1, T_P + 1)], 1
        )


def rollout(walker):
    return Rollout(walker, torch.Generator().manual_seed(0), steps=None)


def test_the_way_back_is_drawn_through_what_is_known():
    """Halving walks 4, 2, 1, .5, .25; one entry is known to be 40, 39 more than was walked.

    The correction fades over FADE frames on both sides, in the column of the known entry alone.
    """
    walker, B = Halving(), 3
    ahead = torch.full((B, T_H, D), 0.5 + 2 * 8.0)
    given = torch.full((B, T_H, D), float("nan"))
    known = torch.zeros(B, T_H, D, dtype=torch.bool)
    known[:, 2, 1], given[:, 2, 1] = True, 0.5 + 2 * 40.0
    arguments = ahead, torch.zeros(B, 2 * T_H, 3), given, known
    made, free = (
        walker.pose_scaler.transform(way(rollout(walker), *arguments))
        for way in (blended_way_back, plain_way_back)
    )
    torch.testing.assert_close(free[0, :, 0], torch.tensor([4.0, 2.0, 1.0, 0.5, 0.25]))
    shares = 1 - torch.tensor([2.0, 1.0, 0.0, 1.0, 2.0]) / (FADE + 1)
    torch.testing.assert_close(made[..., 1], (free[..., 1] + 39 * shares).expand(B, -1))
    torch.testing.assert_close(made[..., 0], free[..., 0])


class Known(Halving):
    """A walker whose windows are Gaussian, whatever came before; the exact denoiser is its
    network. As strict as MoDiff about how many rows it takes."""

    def __init__(self, T_p: int = T_H):
        super().__init__()
        self.config.T_p, self.config.S = T_p, 60
        root = torch.randn(
            T_p * D, T_p * D, generator=torch.Generator().manual_seed(3), dtype=torch.float64
        )
        covariance = root @ root.T / (T_p * D) + 0.1 * torch.eye(T_p * D)
        self.given = exact.mixture(torch.ones(1), torch.zeros(1, T_p * D), covariance[None])
        self.schedule = linear_schedule(60, 1e-3, 0.3)

    def denoiser(self, past, control):
        assert past.shape[1] == T_H and control.shape[1] == T_H + self.config.T_p
        return exact.exact_denoiser(self.given, self.schedule)


def test_a_window_under_a_mask_has_about_the_mean_that_what_is_known_asks_for():
    walker, B = Known(), 1500
    known = torch.zeros(B, T_H, D, dtype=torch.bool)
    known[:, 1] = known[:, 3, 0] = True
    values = torch.tensor([1.5, -1.0, 2.0])
    given = torch.full((B, T_H, D), float("nan"))
    given[known] = 0.5 + 2 * values.repeat(B)
    made = walker.pose_scaler.transform(
        masked_way_back(
            rollout(walker), torch.zeros(B, T_H, D), torch.zeros(B, 2 * T_H, 3), given, known
        )
    )
    torch.testing.assert_close(made[known], values.repeat(B))
    whole, padded = known[0].flatten(), torch.zeros(T_H * D)
    padded[whole] = values
    wanted = exact.conditional(walker.given, padded, whole)
    truth, spread = wanted.mean().float(), wanted.covariance().diagonal().sqrt().float()
    plain = walker.given.mean()[: len(truth)].float()
    off, off_unheeded = (((x - truth) / spread).abs() for x in (made[:, ~known[0]].mean(0), plain))
    assert off.mean() < 0.25 < 0.5 < off_unheeded.mean()


def test_more_moves_come_nearer_to_what_is_known(monkeypatch):
    """A Gaussian's exact conditional is reached by many; one move explains the easiest part."""
    walker, B = Known(), 300
    known = torch.zeros(B, T_H, D, dtype=torch.bool)
    known[:, 1] = known[:, 3] = True
    given = torch.where(known, torch.tensor([3.5, -1.5]), 0.0)
    apart = []
    for moves in (1, MOVES):
        monkeypatch.setattr(back_with_known, "MOVES", moves)
        made = masked_way_back(
            rollout(walker), torch.zeros(B, T_H, D), torch.zeros(B, 2 * T_H, 3), given, known
        )
        units = walker.pose_scaler.transform(given)[0].flatten().double()
        wanted = exact.conditional(walker.given, units, known[0].flatten()).mean().float()
        made = walker.pose_scaler.transform(made)[:, ~known[0]].mean(0)
        apart.append((made - wanted).abs().mean())
    assert apart[1] < 0.8 * apart[0]


def test_a_smaller_weight_leaves_more_of_the_spread_that_a_gaussian_has(monkeypatch):
    """Moves of their whole length bring the samples too near to one another."""
    walker = Known()
    B = 1500
    known = torch.zeros(B, T_H, D, dtype=torch.bool)
    known[:, 1] = known[:, 3] = True
    given = torch.where(known, torch.tensor([3.5, -1.5]), 0.0)
    units = walker.pose_scaler.transform(given)[0].flatten().double()
    wanted = exact.conditional(walker.given, units, known[0].flatten()).covariance().float()
    apart = []
    for weight in (1.0, WEIGHT):
        monkeypatch.setattr(back_with_known, "WEIGHT", weight)
        made = masked_way_back(
            rollout(walker), torch.zeros(B, T_H, D), torch.zeros(B, 2 * T_H, 3), given, known
        )
        made = walker.pose_scaler.transform(made)[:, ~known[0]]
        apart.append((torch.cov(made.T) - wanted).norm())
    assert apart[1] < 0.75 * apart[0]


class Listening(Known):
    """It remembers the past and the control that its network is given."""

    def __init__(self):
        super().__init__()
        self.control_scaler = Scaler(torch.tensor([1.0, 0.1, -0.2]), torch.tensor([0.5, 0.2, 0.8]))
        self.heard = []

    def denoiser(self, past, control):
        self.heard.append((past, control))
        return super().denoiser(past, control)


def test_under_a_mask_the_network_is_given_its_own_units():
    walker = Listening()
    random = torch.Generator().manual_seed(4)
    ahead = torch.randn(2, T_H, D, generator=random)
    control = torch.randn(2, 2 * T_H, 3, generator=random)
    known = torch.zeros(2, T_H, D, dtype=torch.bool)
    known[:, 2] = True
    masked_way_back(rollout(walker), ahead, control, torch.ones(2, T_H, D), known)
    ((past, steer),) = walker.heard
    torch.testing.assert_close(past, (ahead - 0.5) / 2)
    middle = torch.tensor([1.0, 0.1, -0.2])
    spread = torch.tensor([0.5, 0.2, 0.8])
    torch.testing.assert_close(steer, (control - middle) / spread)


@pytest.mark.parametrize("T_p", [T_H - 1, T_P])
def test_a_mask_wants_a_window_as_long_as_the_past(T_p):
    with pytest.raises(ValueError, match=f"predicts {T_p} poses from 5.*blended_way_back"):
        zeros = torch.zeros(2, T_H, D)
        control = torch.zeros(2, 2 * T_H, 3)
        masked_way_back(rollout(Known(T_p)), zeros, control, zeros, zeros > 1)


def test_all_is_made_where_the_inputs_are_and_drawn_where_the_generator_is():
    """With another default device, new tensors still land beside the inputs."""
    walker, known = Known(), torch.zeros(2, T_H, D, dtype=torch.bool)
    ahead, given = torch.zeros(2, T_H, D), torch.ones(2, T_H, D)
    known[:, 2] = True
    arguments = ahead, torch.zeros(2, 2 * T_H, 3), given, known
    here, again = masked_way_back(rollout(walker), *arguments), rollout(walker)
    with torch.device("meta"):
        there = masked_way_back(again, *arguments)
    assert torch.equal(here, there)


@pytest.mark.parametrize("way", [plain_way_back, blended_way_back])
def test_each_way_serves_the_repair_and_keeps_what_is_known(way):
    past = torch.randn(2, T_H, D, generator=torch.Generator().manual_seed(5))
    known = torch.ones(past.shape, dtype=torch.bool)
    known[:, 2] = False
    holes = past.masked_fill(~known, float("nan"))
    control, stop = torch.zeros(2, 2 * T_H, 3), Stop(rounds=2)
    made = reconstruct(rollout(Halving()), holes, known, control, way_back=way, stop=stop)
    assert torch.equal(made[known], past[known]) and torch.isfinite(made).all()
    assert not torch.equal(made[~known], walker_mean().expand(2, D).reshape(-1))


def walker_mean():
    return torch.full((D,), 0.5)
