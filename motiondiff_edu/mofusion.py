"""MoFusion's network: a 1D U-Net over motion frames; every block ends with attention to the music.

    x_s -> [res, att] --------------------------------------------------> [res, att] -> eps_hat
             halve -> [res, att] ----------------------------> [res, att] -> double
                        halve -> [res, att] ------> [res, att] -> double
                                   halve -> [res, att] -> double

res: two convolutions over time, scaled and shifted by the step s (`ResBlock`).
att: cross-modal attention with keys and values from the music (`CrossAttentionBlock`).
Source: MoFusion 3.1-3.3, Fig. 3.  Notebook: 12
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import torch
from jaxtyping import Bool, Float, Int
from torch import Tensor, nn
from torch.nn import functional as F

from .cross_modal_attention import CrossModalAttention, KeysValues, angles_of
from .modiff import step_embedding
from .prediction import TARGETS


@dataclass(frozen=True)
class MoFusionConfig:
    """Sizes of the network.

    The paper gives three levels and 80 Mel bands; widths, heads and the rest are ours.

    `C` = 0 leaves the music out: keys and values come from the motion itself.  Source: MoFusion 3.3
    """

    D: int = 63  # motion features
    C: int = 80  # condition features (Mel bands)
    S: int = 1000  # diffusion steps
    widths: tuple[int, ...] = (
        96,
        96,
        128,
    )  # of the levels, which have all frames, every second, every fourth (then eighth)
    heads: int = 4
    # convolutions over the music before attention; 0: only a linear layer, as in the paper
    music_layers: int = 4
    fps: float = 20.0  # of the motion
    slowest: float = 0.05  # lowest and highest frequency of the position code, Hz
    fastest: float = 8.0
    target: str = "eps"
    skip: bool = True

    def __post_init__(self):
        """Raise ValueError for an unknown target, or for impossible sizes."""
        least = {"D": 1, "S": 1, "heads": 1, "C": 0, "music_layers": 0}
        for name, at_least in least.items():
            if getattr(self, name) < at_least:
                raise ValueError(f"{name} = {getattr(self, name)} must be at least {at_least}")
        for name in ("fps", "slowest", "fastest"):
            if not getattr(self, name) > 0:
                raise ValueError(f"{name} = {getattr(self, name):g} must be above 0")
        if not self.widths:
            raise ValueError("widths = (): a U-Net needs one level at least")
        bad = next((w for w in self.widths if w < 2 * self.heads or w % (2 * self.heads)), None)
        if bad is not None:
            raise ValueError(f"each width must be a multiple of 2 x {self.heads} heads, not {bad}")
        if self.target not in TARGETS:
            raise ValueError(f"target must be one of {', '.join(TARGETS)}, not {self.target!r}")

    @property
    def context_width(self) -> int:
        """Of the music's tokens: that of the second level, where there are two."""
        return self.widths[:2][-1]


MOFUSION_FULL = MoFusionConfig(widths=(256, 512, 1024), heads=8)
MOFUSION_SMALL = MoFusionConfig()


class FrameConv(nn.Module):
    """A convolution over time: one linear layer of a frame and its two neighbours.

    Frames outside the motion are zeros. With stride 2 it keeps every second frame, starting with
    the first. The kernel is stored as one matrix (outputs, 3 x inputs): the frame before, the
    frame, the frame after.  Notebook: 12
    """

    def __init__(self, inputs: int, outputs: int, stride: int = 1, dilation: int = 1):
        super().__init__()
        self.mix = nn.Linear(3 * inputs, outputs)
        self.stride = stride
        self.dilation = dilation

    def forward(self, x: Float[Tensor, "B T W"]) -> Float[Tensor, "B T2 W2"]:
        kernel = self.mix.weight.unflatten(1, (3, -1)).mT  # (outputs, inputs, 3)
        n = self.dilation
        return F.conv1d(x.mT, kernel, self.mix.bias, self.stride, padding=n, dilation=n).mT


