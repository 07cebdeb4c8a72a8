"""Terms and weights of the loss, each by hand on errors made for it."""

import numpy as np
import pytest
import torch

from motiondiff_edu.beyond.loss_terms import (
    as_x0_errors,
    changes,
    metre_weights,
    toe_changes,
    total,
    weighted,
    weighted_by_step,
)
from motiondiff_edu.ddpm import linear_schedule, q_sample, squared_error
from motiondiff_edu.motion import dance_frame
from motiondiff_edu.motion.skeleton import HIPS, TOES
from motiondiff_edu.prediction import v_from_x0_eps, x0_from_v

S1 = torch.tensor([1])


def one_error(frame: int = 0, column: int = 0, size: float = 1.0, shape=(1, 3, 63)) -> torch.Tensor:
    error = torch.zeros(shape)
    error[0, frame, column] = size
    return error


def test_weights_are_weights_of_the_squares():
    error = torch.tensor([[[1.0, 2.0], [3.0, 4.0], [0.0, 1.0]]])
    columns, frames = torch.tensor([4.0, 1.0]), torch.tensor([[1.0], [10.0], [100.0]])
    frames = frames.expand(1, 3, 2)
    by_column = weighted(squared_error, columns)
    assert by_column(error, S1).item() == pytest.approx((4 + 4 + 36 + 16 + 0 + 1) / 6)
    by_frame = weighted(by_column, frames)
    assert by_frame(error, S1).item() == pytest.approx((8 + 520 + 100) / 6)


def test_weights_of_steps_go_by_each_sample_s_own_step():
    error = torch.tensor([[[1.0]], [[2.0]], [[3.0]]])
    loss = weighted_by_step(squared_error, torch.tensor([0.0, 1.0, 10.0, 100.0]))
    assert loss(error, torch.tensor([3, 1, 2])).item() == pytest.approx((100 + 4 + 90) / 3)


def test_losses_add_up():
    both = total(squared_error, squared_error, lambda error, s: s.float().sum())
    assert both(torch.full((1, 2, 2), 2.0), torch.tensor([5])).item() == 4 + 4 + 5


@pytest.mark.parametrize("power", [1.0, 2.0])
def test_columns_are_weighted_by_how_far_they_move(power):
    """Squared errors in metres: a column that moves three times as far costs nine times as much."""
    weights = metre_weights(torch.tensor([0.1, 0.3, 0.5]), power)
    assert weights[1] / weights[0] == pytest.approx(3**power)
    assert weights.mean().item() == pytest.approx(1)


def test_errors_of_v_count_as_those_of_x0():
    schedule, rng = linear_schedule(6, 0.2, 0.95), torch.Generator().manual_seed(0)
    x0, eps, wrong = (torch.randn(3, 4, 5, generator=rng) for _ in range(3))
    s = torch.tensor([1, 3, 6])
    x_s, v = q_sample(x0, s, schedule, eps), v_from_x0_eps(x0, s, eps, schedule)
    loss = weighted_by_step(squared_error, as_x0_errors(schedule))(wrong, s)
    off = x0_from_v(x_s, s, v - wrong, schedule) - x0
    torch.testing.assert_close(loss, off.square().mean())


def test_weights_that_suit_a_difference_leave_out_what_both_ends_share():
    """Columns for changes; with frames, what is shared counts."""
    columns = metre_weights(torch.linspace(0.1, 0.9, 63), 2.0)
    frames = torch.tensor([[1.0], [4.0], [9.0]]).expand(1, 3, 63)
    steady = torch.rand(1, 1, 63).expand(1, 3, 63)
    assert weighted(changes(1.0), columns)(steady, S1).item() == pytest.approx(0, abs=1e-9)
    assert weighted(changes(1.0), frames)(steady, S1) > 0.01


def test_changes_from_frame_to_frame():
    error = torch.zeros(1, 4, 2)
    error[0, :, 0] = torch.tensor([1.0, 2.0, 4.0, 4.0])
    assert changes(3.0)(error, S1).item() == pytest.approx(3 * (1 + 4 + 0) / 6)
    assert changes(3.0)(torch.ones(1, 4, 2), S1) == 0


def test_toes_err_in_the_world_where_pelvis_and_leg_do_not_err_alike():
    std = torch.linspace(0.5, 2.0, 63)
    drift = torch.tensor([0.0, 0.1, 0.3, 0.3])  # metres to the side
    error = torch.zeros(1, 4, 63)
    error[0, :, 3 * HIPS] = drift / std[0]
    # two toes, three axes, three changes: both toes go with the pelvis
    wanted = 2 / 0.05 * 2 * (0.1**2 + 0.2**2) / (2 * 3 * 3)
    assert toe_changes(2.0, dance_frame.moves, std, 0.05)(error, S1).item() == pytest.approx(wanted)
    for toe in TOES:  # the toes stay in the world: minus the drift, about the pelvis
        error[0, :, 3 * toe] = -drift / std[3 * toe]
    assert toe_changes(2.0, dance_frame.moves, std, 0.05)(error, S1).item() == pytest.approx(
        0, abs=1e-9
    )


def test_weights_follow_the_errors_device_and_kind():
    loss = weighted(total(squared_error, changes(1.0)), metre_weights(torch.ones(63), 1.0))
    assert loss(torch.ones(1, 3, 63, dtype=torch.float64), S1).dtype == torch.float64
    assert np.isfinite(loss(one_error(), S1).item())
