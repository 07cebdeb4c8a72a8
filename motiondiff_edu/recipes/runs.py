"""A training run on disk, with its whole state: a killed run continues bit for bit.

The file is safetensors, so reading it runs no code. It is written under a temporary name and then
renamed, so a kill during writing leaves the old file.
"""

import json
from pathlib import Path

import torch
from safetensors import SafetensorError, safe_open
from safetensors.torch import save_file

from .._files import digest_of_tensors, replacing
from ..training import Saving, TrainState


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
    counts = {
        "step": state.step,
        "seconds": state.seconds,
        "about": about,
        "optimizer": _kind(state),
    }
    counts["notes"] = notes or []
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
