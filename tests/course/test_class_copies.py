"""`motiondiff-edu handout`: the notebooks of a class, and nothing overwritten."""

import json

import pytest

from motiondiff_edu import __main__ as command
from motiondiff_edu.course import places
from motiondiff_edu.course.answers import exercises


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
    assert f"{len(copies)} notebooks without solutions" in capsys.readouterr().out


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
    assert "no notebook 77; there are: 00, 01" in capsys.readouterr().err
    assert not (tmp_path / "class").exists()