class ResBlock(nn.Module):
    """Two convolutions with a residual connection; the step scales and shifts between them.

    Each frame is normalised by itself, so that padding and other samples have no influence.
    Source: MoFusion 3.3; scale and shift are usual, but the paper does not mention them.
    Notebook: 12
    """

    def __init__(self, inputs: int, outputs: int, width: int):
        super().__init__()
        self.norm_in, self.conv_in = nn.LayerNorm(inputs), FrameConv(inputs, outputs)
        self.norm_out, self.conv_out = nn.LayerNorm(outputs), FrameConv(outputs, outputs)
        self.step = nn.Linear(width, 2 * outputs)
        self.around = nn.Linear(inputs, outputs) if inputs != outputs else nn.Identity()
        for layer in (self.step, self.conv_out.mix):  # at the start the block changes nothing
            nn.init.zeros_(layer.weight)
            nn.init.zeros_(layer.bias)

    def forward(
        self, x: Float[Tensor, "B T W"], step: Float[Tensor, "B E"], mask: Float[Tensor, "#B T 1"]
    ) -> Float[Tensor, "B T W2"]:
        h = self.conv_in(F.silu(self.norm_in(x)) * mask)
        scale, shift = self.step(step)[:, None].chunk(2, dim=-1)
        h = self.conv_out(F.silu(self.norm_out(h) * (1 + scale) + shift) * mask)
        return self.around(x) + h


class CrossAttentionBlock(nn.Module):
    """Cross-modal attention, then a feed-forward layer.

    Queries come from the motion, keys and values from the music. Without music (context=None) keys
    and values come from the motion, which is self-attention.
    Source: MoFusion 3.3, eq. 8-9 (for the unconditional case the paper writes Q from x, but means K
    and V).
    """

    def __init__(self, width: int, heads: int, context_width: int):
        super().__init__()
        self.norm = nn.LayerNorm(width)
        self.attention = CrossModalAttention(width, heads, context_width)
        self.norm_ff = nn.LayerNorm(width)
        self.ff = nn.Sequential(nn.Linear(width, 2 * width), nn.GELU(), nn.Linear(2 * width, width))

    def forward(self, x: Float[Tensor, "B T W"], context, bias, angles) -> Float[Tensor, "B T W"]:
        normed = self.norm(x)
        x = x + self.attention(normed, normed if context is None else context, bias, angles)
        return x + self.ff(self.norm_ff(x))

    def read(
        self, x: Float[Tensor, "B T W"], heard: KeysValues, bias, angles: Float[Tensor, "T w"]
    ) -> Float[Tensor, "B T W"]:
        """The same for keys and values that were computed before; `angles` of the queries."""
        x = x + self.attention.read(self.norm(x), heard, bias, angles)
        return x + self.ff(self.norm_ff(x))


class MusicEncoder(nn.Module):
    """Mel frames to context: a linear layer, then (ours) convolutions.

    First every second frame is kept, 15.6 per second; then each convolution sees twice as far as
    the one before, up to a second or so to either side.
    Source: MoFusion 3.3 (the linear layer).
    """

    def __init__(self, bands: int, width: int, layers: int):
        super().__init__()
        self.project = nn.Linear(bands, width)
        self.shorten = FrameConv(width, width, stride=2) if layers else None
        self.convs = nn.ModuleList(FrameConv(width, width, dilation=2**k) for k in range(layers))
        self.norms = nn.ModuleList(nn.LayerNorm(width) for _ in range(layers))
        self.norm = nn.LayerNorm(width)

    def forward(
        self, mel: Float[Tensor, "B M C"], mask: Float[Tensor, "#B M 1"]
    ) -> Float[Tensor, "B M2 W"]:
        h = self.project(mel)
        if self.shorten is not None:
            h, mask = self.shorten(F.silu(h) * mask), mask[:, ::2]
        for norm, conv in zip(self.norms, self.convs, strict=True):
            h = h + F.silu(conv(norm(h) * mask))
        return self.norm(h)


