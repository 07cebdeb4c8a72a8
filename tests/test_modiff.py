"""MoDiff's network: the paper's sizes, its inputs, the skip, what is encoded once; Algorithm 1."""

import math
from dataclasses import replace

import pytest
import torch

from motiondiff_edu.cross_modal_attention import relative_position_bucket
from motiondiff_edu.ddpm import linear_schedule
from motiondiff_edu.diffusion_dropout import Dropout
from motiondiff_edu.modiff import MODIFF_PAPER, MODIFF_SMALL, MoDiff, step_embedding, training_loss

TINY = replace(MODIFF_SMALL, D=9, T_h=4, T_p=5, S=20, width=16, heads=2, hidden=24)
B = 3


def lively(config, seed=0):
    """A network whose zero-initialised tables have values too.

    Else a missing bias would go unnoticed.
    """
    torch.manual_seed(seed)
    model = MoDiff(config).eval()
    with torch.no_grad():
        for name, weight in model.named_parameters():
            if name.endswith("table") or name == "skip":
                weight.add_(0.5 * torch.randn_like(weight))
    return model


def inputs(config, batch=B, seed=1):
    g = torch.Generator().manual_seed(seed)
    x_s = torch.randn(batch, config.T_p, config.D, generator=g)
    past = torch.randn(batch, config.T_h, config.D, generator=g)
    control = torch.randn(batch, config.T_h + config.T_p, config.C, generator=g)
    return x_s, torch.full((batch,), 7), past, control


@pytest.mark.parametrize(
    ("config", "cross"), [(MODIFF_PAPER, 6), (MODIFF_SMALL, 2)], ids=["paper", "small"]
)
def test_layers_are_the_papers_but_for_the_small_ones_cross_modal_layers(config, cross):
    model = MoDiff(config)
    encoders = (model.motion_encoder, model.control_encoder, model.cross_encoder)
    assert [len(e.blocks) for e in encoders] == [2, 2, cross]
    assert len(model.decoder) == 3 and all(block.with_context for block in model.decoder)
    assert (config.T_h, config.S, config.heads, config.D, config.C) == (10, 100, 4, 63, 3)


def test_paper_sizes():
    assert (MODIFF_PAPER.width, MODIFF_PAPER.heads, MODIFF_PAPER.target) == (256, 4, "eps")
    paper, small = (
        sum(p.numel() for p in MoDiff(c).parameters()) for c in (MODIFF_PAPER, MODIFF_SMALL)
    )
    assert (
        11e6 < paper < 13e6 and small < 2e6
    )  # a paper-width block has 12 * 256^2 weights and a bit


@pytest.mark.parametrize(
    "wrong", [{"heads": 0}, {"S": -1}, {"target": "foo"}, {"decoder_layers": -1}]
)
def test_sizes_that_make_no_network_are_refused(wrong):
    with pytest.raises(ValueError, match=next(iter(wrong))):
        replace(TINY, **wrong)


@pytest.mark.parametrize("config", [TINY, MODIFF_SMALL], ids=["tiny", "small"])
def test_output_has_the_shape_of_the_future(config):
    x_s, s, past, control = inputs(config)
    assert lively(config)(x_s, s, past, control).shape == x_s.shape


@pytest.mark.parametrize("frames", [(3, 9), (4, 8), (4, 10), (5, 9)])
def test_wrong_numbers_of_frames_are_told(frames):
    x_s, s, past, control = inputs(TINY)
    with pytest.raises(
        ValueError, match=rf"4 past poses and 9 rows.*not {frames[0]}.* and {frames[1]}"
    ):
        MoDiff(TINY)(x_s, s, torch.zeros(B, frames[0], TINY.D), torch.zeros(B, frames[1], TINY.C))


@pytest.mark.parametrize("frames", [1, 4, 6])
def test_a_future_of_another_length_is_told(frames):
    """One frame would be repeated, and give five."""
    _, s, past, control = inputs(TINY)
    model, future = MoDiff(TINY), torch.zeros(B, frames, TINY.D)
    batch, schedule = (past, future, control), linear_schedule(TINY.S, 1e-3, 0.5)
    with pytest.raises(ValueError, match=f"predicts 5 future poses, not {frames}"):
        model(future, s, past, control)
    with pytest.raises(ValueError, match=f"predicts 5 future poses, not {frames}"):
        training_loss(model, batch, schedule, torch.Generator().manual_seed(0))


