"""Training data of a mover: whole motions with their captions, mirrored with their words.

A batch holds motions of one length, so nothing is padded, and it has about as many frames whatever
the length is. Source: MoFusion 4.2 (motions and texts; lengths and batches are ours).
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import torch
from jaxtyping import Bool, Float, Int
from torch import Tensor

from ..beyond import timeline
from ..conditions.text import read_words
from ..conditions.word_encoder import NOTHING, PADDING, ids_of
from ..motion.moving_frame import D, mirror_features, to_features
from ..motion.scaler import Scaler

GRID = 8  # frames: lengths are cut to multiples of it
OTHER = {"left": "right", "right": "left"}
Batch = tuple[Float[Tensor, "B T F"], Int[Tensor, "B M"], Bool[Tensor, "B T 2"]]


@dataclass(frozen=True, eq=False)
class DescribedWindows:
    """Motions by length, standardised when drawn, each with the ids of its captions.

    `motions[n]` and `contacts[n]` hold all motions of n frames; `captions[n]` their captions as ids
    (K, W, M) of `words`. A motion has the 66 columns of `motion/moving_frame.py`, and behind them
    those of a timeline, if there are any (`beyond/timeline.py`). For a network that reads by CLIP
    each whole caption is one such "word".
    """

    motions: dict[int, Float[Tensor, "K T F"]]
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
        timelines: Sequence[Float[np.ndarray, "_ 24"]] | None = None,
    ) -> "DescribedWindows":
        """Motions (metres, world); each has as many captions, and a timeline as long as it is.

        Raises ValueError for lists of different lengths, and TextError for unknown words.
        """
        texts = [[read_words(text, words, {}).words for text in each] for each in captions]
        return cls._of(positions, contacts, texts, words, timelines)

    @classmethod
    def of_texts(
        cls,
        positions: Sequence[Float[np.ndarray, "_ 21 3"]],
        contacts: Sequence[Bool[np.ndarray, "_ 2"]],
        captions: Sequence[Sequence[str]],
        timelines: Sequence[Float[np.ndarray, "_ 24"]] | None = None,
    ) -> "DescribedWindows":
        """The same for CLIP, with captions in any words; `words` are the captions,
        and those with left and right exchanged.

        Raises ValueError for lists of different lengths.
        """
        texts = [[(text,) for text in each] for each in captions]
        given = {text for each in captions for text in each}
        once = given | set(map(exchanged_sides, given))
        both = once | set(map(exchanged_sides, once))  # "Left" becomes "right", and that "left"
        return cls._of(positions, contacts, texts, tuple(sorted(both)), timelines)

    @classmethod
    def _of(
        cls,
        positions: Sequence[Float[np.ndarray, "_ 21 3"]],
        contacts: Sequence[Bool[np.ndarray, "_ 2"]],
        texts: Sequence[Sequence[tuple[str, ...]]],
        words: tuple[str, ...],
        timelines: Sequence[Float[np.ndarray, "_ 24"]] | None,
    ) -> "DescribedWindows":
        every = ids_of([text for each in texts for text in each], words)
        of_each = every.split([len(each) for each in texts])
        groups: dict[int, list[tuple]] = {}
        beside = timelines or [np.zeros((len(moved), 0)) for moved in positions]
        for k, (moved, acts, stands, ids) in enumerate(
            zip(positions, beside, contacts, of_each, strict=True)
        ):
            n = len(moved) // GRID * GRID
            if not n:
                raise ValueError(f"motion {k} has {len(moved)} frames, and {GRID} are needed")
            columns = np.concatenate([to_features(moved[:n]), acts[:n]], -1)
            features = torch.from_numpy(columns).float()
            groups.setdefault(n, []).append((features, torch.from_numpy(stands[:n].copy()), ids))
        columns = {
            n: [torch.stack(x) for x in zip(*rows, strict=True)] for n, rows in groups.items()
        }
        motions, planted, ids = ({n: x[k] for n, x in columns.items()} for k in range(3))
        some = torch.cat([x[:: max(1, len(x) // 64)].flatten(0, 1) for x in motions.values()])
        mirrored_words = ids_of([tuple(map(exchanged_sides, words))], words)[0]
        exchanged = torch.tensor([PADDING, NOTHING, *mirrored_words.tolist()])
        return cls(motions, planted, ids, exchanged, with_even_timeline(Scaler.fit(some)), words)

    def without_timeline(self) -> "DescribedWindows":
        """The same clips as motions alone."""
        motions = {n: x[..., :D].contiguous() for n, x in self.motions.items()}
        return replace(self, motions=motions, scaler=self.scaler.part(slice(D)))

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
        other = torch.cat([mirror_features(x[..., :D]), timeline.mirrored(x[..., D:])], -1)
        x = torch.where(turned[:, None, None], other, x)
        planted = planted.where(~turned[:, None, None], planted.flip(-1))
        ids = torch.where(turned[:, None], self.exchanged[ids], ids)
        ids = ids[:, : int((ids != PADDING).sum(1).max())]
        return self.scaler.transform(x), ids, planted


def with_even_timeline(scaler: Scaler) -> Scaler:
    """The scaler with one spread for all columns of the timeline: rare verbs count alike."""
    std = scaler.std.clone()
    std[D:] = timeline.SPREAD
    return Scaler(scaler.mean, std)


def exchanged_sides(text: str) -> str:
    """A text with the words left and right exchanged, as the mirrored motion needs it."""
    return re.sub(r"\b(left|right)\b", lambda found: OTHER[found[0].lower()], text, flags=re.I)


@dataclass(frozen=True, eq=False)
class Chosen:
    """A batch of motions of one length: which ones, by which caption, and which are mirrored."""

    length: int
    which: Int[Tensor, "B"]
    wording: Int[Tensor, "B"]
    turned: Bool[Tensor, "B"]
