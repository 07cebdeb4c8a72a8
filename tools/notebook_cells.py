"""Reading notebooks for the tools and tests.

It gives cells and tags, and runs tagged cells without a kernel.
"""

import json
import re
from pathlib import Path

NOTEBOOKS = Path(__file__).parent.parent / "notebooks"


def sources() -> list[Path]:
    """The notebooks (not the student edition), in order."""
    return sorted(path for path in NOTEBOOKS.glob("*.ipynb") if re.match(r"\d\d", path.name))


def read(path: Path) -> dict:
    """A notebook; every cell's source as one string. Raises ValueError when it is not readable."""
    try:
        notebook = json.loads(path.read_text(encoding="utf-8"))
        for cell in notebook["cells"]:
            cell["source"] = "".join(cell["source"])
    except (json.JSONDecodeError, KeyError, TypeError) as error:
        raise ValueError(f"{path} is not a readable notebook ({error})") from error
    return notebook


def tags(cell: dict) -> list[str]:
    return cell.get("metadata", {}).get("tags", [])


def code(notebook: dict, *wanted: str) -> list[dict]:
    """The code cells, or those that have one of the tags."""
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    return [cell for cell in cells if not wanted or set(wanted) & set(tags(cell))]


def python_of(path: Path) -> list[str]:
    """The Python of a file: a module's whole text, or each code cell of a notebook."""
    if path.suffix == ".py":
        return [path.read_text(encoding="utf-8")]
    return [cell["source"] for cell in code(read(path))]


def markdown(notebook: dict) -> list[dict]:
    return [cell for cell in notebook["cells"] if cell["cell_type"] == "markdown"]


def run(cells: list[dict], namespace: dict, name: str = "notebook") -> dict:
    """Execute cells one after the other in a namespace, as a kernel would."""
    namespace.setdefault("__name__", "notebook")
    for cell in cells:
        exec(compile(cell["source"], f"{name}[{cell.get('id', '?')}]", "exec"), namespace)
    return namespace


def start(notebook: dict, name: str = "notebook") -> dict:
    """The namespace after the cells tagged `imports` and `setup`.

    Tagged cells can use its names.
    """
    return run(code(notebook, "imports", "setup"), {}, name)