@pytest.mark.parametrize("which", ["x_s", "s", "past", "control"])
def test_every_input_is_heard(which):
    model = lively(TINY)
    args = dict(zip(("x_s", "s", "past", "control"), inputs(TINY), strict=True))
    before = model(**args)
    args[which] = args[which] + (1 if which == "s" else 0.5)
    assert not torch.allclose(model(**args), before, atol=1e-4)


def test_rows_of_a_batch_do_not_talk():
    model, (x_s, _, past, control) = lively(TINY), inputs(TINY)
    s = torch.tensor([1, 9, 20])
    together = model(x_s, s, past, control)
    for b in range(B):
        alone = model(x_s[b : b + 1], s[b : b + 1], past[b : b + 1], control[b : b + 1])
        torch.testing.assert_close(together[b : b + 1], alone, atol=1e-5, rtol=1e-5)


def test_order_in_time_matters_and_the_relative_bias_is_used():
    model, (x_s, s, past, control) = lively(TINY), inputs(TINY)
    before = model(x_s, s, past, control)
    assert not torch.allclose(model(x_s.flip(1), s, past, control).flip(1), before, atol=1e-3)
    for bias in (
        model.self_bias,
        model.memory_bias,
        model.cross_encoder.bias,
        model.control_encoder.bias,
    ):
        kept = bias.table.detach().clone()
        with torch.no_grad():
            bias.table.zero_()
            assert not torch.allclose(model(x_s, s, past, control), before, atol=1e-5)
            bias.table.copy_(kept)


def test_without_time_the_future_is_a_set_of_frames():
    """Neither biases nor clocks: turning the future round turns the output round."""
    model, (x_s, s, past, control) = lively(TINY), inputs(TINY)
    with torch.no_grad():
        for name, weight in model.named_parameters():
            if name.endswith("table") or name == "time":
                weight.zero_()
        turned = model(x_s.flip(1), s, past, control).flip(1)
        torch.testing.assert_close(turned, model(x_s, s, past, control), atol=1e-5, rtol=1e-5)


def test_at_the_start_each_frame_has_its_own_code_of_time():
    model = MoDiff(TINY)
    wanted = step_embedding(8 * torch.arange(TINY.T_h + TINY.T_p), TINY.width)
    torch.testing.assert_close(model.time.detach(), wanted)
    apart = torch.cdist(wanted, wanted) + 9 * torch.eye(len(wanted))
    assert apart.min() > 0.5


def test_skip_adds_w_of_s_times_the_input():
    with_skip = lively(TINY)
    without = MoDiff(replace(TINY, skip=False)).eval()
    without.load_state_dict({k: v for k, v in with_skip.state_dict().items() if k != "skip"})
    x_s, _, past, control = inputs(TINY)
    s = torch.tensor([2, 11, 20])
    wanted = without(x_s, s, past, control) + with_skip.skip[s].view(B, 1, 1) * x_s
    torch.testing.assert_close(with_skip(x_s, s, past, control), wanted)
    assert torch.equal(MoDiff(TINY).skip, torch.ones(TINY.S + 1))


def test_step_embedding_by_hand():
    out = step_embedding(torch.tensor([0, 3]), 6)
    frequencies = [1.0, 1e4 ** (-1 / 3), 1e4 ** (-2 / 3)]
    wanted = [math.sin(3 * f) for f in frequencies] + [math.cos(3 * f) for f in frequencies]
    torch.testing.assert_close(out, torch.tensor([[0.0, 0, 0, 1, 1, 1], wanted]))


@pytest.mark.parametrize("config", [TINY, MODIFF_SMALL, replace(TINY, skip=False)],
                         ids=["tiny", "small", "no skip"])  # fmt: skip
@torch.no_grad()
def test_a_window_encoded_once_is_decoded_at_every_step(config):
    model, (x_s, _, past, control) = lively(config), inputs(config)
    memory = model.encode(past, control)
    for s in (torch.full((3,), 1), torch.full((3,), config.S), torch.tensor([3, 20, 11])):
        assert torch.equal(model.decode(x_s, s, memory), model(x_s, s, past, control))


@torch.no_grad()
def test_a_memory_belongs_to_its_past_and_its_control():
    model, (x_s, s, past, control) = lively(TINY), inputs(TINY)
    wanted = model.decode(x_s, s, model.encode(past, control))
    for other in ((past + 1, control), (past, control + 1)):
        assert not torch.allclose(model.decode(x_s, s, model.encode(*other)), wanted, atol=1e-4)


