"""Every check on three kinds of answer.

The notebook's solution, its stub, and the wrong answers of the zoo.
"""

import ast
import functools

import build_student
import notebook_cells
import pytest

from motiondiff_edu.course import checks
from motiondiff_edu.course.checks import zoo

CHECKS, WRONG = checks.load_all(), zoo.load_all()


def called(source: str) -> list[str]:
    """The checks that a cell calls: checks.<name>(...)."""
    calls = [node.func for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Call)]
    calls = [f for f in calls if isinstance(f, ast.Attribute) and isinstance(f.value, ast.Name)]
    return [f.attr for f in calls if f.value.id == "checks"]


EXERCISES = [
    pytest.param(path, cell, name, id=f"{path.stem[:2]}-{name}")
    for path in notebook_cells.sources()
    for cell in notebook_cells.code(notebook_cells.read(path), "solution")
    for name in called(cell["source"]) or ["no check called"]
]


@functools.cache
def prepared(path):
    """The names that an exercise may rely on: after the cells tagged imports, setup and twin."""
    notebook = notebook_cells.read(path)
    namespace = notebook_cells.start(notebook, path.stem)
    return notebook_cells.run(notebook_cells.code(notebook, "twin"), namespace, path.stem)


@pytest.mark.parametrize("path, cell, name", EXERCISES)
def test_the_solution_is_right(path, cell, name, capsys):
    namespace = dict(prepared(path))
    capsys.readouterr()
    notebook_cells.run([cell], namespace, path.stem)
    assert f"{name}: right." in capsys.readouterr().out


@pytest.mark.parametrize("path, cell, name", EXERCISES)
def test_the_stub_is_not_attempted(path, cell, name, capsys):
    namespace = dict(prepared(path))
    capsys.readouterr()
    notebook_cells.run(
        [cell | {"source": build_student.stub(cell["source"], name)}], namespace, path.stem
    )
    assert f"{name}: not attempted yet." in capsys.readouterr().out


@pytest.mark.parametrize(
    "name, what", [pytest.param(n, w, id=f"{n}: {w}") for n in WRONG for w in WRONG[n]]
)
def test_the_wrong_answer_is_refused(name, what):
    with pytest.raises(checks.CheckFailed) as caught:
        CHECKS[name](WRONG[name][what])
    assert caught.value.__cause__ is None, (
        f"the wrong answer crashes instead of being diagnosed: {caught.value}"
    )


@pytest.mark.parametrize("name", CHECKS)
def test_a_missing_return_is_named(name):
    with pytest.raises(checks.CheckFailed, match="is a `return` missing"):
        CHECKS[name](lambda *args, **kwargs: None)


def test_an_answer_that_raises_says_what_it_was_given():
    def needs_a_first(runs, gap):
        _ = runs[0]
        return zoo.nb08._merge(runs, gap)

    with pytest.raises(
        checks.CheckFailed, match=r"IndexError: list index out of range \(it was given \[\], 2\)"
    ):
        CHECKS["merge_steps"](needs_a_first)
    with pytest.raises(checks.CheckFailed, match=r"it was given an array \(7, 3\), 4"):
        CHECKS["hold_control"](lambda control, T_h: control[99])


@pytest.mark.parametrize("name", CHECKS)
def test_each_check_has_an_exercise_and_two_wrong_answers(name):
    assert name in {param.values[2] for param in EXERCISES}, (
        f"no cell tagged `solution` calls checks.{name}"
    )
    assert len(WRONG.get(name, {})) >= 2, f"checks.{name} needs two wrong answers in checks/zoo"


def test_the_zoo_names_only_checks_there_are():
    assert set(WRONG) <= set(CHECKS)
