"""The exercises of a notebook, the answers in a student's copy of it, and what becomes of them."""

import ast
import contextlib
import json
import os
import re
import signal
import stat
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
RESULTS = (RIGHT, OPEN, WRONG, FAILED, SLOW, DIED, UNREADABLE)

LARGEST = 64 * 2**20  # bytes of a notebook; a film in its outputs takes a few million
LONGEST = 500  # characters of a message: a table shows its beginning
CUT = " ..."  # at the end of a longer one


class CopyError(ValueError):
    """A file that is no readable notebook."""


@dataclass(frozen=True)
class Answer:
    """The cell that calls a check, and what the cells before it define (`definitions`)."""

    source: str
    before: tuple[str, ...] = ()


def cells(path: Path) -> list[dict]:
    """The code cells of a notebook, each as {"source", "tags", "outputs"}. Raises CopyError.

    Only regular files are read, and links to them; none is larger than LARGEST.
    """
    try:
        notebook = json.loads(_read(path))
        return [
            {
                "source": "".join(cell["source"]),
                "tags": cell.get("metadata", {}).get("tags", []),
                "outputs": cell.get("outputs", []),
            }
            for cell in notebook["cells"]
            if cell["cell_type"] == "code"
        ]
    except Exception as error:  # a copy may be broken in any way
        raise CopyError(f"{path.name} is not a readable notebook ({_reason(error)})") from error


def _read(path: Path) -> str:
    """The text of a regular file. Raises CopyError for anything else, and OSError."""
    if not stat.S_ISREG(path.stat().st_mode):  # before `open`, which may wait or wake a device
        raise CopyError("it is a folder" if path.is_dir() else "it is not a regular file")
    # no wait should it become a named pipe just now
    flags = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
    with open(os.open(path, flags), "rb") as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise CopyError("it is not a regular file")
        content = file.read(LARGEST + 1)
    if len(content) > LARGEST:
        raise CopyError(f"it is larger than {LARGEST // 2**20} MB")
    return content.decode("utf-8-sig")


def _reason(error: Exception) -> str:
    """Why a copy cannot be read, in plain words."""
    if isinstance(error, FileNotFoundError):
        return "it is not there, or a link to a file that is not there"
    if isinstance(error, PermissionError):
        return "its permissions forbid to read it"
    if isinstance(error, OSError):
        return error.strerror or "the system cannot read it"
    if isinstance(error, UnicodeDecodeError):
        return "it is not UTF-8 text"
    if isinstance(error, json.JSONDecodeError):
        return f"it is not JSON: {error}"
    if isinstance(error, RecursionError):
        return "it is nested too deeply"
    if isinstance(error, MemoryError):
        return "it needs more memory than there is"
    if isinstance(error, KeyError | TypeError | AttributeError):
        return "it is JSON, but not the JSON of a notebook"
    return str(error)


def plain(source: str) -> str:
    """The Python of a cell: lines of IPython's own, %%time for instance, are emptied."""
    return re.sub(r"^[%!].*$", "", source, flags=re.M)


def _parsed(source: str) -> ast.Module | None:
    """The cell as a tree; None for one that was left half-way, or that Python cannot parse."""
    try:
        return ast.parse(plain(source))
    except (SyntaxError, ValueError, RecursionError, MemoryError):
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


# of these modules alone functions are called to make a value: others may take long
CALLED = frozenset("math cmath np numpy torch functools itertools fractions".split())
BUILTIN = frozenset(
    "float int complex bool str list tuple dict set len abs min max sum range sorted round zip"
    " enumerate pow divmod".split()
)
CHANGING = frozenset(
    "append extend insert remove pop clear update add discard sort reverse".split()
)


def definitions(source: str) -> tuple[str, ...]:
    """The imports, functions, classes and values of a cell, as statements.

    Nothing else of it is needed by an answer that is run by itself. A name whose value is made in
    another way is deleted, so that none has a value of before.
    """
    tree = _parsed(source)
    found = []
    for node in tree.body if tree else ():
        with contextlib.suppress(RecursionError):  # a statement nested too deeply is left out
            if _defines(node):
                found.append(ast.unparse(node))
            else:
                found += [GONE.format(name=name) for name in _changed_by(node)]
    return tuple(found)


GONE = "if type({name}).__name__ != 'module': del {name}"


