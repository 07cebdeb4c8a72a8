"""`motiondiff-edu export NOTEBOOK`: the notebook as one page whose figures move without a kernel.

nbconvert alone asks for each widget from the network, and shows nothing where there is none. The
course's widgets have a page of their own in the notebook, which is taken instead.
"""

import argparse
from pathlib import Path
from typing import Any

from .._files import check_writable, replacing
from ..motion.arguments import check_there

HELP = "write a notebook that was run as one page, which moves without a kernel"
EXAMPLE = "export my_notebook.ipynb --out my_notebook.html"
LIVE = "application/vnd.jupyter.widget-view+json"  # needs a kernel, or the network


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `export`."""
    parser.add_argument("notebook", type=Path, help="a notebook that was run and saved")
    parser.add_argument("--out", type=Path, help="the page (default: beside it, as .html)")
    parser.add_argument("--overwrite", action="store_true", help="replace an existing page")


def run(args: argparse.Namespace) -> None:
    """Write the page.  Raises ValueError for what is no notebook, or was not run."""
    check_there(args.notebook)
    out = args.out or args.notebook.with_suffix(".html")
    if out.suffix.lower() != ".html":
        raise ValueError(f"--out {out}: the page's name must end in .html")
    if out.exists() and not args.overwrite:
        raise ValueError(f"{out} exists already: choose another name, or add --overwrite")
    check_writable(out)
    import nbformat
    from nbconvert import HTMLExporter

    try:
        notebook = nbformat.read(args.notebook, as_version=4)
        cells = [(cell.cell_type, cell.source) for cell in notebook.cells]
    except (ValueError, AttributeError, TypeError, OSError) as error:
        raise ValueError(f"{args.notebook} is no notebook: {error!s:.80}") from None
    if not cells:
        raise ValueError(f"{args.notebook} is no notebook: it has no cells")
    figures, others = still_alive(notebook)
    page, _ = HTMLExporter().from_notebook_node(notebook)
    with replacing(out) as aside:
        aside.write_text(page, "utf-8")
    print(f"{out}: {figures} figures that move without a kernel")
    if others:
        print(f"{others} controls need a kernel, and are seen in the notebook alone")


def still_alive(notebook: Any) -> tuple[int, int]:
    """Leave each widget's own page in its output, in place of what needs a kernel.

    Returned are the number of these, and that of widgets without a page.
    Raises ValueError for a notebook without outputs.
    """
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    data = [output.data for cell in code for output in cell.outputs if "data" in output]
    if not any(cell.outputs for cell in code):
        raise ValueError(
            "the notebook has no outputs: run all of its cells, save it, and try again"
        )
    widgets = [one for one in data if LIVE in one and "text/html" in one]
    for one in widgets:
        del one[LIVE]
    others = sum(LIVE in one for one in data)
    if not others:
        notebook.metadata.pop("widgets", None)
    return len(widgets), others