def test_the_wiring_by_hand():
    """Which table goes where, and when everything happens.

    Written out, with every time as a number.

    T_h = 4, T_p = 5: poses are given at frames -3 to 0, control at -3 to 5, and the future is 1 to
    5.
    """
    model, (x_s, s, past, control) = lively(TINY), inputs(TINY)
    given = [-3, -2, -1, 0]
    told = [-3, -2, -1, 0, 1, 2, 3, 4, 5]
    future = [1, 2, 3, 4, 5]
    clock = {t: model.time[t + 3] for t in told}

    def encoder(part, times, x):
        bias = part.bias.table[
            relative_position_bucket(torch.tensor(times)[None] - torch.tensor(times)[:, None])
        ]
        for block in part.blocks:
            x = block(x, bias.permute(2, 0, 1)[None])
        return x

    with torch.no_grad():
        motion = model.past_in(past) + torch.stack([clock[t] for t in given]) + model.modality[0]
        steered = (
            model.control_in(control) + torch.stack([clock[t] for t in told]) + model.modality[1]
        )
        tokens = [
            encoder(model.motion_encoder, given, motion),
            encoder(model.control_encoder, told, steered),
        ]
        memory = model.memory_norm(encoder(model.cross_encoder, given + told, torch.cat(tokens, 1)))
        noised = torch.cat(
            [x_s, model.step_in(step_embedding(s, 16))[:, None].expand(-1, 5, -1)], -1
        )
        x = model.future_in(noised) + torch.stack([clock[t] for t in future])
        gaps = {name: torch.tensor(times)[None] - torch.tensor(future)[:, None]
                for name, times in (("self", future), ("memory", given + told))}  # fmt: skip
        own = model.self_bias.table[relative_position_bucket(gaps["self"])].permute(2, 0, 1)[None]
        other = model.memory_bias.table[relative_position_bucket(gaps["memory"])].permute(2, 0, 1)[
            None
        ]
        for block in model.decoder:
            x = block(x, own, block.cross_attention.keys_and_values(memory), other)
        wanted = model.head(x) + model.skip[7] * x_s
        torch.testing.assert_close(model(x_s, s, past, control), wanted, atol=1e-6, rtol=1e-5)


@pytest.mark.parametrize("target", ["eps", "x0", "v"])
@pytest.mark.parametrize("rate", [0.0, 0.5])
def test_training_loss_is_algorithm_1(target, rate):
    """Steps, dropout and noise drawn as the loss draws them; the rest written out."""
    model, schedule = lively(replace(TINY, target=target)), linear_schedule(TINY.S, 0.2, 0.95)
    x0, _, past, control = inputs(TINY, batch=9)
    dropout = Dropout(schedule, lambda done: rate, steps=1, done=0.0)
    loss = training_loss(
        model, (past, x0, control), schedule, torch.Generator().manual_seed(4), dropout=dropout
    )
    draws = torch.Generator().manual_seed(4)
    s = torch.randint(1, TINY.S + 1, (9,), generator=draws)
    hit = torch.rand(9, generator=draws) < rate
    of_past, eps = torch.randn(past.shape, generator=draws), torch.randn(x0.shape, generator=draws)
    a = schedule.alpha_bar[s].float().sqrt()[:, None, None]
    b = (1 - schedule.alpha_bar[s]).float().sqrt()[:, None, None]
    x_d = torch.where(hit[:, None, None], a * past + b * of_past, past)
    wanted = {"eps": eps, "x0": x0, "v": a * eps - b * x0}[target]
    errors = (wanted - model(a * x0 + b * eps, s, x_d, control)) ** 2
    assert (0 < hit.sum() < 9) == (rate > 0)
    assert loss.item() == pytest.approx(errors.mean().item(), rel=1e-5)


def test_every_step_is_drawn_and_none_beyond():
    model, schedule = lively(TINY), linear_schedule(TINY.S, 0.2, 0.95)
    seen = set()
    x0, _, past, control = inputs(TINY, batch=200)
    draws = torch.Generator().manual_seed(6)

    def dropout(past, s, generator):
        seen.update(s.tolist())
        return past

    training_loss(model, (past, x0, control), schedule, draws, dropout=dropout)
    assert seen == set(range(1, TINY.S + 1))


def test_the_dropout_of_a_configuration_reaches_all_blocks_and_no_other_network_has_any():
    def rates(config):
        return {one.p for one in MoDiff(config).modules() if isinstance(one, torch.nn.Dropout)}

    assert rates(MODIFF_PAPER) == {MODIFF_PAPER.dropout} and MODIFF_PAPER.dropout > 0
    assert rates(MODIFF_SMALL) == {0.0}
