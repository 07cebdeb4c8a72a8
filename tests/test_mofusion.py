"""MoFusion's U-Net: lengths, the batch, time in seconds, and what is encoded once."""

from dataclasses import replace

import pytest
import torch
import torch.nn.functional as F

from motiondiff_edu.cross_modal_attention import angles_of, rotary
from motiondiff_edu.modiff import step_embedding
from motiondiff_edu.mofusion import (
    MOFUSION_FULL,
    MOFUSION_SMALL,
    FrameConv,
    MoFusion,
    MoFusionConfig,
)

TINY = MoFusionConfig(
    D=7, C=5, S=30, widths=(16, 24, 32), heads=2, music_layers=2, target="x0", skip=False
)
MEL_FPS = 31.25


def shaken(config: MoFusionConfig, seed: int = 0) -> MoFusion:
    """A network whose every weight counts: as it is made, its blocks change nothing."""
    torch.manual_seed(seed)
    model = MoFusion(config).eval()
    with torch.no_grad():
        for weight in model.parameters():
            weight.add_(0.15 * torch.randn(weight.shape))
    return model


def music(B: int, M: int, C: int = 5, seed: int = 1):
    return torch.randn(B, M, C, generator=torch.Generator().manual_seed(seed)), torch.arange(
        M
    ) / MEL_FPS


def conv3(layer, x, stride=1, dilation=1):
    """A convolution over three frames, written out: zeros beyond both ends."""
    B, T, W = x.shape
    padded = torch.cat([x.new_zeros(B, dilation, W), x, x.new_zeros(B, dilation, W)], 1)
    neighbours = [padded[:, k * dilation : k * dilation + T : stride] for k in range(3)]
    return torch.cat(neighbours, -1) @ layer.mix.weight.T + layer.mix.bias


@torch.no_grad()
def test_the_music_encoder_by_hand():
    """Four layers see 1, 2, 4 and 8 frames further, and each adds to what came in."""
    model = shaken(replace(TINY, music_layers=4))
    encoder, (mel, _) = model.music, music(2, 40)
    h = conv3(encoder.shorten, F.silu(encoder.project(mel)), stride=2)
    for norm, conv, dilation in zip(encoder.norms, encoder.convs, (1, 2, 4, 8), strict=True):
        h = h + F.silu(conv3(conv, norm(h), dilation=dilation))
    made = encoder(mel, torch.ones(1, 40, 1))
    assert made.shape == (2, 20, 24)
    torch.testing.assert_close(made, encoder.norm(h), atol=1e-5, rtol=1e-4)


@torch.no_grad()
def test_the_wiring_by_hand():
    """One level down and up, written out: every norm, residual, skip and turn at its place."""
    config = replace(TINY, widths=(16,), target="eps", skip=True, music_layers=0)
    model, (mel, times) = shaken(config), music(2, 30)
    x_s, s = torch.randn(2, 12, 7), torch.tensor([4, 19])
    heard, step = model.music.norm(model.music.project(mel)), model.step_in(step_embedding(s, 64))

    def res(part, x):
        h = conv3(part.conv_in, F.silu(part.norm_in(x)))
        scale, shift = part.step(step)[:, None].chunk(2, dim=-1)
        h = conv3(part.conv_out, F.silu(part.norm_out(h) * (1 + scale) + shift))
        return part.around(x) + h

    def attend(part, x, frames):
        code = (config.slowest, config.fastest)
        turns = tuple(angles_of(t, 8, *code) for t in (frames / config.fps, times))
        x = x + part.attention(part.norm(x), heard, None, turns)
        return x + part.ff(part.norm_ff(x))

    def block(parts, x, frames):
        return attend(parts["ask"], res(parts["res"], x), frames)

    fine, coarse = torch.arange(12), torch.arange(0, 12, 2)
    top = block(model.down[0], conv3(model.into, x_s), fine)
    low = block(model.middle, conv3(model.shorten[0], top, stride=2), coarse)
    back = conv3(model.lengthen[0], low.repeat_interleave(2, dim=1))
    out = model.out(block(model.up[0], torch.cat([back, top], -1), fine))
    wanted = out + model.skip[s][:, None, None] * x_s
    made = model(x_s, s, model.listen(mel, times))
    torch.testing.assert_close(made, wanted, atol=1e-5, rtol=1e-4)


