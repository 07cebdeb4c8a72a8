"""The paper's own way to read a text: the tokens of CLIP's text transformer, which stays frozen.

    "walks ahead"  ->  <start> walks ahead <end>  ->  one row of E numbers for each of them

The rows are the states after the last layer norm, and not the one vector that CLIP compares with
pictures. CLIP has seen the words of the whole web, so no word is refused. Its weights are in no
file of ours: they come from a folder, or from where `transformers` keeps what it has downloaded.
Nothing is downloaded unless you ask for it: `load(name, download=True)`, once. What a network adds
is an MLP (`ClipEncoder`), which is trained and saved with it.
Source: MoFusion 3.3, "we project the token embeddings using an MLP" (its sizes are ours); Radford
and others, 2021.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import torch
from jaxtyping import Bool, Float, Int
from torch import Tensor, nn
from torch.nn.utils.rnn import pad_sequence

from .._files import home
from .text import Read, TextError, empty


@dataclass(frozen=True, eq=False)
class ClipTokens:
    """Texts as CLIP's transformer leaves them, padded to the longest.

    `mask` is True where there is a token. CLIP puts a mark before and after a text, so the empty
    text has two.
    """

    hidden: Float[Tensor, "B M E"]
    mask: Bool[Tensor, "B M"]

    def __len__(self) -> int:
        return len(self.mask)

    def to(self, device: str | torch.device) -> "ClipTokens":
        """The same tokens on another device."""
        return ClipTokens(self.hidden.to(device), self.mask.to(device))


class ClipEncoder(nn.Module):
    """Tokens of CLIP (B, M, E) to tokens (B, M, C); each is projected by itself."""

    def __init__(self, clip_width: int, width: int):
        super().__init__()
        self.mlp = nn.Sequential(
            nn.Linear(clip_width, 2 * width), nn.GELU(), nn.Linear(2 * width, width)
        )

    def forward(self, texts: ClipTokens) -> Float[Tensor, "B M C"]:
        return self.mlp(texts.hidden)

    def tokens_of(self, texts: ClipTokens) -> tuple[Float[Tensor, "B M C"], Bool[Tensor, "B M"]]:
        """The tokens of texts, and where there is one."""
        return self(texts), texts.mask


NAME = "openai/clip-vit-base-patch32"  # the usual one; the paper does not say which
WIDTH = 512  # of its tokens
EXTRA = 'CLIP needs the package transformers: pip install "motiondiff_edu[clip]"'
MOST_LAYERS = 100  # the largest CLIP has 32
BATCH = 128  # texts that are encoded together
TOLD_APART_BY = "a person waves"
ALIKE = 0.02  # numbers of `sample`: two machines differ by a thousandth of this


class NoTransformers(ImportError):
    """The extra is not installed; the message says how."""


class ClipError(OSError):
    """There is no such CLIP here, or not this one; the message says what to do."""


@dataclass(frozen=True, eq=False)
class ClipModel:
    """CLIP's text transformer, frozen, and the tokenizer that goes with it."""

    name: str
    model: Any  # a CLIPTextModel and a CLIPTokenizer of transformers
    tokenizer: Any

    @property
    def width(self) -> int:
        """E, the width of a token."""
        return self.model.config.hidden_size

    @property
    def longest(self) -> int:
        """The number of tokens that it can read, with the marks before and after a text."""
        return self.model.config.max_position_embeddings

    def read(self, text: str) -> Read:
        """The whole text as one "word"; every word is known.

        Raises TextError for an empty text and for one that is too long.
        """
        if not text.strip():
            raise empty("is empty")
        self.ids([text])
        return Read(text.strip(), (text.strip(),))

    def encoded(self, texts: Sequence[tuple[str, ...]]) -> ClipTokens:
        """What a network takes of texts that were read; () is the empty text."""
        return self.tokens([" ".join(text) for text in texts])

    def tokens(self, texts: Sequence[str]) -> ClipTokens:
        """The tokens of texts. Those of one text do not depend on the others.

        Raises TextError for a text that is too long.
        """
        different = list(dict.fromkeys(texts))
        found = dict(zip(different, self._hidden(different), strict=True))
        rows = [found[text] for text in texts]
        counts = torch.tensor([len(row) for row in rows])
        hidden = pad_sequence(rows, batch_first=True)
        return ClipTokens(hidden, torch.arange(hidden.shape[1]) < counts[:, None])

    def table(self, texts: Sequence[str]) -> "ClipTable":
        """The tokens of many texts, encoded once, for a training."""
        rows = self._hidden(texts, torch.float16)
        counts = torch.tensor([len(row) for row in rows])
        return ClipTable(torch.cat(rows), counts.cumsum(0) - counts, counts)

    def sample(self) -> list[float]:
        """Eight numbers of one token of a fixed sentence, which differ from CLIP to CLIP."""
        return [round(x, 4) for x in self.tokens([TOLD_APART_BY]).hidden[0, -1, :8].tolist()]

    def ids(self, texts: Sequence[str]) -> list[list[int]]:
        """The tokenizer's ids of each text, with both marks.

        Raises TextError for a text that is too long, or that is no valid Unicode.
        """
        for text in texts:
            if not _encodes(text):
                raise TextError(f"the text {text!r:.60} is no valid Unicode: type it again")
        found = self.tokenizer(list(texts), truncation=False, padding=False, verbose=False)
        for text, ids in zip(texts, found.input_ids, strict=True):
            if len(ids) > self.longest:
                raise TextError(
                    f"the text {text.strip()!r:.40}... has {len(ids)} tokens, with the marks before"
                    f" and after it; CLIP reads {self.longest} at most: say it in fewer words"
                )
        return found.input_ids

    @torch.no_grad()
    def _hidden(
        self, texts: Sequence[str], dtype: torch.dtype = torch.float32
    ) -> list[Float[Tensor, "_ E"]]:
        """The states of each text after the last layer norm; texts of like length go together.

        The attention is causal, so a token never sees the padding after it.
        """
        ids = [torch.tensor(row) for row in self.ids(texts)]
        by_length = sorted(range(len(ids)), key=lambda k: len(ids[k]))
        found = [torch.empty(0)] * len(ids)
        for start in range(0, len(ids), BATCH):
            chosen = by_length[start : start + BATCH]
            padded = pad_sequence([ids[k] for k in chosen], batch_first=True)
            hidden = self.model(padded.to(self.model.device)).last_hidden_state
            for k, row in zip(chosen, hidden.to("cpu", dtype), strict=True):
                found[k] = row[: len(ids[k])]
        return found


