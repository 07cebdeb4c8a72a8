"""The recipe of an ear: songs alone, augmented in another way each time.

Ours; see `beyond.hearing`.
"""

from dataclasses import dataclass
from functools import reduce
from pathlib import Path
from typing import Any

import torch
from jaxtyping import Float
from torch import Tensor
from torch.nn import functional as F

from .._files import digest_of_tensors, digest_of_texts
from ..beyond.hearing import (
    MelAugmentation,
    augmented,
    gain_noise,
    interpolated_rows,
    on_circles,
    tempo_factors,
)
from ..conditions.music import frame_times
from ..motion.scaler import Scaler
from ..performers.ear import Ear, EarConfig, EarOutput, rescale_ear
from ..performers.hearing_mofusion import WithEar
from ..training import LossFn
from .songs import HeardSongs, songs_as_mel
from .training import Provenance, Recipe, on_device, train_recipe


@dataclass(frozen=True)
class EarRecipe(Recipe):
    """One training run of an ear, on `songs` songs of `seconds` each."""

    name: str = "ear"
    config: EarConfig = EarConfig()
    steps: int = 10_000
    frames: tuple[int, ...] = (128, 160, 224)  # Mel frames of a piece; one of these for each batch
    gain_noise: float = 0.3  # `beyond.hearing.gain_noise`
    lr: float = 2e-3
    batch: int = 32
    songs: int = 1500
    seconds: float = 20.0


EAR = EarRecipe()
WEIGHTS = {"beat": 1.0, "bar": 0.5, "sounds": 0.2, "genre": 0.2}  # of the parts of the loss


def drawn_batch(
    recipe: EarRecipe, songs: HeardSongs, generator: torch.Generator
) -> tuple[Float[Tensor, "B M C"], Float[Tensor, "B M 2"], Tensor]:
    """A random batch: augmented Mel frames, their counts, and the genres."""
    from data_synth.music.tempi import FAR_FROM_HELD_OUT

    how = MelAugmentation()
    lengths = recipe.frames
    M = lengths[int(torch.randint(len(lengths), (1,), generator=generator))]
    chosen = torch.randint(len(songs), (recipe.batch,), generator=generator)
    most, share = how.faster
    last = songs.mel.shape[1] - 1
    limits = 1 / most, min(most, last / (M - 1))  # played faster than that, the song is too short
    speed = tempo_factors(songs.tempi[chosen], FAR_FROM_HELD_OUT, limits, generator)
    own = torch.rand(len(chosen), generator=generator) >= share
    speed = speed.where(~own, 1.0)
    first = torch.rand(len(chosen), generator=generator) * (last - speed * (M - 1))
    at = first[:, None] + speed[:, None] * torch.arange(M)
    mel = augmented(interpolated_rows(songs.mel[chosen], at), how, generator)
    mel = gain_noise(mel, recipe.gain_noise, generator)
    return mel, interpolated_rows(songs.counts[chosen], at), songs.genres[chosen]


def hearing_loss(
    said: EarOutput, counts: Float[Tensor, "B M 2"], genres: Tensor
) -> dict[str, Float[Tensor, ""]]:
    """The parts of the loss: squared errors of places, cross-entropies of beat or none, and genre.

    counts  beats and bars at the tokens (`beyond.hearing.beat_counts`); NaN where there is no beat
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

    def loss_fn(model: Any, generator: torch.Generator) -> Tensor:
        device = next(model.parameters()).device
        mel, counts, genres = (x.to(device) for x in drawn_batch(recipe, songs, generator))
        times = frame_times(mel.shape[1]).float().to(device)
        said = model.read(model(mel, times))
        parts = hearing_loss(said, counts[:, :: model.stride], genres)
        return reduce(torch.add, (WEIGHTS[name] * part for name, part in parts.items()))

    return loss_fn


@dataclass(frozen=True, eq=False)
class TrainedEar:
    """An ear with averaged weights, the scaler of its Mel frames, and what its training took."""

    ear: Ear
    scaler: Scaler
    card: dict

    def hearing(self, scaler: Scaler) -> Ear:
        """The ear for Mel frames that are standardised by another scaler."""
        return rescale_ear(self.ear, self.scaler, scaler)


def ear_within(dancer: Any) -> TrainedEar:
    """The ear of a trained dancer, for other dancers: an ear takes longer to train than a dancer.

    Raises ValueError for a dancer without an ear, and another performer.
    """
    if not isinstance(dancer.model, WithEar):
        raise ValueError(f"{type(dancer.model).__name__} has no ear that another dancer could use")
    card = dancer.card.get("ear", {}) | {"taken_over": True}
    return TrainedEar(dancer.model.ear, dancer.mel_scaler, card)


def ear_of(recipe: EarRecipe, folder: Path, log=print, device: str | None = None) -> TrainedEar:
    """The ear of a recipe, trained first if that was not done.

    Its run lies in the folder, where all dancers with this ear find it.
    """
    made_of = digest_of_texts({"recipe": repr(recipe)})[:8]
    return train_ear(recipe, folder / f"ear-{made_of}.run.safetensors", log=log, device=device)


def train_ear(
    recipe: EarRecipe,
    run_file: Path,
    songs: HeardSongs | None = None,
    log=print,
    device: str | None = None,
) -> TrainedEar:
    """Train by a recipe, or continue the run in `run_file`.

    Raises ValueError for songs that are shorter than a piece, and when the run in `run_file` was
    begun with other settings.
    """
    if songs is None:
        songs = HeardSongs.of(songs_as_mel(recipe.songs, recipe.data_seed, recipe.seconds))
    if songs.mel.shape[1] < max(recipe.frames):
        raise ValueError(
            f"ear: songs of {recipe.seconds:g} s have {songs.mel.shape[1]} Mel frames; pieces of "
            f"{max(recipe.frames)} need more"
        )
    torch.manual_seed(recipe.seed)
    facts = {"mel": songs.mel.mean(1), "counts": songs.counts[:, ::16].nan_to_num()}
    facts |= {"tempi": songs.tempi, "genres": songs.genres}
    about = {"network": "Ear", "data": digest_of_tensors(facts)[:16]}
    trained, card = train_recipe(
        recipe,
        run_file,
        on_device(Ear(recipe.config), device),
        loss_of_ear(recipe, songs),
        Provenance(about, {"songs": len(songs)}, "data_synth.music, synthetic"),
        warmup=300,
        log=log,
    )
    kept = ("parameters", "songs", "minutes", "final_loss")
    return TrainedEar(trained, songs.scaler, {name: card[name] for name in kept})
