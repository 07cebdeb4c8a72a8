"""What all trainings of a recipe share: the run on disk, the sittings, the loop, the card."""

import datetime
import platform
import subprocess
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Protocol, runtime_checkable

import numpy as np
import torch
from torch import nn

from ..training import LossFn, TrainState, cosine_lr, train_steps
from .muon import optimizer_for
from .runs import notes_of, resume_run, saver

LOG_EVERY, SAVE_EVERY = 30.0, 300.0  # seconds of training


@runtime_checkable
class AnyRecipe(Protocol):
    """What every recipe says of its training: a frozen dataclass with the network's `config`."""

    name: str
    config: object
    steps: int
    lr: float
    optimizer: str
    decay: float
    seed: int


@dataclass(frozen=True)
class Provenance:
    """What a run begins with besides its recipe, and what its card says of it."""

    about: dict[str, str]  # which network, which data; resuming requires equal values
    facts: dict  # entries of the card: how many windows, which control
    data: str  # where the data are from, for the card


def train_recipe(
    recipe: AnyRecipe,
    run_file: Path,
    model: nn.Module,
    loss_fn: LossFn,
    provenance: Provenance,
    *,
    warmup: int,
    log: Callable[[str], object],
    before: Callable[[int], object] | None = None,
) -> tuple[nn.Module, dict]:
    """Train (or continue) a fresh network; `run_file` holds the run.

    It is trained where it is (`on_device`). Returns the averaged network, on the CPU, and its card.

    `warmup`: steps in which the rate rises, at most a quarter of all.
    `before`: as in `train_steps`.
    Raises ValueError when the run in `run_file` was begun with other settings.
    """
    device = next(model.parameters()).device.type
    optimizer = optimizer_for(model, recipe.optimizer)
    state = TrainState.start(model, recipe.seed, optimizer, recipe.decay)
    about = asdict(recipe) | provenance.about
    if run_file.exists():
        resume_run(state, run_file, about)
        log(f"{recipe.name}: continuing at step {state.step}")
    sittings = notes_of(run_file)
    if state.step < recipe.steps:
        sittings = [*sittings, {"from_step": state.step, **where(device)}]
    rate = cosine_lr(recipe.lr, recipe.steps, warmup=min(warmup, recipe.steps // 4))
    save = saver(run_file, about, sittings, SAVE_EVERY)
    run_to_end(recipe, rate, state, loss_fn, save, log, before)
    if before:  # the final loss is that of the end, also of a run that had nothing to do
        before(state.step)
    card = {
        "name": recipe.name,
        "target": recipe.config.target,
        "recipe": {k: v for k, v in asdict(recipe).items() if k not in ("config", "name")},
        "parameters": sum(p.numel() for p in state.model.parameters()),
        **provenance.facts,
        "minutes": round(state.seconds / 60, 1),
        "sittings": sittings,
        "data": provenance.data,
        "final_loss": final_loss(recipe, loss_fn, state.average),
    }  # `make results` adds what it measures
    return state.average.cpu().eval(), card


def on_device(model: nn.Module, device: str | None) -> nn.Module:
    """The network where it is trained: by default on a GPU, if there is one."""
    return model.to(device or ("cuda" if torch.cuda.is_available() else "cpu"))


def run_to_end(
    recipe: AnyRecipe,
    rate,
    state: TrainState,
    loss_fn: LossFn,
    save,
    log,
    before=None,
) -> None:
    """Train to the last step, with a line of log every LOG_EVERY seconds, and at the end."""
    losses, logged = [], state.seconds
    how = {"lr": rate, "save": save, "before": before, "progress": False}
    for report in train_steps(state, loss_fn, recipe.steps, **how):
        losses.append(report.loss)
        if state.seconds - logged >= LOG_EVERY or report.step == recipe.steps:
            mean, minutes = np.mean(losses), state.seconds / 60
            log(f"{recipe.name} {report.step}/{recipe.steps}: loss {mean:.5f}, {minutes:.1f} min")
            losses, logged = [], state.seconds


def final_loss(recipe: AnyRecipe, loss_fn: LossFn, network: nn.Module) -> float:
    """The mean loss over 50 batches, or over as many as a shorter training had."""
    return round(mean_loss(loss_fn, network, min(50, recipe.steps)), 6)


@torch.no_grad()
def mean_loss(loss_fn: LossFn, network: nn.Module, batches: int) -> float:
    """The mean loss of a network over `batches`, which are drawn with seed 1."""
    generator = torch.Generator().manual_seed(1)
    return float(np.mean([loss_fn(network, generator).item() for _ in range(batches)]))


def commit_of(folder: Path) -> str:
    """The commit of the checkout whose top `folder` is, "-dirty" when files differ from it."""
    if not (
        folder / ".git"
    ).exists():  # a package installed within somebody's own repository has no commit of ours
        return "not in a checkout"
    command = ["git", "-C", str(folder), "describe", "--always", "--dirty"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError:  # no git here
        return "unknown"
    return done.stdout.strip() or "not in a checkout"


def where(device: str) -> dict:
    """The code and the machine of one sitting."""
    return {
        "commit": commit_of(Path(__file__).parents[2]),
        "date": datetime.date.today().isoformat(),
        "machine": torch.cuda.get_device_name() if device == "cuda" else platform.machine(),
        "threads": torch.get_num_threads(),
        "torch": torch.__version__,
    }