@torch.no_grad()
def test_any_length_comes_back_as_long_as_it_was():
    model = shaken(TINY)
    for T in (1, 2, 7, 8, 9, 41):
        mel, times = music(3, 70)
        out = model(torch.randn(3, T, 7), torch.tensor([1, 15, 30]), model.listen(mel, times))
        assert out.shape == (3, T, 7)


@torch.no_grad()
def test_lengths_in_one_batch_do_not_influence_one_another():
    model, lengths = shaken(TINY), torch.tensor([33, 12, 25])
    mel, times = music(3, 60)
    heard = torch.arange(60) < torch.tensor([60, 22, 41])[:, None]
    x, s = torch.randn(3, 33, 7), torch.tensor([4, 17, 29])
    together = model(x, s, model.listen(mel, times, heard), lengths)
    for i, (n, m) in enumerate(zip(lengths, heard.sum(1), strict=True)):
        alone = model(x[i : i + 1, :n], s[i : i + 1], model.listen(mel[i : i + 1, :m], times[:m]))
        torch.testing.assert_close(together[i, :n], alone[0], atol=2e-5, rtol=1e-4)
        assert (together[i, n:] == 0).all()
    assert together[:, :12].std() > 0.05  # else the comparison says nothing


@pytest.mark.parametrize("lengths", [[34, 12], [33, 0]])
def test_lengths_that_no_motion_of_the_batch_has_are_refused(lengths):
    model, (x, s) = shaken(TINY), (torch.randn(2, 33, 7), torch.tensor([4, 17]))
    with pytest.raises(ValueError, match="from 1 to the 33 frames"):
        model(x, s, model.listen(*music(2, 60)), torch.tensor(lengths))


@torch.no_grad()
def test_what_lies_in_the_padding_does_not_matter():
    model, lengths = shaken(TINY), torch.tensor([19, 11])
    mel, times = music(2, 40)
    x = torch.randn(2, 19, 7)
    first = model(x, torch.tensor([3, 9]), model.listen(mel, times), lengths)
    x[1, 11:] = 100.0
    assert torch.equal(first, model(x, torch.tensor([3, 9]), model.listen(mel, times), lengths))


@torch.no_grad()
def test_the_network_hears_the_music_and_when_it_sounds():
    model = shaken(TINY)
    mel, times = music(1, 50)
    x, s = torch.randn(1, 30, 7), torch.tensor([20])
    out = model(x, s, model.listen(mel, times))
    other = model(x, s, model.listen(mel.flip(1), times))
    later = model(x, s, model.listen(mel, times + 0.3))
    assert (out - other).abs().max() > 1e-3 and (out - later).abs().max() > 1e-3


@torch.no_grad()
def test_only_the_distance_in_time_counts():
    """Dance and music a minute later: the same attention, up to rounding."""
    q, k = torch.randn(2, 3, 9, 8), torch.randn(2, 3, 13, 8)
    frames, heard = torch.arange(9) / 20, torch.arange(13) / 15.625

    def scores(shift: float):
        turn = [angles_of(t + shift, 8, 0.05, 8.0) for t in (frames, heard)]
        return rotary(q, turn[0]) @ rotary(k, turn[1]).mT

    torch.testing.assert_close(scores(0.0), scores(60.0), atol=2e-3, rtol=1e-3)
    assert (scores(0.0) - q @ k.mT).abs().max() > 0.1


def test_a_turn_keeps_lengths_and_zero_turns_nothing():
    x = torch.randn(2, 5, 8)
    angles = angles_of(torch.arange(5) / 20, 8, 0.05, 8.0)
    torch.testing.assert_close(rotary(x, angles).norm(dim=-1), x.norm(dim=-1))
    assert torch.equal(rotary(x, torch.zeros(5, 4)), x)
    assert angles[3].tolist() == pytest.approx(
        [2 * torch.pi * 0.15 * f for f in (0.05, 0.2714, 1.4736, 8.0)], rel=1e-3
    )


