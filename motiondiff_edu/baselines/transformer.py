"""A plain transformer that dances, without a U-Net: frames attend to frames and to the music.

With the noised motion and the step as input, it is a denoiser of the U-Net's size. With only the
music as input, it is a regression (`regression_loss`).
Source: AI Choreographer's cross-modal transformer (cited by MoFusion 4.1), made small; the sizes
are ours.
"""

from dataclasses import dataclass

import torch
from jaxtyping import Bool, Float, Int
from torch import Tensor, nn

from ..cross_modal_attention import CrossModalAttention, angles_of
from ..modiff import step_embedding
from ..mofusion import CrossAttentionBlock, Music, MusicEncoder
from ..performers.hearing_mofusion import EarSizes, WithEar
from ..performers.networks import DancerNetwork, register
from ..prediction import TARGETS


@dataclass(frozen=True)
class TransformerConfig:
    """Sizes of the network.

    With `deterministic` the network ignores x_s and s; the motion then depends on the music alone.
    """

    D: int = 63
    C: int = 80
    S: int = 1000
    width: int = 160
    heads: int = 4
    layers: int = 7
    music_layers: int = 4
    fps: float = 20.0
    slowest: float = 0.05  # lowest and highest frequency of the position code, Hz
    fastest: float = 8.0
    target: str = "x0"
    deterministic: bool = False

    def __post_init__(self):
        """Raise ValueError for impossible sizes or an unknown target."""
        if min(self.D, self.C, self.S, self.heads, self.layers) < 1 or self.music_layers < 0:
            raise ValueError("D, C, S, heads and layers must be at least 1")
        if min(self.fps, self.slowest, self.fastest) <= 0:
            raise ValueError("fps, slowest and fastest must be above 0")
        if self.width < 1 or self.width % (2 * self.heads):
            raise ValueError(
                f"the width must be a multiple of 2 x {self.heads} heads, not {self.width}"
            )
        if self.target not in TARGETS:
            raise ValueError(f"target must be one of {', '.join(TARGETS)}, not {self.target!r}")


class Layer(nn.Module):
    """Self-attention between frames, attention to the music, and a feed-forward layer."""

    def __init__(self, width: int, heads: int):
        super().__init__()
        self.norm, self.attention = nn.LayerNorm(width), CrossModalAttention(width, heads)
        self.ask = CrossAttentionBlock(width, heads, width)

    def forward(
        self, x: Float[Tensor, "B T W"], music: Music, bias, between, to_music
    ) -> Float[Tensor, "B T W"]:
        normed = self.norm(x)
        x = x + self.attention(normed, normed, None, between)
        return self.ask(x, music.tokens, bias, to_music)


class DanceTransformer(nn.Module):
    """A network with MoFusion's interface: (x_s, s, music) -> the target.

    With `deterministic`, only the length of x_s matters.
    """

    def __init__(self, config: TransformerConfig):
        super().__init__()
        self.config, width = config, config.width
        self.music = MusicEncoder(config.C, width, config.music_layers)
        self.step_in = nn.Sequential(nn.Linear(width, width), nn.SiLU(), nn.Linear(width, width))
        self.into = nn.Linear(config.D, width)
        self.layers = nn.ModuleList(Layer(width, config.heads) for _ in range(config.layers))
        self.out = nn.Sequential(nn.LayerNorm(width), nn.Linear(width, config.D))

    def listen(
        self,
        mel: Float[Tensor, "B M C"],
        times: Float[Tensor, "M"],
        mask: Bool[Tensor, "B M"] | None = None,
    ) -> Music:
        """The context of a piece of music, as in MoFusion.listen."""
        present = (
            mel.new_ones(1, mel.shape[1], 1) if mask is None else mask[..., None].to(mel.dtype)
        )
        step = 2 if self.config.music_layers else 1
        return Music(
            self.music(mel, present), times[::step], None if mask is None else mask[:, ::step]
        )

    def encode(self, music: Music, frames: int) -> Music:
        """The music itself: here nothing more is the same at all steps."""
        return music

    def decode(
        self, x_s: Float[Tensor, "B T D"], s: Int[Tensor, "B"], music: Music
    ) -> Float[Tensor, "B T D"]:
        return self(x_s, s, music)

    def forward(
        self, x_s: Float[Tensor, "B T D"], s: Int[Tensor, "B"], music: Music
    ) -> Float[Tensor, "B T D"]:
        config = self.config
        if config.deterministic:
            x_s, s = torch.zeros_like(x_s), torch.zeros_like(s)
        times = torch.arange(x_s.shape[1], device=x_s.device) / config.fps
        code = (config.width // config.heads, config.slowest, config.fastest)
        frames, tokens = angles_of(times, *code), angles_of(music.times, *code)
        bias = None
        if music.mask is not None:
            bias = torch.where(music.mask[:, None, None], 0.0, -1e4).expand(-1, -1, len(times), -1)
        x = self.into(x_s) + self.step_in(step_embedding(s, config.width))[:, None]
        for layer in self.layers:
            x = layer(x, music, bias, (frames, frames), (frames, tokens))
        return self.out(x)


@dataclass(frozen=True)
class HearingTransformerConfig(EarSizes, TransformerConfig):
    """The transformer's sizes, and those of its ear."""

    ear_width: int = 96
    ear_blocks: int = 4

    def __post_init__(self):
        super().__post_init__()
        self.check_ear()


class HearingTransformer(WithEar, DanceTransformer):
    """The transformer with an ear, which the regression has.  Ours."""

    def __init__(self, config: HearingTransformerConfig):
        super().__init__(config)
        self.with_ear(config.ear, config.width)


def regression_loss(
    model: DancerNetwork,
    x0: Float[Tensor, "B T D"],
    mel: Float[Tensor, "B M C"],
    mel_times: Float[Tensor, "M"],
) -> Float[Tensor, ""]:
    """Mean squared error of the motion itself, from no noise at step 0: a regression's loss.

    The same song then gives the same dance, the mean of all its possible dances. A mean of dances
    hardly moves. AI Choreographer, with which MoFusion is compared, is trained so.
    mel_times  seconds of each row of the log-Mel spectrogram
    """
    s = torch.zeros(len(x0), dtype=torch.long, device=x0.device)
    out = model(torch.zeros_like(x0), s, model.listen(mel, mel_times))
    return (out - x0).square().mean()


register("dancer", DanceTransformer, TransformerConfig)
register("dancer", HearingTransformer, HearingTransformerConfig)
