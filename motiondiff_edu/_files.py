"""Writing files completely or not at all, and checksums that detect damage."""

import hashlib
import os
import platform
import re
import secrets
import zlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import torch


def home(path: str | Path) -> Path:
    """The path with the home folder in place of ~.

    Raises FileNotFoundError for an address, and for the home of a user who is not here.
    """
    there, text = Path(os.path.expanduser(path)), re.sub(":/+", "://", str(path), count=1)
    if re.match(r"\w\w+://", text):
        raise FileNotFoundError(f"{text} is an address: download the file first, then name it")
    if there.parts[1:] and there.parts[0].startswith("~"):
        raise FileNotFoundError(f"{path}: nobody here is called {there.parts[0][1:]}")
    return there


@contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """Yield a temporary name beside `path`; it is renamed to `path`, or removed after an error.

    with replacing("walk.bvh") as aside: aside.write_text(...)
    `~` is the home folder. What a killed process left of the same file is removed first.
    """
    path = home(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    _remove_left_over(path)
    aside = _aside(path)
    try:
        yield aside
        os.replace(aside, path)
    except OSError as error:
        if error.filename == str(aside):  # a message names the file that the caller asked for
            error.filename = str(path)
        raise
    finally:
        aside.unlink(missing_ok=True)


def check_writable(path: str | Path) -> None:
    """Raise OSError unless a file of that name can be made; to be asked before long work.

    A temporary file is made and removed; folders that are not there are made with the file itself.
    """
    path = home(path).absolute()
    if os.path.isdir(path):  # a name that is too long is no folder
        raise OSError(f"{path} is a folder; give the name of a file in it")
    there = next((folder for folder in path.parents if folder.exists()), None)
    if there is None:  # a drive of Windows that is not there
        raise OSError(f"{path}: there is no {path.anchor}; choose another place")
    if not there.is_dir():
        raise OSError(f"{path}: {there} is a file, not a folder; choose another place")
    probe = _aside(there / path.name)
    try:
        probe.touch()
        probe.unlink()
    except OSError as error:
        raise OSError(
            f"{path}: no file can be made in {there} ({error.strerror}); choose another place"
        ) from None


def _aside(path: Path) -> Path:
    """A temporary name beside `path`, of its own for each writer, including threads."""
    writer = f"{_machine()}.{os.getpid()}.{secrets.token_hex(4)}"
    return path.with_name(f".{path.name}.{writer}.part")  # a file of tempfile would be private


def _machine() -> str:
    """Four letters for this machine; several may write to one shared folder."""
    return f"{zlib.crc32(platform.node().encode()) & 0xFFFF:04x}"


def _remove_left_over(path: Path) -> None:
    """Remove temporary files of `path` whose process, on this machine, runs no more."""
    form = re.compile(rf"\.{re.escape(path.name)}\.{_machine()}\.(\d+)\.[0-9a-f]{{8}}\.part")
    with suppress(OSError):  # a folder may be written to, but not listed
        for one in path.parent.iterdir():
            found = form.fullmatch(one.name)
            if found and not _runs(int(found[1])):
                one.unlink(missing_ok=True)


def _runs(process: int) -> bool:
    """Whether a process runs.  On Windows, where asking by a signal would end it: always True."""
    if os.name == "nt":
        return True
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except OSError:  # it runs for another user
        return True
    return True


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
