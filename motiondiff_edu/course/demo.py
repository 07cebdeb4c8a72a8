"""`motiondiff-edu demo NB`: one notebook ready to show, with shipped weights and large type."""

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


def arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("number", metavar="NB", help="the notebook's number, 07 for instance")


def run(chosen: argparse.Namespace) -> int:
    """Copy the notebooks to a temporary folder, and open one of them there."""
    notebooks = notebook_folder()
    find(notebooks, chosen.number)
    temporary = tempfile.TemporaryDirectory(prefix="motiondiff_demo_", ignore_cleanup_errors=True)
    with temporary as folder:
        home = Path(folder).resolve()
        notebook = find(place_for_demo(notebooks, home), chosen.number)
        print("This is a copy to show. Your changes to it will not be kept.")
        return open_lab(home, notebook, chosen.options, demo_environment(home))


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
    folder = home / "settings" / "@jupyterlab" / "apputils-extension"
    folder.mkdir(parents=True)
    large_type = json.dumps({"overrides": LARGE_SIZES})
    (folder / "themes.jupyterlab-settings").write_text(large_type, encoding="utf-8")
    return {
        "MOTIONDIFF_DEMO": "1",
        "JUPYTERLAB_SETTINGS_DIR": str(home / "settings"),
        "JUPYTERLAB_WORKSPACES_DIR": str(home / "workspaces"),
    }
