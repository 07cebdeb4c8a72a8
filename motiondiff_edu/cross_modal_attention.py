"""Cross-modal attention: queries from motion, keys and values from the condition.

`watch` collects the attention maps.

weights = softmax(Q K^T / sqrt(d) + bias),   out = weights V
Source: MoFusion eq. 8-9; MoDiff IV-A (T5-style relative positions).  Notebook: 06
"""

import math
from collections.abc import Iterator
from contextlib import contextmanager
from typing import NamedTuple

import torch
from jaxtyping import Float, Int
from torch import Tensor, nn
from torch.nn import functional as F


def attention_weights(
    q: Float[Tensor, "B H T d"],
    k: Float[Tensor, "B H M d"],
    bias: Float[Tensor, "#B #H T M"] | None = None,
) -> Float[Tensor, "B H T M"]:
    """softmax(Q K^T / sqrt(d) + bias): each query's row is a distribution over the M keys.

    Source: MoFusion eq. 9.  Notebook: 06
    """
    scores = q @ k.transpose(-1, -2) / math.sqrt(q.shape[-1])
    return torch.softmax(scores if bias is None else scores + bias, dim=-1)


def attention(
    q: Float[Tensor, "B H T d"],
    k: Float[Tensor, "B H M d"],
    v: Float[Tensor, "B H M e"],
    bias: Float[Tensor, "#B #H T M"] | None = None,
) -> Float[Tensor, "B H T e"]:
    """weights V: every query's weighted mean of the values.

    Source: MoFusion eq. 8-9.   Notebook: 06
    """
    return attention_weights(q, k, bias) @ v


def relative_position_bucket(
    distance: Int[Tensor, "*N"], buckets: int = 32, farthest: int = 128, bidirectional: bool = True
) -> Int[Tensor, "*N"]:
    """T5's bucket of a distance (key time minus query time): exact when near, logarithmic when far.

    Each direction has half of the buckets, and half of these are exact. All distances beyond
    `farthest` share the last bucket.
    Source: MoDiff IV-A names T5.  Notebook: 06
    """
    if bidirectional:
        buckets //= 2
        offset = (distance > 0).long() * buckets
        distance = distance.abs()
    else:
        offset, distance = torch.zeros_like(distance), (-distance).clamp_min(0)
    exact = buckets // 2
    far = (
        torch.log(distance.clamp_min(1).float() / exact)
        / math.log(farthest / exact)
        * (buckets - exact)
    )
    far = (exact + far.long()).clamp_max(buckets - 1)
    return offset + torch.where(distance < exact, distance, far)


class RelativeBias(nn.Module):
    """A learned bias of the scores for each head and bucket of time distance; all layers share it.

    The times of queries and keys are in frames. They can belong to different modalities.
    """

    buckets: Int[Tensor, "T M"]

    def __init__(self, heads: int, query_times: Int[Tensor, "T"], key_times: Int[Tensor, "M"]):
        super().__init__()
        self.table = nn.Parameter(torch.zeros(32, heads))
        buckets = relative_position_bucket(key_times[None, :] - query_times[:, None])
        self.register_buffer("buckets", buckets, persistent=False)

    def forward(self) -> Float[Tensor, "1 H T M"]:
        return F.embedding(self.buckets, self.table).permute(2, 0, 1)[None]


