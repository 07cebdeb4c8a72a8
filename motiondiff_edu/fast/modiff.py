"""MoDiff for use: the context is encoded once a frame; keys, values and step embeddings are kept over the loop.

The same numbers as the plain network in the core, to 1e-5 (tested). The plain one runs encoder and decoder at each of
the S steps although past and control do not change meanwhile.  Source: MoDiff III-F, Fig. 2.  Notebook: 07
"""

import copy
from dataclasses import dataclass

import torch
from jaxtyping import Float, Int
from torch import Tensor, nn
from torch.nn import functional as F

from ..cross_modal_attention import Block
from ..modiff import MoDiff, step_embedding


@dataclass(frozen=True, eq=False)
class Context:
    """What the decoder needs of past and control: keys and values, one pair for each decoder layer."""

    keys: tuple[Float[Tensor, "B H M d"], ...]
    values: tuple[Float[Tensor, "B H M d"], ...]


class _Linear:
    """Linear layers of one input as one product: the same numbers as theirs side by side.

    The weight lies transposed, which suits the ten rows of a frame (`python -m benchmarks frame`).
    """

    def __init__(self, *layers: nn.Linear):
        self.weight = torch.cat([layer.weight for layer in layers]).t().contiguous()
        self.bias = torch.cat([layer.bias for layer in layers])

    def __call__(self, x: Float[Tensor, "N C"]) -> Float[Tensor, "N K"]:
        return torch.addmm(self.bias, x, self.weight)


class _Layer:
    """One decoder block, laid out for few calls; x is (B*T, width), all frames of all samples in rows."""

    def __init__(self, block: Block):
        own, cross, (first, *_, last) = block.self_attention, block.cross_attention, block.ff
        self.heads = own.heads
        self.norm_self, self.norm_cross, self.norm_ff = block.norm_self, block.norm_cross, block.norm_ff
        self.qkv, self.out = _Linear(own.q, own.kv), _Linear(own.out)
        self.cross_q, self.cross_out = _Linear(cross.q), _Linear(cross.out)
        self.first, self.last = _Linear(first), _Linear(last)

    def __call__(
        self,
        x: Float[Tensor, "N C"],
        frames: int,
        self_bias: Float[Tensor, "1 H T T"],
        keys: Float[Tensor, "B H M d"],
        values: Float[Tensor, "B H M d"],
        memory_bias: Float[Tensor, "1 H T M"],
    ) -> Float[Tensor, "N C"]:
        width, shape = x.shape[1], (-1, frames, self.heads, x.shape[1] // self.heads)
        q, k, v = (part.reshape(shape).transpose(1, 2) for part in self.qkv(self.norm_self(x)).chunk(3, dim=-1))
        mixed = F.scaled_dot_product_attention(q, k, v, attn_mask=self_bias)  # (B, H, T, d)
        x = self.out(mixed.transpose(1, 2).reshape(-1, width)).add_(x)
        q = self.cross_q(self.norm_cross(x)).view(shape).transpose(1, 2)
        mixed = F.scaled_dot_product_attention(q, keys, values, attn_mask=memory_bias)
        x = self.cross_out(mixed.transpose(1, 2).reshape(-1, width)).add_(x)
        return self.last(F.gelu(self.first(self.norm_ff(x)))).add_(x)


class FastMoDiff:
    """A trained MoDiff, read once: `encode` a frame's context, then `denoise` as often as the sampler asks.

    It works on a copy: `model` may train on, in its own mode, and this twin keeps the weights of the time of building.
    Notebook: 07
    """

    @torch.inference_mode()
    def __init__(self, model: MoDiff):
        model = copy.deepcopy(model).eval()
        self.model, self.config = model, model.config
        width, D = model.config.width, model.config.D
        weight = model.future_in.weight
        self.x_weight = weight[:, :D].t().contiguous()  # the noised poses' half of the input layer
        steps = model.step_in(step_embedding(torch.arange(model.config.S + 1, device=weight.device), width))
        step_part = F.linear(steps, weight[:, D:], model.future_in.bias)  # the step's half, for every s
        self.start = step_part[:, None] + model.time[model.config.T_h :]  # and when each frame is
        self.layers = [_Layer(block) for block in model.decoder]
        self.self_bias, self.memory_bias = model.self_bias().contiguous(), model.memory_bias().contiguous()
        norm, first, _, last = model.head
        self.head_norm, self.head_first, self.head_last = norm, _Linear(first), _Linear(last)
        self.skip = model.skip

    @torch.inference_mode()
    def encode(self, past: Float[Tensor, "B T_h D"], control: Float[Tensor, "B T C"]) -> Context:
        """Run the encoders once, and make every decoder layer's keys and values."""
        return self.context_of(self.model.encode(past, control))

    def context_of(self, memory: Float[Tensor, "B M width"]) -> Context:
        """Every decoder layer's keys and values of a memory."""
        keys, values = [], []
        for block in self.model.decoder:
            cross = block.cross_attention
            k, v = (cross.split(part).contiguous() for part in cross.kv(memory).chunk(2, dim=-1))
            keys.append(k)
            values.append(v)
        return Context(tuple(keys), tuple(values))

    @torch.inference_mode()
    def denoise(
        self, x_s: Float[Tensor, "B T_p D"], s: Int[Tensor, "B"] | int, context: Context
    ) -> Float[Tensor, "B T_p D"]:
        """The network's output at step s, one for the whole batch or one for each: eps, x0 or v, as its target says."""
        out = self.head(self.attend(self.embed(x_s, s), context))
        return out if self.skip is None else out + self.skip[s].view(-1, 1, 1) * x_s

    def embed(self, x_s: Float[Tensor, "B T_p D"], s: Int[Tensor, "B"] | int) -> Float[Tensor, "B T_p width"]:
        """The decoder's tokens, as MoDiff.embed makes them."""
        return (x_s @ self.x_weight).add_(self.start[s])

    def attend(self, x: Float[Tensor, "B T_p width"], context: Context) -> Float[Tensor, "B T_p width"]:
        """The decoder's layers, as MoDiff.attend has them."""
        rows = x.flatten(0, 1)
        for layer, keys, values in zip(self.layers, context.keys, context.values, strict=True):
            rows = layer(rows, x.shape[1], self.self_bias, keys, values, self.memory_bias)
        return rows.view_as(x)

    def head(self, x: Float[Tensor, "B T_p width"]) -> Float[Tensor, "B T_p D"]:
        """The decoder's last layers, as MoDiff.head has them."""
        rows = self.head_last(F.gelu(self.head_first(self.head_norm(x.flatten(0, 1)))))
        return rows.view(*x.shape[:2], -1)
