"""The form of a notebook.

It has rules for length, opening, tags, exercises and closing, and against ties to one machine.

python tools/check_notebooks.py [NOTEBOOK ...]     lists all faults; exit 1 if there are any
"""

import ast
import math
import re
import symtable
import sys
from collections.abc import Iterator
from pathlib import Path

import build_student
import notebook_cells
from notebook_cells import code, markdown, tags

CELLS, WORDS = (25, 45), 1800  # of the short path
EXTRA_CELLS, EXTRA_WORDS = 12, 500
IDEAS = 3
BEFORE = (1, 3, 7)  # each notebook opens with questions from those so many numbers before
LINES = 8  # logical lines: a statement over several rows counts once
LONG_SHARE = 0.10
LINES_AT_MOST = 16
ROWS_AT_MOST = 32
COLUMNS = 88
NO_TWINS = {"00"}  # notebook 00: nothing is built by hand

OPENING = {  # texts that the cells before the imports must have
    "what you will be able to do": r"you (will|can).{0,20} be able to|be able to",
    "what it needs": r"\bneeds?\b",
    "the paper's section": r"\b(MoDiff|MoFusion|paper)\b",
    "its minutes": r"\*\*Minutes:\*\* \d+ in class\b.*; not yet timed on students\.",
    "the symbols": r"\bsymbols?\b",
}
CLOSING = {
    "three things to keep": r"three things|to keep\b|take away",
    "what to read next": r"\bnext\b",
}
FORBIDDEN = {
    "pip": r"(?m)^\s*[!%]\s*(pip|conda)\b|\bpip install\b",
    "a magic or shell line": r"(?m)^\s*[!%]",
    "a path edit": r"sys\.path",
    "os.chdir": r"\bchdir\b",
    "a download": r"urlopen|urlretrieve|requests\.get|wget|curl ",
    "an absolute path": r"""["'](/(?!/)[a-z]+/|[A-Z]:\\)""",
}


def lines(cell: dict) -> int:
    """Logical lines of code: a statement counts once, also when it is wrapped over several rows."""
    return sum(isinstance(node, ast.stmt) for node in ast.walk(parsed(cell)))


def rows(cell: dict) -> int:
    """Rows of code: blank rows and whole-row comments are not counted."""
    stripped = (row.strip() for row in cell["source"].splitlines())
    return sum(bool(row) and not row.startswith("#") for row in stripped)


def length(notebook: dict) -> Iterator[str]:
    """25-45 cells, most code cells of at most 8 logical lines, under 1,800 words.

    What is extra has limits of its own. The lines of the cell of imports are not counted.
    """
    extra = [cell for cell in notebook["cells"] if "extra" in tags(cell)]
    count = len(notebook["cells"]) - len(extra)
    if not CELLS[0] <= count <= CELLS[1]:
        yield f"{count} cells; one sitting has {CELLS[0]} to {CELLS[1]}"
    if len(extra) > EXTRA_CELLS:
        yield f"{len(extra)} extra cells; {EXTRA_CELLS} at most"
    words = words_of(notebook, extra=False)
    if words >= WORDS:
        yield f"{words} words; keep under {WORDS}"
    words = words_of(notebook, extra=True)
    if words > EXTRA_WORDS:
        yield f"{words} words in extra cells; {EXTRA_WORDS} at most"
    cells = [cell for cell in code(notebook) if "imports" not in tags(cell)]
    sizes = [lines(cell) for cell in cells]
    long = sum(size > LINES for size in sizes)
    if long > math.ceil(LONG_SHARE * len(sizes)):
        yield f"{long} of {len(sizes)} code cells have more than {LINES} lines; one in ten may"
    if max(sizes, default=0) > LINES_AT_MOST:
        yield f"a code cell of {max(sizes)} lines; {LINES_AT_MOST} at most"
    tall = max(map(rows, cells), default=0)
    if tall > ROWS_AT_MOST:
        yield f"a code cell of {tall} rows, which no screen shows at once; {ROWS_AT_MOST} at most"


def words_of(notebook: dict, extra: bool) -> int:
    """The words of the extra cells, or of the others; targets of links do not count."""
    cells = [cell for cell in markdown(notebook) if ("extra" in tags(cell)) == extra]
    texts = [re.sub(r"<!--.*?-->|(?<=\])\([^)\s]+\)", "", cell["source"]) for cell in cells]
    return sum(len(re.findall(r"[^\W_][\w'-]*", text)) for text in texts)


def ideas(notebook: dict) -> list[str]:
    """The new ideas that a notebook's opening names."""
    found = re.search(r"(?m)^\*\*New here:\*\* (.+)\.$", notebook["cells"][0]["source"])
    return found[1].split("; ") if found else []


