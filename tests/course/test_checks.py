"""Every check on all kinds of answer.

The notebook's solution and its mutants, the stub, unusual right answers, and the wrong answers of
the zoo.
"""

import functools

import build_student
import mutants
import notebook_cells
import pytest
from right_answers import RIGHT

from motiondiff_edu.course import checks
from motiondiff_edu.course.answers import checks_called
from motiondiff_edu.course.checks import zoo
from motiondiff_edu.course.checks._compare import other_inputs

CHECKS = checks.load_all()
MISTAKES, OTHERS = zoo.load_all()
NAMED = [
    pytest.param(name, hint, answer, id=f"{name}: {hint[:60]} {i}")
    for name in MISTAKES
    for hint, wrong in MISTAKES[name].items()
    for i, answer in enumerate(zoo.several(wrong))
]
SOME_MUTANTS = 16  # of each solution; `python tools/mutants.py` takes all


EXERCISES = [
    pytest.param(path, cell, name, id=f"{path.stem[:2]}-{name}")
    for path in notebook_cells.sources()
    for cell in notebook_cells.code(notebook_cells.read(path), "solution")
    for name in list(checks_called(cell["source"])) or ["no check called"]
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


@pytest.mark.parametrize("name, hint, answer", NAMED)
def test_a_mistake_gets_its_own_hint_on_other_inputs_too(name, hint, answer):
    with other_inputs(7), pytest.raises(checks.CheckFailed) as caught:
        CHECKS[name](answer)
    assert str(caught.value).endswith(f": {hint}")


@pytest.mark.parametrize(
    "name, what", [pytest.param(n, w, id=f"{n}: {w}") for n in OTHERS for w in OTHERS[n]]
)
def test_other_wrong_answers_are_refused(name, what):
    with pytest.raises(checks.CheckFailed) as caught:
        CHECKS[name](OTHERS[name][what])
    assert caught.value.__cause__ is None, (
        f"the wrong answer crashes instead of being refused: {caught.value}"
    )


@pytest.mark.parametrize(
    "name, answer",
    [pytest.param(n, a, id=f"{n} {i}") for n in RIGHT for i, a in enumerate(RIGHT[n])],
)
def test_unusual_right_answers_are_taken(name, answer, capsys):
    with other_inputs(7):
        CHECKS[name](answer)
    assert f"{name}: right." in capsys.readouterr().out


def test_each_check_has_three_unusual_right_answers():
    assert {name: len(RIGHT.get(name, ())) for name in CHECKS if len(RIGHT.get(name, ())) < 3} == {}


@pytest.mark.parametrize("path", notebook_cells.sources(), ids=lambda path: path.stem[:2])
def test_no_mutant_of_a_solution_passes(path):
    for exercise in mutants.exercises(path):
        judged = exercise.judged(SOME_MUTANTS, seeds=(1,))
        assert judged.passing == [], f"checks.{exercise.check} lets them pass"
        assert judged.wrong >= 10, f"too few mutants of {exercise.check} give other results"


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
    with pytest.raises(checks.CheckFailed, match="IndexError: list index out of range$"):
        CHECKS["right_turn"](lambda: [][0])
    with pytest.raises(checks.CheckFailed, match=r"it was given an array \(7, 3\), 4"):
        CHECKS["hold_control"](lambda control, T_h: control[99])


@pytest.mark.parametrize("name", CHECKS)
def test_each_check_has_an_exercise_and_two_wrong_answers(name):
    assert name in {param.values[2] for param in EXERCISES}, (
        f"no cell tagged `solution` calls checks.{name}"
    )
    count = len(MISTAKES.get(name, {})) + len(OTHERS.get(name, {}))
    assert count >= 5, f"checks.{name} needs five wrong answers in checks/zoo"


def test_the_zoo_names_only_checks_there_are():
    assert set(MISTAKES) | set(OTHERS) <= set(CHECKS)
