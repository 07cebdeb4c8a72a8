"""The recipe of an ear: songs alone, heard otherwise each time.

Notebook: 12
"""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import torch
from jaxtyping import Float
from torch import Tensor, nn
from torch.nn import functional as F

from .._files import digest_of_tensors
from ..beyond.gain_noise import gain_noise
from ..beyond.hearing import Otherwise, between, heard_otherwise, on_circles, speeds
from ..conditions.music import frame_times
from ..performers.ear import Ear, EarConfig, Said
from ..training import LossFn
from .songs import HeardSongs, training_songs
from .train_recipe import Provenance, train_recipe


@dataclass(frozen=True)
class EarRecipe:
    """One training run of an ear, on `songs` songs of `seconds` each."""

    name: str = "ear"
    config: EarConfig = EarConfig()
    steps: int = 10_000
    frames: tuple[int, ...] = (128, 160, 224)  # Mel frames of a piece; one of these for each batch
    gain_noise: float = 0.3  # `beyond.gain_noise`
    lr: float = 2e-3
    optimizer: str = "muon"
    batch: int = 32
    decay: float = 0.999
    songs: int = 1500
    seconds: float = 20.0
    data_seed: int = 1
    seed: int = 0
    save_every: int = 250  # steps


EAR = EarRecipe()
WEIGHTS = {"beat": 1.0, "bar": 0.5, "sounds": 0.2, "genre": 0.2}  # of the parts of the loss


@cache
def songs_of(songs: int, seed: int, seconds: float) -> HeardSongs:
    """The songs of a recipe, generated from its seed; they are kept, since it takes minutes."""
    return HeardSongs.of(training_songs(songs, seed, seconds))


def piece(
    recipe: EarRecipe, songs: HeardSongs, generator: torch.Generator
) -> tuple[Float[Tensor, "B M C"], Float[Tensor, "B M 2"], Tensor]:
    """A random batch: Mel frames heard otherwise, their counts, and the genres."""
    from data_synth.music.tempi import FAR_FROM_HELD_OUT

    how = Otherwise()
    lengths = recipe.frames
    M = lengths[int(torch.randint(len(lengths), (1,), generator=generator))]
    chosen = torch.randint(len(songs), (recipe.batch,), generator=generator)
    most, share = how.faster
    speed = speeds(songs.tempi[chosen], FAR_FROM_HELD_OUT, most, generator)
    own = torch.rand(len(chosen), generator=generator) >= share
    longest = (songs.mel.shape[1] - 1) / (M - 1)  # faster than that, the song would end before
    speed = speed.where(~own, 1.0).clamp(max=longest)
    first = torch.rand(len(chosen), generator=generator) * (
        songs.mel.shape[1] - 1 - speed * (M - 1)
    )
    at = first[:, None] + speed[:, None] * torch.arange(M)
    mel = heard_otherwise(between(songs.mel[chosen], at), how, generator)
    mel = gain_noise(mel, recipe.gain_noise, generator)
    return mel, between(songs.counts[chosen], at), songs.genres[chosen]


def hearing_loss(
    said: Said, counts: Float[Tensor, "B M 2"], genres: Tensor
) -> dict[str, Float[Tensor, ""]]:
    """The parts of the loss: squared errors of places, cross-entropies of beat or none, and genre.

    counts  beats and bars at the tokens (`beyond.hearing.counts`); NaN where there is no beat
    """
    known = ~counts.isnan().any(-1)
    right = on_circles(counts)
    share = known.float().mean().clamp_min(1e-6)

    def error(one: Tensor, other: Tensor) -> Tensor:
        return ((one - other).square().sum(-1) * known).mean() / share

    of_genre = F.cross_entropy(said.genre.mean(1), genres)
    return {
        "beat": error(said.beat, right[..., :2]),
        "bar": error(said.bar, right[..., 2:]),
        "sounds": F.binary_cross_entropy_with_logits(said.sounds, known.float()),
        "genre": of_genre,
    }


def loss_of_ear(recipe: EarRecipe, songs: HeardSongs) -> LossFn:
    """The weighted loss of a batch."""

    def loss_fn(model: nn.Module, generator: torch.Generator) -> Tensor:
        device = next(model.parameters()).device
        mel, counts, genres = (x.to(device) for x in piece(recipe, songs, generator))
        times = frame_times(mel.shape[1]).float().to(device)
        said = model.says(model(mel, times))
        parts = hearing_loss(said, counts[:, :: model.stride], genres)
        return sum(WEIGHTS[name] * part for name, part in parts.items())

    return loss_fn


def train_ear(recipe: EarRecipe, run_file: Path, songs: HeardSongs | None = None, log=print) -> Ear:
    """Train by a recipe, or continue the run in `run_file`; return the averaged ear.

    Raises ValueError when the run in `run_file` was begun with other settings.
    """
    if songs is None:
        songs = songs_of(recipe.songs, recipe.data_seed, recipe.seconds)
    torch.manual_seed(recipe.seed)
    some = {"mel": songs.mel[::100], "counts": songs.counts[::100].nan_to_num()}
    about = {"network": "Ear", "data": digest_of_tensors(some)[:16]}
    trained, _ = train_recipe(
        recipe,
        run_file,
        Ear(recipe.config),
        loss_of_ear(recipe, songs),
        Provenance(about, {"songs": len(songs)}, "data_synth.music, synthetic"),
        warmup=300,
        log=log,
    )
    return trained