class MoFusion(nn.Module):
    """eps_hat = net(x_s, s, music) + w(s) x_s, for motions of any length.

    Frame t of the motion is at t / fps seconds; the music's frames have their own times (`listen`).
    Queries and keys are rotated by these times in the same way (`rotary`).
    Source: MoFusion 3.3, Fig. 3; the skip w(s) and the position code are ours.  Notebook: 12
    """

    def __init__(self, config: MoFusionConfig = MOFUSION_SMALL):
        super().__init__()
        self.config = config
        widths = config.widths
        first = config.widths[0]
        width = 4 * first  # of the step's embedding
        self.step_in = nn.Sequential(
            nn.Linear(width, width), nn.SiLU(), nn.Linear(width, width), nn.SiLU()
        )
        context = config.context_width
        self.music = MusicEncoder(config.C, context, config.music_layers) if config.C else None
        self.into = FrameConv(config.D, first)

        def block(inputs, outputs):
            ask = CrossAttentionBlock(outputs, config.heads, context if config.C else outputs)
            return nn.ModuleDict({"res": ResBlock(inputs, outputs, width), "ask": ask})

        self.down = nn.ModuleList(block(a, b) for a, b in pairwise((first, *widths)))
        self.shorten = nn.ModuleList(FrameConv(w, w, stride=2) for w in widths)
        self.middle = block(widths[-1], widths[-1])
        self.lengthen = nn.ModuleList(
            FrameConv(a, b) for a, b in pairwise((widths[-1], *reversed(widths)))
        )
        self.up = nn.ModuleList(block(2 * w, w) for w in reversed(widths))
        self.out = nn.Linear(first, config.D)
        self.skip = nn.Parameter(torch.ones(config.S + 1)) if config.skip else None

    def listen(
        self,
        mel: Float[Tensor, "B M C"],
        times: Float[Tensor, "M"],
        mask: Bool[Tensor, "B M"] | None = None,
    ) -> "Music":
        """The context of a piece of music.

        mel    a standardised log-Mel spectrogram
        times  of its frames, in seconds from the first motion frame
        mask   True where there is music, for pieces of several lengths in one batch
        Raises ValueError if the network takes no music.
        """
        present = (
            mel.new_ones(1, mel.shape[1], 1) if mask is None else mask[..., None].to(mel.dtype)
        )
        if self.music is None:
            raise ValueError("this network takes no music; pass music=None")
        tokens, step = self.music(mel, present), 2 if self.config.music_layers else 1
        return Music(tokens, times[::step], None if mask is None else mask[:, ::step])

    def forward(
        self,
        x_s: Float[Tensor, "B T D"],
        s: Int[Tensor, "B"],
        music: "Music | None" = None,
        lengths: Int[Tensor, "B"] | None = None,
    ) -> Float[Tensor, "B T D"]:
        """The network's prediction of its target (eps, x0 or v).

        Frames from `lengths` on are padding, and their output is 0.
        Raises ValueError for music that is missing or not wanted, and for lengths outside 1..T.
        """
        return self.decode(x_s, s, self.encode(music, x_s.shape[1], lengths))

    def encode(
        self, music: "Music | None", frames: int, lengths: Int[Tensor, "B"] | None = None
    ) -> "Memory":
        """What all diffusion steps have in common: a song is encoded once, and decoded S times.

        Raises ValueError as `forward`.
        """
        if (music is None) != (self.music is None):
            raise ValueError(
                "this network dances to music; pass its music"
                if music is None
                else "this network takes no music; pass music=None"
            )
        if lengths is None:
            lengths = torch.full((1,), frames, device=self.into.mix.weight.device)
        elif not 1 <= lengths.min() <= lengths.max() <= frames:
            raise ValueError(
                f"lengths must be from 1 to the {frames} frames of x_s: {lengths.tolist()}"
            )
        depth = len(self.config.widths)
        padded = frames + -frames % 2**depth
        levels = [Level.of(padded, lengths, k, music, self.config) for k in range(depth + 1)]
        heard = {}
        if music is not None:
            for block, k in self._blocks():
                heard |= self._hear(block, music, levels[k])
        return Memory(frames, levels, heard)

    def decode(
        self, x_s: Float[Tensor, "B T D"], s: Int[Tensor, "B"], memory: "Memory"
    ) -> Float[Tensor, "B T D"]:
        """The U-Net's output for the noised motion of step s: down, the middle, and up again.

        Raises ValueError for a motion of another length than the memory was made for.
        """
        levels, T = memory.levels, x_s.shape[1]
        if T != memory.frames:
            raise ValueError(
                f"this memory is for motions of {memory.frames} frames, not of {T}: encode again"
            )
        x = F.pad(x_s, (0, 0, 0, len(levels[0].times) - T))
        step = self.step_in(step_embedding(s, 4 * self.config.widths[0]))
        h, kept = self.into(x * levels[0].mask), []
        for level, block, shorten in zip(levels, self.down, self.shorten, strict=False):
            h = self._block(block, h, step, level, memory)
            kept.append(h)
            h = shorten(h * level.mask)
        h = self._block(self.middle, h, step, levels[-1], memory)
        for level, block, lengthen in zip(levels[-2::-1], self.up, self.lengthen, strict=True):
            h = lengthen(h.repeat_interleave(2, dim=1) * level.mask)
            h = self._block(block, torch.cat([h, kept.pop()], dim=-1), step, level, memory)
        out = self.out(h) if self.skip is None else self.out(h) + self.skip[s][:, None, None] * x
        return (out * levels[0].mask)[:, :T]

    def _blocks(self) -> Iterator[tuple[nn.ModuleDict, int]]:
        """Each block with the number of its level, in the order in which they are run."""
        depth = len(self.down)
        yield from zip(self.down, range(depth), strict=True)
        yield self.middle, depth
        yield from zip(self.up, reversed(range(depth)), strict=True)

    def _hear(self, block, music: "Music", level: "Level") -> "dict[nn.Module, KeysValues]":
        """The keys and values of the music for each layer of a block that attends to it."""
        ask = block["ask"]
        return {ask: ask.attention.keys_and_values(music.tokens, level.angles_of(ask)[1])}

    def _block(self, block, h, step, level: "Level", memory: "Memory"):
        h = block["res"](h, step, level.mask)
        return memory.read(block["ask"], h, level)