def start(notebook: dict, name: str) -> Iterator[str]:
    """At most three new ideas; questions from the last notebook, the third and seventh before."""
    found = ideas(notebook)
    if not 1 <= len(found) <= IDEAS:
        yield f"{len(found)} new ideas (**New here:** one; two; three.); one to {IDEAS}"
    text = notebook["cells"][0]["source"]
    wanted = [f"{int(name[:2]) - back:02d}" for back in BEFORE if int(name[:2]) >= back]
    asked = re.findall(r"(?m)^\d\. \((\d\d)\) (?:.+\?|Name .+\.)$", text)
    if asked != wanted:
        yield f"the opening asks questions from {asked or 'nowhere'}; it should from {wanted}"
    folded = re.search(r"(?s)<details><summary>Answers</summary>(.+)</details>", text)
    answers = len(re.findall(r"(?m)^\d\. ", folded[1])) if folded else 0
    if answers != len(wanted):
        yield f"{answers} folded answers to {len(wanted)} questions of the opening"


def extras(notebook: dict) -> Iterator[str]:
    """Extra cells come in runs, whose first cell says so; no other cell says it."""
    before = False
    for cell in notebook["cells"][1:]:
        said = "(extra" in cell["source"].split("\n", 1)[0]
        begins = "extra" in tags(cell) and not before
        if begins and not (said and cell["cell_type"] == "markdown"):
            yield f"cell {cell.get('id')} begins what is extra, and does not say (extra)"
        if said and "extra" not in tags(cell):
            yield f"cell {cell.get('id')} says (extra), and is not tagged so"
        before = "extra" in tags(cell)


def width(notebook: dict) -> Iterator[str]:
    """Code of at most 88 columns: a laptop with the file browser open shows no more."""
    for cell in code(notebook):
        for number, row in enumerate(cell["source"].splitlines(), 1):
            if len(row) > COLUMNS:
                where = f"cell {cell.get('id')}, line {number}"
                yield f"{where} has {len(row)} columns; {COLUMNS} at most"


def storage(notebook: dict) -> Iterator[str]:
    """No outputs, stable cell ids, code that parses."""
    if any(cell.get("outputs") or cell.get("execution_count") for cell in code(notebook)):
        yield "outputs are stored; strip them (nbstripout)"
    ids = [cell.get("id") for cell in notebook["cells"]]
    if None in ids or len(set(ids)) < len(ids):
        yield "cell ids are missing or repeated"
    for cell in code(notebook):
        try:
            ast.parse(cell["source"])
        except SyntaxError as error:
            yield f"cell {cell.get('id')} does not parse: {error}"


def opening(notebook: dict) -> Iterator[str]:
    """Before the imports: aim, needs, paper, minutes, symbols.

    Then one imports cell that starts the run.
    """
    imports = code(notebook, "imports")
    if len(imports) != 1 or "runtime.start(" not in imports[0]["source"]:
        yield "there must be one cell tagged `imports`, which calls runtime.start(...)"
        return
    if code(notebook)[0] is not imports[0]:
        yield "the cell tagged `imports` must be the first code cell"
    before = notebook["cells"][: notebook["cells"].index(imports[0])]
    text = "\n".join(cell["source"] for cell in before)
    yield from (
        f"the opening does not say {what}"
        for what, p in OPENING.items()
        if not re.search(p, text, re.I)
    )
    if not text.lstrip().startswith("# "):
        yield "the first cell must begin with a title (# ...)"
    for cell in code(notebook)[1:]:
        if any(isinstance(node, ast.Import | ast.ImportFrom) for node in parsed(cell).body):
            yield f"cell {cell.get('id')} imports; all imports belong in the cell tagged `imports`"


def parsed(cell: dict) -> ast.Module:
    try:
        return ast.parse(cell["source"])
    except SyntaxError:
        return ast.Module([], [])


def closing(notebook: dict) -> Iterator[str]:
    """The last cells: what to keep, what to read next."""
    text = "\n".join(
        cell["source"] for cell in notebook["cells"][-4:] if cell["cell_type"] == "markdown"
    )
    yield from (
        f"the closing does not say {what}"
        for what, p in CLOSING.items()
        if not re.search(p, text, re.I)
    )


def exercises(notebook: dict, name: str) -> Iterator[str]:
    """Two or more exercises, each with minutes, difficulty, a hint and a check.

    The text is before the cell, the check is in it.
    """
    cells = notebook["cells"]
    found = [
        index
        for index, cell in enumerate(cells)
        if cell["cell_type"] == "code" and "solution" in tags(cell)
    ]
    if len(found) < 2:
        yield f"{len(found)} cells tagged `solution`; a notebook has two exercises or more"
    for index in found:
        where = f"exercise in cell {cells[index].get('id')}"
        text = before(cells, index)
        if not re.search(r"\bmin(utes?)?\b", text) or not re.search(
            r"difficulty|easy|medium|hard|[★☆●○]", text, re.I
        ):
            yield f"{where}: the text before it must give minutes and difficulty"
        if "<details" not in text or not re.search("hint", text, re.I):
            yield f"{where}: the text before it must fold a hint into <details>"
        if not re.search(r"^checks\.\w+\(", cells[index]["source"], re.M):
            yield f"{where}: the same cell must call its check"
        try:
            build_student.stub(cells[index]["source"], where)
        except build_student.StudentError as error:
            yield str(error)


