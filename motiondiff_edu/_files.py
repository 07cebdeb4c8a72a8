"""Writing files completely or not at all, and checksums that detect damage."""

import hashlib
import os
import secrets
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import torch


@contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """Yield a temporary name beside `path`; it is renamed to `path`, or removed after an error.

    with replacing("walk.bvh") as aside: aside.write_text(...)
    `~` is the home folder.
    """
    path = Path(path).expanduser()
    path.parent.mkdir(parents=True, exist_ok=True)
    # a name of its own for each writer, including threads; files of tempfile would be private
    aside = path.with_name(f".{path.name}.{os.getpid()}.{secrets.token_hex(4)}.part")
    try:
        yield aside
        os.replace(aside, path)
    except OSError as error:
        if error.filename == str(aside):  # a message names the file that the caller asked for
            error.filename = str(path)
        raise
    finally:
        aside.unlink(missing_ok=True)


def digest_of_tensors(tensors: Mapping[str, "torch.Tensor"]) -> str:
    """SHA-256 of all tensors, in the order of their names.

    Safetensors itself checks only its header.
    """
    # the type is a string, because `lab` also writes files where torch cannot be imported
    digest = hashlib.sha256()
    for name in sorted(tensors):
        digest.update(name.encode() + _bytes_of(tensors[name]))
    return digest.hexdigest()


def _bytes_of(tensor: "torch.Tensor") -> bytes:
    """The bytes of a tensor of any type; numpy has no bfloat16."""
    import torch

    return tensor.detach().cpu().contiguous().flatten().view(torch.uint8).numpy().tobytes()


def digest_of_texts(texts: Mapping[str, str]) -> str:
    """SHA-256 of named texts, in the order of their names."""
    return hashlib.sha256(repr(sorted(texts.items())).encode()).hexdigest()
