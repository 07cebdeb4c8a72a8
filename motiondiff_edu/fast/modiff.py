"""A fast MoDiff: the context is encoded once per frame.

Keys, values and step embeddings are kept over the sampling loop. The plain network runs encoder and
decoder at each of the S steps, although past and control do not change between steps. The outputs
agree to 1e-5 (tested).
Source: MoDiff III-F, Fig. 2.   Notebook: 07
"""

import copy
import math
from dataclasses import dataclass

import torch
from jaxtyping import Float, Int
from torch import Tensor, nn
from torch.nn import functional as F

from ..cross_modal_attention import Block
from ..modiff import MoDiff, step_embedding


@dataclass(frozen=True, eq=False)
class Folded:
    """A memory prepared for one decoder layer.

    The keys contain the weights of the queries, the values those of the output:
    q K^T = (x W_q) K^T = x (W_q K^T) and (A V) W_o = A (V W_o). The brackets are the same at all S
    steps. The heads lie side by side, as HM = H*M columns, so one product gives the scores of all
    heads and one their mixed values.
    """

    keys: Float[Tensor, "B W HM"]
    bias: Float[Tensor, "B T HM"]
    values: Float[Tensor, "B HM W"]


@dataclass(frozen=True, eq=False)
class Context:
    """The past and the control, prepared for each layer of the decoder."""

    layers: tuple[Folded, ...]


class _Linear:
    """Several linear layers of one input as one product; their outputs stand side by side.

    The weight is stored transposed, which is faster for the ten rows of a frame
    (`python -m benchmarks frame`).
    """

    def __init__(self, *layers: nn.Linear):
        self.weight = torch.cat([layer.weight for layer in layers]).t().contiguous()
        self.bias = torch.cat([layer.bias for layer in layers])

    def __call__(self, x: Float[Tensor, "N W"]) -> Float[Tensor, "N K"]:
        return torch.addmm(self.bias, x, self.weight)


