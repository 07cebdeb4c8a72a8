"""Training data of a mover: whole motions with their captions, mirrored with their words.

A batch holds motions of one length, so nothing is padded, and it has about as many frames whatever
the length is. Source: MoFusion 4.2 (motions and texts; lengths and batches are ours).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Bool, Float, Int
from torch import Tensor
from torch.nn.functional import pad

from ..conditions.text import read
from ..conditions.word_encoder import NOTHING, PADDING, ids_of
from ..motion.moving_frame import mirrored, to_features
from ..motion.scaler import Scaler

GRID = 8  # frames: lengths are cut to multiples of it
OTHER = {"left": "right", "right": "left"}
Batch = tuple[Float[Tensor, "B T 66"], Int[Tensor, "B M"], Bool[Tensor, "B T 2"]]


@dataclass(frozen=True, eq=False)
class DescribedWindows:
    """Motions by length, standardised when drawn, each with the ids of its captions.

    `motions[n]` and `contacts[n]` hold all motions of n frames; `captions[n]` their captions as ids
    (K, W, M).
    """

    motions: dict[int, Float[Tensor, "K T 66"]]
    contacts: dict[int, Bool[Tensor, "K T 2"]]
    captions: dict[int, Int[Tensor, "K W M"]]
    exchanged: Int[Tensor, "V"]  # the id of each word with left and right exchanged
    scaler: Scaler
    words: tuple[str, ...]

    @classmethod
    def of(
        cls,
        positions: Sequence[Float[np.ndarray, "_ 21 3"]],
        contacts: Sequence[Bool[np.ndarray, "_ 2"]],
        captions: Sequence[Sequence[str]],
        words: tuple[str, ...],
    ) -> "DescribedWindows":
        """Motions (metres, world); each has as many captions.

        Raises ValueError for lists of different lengths, and TextError for unknown words.
        """
        texts = [[read(text, words, {}).words for text in each] for each in captions]
        longest = max(len(text) for each in texts for text in each)
        groups: dict[int, list[tuple]] = {}
        for moved, stands, each in zip(positions, contacts, texts, strict=True):
            n = len(moved) // GRID * GRID
            ids = ids_of(each, words)
            ids = pad(ids, (0, longest - ids.shape[1]), value=PADDING)
            features = torch.from_numpy(to_features(moved[:n])).float()
            groups.setdefault(n, []).append((features, torch.from_numpy(stands[:n].copy()), ids))
        columns = {
            n: [torch.stack(x) for x in zip(*rows, strict=True)] for n, rows in groups.items()
        }
        motions, planted, ids = ({n: x[k] for n, x in columns.items()} for k in range(3))
        some = torch.cat([x[:: max(1, len(x) // 64)].flatten(0, 1) for x in motions.values()])
        swap = {word: OTHER.get(word, word) for word in words}
        exchanged = torch.tensor(
            [PADDING, NOTHING, *ids_of([tuple(swap[word] for word in words)], words)[0].tolist()]
        )
        return cls(motions, planted, ids, exchanged, Scaler.fit(some), words)

    def __len__(self) -> int:
        return sum(map(len, self.motions.values()))

    def draw(self, frames: int, generator: torch.Generator) -> Batch:
        """A random batch of about `frames` frames: motions, captions, and which feet are planted.

        Every motion is as likely as another, and half of them are mirrored, with their words.
        """
        return self.take(self.choose(frames, generator))

    def choose(self, frames: int, generator: torch.Generator) -> "Chosen":
        """What a random batch is made of."""
        lengths = sorted(self.motions)
        weights = torch.tensor([len(self.motions[n]) * n for n in lengths], dtype=torch.float64)
        n = lengths[int(torch.multinomial(weights, 1, generator=generator))]
        batch = max(1, frames // n)
        return Chosen(
            n,
            torch.randint(len(self.motions[n]), (batch,), generator=generator),
            torch.randint(self.captions[n].shape[1], (batch,), generator=generator),
            torch.rand(batch, generator=generator) < 0.5,
        )

    def take(self, chosen: "Chosen") -> Batch:
        """The motions, captions and planted feet that were chosen."""
        n, turned = chosen.length, chosen.turned
        x, planted = self.motions[n][chosen.which], self.contacts[n][chosen.which]
        ids = self.captions[n][chosen.which, chosen.wording]
        x = torch.where(turned[:, None, None], mirrored(x), x)
        planted = planted.where(~turned[:, None, None], planted.flip(-1))
        ids = torch.where(turned[:, None], self.exchanged[ids], ids)
        ids = ids[:, : int((ids != PADDING).sum(1).max())]
        return self.scaler.transform(x), ids, planted


@dataclass(frozen=True, eq=False)
class Chosen:
    """A batch of motions of one length: which ones, by which caption, and which are mirrored."""

    length: int
    which: Int[Tensor, "B"]
    wording: Int[Tensor, "B"]
    turned: Bool[Tensor, "B"]
