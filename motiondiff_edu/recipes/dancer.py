"""How dancers are made: songs, dances, windows, MoFusion's loss with a recipe's departures.

The paper gives no widths, no steps and no weights of its losses, so all numbers are ours. A killed
run continues from its last save.
Notebook: 13
"""

from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import Tensor

from .._files import digest_of_tensors
from ..baselines.transformer import HearingTransformerConfig, regression_loss
from ..beyond.classifier_free import without
from ..beyond.loss_terms import changes, toe_changes, total
from ..ddpm import Schedule, cosine_schedule, squared_error
from ..kinematic_loss import KinematicWeights, training_loss, weight_by_step
from ..metrics.bodies import bone_lengths
from ..mofusion import MOFUSION_FULL, MOFUSION_SMALL
from ..motion import dance_frame
from ..performers.dance_windows import DanceWindows, toes_moved
from ..performers.dancer import Dancer
from ..performers.hearing_mofusion import HearingConfig
from ..performers.networks import Config, network
from ..training import LossFn
from .ear import EAR, EarRecipe, TrainedEar, ear_of
from .mofusion import KINEMATIC, MoFusionRecipe
from .songs import songs_as_mel
from .training import Provenance, on_device, train_recipe


# ---- recipes -------------------------------------------------------------------------------------
@dataclass(frozen=True)
class DanceRecipe(MoFusionRecipe):
    """The sizes and rates of one training run of a dancer.

    The data are `songs` songs of `seconds` each with `dances` dances each, or, for a network
    without music (C = 0), as many walks and dances; all are mirrored, too.
    `ear`: the recipe of an ear that is trained first; none for a network without one.
    Raises ValueError for a regression that is to dance without music, too (it has one dance only),
    and for an ear that does not fit the network.
    """

    config: Config  # of a network for dancers (`performers.networks`)
    # after 2,000 steps heavier ones made dances worse, bones too (docs/RESULTS.md)
    kinematic: KinematicWeights | None = replace(KINEMATIC, skeleton=30.0, asymmetry=0.4)
    no_music: float = 0.0  # share of the music left out: `beyond.classifier_free`
    frames: int = 100  # per window
    batch: int = 32
    songs: int = 1500
    seconds: float = 20.0
    dances: int = 2  # per song
    ear: EarRecipe | None = None

    def __post_init__(self):
        super().__post_init__()
        if self.no_music and getattr(self.config, "deterministic", False):
            raise ValueError("no_music: a regression cannot be guided, so it always has its music")
        own = getattr(self.config, "ear", None)
        given = self.ear.config if self.ear else None
        if given and own != given:
            wanted = f"an ear with {own}" if own else "no ear: pass ear=None"
            raise ValueError(f"{self.name}: its network has {wanted}; the ear given has {given}")


HEARING = HearingConfig(target="x0", skip=False)
DANCER = DanceRecipe("dancer", HEARING, steps=8_000, no_music=0.15, ear=EAR)
DANCER_PLAIN = replace(DANCER, name="dancer-plain", kinematic=None)
REGRESSED = replace(
    DANCER_PLAIN,
    name="regression",
    config=HearingTransformerConfig(deterministic=True),
    steps=3000,
    changes=0.0,
    toes=0.0,
    no_music=0.0,
)
# never trained: it needs a GPU
FULL = replace(HEARING, widths=MOFUSION_FULL.widths, heads=MOFUSION_FULL.heads)
DANCER_FULL = replace(DANCER, name="dancer-full", config=FULL, steps=200_000, batch=64)
UNCONDITIONAL = DanceRecipe(
    "unconditional", replace(MOFUSION_SMALL, target="x0", skip=False, C=0), steps=6000, songs=3000
)

SHIPPED_DANCERS = (DANCER, DANCER_PLAIN, REGRESSED, UNCONDITIONAL)
DANCE_RECIPES = {recipe.name: recipe for recipe in (*SHIPPED_DANCERS, DANCER_FULL)}


# ---- training ------------------------------------------------------------------------------------
ONE_BODY = 0.1  # cm: bones that differ by less are the same


def training_windows(recipe: DanceRecipe) -> DanceWindows:
    """The recipe's data, generated from its seed: songs, dances, and Mel spectrograms.

    The last data set is kept, because it takes minutes to generate.
    """
    seeds = recipe.data_seed, recipe.seconds
    if recipe.config.C:
        return _song_windows(recipe.songs, *seeds, recipe.dances, recipe.frames)
    return _motion_windows(recipe.songs, *seeds, recipe.frames)


@lru_cache(maxsize=1)
def _song_windows(songs: int, seed: int, seconds: float, each: int, frames: int) -> DanceWindows:
    from data_synth.dancing.performance import DANCES_A_SEED, dances_to

    made = songs_as_mel(songs, seed, seconds)
    danced = [one for _, one in dances_to([song for song, _ in made], seed * DANCES_A_SEED, each)]
    return DanceWindows.of(
        [one.positions for one in danced],
        [one.contacts for one in danced],
        [mel for _, mel in made for _ in range(each)],
        frames,
    )


