"""Where a dancer's attention reads in the music, and how much of it falls on the beats.

A weight says where values were read; what a change does is another question, and may have another
answer (`occlusion`).
Source: MoFusion Fig. 4.  Notebook: 12
"""

from collections.abc import Iterator

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor

from ..cross_modal_attention import watch
from ..ddpm import draw, q_sample
from ..mofusion import MoFusionConfig
from ..motion.dance_frame import to_features
from .dancer import Dancer

NEAR = 0.1  # s: what lies so close to a beat is counted as the beat's


def layers_of(config: MoFusionConfig) -> Iterator[tuple[str, int, str]]:
    """Each block's attention layer, its level, and its name.

    Every 2^level-th frame asks; the name says how many a second.

    In the order of the computation: from the input down to the bottom of the U, and up again.
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

    The mean over heads.

    {level: (its motion frames, music tokens)}, each row summing to one, and the tokens' times in
    seconds. `mel` is log-Mel, as for `Dancer.dance`. Raises ValueError for a step that is not
    there, and for a network that is no U-Net, or hears no music.  Source: MoFusion Fig. 4.
    Notebook: 12
    """
    model, T = dancer.model, len(dance)
    if not hasattr(model.config, "widths") or model.music is None:
        raise ValueError(
            f"these maps are of a U-Net that hears music, not of {type(model).__name__} without"
        )
    if not 1 <= s <= dancer.schedule.S:
        raise ValueError(f"this dancer's steps are 1 to {dancer.schedule.S}, not {s}")
    features = torch.from_numpy(to_features(dance)).float().to(dancer.device)
    x0 = dancer.motion_scaler.transform(features)[None]
    x_s = q_sample(x0, s, dancer.schedule, draw(x0, generator))
    with watch(model) as seen:
        music = model.listen(*dancer.mel_input(mel[None], T))
        model(x_s, torch.tensor([s], device=dancer.device), music)
    maps = {
        name: seen[layer][0][0]
        .mean(0)[: -(-T // 2**level)]
        .cpu()
        .numpy()  # rows beyond the dance are padding
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
    """How much of each row's attention falls on the tokens near some moments.

    Near is from `before` seconds before each moment to `after` seconds after it.
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

    It says nothing without `beat_mass_by_chance`: at 120 beats a minute 0.1 s around each are
    already 0.4 of all time.
    Raises ValueError for music without a beat.  Source: MoFusion Fig. 4.  Notebook: 12
    """
    if not len(beats):
        raise ValueError("this music has no beat that attention could fall on")
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
    """`beat_mass` with the beats moved together by random times.

    They go round at the end of the music.

    The beats keep their rhythm and lose their place.  Raises ValueError for music without a beat.
    Notebook: 12
    """
    first, seconds = token_times[0], token_times[-1] - token_times[0]
    moved = (
        np.sort((beats - first + by) % seconds) + first for by in rng.uniform(0, seconds, times)
    )
    return np.array([beat_mass(weights, token_times, beats_now, near) for beats_now in moved])


def seconds_read(weights: Float[np.ndarray, "T M"], token_times: Float[np.ndarray, "M"]) -> float:
    """How many seconds of music a frame reads: exp(entropy) of its row, times a token's length.

    The mean over rows.

    Equal weights read all of it, a single weight one token. Few seconds are a sharp level, many a
    scattered one.
    Raises ValueError for a single token.  Notebook: 12
    """
    if len(token_times) < 2:
        raise ValueError(
            "one token is all the music there is: nothing can be read from where it is read"
        )
    logs = np.log(weights, out=np.zeros_like(weights), where=weights > 0)
    tokens = np.exp(-(weights * logs).sum(1)).mean()
    return float(tokens * (token_times[-1] - token_times[0]) / (len(token_times) - 1))
