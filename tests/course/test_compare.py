"""checks/_compare.py and checks/_differences.py: what a wrong answer is told."""

import numpy as np
import pytest
import torch

from motiondiff_edu.course.checks import CheckFailed, _report
from motiondiff_edu.course.checks._compare import compare, other_inputs

ROOT = {"take the root": lambda x: x}


def squares(rng):
    yield (np.array([[1.0, 4.0, 9.0], [16.0, 25.0, 36.0]]),)
    yield (rng.uniform(1, 5, size=(3, 4)),)


def refused(answer, right=np.sqrt, inputs=squares, what="y", mistakes=None):
    with pytest.raises(CheckFailed) as caught:
        compare(answer, right, inputs, what, mistakes)
    return str(caught.value)


def test_a_mistake_is_named_only_if_it_explains_every_input():
    assert refused(lambda x: x, mistakes=ROOT) == "y: take the root"
    once = lambda x: x if x.shape == (2, 3) else np.sqrt(x) + 1  # noqa: E731
    assert "take the root" not in refused(once, mistakes=ROOT)


def test_one_of_several_functions_of_a_hint_is_enough():
    assert refused(lambda x: x**2, mistakes={"no": (np.cbrt, lambda x: x**2)}) == "y: no"


def test_a_mistake_that_cannot_answer_is_passed_over():
    broken = {"broken": lambda x: x[99], **ROOT}
    assert refused(lambda x: x, mistakes=broken) == "y: take the root"


@pytest.mark.parametrize(
    "answer, told",
    [
        (lambda x: -np.sqrt(x), "y: the sign is wrong everywhere; the numbers are right"),
        (lambda x: 3 * np.sqrt(x), "y: everywhere it is 3 times what it should be"),
        (lambda x: 0 * x, "y: everything is 0"),
        (lambda x: np.sqrt(x) + 0.5, "y: everywhere it is too large by 0.5"),
        (lambda x: np.sqrt(x) - 0.5, "y: everywhere it is too small by 0.5"),
        (lambda x: x, "y: it is the square of what it should be"),
        (lambda x: x**0.25, "y: it is the root of what it should be"),
        (lambda x: 1 / np.sqrt(x), "y: it is one divided by what it should be"),
        (lambda x: 1 - np.sqrt(x), "y: it is one minus what it should be"),
        (lambda x: np.log(np.sqrt(x)), "y: it is the logarithm of what it should be"),
        (
            lambda x: np.sqrt(x) * np.where(np.arange(x.shape[1]) % 2, 1, -1),
            "y: all sizes are right, some signs are not",
        ),
        (
            lambda x: np.sqrt(x).T,
            "y: the numbers are right, but the axes should be in another order: shape (2, 3)",
        ),
        (lambda x: np.sqrt(x)[::-1], "y: the numbers are right, but axis 0 runs backwards"),
        (
            lambda x: np.where(np.arange(x.shape[1]) == 2, 7.0, np.sqrt(x)),
            "y is 7 at (0, 2), and should be 3; only index 2 along axis 1 is wrong",
        ),
        (lambda x: np.sqrt(x)[1:], "y has shape (1, 3), and should have (2, 3)"),
        (lambda x: np.sqrt(x - 5), "y contains NaN or infinity"),
        (
            lambda x: np.where(x > 30, 5.0, np.sqrt(x)),
            "y is 5 at (1, 2), and should be 6; only index 1 along axis",
        ),
    ],
)
@pytest.mark.filterwarnings("ignore:invalid value")
def test_what_differs_is_said(answer, told):
    message = refused(answer)
    assert message == told or message.startswith(told) or "other inputs" in message


def test_rows_that_come_late_or_early_are_seen():
    inputs = lambda rng: [(rng.normal(size=(6, 2)),)]  # noqa: E731
    late = lambda x: np.concatenate([x[:1], x[:-1]])  # noqa: E731
    soon = lambda x: np.concatenate([x[1:], x[-1:]])  # noqa: E731
    told = refused(late, right=np.copy, inputs=inputs)
    assert told == "y: along axis 0 everything comes one place too late"
    told = refused(soon, right=np.copy, inputs=inputs)
    assert told == "y: along axis 0 everything comes one place too early"


def test_it_is_said_when_other_inputs_come_out_right():
    def fails_once(x):
        return np.sqrt(x) if len(x) == 2 else np.sqrt(x) * np.arange(x.shape[1])

    assert refused(fails_once).endswith("(other inputs come out right: 1 of 2)")


def test_an_observation_holds_for_every_input():
    def by_rows(x):
        return len(x) * np.sqrt(x)

    assert "times what it should be" not in refused(by_rows)


