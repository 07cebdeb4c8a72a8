"""Checks of notebook 06: attention with a bias, heads, and the relative bias of T5."""

import math

import numpy as np
import torch
from torch.nn import functional as F

from ._compare import compare
from ._drawn import tensors
from ._report import check
from .zoo.nb06 import MISTAKES


def _queries(rng: np.random.Generator):
    """3 queries and 5 keys; others; a hidden key; scores near 900."""
    for T, M, d, e in ((3, 5, 4, 2), (6, 4, 9, 3)):
        yield tensors(rng, T, d), tensors(rng, M, d), tensors(rng, M, e), 2 * tensors(rng, T, M)
    q = tensors(rng, 3, 4)
    k = tensors(rng, 5, 4)
    v = tensors(rng, 5, 2)
    bias = tensors(rng, 3, 5)
    bias[:, 1] = -math.inf
    yield q, k, v, bias
    yield 30 * q, 30 * k, v, tensors(rng, 3, 5)


def fused(q, k, v, bias) -> torch.Tensor:
    """PyTorch's own attention."""
    whole = F.scaled_dot_product_attention(q[None], k[None], v[None], attn_mask=bias[None])
    return whole[0]


@check
def attention_with_bias(mine):
    """mine(q, k, v, bias) against attention of PyTorch."""
    compare(
        mine, fused, _queries, "the output of attention", MISTAKES["attention_with_bias"], atol=1e-6
    )
    return "A bias of minus infinity is a mask; every mask in a transformer is a bias."


def _channels(rng: np.random.Generator):
    """12 channels in 3 heads; others."""
    yield torch.arange(2 * 5 * 12.0).reshape(2, 5, 12), 3
    yield tensors(rng, 3, 4, 10), 5


def owned(x, heads: int) -> torch.Tensor:
    """Head by head."""
    d = x.shape[2] // heads
    return torch.stack([x[:, :, h * d : h * d + d] for h in range(heads)], 1)


@check
def split_into_heads(mine):
    """mine(x, heads): (B, T, width) to (B, heads, T, width / heads), each channel in its place."""
    compare(mine, owned, _channels, "the heads", MISTAKES["split_into_heads"])
    return "Heads cost nothing: they are the same numbers, read as several short vectors."


def _times(rng: np.random.Generator):
    """Few frames by hand; then any."""
    yield tensors(rng, 32, 3), torch.tensor([0, 8]), torch.tensor([0, -8, 16, 1, 7])
    query, key = (torch.from_numpy(rng.integers(-60, 60, size=n)) for n in (5, 4))
    yield tensors(rng, 32, 2), query, key


def bucket(distance: int) -> int:
    """T5's bucket of one distance: exact up to 7, then by the logarithm up to 128."""
    far = abs(distance)
    if far >= 8:
        far = min(15, 8 + int(math.log(far / 8) / math.log(128 / 8) * 8))
    return far + (16 if distance > 0 else 0)


def looked_up(table, query, key) -> torch.Tensor:
    """Pair by pair, with T5's rule written for one number."""
    rows = [[table[bucket(k - q)] for k in key.tolist()] for q in query.tolist()]
    return torch.stack([torch.stack(row, 1) for row in rows], 1)


@check
def relative_bias(mine):
    """mine(table, query, key) against T5's buckets, pair by pair."""
    compare(mine, looked_up, _times, "the relative bias", MISTAKES["relative_bias"])
    return "The table knows only distances, so it also serves a window that begins elsewhere."
