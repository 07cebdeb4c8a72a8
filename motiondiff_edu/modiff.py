"""MoDiff: two encoders, a cross-modal transformer and a decoder, and the loss that trains them.

The decoder predicts the noise of the future; Algorithm 1 trains all parts together.

    past poses  --2 layers--+
                            +--concatenated in time--6 cross-modal layers--> memory
    control     --2 layers--+                                                  |
    (noised future, step) ----------------------------------3 decoder layers--+--> eps_hat
Source: MoDiff III-F, IV-A, Fig. 2.  Notebook: 07
"""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, fields
from typing import Any

import torch
from jaxtyping import Float, Int
from torch import Tensor, nn

from .cross_modal_attention import Block, KeysValues, RelativeBias
from .ddpm import Schedule, draw, q_sample, squared_error
from .prediction import TARGETS, target_of

Past = Float[Tensor, "B T_h D"]
Future = Float[Tensor, "B T_p D"]
Control = Float[Tensor, "B T C"]


@dataclass(frozen=True)
class MoDiffConfig:
    """Sizes of the network. `target` is what the network predicts; `skip` adds w(s) x_s to it.

    The paper gives width, heads, layers, T_h and S; T_p, the feed-forward width and dropout are
    ours.
    Source: MoDiff III-F, IV-A
    """

    D: int = 63  # motion features
    C: int = 3  # control features
    T_h: int = 10  # past frames given
    T_p: int = 10  # future frames predicted
    S: int = 100  # diffusion steps
    width: int = 256
    heads: int = 4
    hidden: int = 1024  # feed-forward width
    motion_layers: int = 2
    control_layers: int = 2
    cross_layers: int = 6
    decoder_layers: int = 3
    dropout: float = 0.0
    target: str = "eps"
    skip: bool = True

    def __post_init__(self):
        """Raise ValueError for an unknown target, or for impossible sizes."""
        sizes = {
            field.name: getattr(self, field.name)
            for field in fields(self)
            if type(field.default) is int
        }
        least = {name: 0 if "layers" in name else 1 for name in sizes}
        bad = next((name for name, value in sizes.items() if value < least[name]), None)
        if bad:
            raise ValueError(f"{bad} = {sizes[bad]} must be at least {least[bad]}")
        if not 0 <= self.dropout < 1:
            raise ValueError(f"dropout = {self.dropout:g} must be from 0 to below 1")
        if self.width % self.heads or self.width % 2:
            raise ValueError(
                f"width = {self.width} must be even, and a multiple of {self.heads} heads"
            )
        if self.target not in TARGETS:
            raise ValueError(f"target must be one of {', '.join(TARGETS)}, not {self.target!r}")


MODIFF_PAPER = MoDiffConfig(dropout=0.1, skip=False)
MODIFF_SMALL = MoDiffConfig(width=128, hidden=256, cross_layers=2)


