"""`checks.progress()` counts what is right, in this kernel and in saved copies."""

import json
from contextlib import nullcontext

import pytest

from motiondiff_edu.course import checks
from motiondiff_edu.course.checks import _progress, _report


def cell(source, *outputs):
    return {
        "cell_type": "code",
        "id": source[:8].strip() or "x",
        "metadata": {},
        "source": source,
        "outputs": list(outputs),
    }


def printed(text):
    return {"output_type": "stream", "name": "stdout", "text": [text]}


def failed(text):
    return {"output_type": "error", "ename": "CheckFailed", "evalue": text, "traceback": []}


def write(path, *cells):
    path.parent.mkdir(parents=True, exist_ok=True)
    notebook = {"cells": list(cells), "metadata": {}, "nbformat": 4, "nbformat_minor": 5}
    path.write_text(json.dumps(notebook))


@pytest.fixture
def course(tmp_path, monkeypatch):
    """Two notebooks of three exercises, and a folder of copies."""
    write(
        tmp_path / "student" / "02_noise.ipynb", cell("checks.q_sample(f)"), cell("checks.mean(f)")
    )
    write(tmp_path / "student" / "03_back.ipynb", cell("checks.leap(f)"))
    monkeypatch.setattr(_progress, "notebook_folder", lambda: tmp_path)
    monkeypatch.setattr(_report, "FOUND", {})
    monkeypatch.setattr(_progress, "FOUND", _report.FOUND)
    return tmp_path / "mine"


def told(folder, capsys):
    checks.progress(folder)
    return capsys.readouterr().out.splitlines()


def test_without_copies_nothing_is_attempted(course, capsys):
    assert told(course, capsys) == [
        "02  0 of 2  . q_sample, . mean",
        "03  0 of 1  . leap",
        "0 of 3 exercises are right (x: not yet, a dot: not attempted)",
    ]


def test_saved_copies_count(course, capsys):
    write(
        course / "02_noise.ipynb",
        cell("checks.q_sample(f)", printed("q_sample: right. Six tenths.\n")),
        cell("checks.mean(f)", failed("mean: it is 2, and should be 3")),
    )
    write(course / "03_back.ipynb", cell("checks.leap(f)", printed("leap: not attempted yet.\n")))
    assert told(course, capsys)[:2] == ["02  1 of 2  x mean", "03  0 of 1  . leap"]


def test_this_kernel_counts_more_than_what_was_saved(course, capsys):
    write(course / "03_back.ipynb", cell("checks.leap(f)", printed("leap: right.\n")))
    _report.FOUND["leap"] = False
    assert told(course, capsys)[1] == "03  0 of 1  x leap"
    _report.FOUND["leap"] = True
    assert told(course, capsys)[1] == "03  1 of 1"


def test_a_copy_that_is_no_notebook_counts_as_none(course, capsys):
    course.mkdir()
    (course / "02_noise.ipynb").write_text("half a file")
    assert told(course, capsys)[0] == "02  0 of 2  . q_sample, . mean"


@pytest.mark.parametrize(
    "answer, wanted", [(lambda x, *_: x, False), (None, None)], ids=["wrong", "stub"]
)
def test_a_check_remembers_its_last_answer(monkeypatch, answer, wanted):
    monkeypatch.setattr(_report, "FOUND", {"lengths_of_bones": True})

    def stub(*_):
        raise NotImplementedError("your turn")

    with pytest.raises(checks.CheckFailed) if answer else nullcontext():
        checks.lengths_of_bones(answer or stub)
    assert _report.FOUND.get("lengths_of_bones") is wanted


def test_a_class_sees_its_own_notebooks_alone(course, capsys):
    (course / "mine" / ".lab").mkdir(parents=True)
    (course / "mine" / ".lab" / "class.json").write_text(
        '{"notebooks": ["03"], "solutions": false}'
    )
    assert told(course / "mine", capsys) == [
        "03  0 of 1  . leap",
        "0 of 1 exercises are right (x: not yet, a dot: not attempted)",
    ]
