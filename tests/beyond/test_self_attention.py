"""Frames far apart see each other, padding does not, and the rest is MoFusion."""

import pytest
import torch

from motiondiff_edu.beyond.self_attention import (
    CURVES,
    SLOWEST,
    SelfAttendingMoFusion,
    from_both_ends,
)
from motiondiff_edu.cross_modal_attention import angles_of
from motiondiff_edu.mofusion import Level, MoFusion, MoFusionConfig

CONFIG = MoFusionConfig(D=5, C=6, S=20, widths=(16, 24, 32), heads=2, music_layers=0)


def built(kind):
    torch.manual_seed(0)
    model = kind(CONFIG).eval()
    for parameter in model.parameters():  # blocks that begin at zero would hide their inputs
        if not parameter.any():
            torch.nn.init.normal_(parameter, std=0.1)
    return model


def reach(model, T: int = 240) -> float:
    """How much the last frame's output depends on the first frame's input."""
    x = torch.randn(1, T, 5, generator=torch.Generator().manual_seed(1), requires_grad=True)
    music = model.listen(torch.ones(1, 3, 6), torch.zeros(3))
    model(x, torch.tensor([9]), music)[0, -1].sum().backward()
    return x.grad[0, 0].abs().max().item()


def test_the_last_frame_sees_the_first_one():
    assert reach(built(MoFusion)) == 0.0  # 12 s: convolutions do not reach so far
    assert reach(built(SelfAttendingMoFusion)) > 0.0


@pytest.mark.parametrize("levels, blocks", [(1, 1), (2, 3), (4, 7)])
def test_the_lowest_levels_attend_to_themselves(levels, blocks):
    model = SelfAttendingMoFusion(CONFIG, levels)
    every = [*model.down, model.middle, *model.up]
    assert sum("own" in block for block in every) == blocks and "own" in model.middle
    plain = set(MoFusion(CONFIG).state_dict())
    assert plain < set(model.state_dict())


def test_padding_is_not_seen():
    model = built(SelfAttendingMoFusion)
    x = torch.randn(2, 40, 5, generator=torch.Generator().manual_seed(2))
    s, music = torch.tensor([4, 4]), model.listen(torch.ones(2, 3, 6), torch.zeros(3))
    lengths = torch.tensor([40, 24])
    together = model(x, s, music, lengths)
    other = x.clone()
    other[1, 24:] = 100.0
    torch.testing.assert_close(model(other, s, music, lengths), together)
    assert not together[1, 24:].any()


def test_where_a_motion_begins_does_not_matter_to_attention_over_time():
    """Only differences of times count: the code of times is a rotation."""
    model = built(SelfAttendingMoFusion)
    block = model.middle["own"]
    h = torch.randn(1, 7, 32, generator=torch.Generator().manual_seed(3))

    def angles(first):
        return angles_of(first + torch.arange(7) * 0.4, 16, CONFIG.slowest, CONFIG.fastest)

    near, far = (block(h, None, None, (angles(t), angles(t))) for t in (0.0, 5.0))
    torch.testing.assert_close(near, far, atol=1e-5, rtol=1e-4)


def test_seconds_are_counted_from_the_first_frame_and_to_the_last_one_of_each_motion():
    """The slowest curve turns once in 50 s, so it is nearly the angle itself."""
    times, mask = torch.arange(5.0), torch.ones(2, 5, 1)
    mask[1, 3:] = 0
    codes = from_both_ends(Level(times=times, mask=mask, bias=None, angles={}))
    sines = codes.unflatten(-1, (2, 2 * CURVES))[..., 0]  # (motion, frame, which end)
    angle = 2 * torch.pi * SLOWEST
    torch.testing.assert_close(sines[..., 0], (angle * times).sin().expand(2, -1))
    left = torch.tensor([[4.0, 3, 2, 1, 0], [2, 1, 0, -1, -2]])
    torch.testing.assert_close(sines[..., 1], (angle * left).sin())