@dataclass(frozen=True, eq=False)
class ClipTable:
    """The tokens of many texts, one after another; a row number gets those of its text.

    They are kept as float16, because a training has tens of thousands of captions.
    """

    rows: Float[Tensor, "R E"]
    first: Int[Tensor, "N"]
    counts: Int[Tensor, "N"]

    def __getitem__(self, texts: Int[Tensor, "B"]) -> ClipTokens:
        """The tokens of the texts with these numbers, padded to the longest of them."""
        counts = self.counts[texts]
        places = torch.arange(int(counts.max()))
        mask = places < counts[:, None]
        where = (self.first[texts][:, None] + places).where(mask, 0)
        return ClipTokens(self.rows[where].float() * mask[..., None], mask)


def load(where: str | Path = NAME, download: bool = False) -> ClipModel:
    """A CLIP of `transformers`: a folder, or the name that it has on the Hugging Face hub.

    By its name it is looked for on this machine; with `download` it is fetched if it is not here.
    Raises NoTransformers without the extra, and ClipError for what is missing or is no CLIP.
    """
    try:
        from transformers import CLIPTextConfig, CLIPTextModel, CLIPTokenizer
    except ImportError as error:
        raise NoTransformers(EXTRA) from error
    folder = home(where)
    fetch = download and not folder.is_dir()
    place = folder if folder.is_dir() else where if fetch else _kept(str(where))
    if place is None:
        raise ClipError(
            f"there is no folder {where}, and no CLIP of that name has been downloaded. Give the "
            "folder of a CLIP, or download it once: python -c 'from motiondiff_edu.conditions "
            f'import clip; clip.load("{where}", download=True)\''
        )
    try:
        with _quiet():
            if isinstance(place, Path) and not _fits(CLIPTextConfig.from_pretrained(place), place):
                raise ValueError("config.json asks for more weights than the files have")
            loaded: Any = CLIPTextModel.from_pretrained(
                place, dtype=torch.float32, output_loading_info=True, local_files_only=not fetch
            )
            model, found = loaded
            tokenizer = CLIPTokenizer.from_pretrained(place, local_files_only=not fetch)
    except Exception as error:  # transformers raises whatever its readers of files raise
        what = "could not be downloaded" if fetch else "has no CLIP that can be used"
        told = next(iter(str(error).splitlines()), type(error).__name__)
        raise ClipError(f"{place} {what} ({told})") from error
    if found["missing_keys"]:
        raise ClipError(f"{place} is no CLIP: it lacks {sorted(found['missing_keys'])[0]}")
    # without its files the tokenizer is made all the same, and knows its marks alone
    if not 3 < len(tokenizer) <= model.config.vocab_size:
        raise ClipError(
            f"{place} has no tokenizer that fits: it knows {len(tokenizer)} tokens, the transformer"
            f" {model.config.vocab_size}; it needs tokenizer.json, or vocab.json and merges.txt"
        )
    return ClipModel(str(where), model.eval().requires_grad_(False), tokenizer)


