"""Some windows hold their control over the future; the others, and the data, stay as they are."""

import pytest
import torch

from motiondiff_edu.performers.windows import held_control

CONTROL = torch.arange(400 * 6 * 3, dtype=torch.float32).reshape(400, 6, 3)


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_a_share_of_the_windows_holds_the_last_row_of_the_past(share):
    before = CONTROL.clone()
    made = held_control(CONTROL, 4, share, torch.Generator().manual_seed(1))
    assert torch.equal(CONTROL, before) and torch.equal(made[:, :4], CONTROL[:, :4])
    held = (made[:, 4:] == CONTROL[:, 3:4]).all(-1).all(-1)
    assert abs(held.float().mean() - share) <= 0.1 * (share == 0.5)
    assert torch.equal(made[~held], CONTROL[~held])


def test_it_comes_from_the_generator():
    one, again, other = (
        held_control(CONTROL, 4, 0.5, torch.Generator().manual_seed(seed)) for seed in (1, 1, 2)
    )
    assert torch.equal(one, again) and not torch.equal(one, other)