@torch.no_grad()
def test_without_music_the_motion_attends_to_itself():
    config = replace(TINY, C=0)
    model, lengths = shaken(config), torch.tensor([21, 13])
    x, s = torch.randn(2, 21, 7), torch.tensor([3, 9])
    out = model(x, s, None, lengths)
    torch.testing.assert_close(out[1, :13], model(x[1:, :13], s[1:])[0], atol=2e-5, rtol=1e-4)
    far = x.clone()
    far[:, -1] += 5.0
    assert (model(far, s) - model(x, s))[
        :, 0
    ].abs().max() > 1e-5  # 20 frames away: through attention, or the depth
    with pytest.raises(ValueError, match="takes no music"):
        model(x, s, shaken(TINY).listen(*music(2, 30)))
    with pytest.raises(ValueError, match="pass its music"):
        shaken(TINY)(x, s)


@torch.no_grad()
@pytest.mark.parametrize("change", [{}, {"skip": True, "target": "eps"}, {"music_layers": 0}])
def test_a_song_encoded_once_is_decoded_at_every_step(change):
    model = shaken(replace(TINY, **change))
    heard, x = model.listen(*music(3, 64)), torch.randn(3, 37, 7)
    memory = model.encode(heard, 37)
    for s in (torch.full((3,), 1), torch.full((3,), 30), torch.tensor([2, 9, 28])):
        torch.testing.assert_close(model.decode(x, s, memory), model(x, s, heard))
    with pytest.raises(ValueError, match="motions of 37 frames, not of 36: encode again"):
        model.decode(x[:, :36], torch.full((3,), 1), memory)
    other = model.encode(model.listen(*music(3, 64, seed=2)), 37)
    assert not torch.allclose(model.decode(x, s, other), model(x, s, heard), atol=1e-4)


@pytest.mark.parametrize("stride, dilation", [(1, 1), (2, 1), (1, 4)])
def test_a_frame_is_mixed_from_itself_and_its_neighbours(stride, dilation):
    conv, x = FrameConv(4, 5, stride, dilation), torch.randn(2, 11, 4)
    out, nothing = conv(x), torch.zeros(2, 4)
    assert out.shape == (2, -(-11 // stride), 5)
    for k in range(out.shape[1]):
        t = k * stride
        frames = [x[:, i] if 0 <= i < 11 else nothing for i in (t - dilation, t, t + dilation)]
        wanted = conv.mix.bias + sum(
            frame @ conv.mix.weight[:, 4 * tap : 4 * tap + 4].T for tap, frame in enumerate(frames)
        )
        torch.testing.assert_close(out[:, k], wanted)


def test_a_new_network_changes_nothing_between_its_ends():
    """Residual blocks start as what leads around them.

    So a deep network trains from the first step.
    """
    torch.manual_seed(0)
    block = MoFusion(TINY).down[0]["res"]
    x = torch.randn(2, 9, 16)
    assert torch.equal(block(x, torch.randn(2, 64), torch.ones(1, 9, 1)), x)


def test_sizes_are_checked():
    for wrong in (
        {"widths": (18,)},
        {"widths": ()},
        {"target": "y"},
        {"S": 0},
        {"heads": 0},
        {"fps": 0.0},
        {"slowest": 0.0},
    ):
        with pytest.raises(ValueError):
            MoFusionConfig(**wrong)
    assert len(MOFUSION_SMALL.widths) == len(MOFUSION_FULL.widths) == 3  # the paper's levels


def test_gradients_reach_every_weight():
    model = shaken(replace(TINY, skip=True, target="eps"))
    mel, times = music(2, 30)
    model(
        torch.randn(2, 18, 7), torch.tensor([3, 20]), model.listen(mel, times)
    ).square().mean().backward()
    assert [
        name for name, p in model.named_parameters() if p.grad is None or not p.grad.abs().sum() > 0
    ] == []
