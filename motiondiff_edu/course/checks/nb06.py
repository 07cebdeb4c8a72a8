"""Checks of notebook 06: attention with a bias, heads, and the relative bias of T5."""

import math

import torch
from torch.nn import functional as F

from ._report import check, expect, expect_close


def _numbers(*shape: int, seed: int = 0) -> torch.Tensor:
    return torch.randn(*shape, generator=torch.Generator().manual_seed(seed))


@check
def attention_with_bias(mine):
    """mine(q, k, v, bias) against attention in two lines of PyTorch."""
    q = _numbers(3, 4)
    k = _numbers(5, 4, seed=1)
    v = _numbers(5, 2, seed=2)
    bias = 2 * _numbers(3, 5, seed=3)
    raw, scaled = q @ k.T, q @ k.T / 2
    mistakes = {
        "the scores are not divided by anything: what does their size grow with?": (
            raw + bias
        ).softmax(-1)
        @ v,
        "divide by the square root of d, not by d": (raw / 4 + bias).softmax(-1) @ v,
        "d is the size of a query, not the number of keys": (raw / math.sqrt(5) + bias).softmax(-1)
        @ v,
        "only the scores are divided; the bias is added after that": ((raw + bias) / 2).softmax(-1)
        @ v,
        "the softmax runs over the wrong axis: each query's weights must sum to one": (
            scaled + bias
        ).softmax(0)
        @ v,
        "the bias belongs inside the softmax": (scaled.softmax(-1) + bias) @ v,
        "the bias is not used": scaled.softmax(-1) @ v,
        "these are scores times values; where is the softmax?": (scaled + bias) @ v,
    }
    wanted = F.scaled_dot_product_attention(q[None], k[None], v[None], attn_mask=bias[None])[0]
    expect_close(mine(q, k, v, bias), wanted, "the output for 3 queries and 5 keys", mistakes)
    hidden = bias.clone()
    hidden[:, 1] = -math.inf
    rest = [0, 2, 3, 4]
    without = F.scaled_dot_product_attention(
        q[None], k[None, rest], v[None, rest], attn_mask=bias[None][..., rest]
    )
    expect_close(
        mine(q, k, v, hidden), without[0], "the output when a bias of minus infinity hides a key"
    )
    return "A bias of minus infinity is a mask; every mask in a transformer is a bias."


@check
def split_into_heads(mine):
    """mine(x, heads): (B, T, width) to (B, heads, T, width / heads), each channel in its place."""
    x = torch.arange(2 * 5 * 12.0).reshape(
        2, 5, 12
    )  # batch 2, 5 frames, 12 channels; heads of 4 channels
    wanted = torch.stack(
        [torch.stack([x[b, :, 4 * h : 4 * h + 4] for h in range(3)]) for b in range(2)]
    )
    got = mine(x, 3)
    mistakes = {
        (
            "frames and channels are mixed: split the channels, then move the heads to the front"
        ): x.reshape(2, 3, 5, 4),
        "a head owns neighbouring channels, not every third": x.reshape(2, 5, 4, 3).permute(
            0, 3, 1, 2
        ),
    }
    flat = torch.as_tensor(got)
    expect(
        tuple(flat.shape) != (2, 5, 3, 4),
        "the channels are split correctly; the heads must come before the frames",
    )
    expect(tuple(flat.shape) != (2, 4, 5, 3), "there are 3 heads of 4 channels, not 4 of 3")
    expect_close(got, wanted, "the heads of 12 channels", mistakes)
    return "Heads cost nothing: they are the same numbers, read as several short vectors."


@check
def relative_bias(mine):
    """mine(table, query, key) against buckets that published code of T5 computed."""
    query, key = torch.tensor([0, 8]), torch.tensor([0, -8, 16, 1, 7])
    buckets = torch.tensor(
        [[0, 8, 26, 17, 23], [8, 10, 24, 7, 1]]
    )  # of T5, as published code has them
    turned = torch.tensor([[0, 24, 10, 1, 7], [24, 26, 8, 23, 17]])  # the same of query minus key
    table = _numbers(32, 3)
    mistakes = {
        "the distance is the key's time minus the query's": table[turned].permute(2, 0, 1),
        "before and after must differ: do not take the absolute value": table[
            torch.tensor([[0, 24, 26, 17, 23], [24, 26, 24, 23, 17]])
        ].permute(2, 0, 1),
        "use the bucket of the distance, not the distance": table[
            (key[None] - query[:, None]) % 32
        ].permute(2, 0, 1),
    }
    got = mine(table, query, key)
    shape = tuple(torch.as_tensor(got).shape)
    expect(shape != (2, 5, 3), "the values are right; the heads must come first: (H, T, M)")
    expect(shape != (3, 5, 2), "queries are rows and keys are columns: (H, T, M)")
    expect_close(got, table[buckets].permute(2, 0, 1), "the bias of 2 queries and 5 keys", mistakes)
    return "The table knows only distances, so it also serves a window that begins elsewhere."