def independence(notebook: dict) -> Iterator[str]:
    """No cell uses what an exercise defines: in the student edition that is a stub.

    With this rule both editions are the same but for the exercises' own cells.
    """
    bound = {id(cell): defined(cell) for cell in code(notebook, "solution")}
    for cell in code(notebook):
        others = set().union(*(names for key, names in bound.items() if key != id(cell)))
        used = {
            node.id
            for node in ast.walk(parsed(cell))
            if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)
        }
        yield from (
            f"cell {cell.get('id')} uses {name} of an exercise, which may not be done yet"
            for name in sorted(used & others - bound.get(id(cell), set()))
        )


def skippable(notebook: dict) -> Iterator[str]:
    """No cell uses what only an extra cell has defined: a class leaves these out."""
    in_extra: dict[str, bool] = {}
    for cell in code(notebook):
        used, bound = names_of(cell)
        extra = "extra" in tags(cell)
        for name in sorted(used) if not extra else ():
            if in_extra.get(name):
                yield f"cell {cell.get('id')} uses {name} of an extra cell, which may be left out"
        in_extra |= dict.fromkeys(bound, extra)


def names_of(cell: dict) -> tuple[set[str], set[str]]:
    """The names of the notebook that a cell uses and does not define itself, and those it defines.

    Local names of functions and of comprehensions are neither.
    """
    try:
        top = symtable.symtable(cell["source"], "a cell", "exec")
    except SyntaxError:
        return set(), set()
    inner, waiting = set(), list(top.get_children())
    while waiting:
        table = waiting.pop()
        waiting += table.get_children()
        inner |= {one.get_name() for one in table.get_symbols() if one.is_global()}
    symbols = top.get_symbols()
    bound = {one.get_name() for one in symbols if one.is_assigned() or one.is_imported()}
    used = inner | {one.get_name() for one in symbols if one.is_referenced()}
    return used - bound, bound


def defined(cell: dict) -> set[str]:
    """The functions and variables that the top level of a cell gives a value."""
    names = set()
    for statement in parsed(cell).body:
        if isinstance(statement, ast.FunctionDef | ast.ClassDef):
            names.add(statement.name)
        names |= {
            node.id
            for target in getattr(statement, "targets", [getattr(statement, "target", None)])
            if target is not None
            for node in ast.walk(target)
            if isinstance(node, ast.Name)
        }
    return names


def before(cells: list[dict], index: int) -> str:
    """The markdown between a cell and the code cell before it."""
    text = []
    while index and cells[index - 1]["cell_type"] == "markdown":
        index -= 1
        text.append(cells[index]["source"])
    return "\n".join(reversed(text))


def room(notebook: dict) -> Iterator[str]:
    """Three questions for the room or more, and seeds."""
    text = "\n".join(cell["source"] for cell in markdown(notebook))
    found = re.search(
        r"(?s)\*\*Questions for the room[.:]\*\*(.+?)(?:\*\*Seeds[.:]\*\*|\n\n\*\*)", text
    )
    asked = found[1].count("?") if found else 0
    if asked < 3:
        yield f"{asked} questions for the room; three or more"
    if not re.search(r"\*\*Seeds[.:]\*\*", text):
        yield "it names no **Seeds** that show well, or fail instructively"


def lesson(notebook: dict, name: str) -> Iterator[str]:
    """Two to four predictions, step-by-step cells, pictures that say what they show."""
    text = "\n".join(cell["source"] for cell in markdown(notebook))
    predictions = len(re.findall(r"\*\*Predict", text))
    if not 2 <= predictions <= 4:
        yield f"{predictions} times **Predict**; two to four"
    if name[:2] not in NO_TWINS and not code(notebook, "twin"):
        yield "no cell tagged `twin`: where is the step-by-step version?"
    if re.search(r"!\[\s*\]\(", text) or any(
        "alt=" not in image for image in re.findall(r"<img\b[^>]*>", text)
    ):
        yield "an image without alt text"


def portable(notebook: dict) -> Iterator[str]:
    """No code that installs, downloads, edits paths or depends on one machine."""
    text = "\n".join(cell["source"] for cell in code(notebook))
    yield from (
        f"{what} in a code cell" for what, pattern in FORBIDDEN.items() if re.search(pattern, text)
    )


def faults(path: Path) -> list[str]:
    """All faults in the form of one notebook."""
    notebook = notebook_cells.read(path)
    rules = (length, width, storage, opening, extras, closing, room, independence)
    rules += (skippable, portable)
    plain = [rule(notebook) for rule in rules]
    return [
        fault
        for rule in [*plain, *(rule(notebook, path.name) for rule in (start, exercises, lesson))]
        for fault in rule
    ]


def main(arguments: list[str]) -> int:
    paths = [Path(argument) for argument in arguments] or notebook_cells.sources()
    found = [f"{path.name}: {fault}" for path in paths for fault in faults(path)]
    print("\n".join(found) or f"{len(paths)} notebooks have the form")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
