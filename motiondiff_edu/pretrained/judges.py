"""Judges of words: a space of texts and motions with its units, shipped for R-Precision and FID.

Source: `metrics/distributions.py`, which has the network and the measures.
Notebook: 17
"""

import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor

from ..conditions.text import read_words
from ..conditions.word_encoder import FIRST, ids_of
from ..metrics.distributions import Space
from ..motion.moving_frame import D, to_features
from ..motion.scaler import Scaler
from .checkpoints import FOLDER, card_of, refuse_other_shapes, scaler_of, weights_of, with_weights
from .weights_file import LARGEST, check_sizes, pack, read_weights, write_weights

FORMAT = "motiondiff_edu judge 1"
GRID = 4  # frames: the network halves a motion twice


@dataclass(frozen=True, eq=False)
class Judge:
    """A space, the scaler of its motions, and the words that it knows."""

    space: Space
    scaler: Scaler
    words: tuple[str, ...]
    card: dict = field(default_factory=dict)

    @torch.inference_mode()
    def of_texts(self, texts: Sequence[str]) -> Float[np.ndarray, "N E"]:
        """The points of captions.  Raises TextError for a text that cannot be read."""
        ids = ids_of([read_words(text, self.words).words for text in texts], self.words)
        return self.space.text_points(ids).double().numpy()

    @torch.inference_mode()
    def of_motions(
        self, motions: Sequence[Float[np.ndarray, "_ 21 3"]]
    ) -> Float[np.ndarray, "N E"]:
        """The points of motions at 20 frames a second, metres; each may have its own length."""
        points = []
        for positions in motions:
            features = torch.from_numpy(to_features(positions[: len(positions) // GRID * GRID]))
            points.append(self.space.motion_points(self.scaler.transform(features.float())[None]))
        return torch.cat(points).double().numpy()


def save_judge(judge: Judge, path: str | Path) -> Path:
    """Write a judge in eight bits, with its card beside it."""
    tensors = {f"model.{k}": v for k, v in pack(judge.space.state_dict()).items()}
    tensors |= {"motion.mean": judge.scaler.mean, "motion.std": judge.scaler.std}
    config = {"words": list(judge.words), "width": judge.space.width}
    return write_weights(path, tensors, {"format": FORMAT}, config, judge.card)


def load_judge(path: str | Path) -> Judge:
    """Read a judge.  Raises CheckpointError for a file that is missing, damaged, or no judge."""
    return read_weights(path, {FORMAT: _assembled})


def judges() -> list[Judge]:
    """The shipped judges, one for each seed of their training."""
    return [load_judge(path) for path in sorted((FOLDER / "judges").glob("*.safetensors"))]


def _assembled(tensors: dict[str, Tensor], metadata: dict[str, str]) -> Judge:
    config = json.loads(metadata["config"])
    words, width = config["words"], config["width"]
    named = isinstance(words, list) and all(isinstance(word, str) for word in words)
    if not named or type(width) is not int or not 0 < width <= LARGEST:
        raise ValueError("a judge has a list of words, and a width")
    check_sizes(tensors, {"motion.mean": D, "motion.std": D})
    build, weights = partial(Space, D, FIRST + len(words), width), weights_of(tensors)
    refuse_other_shapes(build, weights)
    space, scaler = with_weights(build(), weights), scaler_of(tensors, "motion")
    return Judge(space, scaler, tuple(words), card_of(metadata))
