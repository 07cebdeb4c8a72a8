"""Weights on disk: safetensors (no code in them) with a card that says what they are and how they were made.

A damaged or foreign file is refused with the reason.  Notebook: 00, 07
"""

import json
import os
from dataclasses import fields
from pathlib import Path

import torch
from safetensors import SafetensorError, safe_open
from safetensors.torch import save_file
from torch import Tensor

from .ddpm import make_schedule
from .files import digest_of_tensors, digest_of_texts, replacing
from .foothold import FootholdConfig, network
from .modiff import MoDiffConfig
from .motion.scaler import Scaler
from .walker import Walker

FORMAT = "motiondiff_edu walker 2"
FOLDER = Path(__file__).parent / "pretrained"
NETWORKS = {"MoDiff": MoDiffConfig, "FootholdMoDiff": FootholdConfig}  # by the name of the class


class CheckpointError(ValueError):
    """A weights file that cannot be used, with the reason and what to do."""


def save_walker(walker: Walker, path: str | Path, half: bool = True) -> Path:
    """Write a walker: weights (float16 unless half=False), scalers, schedule, card. A card.json is laid beside it.

    Written to a temporary name and renamed.  Notebook: 07
    """
    path = Path(path)
    weights = {f"model.{k}": v.half() if half else v for k, v in walker.model.state_dict().items()}
    scalers = {"pose": walker.pose_scaler, "control": walker.control_scaler}
    weights |= {f"{name}.{part}": getattr(s, part) for name, s in scalers.items() for part in ("mean", "std")}
    weights["schedule.beta"] = walker.schedule.beta[1:]
    config = json.dumps(walker.config.as_dict())
    metadata = {"format": FORMAT, "network": type(walker.model).__name__, "config": config}
    metadata |= {"schedule": walker.schedule.name, "card": json.dumps(walker.card)}
    weights = {k: v.detach().cpu().clone().contiguous() for k, v in weights.items()}
    with replacing(path) as aside:
        save_file(weights, aside, metadata | _digests(weights, metadata))
        os.chmod(aside, 0o644)  # safetensors writes for its owner alone; weights are for everybody
    with replacing(path.with_suffix(".json")) as aside:
        aside.write_text(json.dumps(walker.card | {"config": walker.config.as_dict()}, indent=1) + "\n")
    return path


def load_walker(path: str | Path) -> Walker:
    """Read a walker.  Raises CheckpointError for a file that is missing, damaged, or not one of ours."""
    path = Path(path)
    if not path.is_file():
        raise CheckpointError(f"there is no weights file {path}")
    try:
        with safe_open(path, "pt") as file:
            metadata, tensors = file.metadata() or {}, {name: file.get_tensor(name) for name in file.keys()}
    except (SafetensorError, OSError, ValueError) as error:
        raise CheckpointError(f"{path.name} is damaged or is no safetensors file ({error}); fetch it again") from error
    if metadata.get("format") != FORMAT:
        raise CheckpointError(f"{path.name} is no walker of this project ({_looks_like(tensors)})")
    for what, digest in _digests(tensors, metadata).items():
        if metadata.get(what) != digest:
            part = "tensors" if what == "sha256" else "settings"
            raise CheckpointError(f"{path.name} is damaged: its {part} are not those that were written; fetch it again")
    bad = [name for name, tensor in tensors.items() if not torch.isfinite(tensor.float()).all()]
    if bad:
        raise CheckpointError(f"{path.name}: {bad[0]} holds NaN or infinity; the training that wrote it had failed")
    config = _config(metadata, path)
    try:
        return _assemble(config, tensors, metadata)
    except (RuntimeError, KeyError, ValueError, AssertionError) as error:
        raise CheckpointError(f"{path.name}: weights and configuration disagree ({error}); fetch it again") from error


def _digests(tensors: dict, metadata: dict[str, str]) -> dict[str, str]:
    """Of the tensors alone (records of figures name the weights by it), and of what settles how they are used."""
    settings = {name: metadata.get(name, "") for name in ("format", "network", "config", "schedule")}
    return {"sha256": digest_of_tensors(tensors), "sha256_settings": digest_of_texts(settings)}


def _assemble(config: MoDiffConfig, tensors: dict[str, Tensor], metadata: dict) -> Walker:
    """Build the walker, checking the sizes that `load_state_dict` does not."""
    sizes = {"pose.mean": config.D, "pose.std": config.D, "control.mean": config.C, "control.std": config.C}
    for name, size in (sizes | {"schedule.beta": config.S}).items():
        if tuple(tensors[name].shape) != (size,):
            raise ValueError(f"{name} has the shape {tuple(tensors[name].shape)} where ({size},) belongs")
    pose, control = (Scaler(tensors[f"{n}.mean"], tensors[f"{n}.std"]) for n in ("pose", "control"))
    model = network(config, pose, control)
    model.load_state_dict({k[6:]: v.float() for k, v in tensors.items() if k.startswith("model.")})
    schedule = make_schedule(tensors["schedule.beta"], metadata["schedule"])
    card = json.loads(metadata.get("card", "{}")) or {}
    return Walker(model.eval().requires_grad_(False), schedule, pose, control, card)


def _config(metadata: dict, path: Path) -> MoDiffConfig:
    """The configuration, every setting known and of its default's type."""
    try:
        values = dict(json.loads(metadata["config"]))
    except (KeyError, ValueError, TypeError) as error:
        raise CheckpointError(f"{path.name}: its configuration cannot be read ({error}); fetch it again") from error
    kind = NETWORKS.get(metadata.get("network", "MoDiff"))
    if kind is None:
        raise CheckpointError(f"{path.name} holds an unknown network, {metadata['network']}; upgrade")
    defaults = {field.name: field.default for field in fields(kind)}
    unknown = set(values) - set(defaults)
    if unknown:
        raise CheckpointError(f"{path.name} has unknown settings ({', '.join(sorted(unknown))}); upgrade")
    for name, value in values.items():
        whole = type(value) is int and type(defaults[name]) is float  # dropout = 0
        if type(value) is not type(defaults[name]) and not whole:
            raise CheckpointError(f"{path.name}: its setting {name} = {value!r} makes no sense; fetch it again")
    try:
        return kind(**values)
    except ValueError as error:
        raise CheckpointError(f"{path.name}: its settings make no network ({error}); fetch it again") from error


def _looks_like(tensors: dict) -> str:
    first = ", ".join(sorted(tensors)[:3])
    return f"its tensors begin with {first}" if first else "it holds no tensors"


def available() -> dict[str, Path]:
    """The shipped weights: {name: file}; an alias stands beside the name it points to."""
    files = {path.stem: path for path in sorted(FOLDER.glob("*.safetensors"))}
    aliases = FOLDER / "aliases.json"
    named = json.loads(aliases.read_text()) if aliases.is_file() else {}
    return files | {alias: files[name] for alias, name in named.items() if name in files}


def pretrained(name: str = "walker") -> Walker:
    """A shipped walker by name: "walker" is the better one of "walker-eps" and "walker-x0".

    Raises CheckpointError with the names there are.  Notebook: 00
    """
    files = available()
    if name not in files:
        there = ", ".join(files) or "none (run make pretrained)"
        raise CheckpointError(f"no weights are called {name!r}; there are: {there}")
    return load_walker(files[name])
