"""`motiondiff-edu handout`: the notebooks of a class, and nothing overwritten."""

import json
import shutil

import pytest

from motiondiff_edu import __main__ as command
from motiondiff_edu.course import jupyter, places
from motiondiff_edu.course.answers import exercises
from motiondiff_edu.course.copies import digest


def test_the_class_gets_exercises_and_hints_and_no_solution(tmp_path, capsys):
    assert command.main(["handout", str(tmp_path / "class")]) == 0
    copies = sorted((tmp_path / "class").glob("*.ipynb"))
    originals = sorted((places.notebook_folder() / "student").glob("*.ipynb"))
    assert [c.name for c in copies] == [o.name for o in originals] and len(copies) >= 18
    for copy, original in zip(copies, originals, strict=True):
        text = copy.read_text()
        assert "<summary>Solution" not in text and "<summary>Hint" in text
        assert exercises(copy) == exercises(original)
    assert (tmp_path / "class" / "docs" / "NOTATION.md").is_file()
    told = capsys.readouterr().out
    assert f"{len(copies)} notebooks without solutions" in told and "lab --folder class" in told


def test_some_notebooks_with_solutions(tmp_path):
    folder = tmp_path / "class"
    assert command.main(["handout", str(folder), "--solutions", "--only", "2", "07"]) == 0
    assert [p.name[:2] for p in sorted(folder.glob("*.ipynb"))] == ["02", "07"]
    for path in folder.glob("*.ipynb"):
        assert "<summary>Solution" in path.read_text()
        assert json.loads(path.read_text())["nbformat"] == 4


@pytest.mark.parametrize("there", ["a file", "a folder with something in it"])
def test_what_is_there_stays(tmp_path, capsys, there):
    place = tmp_path / "class"
    if there == "a file":
        place.write_text("mine")
    else:
        place.mkdir()
        (place / "02_noise.ipynb").write_text("mine")
    assert command.main(["handout", str(place)]) == 1
    assert "is not empty: name a new folder" in capsys.readouterr().err
    kept = place if there == "a file" else place / "02_noise.ipynb"
    assert kept.read_text() == "mine"


def test_a_number_that_is_no_notebook_is_answered_with_those_that_are(tmp_path, capsys):
    assert command.main(["handout", str(tmp_path / "class"), "--only", "02", "77"]) == 1
    message = capsys.readouterr().err
    assert "no notebook 77" in message and "there are: 00, 01" in message
    assert not (tmp_path / "class").exists()


@pytest.fixture
def opened(monkeypatch):
    """Instead of starting JupyterLab: the notebooks that were opened."""
    seen = []
    monkeypatch.setattr(jupyter, "serve", lambda arguments, _: seen.append(arguments) or 0)
    return seen


def test_a_students_lab_leaves_the_folder_of_a_class_as_it_is(tmp_path, capsys, opened):
    """It shows neither solutions nor notebooks that are for later, also in a fresh copy."""
    assert command.main(["handout", str(tmp_path / "week"), "--only", "03", "02"]) == 0
    mine = tmp_path / "at home"
    shutil.copytree(tmp_path / "week", mine)
    first = next(mine.glob("02*.ipynb"))
    filled = json.loads(first.read_text())
    filled["cells"][0]["source"] = "my answer"
    first.write_text(json.dumps(filled))
    before = {path: path.read_bytes() for path in mine.glob("*.ipynb")}
    assert command.main(["lab", "--folder", str(mine)]) == 0
    assert f"--LabApp.default_url=/lab/tree/{first.name}" in opened[0]
    assert {path: path.read_bytes() for path in mine.glob("*.ipynb")} == before
    capsys.readouterr()
    assert command.main(["lab", "--folder", str(mine), "--fresh", "2"]) == 0
    assert "<summary>Solution" not in first.read_text() and "my answer" not in first.read_text()
    assert len(list(mine.glob("*.ipynb"))) == 3  # both of the class, and the one filled in
    assert command.main(["lab", "07", "--folder", str(mine)]) == 1
    assert "no notebook 07 in this class's copies; there are: 02, 03" in capsys.readouterr().err


def test_a_new_edition_reaches_an_unchanged_copy_without_its_solutions(tmp_path, opened):
    mine = tmp_path / "week"
    assert command.main(["handout", str(mine), "--only", "02"]) == 0
    path, record = next(mine.glob("02*.ipynb")), mine / ".lab" / "handed_out.json"
    new = path.read_bytes()
    old = json.loads(new) | {"cells": []}
    path.write_text(json.dumps(old))
    handed_out = json.loads(record.read_text()) | {path.name: digest(path.name, path.read_bytes())}
    record.write_text(json.dumps(handed_out))
    assert command.main(["lab", "--folder", str(mine)]) == 0 and path.read_bytes() == new


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"notebooks": [2], "solutions": false}'])
def test_a_damaged_record_of_the_class_is_said_and_nothing_is_added(tmp_path, capsys, text, opened):
    mine = tmp_path / "week"
    assert command.main(["handout", str(mine), "--only", "02"]) == 0
    (mine / ".lab" / "class.json").write_text(text)
    assert command.main(["lab", "--folder", str(mine)]) == 1 and not opened
    message = capsys.readouterr().err
    assert "class.json" in message and "Ask for a new copy" in message
    assert len(list(mine.glob("*.ipynb"))) == 1


def test_copies_without_the_hidden_record_still_get_no_solutions(tmp_path, opened):
    """Only the visible files were passed on; and then JupyterLab saved one of them."""
    assert command.main(["handout", str(tmp_path / "week"), "--only", "02", "03"]) == 0
    mine = tmp_path / "home"
    shutil.copytree(tmp_path / "week", mine, ignore=shutil.ignore_patterns(".lab"))
    assert command.main(["lab", "--folder", str(mine)]) == 0 and len(opened) == 1
    copies = sorted(mine.glob("*.ipynb"))
    assert [path.name[:2] for path in copies] == ["02", "03"]
    assert not any("<summary>Solution" in path.read_text() for path in copies)


def test_a_plain_folder_of_copies_has_no_mark(tmp_path, opened):
    assert command.main(["lab", "--folder", str(tmp_path / "mine")]) == 0
    copies = sorted((tmp_path / "mine").glob("*.ipynb"))
    assert len(copies) >= 18
    assert not any("motiondiff_class" in path.read_text() for path in copies)
