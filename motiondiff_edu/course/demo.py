"""`motiondiff-edu demo NB`: one notebook ready to show, already run, in large type."""

import argparse
import json
import shutil
import tempfile
from pathlib import Path

from .jupyter import open_lab
from .places import find, notebook_folder

HELP = "open one notebook ready to show"
EXAMPLE = "demo 07"
PASSES_OPTIONS_ON = "JupyterLab"

# JupyterLab's large type for a projector; `viz.style` enlarges the plots
LARGE_SIZES = {"code-font-size": "19px", "content-font-size1": "21px", "ui-font-size1": "17px"}
SETTINGS = {
    "apputils-extension/themes": {"overrides": LARGE_SIZES},
    "notebook-extension/tracker": {"codeCellConfig": {"lineNumbers": False, "lineWrap": True}},
}


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `demo`."""
    parser.add_argument("number", metavar="NB", help="the notebook's number, 07 for instance")
    parser.add_argument(
        "--unrun", action="store_true", help="open it at once, before any cell was run"
    )


def run(chosen: argparse.Namespace) -> int:
    """Copy the notebooks to a temporary folder, and open one of them there."""
    notebooks = notebook_folder()
    find(notebooks, chosen.number)
    temporary = tempfile.TemporaryDirectory(prefix="motiondiff_demo_", ignore_cleanup_errors=True)
    with temporary as folder:
        home = Path(folder).resolve()
        notebook = find(place_for_demo(notebooks, home), chosen.number)
        environment = demo_environment(home)
        if not chosen.unrun:
            prepare(notebook, Path(environment["JUPYTER_DATA_DIR"]))
        print("This is a copy to show. Your changes to it will not be kept.")
        return open_lab(home, notebook, chosen.options, environment, alone=True)


def prepare(notebook: Path, jupyter_data: Path) -> None:
    """Put the outputs of a run into the copy. A notebook that fails is opened as it is."""
    from . import prepared  # its packages may be missing, and the other verbs do without them

    try:
        run = prepared.prepare_notebook(notebook, notebook.parent)
    except prepared.PreparationError as error:
        print(f"{error}. It opens without outputs.")
        return
    prepared.write_trusted(run, notebook, jupyter_data)


def place_for_demo(notebooks: Path, home: Path) -> Path:
    """Copy the notebooks, and docs/, to which they link. The sources stay as they are."""
    target = home / "notebooks"
    shutil.copytree(
        notebooks, target, ignore=shutil.ignore_patterns("student", ".ipynb_checkpoints")
    )
    if (notebooks.parent / "docs").is_dir():
        shutil.copytree(notebooks.parent / "docs", home / "docs")
    return target


def demo_environment(home: Path) -> dict[str, str]:
    """Settings for a notebook to show. They also keep the demo's tabs out of later sessions."""
    settings = home / "settings" / "@jupyterlab"
    for name, value in SETTINGS.items():
        file = settings / f"{name}.jupyterlab-settings"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(json.dumps(value), encoding="utf-8")
    return {
        "MOTIONDIFF_DEMO": "1",
        "MOTIONDIFF_LARGE": "1",
        "JUPYTERLAB_SETTINGS_DIR": str(home / "settings"),
        "JUPYTERLAB_WORKSPACES_DIR": str(home / "workspaces"),
        "JUPYTER_DATA_DIR": str(home / "jupyter"),
    }
