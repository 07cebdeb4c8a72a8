"""Trained walkers and dancers on disk, and the shipped ones by name.

Safetensors with a card that says what they are and how they were made; float16 unless told otherwise.
Notebook: 00, 07, 12
"""

import json
from pathlib import Path

from torch import Tensor

from .baselines.transformer import DanceTransformer, TransformerConfig
from .dancer import Dancer
from .ddpm import make_schedule
from .foothold import FootholdConfig, network
from .modiff import MoDiffConfig
from .mofusion import MoFusion, MoFusionConfig
from .motion.scaler import Scaler
from .walker import Walker
from .weights_file import CheckpointError, check_sizes, config_of, format_of, read_weights, write_weights

__all__ = ["CheckpointError", "available", "load_dancer", "load_walker", "pretrained", "save_dancer", "save_walker"]

WALKER, DANCER = "motiondiff_edu walker 2", "motiondiff_edu dancer 1"
FOLDER = Path(__file__).parent / "pretrained"
NETWORKS = {"MoDiff": MoDiffConfig, "FootholdMoDiff": FootholdConfig}  # by the name of the class
DANCING = {"MoFusion": (MoFusionConfig, MoFusion), "DanceTransformer": (TransformerConfig, DanceTransformer)}


def save_walker(walker: Walker, path: str | Path, half: bool = True) -> Path:
    """Write a walker: weights (float16 unless half=False), scalers, schedule, card. A card.json is laid beside it.

    Written to a temporary name and renamed.  Notebook: 07
    """
    return _save(walker, path, WALKER, {"pose": walker.pose_scaler, "control": walker.control_scaler}, half)


def save_dancer(dancer: Dancer, path: str | Path, half: bool = True) -> Path:
    """Write a dancer, as `save_walker` writes a walker.  Notebook: 12"""
    return _save(dancer, path, DANCER, {"motion": dancer.motion_scaler, "mel": dancer.mel_scaler}, half)


def _save(figure: Walker | Dancer, path: str | Path, kind: str, scalers: dict[str, Scaler], half: bool) -> Path:
    tensors = {f"model.{k}": v.half() if half else v for k, v in figure.model.state_dict().items()}
    tensors |= {f"{name}.{part}": getattr(s, part) for name, s in scalers.items() for part in ("mean", "std")}
    tensors["schedule.beta"] = figure.schedule.beta[1:]
    settings = {"format": kind, "network": type(figure.model).__name__, "schedule": figure.schedule.name}
    return write_weights(path, tensors, settings, figure.config.as_dict(), figure.card)


def load_walker(path: str | Path) -> Walker:
    """Read a walker.  Raises CheckpointError for a file that is missing, damaged, or not one of ours."""
    return read_weights(path, WALKER, _walker)


def load_dancer(path: str | Path) -> Dancer:
    """Read a dancer, or a baseline that dances.  Raises CheckpointError as `load_walker` does."""
    return read_weights(path, DANCER, _dancer)


def _walker(tensors: dict[str, Tensor], metadata: dict[str, str]) -> Walker:
    config = config_of(metadata, NETWORKS, "MoDiff")
    check_sizes(tensors, {f"{n}.{part}": getattr(config, size) for n, size in (("pose", "D"), ("control", "C"))
                          for part in ("mean", "std")} | {"schedule.beta": config.S})  # fmt: skip
    scalers = [Scaler(tensors[f"{n}.mean"], tensors[f"{n}.std"]) for n in ("pose", "control")]
    return Walker(_filled(network(config, *scalers), tensors), *_rest(tensors, metadata, scalers))


def _dancer(tensors: dict[str, Tensor], metadata: dict[str, str]) -> Dancer:
    config = config_of(metadata, {name: kind for name, (kind, _) in DANCING.items()}, "MoFusion")
    check_sizes(tensors, {f"{n}.{part}": getattr(config, size) for n, size in (("motion", "D"), ("mel", "C"))
                          for part in ("mean", "std")} | {"schedule.beta": config.S})  # fmt: skip
    scalers = [Scaler(tensors[f"{n}.mean"], tensors[f"{n}.std"]) for n in ("motion", "mel")]
    model = DANCING[metadata.get("network", "MoFusion")][1](config)
    return Dancer(_filled(model, tensors), *_rest(tensors, metadata, scalers))


def _filled(model, tensors: dict[str, Tensor]):
    model.load_state_dict({k[6:]: v.float() for k, v in tensors.items() if k.startswith("model.")})
    return model.eval().requires_grad_(False)


def _rest(tensors: dict[str, Tensor], metadata: dict[str, str], scalers: list[Scaler]) -> tuple:
    card = json.loads(metadata.get("card", "{}")) or {}
    return make_schedule(tensors["schedule.beta"], metadata["schedule"]), *scalers, card


def available() -> dict[str, Path]:
    """The shipped weights: {name: file}; an alias stands beside the name it points to."""
    files = {path.stem: path for path in sorted(FOLDER.glob("*.safetensors"))}
    aliases = FOLDER / "aliases.json"
    named = json.loads(aliases.read_text()) if aliases.is_file() else {}
    return files | {alias: files[name] for alias, name in named.items() if name in files}


def pretrained(name: str = "walker") -> Walker | Dancer:
    """Shipped weights by name: "walker" is the better one of "walker-eps" and "walker-x0"; "dancer" dances.

    Raises CheckpointError with the names there are.  Notebook: 00
    """
    files = available()
    if name not in files:
        there = ", ".join(files) or "none (run make pretrained)"
        raise CheckpointError(f"no weights are called {name!r}; there are: {there}")
    return (load_dancer if format_of(files[name]) == DANCER else load_walker)(files[name])
