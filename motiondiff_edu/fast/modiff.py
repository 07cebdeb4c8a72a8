"""MoDiff for use: the context is encoded once a frame; keys, values and step embeddings are kept over the loop.

The same numbers as the plain network in the core, to 1e-5 (tested). The plain one runs encoder and decoder at each of
the S steps although past and control do not change meanwhile.  Source: MoDiff III-F, Fig. 2.  Notebook: 07
"""

import copy
from dataclasses import dataclass

import torch
from jaxtyping import Float, Int
from torch import Tensor
from torch.nn import functional as F

from ..cross_modal_attention import Block, CrossModalAttention
from ..modiff import MoDiff, step_embedding


@dataclass(frozen=True, eq=False)
class Context:
    """What the decoder needs of past and control: keys and values, one pair for each decoder layer."""

    keys: tuple[Float[Tensor, "B H M d"], ...]
    values: tuple[Float[Tensor, "B H M d"], ...]


class _Layer:
    """The weights of one decoder block, laid out for few calls: q, k and v of the self-attention in one product."""

    def __init__(self, block: Block):
        self.block = block
        own: CrossModalAttention = block.self_attention
        self.qkv_weight = torch.cat([own.q.weight, own.kv.weight]).contiguous()
        self.qkv_bias = torch.cat([own.q.bias, own.kv.bias])
        self.heads = own.heads

    def __call__(self, x, self_bias, keys, values, memory_bias):
        block, batch, frames, width = self.block, *x.shape
        head = width // self.heads
        normed = block.norm_self(x)
        qkv = F.linear(normed, self.qkv_weight, self.qkv_bias).view(batch, frames, 3, self.heads, head)
        q, k, v = qkv.permute(2, 0, 3, 1, 4).unbind(0)
        mixed = F.scaled_dot_product_attention(q, k, v, attn_mask=self_bias)
        x = x + block.self_attention.out(mixed.transpose(1, 2).reshape(batch, frames, width))
        q = block.cross_attention.q(block.norm_cross(x)).view(batch, frames, self.heads, head).transpose(1, 2)
        mixed = F.scaled_dot_product_attention(q, keys, values, attn_mask=memory_bias)
        x = x + block.cross_attention.out(mixed.transpose(1, 2).reshape(batch, frames, width))
        return x + block.ff(block.norm_ff(x))


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
        self.x_weight = weight[:, :D].contiguous()  # the noised poses' half of the input layer
        steps = model.step_in(step_embedding(torch.arange(model.config.S + 1, device=weight.device), width))
        step_part = F.linear(steps, weight[:, D:], model.future_in.bias)  # the step's half, for every s
        self.start = step_part[:, None] + model.time[model.config.T_h :]  # and when each frame is
        self.layers = [_Layer(block) for block in model.decoder]
        self.self_bias, self.memory_bias = model.self_bias().contiguous(), model.memory_bias().contiguous()
        self.skip = model.skip

    @torch.inference_mode()
    def encode(self, past: Float[Tensor, "B T_h D"], control: Float[Tensor, "B T C"]) -> Context:
        """Run the encoders once, and make every decoder layer's keys and values."""
        return self.context_of(self.model.encode(past, control))

    def context_of(self, memory: Float[Tensor, "B M width"]) -> Context:
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
        out = self.model.head(self.attend(self.embed(x_s, s), context))
        return out if self.skip is None else out + self.skip[s].view(-1, 1, 1) * x_s

    def embed(self, x_s: Float[Tensor, "B T_p D"], s: Int[Tensor, "B"] | int) -> Float[Tensor, "B T_p width"]:
        return F.linear(x_s, self.x_weight).add_(self.start[s])

    def attend(self, x: Float[Tensor, "B T_p width"], context: Context) -> Float[Tensor, "B T_p width"]:
        for layer, keys, values in zip(self.layers, context.keys, context.values, strict=True):
            x = layer(x, self.self_bias, keys, values, self.memory_bias)
        return x
