"""A file of weights: safetensors (which contain no code), settings, and a card.

The card says how the weights were made. A damaged or foreign file raises an error with the reason.
`pretrained/checkpoints.py` knows what the tensors mean.

Weights take half the space of float16 in eight bits:
    q = round(w / scale), scale = max |row| / 127,   and back:  w = q scale
The rounding error is at most half a scale, 1/254 of a row's largest weight (0.39 %); its RMS is
1/sqrt(12) of a scale (0.23 %). Vectors (biases, norms) are small but sensitive, so they stay in
float16. All shipped weights have eight, which keeps the package small. Every published number comes
from the shipped weights.
Source: symmetric quantisation with one scale per row, as usual.
"""

import json
import os
from collections.abc import Callable, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any, TypeVar

import torch
from safetensors import SafetensorError, safe_open
from safetensors.torch import save_file
from torch import Tensor

from .._files import digest_of_tensors, digest_of_texts, home, replacing
from ..performers.networks import Config

# ---- files ---------------------------------------------------------------------------------------
Read = TypeVar("Read")  # the object that a file describes
# (tensors, metadata) -> the object that they describe
Assemble = Callable[[dict[str, Tensor], dict[str, str]], Read]
# settings of earlier versions; with this value they had no effect and are ignored
RETIRED = {"reach": 0.0, "turning": False}
LARGEST = 10_000  # of a whole number among the settings: widths, steps, frames
SETTINGS = ("format", "network", "config", "schedule")  # they decide how the tensors are used


class CheckpointError(ValueError):
    """A weights file cannot be used; the message has the reason and what to do."""


def write_weights(
    path: str | Path, tensors: Mapping[str, Tensor], settings: dict, config: dict, card: dict
) -> Path:
    """Write tensors, settings (strings) and card; also write the card as .json beside the file.

    The files get temporary names first and are then renamed.
    """
    path = home(path)
    metadata = settings | {"config": json.dumps(config), "card": json.dumps(card)}
    tensors = {k: v.detach().cpu().clone().contiguous() for k, v in tensors.items()}
    with replacing(path) as aside:
        save_file(tensors, aside, metadata | _digests(tensors, metadata))
        os.chmod(aside, 0o644)  # safetensors makes the file readable by its owner alone
    with replacing(path.with_suffix(".json")) as aside:
        aside.write_text(json.dumps(card | {"config": config}, indent=1) + "\n", encoding="utf-8")
    return path


def read_weights(path: str | Path, kinds: Mapping[str, Assemble[Read]]) -> Read:
    """Read and check a file, and return kinds[format](tensors, metadata).

    `kinds` has a function for each format that is accepted.
    Raises CheckpointError for a file that is missing, damaged, or of another format.
    """
    path = home(path)
    metadata, tensors = _opened(path)
    assemble = kinds.get(metadata.get("format", ""))
    if assemble is None:
        *others, last = (name.split()[1] for name in kinds)
        wanted = f"{', '.join(others)} or {last}" if others else last
        raise CheckpointError(
            f"{path.name} is not a {wanted} of this project ({_looks_like(metadata, tensors)})"
        )
    for what, digest in _digests(tensors, metadata).items():
        if metadata.get(what) != digest:
            part = "tensors" if what == "sha256" else "settings"
            raise CheckpointError(
                f"{path.name} is damaged: its {part} do not match their checksum; download it again"
            )
    bad = [name for name, tensor in tensors.items() if not torch.isfinite(tensor.float()).all()]
    if bad:
        raise CheckpointError(
            f"{path.name}: {bad[0]} contains NaN or infinity; its training must have failed"
        )
    try:
        return assemble(tensors, metadata | {"file": path.name})
    except CheckpointError:
        raise
    except (RuntimeError, KeyError, ValueError, TypeError, AssertionError) as error:
        raise CheckpointError(
            f"{path.name}: weights and configuration disagree ({error}); download it again"
        ) from error


