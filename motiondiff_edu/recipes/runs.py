"""A training run on disk: everything it consists of, so that a killed run continues bit for bit.

Safetensors: reading one runs no code. Written to a temporary name and renamed, so a kill leaves the
old file.
"""

import json
from pathlib import Path

import torch
from safetensors import SafetensorError, safe_open
from safetensors.torch import save_file

from .._files import digest_of_tensors, replacing
from ..training import Saving, TrainState


def saver(
    path: str | Path, about: dict | None = None, notes: list | None = None, every: int = 1000
) -> Saving:
    """A `save` for `training.train_steps`: writes the run to this file every so many steps.

    `about` and `notes` as in save_run.
    """
    return Saving(lambda state: save_run(state, path, about, notes), every)


def save_run(
    state: TrainState, path: str | Path, about: dict | None = None, notes: list | None = None
) -> Path:
    """Write all of a run: weights, optimizer, random generators, step and seconds.

    The weights' average and the optimizer's moments are among them.

    `about` is what the run must be resumed with; `notes` are for the reader (see notes_of).
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
    """Bring `state` to where the run at `path` was.

    Of another model, load_state_dict says what differs.

    Raises ValueError when the file is damaged or no saved run, when another optimizer made it, or
    when the run is about something else than `about` (its settings, say): continued, it would be
    neither the one nor the other.
    """
    try:
        with safe_open(path, "pt") as file:
            tensors = {name: file.get_tensor(name) for name in file.keys()}
            counts = file.metadata() or {}
    except (SafetensorError, OSError) as error:
        raise ValueError(
            f"{path} cannot be resumed: damaged, or no safetensors file ({error}); delete it"
        ) from error
    if counts.get("sha256", "") != digest_of_tensors(tensors) and "step" in counts:
        raise ValueError(
            f"{path} cannot be resumed: damaged, "
            "its tensors are not those that were saved; delete it"
        )
    parts: dict[str, dict] = {}
    for name, tensor in tensors.items():
        part, _, key = name.partition(".")
        parts.setdefault(part, {})[key] = tensor
    missing = {"model", "average", "random"} - set(parts) or {"step"} - set(counts)
    if missing:
        raise ValueError(
            f"{path} is no saved run: it has no {sorted(missing)[0]}; "
            "give another file, or delete it"
        )
    _same(about, json.loads(counts.get("about", "null")), path)
    kind = json.loads(counts.get("optimizer", "null"))
    if kind != _kind(state):
        raise ValueError(
            f"{path} was trained by {kind}, not by {_kind(state)}: use that one, or delete the file"
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
    """The notes that a run was saved with; none when there is no such run."""
    if not Path(path).is_file():
        return []
    with safe_open(path, "pt") as file:
        return json.loads((file.metadata() or {}).get("notes", "[]"))


def _kind(state: TrainState) -> str:
    """Whose moments these are: the moments of one optimizer mean nothing to another."""
    return type(state.optimizer).__name__


def _same(asked: dict | None, found: dict | None, path: str | Path) -> None:
    """Compare what a run should be about with what it is about."""
    asked = json.loads(json.dumps(asked))  # as the file has it: lists for tuples
    if asked is None or asked == found:
        return
    found = found or {}
    name = next(key for key in [*asked, *found] if asked.get(key) != found.get(key))
    raise ValueError(
        f"{path} was begun with {name} = {found.get(name)!r}, and {asked.get(name)!r} is asked "
        "for: delete the file to start anew, or ask for what it was begun with"
    )
