"""A function says what it takes: at most eight parameters, and none hidden in `**options`."""

import ast
from functools import cache
from pathlib import Path

import notebook_cells

ROOT = Path(__file__).parent.parent
CODE = ("motiondiff_edu", "data_synth", "tools", "benchmarks")
SOURCES = [
    *sorted(path for folder in CODE for path in (ROOT / folder).rglob("*.py")),
    *notebook_cells.sources(),
]
MOST = 8
# functions that take any keyword, and why
OPEN = {
    "_repr_mimebundle_": "Jupyter calls it with keywords of its own",
    "course/checks/_report.py answer": "it wraps a student's function, whatever that takes",
    "widgets/explore.py explore": "the keywords are the parameters of the function that is drawn",
    "widgets/explore.py refresh": "as `explore`",
    "widgets/controls.py steering": "the keywords are those of the function that is steered",
    "results/sweep.py further": "the keywords are fields of a recipe, as in `replace`",
    "tools/mutants.py _with": "the keywords are fields of a node, as in `replace`",
}


def functions(source: str) -> list[tuple[str, int, bool]]:
    """Of each function: its name, how many parameters it names, whether it takes any keyword."""
    found = []
    for node in ast.walk(ast.parse(source)):
        if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
            continue
        given = node.args
        names = [one.arg for one in (*given.posonlyargs, *given.args, *given.kwonlyargs)]
        count = len([name for name in names if name not in ("self", "cls")])
        found.append((getattr(node, "name", "lambda"), count, given.kwarg is not None))
    return found


@cache
def functions_of(path: Path) -> list[tuple[str, int, bool]]:
    """The functions of a file, or of a notebook's cells."""
    return [one for cell in notebook_cells.python_of(path) for one in functions(cell)]


def reason(path: Path, name: str) -> str | None:
    """The entry of OPEN that lets this function take any keyword, if there is one."""
    place = f"{path.as_posix()} {name}"
    return next((one for one in OPEN if name == one or place.endswith(f"/{one}")), None)


def test_parameters_are_counted():
    source = """
class One:
    def method(self, a, /, b, *more, c=1): ...
    @classmethod
    async def made(cls, **options): ...
def outer(a, b=2):
    return lambda x, **_: x
"""
    assert sorted(functions(source)) == [
        ("lambda", 1, True),
        ("made", 0, True),
        ("method", 3, False),
        ("outer", 2, False),
    ]


def test_what_may_take_any_keyword_is_there():
    """No entry of the list outlives its function."""
    found = {
        reason(path, name)
        for path in SOURCES
        for name, _, keywords in functions_of(path)
        if keywords
    }
    assert found == set(OPEN)
    assert reason(ROOT / "motiondiff_edu/widgets/explore.py", "explore")
    assert reason(ROOT / "motiondiff_edu/widgets/explore.py", "redraw") is None
    assert reason(ROOT / "motiondiff_edu/course/checks/nb10.py", "answer") is None


def test_what_a_function_takes_can_be_read_from_its_signature():
    """What always goes together is a small dataclass; keywords are named one by one."""
    wrong = []
    for path in SOURCES:
        for name, count, keywords in functions_of(path):
            where = f"{path.relative_to(ROOT)}: {name} takes"
            if count > MOST:
                wrong.append(f"{where} {count} parameters: group what goes together")
            if keywords and not reason(path, name):
                wrong.append(f"{where} any keyword: name them")
    assert wrong == []
