"""Trained performers on disk, and the shipped ones by name.

Safetensors with a card that says what they are and how they were made; float16 by default.
Notebook: 00, 07, 12
"""

import copy
import json
from collections.abc import Callable
from dataclasses import MISSING, asdict, dataclass
from difflib import get_close_matches
from functools import lru_cache, partial
from pathlib import Path
from typing import Generic, TypeVar

import torch
from safetensors import safe_open
from torch import Tensor, nn

from ..baselines import text, transformer  # noqa: F401  they register their networks
from ..conditions.clip import ClipError, ClipModel
from ..conditions.clip import load as load_clip
from ..ddpm import make_schedule
from ..motion.scaler import Scaler
from ..performers import hearing_mofusion  # noqa: F401
from ..performers.dancer import Dancer
from ..performers.inbetweener import Inbetweener
from ..performers.mover import Mover
from ..performers.networks import kind_of, networks_of
from ..performers.performer import Performer, float32
from ..performers.walker import Walker
from .weights_file import (
    CheckpointError,
    check_sizes,
    config_of,
    pack,
    read_weights,
    to_float16,
    unpack,
    write_weights,
)

__all__ = ["CheckpointError", "available", "load", "save"]

FOLDER = Path(__file__).parent
AnyPerformer = Walker | Dancer | Mover | Inbetweener
P = TypeVar("P", bound=Performer, covariant=True)
Model = TypeVar("Model", bound=nn.Module)


@dataclass(frozen=True)
class Kind(Generic[P]):
    """A performer in files.

    Its name, its format there, its class, its scalers with the width of each ("D" or "C" of the
    configuration), and its usual network.
    """

    name: str
    format: str
    performer: type[P]
    scalers: dict[str, str]
    usual: str


WALKER = Kind("walker", "motiondiff_edu walker 2", Walker, {"pose": "D", "control": "C"}, "MoDiff")
DANCER = Kind("dancer", "motiondiff_edu dancer 1", Dancer, {"motion": "D", "mel": "C"}, "MoFusion")
MOVER = Kind("mover", "motiondiff_edu mover 1", Mover, {"motion": "D"}, "TextMoFusion")
INBETWEENER = Kind(
    "inbetweener", "motiondiff_edu inbetweener 1", Inbetweener, {"motion": "D"}, "KeyframeMoFusion"
)
KINDS: tuple[Kind[AnyPerformer], ...] = (WALKER, DANCER, MOVER, INBETWEENER)
STORED = {8: pack, 16: to_float16, 32: dict}


def save(figure: AnyPerformer, path: str | Path, bits: int = 16) -> Path:
    """Write a performer: weights, scalers, schedule.

    Weights are stored as float16; `bits=32` leaves them unchanged, `bits=8` is `weights_file.pack`.

    NAME.json, the card, is written beside NAME.safetensors. Both get a temporary name first.
    Raises ValueError for other numbers of bits or another ending, for what is no performer, for
    weights too large for float16, and for a network that is not registered
    (`performers.networks.register`).
    """
    if bits not in STORED:
        raise ValueError(f"weights are written in 8, 16 or 32 bits, not {bits}")
    kind = next((kind for kind in KINDS if isinstance(figure, kind.performer)), None)
    if kind is None:
        names = ", ".join(kind.performer.__name__ for kind in KINDS)
        raise ValueError(f"save takes one of {names}, not a {type(figure).__name__}")
    if Path(path).suffix != ".safetensors":
        raise ValueError(f"weights are written to a file .safetensors, not to {Path(path).name!r}")
    network = type(figure.model).__name__
    if kind_of(figure.model) is not networks_of(kind.name).get(network, MISSING):
        raise ValueError(
            f"{network} is not registered, and could not be loaded again: call "
            f'performers.networks.register("{kind.name}", {network}, '
            f"{type(figure.config).__name__})"
        )
    scalers = {name: getattr(figure, f"{name}_scaler") for name in kind.scalers}
    weights = STORED[bits](figure.model.state_dict())
    tensors = {f"model.{k}": v for k, v in weights.items()}
    tensors |= {
        f"{name}.{part}": getattr(s, part)
        for name, s in scalers.items()
        for part in ("mean", "std")
    }
    tensors["schedule.beta"] = figure.schedule.beta[1:]
    settings = {"format": kind.format, "network": network, "schedule": figure.schedule.name}
    return write_weights(path, tensors, settings, asdict(figure.config), figure.card)


def bits_of(path: str | Path) -> int:
    """In how many bits a file's matrices are written: 8, 16 or 32."""
    with safe_open(path, "pt") as file:
        kinds = {
            file.get_slice(name).get_dtype() for name in file.keys() if name.startswith("model.")
        }
    return 8 if "I8" in kinds else 16 if "F16" in kinds else 32