def config_of(metadata: dict[str, str], kinds: Mapping[str, type], default: str) -> Config:
    """The configuration; every setting must be known and have the type of its default.

    Whole numbers are at most LARGEST, so that a false one does not fill the memory.

    `kinds` has a configuration class for each name of a network's class.
    """
    name = metadata["file"]
    try:
        values = dict(json.loads(metadata["config"]))
    except (KeyError, ValueError, TypeError) as error:
        raise CheckpointError(
            f"{name}: its configuration cannot be read ({error}); download it again"
        ) from error
    kind = kinds.get(metadata.get("network", default))
    if kind is None:
        raise CheckpointError(
            f"{name} contains an unknown network, {metadata['network']}; upgrade, or register it "
            "first (performers.networks.register)"
        )
    defaults: dict[str, Any] = {field.name: field.default for field in fields(kind)}
    values = {
        k: v for k, v in values.items() if k in defaults or k not in RETIRED or v != RETIRED[k]
    }
    unknown = set(values) - set(defaults)
    if unknown:
        old = unknown & set(RETIRED)
        told = "an earlier version: train it again, or load a shipped one"
        what = told if old else "a later one: upgrade"
        raise CheckpointError(
            f"{name} has settings ({', '.join(sorted(old or unknown))}) of {what}"
        )
    for setting, value in values.items():
        usual = type(defaults[setting])
        fits = type(value) is usual or (type(value) is int and usual is float)  # dropout = 0
        if usual is tuple and type(value) is list:  # of numbers, or of words
            inner = {type(v) for v in defaults[setting]} or {str}
            fits = all(type(v) in inner for v in value)
        numbers = value if isinstance(value, list) else [value]
        fits &= all(abs(v) <= LARGEST for v in numbers if type(v) is int)
        if not fits:
            raise CheckpointError(
                f"{name}: its setting {setting} = {value!r:.60} is not valid; download it again"
            )
    values = {k: tuple(v) if isinstance(v, list) else v for k, v in values.items()}
    try:
        return kind(**values)
    except ValueError as error:
        raise CheckpointError(
            f"{name}: its settings do not define a network ({error}); download it again"
        ) from error


def check_sizes(tensors: dict[str, Tensor], sizes: dict[str, int]) -> None:
    """Raise ValueError for a vector of the wrong length; `load_state_dict` misses those."""
    for name, size in sizes.items():
        if tuple(tensors[name].shape) != (size,):
            raise ValueError(
                f"{name} has the shape {tuple(tensors[name].shape)}; it must be ({size},)"
            )


def _opened(path: Path) -> tuple[dict[str, str], dict[str, Tensor]]:
    if not path.is_file():
        raise CheckpointError(f"there is no weights file {path}")
    try:
        with safe_open(path, "pt") as file:
            return file.metadata() or {}, {name: file.get_tensor(name) for name in file.keys()}
    except (SafetensorError, OSError, ValueError) as error:
        raise CheckpointError(
            f"{path.name} is damaged or not a safetensors file ({error}); download it again"
        ) from error


def _digests(tensors: dict, metadata: dict[str, str]) -> dict[str, str]:
    """Checksums of the tensors alone, and of the settings that decide how they are used.

    Published results name the weights by the first.
    """
    settings = {name: metadata.get(name, "") for name in SETTINGS}
    return {"sha256": digest_of_tensors(tensors), "sha256_settings": digest_of_texts(settings)}


def _looks_like(metadata: dict[str, str], tensors: dict) -> str:
    if metadata.get("format"):
        return f"its format is {metadata['format']}"
    first = ", ".join(sorted(tensors)[:3])
    return f"its tensors begin with {first}" if first else "it contains no tensors"


# ---- eight bits ----------------------------------------------------------------------------------
SCALE = ".scale"


def to_float16(weights: dict[str, Tensor]) -> dict[str, Tensor]:
    """Weights as float16; whole numbers stay as they are.

    Raises ValueError for weights beyond float16, of which the largest is 65,504.
    """
    made = {name: x.half() if x.is_floating_point() else x for name, x in weights.items()}
    for name, x in weights.items():
        if torch.isfinite(x).all() and not torch.isfinite(made[name]).all():
            raise ValueError(f"{name} goes up to {x.abs().max():.3g}, beyond float16: pass bits=32")
    return made


def pack(tensors: dict[str, Tensor]) -> dict[str, Tensor]:
    """Each matrix as int8 with one scale per row (`name.scale`), each vector in float16.

    Raises ValueError as `to_float16` does.
    """
    packed = {}
    for name, weight in tensors.items():
        if weight.dim() < 2 or not weight.is_floating_point():
            packed |= to_float16({name: weight})
            continue
        scale = weight.float().flatten(1).abs().amax(1).clamp(min=1e-12) / 127
        rows = scale.view(-1, *[1] * (weight.dim() - 1))
        packed[name] = (weight.float() / rows).round().clamp(-127, 127).to(torch.int8)
        packed[name + SCALE] = scale
    return packed


def unpack(packed: dict[str, Tensor]) -> dict[str, Tensor]:
    """Unpack to float32; tensors that were never packed pass through.

    Raises KeyError for an int8 matrix without its scale.
    """
    tensors = {}
    for name, weight in packed.items():
        if name.endswith(SCALE) and name.removesuffix(SCALE) in packed:
            continue
        if weight.dtype == torch.int8:
            scale = packed[name + SCALE]
            weight = weight.float() * scale.view(-1, *[1] * (weight.dim() - 1))
        tensors[name] = weight.float() if weight.is_floating_point() else weight
    return tensors
