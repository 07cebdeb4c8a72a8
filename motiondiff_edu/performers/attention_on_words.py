"""Where a mover's attention reads in a sentence, frame by frame.

An attention weight shows where values are read. It does not show what changes in the motion if the
word changes: exchange the word and look.
Source: MoFusion 3.3, for words instead of music.
"""

from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Float

from ..conditions.text import read
from ..conditions.word_encoder import ids_of
from ..cross_modal_attention import watch
from ..ddpm import draw, q_sample
from .mover import Mover


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
        rows = [
            weights[np.arange(frames) * len(weights) // frames] for weights in self.levels.values()
        ]
        return np.mean(rows, axis=0)


@torch.no_grad()
def attention_on_words(
    mover: Mover,
    text: str,
    positions: Float[np.ndarray, "T 21 3"],
    s: int,
    *,
    generator: torch.Generator | None = None,
) -> WordMaps:
    """Where each layer reads in the text while this motion, noised to step s, is denoised.

    Heads are averaged.
    Raises TextError for a text that cannot be read, ValueError for a step outside the schedule, or
    a mover that reads by CLIP.
    """
    if mover.config.clip:
        raise ValueError("these maps are over words; this mover reads by CLIP")
    if not 1 <= s <= mover.schedule.S:
        raise ValueError(f"this mover's steps are 1 to {mover.schedule.S}, not {s}")
    words = read(text, mover.config.words).words
    ids = ids_of([words], mover.config.words)
    x0 = mover.units_of(positions)[None]
    x_s = q_sample(x0, s, mover.schedule, draw(x0, generator))
    plan = mover.plans(ids, x0.shape[1], generator=generator) if mover.can_plan else None
    denoise = mover.denoiser(ids, plan=plan)
    with watch(mover.model) as seen:
        denoise(x_s, torch.tensor([s], device=mover.device))
    levels = {
        name.split("unet.")[-1].removesuffix(".attention"): maps[0][0].mean(0).cpu().numpy()
        for name, maps in seen.items()
        if ".ask." in name and maps  # a planner was not asked
    }
    return WordMaps(words, levels)