def step_embedding(s: Int[Tensor, "B"], width: int) -> Float[Tensor, "B E"]:
    """Sines and cosines of the diffusion step.

    The wavelengths grow from 2 pi steps to 10000^(1 - 2 / width) * 2 pi steps, by equal ratios.
    Notebook: 05
    """
    frequencies = torch.exp(
        -math.log(1e4) * torch.arange(width // 2, device=s.device) / (width // 2)
    )
    angles = s[:, None].float() * frequencies
    return torch.cat([angles.sin(), angles.cos()], dim=-1)


class Encoder(nn.Module):
    """Self-attention over tokens with known times (in frames).

    Source: MoDiff III-F.  Notebook: 06
    """

    def __init__(self, config: MoDiffConfig, layers: int, times: Int[Tensor, "T"]):
        super().__init__()
        self.bias = RelativeBias(config.heads, times, times)
        sizes = (config.width, config.heads, config.hidden)
        self.blocks = nn.ModuleList(Block(*sizes, dropout=config.dropout) for _ in range(layers))

    def forward(self, x: Float[Tensor, "B T W"]) -> Float[Tensor, "B T W"]:
        bias = self.bias()
        for block in self.blocks:
            x = block(x, bias)
        return x


@dataclass(frozen=True, eq=False)
class Memory:
    """What the decoder needs besides x_s and s, which is the same at all steps.

    So a window is encoded once and decoded S times.

    steps   the embedding of every diffusion step
    layers  for each layer of the decoder, keys and values of past and control
    """

    steps: Float[Tensor, "S_plus_1 width"]
    layers: tuple[KeysValues, ...]
    self_bias: Float[Tensor, "1 H T_p T_p"]
    memory_bias: Float[Tensor, "1 H T_p M"]


class MoDiff(nn.Module):
    """eps_hat = net(x_s, s, past, control) + w(s) x_s.

    w(s) is learned, one number per step, and starts at 1. At high noise eps is nearly x_s itself;
    with the skip the network need not carry 63 independent noise values through its width (ours;
    the paper has none). Times are in frames: the past ends at 0, the future is 1..T_p, and control
    has a row for each of these frames.
    Source: MoDiff III-F, Fig. 2.  Notebook: 07
    """

    def __init__(self, config: MoDiffConfig = MODIFF_SMALL):
        super().__init__()
        self.config, width = config, config.width
        past, future = torch.arange(1 - config.T_h, 1), torch.arange(1, config.T_p + 1)
        both = torch.cat([past, future])  # times of the control
        memory = torch.cat([past, both])
        self.past_in, self.control_in = nn.Linear(config.D, width), nn.Linear(config.C, width)
        self.modality = nn.Parameter(0.02 * torch.randn(2, width))  # marks pose and control tokens
        self.time = nn.Parameter(
            step_embedding(8 * torch.arange(len(both)), width)
        )  # marks the time of a token; times 8, so that neighbouring frames differ clearly
        self.motion_encoder = Encoder(config, config.motion_layers, past)
        self.control_encoder = Encoder(config, config.control_layers, both)
        self.cross_encoder = Encoder(config, config.cross_layers, memory)
        self.memory_norm = nn.LayerNorm(width)

        self.step_in = nn.Sequential(nn.Linear(width, width), nn.SiLU(), nn.Linear(width, width))
        self.future_in = nn.Linear(config.D + width, width)
        self.self_bias = RelativeBias(config.heads, future, future)
        self.memory_bias = RelativeBias(config.heads, future, memory)
        sizes = (width, config.heads, config.hidden)
        self.decoder = nn.ModuleList(
            Block(*sizes, True, config.dropout) for _ in range(config.decoder_layers)
        )
        self.head = nn.Sequential(
            nn.LayerNorm(width), nn.Linear(width, width), nn.GELU(), nn.Linear(width, config.D)
        )
        self.skip = nn.Parameter(torch.ones(config.S + 1)) if config.skip else None

    def encode(self, past: Float[Tensor, "B T_h D"], control: Float[Tensor, "B T C"]) -> Memory:
        """The memory: past poses and control, encoded separately and then together.

        Raises ValueError if past or control have the wrong number of frames.
        """
        frames = (self.config.T_h, self.config.T_h + self.config.T_p)
        if (past.shape[1], control.shape[1]) != frames:
            raise ValueError(
                f"this network takes {frames[0]} past poses and {frames[1]} rows of control "
                f"(past and future), not {past.shape[1]} and {control.shape[1]}"
            )
        motion = (
            self.past_in(past) + self.time[: self.config.T_h] + self.modality[0]
        )  # (B, T_h, width)
        control = self.control_in(control) + self.time + self.modality[1]  # (B, T, width)
        both = torch.cat(
            [self.motion_encoder(motion), self.control_encoder(control)], dim=1
        )  # (B, M, width)
        tokens = self.memory_norm(self.cross_encoder(both))
        blocks: Iterable[Any] = self.decoder  # torch's stubs say of a list that it holds Modules
        layers = tuple(block.cross_attention.keys_and_values(tokens) for block in blocks)
        every = torch.arange(self.config.S + 1, device=tokens.device)
        steps = self.step_in(step_embedding(every, self.config.width))
        return Memory(steps, layers, self.self_bias(), self.memory_bias())

    def decode(
        self, x_s: Float[Tensor, "B T_p D"], s: Int[Tensor, "B"], memory: Memory
    ) -> Float[Tensor, "B T_p D"]:
        """The network's prediction of its target (eps, x0 or v) from the noised future.

        Raises ValueError if the future has the wrong number of frames.
        """
        if x_s.shape[1] != self.config.T_p:  # a single one would be repeated for all of them
            raise ValueError(
                f"this network predicts {self.config.T_p} future poses, not {x_s.shape[1]}"
            )
        step = memory.steps[s, None].expand(-1, x_s.shape[1], -1)  # one s for all poses
        x = self.future_in(torch.cat([x_s, step], dim=-1)) + self.time[self.config.T_h :]
        for block, layer in zip(self.decoder, memory.layers, strict=True):
            x = block(x, memory.self_bias, layer, memory.memory_bias)
        out = self.head(x)
        return out if self.skip is None else out + self.skip[s][:, None, None] * x_s

    def forward(
        self,
        x_s: Float[Tensor, "B T_p D"],
        s: Int[Tensor, "B"],
        past: Float[Tensor, "B T_h D"],
        control: Float[Tensor, "B T C"],
    ) -> Float[Tensor, "B T_p D"]:
        return self.decode(x_s, s, self.encode(past, control))


def training_loss(
    model: Callable[[Future, Int[Tensor, "B"], Past, Control], Future],
    batch: tuple[Past, Future, Control],
    schedule: Schedule,
    generator: torch.Generator,
    *,
    dropout: Callable[[Past, Int[Tensor, "B"], torch.Generator], Past] | None = None,
) -> Float[Tensor, ""]:
    """Algorithm 1: the loss of one batch (past, future, control).

    || eps - eps_theta(x_s, s, x_d, c) ||^2
    x_s = sqrt(alpha_bar_s) x0 + sqrt(1 - alpha_bar_s) eps
    s ~ Uniform(1..S), eps ~ N(0, I); the paper's x0 and x_s are y_0 and y_s.
    dropout  makes x_d from the past x (`diffusion_dropout.Dropout`); without it x_d = x
    The network can predict x0 or v instead of eps (`model.config.target`), which is ours, too.
    Source: MoDiff Alg. 1, eq. 10.  Notebook: 05, 07
    """
    past, x0, control = batch
    s = torch.randint(1, schedule.S + 1, (len(x0),), generator=generator).to(x0.device)
    if dropout is not None:
        past = dropout(past, s, generator)  # eq. 12
    eps = draw(x0, generator)
    x_s = q_sample(x0, s, schedule, eps)  # eq. 2
    kind = model.config.target  # type: ignore[attr-defined]  # a network has its configuration
    target = target_of(x0, eps, s, schedule, kind)
    return squared_error(target - model(x_s, s, past, control), s)  # eq. 10
