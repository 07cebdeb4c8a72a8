"""Where a dancer's attention reads in the music, and how much of it falls on the beats.

An attention weight shows where values are read. It does not show what changes in the dance if the
music changes; `occlusion` measures that.
Source: MoFusion Fig. 4.  Notebook: 12
"""

from collections.abc import Iterator

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor

from ...cross_modal_attention import watch
from ...ddpm import draw, q_sample
from ...mofusion import MoFusion, MoFusionConfig
from ...motion.dance_frame import to_features
from ...performers.dancer import Dancer

NEAR = 0.1  # s: tokens closer than this to a beat count as on the beat


def layers_of(config: MoFusionConfig) -> Iterator[tuple[str, int, str]]:
    """Each block's attention layer, its level, and its name, in the order of the computation.

    At a level, every 2^level-th frame has a query; the name says how many there are per second.
    The order is from the input down to the bottom of the U, and up again.
    """
    levels = len(config.widths)
    for level in range(levels):
        yield f"down.{level}.ask.attention", level, f"down, {config.fps / 2**level:g} a second"
    yield "middle.ask.attention", levels, f"bottom, {config.fps / 2**levels:g} a second"
    for k, level in enumerate(reversed(range(levels))):
        yield f"up.{k}.ask.attention", level, f"up, {config.fps / 2**level:g} a second"


@torch.no_grad()
def attention_maps(
    dancer: Dancer,
    mel: Float[Tensor, "M C"],
    dance: Float[np.ndarray, "T 21 3"],
    s: int,
    *,
    generator: torch.Generator | None = None,
) -> tuple[dict[str, Float[np.ndarray, "_ M2"]], Float[np.ndarray, "M2"]]:
    """Where each level reads in the music while this dance, noised to step s, is denoised.

    Returns {level: weights (its motion frames, music tokens)}, averaged over heads, and the tokens'
    times in seconds. Each row sums to one. `mel` is log-Mel, as for `Dancer.dance_mel`.
    Raises ValueError for a step outside the schedule, and for a network that is not a U-Net or has
    no music.  Source: MoFusion Fig. 4.  Notebook: 12
    """
    model, T = dancer.model, len(dance)
    if not isinstance(model, MoFusion) or model.music is None:
        raise ValueError(
            f"these maps need a U-Net with music; this dancer has a {type(model).__name__}, "
            f"C = {model.config.C}"
        )
    if not 1 <= s <= dancer.schedule.S:
        raise ValueError(f"this dancer's steps are 1 to {dancer.schedule.S}, not {s}")
    features = torch.from_numpy(to_features(dance)).float().to(dancer.device)
    x0 = dancer.motion_scaler.transform(features)[None]
    x_s = q_sample(x0, s, dancer.schedule, draw(x0, generator))
    with watch(model) as seen:
        music = model.listen(*dancer.mel_input(mel[None], T))
        model(x_s, torch.tensor([s], device=dancer.device), music)
    maps = {  # rows beyond the dance are padding
        name: seen[layer][0][0].mean(0)[: -(-T // 2**level)].cpu().numpy()
        for layer, level, name in layers_of(model.config)
    }
    return maps, music.times.double().cpu().numpy()


def share_near(
    weights: Float[np.ndarray, "T M"],
    token_times: Float[np.ndarray, "M"],
    moments: Float[np.ndarray, "K"],
    before: float = NEAR,
    after: float = NEAR,
) -> Float[np.ndarray, "T K"]:
    """The share of each row's attention on the tokens near each of the `moments` (seconds).

    Near is from `before` seconds before the moment to `after` seconds after it.
    """
    away = token_times[:, None] - moments[None, :]
    return weights @ ((-before <= away) & (away <= after)).astype(weights.dtype)


def beat_mass(
    weights: Float[np.ndarray, "T M"],
    token_times: Float[np.ndarray, "M"],
    beats: Float[np.ndarray, "K"],
    near: float = NEAR,
) -> float:
    """The share of all attention that falls on tokens within `near` seconds of some beat, 0 to 1.

    Compare it with `beat_mass_by_chance`: at 120 beats a minute, 0.1 s around each beat is already
    0.4 of all time.
    Raises ValueError for music without a beat.  Source: MoFusion Fig. 4.  Notebook: 12
    """
    if not len(beats):
        raise ValueError("this music has no beats, so attention on beats is undefined")
    nearest = np.abs(token_times[:, None] - beats[None, :]).min(1)
    return float(weights[:, nearest <= near].sum(1).mean())


def beat_mass_by_chance(
    weights: Float[np.ndarray, "T M"],
    token_times: Float[np.ndarray, "M"],
    beats: Float[np.ndarray, "K"],
    rng: np.random.Generator,
    times: int = 500,
    near: float = NEAR,
) -> Float[np.ndarray, "times"]:
    """`beat_mass` after random circular shifts of the beats: they keep their rhythm and lose their
    place in the music.

    Raises ValueError for music without a beat.  Notebook: 12
    """
    first, seconds = token_times[0], token_times[-1] - token_times[0]
    moved = (
        np.sort((beats - first + by) % seconds) + first for by in rng.uniform(0, seconds, times)
    )
    return np.array([beat_mass(weights, token_times, beats_now, near) for beats_now in moved])


def seconds_read(weights: Float[np.ndarray, "T M"], token_times: Float[np.ndarray, "M"]) -> float:
    """How many seconds of music a frame reads: exp(entropy) of its row, times a token's length.

    The result is the mean over rows. Equal weights give the whole music, a single weight one token.
    So few seconds mean sharp attention, and many mean scattered attention.
    Raises ValueError for a single token.  Notebook: 12
    """
    if len(token_times) < 2:
        raise ValueError(
            "the music has a single token, so the attention on it says nothing; 2 are needed"
        )
    logs = np.log(weights, out=np.zeros_like(weights), where=weights > 0)
    tokens = np.exp(-(weights * logs).sum(1)).mean()
    return float(tokens * (token_times[-1] - token_times[0]) / (len(token_times) - 1))
