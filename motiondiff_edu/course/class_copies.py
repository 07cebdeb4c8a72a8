"""`motiondiff-edu handout FOLDER`: the notebooks for a class, without solutions."""

import argparse
import json
from pathlib import Path

from .._files import replacing
from .handout import shipped
from .places import FolderError, notebook_folder

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
    wanted = {number.zfill(2) for number in chosen.only}
    files = shipped(notebook_folder())
    there = {name[:2] for name in files if name.endswith(".ipynb")}
    if not wanted <= there:
        raise FolderError(
            f"no notebook {', '.join(sorted(wanted - there))}; there are: "
            f"{', '.join(sorted(there))}"
        )
    written = []
    for name, content in files.items():
        if name.endswith(".ipynb"):
            if wanted and name[:2] not in wanted:
                continue
            content = content if chosen.solutions else without_solutions(content)
            written.append(name)
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        with replacing(path) as part:
            part.write_bytes(content)
    kind = "with" if chosen.solutions else "without"
    count = f"{len(written)} notebook{'s' * (len(written) > 1)}"
    print(f"{count} {kind} solutions, and the pages they link to, in {folder}")
    return 0


def without_solutions(content: bytes) -> bytes:
    """A notebook of the student edition without its cells of solutions; hints stay."""
    notebook = json.loads(content)
    notebook["cells"] = [
        cell for cell in notebook["cells"] if not cell.get("id", "").endswith("-solution")
    ]
    return (json.dumps(notebook, indent=1, ensure_ascii=False, sort_keys=True) + "\n").encode()
