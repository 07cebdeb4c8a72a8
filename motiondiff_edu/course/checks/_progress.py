"""`checks.progress()`: which exercises are done, in this kernel and in the copies beside it."""

from pathlib import Path

from ..answers import CopyError, exercises, outputs
from ..edition import edition_of
from ..places import notebook_folder
from ._report import FOUND, NOT_ATTEMPTED

SIGNS = {True: "+", False: "x", None: "."}  # right, not right yet, not attempted


def progress(folder: str | Path = ".") -> None:
    """Print a line for each notebook: how many exercises are right, and which are not.

    It knows the checks of this kernel, and those of the notebooks that are saved in `folder`. In
    the folder of a class, it lists the notebooks of the class.
    Raises FolderError where the folder's record of its class is damaged.
    """
    lines = []
    right = 0
    every = 0
    of_class = edition_of(Path(folder)).notebooks
    for original in sorted((notebook_folder() / "student").glob("[0-9][0-9]_*.ipynb")):
        if of_class and original.name[:2] not in of_class:
            continue
        names = exercises(original)
        known = saved(Path(folder) / original.name) | {n: FOUND[n] for n in names if n in FOUND}
        done = [name for name in names if known.get(name)]
        rest = [f"{SIGNS[known.get(name)]} {name}" for name in names if name not in done]
        right, every = right + len(done), every + len(names)
        lines.append(
            f"{original.stem[:2]}  {len(done)} of {len(names)}  {', '.join(rest)}".rstrip()
        )
    print("\n".join(lines))
    print(f"{right} of {every} exercises are right (x: not yet, a dot: not attempted)")


def saved(path: Path) -> dict[str, bool | None]:
    """{check: right, not right, or None for not attempted}, by the outputs saved in a copy."""
    found: dict[str, bool | None] = {}
    try:
        for name, told in outputs(path).items():
            if f"{name}: right." in told:
                found[name] = True
            elif f"{name}: {NOT_ATTEMPTED}" not in told and told:
                found[name] = False
    except CopyError:
        return {}
    return found
