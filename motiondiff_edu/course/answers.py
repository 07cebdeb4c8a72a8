"""The exercises of a notebook, and the answers in a student's copy of it."""

import ast
import contextlib
import json
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
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


@dataclass(frozen=True)
class Answer:
    """The cell that calls a check, and what the cells before it define (`definitions`)."""

    source: str
    before: tuple[str, ...] = ()


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


def plain(source: str) -> str:
    """The Python of a cell: lines of IPython's own, %%time for instance, are emptied."""
    return re.sub(r"^[%!].*$", "", source, flags=re.M)


def _parsed(source: str) -> ast.Module | None:
    """The cell as a tree; None for one that was left half-way."""
    try:
        return ast.parse(plain(source))
    except SyntaxError:
        return None


def checks_called(source: str) -> Iterator[str]:
    """The checks that a cell calls: `q_sample` of `checks.q_sample(my_q_sample)`."""
    tree = _parsed(source)
    for node in ast.walk(tree) if tree else ():
        if (
            isinstance(node, ast.Call)
            and isinstance(node.func, ast.Attribute)
            and isinstance(node.func.value, ast.Name)
            and node.func.value.id == "checks"
        ):
            yield node.func.attr


def _intended(source: str) -> Iterable[str]:
    """The checks that a cell calls; those that it writes, where it does not parse."""
    half_way = _parsed(source) is None
    return re.findall(r"\bchecks\.(\w+)", source) if half_way else checks_called(source)


def definitions(source: str) -> tuple[str, ...]:
    """The imports, functions, classes and literal values of a cell, as statements.

    Nothing else of it is needed by an answer that is run by itself.
    """
    tree = _parsed(source)
    kinds = (ast.Import, ast.ImportFrom, ast.FunctionDef, ast.ClassDef)
    nodes = tree.body if tree else ()
    return tuple(ast.unparse(n) for n in nodes if isinstance(n, kinds) or _is_literal(n))


def _is_literal(node: ast.stmt) -> bool:
    """Whether a statement gives a name to a number, text, list of such ..., or a lambda."""
    if not isinstance(node, ast.Assign):
        return False
    with contextlib.suppress(ValueError, TypeError):
        ast.literal_eval(node.value)
        return True
    return isinstance(node.value, ast.Lambda)


def exercises(path: Path) -> list[str]:
    """The checks of a notebook's exercises, in order."""
    found = [name for cell in cells(path) for name in checks_called(cell["source"])]
    return list(dict.fromkeys(found))


def of_copy(path: Path) -> dict[str, Answer]:
    """{check: the last cell that calls it, or that tried to}. Raises CopyError.

    A cell that does not parse counts for the checks whose names it writes, so that it is not lost.
    """
    found: dict[str, Answer] = {}
    before: tuple[str, ...] = ()
    for cell in cells(path):
        answer = Answer(cell["source"], before)
        found |= dict.fromkeys(_intended(cell["source"]), answer)
        before += definitions(cell["source"])
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
