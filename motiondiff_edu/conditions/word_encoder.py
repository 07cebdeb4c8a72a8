"""Words to tokens: an embedding for each word; a small transformer lets each see the others.

So "left" in "kicks with the left foot" knows what is left, and "waves, then kicks" differs from
"kicks, then waves", which a bag of words cannot tell apart.
Source: MoFusion 3.3, which has the tokens of CLIP here (`conditions/clip.py`); these are ours,
trained with the motions.
Notebook: 16
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import torch
from jaxtyping import Bool, Float, Int
from torch import Tensor, nn

from .acts import PLAIN, in_words
from .sentences import Understood, understand
from .text import Read, TextError, lemma, read_words

# ids
PADDING = 0  # of no word
NOTHING = 1  # of the empty text
FIRST = 2  # of the first known word


class WordEncoder(nn.Module):
    """Ids of words (B, M) to tokens (B, M, C); id 0 is padding, which no word sees."""

    def __init__(self, words: int, width: int, layers: int, heads: int, longest: int):
        super().__init__()
        self.embed = nn.Embedding(FIRST + words, width, padding_idx=PADDING)
        self.place = nn.Embedding(longest, width)
        layer = nn.TransformerEncoderLayer(
            width, heads, 2 * width, dropout=0.1, activation="gelu", batch_first=True,
            norm_first=True,
        )  # fmt: skip
        self.layers = nn.TransformerEncoder(layer, layers, enable_nested_tensor=False)
        self.norm = nn.LayerNorm(width)

    def forward(self, ids: Int[Tensor, "B M"]) -> Float[Tensor, "B M C"]:
        places = torch.arange(ids.shape[1], device=ids.device)
        h = self.embed(ids) + self.place(places)
        return self.norm(self.layers(h, src_key_padding_mask=~present(ids)))

    def tokens_of(
        self, ids: Int[Tensor, "B M"]
    ) -> tuple[Float[Tensor, "B M C"], Bool[Tensor, "B M"]]:
        """The tokens of texts, and where there is one."""
        return self(ids), present(ids)


def present(ids: Int[Tensor, "B M"]) -> Bool[Tensor, "B M"]:
    """True where there is a word, and for the empty text its one token."""
    return ids != PADDING


def ids_of(texts: list[tuple[str, ...]], vocabulary: tuple[str, ...]) -> Int[Tensor, "B M"]:
    """The ids of texts that were read (`text.read_words`), padded to the longest.

    () is the empty text. Raises KeyError for a word that is not in the vocabulary.
    """
    index = {word: FIRST + k for k, word in enumerate(vocabulary)}
    rows = [[index[word] for word in text] or [NOTHING] for text in texts]
    longest = max(map(len, rows))
    return torch.tensor([row + [PADDING] * (longest - len(row)) for row in rows])


@cache
def knows_all_acts(vocabulary: tuple[str, ...]) -> bool:
    """Whether a network has a word for each act that the grammar knows."""
    known = frozenset(vocabulary)
    return all(lemma(phrase.split()[0], known) in known for phrase, _ in PLAIN.values())


@dataclass(frozen=True)
class WordReader:
    """How a network with a vocabulary reads; `clip.ClipModel` has the same two methods."""

    words: tuple[str, ...]

    def read(self, text: str) -> Read:
        """The words of a text.

        A sentence that the grammar understands is said in the plain words of the training.
        Raises TextError as `text.read_words`, and for a sentence in which it understands no act.
        """
        found = understand(text) if isinstance(text, str) else Understood(())
        if not found.parts:
            words = read_words(text, self.words)
            if knows_all_acts(self.words):
                why = "; ".join(found.notes) or "no act is understood"
                raise TextError(f"{text.strip()!r:.80} names no act: {why}")
            return words
        try:
            plain = read_words(in_words(found.parts), self.words, {})
        except TextError:  # a network with other words
            return read_words(text, self.words)
        return Read(text.strip(), plain.words, (*found.notes, *plain.notes), found.parts)

    def encoded(self, texts: Sequence[tuple[str, ...]]) -> Int[Tensor, "B M"]:
        """What the network takes of texts that were read; () is the empty text."""
        return ids_of(list(texts), self.words)
