"""A notebook that was run before it is shown: its figures move as soon as the page is there.

The outputs are kept in the user's cache, so only the first demo of a notebook waits for it. What
needs a kernel says so until the notebook is run again.
"""

import copy
import hashlib
import os
from pathlib import Path

import nbformat
import platformdirs
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError, CellTimeoutError, DeadKernelError
from nbformat.sign import NotebookNotary
from tqdm import tqdm

from .._files import replacing
from .places import PACKAGE
from .profiles import profile

WIDGET = "application/vnd.jupyter.widget-view+json"
FOLDED = {"imports", "setup", "solution", "twin"}  # tags of cells whose code a demo folds
SECONDS = 900  # for one cell
ENVIRONMENT = {"MOTIONDIFF_LARGE": "1", "MOTIONDIFF_PAGES": "1"}  # sliders keep a few states
MOVING = 'title="motion player"'  # in the HTML of a player
KERNEL_NOTE = "<p><em>Controls that need a running kernel: Run, Run All Cells.</em></p>"


class PreparationError(RuntimeError):
    """The notebook did not run to its end; the message says why."""


def prepare_notebook(path: Path, folder: Path) -> nbformat.NotebookNode:
    """The notebook of `path`, run in `folder`, with outputs that need no kernel.

    Raises PreparationError for a notebook that does not run to its end.
    """
    file = prepared_path(path)
    if file.is_file():
        return nbformat.read(file, as_version=4)
    print("It is run once, now; later demos of it open at once.", flush=True)
    notebook = run_cells(nbformat.read(path, as_version=4), folder, path.stem)
    for cell in notebook.cells:
        still(cell)
    first_figure_first(notebook)
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        for old in file.parent.glob(f"{path.stem}-*.ipynb"):
            old.unlink()
        with replacing(file) as part:
            nbformat.write(notebook, part)
    except OSError as error:  # it can be shown all the same
        print(f"The prepared notebook cannot be kept: {error}")
    return notebook


def prepared_path(path: Path) -> Path:
    """The file of this notebook, prepared; another one after each change of notebook or code."""
    return cache() / f"{path.stem}-{digest(path)}.ipynb"


def cache() -> Path:
    """The folder of prepared notebooks; MOTIONDIFF_CACHE names another one."""
    chosen = os.environ.get("MOTIONDIFF_CACHE")
    return Path(chosen) if chosen else platformdirs.user_cache_path("motiondiff_edu") / "demo"


def digest(path: Path) -> str:
    """A checksum of the notebook, its profile, and all code and weights that it can use."""
    found = hashlib.sha256(path.read_bytes() + profile().encode())
    data_synth = PACKAGE.parent / "data_synth"
    scripts = (PACKAGE / "widgets").rglob("*.js")  # their text is in the outputs
    for source in sorted([*PACKAGE.rglob("*.py"), *scripts, *data_synth.rglob("*.py")]):
        found.update(source.read_bytes())
    for weights in sorted(PACKAGE.rglob("*.json")):  # cards, and the words of a text
        found.update(weights.read_bytes())
    return found.hexdigest()[:16]


def run_cells(
    notebook: nbformat.NotebookNode, folder: Path, name: str = "the notebook"
) -> nbformat.NotebookNode:
    """Run all cells, with a bar that says how far it is."""
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    client = NotebookClient(
        notebook,
        timeout=SECONDS,
        resources={"metadata": {"path": str(folder)}},
        store_widget_state=False,
    )
    environment = os.environ | ENVIRONMENT
    with tqdm(total=len(cells), desc=f"preparing {name}", unit="cell") as bar:
        client.on_cell_executed = lambda cell, cell_index, execute_reply: bar.update()
        try:
            return client.execute(env=environment)
        except CellExecutionError as error:
            raise PreparationError(f"{name} stopped with {error.ename}: {error.evalue}") from error
        except CellTimeoutError as error:
            raise PreparationError(f"a cell of {name} took more than {SECONDS} s") from error
        except DeadKernelError as error:
            raise PreparationError(f"the kernel of {name} died") from error


def still(cell: nbformat.NotebookNode) -> None:
    """Fold what is folded in a demo; leave no output that waits for a kernel."""
    tags = set(cell.metadata.get("tags", []))
    if tags & FOLDED:
        cell.metadata["jupyter"] = {"source_hidden": True}
    for output in cell.get("outputs", []):
        data = output.get("data", {})
        if data.pop(WIDGET, None) and not {"text/html", "image/png"} & data.keys():
            data["text/html"] = KERNEL_NOTE


def first_figure_first(notebook: nbformat.NotebookNode) -> None:
    """Show the notebook's first moving figure above its title as well."""
    moving = (
        output
        for cell in notebook.cells
        for output in cell.get("outputs", [])
        if MOVING in output.get("data", {}).get("text/html", "")
    )
    first = next(moving, None)
    if first is not None:
        top = nbformat.v4.new_code_cell("# the first figure of this notebook", id="first-figure")
        top.outputs = [copy.deepcopy(first)]
        top.metadata["jupyter"] = {"source_hidden": True}
        notebook.cells.insert(0, top)


def write_trusted(notebook: nbformat.NotebookNode, path: Path, jupyter_data: Path) -> None:
    """Write a notebook, and sign it in this folder of Jupyter's data: else no script of it runs."""
    jupyter_data.mkdir(parents=True, exist_ok=True)
    nbformat.write(notebook, path)
    as_read = nbformat.read(path, as_version=4)
    NotebookNotary(data_dir=str(jupyter_data)).sign(as_read)
