"""checks/_report.py: how a check speaks; checks/__init__.py: how a check is found."""

import numpy as np
import pytest
import torch

from motiondiff_edu.course import checks
from motiondiff_edu.course.checks import CheckFailed, _report, expect
from motiondiff_edu.course.checks._compare import compare
from motiondiff_edu.course.checks._report import as_array


@pytest.fixture
def double(monkeypatch):
    monkeypatch.setattr(_report, "REGISTRY", {})

    @_report.check
    def double(mine):
        square = {"this is the square": lambda x: x**2}
        compare(mine, lambda x: 2 * x, lambda rng: [(3.0,)], "the double of 3", square)
        return "twice is twice."

    return double


def test_right_prints_one_line_of_content(double, capsys):
    assert double(lambda x: 2 * x) is None
    assert capsys.readouterr().out == "double: right. twice is twice.\n"


def test_stub_is_reported_and_never_raised(double, capsys):
    def stub(x):
        raise NotImplementedError("your turn")

    double(stub)
    assert capsys.readouterr().out == "double: not attempted yet.\n"


@pytest.mark.parametrize(
    "wrong",
    [lambda x: torch.arange(3).softmax(0), lambda x: torch.nn.Module()(x)],
    ids=["softmax of whole numbers", "a module without forward"],
)
def test_what_torch_has_not_implemented_is_a_wrong_answer(double, wrong):
    with pytest.raises(CheckFailed, match="your answer raised NotImplementedError"):
        double(wrong)


def test_likely_mistake_is_named(double):
    with pytest.raises(CheckFailed, match="^double: the double of 3: this is the square$"):
        double(lambda x: x**2)


def test_other_wrong_answer_says_what_it_is_and_should_be(double):
    with pytest.raises(CheckFailed, match="the double of 3 is 7, and should be 6"):
        double(lambda x: x + 4)


def test_answer_that_raises_shows_the_readers_line_and_not_ours(double):
    def broken(x):
        return x + torch.ones(2) @ torch.ones(3)

    with pytest.raises(CheckFailed, match="your answer raised RuntimeError") as caught:
        double(broken)
    shown = "\n".join(caught.value._render_traceback_())
    assert "torch.ones(2) @ torch.ones(3)" in shown and "_report" not in shown


@pytest.mark.parametrize("wrong", ["six", {1}, [[1], [2, 3]]])
def test_what_is_no_number_is_refused(wrong):
    with pytest.raises(CheckFailed, match="expected numbers, got"):
        as_array(wrong)


@pytest.mark.parametrize(
    "value", [[[1.0, 2.0]], np.array([[1, 2]]), torch.tensor([[1.0, 2.0]], requires_grad=True)]
)
def test_numbers_of_all_kinds_are_taken(value):
    assert as_array(value).tolist() == [[1.0, 2.0]]


def test_expect():
    expect(torch.tensor(True), "fine")
    with pytest.raises(CheckFailed, match="mask inverted"):
        expect(np.bool_(False), "mask inverted")


def test_two_checks_of_one_name_are_refused(double):
    def other(mine):
        return None

    other.__name__, other.__module__ = "double", "another.file"
    with pytest.raises(ValueError, match="two checks are called double"):
        _report.check(other)


def test_unknown_check_names_those_there_are():
    with pytest.raises(AttributeError, match="no check called 'nonsense'; there are"):
        checks.nonsense  # noqa: B018
    assert set(checks.load_all()) <= set(dir(checks))
