"""Where the notebooks are and where a student's copies go, in a checkout and from a wheel."""

import os
import shlex
import subprocess
import sys
from pathlib import Path

PACKAGE = Path(__file__).parents[1]
COPIES = "motiondiff_notebooks"


class NotebookError(ValueError):
    """No notebook has that number; the message lists the numbers that exist."""


class FolderError(ValueError):
    """The folder of the copies cannot be used."""


def in_checkout() -> bool:
    """Whether the package runs from a checkout (or an unpacked archive), not from a wheel."""
    above = PACKAGE.parent
    return (above / "notebooks").is_dir() and (above / "pyproject.toml").is_file()


def notebook_folder() -> Path:
    """notebooks/ of the checkout, or of the wheel; docs/ is beside it."""
    return (PACKAGE.parent if in_checkout() else PACKAGE) / "notebooks"


def find(folder: Path, number: str) -> Path:
    """The notebook of that number. Raises NotebookError if there is none."""
    there = sorted(folder.glob("[0-9][0-9]*.ipynb"))
    wanted = [path for path in there if path.name[:2] == number.zfill(2)]
    if not wanted:
        numbers = ", ".join(path.name[:2] for path in there) or "none"
        raise NotebookError(f"no notebook {number} in {folder}; there are: {numbers}")
    return wanted[0]


def place_for_students(chosen: Path | None = None) -> tuple[Path, Path]:
    """The folder in which JupyterLab starts, and the folder of the student's copies.

    In a checkout JupyterLab starts at its top, so that the library can be read beside the
    notebooks. From a wheel it starts in the folder of the copies, which is made in the current
    folder.
    """
    if chosen is not None:
        mine = chosen.expanduser().resolve()
        if mine.exists() and not mine.is_dir():
            raise FolderError(f"{chosen} is a file; --folder takes the folder of your copies")
        return mine, mine
    if in_checkout():
        return PACKAGE.parent, PACKAGE.parent / COPIES
    here = Path.cwd()
    mine = here if here.name == COPIES else here / COPIES
    return mine, mine


def program() -> str:
    """The command that was typed: motiondiff-edu, or python -m motiondiff_edu."""
    name = Path(sys.argv[0]).stem
    return name if name == "motiondiff-edu" else "python -m motiondiff_edu"


def command_for_lab() -> str:
    """The command that opens the course, with make or without."""
    by_make = in_checkout() and "MAKELEVEL" in os.environ
    return "make lab" if by_make else f"{program()} lab"


def command_for_fresh(number: str, folder: Path | None = None) -> str:
    """The command for a fresh copy of one notebook, with make or without; `folder` as typed."""
    if folder is not None:
        return f"{program()} lab --fresh {number} --folder {quote_for_terminal(str(folder))}"
    by_make = in_checkout() and "MAKELEVEL" in os.environ
    return f"make lab FRESH={number}" if by_make else f"{program()} lab --fresh {number}"


def quote_for_terminal(word: str) -> str:
    """A word as one types it in this system's terminal."""
    return subprocess.list2cmdline([word]) if os.name == "nt" else shlex.quote(word)
