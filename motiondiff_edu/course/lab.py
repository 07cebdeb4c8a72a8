"""`motiondiff-edu lab`: JupyterLab in a student's own copies of the student edition."""

import argparse
from pathlib import Path

from .handout import Handout, hand_out, make_fresh
from .jupyter import open_lab
from .places import find, notebook_folder, place_for_students, word_for_fresh

HELP = "open JupyterLab at notebook 00, in your own copy of the notebooks"
EXAMPLE = "lab --no-browser"
PASSES_OPTIONS_ON = "JupyterLab"


def arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--fresh",
        metavar="NB",
        action="append",
        default=[],
        help="a fresh copy of notebook NB; yours stays beside it as ..._mine.ipynb",
    )
    parser.add_argument(
        "--folder",
        type=Path,
        help="where your copies are (default: motiondiff_notebooks)",
    )


def run(chosen: argparse.Namespace) -> int:
    """Bring the copies up to date, say what happened to them, and open JupyterLab."""
    notebooks = notebook_folder()
    wanted = [find(notebooks / "student", number).name for number in chosen.fresh or ["00"]]
    root, mine = place_for_students(chosen.folder)
    handout = hand_out(notebooks, mine)
    for name in wanted if chosen.fresh else []:
        aside = make_fresh(notebooks, mine, name)
        print(f"{name} is fresh" + (f"; yours is now {aside.name}" if aside else ""))
    tell(handout, but=chosen.fresh and wanted)
    own_tabs = {"JUPYTERLAB_WORKSPACES_DIR": str(mine / ".lab" / "workspaces")}
    return open_lab(root, mine / wanted[0], chosen.options, own_tabs)


def tell(handout: Handout, but: list[str]) -> None:
    """Say which copies were renewed, and which old ones were kept and how to get the new ones.

    Nothing is said of pages, nor of the notebooks in `but`.
    """
    renewed = [name for name in handout.renewed if name.endswith(".ipynb")]
    kept = [name for name in handout.kept if name.endswith(".ipynb") and name not in but]
    if renewed:
        print("renewed, you had not changed them: " + ", ".join(renewed))
    if kept:
        print("kept as you left them, although the course has newer ones: " + ", ".join(kept))
        print(f"  for a new one, with yours beside it: {word_for_fresh(kept[0][:2])}")
