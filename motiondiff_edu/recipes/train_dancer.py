"""Train a recipe into a dancer: songs, dances, windows, card. A killed run continues where it was
saved last."""

from functools import lru_cache
from pathlib import Path

import torch

from .._files import digest_of_tensors
from ..baselines.regression import regression_loss
from ..beyond.schedules import shifted
from ..conditions.music import log_mel
from ..ddpm import Schedule, cosine_schedule
from ..performers.dance_windows import DanceWindows, dance_loss
from ..performers.dancer import Dancer, network
from ..training import LossFn
from .dancers import DanceRecipe
from .train_recipe import train_recipe


def training_windows(recipe: DanceRecipe) -> DanceWindows:
    """The recipe's data, made from its seed: songs, dances to each, and the Mel spectrograms.

    Recipes in a row that want the same data share it: it takes minutes to make.
    """
    if recipe.motions:
        return _unheard(recipe.motions, recipe.data_seed, recipe.seconds, recipe.frames)
    return _made(recipe.songs, recipe.data_seed, recipe.seconds, recipe.dances, recipe.frames)


@lru_cache(maxsize=1)
def _made(songs: int, seed: int, seconds: float, each: int, frames: int) -> DanceWindows:
    from data_synth.dancing import dances  # data_synth lies beside the package, and imports it

    positions = []
    contacts = []
    mels = []
    heard = None
    for song, danced in dances(songs, seed, seconds, each=each):
        if song is not heard:
            heard, mel = song, log_mel(torch.from_numpy(song.audio).float())
        positions.append(danced.positions)
        contacts.append(danced.contacts)
        mels.append(mel)
    return DanceWindows.of(positions, contacts, mels, frames)


@lru_cache(maxsize=1)
def _unheard(count: int, seed: int, seconds: float, frames: int) -> DanceWindows:
    from data_synth.mixed import motions

    positions, contacts = zip(*motions(count, seed, seconds), strict=True)
    return DanceWindows.of(positions, contacts, None, frames)


def train_dancer(
    recipe: DanceRecipe, run_file: Path, windows: DanceWindows | None = None, log=print
) -> Dancer:
    """Train (or continue) a recipe; `run_file` holds the run.  Returns the averaged network as a
    dancer.

    Raises ValueError when the run in `run_file` was begun with other settings.
    """
    config, windows = recipe.config, training_windows(recipe) if windows is None else windows
    schedule = schedule_of(recipe)
    torch.manual_seed(recipe.seed)
    model = network(config)
    trained, card = train_recipe(
        recipe,
        run_file,
        model,
        loss_of(recipe, windows, schedule),
        about={"network": type(model).__name__, "data": digest(windows)},
        facts={"windows": len(windows)},
        data=f"data_synth.{'mixed' if recipe.motions else 'music and data_synth.dance'}, synthetic",
        warmup=300,
        log=log,
    )
    return Dancer(trained, schedule, windows.motion_scaler, windows.mel_scaler, card)


def schedule_of(recipe: DanceRecipe) -> Schedule:
    """The cosine schedule, shifted as the recipe says."""
    return shifted(cosine_schedule(recipe.config.S), recipe.snr)


def loss_of(recipe: DanceRecipe, windows: DanceWindows, schedule: Schedule) -> LossFn:
    """The loss that a recipe asks for: MoFusion's, or the regression's where the network is
    deterministic."""
    if getattr(recipe.config, "deterministic", False):
        return regression_loss(windows, batch=recipe.batch, shake=recipe.shake)
    return dance_loss(windows, schedule, recipe.kinematic, **recipe.loss_settings)


def digest(windows: DanceWindows) -> str:
    """Of dances, music, and how windows are cut from them: a run goes on with what it was begun
    with, or not at all."""
    some = torch.linspace(0, len(windows) - 1, min(len(windows), 100)).long()
    motion, mel, stands = windows.take(some)
    parts = {
        "dances": windows.dances,
        "mel": windows.mel,
        "starts": windows.starts,
        "songs": windows.song_starts,
    }
    return digest_of_tensors(parts | {"motion": motion, "heard": mel, "stands": stands})[:16]