def angles_of(
    times: Float[Tensor, "T"], width: int, slowest: float, fastest: float
) -> Float[Tensor, "T w"]:
    """2 pi f t for width/2 frequencies f between `slowest` and `fastest` Hz, evenly on a log scale.

    Times are in seconds. After queries and keys are rotated by these angles (see `rotary`), their
    product depends on the time between them, and on no other time.
    Source: rotary positions (Su and others, 2021), in seconds; MoFusion leaves positions open.
    Notebook: 12
    """
    f = slowest * (fastest / slowest) ** torch.linspace(0, 1, width // 2, device=times.device)
    return 2 * math.pi * times[:, None] * f


def rotary(x: Float[Tensor, "*B T d"], angles: Float[Tensor, "T w"]) -> Float[Tensor, "*B T d"]:
    """Rotate each pair (x[i], x[i + d/2]) by its angle.

    Then q_t . k_u depends on the time between t and u.

    Source: rotary positions (Su and others, 2021).  Notebook: 12
    """
    a, b = x.chunk(2, dim=-1)
    cos, sin = angles.cos(), angles.sin()
    return torch.cat([a * cos - b * sin, a * sin + b * cos], dim=-1)


class KeysValues(NamedTuple):
    """The keys and values of one layer of attention."""

    keys: Float[Tensor, "B H M d"]
    values: Float[Tensor, "B H M d"]


class CrossModalAttention(nn.Module):
    """Multi-head attention: queries from `x`, keys and values from `context`.

    With context = x it is self-attention. Usually the maps are never computed (fused kernel);
    inside `watch(model)` they are computed and kept.
    Source: MoFusion eq. 8-9.  Notebook: 06
    """

    def __init__(self, width: int, heads: int, context_width: int | None = None):
        super().__init__()
        if width % heads:
            raise ValueError(f"width {width} must be a multiple of {heads} heads")
        self.heads = heads
        self.q = nn.Linear(width, width)
        self.kv = nn.Linear(context_width or width, 2 * width)
        self.out = nn.Linear(width, width)
        self.watcher: list[Tensor] | None = None  # a list inside `watch`

    def split(self, x: Float[Tensor, "B T W"]) -> Float[Tensor, "B H T d"]:
        """Split the channels into heads: head h has channels h*d ... (h+1)*d - 1."""
        return x.unflatten(-1, (self.heads, -1)).transpose(1, 2)

    def forward(
        self,
        x: Float[Tensor, "B T W"],
        context: Float[Tensor, "B M C"],
        bias: Float[Tensor, "#B #H T M"] | None = None,
        angles: tuple[Float[Tensor, "T w"], Float[Tensor, "M w"]] | None = None,
    ) -> Float[Tensor, "B T W"]:
        """`bias` is added to the scores.

        `angles`: of `rotary`, for queries and keys; None: no rotation.
        """
        of_queries, of_keys = angles if angles is not None else (None, None)
        return self.read(x, self.keys_and_values(context, of_keys), bias, of_queries)

    def keys_and_values(
        self, context: Float[Tensor, "B M C"], angles: Float[Tensor, "M w"] | None = None
    ) -> KeysValues:
        """What this layer keeps of a context. It does not depend on the queries."""
        k, v = (self.split(part) for part in self.kv(context).chunk(2, dim=-1))
        return KeysValues(k if angles is None else rotary(k, angles), v)

    def read(
        self,
        x: Float[Tensor, "B T W"],
        memory: KeysValues,
        bias: Float[Tensor, "#B #H T M"] | None = None,
        angles: Float[Tensor, "T w"] | None = None,
    ) -> Float[Tensor, "B T W"]:
        """Queries from x read keys and values that were computed before."""
        q = self.split(self.q(x))
        if angles is not None:
            q = rotary(q, angles)
        if self.watcher is None:
            out = F.scaled_dot_product_attention(q, memory.keys, memory.values, attn_mask=bias)
        else:
            weights = attention_weights(q, memory.keys, bias)
            self.watcher.append(weights.detach())
            out = weights @ memory.values
        return self.out(out.transpose(1, 2).flatten(-2))


class Block(nn.Module):
    """A pre-norm transformer block: self-attention, then cross-attention (with_context), then
    feed-forward with GELU.

    MoDiff uses "the standard Transformer encoder in PyTorch", which by default normalises last and
    has ReLU.
    Source: MoDiff III-F, IV-A; MoFusion 3.3.  Notebook: 06
    """

    def __init__(
        self, width: int, heads: int, hidden: int, with_context: bool = False, dropout: float = 0.0
    ):
        super().__init__()
        self.norm_self, self.self_attention = nn.LayerNorm(width), CrossModalAttention(width, heads)
        self.with_context = with_context
        if with_context:
            self.norm_cross = nn.LayerNorm(width)
            self.cross_attention = CrossModalAttention(width, heads)
        self.norm_ff = nn.LayerNorm(width)
        self.ff = nn.Sequential(nn.Linear(width, hidden), nn.GELU(), nn.Linear(hidden, width))
        self.drop = nn.Dropout(dropout)

    def forward(
        self,
        x: Float[Tensor, "B T W"],
        bias: Float[Tensor, "1 H T T"] | None = None,
        context: KeysValues | None = None,
        context_bias: Float[Tensor, "1 H T M"] | None = None,
    ) -> Float[Tensor, "B T W"]:
        """`context`: what `cross_attention.keys_and_values` made of it.

        Raises ValueError where a block with context gets none.
        """
        normed = self.norm_self(x)
        x = x + self.drop(self.self_attention(normed, normed, bias))
        if self.with_context:
            if context is None:
                raise ValueError("this block reads a context: pass its keys and values")
            x = x + self.drop(self.cross_attention.read(self.norm_cross(x), context, context_bias))
        return x + self.drop(self.ff(self.norm_ff(x)))


@contextmanager
def watch(model: nn.Module) -> Iterator[dict[str, list[Float[Tensor, "B H T M"]]]]:
    """Collect the attention maps of every layer inside the `with` block.

    It yields {layer name: [one map per call]}. Outside the block no map is computed or kept.
    Notebook: 06
    """
    layers = {name: m for name, m in model.named_modules() if isinstance(m, CrossModalAttention)}
    maps: dict[str, list[Tensor]] = {name: [] for name in layers}
    before = {name: layer.watcher for name, layer in layers.items()}
    try:
        for name, layer in layers.items():
            layer.watcher = maps[name]
        yield maps
    finally:
        for name, layer in layers.items():
            layer.watcher = before[name]
