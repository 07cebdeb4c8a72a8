"""`motiondiff-edu handout FOLDER`: the notebooks for a class, without solutions."""

import argparse
from pathlib import Path

from .copies import hand_out, written_in
from .edition import class_edition, write_edition
from .places import FolderError, notebook_folder, program

HELP = "write the notebooks for a class into a folder, without solutions"
EXAMPLE = "handout week_1 --only 00 01"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `handout`."""
    parser.add_argument("folder", type=Path, metavar="FOLDER", help="a new or an empty folder")
    parser.add_argument("--solutions", action="store_true", help="keep the folded solutions")
    parser.add_argument(
        "--only", nargs="+", default=[], metavar="NB", help="only these notebooks, 02 for instance"
    )


def run(chosen: argparse.Namespace) -> int:
    """Write the files, and say how many. Raises FolderError where something is in the way."""
    folder = chosen.folder
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise FolderError(f"{folder} is not empty: name a new folder, so that nothing is lost")
    edition = class_edition(notebook_folder(), chosen.only, chosen.solutions)
    with written_in(folder):
        write_edition(folder, edition)
    hand_out(notebook_folder(), folder)
    count = len(list(folder.glob("*.ipynb")))
    kind = "with" if chosen.solutions else "without"
    notebooks = f"{count} notebook{'s' * (count > 1)}"
    print(f"{notebooks} {kind} solutions, and the pages they link to, in {folder}")
    print(f"Students open them by: {program()} lab --folder {folder.name}")
    return 0
