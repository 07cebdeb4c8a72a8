"""Two ways to be wrong about a sentence: a bag of its words, and one motion for each text.

A bag of words keeps which words there are, and loses their order: "waves, then kicks" and "kicks,
then waves" are the same bag. The regression is not shown any noise, so a text has one motion, and
the squared error makes it the mean of all right ones.
Both are trained, saved and used as a mover is.
"""

from dataclasses import dataclass

from jaxtyping import Bool, Float, Int
from torch import Tensor, nn

from ..conditions.word_encoder import FIRST, PADDING, present
from ..mofusion import Memory
from ..performers.networks import register
from ..performers.text_mofusion import TextMoFusion, TextMoFusionConfig


@dataclass(frozen=True)
class BagConfig(TextMoFusionConfig):
    """The sizes of `TextMoFusionConfig`."""


@dataclass(frozen=True)
class RegressionConfig(TextMoFusionConfig):
    """The sizes of `TextMoFusionConfig`."""


def bag(tokens: Float[Tensor, "B M C"], there: Bool[Tensor, "B M"]) -> Float[Tensor, "B C"]:
    """The mean of the tokens that are there: it knows the words, and not their order."""
    return (tokens * there[..., None]).sum(1) / there.sum(1, keepdim=True)


class BagOfWords(nn.Module):
    """Ids of words to one token, the mean of their embeddings."""

    def __init__(self, words: int, width: int):
        super().__init__()
        self.embed = nn.Embedding(FIRST + words, width, padding_idx=PADDING)
        wide = 2 * width
        self.mix = nn.Sequential(nn.Linear(width, wide), nn.GELU(), nn.Linear(wide, width))

    def tokens_of(
        self, ids: Int[Tensor, "B M"]
    ) -> tuple[Float[Tensor, "B 1 C"], Bool[Tensor, "B 1"]]:
        """The one token of each text; its mask is always True."""
        there = present(ids)
        return self.mix(bag(self.embed(ids), there))[:, None], there.any(1, keepdim=True)


class BagMoFusion(TextMoFusion):
    """MoFusion from a bag of words."""

    def __init__(self, config: BagConfig):
        super().__init__(config, BagOfWords(len(config.words), config.C))


class TextRegression(TextMoFusion):
    """MoFusion's network without the diffusion: it never sees x_s or s."""

    def decode(
        self, x_s: Float[Tensor, "B T D"], s: Int[Tensor, "B"], memory: Memory
    ) -> Float[Tensor, "B T D"]:
        return super().decode(x_s.new_zeros(x_s.shape), s.new_zeros(s.shape), memory)


register("mover", BagMoFusion, BagConfig)
register("mover", TextRegression, RegressionConfig)