@lru_cache(maxsize=1)
def _motion_windows(count: int, seed: int, seconds: float, frames: int) -> DanceWindows:
    from data_synth.mixed import motions

    positions, contacts = zip(*motions(count, seed, seconds), strict=True)
    return DanceWindows.of(positions, contacts, None, frames)


def train_dancer(
    recipe: DanceRecipe,
    run_file: Path,
    windows: DanceWindows | None = None,
    log=print,
    ear: TrainedEar | None = None,
    device: str | None = None,
) -> Dancer:
    """Train by a recipe, or continue the run in `run_file`; return a dancer with averaged weights.

    `device`: as in `training.on_device`.
    `ear`: a trained one for a recipe with an ear; without it, one is trained first.
    Raises ValueError when the run in `run_file` was begun with other settings, or `ear` is not of
    the recipe's kind.
    """
    own = getattr(recipe.config, "ear", None)
    if ear and own != ear.ear.config:
        needs = f"needs an ear with {own}" if own else "has no ear"
        raise ValueError(f"{recipe.name} {needs}; the ear that is given has {ear.ear.config}")
    if own and not (ear or recipe.ear):
        raise ValueError(f"{recipe.name} needs an ear: pass `ear`, or a recipe with one")
    made_of = "music.varied and data_synth.dancing" if recipe.config.C else "mixed"
    source = f"data_synth.{made_of}, synthetic" if windows is None else "given windows"
    windows = training_windows(recipe) if windows is None else windows
    schedule = cosine_schedule(recipe.config.S)
    torch.manual_seed(recipe.seed)
    model = network(recipe.config)
    about = {"network": type(model).__name__, "data": digest(windows)}
    facts: dict[str, Any] = {"windows": len(windows)} | bones_of(windows)
    if own:
        if ear is None:
            assert recipe.ear  # checked above
            ear = ear_of(recipe.ear, run_file.parent, log, device)
        model.ear.load_state_dict(ear.hearing(windows.mel_scaler).state_dict())
        about["ear"] = digest_of_tensors(ear.ear.state_dict())[:16]
        facts["ear"] = ear.card
    trained, card = train_recipe(
        recipe,
        run_file,
        on_device(model, device),
        loss_of(recipe, windows, schedule),
        Provenance(about, facts, source),
        warmup=300,
        log=log,
    )
    return Dancer(trained, schedule, windows.motion_scaler, windows.mel_scaler, card)


def bones_of(windows: DanceWindows) -> dict[str, list[float]]:
    """The lengths of the bones in cm, for the card, if all dances have the same body."""
    lengths = 100 * bone_lengths(windows.dances.numpy())
    typical = np.median(lengths, axis=0)
    same = np.abs(lengths - typical).max() < ONE_BODY
    return {"bones_cm": typical.round(3).tolist()} if same else {}


def loss_of(recipe: DanceRecipe, windows: DanceWindows, schedule: Schedule) -> LossFn:
    """Eq. 4 of dances and their music, which is left out now and then.

    A regression has a loss of its own.
    Source: MoFusion eq. 4; the other terms are ours.
    """
    if getattr(recipe.config, "deterministic", False):
        return regression_loss_of(recipe, windows)
    scaler, weights = windows.motion_scaler, recipe.kinematic
    data = total(squared_error, changes(recipe.changes))
    if recipe.toes:
        moved = toes_moved(windows)
        data = total(data, toe_changes(recipe.toes, dance_frame.moves, scaler.std, moved))
    lambda_k = weight_by_step(schedule, weights.over_time) if weights else None

    def loss_fn(model: Any, generator: torch.Generator) -> Tensor:
        device = next(model.parameters()).device
        x0, mel, planted = (part.to(device) for part in windows.draw(recipe.batch, generator))
        music = model.listen(mel, windows.mel_times.to(device)) if model.config.C else None
        if music is not None and recipe.no_music:
            left_out = torch.rand(len(mel), generator=generator) < recipe.no_music
            music = without(music, left_out.to(device))
        kinematic = None
        if weights:
            kinematic = weights.loss_for(dance_frame.body_of(scaler.to(device)), planted)
        return training_loss(
            model, (x0, music), schedule, generator,
            kinematic=kinematic, lambda_k=lambda_k, loss=data,
        )  # fmt: skip

    return loss_fn


def regression_loss_of(recipe: DanceRecipe, windows: DanceWindows) -> LossFn:
    """The loss of a regression, which gets neither noise nor a step."""

    def loss_fn(model: Any, generator: torch.Generator) -> Tensor:
        device = next(model.parameters()).device
        x0, mel, _ = windows.draw(recipe.batch, generator)
        times = windows.mel_times.to(device)
        return regression_loss(model, x0.to(device), mel.to(device), times)

    return loss_fn


def digest(windows: DanceWindows) -> str:
    """A checksum of dances, music, and window starts.

    A run can only be resumed with the data that it was begun with.
    """
    some = torch.linspace(0, len(windows) - 1, min(len(windows), 100)).long()
    motion, mel, stands = windows.take(some)
    parts = {
        "dances": windows.dances,
        "mel": windows.mel,
        "starts": windows.starts,
        "songs": windows.song_starts,
    }
    return digest_of_tensors(parts | {"motion": motion, "heard": mel, "stands": stands})[:16]