class _Layer:
    """One decoder block with few calls; x is (B*T, width), all frames of all samples in rows."""

    def __init__(self, block: Block):
        own = block.self_attention
        cross = block.cross_attention
        first, *_, last = block.ff
        self.cross, self.heads = cross, own.heads
        self.norm_self = block.norm_self
        self.norm_cross = block.norm_cross
        self.norm_ff = block.norm_ff
        self.qkv, self.out = _Linear(own.q, own.kv), _Linear(own.out)
        self.first, self.last = _Linear(first), _Linear(last)

    def fold(self, memory: Float[Tensor, "B M W"], bias: Float[Tensor, "1 H T M"]) -> Folded:
        """A memory's keys and values with this layer's weights included; done once per frame."""
        cross = self.cross
        B, M, W = memory.shape
        H = self.heads
        k, v = (
            part.reshape(B * M, H, -1).transpose(0, 1) for part in cross.kv(memory).chunk(2, dim=-1)
        )
        k = k / math.sqrt(W // H)  # (H, B*M, d), as v
        query_weight = cross.q.weight.unflatten(0, (H, -1))  # (H, d, W)
        out_weight = cross.out.weight.unflatten(1, (H, -1)).permute(1, 2, 0)  # (H, d, W)
        keys, values = (
            torch.bmm(part, weight).view(H, B, M, W).transpose(0, 1).reshape(B, H * M, W)
            for part, weight in ((k, query_weight), (v, out_weight))
        )
        # the part of the scores that comes from the queries' bias
        query_bias = torch.bmm(k, cross.q.bias.view(H, -1, 1)).view(H, B, 1, M).transpose(0, 1)
        return Folded(keys.transpose(1, 2), (bias + query_bias).transpose(1, 2).flatten(2), values)

    def __call__(
        self,
        x: Float[Tensor, "N W"],
        frames: int,
        self_bias: Float[Tensor, "1 H T T"],
        memory: Folded,
    ) -> Float[Tensor, "N W"]:
        width, shape = x.shape[1], (-1, frames, self.heads, x.shape[1] // self.heads)
        q, k, v = (
            part.reshape(shape).transpose(1, 2)
            for part in self.qkv(self.norm_self(x)).chunk(3, dim=-1)
        )
        mixed = F.scaled_dot_product_attention(q, k, v, attn_mask=self_bias)  # (B, H, T, d)
        x = self.out(mixed.transpose(1, 2).reshape(-1, width)).add_(x)
        scores = torch.baddbmm(
            memory.bias, self.norm_cross(x).view(-1, frames, width), memory.keys
        )  # (B, T, H*M)
        weights = torch.softmax(scores.unflatten(-1, (self.heads, -1)), dim=-1).view_as(scores)
        x = (
            torch.baddbmm(x.view(-1, frames, width), weights, memory.values)
            .view(-1, width)
            .add_(self.cross.out.bias)
        )
        return self.last(F.gelu(self.first(self.norm_ff(x)))).add_(x)


class FastMoDiff:
    """A fast copy of a trained MoDiff.

    `encode` computes a frame's context once; `denoise` then runs at every step of the sampler.

    `model` can be trained further; this copy keeps the weights that it was built with.
    """

    @torch.inference_mode()
    def __init__(self, model: MoDiff):
        model = copy.deepcopy(model).eval()
        self.model, self.config = model, model.config
        width, D = model.config.width, model.config.D
        weight = model.future_in.weight
        self.x_weight = weight[:, :D].t().contiguous()  # the noised poses' half of the input layer
        steps = model.step_in(
            step_embedding(torch.arange(model.config.S + 1, device=weight.device), width)
        )
        step_part = F.linear(
            steps, weight[:, D:], model.future_in.bias
        )  # the step's half, for every s
        self.start = step_part[:, None] + model.time[model.config.T_h :]  # and when each frame is
        self.layers = [_Layer(block) for block in model.decoder]
        self.self_bias = model.self_bias().contiguous()
        self.memory_bias = model.memory_bias().contiguous()
        norm, first, _, last = model.head
        self.head_norm = norm
        self.head_first = _Linear(first)
        self.head_last = _Linear(last)
        self.skip = model.skip

    @torch.inference_mode()
    def encode(self, past: Float[Tensor, "B T_h D"], control: Float[Tensor, "B T C"]) -> Context:
        """Run the encoders once, and prepare the keys and values of every decoder layer."""
        return self.context_of(self.model.encode(past, control))

    def context_of(self, memory: Float[Tensor, "B M width"]) -> Context:
        """A memory, prepared for every decoder layer."""
        return Context(tuple(layer.fold(memory, self.memory_bias) for layer in self.layers))

    @torch.inference_mode()
    def denoise(
        self, x_s: Float[Tensor, "B T_p D"], s: Int[Tensor, "B"] | int, context: Context
    ) -> Float[Tensor, "B T_p D"]:
        """The network's output (eps, x0 or v, its target) at step s.

        `s` is one step for the whole batch, or one for each sample.
        """
        out = self.head(self.attend(self.embed(x_s, s), context))
        return out if self.skip is None else out + self.skip[s].view(-1, 1, 1) * x_s

    def embed(
        self, x_s: Float[Tensor, "B T_p D"], s: Int[Tensor, "B"] | int
    ) -> Float[Tensor, "B T_p width"]:
        """The decoder's tokens, as MoDiff.embed makes them."""
        return (x_s @ self.x_weight).add_(self.start[s])

    def attend(
        self, x: Float[Tensor, "B T_p width"], context: Context
    ) -> Float[Tensor, "B T_p width"]:
        """The decoder's layers, as MoDiff.attend has them."""
        rows = x.flatten(0, 1)
        for layer, memory in zip(self.layers, context.layers, strict=True):
            rows = layer(rows, x.shape[1], self.self_bias, memory)
        return rows.view_as(x)

    def head(self, x: Float[Tensor, "B T_p width"]) -> Float[Tensor, "B T_p D"]:
        """The decoder's last layers, as MoDiff.head has them."""
        rows = self.head_last(F.gelu(self.head_first(self.head_norm(x.flatten(0, 1)))))
        return rows.view(*x.shape[:2], -1)
