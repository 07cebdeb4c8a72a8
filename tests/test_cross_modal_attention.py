"""Attention against torch's own, and the T5 buckets against published values.

Watching changes nothing.
"""

from math import pi

import pytest
import torch
from torch import nn
from torch.nn import functional as F

from motiondiff_edu.cross_modal_attention import (
    Block,
    CrossModalAttention,
    RelativeBias,
    attention,
    attention_weights,
    relative_position_bucket,
    rotary,
    watch,
)

B = 2
H = 3
T = 5
M = 7
d = 4


@pytest.fixture
def qkvb():
    g = torch.Generator().manual_seed(0)
    shapes = [(B, H, T, d), (B, H, M, d), (B, H, M, d), (1, H, T, M)]
    return [torch.randn(*shape, generator=g) for shape in shapes]


def random_layer(*args, seed=1, **kwargs):
    torch.manual_seed(seed)
    return CrossModalAttention(*args, **kwargs).eval()


def test_equals_torch(qkvb):
    q, k, v, bias = qkvb
    torch.testing.assert_close(attention(q, k, v), F.scaled_dot_product_attention(q, k, v))
    wanted = F.scaled_dot_product_attention(q, k, v, attn_mask=bias)
    torch.testing.assert_close(attention(q, k, v, bias), wanted)


def test_rows_are_distributions(qkvb):
    q, k, _, bias = qkvb
    for weights in (attention_weights(q, k), attention_weights(q, k, bias)):
        assert weights.shape == (B, H, T, M) and (weights >= 0).all()
        torch.testing.assert_close(weights.sum(-1), torch.ones(B, H, T))


def test_order_of_keys_and_values_is_nothing(qkvb):
    q, k, v, bias = qkvb
    order = torch.randperm(M, generator=torch.Generator().manual_seed(4))
    torch.testing.assert_close(attention(q, k[..., order, :], v[..., order, :]), attention(q, k, v))
    assert not torch.allclose(
        attention(q, k[..., order, :], v), attention(q, k, v)
    )  # together, or not at all


def test_a_key_that_is_masked_out_gets_nothing(qkvb):
    q, k, v, _ = qkvb
    bias = torch.zeros(1, H, T, M)
    bias[..., 2] = -torch.inf
    changed = v.clone()
    changed[:, :, 2] = 1e6
    assert torch.equal(attention_weights(q, k, bias)[..., 2], torch.zeros(B, H, T))
    torch.testing.assert_close(attention(q, k, changed, bias), attention(q, k, v, bias))


# transformers 5.23.0, T5Attention._relative_position_bucket, 32 buckets, farthest 128; distance =
# key - query
T5_BOTH = {
    -128: 15, -91: 15, -64: 14, -46: 13, -32: 12, -23: 11, -16: 10, -12: 9, -11: 8, -8: 8, -7: 7,
    -1: 1, 0: 0, 1: 17, 7: 23, 8: 24, 12: 25,
    16: 26, 23: 27, 32: 28, 46: 29, 64: 30, 91: 31, 200: 31,
}  # fmt: skip
T5_CAUSAL = {
    -128: 31,
    -91: 29,
    -64: 26,
    -46: 24,
    -32: 21,
    -23: 18,
    -16: 16,
    -12: 12,
    -7: 7,
    0: 0,
    1: 0,
    40: 0,
}


@pytest.mark.parametrize("table, both", [(T5_BOTH, True), (T5_CAUSAL, False)])
def test_buckets_are_those_of_t5(table, both):
    found = relative_position_bucket(torch.tensor(list(table)), bidirectional=both)
    assert found.tolist() == list(table.values())


@pytest.mark.parametrize("sizes", [(32, 128, True), (32, 128, False), (12, 10, True)])
def test_buckets_over_the_whole_range(real_data, sizes):
    import numpy as np

    file = np.load(real_data / "oracle" / "t5_relative_position_buckets.npz")
    buckets, farthest, both = sizes
    found = relative_position_bucket(torch.from_numpy(file["rel"]), buckets, farthest, both)
    wanted = file[f"{'bidirectional' if both else 'causal'}_{buckets}_{farthest}"]
    assert np.array_equal(found.numpy(), wanted)


def test_bias_depends_on_the_time_between_only():
    bias = RelativeBias(H, torch.arange(3, 3 + T), torch.arange(M))
    nn.init.normal_(bias.table, generator=torch.Generator().manual_seed(2))
    out = bias()
    assert out.shape == (1, H, T, M)
    torch.testing.assert_close(out[..., 1:, 1:], out[..., :-1, :-1])  # both a frame later: the same
    assert torch.equal(out[0, 1, 0, 3], bias.table[0, 1])  # key time 3, query time 3: bucket 0
    assert not torch.equal(out[0, 1, 0, 2], out[0, 1, 0, 4])  # before and after are told apart


