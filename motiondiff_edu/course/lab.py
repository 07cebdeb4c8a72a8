"""`motiondiff-edu lab [NB]`: open JupyterLab in a student's own copies of the student edition."""

import argparse
from pathlib import Path

from .copies import Handout, hand_out, make_fresh
from .edition import edition_of
from .jupyter import open_lab
from .places import command_for_fresh, notebook_folder, place_for_students

HELP = "open JupyterLab at notebook 00, or at the one whose number comes first, in your own copies"
EXAMPLE = "lab 07 --no-browser"
PASSES_OPTIONS_ON = "JupyterLab"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `lab`."""
    parser.add_argument(
        "--fresh",
        metavar="NB",
        action="append",
        default=[],
        help="make a fresh copy of notebook NB; yours stays beside it as ..._mine.ipynb",
    )
    parser.add_argument(
        "--folder",
        type=Path,
        help="the folder of your copies "
        "(default: motiondiff_notebooks, in the checkout or else here)",
    )


def run(chosen: argparse.Namespace) -> int:
    """Bring the copies up to date, say what happened to them, and open JupyterLab."""
    notebooks, options = notebook_folder(), list(chosen.options)
    root, mine = place_for_students(chosen.folder)
    edition = edition_of(mine)
    if options and not options[0].startswith("-"):  # after an option, a word can be its value
        opened = [options.pop(0)]
    else:
        opened = chosen.fresh or [edition.first]
    first, *_ = (edition.find(notebooks / "student", number).name for number in opened)
    renewed = [edition.find(notebooks / "student", number).name for number in chosen.fresh]
    handout = hand_out(notebooks, mine)
    for name in renewed:
        aside = make_fresh(notebooks, mine, name)
        print(f"{name} is fresh" + (f"; yours is now {aside.name}" if aside else ""))
    report(handout, renewed, chosen.folder)
    own_tabs = {"JUPYTERLAB_WORKSPACES_DIR": str(mine / ".lab" / "workspaces")}
    return open_lab(root, mine / first, options, own_tabs)


def report(handout: Handout, leave_out: list[str], folder: Path | None) -> None:
    """Print which copies were renewed, which old ones were kept, and how to get the new ones.

    Pages, and the notebooks in `leave_out`, are not mentioned.
    """
    renewed = [name for name in handout.renewed if name.endswith(".ipynb")]
    kept = [name for name in handout.kept if name.endswith(".ipynb") and name not in leave_out]
    if renewed:
        print("Renewed, because you had not changed them: " + ", ".join(renewed))
    if kept:
        print("Kept as you left them, although the course has newer ones: " + ", ".join(kept))
        command = command_for_fresh(kept[0][:2], folder)
        print(f"  To get a new one, with yours beside it: {command}")
