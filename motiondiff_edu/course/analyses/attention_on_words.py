"""Where a mover's attention reads in a sentence, frame by frame.

An attention weight shows where values are read. It does not show what changes in the motion if the
word changes: exchange the word and look.
Source: MoFusion 3.3, for words instead of music.
Notebook: 16
"""

from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor, nn

from ...conditions.clip import ClipModel
from ...cross_modal_attention import watch
from ...ddpm import Denoiser, draw, q_sample
from ...performers.mover import Mover
from ...performers.text_mofusion import Texts


@dataclass(frozen=True, eq=False)
class WordMaps:
    """Attention over the words of a sentence; each row of a map sums to one.

    words   as the network reads them
    levels  for each layer, by the number of queries per second: (its motion frames, words)
    """

    words: tuple[str, ...]
    levels: dict[str, Float[np.ndarray, "_ M"]]

    def by_frame(self, frames: int) -> Float[np.ndarray, "{frames} M"]:
        """The mean over layers, for each frame of the motion."""
        T = max(map(len, self.levels.values()))  # the first layer has a query for each frame
        frame = np.arange(frames) * T // frames
        strides = [2 ** round(np.log2(T / len(weights))) for weights in self.levels.values()]
        rows = zip(self.levels.values(), strides, strict=True)
        return np.mean([weights[frame // stride] for weights, stride in rows], axis=0)


@torch.no_grad()
def attention_on_words(
    mover: Mover,
    text: str,
    positions: Float[np.ndarray, "T 21 3"],
    s: int,
    *,
    plan: Float[Tensor, "1 T 24"] | None = None,
    generator: torch.Generator | None = None,
) -> WordMaps:
    """Where each layer reads in the text while this motion, noised to step s, is denoised.

    A mover that plans needs the `plan` of the motion (`Mover.plans`). Heads are averaged.
    Raises TextError for a text that cannot be read, ValueError for a step outside the schedule, a
    missing plan, or a mover that reads by CLIP.
    """
    words, ids = _read(mover, text, s)
    denoise, x0 = mover.denoiser(ids, len(positions), plan=plan), mover.units_of(positions)[None]
    return WordMaps(words, _seen(mover, denoise, x0, s, generator))


@torch.no_grad()
def attention_of_the_plan(
    mover: Mover,
    text: str,
    plan: Float[Tensor, "1 T 24"],
    s: int,
    *,
    generator: torch.Generator | None = None,
) -> WordMaps:
    """The same for the network that plans, while this timeline, noised to step s, is denoised."""
    words, ids = _read(mover, text, s)
    x0 = mover.plan_scaler.transform(plan.to(mover.device))
    denoise = mover.plan_denoiser(ids, plan.shape[1])
    return WordMaps(words, _seen(mover, denoise, x0, s, generator))


def _read(mover: Mover, text: str, s: int) -> tuple[tuple[str, ...], Texts]:
    """The words of a text, and what the network takes of them, for step s."""
    if isinstance(mover.reader, ClipModel):
        raise ValueError("these maps are over words; this mover reads by CLIP")
    if not 1 <= s <= mover.schedule.S:
        raise ValueError(f"this mover's steps are 1 to {mover.schedule.S}, not {s}")
    words = mover.reader.read(text).words
    return words, mover.reader.encoded([words])


def _seen(
    mover: Mover,
    denoise: Denoiser,
    x0: Float[Tensor, "1 T F"],
    s: int,
    generator: torch.Generator | None,
) -> dict[str, Float[np.ndarray, "_ M"]]:
    """The maps of all layers that were asked, while x0, noised to step s, is denoised."""
    x_s, model = q_sample(x0, s, mover.schedule, draw(x0, generator)), mover.model
    assert isinstance(model, nn.Module)
    with watch(model) as seen:
        denoise(x_s, torch.tensor([s], device=mover.device))
    found = {
        name.split("unet.")[-1].removesuffix(".attention"): maps[0][0].mean(0).cpu().numpy()
        for name, maps in seen.items()
        if ".ask." in name and maps
    }
    T, padded = x0.shape[1], max(map(len, found.values()))
    return {name: rows[: -(-T * len(rows) // padded)] for name, rows in found.items()}