@float32()
def load(name: str | Path, clip: ClipModel | str | Path | None = None) -> AnyPerformer:
    """A performer: shipped weights by name ("walker", "dancer", "mover" ...), or your own file.

    `clip`: for your own mover that reads by CLIP, that CLIP or its folder; without it the CLIP is
    looked for by the name in the file (`conditions.clip.load`), on this machine.
    Raises CheckpointError for an unknown name, with a list of the names, for a file that is
    missing, damaged, or not one of ours, for a CLIP that is missing or another one, and for `clip`
    with shipped weights, none of which reads by CLIP.
    Notebook: 00
    """
    path = Path(str(name))
    if path.suffix or path.parent.name:
        return _read(path, clip)
    files, name = available(), str(name)
    if name not in files:
        there = ", ".join(files) or "none (run make pretrained)"
        near = get_close_matches(name.lower(), files, n=1)
        meant = f". Did you mean {near[0]!r}?" if near else ""
        raise CheckpointError(f"no weights are called {name!r}; there are: {there}{meant}")
    if clip is not None:
        raise CheckpointError(f"the shipped {name!r} does not read by CLIP: leave `clip` out")
    path = files[name]
    return copy.deepcopy(_kept(path, path.stat().st_mtime_ns))


def _read(path: str | Path, clip: ClipModel | str | Path | None = None) -> AnyPerformer:
    shipped = Path(path).parent == FOLDER
    assembled = {kind.format: partial(_assembled, kind, clip=clip, shipped=shipped)
                 for kind in KINDS}  # fmt: skip
    return read_weights(path, assembled)


def _assembled(
    kind: Kind[P],
    tensors: dict[str, Tensor],
    metadata: dict[str, str],
    clip: ClipModel | str | Path | None = None,
    shipped: bool = False,
) -> P:
    networks = networks_of(kind.name)
    config = config_of(metadata, {name: one.config for name, one in networks.items()}, kind.usual)
    sizes = {name: getattr(config, width) for name, width in kind.scalers.items()}
    vectors = {f"{name}.{part}": size for name, size in sizes.items() for part in ("mean", "std")}
    check_sizes(tensors, vectors | {"schedule.beta": config.S})
    scalers = [scaler_of(tensors, name) for name in kind.scalers]
    build = partial(networks[metadata.get("network", kind.usual)].model, config)
    weights = weights_of(tensors)
    if not shipped:  # torch takes a second to import what an outline needs
        refuse_other_shapes(build, weights)
    schedule = make_schedule(tensors["schedule.beta"], metadata["schedule"])
    perform: Callable[..., P] = kind.performer  # each takes its own scalers
    trained = (with_weights(build(), weights), schedule, *scalers, card_of(metadata))
    name = getattr(config, "clip", "")
    if not name and clip is None:
        return perform(*trained)
    if not name:
        raise CheckpointError(f"{metadata['file']} does not read by CLIP: leave `clip` out")
    try:
        return perform(*trained, clip if isinstance(clip, ClipModel) else load_clip(clip or name))
    except ClipError as error:
        raise CheckpointError(
            f"{metadata['file']} reads texts by {name}, or by its folder in `clip`: {error}"
        ) from error


def weights_of(tensors: dict[str, Tensor]) -> dict[str, Tensor]:
    """The weights of the network among the tensors of a file, in full precision."""
    return unpack({k[6:]: v for k, v in tensors.items() if k.startswith("model.")})


def refuse_other_shapes(build: Callable[[], nn.Module], weights: dict[str, Tensor]) -> None:
    """Raise ValueError for weights of other shapes than the network's, before it takes memory."""
    try:
        with torch.device("meta"):  # tensors with a shape and without numbers
            outline = build().state_dict()
    except (RuntimeError, TypeError):  # somebody's network computes with its numbers
        return
    for name in sorted(outline.keys() | weights.keys()):
        own, given = (tuple(x[name].shape) if name in x else None for x in (outline, weights))
        if own != given:
            raise ValueError(f"{name} has the shape {given}; the network has {own}")


def with_weights(model: Model, weights: dict[str, Tensor]) -> Model:
    """The network with these weights, in evaluation mode and without gradients."""
    model.load_state_dict(weights)
    return model.eval().requires_grad_(False)


def scaler_of(tensors: dict[str, Tensor], name: str) -> Scaler:
    """One of the scalers of a file."""
    return Scaler(tensors[f"{name}.mean"], tensors[f"{name}.std"])


def card_of(metadata: dict[str, str]) -> dict:
    """The card of a file; empty where there is none.  Raises ValueError for another card."""
    card = json.loads(metadata.get("card", "{}")) or {}
    if not isinstance(card, dict):
        raise ValueError(f"the card is a {type(card).__name__}, not a dictionary")
    return card


def available() -> dict[str, Path]:
    """The shipped weights: {name: file}."""
    return {path.stem: path for path in sorted(FOLDER.glob("*.safetensors"))}


@lru_cache(maxsize=8)
def _kept(path: Path, changed: int) -> AnyPerformer:
    """Shipped weights are read and checked once; nobody gets this object, only copies of it."""
    return _read(path)
