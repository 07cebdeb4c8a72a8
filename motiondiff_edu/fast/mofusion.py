"""A fast MoFusion: the music is encoded once per song.

Keys, values and the modulations of each diffusion step are kept over the sampling loop. The output
equals that of the plain network up to rounding (tested).  Notebook: 12
"""

import copy
from dataclasses import dataclass

import torch
from jaxtyping import Float, Int
from torch import Tensor
from torch.nn import functional as F

from ..cross_modal_attention import rotary
from ..modiff import step_embedding
from ..mofusion import CrossAttentionBlock, FrameConv, MoFusion, Music, ResBlock, View


@dataclass(frozen=True, eq=False)
class SongContext:
    """A song, prepared for motions of one length: keys and values of each block, and the views."""

    frames: int
    views: list[View]
    keys: tuple[Float[Tensor, "B H M _"], ...]
    values: tuple[Float[Tensor, "B H M _"], ...]


class FastMoFusion:
    """A fast copy of a trained MoFusion.

    `listen` encodes the music once; `denoise` then runs at every step of the sampler.

    As in FastMoDiff, the copy keeps the weights that it was built with. Without music (C = 0) there
    is nothing to keep, so use the plain network.
    """

    @torch.inference_mode()
    def __init__(self, model: MoFusion):
        if model.music is None:
            raise ValueError(
                "a network without music has no keys and values to keep: use the plain network"
            )
        model = copy.deepcopy(model).eval()
        self.model = model
        self.config = model.config
        self.levels = len(self.config.widths)
        self.blocks = [*model.down, model.middle, *model.up]
        self.level_of = [*range(self.levels), self.levels, *range(self.levels - 1, -1, -1)]
        device = model.into.mix.weight.device
        steps = model.step_in(
            step_embedding(
                torch.arange(self.config.S + 1, device=device), 4 * self.config.widths[0]
            )
        )
        # (scale, shift) of each block, for every s
        self.modulations = [block["res"].step(steps).chunk(2, dim=-1) for block in self.blocks]

    @torch.inference_mode()
    def listen(
        self, mel: Float[Tensor, "B M C"], times: Float[Tensor, "M"], frames: int
    ) -> SongContext:
        """The keys and values of a song, rotated by their times, for a dance of `frames` frames."""
        return self.context(self.model.listen(mel, times), frames)

    @torch.inference_mode()
    def context(self, music: Music, frames: int) -> SongContext:
        """The same of music that the network has listened to already (`MoFusion.listen`)."""
        padded = frames + -frames % 2**self.levels
        lengths = torch.full((1,), frames, device=music.tokens.device)
        views = [
            View.of(padded, lengths, level, music, self.config) for level in range(self.levels + 1)
        ]
        keys, values = [], []
        for block, level in zip(self.blocks, self.level_of, strict=True):
            attention = block["ask"].attention
            k, v = (attention.split(part) for part in attention.kv(music.tokens).chunk(2, dim=-1))
            keys.append(rotary(k, views[level].angles[attention.q.out_features][1]).contiguous())
            values.append(v.contiguous())
        return SongContext(frames, views, tuple(keys), tuple(values))

    @torch.inference_mode()
    def denoise(
        self, x_s: Float[Tensor, "B T D"], s: Int[Tensor, "B"] | int, song: SongContext
    ) -> Float[Tensor, "B T D"]:
        """The network's output (eps, x0 or v, its target) at step s.

        `s` is one step for the whole batch, or one for each sample.
        """
        model = self.model
        levels = self.levels
        views = song.views
        x = F.pad(x_s, (0, 0, 0, -song.frames % 2**levels))
        h, kept = _conv(model.into, x), []
        for level in range(levels):
            h = self._block(level, h, s, song)
            kept.append(h)
            h = _conv(model.shorten[level], h * views[level].mask)
        h = self._block(levels, h, s, song)
        for up, level in enumerate(range(levels - 1, -1, -1)):
            h = _conv(model.lengthen[up], h.repeat_interleave(2, dim=1) * views[level].mask)
            h = self._block(levels + 1 + up, torch.cat([h, kept[level]], dim=-1), s, song)
        out = model.out(h[:, : song.frames])
        return out if model.skip is None else out + model.skip[s].view(-1, 1, 1) * x_s

    def _block(self, k: int, h: Tensor, s, song: SongContext) -> Tensor:
        view = song.views[self.level_of[k]]
        scale, shift = (part[s].view(-1, 1, part.shape[-1]) for part in self.modulations[k])
        h = _res(self.blocks[k]["res"], h, scale, shift, view.mask)
        return _attend(self.blocks[k]["ask"], h, song.keys[k], song.values[k], view)


def _res(block: ResBlock, x: Tensor, scale: Tensor, shift: Tensor, mask: Tensor) -> Tensor:
    """ResBlock.forward, with the step's scale and shift already computed."""
    h = _conv(block.conv_in, F.silu(block.norm_in(x)).mul_(mask))
    h = torch.addcmul(shift, block.norm_out(h), 1 + scale)
    return _conv(block.conv_out, F.silu(h).mul_(mask)).add_(block.around(x))


def _conv(conv: FrameConv, x: Tensor) -> Tensor:
    """FrameConv.forward as one product of a frame and its neighbours.

    It is a tenth faster for a few short motions, and slower in training.
    """
    n = conv.dilation
    padded = F.pad(x, (0, 0, n, n))
    together = torch.cat([padded[:, : -2 * n], x, padded[:, 2 * n :]], dim=-1)
    return conv.mix(together[:, :: conv.stride])


def _attend(
    block: CrossAttentionBlock, x: Tensor, keys: Tensor, values: Tensor, view: View
) -> Tensor:
    """CrossAttentionBlock.forward, with keys and values already computed."""
    attention = block.attention
    q = rotary(attention.split(attention.q(block.norm(x))), view.angles[x.shape[-1]][0])
    mixed = F.scaled_dot_product_attention(q, keys, values, attn_mask=view.bias)
    x = attention.out(mixed.transpose(1, 2).flatten(-2)).add_(x)
    return block.ff(block.norm_ff(x)).add_(x)