def test_layer_equals_multihead_attention_with_the_same_weights():
    width, context_width = 12, 10
    mine = random_layer(width, H, context_width)
    theirs = nn.MultiheadAttention(
        width, H, kdim=context_width, vdim=context_width, batch_first=True
    ).eval()
    with torch.no_grad():
        k_weight, v_weight = mine.kv.weight.chunk(2)
        theirs.q_proj_weight.copy_(mine.q.weight)
        theirs.k_proj_weight.copy_(k_weight)
        theirs.v_proj_weight.copy_(v_weight)
        theirs.in_proj_bias.copy_(torch.cat([mine.q.bias, mine.kv.bias]))
        theirs.out_proj.load_state_dict(mine.out.state_dict())
    g = torch.Generator().manual_seed(8)
    x = torch.randn(B, T, width, generator=g)
    context = torch.randn(B, M, context_width, generator=g)
    wanted, weights = theirs(x, context, context, average_attn_weights=False)
    torch.testing.assert_close(mine(x, context), wanted, atol=1e-6, rtol=1e-5)
    with watch(mine) as maps:
        mine(x, context)
    torch.testing.assert_close(maps[""][0], weights, atol=1e-6, rtol=1e-5)


def test_watching_collects_maps_and_changes_nothing():
    torch.manual_seed(3)
    block = Block(12, H, 20, with_context=True).eval()
    g = torch.Generator().manual_seed(9)
    x = torch.randn(B, T, 12, generator=g)
    context = torch.randn(B, M, 12, generator=g)
    bias = torch.randn(1, H, T, T, generator=g)
    context_bias = torch.randn(1, H, T, M, generator=g)
    kept = block.cross_attention.keys_and_values(context)
    plain = block(x, bias, kept, context_bias)
    with watch(block) as maps:
        watched = block(x, bias, kept, context_bias)
        block(x, bias, kept, context_bias)
    torch.testing.assert_close(watched, plain, atol=1e-6, rtol=1e-5)
    assert {name: [tuple(m.shape) for m in seen] for name, seen in maps.items()} == {
        "self_attention": [(B, H, T, T)] * 2,
        "cross_attention": [(B, H, T, M)] * 2,
    }
    assert not maps["cross_attention"][0].requires_grad
    torch.testing.assert_close(maps["self_attention"][1].sum(-1), torch.ones(B, H, T))
    block(x, bias, kept, context_bias)
    assert len(maps["self_attention"]) == 2  # outside, nothing is kept
    assert block.self_attention.watcher is None and block.cross_attention.watcher is None


def test_watching_ends_when_the_block_is_left_by_an_error():
    layer = random_layer(6, 2)
    with pytest.raises(RuntimeError, match="on purpose"), watch(layer):
        raise RuntimeError("on purpose")
    assert layer.watcher is None


def test_watching_within_watching_goes_on_afterwards():
    layer = random_layer(6, 2)
    x = torch.randn(1, 3, 6)
    with watch(layer) as outer:
        layer(x, x)
        with watch(layer) as inner:
            layer(x, x)
        layer(x, x)
    assert [len(seen) for maps in (outer, inner) for seen in maps.values()] == [2, 1]


def test_each_pair_is_turned_by_its_own_angle():
    """The pairs are (1, 2) and (3, 0): a quarter turn of the one, half a turn of the other."""
    turned = rotary(torch.tensor([[1.0, 3.0, 2.0, 0.0]]), torch.tensor([[pi / 2, pi]]))
    torch.testing.assert_close(turned, torch.tensor([[-2.0, -3.0, 1.0, 0.0]]))


def test_heads_own_neighbouring_channels():
    layer, x = random_layer(12, H), torch.arange(12.0).expand(B, T, 12)
    assert torch.equal(layer.split(x)[0, 1, 0], torch.tensor([4.0, 5, 6, 7]))


def test_width_that_heads_cannot_share():
    with pytest.raises(ValueError, match="width 10 must be a multiple of 3 heads"):
        CrossModalAttention(10, 3)


def test_block_is_its_formula():
    """x + self(norm x), + cross(norm x), + ff(norm x): written out, against the class."""
    torch.manual_seed(6)
    block = Block(12, H, 20, with_context=True).eval()
    g = torch.Generator().manual_seed(5)
    x = torch.randn(B, T, 12, generator=g)
    context = torch.randn(B, M, 12, generator=g)
    biases = torch.randn(1, H, T, T, generator=g), torch.randn(1, H, T, M, generator=g)
    kept = block.cross_attention.keys_and_values(context)
    for own, crossed in ((None, None), biases):
        n = F.layer_norm(x, (12,), block.norm_self.weight, block.norm_self.bias)
        y = x + block.self_attention(n, n, own)
        y = y + block.cross_attention(F.layer_norm(y, (12,)), context, crossed)
        y = y + block.ff(F.layer_norm(y, (12,)))
        torch.testing.assert_close(block(x, own, kept, crossed), y)


def test_each_part_of_a_block_is_dropped_in_training_alone():
    """With a rate of 1 nothing is left of attention and feed-forward; without dropout, all is."""
    torch.manual_seed(6)
    block = Block(12, H, 20, with_context=True, dropout=1.0)
    x, context = torch.randn(B, T, 12), torch.randn(B, M, 12)
    kept = block.cross_attention.keys_and_values(context)
    assert torch.equal(block(x, context=kept), x)
    assert not torch.equal(block.eval()(x, context=kept), x)
    parts = (block.self_attention.out, block.cross_attention.out, block.ff[-1])
    block.train()
    block.drop.p = 0.5
    for part in parts:  # only this one gives something, and half of it is dropped
        for other in parts:
            nn.init.zeros_(other.weight)
            nn.init.constant_(other.bias, float(other is part))
        given = block(x, context=kept) - x
        assert 0.3 < (given.abs() < 1e-5).float().mean() < 0.7
        torch.testing.assert_close(given[given.abs() > 0.5].mean(), torch.tensor(2.0))
