"""A training run on disk: everything it consists of, so that a killed run continues bit for bit.

Safetensors: reading one runs no code. Written to a temporary name and renamed, so a kill leaves the old file.
"""

import json
import os
from collections.abc import Callable
from pathlib import Path

import torch
from safetensors import safe_open
from safetensors.torch import save_file

from .training import TrainState


def saver(path: str | Path) -> Callable[[TrainState], Path]:
    """A `save` for `training.train_steps`: writes the run to this file."""
    return lambda state: save_run(state, path)


def save_run(state: TrainState, path: str | Path) -> Path:
    """Write weights, their average, Adam's moments, both random generators and the step number."""
    tensors = {f"model.{k}": v for k, v in state.model.state_dict().items()}
    tensors |= {f"average.{k}": v for k, v in state.average.state_dict().items()}
    for i, moments in state.optimizer.state_dict()["state"].items():
        tensors |= {f"adam.{i}.{k}": v for k, v in moments.items()}
    tensors |= {"random.generator": state.generator.get_state(), "random.torch": torch.get_rng_state()}
    temporary = f"{path}.part"
    save_file({k: v.contiguous().clone() for k, v in tensors.items()}, temporary, {"step": json.dumps(state.step)})
    os.replace(temporary, path)
    return Path(path)


def resume_run(state: TrainState, path: str | Path) -> TrainState:
    """Bring `state` to where the run at `path` was; of another model, load_state_dict says what differs."""
    with safe_open(path, "pt") as file:
        tensors = {name: file.get_tensor(name) for name in file.keys()}
        state.step = json.loads(file.metadata()["step"])
    parts: dict[str, dict] = {}
    for name, tensor in tensors.items():
        part, key = name.split(".", 1)
        parts.setdefault(part, {})[key] = tensor
    state.model.load_state_dict(parts["model"])
    state.average.load_state_dict(parts["average"])
    adam: dict[int, dict] = {}
    for name, tensor in parts.get("adam", {}).items():
        index, key = name.split(".")
        adam.setdefault(int(index), {})[key] = tensor
    state.optimizer.load_state_dict(state.optimizer.state_dict() | {"state": adam})
    state.generator.set_state(parts["random"]["generator"])
    torch.set_rng_state(parts["random"]["torch"])
    return state