def _defines(node: ast.stmt) -> bool:
    """Whether a statement gives names to modules, functions, classes or values (`_is_value`)."""
    if isinstance(node, ast.Try):
        return all(isinstance(one, ast.Import | ast.ImportFrom) for one in node.body)
    if isinstance(node, ast.Assign | ast.AnnAssign | ast.AugAssign):
        return node.value is not None and _is_value(node.value)
    kinds = (ast.Import, ast.ImportFrom, ast.FunctionDef, ast.ClassDef)
    return isinstance(node, kinds)


def _is_value(node: ast.expr) -> bool:
    """Whether an expression is made of literals, names and sums of such, or is a lambda.

    Functions are called of CALLED and BUILTIN alone.
    """
    if isinstance(node, ast.Lambda):
        return True
    called = (one.func for one in ast.walk(node) if isinstance(one, ast.Call))
    others = (ast.Await, ast.Yield, ast.YieldFrom, ast.NamedExpr, ast.comprehension)
    return all(_root(one) in CALLED | BUILTIN for one in called) and not any(
        isinstance(one, others) for one in ast.walk(node)
    )


def _root(node: ast.expr) -> str:
    """The name that an expression like np.linalg.norm begins with; "" for another one."""
    while isinstance(node, ast.Attribute | ast.Subscript):
        node = node.value
    return node.id if isinstance(node, ast.Name) else ""


def assigned(statement: str) -> list[str]:
    """The names that a statement gives values to."""
    tree = _parsed(statement)
    return [name for node in tree.body for name in _changed_by(node)] if tree else []


def _changed_by(node: ast.AST) -> list[str]:
    """The names that a statement assigns or deletes, also by an item of theirs, and those whose
    values it changes ("table.append(1)").
    """
    names = set()
    for one in _own(node):
        if isinstance(one, ast.Name) and not isinstance(one.ctx, ast.Load):
            names.add(one.id)
        elif isinstance(one, ast.Subscript | ast.Attribute) and not isinstance(one.ctx, ast.Load):
            names.add(_root(one))
        elif isinstance(one, ast.Call) and isinstance(one.func, ast.Attribute):
            names |= {_root(one.func)} if one.func.attr in CHANGING else set()
    return sorted(names - {"", "checks"})


def _own(node: ast.AST) -> Iterator[ast.AST]:
    """A statement's parts, but none of functions and comprehensions, whose names are theirs."""
    apart = (ast.FunctionDef, ast.ClassDef, ast.Lambda, ast.comprehension)
    yield node
    for one in ast.iter_child_nodes(node):
        if not isinstance(one, apart):
            yield from _own(one)


def exercises(path: Path) -> list[str]:
    """The checks of a notebook's exercises, in order. Raises CopyError."""
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


def of_copies(paths: list[Path], handed_out: dict[str, Answer]) -> dict[str, Answer]:
    """{check: the answer of the first copy that has one; else the cell as it was handed out}.

    Raises CopyError where no copy can be read.
    """
    found: dict[str, Answer] = {}
    failed = []
    for path in reversed(paths):  # so the first one has the last word
        try:
            given = of_copy(path)
        except CopyError as error:
            failed.append(error)
            continue
        for name in handed_out.keys() & given.keys():
            if name not in found or given[name].source != handed_out[name].source:
                found[name] = given[name]
    if len(failed) == len(paths):
        raise failed[-1]
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


def written(token: str, result: str, message: str) -> bytes:
    """A result as a line, the message cut, with ? for what UTF-8 cannot write.

    The token belongs to the question: nobody else's answer can have this result.
    """
    cut = message if len(message) <= LONGEST else message[:LONGEST] + CUT
    clean = cut.encode("utf-8", "replace").decode("utf-8")
    return b"\n" + json.dumps([token, result, clean]).encode() + b"\n"


def read_back(line: bytes, token: str) -> tuple[str, str] | None:
    """(result, message) of a line of `written`; None for anything else."""
    try:
        sign, result, message = json.loads(line)
    except Exception:  # whatever ran there may have written it
        return None
    if not all(isinstance(one, str) for one in (sign, result, message)):
        return None
    if sign != token or result not in RESULTS or len(message) > LONGEST + len(CUT):
        return None
    return result, message


def ending(code: int) -> str:
    """How a process without a result ended; below 0 the code is that of a signal."""
    if code >= 0:
        return f"the process ended by itself, with status {code}"
    try:
        name = signal.Signals(-code).name
    except ValueError:
        name = f"signal {-code}"
    why = ", perhaps because it was out of memory" if name == "SIGKILL" else ""
    return f"the process was ended by {name}{why}"