def test_parts_are_named():
    parts = ("the mean", "the variance")
    right = lambda x: (x.mean(), x.var())  # noqa: E731
    told = refused(lambda x: (x.mean(), x.std()), right, what=parts)
    assert told == "the variance: it is the root of what it should be"
    told = refused(lambda x: x.mean(), right, what=parts)
    assert told == "return 2 things: the mean and the variance; yours is one"
    told = refused(lambda x: (1, 2, 3), right, what=parts)
    assert told == "return 2 things: the mean and the variance; yours are 3"
    compare(lambda x: [x.mean(), torch.tensor(x.var())], right, squares, parts)


def test_what_explains_all_parts_goes_first():
    right = lambda x: (x, 2 * x)  # noqa: E731
    mistakes = {
        "the first is zero": lambda x: (0 * x, 2 * x),
        "both are zero": lambda x: (0 * x, 0 * x),
    }
    told = refused(lambda x: (0 * x, 0 * x), right, what=("a", "b"), mistakes=mistakes)
    assert told == "a: both are zero"


def test_an_answer_that_draws_is_refused():
    draws = np.random.default_rng(0)  # without a seed, two draws can be as good as equal
    told = refused(lambda x: np.sqrt(x) + draws.normal())
    assert "differs from call to call" in told


def test_complex_answers_are_refused():
    assert "complex" in refused(lambda x: np.sqrt(x) * 1j)
    assert "complex" in refused(lambda x: torch.from_numpy(x) * 1j)


def test_other_inputs_are_other_and_come_back():
    seen = []
    right = lambda x: seen.append(x[0, 0]) or np.sqrt(x)  # noqa: E731
    compare(right, np.sqrt, squares, "y")
    with other_inputs(5):
        compare(right, np.sqrt, squares, "y")
    compare(right, np.sqrt, squares, "y")
    first = seen[:3]
    other = seen[3:6]
    last = seen[6:]
    assert first == last and first[1] != other[1] and first[0] == other[0]


@pytest.fixture
def doubled(monkeypatch):
    monkeypatch.setattr(_report, "REGISTRY", {})

    @_report.check
    def doubled(mine):
        compare(mine, lambda x, more: 2 * x, lambda rng: [(np.ones((2, 3)), [np.ones(2)])], "y")

    return doubled


def in_place(x, more):
    x *= 2
    return x


def list_in_place(x, more):
    more[0][0] = 5
    return 2 * x


def list_shortened(x, more):
    more.pop()
    return 2 * x


@pytest.mark.parametrize(
    "answer, named", [(in_place, "x"), (list_in_place, "more"), (list_shortened, "more")]
)
def test_an_answer_that_changes_its_input_is_told_which(doubled, answer, named):
    told = f"^doubled: your answer changes `{named}`, which it was given; work on a copy$"
    with pytest.raises(CheckFailed, match=told):
        doubled(answer)


def test_a_result_instead_of_the_function_is_told(doubled):
    with pytest.raises(CheckFailed, match=r"hand over the function itself, without \(\)"):
        doubled(np.ones((2, 3)))


def test_an_input_with_nan_that_stays_is_not_changed(monkeypatch):
    monkeypatch.setattr(_report, "REGISTRY", {})

    @_report.check
    def filled(mine):
        compare(mine, np.nan_to_num, lambda rng: [(np.array([1.0, np.nan]),)], "y")

    filled(np.nan_to_num)


def test_one_array_for_several_arrays_is_refused_as_numbers():
    both = lambda x: (x, -x)  # noqa: E731
    told = refused(lambda x: x[0, :2], both, what=("y", "z"))
    assert told == "return 2 arrays: y and z; yours are 2 numbers"


def test_the_choice_that_fails_is_named():
    def inputs(rng):
        for way in ("eps", "v"):
            yield rng.uniform(1, 5, size=4), way

    right = lambda x, way: np.sqrt(x)  # noqa: E731
    told = refused(lambda x, way: np.sqrt(x) + (way == "v") * x, right, inputs)
    assert ", with 'v' (other inputs come out right: 1 of 2)" in told


def test_a_list_whose_numbers_change_is_a_changed_input(doubled):
    """Also where their count stays."""

    def answer(runs):
        runs[0] = 7
        return [2.0, 4.0]

    with pytest.raises(CheckFailed, match="changes `runs`, which it was given"):
        _report._answering(answer)([1, 2])


def test_warnings_of_an_answer_are_not_shown(doubled, recwarn):
    with pytest.raises(CheckFailed):
        doubled(lambda x, more: np.mean(np.array([])))
    assert not recwarn.list