@dataclass(frozen=True, eq=False)
class Music:
    """The context that a network computed from music: tokens, their times (s), and their mask."""

    tokens: Float[Tensor, "B M W"]
    times: Float[Tensor, "M"]
    mask: Bool[Tensor, "B M"] | None = None


@dataclass(frozen=True, eq=False)
class Memory:
    """What the U-Net needs at every diffusion step, and what does not depend on it.

    frames  of the motion
    levels  masks, times and angles; every frame, every second, every fourth ...
    heard   keys and values of the music for each layer that attends to it; {} without music
    """

    frames: int
    levels: "list[Level]"
    heard: dict[nn.Module, KeysValues]

    def read(
        self, ask: CrossAttentionBlock, h: Float[Tensor, "B T W"], level: "Level"
    ) -> Float[Tensor, "B T W"]:
        """Attention to the music; without music, to the motion itself."""
        angles = level.angles_of(ask)
        if not self.heard:
            return ask(h, None, level.bias, angles)
        return ask.read(h, self.heard[ask], level.bias, angles[0])


@dataclass(frozen=True, eq=False)
class Level:
    """One level of the U-Net: the mask of its frames, the attention bias, and rotation angles."""

    mask: Float[Tensor, "#B T 1"]
    times: Float[Tensor, "T"]  # seconds
    bias: Float[Tensor, "#B 1 T M"] | None
    angles: dict[int, tuple[Tensor, Tensor]]  # by the width of the features

    @classmethod
    def of(
        cls,
        T: int,
        lengths: Int[Tensor, "B"],
        level: int,
        music: Music | None,
        config: MoFusionConfig,
    ) -> "Level":
        """The frames of a level are every 2^level-th of the T frames at the top."""
        frames = torch.arange(0, T, 2**level, device=lengths.device)
        inside, times = frames < lengths[:, None], frames / config.fps  # (B, T), and seconds
        token_times, seen = (times, inside) if music is None else (music.times, music.mask)
        allowed = None if seen is None or bool(seen.all()) else seen[:, None, None]
        bias = (
            None
            if allowed is None
            else torch.where(allowed, 0.0, -1e4).expand(-1, -1, len(times), -1)
        )
        code = (config.slowest, config.fastest)
        angles = {
            w: (
                angles_of(times, w // config.heads, *code),
                angles_of(token_times, w // config.heads, *code),
            )
            for w in set(config.widths)
        }
        return cls(inside[..., None].float(), times, bias, angles)

    def angles_of(self, block: CrossAttentionBlock) -> tuple[Tensor, Tensor]:
        """The angles of queries and keys for a block of this level."""
        return self.angles[block.attention.q.in_features]
