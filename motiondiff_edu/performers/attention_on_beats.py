"""What a dancer listens to: where its attention reads in the music, and what moves when one sound
is taken away.

A weight says where values were read; what a change does is another question, and may have another
answer.
Source: MoFusion Fig. 4.  Notebook: 12
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import torch
from jaxtyping import Bool, Float
from scipy.signal import istft, stft
from torch import Tensor

from ..conditions.audio_files import read_audio
from ..conditions.music import SAMPLE_RATE, log_mel
from ..cross_modal_attention import watch
from ..ddpm import q_sample
from ..mofusion import MoFusion, MoFusionConfig
from ..motion.dance_frame import to_features
from .dancer import Dancer

NEAR = 0.1  # s: what lies so close to a beat is counted as the beat's
WIDTH = 0.12  # s of sound that is taken away
# s listened to on either side of it; s of cross-fade; below is silence
BESIDE = 0.08
EDGE = 0.02
TINY = 1e-9


def layers_of(config: MoFusionConfig) -> Iterator[tuple[str, int, str]]:
    """Each block's attention layer, its level (every 2^level-th frame asks), and a name that says
    how many a second.

    In the order of the computation: from the input down to the bottom of the U, and up again.
    Notebook: 12
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
    """Where each level reads in the music while this dance, noised to step s, is denoised; the mean
    over heads.

    {level: (its motion frames, music tokens)}, each row summing to one, and the tokens' times in
    seconds. `mel` is log-Mel, as for `Dancer.dance`. Raises ValueError for a step that is not
    there, and for a network that is no U-Net, or hears no music.  Source: MoFusion Fig. 4.
    Notebook: 12
    """
    model, T = dancer.model, len(dance)
    if not isinstance(model, MoFusion) or model.music is None:
        raise ValueError(
            f"these maps are of a U-Net that hears music, not of {type(model).__name__} without"
        )
    if not 1 <= s <= dancer.schedule.S:
        raise ValueError(f"this dancer's steps are 1 to {dancer.schedule.S}, not {s}")
    x0 = dancer.motion_scaler.transform(torch.from_numpy(to_features(dance)).float())[None]
    x_s = q_sample(
        x0, torch.tensor([s]), dancer.schedule, torch.randn(x0.shape, generator=generator)
    )
    with watch(model) as seen:
        music = model.listen(*dancer.heard(mel[None], T))
        model(x_s, torch.tensor([s]), music)
    maps = {
        name: seen[layer][0][0]
        .mean(0)[: -(-T // 2**level)]
        .numpy()  # rows beyond the dance are padding
        for layer, level, name in layers_of(model.config)
    }
    return maps, music.times.double().numpy()


def share_near(
    weights: Float[np.ndarray, "T M"],
    token_times: Float[np.ndarray, "M"],
    moments: Float[np.ndarray, "K"],
    before: float = NEAR,
    after: float = NEAR,
) -> Float[np.ndarray, "T K"]:
    """How much of each row's attention falls on tokens from `before` seconds before each moment to
    `after` after it."""
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
    """`beat_mass` with the beats moved together by random times, going round at the end of the
    music.

    The beats keep their rhythm and lose their place.  Raises ValueError for music without a beat.
    Notebook: 12
    """
    first, seconds = token_times[0], token_times[-1] - token_times[0]
    moved = (
        np.sort((beats - first + by) % seconds) + first for by in rng.uniform(0, seconds, times)
    )
    return np.array([beat_mass(weights, token_times, beats_now, near) for beats_now in moved])


def seconds_read(weights: Float[np.ndarray, "T M"], token_times: Float[np.ndarray, "M"]) -> float:
    """How many seconds of music a frame reads: exp(entropy) of its row, times a token's length; the
    mean over rows.

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


def silence_hit(
    audio: Float[np.ndarray, "N"], time: float, width: float = WIDTH
) -> Float[np.ndarray, "N"]:
    """The song (16 kHz) without what is struck at `time` seconds: for `width` seconds no frequency
    may burst out.

    Each is held down to a line, straight in decibels, from what it was before to what it is
    afterwards: a note that sounds on sounds on, and outside of the span every sample is as it was.
    Raises ValueError for a time outside of the song, or a width that is not positive.  Notebook: 12
    """
    if not 0 <= time < len(audio) / SAMPLE_RATE:
        raise ValueError(
            f"there is no sound at {time:g} s: this song has {len(audio) / SAMPLE_RATE:g} s"
        )
    if width <= 0:
        raise ValueError(f"a width is a time above 0 s, not {width:g}")
    shape = {"fs": SAMPLE_RATE, "nperseg": 512, "noverlap": 384}
    _, centres, spectrum = stft(audio, **shape)
    away, loud = centres - time, np.abs(spectrum)

    def usual(span: Bool[np.ndarray, "F"]) -> Float[np.ndarray, "K"]:
        return (
            np.log(np.median(loud[:, span], axis=1) + TINY)
            if span.any()
            else np.full(len(loud), np.log(TINY))
        )

    before = usual((-BESIDE <= away) & (away < -EDGE))[:, None]
    after = usual((width <= away) & (away < width + BESIDE))[:, None]
    most = np.exp(before + np.clip(away / width, 0, 1) * (after - before))
    quiet = istft(spectrum * np.minimum(1.0, most / np.maximum(loud, TINY)), **shape)[1][
        : len(audio)
    ]
    t = np.arange(len(audio)) / SAMPLE_RATE - time
    share = np.interp(t, [-EDGE, -EDGE / 2, width, width + EDGE], [0, 1, 1, 0])
    return (audio + share * (quiet - audio)).astype(audio.dtype)


def read_sound(sound: str | Path | bytes | memoryview) -> Float[Tensor, "N"]:
    """`read_audio` of a sound file by its name, or of its bytes, as they come from an upload.

    Raises AudioError as `read_audio` does.  Notebook: 12
    """
    if isinstance(sound, str | Path):
        return read_audio(sound)
    with TemporaryDirectory() as folder:
        path = Path(folder) / "the uploaded file"
        path.write_bytes(sound)
        return read_audio(path)


@dataclass(frozen=True, eq=False)
class Occlusion:
    """A dance, the same from the same noise with each sound silenced, and how far each frame moved:
    metres, the mean over the joints."""

    times: Float[np.ndarray, "K"]
    dance: Float[np.ndarray, "T 21 3"]
    without: Float[np.ndarray, "K T 21 3"]

    @property
    def moved(self) -> Float[np.ndarray, "K T"]:
        return np.linalg.norm(self.without - self.dance, axis=-1).mean(-1)


def occlusion(
    dancer: Dancer,
    audio: Float[np.ndarray, "N"],
    times: Float[np.ndarray, "K"],
    frames: int,
    *,
    generator: torch.Generator | None = None,
    width: float = WIDTH,
    steps: int = 20,
    together: int = 6,
) -> Occlusion:
    """Dance to the song, and again with the sound at each of `times` (seconds) silenced, always
    from the same noise.

    DDIM without noise of its own (eta = 0), so that nothing but the music differs; `together` songs
    are danced to at once. Raises ValueError as `silence_hit` and `Dancer.dance` do.   Notebook: 12
    """
    start = torch.randn(1, frames, dancer.config.D, generator=generator)
    heard = log_mel(np.stack([audio, *(silence_hit(audio, float(time), width) for time in times)]))
    dances = [
        dancer.dance(mel, frames, start=start.expand(len(mel), -1, -1), steps=steps, eta=0.0)
        for mel in heard.split(together)
    ]
    whole = torch.cat(dances).double().numpy()
    return Occlusion(np.asarray(times, np.float64), whole[0], whole[1:])
