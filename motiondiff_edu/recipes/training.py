"""What all recipes share: the loop, the sittings, the card, and the run on disk.

The run on disk is its whole state, so a killed run continues bit for bit. Its file is safetensors,
so reading it runs no code. It is written under a temporary name and then renamed, so a kill during
writing leaves the old file.
"""

import datetime
import json
import platform
import subprocess
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch
from safetensors import SafetensorError, safe_open
from safetensors.torch import save_file
from torch import nn

from .._files import digest_of_tensors, replacing
from ..training import LossFn, Saving, TrainState, cosine_lr, train_steps
from .muon import optimizer_for

# ---- the loop and the card -----------------------------------------------------------------------
LOG_EVERY, SAVE_EVERY = 30.0, 300.0  # seconds of training


OPTIMIZERS = ("muon", "adam")


@dataclass(frozen=True)
class Recipe:
    """What every recipe says: the network's sizes, and the steps, rate and seeds of its training.

    Raises ValueError for an unknown optimizer.
    """

    name: str
    config: Any  # of the network
    steps: int
    lr: float = 3e-3
    optimizer: str = "muon"  # or "adam"
    decay: float = 0.999  # of the averaged weights
    data_seed: int = 1
    seed: int = 0

    def __post_init__(self):
        if self.optimizer not in OPTIMIZERS:
            raise ValueError(f"optimizer must be {' or '.join(OPTIMIZERS)}, not {self.optimizer!r}")


@dataclass(frozen=True)
class Provenance:
    """What a run begins with besides its recipe, and what its card says of it."""

    about: dict[str, str]  # which network, which data; resuming requires equal values
    facts: dict  # entries of the card: how many windows, which control
    data: str  # where the data are from, for the card


def train_recipe(
    recipe: Recipe,
    run_file: Path,
    model: nn.Module,
    loss_fn: LossFn,
    provenance: Provenance,
    *,
    warmup: int,
    log: Callable[[str], object],
    before: Callable[[int], object] | None = None,
) -> tuple[Any, dict]:
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
    recipe: Recipe, rate, state: TrainState, loss_fn: LossFn, save, log, before=None
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


def final_loss(recipe: Recipe, loss_fn: LossFn, network: nn.Module) -> float:
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


# ---- the run on disk -----------------------------------------------------------------------------
def saver(
    path: str | Path, about: dict | None = None, notes: list | None = None, every: float = 300.0
) -> Saving:
    """A `Saving` for `training.train_steps` that writes the run to this file.

    `about` and `notes` are as in `save_run`; `every` counts seconds of training.
    """
    return Saving(lambda state: save_run(state, path, about, notes), every)


def save_run(
    state: TrainState, path: str | Path, about: dict | None = None, notes: list | None = None
) -> Path:
    """Write the whole run: weights, their average, optimizer, random generators, step and seconds.

    `about` (the settings) must be the same when the run is resumed. `notes` are for the reader (see
    `notes_of`).
    """
    tensors = {f"model.{k}": v for k, v in state.model.state_dict().items()}
    tensors |= {f"average.{k}": v for k, v in state.average.state_dict().items()}
    for i, moments in state.optimizer.state_dict()["state"].items():
        tensors |= {f"moments.{i}.{k}": v for k, v in moments.items()}
    tensors |= {
        "random.generator": state.generator.get_state(),
        "random.torch": torch.get_rng_state(),
    }
    if torch.cuda.is_available():
        tensors["random.cuda"] = torch.cuda.get_rng_state()
    counts: dict[str, Any] = {"step": state.step, "seconds": state.seconds, "about": about}
    counts |= {"optimizer": _kind(state), "notes": notes or []}
    tensors = {k: v.detach().cpu().contiguous().clone() for k, v in tensors.items()}
    counts = {name: json.dumps(value) for name, value in counts.items()} | {
        "sha256": digest_of_tensors(tensors)
    }
    with replacing(path) as aside:
        save_file(tensors, aside, counts)
    return Path(path)


def resume_run(state: TrainState, path: str | Path, about: dict | None = None) -> TrainState:
    """Load the saved run at `path` into `state`.

    Torch's global generators become those of the run, too, for whatever else draws from them.
    Raises ValueError if the file is damaged or not a saved run, if another optimizer made it, or if
    its `about` differs: the continued run would then mix two settings. For another model,
    load_state_dict raises RuntimeError with the differences.
    """
    try:
        with safe_open(path, "pt") as file:
            tensors = {name: file.get_tensor(name) for name in file.keys()}
            counts = file.metadata() or {}
    except (SafetensorError, OSError) as error:
        raise ValueError(
            f"{path} cannot be resumed: damaged, or not a safetensors file ({error}); delete it"
        ) from error
    if counts.get("sha256", "") != digest_of_tensors(tensors) and "step" in counts:
        raise ValueError(
            f"{path} cannot be resumed: damaged, its tensors do not match their checksum; delete it"
        )
    parts: dict[str, dict] = {}
    for name, tensor in tensors.items():
        part, _, key = name.partition(".")
        parts.setdefault(part, {})[key] = tensor
    missing = {"model", "average", "random"} - set(parts) or {"step"} - set(counts)
    if missing:
        raise ValueError(
            f"{path} is not a saved run: it has no {sorted(missing)[0]}; "
            "give another file, or delete it"
        )
    _check_about(about, json.loads(counts.get("about", "null")), path)
    kind = json.loads(counts.get("optimizer", "null"))
    if kind != _kind(state):
        raise ValueError(
            f"{path} was trained by {kind}, not by {_kind(state)}: use {kind}, or delete the file"
        )
    state.model.load_state_dict(parts["model"])
    state.average.load_state_dict(parts["average"])
    moments: dict[int, dict] = {}
    for name, tensor in parts.get("moments", {}).items():
        index, key = name.split(".")
        moments.setdefault(int(index), {})[key] = tensor
    state.optimizer.load_state_dict(state.optimizer.state_dict() | {"state": moments})
    state.step = json.loads(counts["step"])
    state.seconds = json.loads(counts.get("seconds", "0"))
    state.generator.set_state(parts["random"]["generator"])
    torch.set_rng_state(parts["random"]["torch"])
    if "cuda" in parts["random"] and torch.cuda.is_available():
        torch.cuda.set_rng_state(parts["random"]["cuda"])
    return state


def notes_of(path: str | Path) -> list:
    """The notes that a run was saved with; an empty list if the run does not exist."""
    if not Path(path).is_file():
        return []
    with safe_open(path, "pt") as file:
        return json.loads((file.metadata() or {}).get("notes", "[]"))


def _kind(state: TrainState) -> str:
    """The kind of optimizer; the moments of one kind do not fit another."""
    return type(state.optimizer).__name__


def _check_about(wanted: dict | None, found: dict | None, path: str | Path) -> None:
    """Raise ValueError if the settings of a saved run differ from the wanted ones."""
    wanted = json.loads(json.dumps(wanted))  # as in the file: lists for tuples
    if wanted is None or wanted == found:
        return
    found = found or {}
    none = object()  # a setting can be None, and another one missing
    name = next(key for key in [*wanted, *found] if wanted.get(key, none) != found.get(key, none))
    raise ValueError(
        f"{path} was begun with {name} = {found.get(name)!r}, not {wanted.get(name)!r}: "
        "delete the file to start again, or use the settings that it was begun with"
    )
