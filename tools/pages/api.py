"""The API as pages that need no network, written by pdoc from signatures and docstrings.

    python -m tools.pages.api build/pages/api

Every public module of the library and of its data has a page. The checks of the notebooks have
none, for they hold the answers.
"""

import importlib
import pkgutil
import sys
import warnings
from pathlib import Path

import pdoc

THEME = Path(__file__).with_name("api_theme")
PACKAGES = ("motiondiff_edu", "data_synth")
LEFT_OUT = ("motiondiff_edu.course.checks",)


def modules() -> list[str]:
    """The packages, their public modules and folders (pdoc itself walks these), and what has none.

    pdoc takes the modules of a package from its `__all__`, and the front door's has none.
    """
    names = []
    for package in map(importlib.import_module, PACKAGES):
        inside = (one.name for one in pkgutil.iter_modules(package.__path__))
        names += [package.__name__]
        names += [f"{package.__name__}.{name}" for name in inside if not name.startswith("_")]
    return [*names, *(f"!{name}" for name in LEFT_OUT)]


def write(target: Path, names: list[str] | None = None) -> Path:
    """Write the pages of these modules (default: all) and an index; return the index."""
    pdoc.render.configure(docformat="markdown", show_source=False, template_directory=THEME)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "The module specification")  # found by two ways
        pdoc.pdoc(*(names or modules()), output_directory=target)
    return target / "index.html"


if __name__ == "__main__":
    print(write(Path(sys.argv[1])))