def check(clip: ClipModel, width: int, sample: Sequence[float] | None = None) -> None:
    """Raise ClipError unless it is the CLIP that a network was trained with.

    That has tokens of this width, and this `sample`, where it is known.
    """
    if clip.width != width:
        raise ClipError(
            f"{clip.name} has tokens of {clip.width} numbers; the network was trained with another "
            f"CLIP, which has {width}"
        )
    apart = [abs(a - b) for a, b in zip(sample or (), clip.sample() if sample else (), strict=True)]
    if not all(one <= ALIKE for one in apart):  # NaN is neither near nor far
        raise ClipError(
            f"{clip.name} gives other tokens than the CLIP that the network was trained with; give "
            "that one"
        )


def _fits(config: Any, folder: Path) -> bool:
    """Whether the files of a folder are large enough for the weights that a config asks for."""
    width, layers = config.hidden_size, config.num_hidden_layers
    weights = layers * (4 * width**2 + 2 * width * config.intermediate_size)
    weights += (config.vocab_size + config.max_position_embeddings) * width
    return 0 < layers <= MOST_LAYERS and weights <= sum(x.stat().st_size for x in folder.iterdir())


def _kept(name: str) -> Path | None:
    """The folder of a CLIP that was downloaded under this name, or None.

    Given the name itself, `transformers` uses the network even for files that are here.
    """
    from huggingface_hub import try_to_load_from_cache

    try:
        kept = try_to_load_from_cache(name, "config.json")
    except ValueError:  # not a name of the hub
        return None
    return Path(kept).parent if isinstance(kept, str) else None


def _encodes(text: str) -> bool:
    try:
        text.encode()
    except UnicodeEncodeError:
        return False
    return True


@contextmanager
def _quiet() -> Iterator[None]:
    """Without the bars and reports of `transformers`; that a CLIP also has an eye is no news."""
    from transformers.utils import logging

    level, bars = logging.get_verbosity(), logging.is_progress_bar_enabled()
    logging.set_verbosity_error()
    logging.disable_progress_bar()
    try:
        yield
    finally:
        logging.set_verbosity(level)
        if bars:
            logging.enable_progress_bar()
