"""The exercises of a notebook, and the answers in a student's copy of it."""

import ast
import json
from collections.abc import Iterator
from pathlib import Path

# what becomes of an answer (`trial`, `collect`)
RIGHT = "right"
OPEN = "not attempted"
WRONG = "wrong"
FAILED = "failed"
SLOW = "too slow"
DIED = "died"
UNREADABLE = "unreadable"


class CopyError(ValueError):
    """A file that is no readable notebook."""


def cells(path: Path) -> list[dict]:
    """The code cells of a notebook, each as {"source", "tags", "outputs"}. Raises CopyError."""
    try:
        notebook = json.loads(path.read_text(encoding="utf-8"))
        return [
            {
                "source": "".join(cell["source"]),
                "tags": cell.get("metadata", {}).get("tags", []),
                "outputs": cell.get("outputs", []),
            }
            for cell in notebook["cells"]
            if cell["cell_type"] == "code"
        ]
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise CopyError(f"{path} is not a readable notebook ({error})") from error


def checks_called(source: str) -> Iterator[str]:
    """The checks that a cell calls: `q_sample` of `checks.q_sample(my_q_sample)`."""
    try:
        tree = ast.parse(source)
    except SyntaxError:  # a cell that was left half-way
        return
    for node in ast.walk(tree):
        if (
            isinstance(node, ast.Call)
            and isinstance(node.func, ast.Attribute)
            and isinstance(node.func.value, ast.Name)
            and node.func.value.id == "checks"
        ):
            yield node.func.attr


def exercises(path: Path) -> list[str]:
    """The checks of a notebook's exercises, in order."""
    found = [name for cell in cells(path) for name in checks_called(cell["source"])]
    return list(dict.fromkeys(found))


def answers(path: Path) -> dict[str, str]:
    """{check: source of the last cell that calls it, or that tried to}.

    A cell that does not parse counts for the check whose name it writes, so that it is not lost.
    """
    found = {}
    for cell in cells(path):
        names = list(checks_called(cell["source"]))
        if not names and "checks." in cell["source"]:
            names = [cell["source"].rpartition("checks.")[2].partition("(")[0].strip()]
        found |= dict.fromkeys(names, cell["source"])
    return found


def outputs(path: Path) -> dict[str, str]:
    """{check: what the last cell that calls it printed or raised}. Raises CopyError."""
    found = {}
    for cell in cells(path):
        told = [
            "".join(one.get("text", [])) + one.get("evalue", "")
            for one in cell["outputs"]
            if one.get("output_type") in ("stream", "error")
        ]
        found |= dict.fromkeys(checks_called(cell["source"]), "\n".join(told))
    return found


def preparation(path: Path) -> list[str]:
    """The cells that an exercise may rely on: those tagged imports, setup and twin."""
    wanted = {"imports", "setup", "twin"}
    return [cell["source"] for cell in cells(path) if wanted & set(cell["tags"])]
