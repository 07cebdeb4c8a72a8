"""Train a recipe into a dancer: songs, dances, windows, loop, card. A killed run continues where it was saved last."""

from dataclasses import asdict
from pathlib import Path

import torch

from ..baselines.regression import regression_loss
from ..conditions.music import log_mel
from ..dance_windows import DanceWindows, dance_loss
from ..dancer import Dancer, network
from ..ddpm import cosine_schedule
from ..files import digest_of_tensors
from ..muon import optimizer_for
from ..runs import notes_of, resume_run, saver
from ..training import TrainState, cosine_lr
from .dance_recipes import DanceRecipe
from .train import mean_loss, run_to_end, where


def training_windows(recipe: DanceRecipe) -> DanceWindows:
    """The recipe's data, made from its seed: songs, a dance to each, and the Mel spectrograms."""
    from data_synth.dance import dance  # data_synth lies beside the package, and imports it
    from data_synth.music import songs

    dances, contacts, mels = [], [], []
    for k, song in enumerate(songs(recipe.songs, recipe.data_seed, recipe.seconds)):
        danced = dance(song, recipe.data_seed * 100_000 + k)
        dances.append(danced.positions)
        contacts.append(danced.contacts)
        mels.append(log_mel(torch.from_numpy(song.audio).float()))
    return DanceWindows.of(dances, contacts, mels, recipe.frames)


def train_dancer(recipe: DanceRecipe, run_file: Path, windows: DanceWindows | None = None, log=print) -> Dancer:
    """Train (or continue) a recipe; `run_file` holds the run.  Returns the averaged network as a dancer.

    Raises ValueError when the run in `run_file` was begun with other settings.
    """
    torch.manual_seed(recipe.seed)
    windows = windows or training_windows(recipe)
    schedule = cosine_schedule(recipe.config.S)
    device = "cuda" if torch.cuda.is_available() else "cpu"
    model = network(recipe.config).to(device)
    about = asdict(recipe) | {"network": type(model).__name__, "data": digest(windows)}
    state = TrainState.start(model, recipe.seed, optimizer_for(model, recipe.optimizer))
    if run_file.exists():
        resume_run(state, run_file, about)
        log(f"{recipe.name}: continuing at step {state.step}")
    sittings = notes_of(run_file)
    if state.step < recipe.steps:
        sittings = [*sittings, {"from_step": state.step, **where(device)}]
    if getattr(recipe.config, "deterministic", False):
        loss_fn = regression_loss(windows, batch=recipe.batch)
    else:
        loss_fn = dance_loss(windows, schedule, recipe.kinematic, **recipe.loss_settings)
    rate = cosine_lr(recipe.lr, recipe.steps, warmup=min(300, recipe.steps // 4))
    run_to_end(recipe.name, recipe, rate, state, loss_fn, saver(run_file, about, sittings), log)
    card = card_of(recipe, windows, state, sittings)
    card["final_loss"] = round(mean_loss(loss_fn, state.average), 6)
    return Dancer(state.average.cpu().eval(), schedule, windows.motion_scaler, windows.mel_scaler, card)


def digest(windows: DanceWindows) -> str:
    """Of motion and music as the network sees them: a run goes on with the data it was begun with, or not at all."""
    return digest_of_tensors({"motion": windows.motion, "mel": windows.mel})[:16]


def card_of(recipe: DanceRecipe, windows: DanceWindows, state: TrainState, sittings: list[dict]) -> dict:
    """What a reader of the weights wants to know; `make results` adds the measured figures."""
    settings = {k: v for k, v in asdict(recipe).items() if k not in ("config", "name")}
    return {
        "name": recipe.name,
        "target": recipe.config.target,
        "recipe": settings,
        "parameters": sum(p.numel() for p in state.model.parameters()),
        "windows": len(windows.motion),
        "minutes": round(state.seconds / 60, 1),
        "sittings": sittings,
        "data": "data_synth.music and data_synth.dance, synthetic",
    }
