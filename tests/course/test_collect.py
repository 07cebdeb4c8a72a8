"""`motiondiff-edu collect`: a class of students with all kinds of answers."""

import csv
import json
import shutil
import sys

import notebook_cells
import pytest

from motiondiff_edu.__main__ import main
from motiondiff_edu.course import answers, collect

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="collect needs fork")
NAME = "02_noise.ipynb"
RIGHT = """def my_constant_beta(S, left):
    return 1 - left ** (2 / S)


checks.constant_beta(my_constant_beta)"""
WRONG = RIGHT.replace("2 / S", "1 / S")
LOOP = RIGHT.replace("return 1", "while True:\n        pass\n    return 1")
HOG = RIGHT.replace("return 1", "x = torch.ones(10**12)\n    return 1")
CRASH = RIGHT.replace("return 1", "import os\n    os._exit(3)\n    return 1")
LEAVE = RIGHT.replace("return 1", "raise SystemExit\n    return 1")
LONG = RIGHT.replace("return 1", "raise ValueError('\\udcff' + 'x' * 70_000)\n    return 1")
SHOUT = RIGHT.replace("return 1", "import os; os.system('echo done; echo dead >&2')\n    return 1")
LINGER = RIGHT.replace(
    "return 1", "import os, time\n    if not os.fork():\n        time.sleep(15)\n    return 1"
)
BROKEN = "def my_constant_beta(S, left:\n    return 1\nchecks.constant_beta(my_constant_beta)"


@pytest.fixture(scope="module")
def handed_in(tmp_path_factory):
    """A folder of copies; each student changed the cell of exercise 3 of notebook 02."""
    folder = tmp_path_factory.mktemp("handed_in")
    own = notebook_cells.NOTEBOOKS / "student" / NAME
    changes = {
        "ada": RIGHT, "bo": WRONG, "cy": WRONG, "di": LOOP, "ed": HOG, "fu": CRASH, "gil": LEAVE,
        "ha": BROKEN, "io": None, "mo": LONG, "nic": SHOUT, "oz": LINGER,
    }  # fmt: skip
    for who, source in changes.items():
        notebook = json.loads(own.read_text())
        for cell in notebook["cells"]:
            if source and "checks.constant_beta(" in "".join(cell["source"]):
                if cell["cell_type"] == "code":
                    cell["source"] = source.splitlines(keepends=True)
        (folder / who / "deeper").mkdir(parents=True)
        (folder / who / "deeper" / NAME).write_text(json.dumps(notebook))
    (folder / "jo").mkdir()
    (folder / "jo" / NAME).write_text("{not json")
    (folder / "lou").mkdir()
    shutil.copy(notebook_cells.NOTEBOOKS / NAME, folder / "lou" / NAME)
    (folder / "kit").mkdir()
    (folder / "kit" / NAME).write_text(json.dumps({"cells": []}))
    return folder


@pytest.fixture(scope="module")
def collected(handed_in, tmp_path_factory):
    out = tmp_path_factory.mktemp("out") / "class.csv"
    command = ["collect", str(handed_in), "--out", str(out), "--seconds", "5", "--gigabytes", "1"]
    import contextlib
    import io

    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        assert main(command) in (0, None)
    with out.open() as file:
        return said.getvalue(), list(csv.DictReader(file))


def of(rows, who, exercise="constant_beta"):
    row = next(row for row in rows if (row["student"], row["exercise"]) == (who, exercise))
    return row["result"], row["message"]


def test_each_answer_gets_its_result(collected):
    _, rows = collected
    assert of(rows, "ada") == ("right", "")
    assert of(rows, "bo")[0] == "wrong" and "amplitude" in of(rows, "bo")[1]
    assert of(rows, "di") == ("too slow", "stopped after 5 s")
    assert of(rows, "ed")[0] in ("wrong", "failed", "died")
    assert of(rows, "fu")[0] == "died"
    assert of(rows, "gil")[0] == "failed" and "SystemExit" in of(rows, "gil")[1]
    assert of(rows, "ha")[0] == "failed" and "SyntaxError" in of(rows, "ha")[1]
    assert of(rows, "io") == ("not attempted", "")
    assert of(rows, "jo")[0] == "unreadable" and NAME in of(rows, "jo")[1]
    result, message = of(rows, "mo")
    assert result == "wrong" and "ValueError" in message and "?xxx" in message
    assert len(message) < 600
    assert of(rows, "nic") == of(rows, "oz") == ("right", "")
    assert of(rows, "kit") == ("not attempted", "its cell is gone")


def test_one_bad_answer_does_not_touch_the_others(collected):
    _, rows = collected
    for who in ("ada", "di", "ed", "fu", "io", "mo", "nic"):
        assert of(rows, who, "q_sample") == ("not attempted", "")
    assert len(rows) == 15 * 3


def test_the_table_and_the_commonest_mistakes(collected):
    said, _ = collected
    lines = {line.split()[0]: line for line in said.splitlines() if line[:1].isalpha()}
    assert lines["ada"].split()[1:] == ["..+", "1", "of", "3"]
    assert lines["bo"].split()[1] == "..x" and lines["jo"].split()[1] == "xxx"
    first = said.split("The commonest mistakes:\n")[1].splitlines()[0]
    assert first.startswith("  2 x  02 constant_beta: beta: that leaves the share")


def test_a_copy_with_its_solution_is_right_everywhere(collected):
    said, rows = collected
    lines = {line.split()[0]: line for line in said.splitlines() if line[:1].isalpha()}
    assert lines["lou"].split()[1:] == ["+++", "3", "of", "3"]
    assert of(rows, "lou", "posterior") == ("right", "")


def test_the_last_copy_of_a_student_counts(handed_in, tmp_path):
    import os

    for name in ("old", "new"):
        (tmp_path / "x" / name).mkdir(parents=True)
        (tmp_path / "x" / name / NAME).write_text("{}")
    os.utime(tmp_path / "x" / "old" / NAME, (1, 1))
    found = collect.copies_of(tmp_path, [])
    assert found == {("x", "02"): tmp_path / "x" / "new" / NAME}
    assert collect.copies_of(tmp_path, ["2"]) == found


@pytest.mark.parametrize(
    "arguments, told",
    [
        (["nowhere"], "nowhere is no folder; it should have a folder for each student"),
        (["."], "has no copies of the notebooks; expected for instance"),
    ],
)
def test_what_cannot_be_collected_is_told(arguments, told, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["collect", *arguments]) == 1
    assert told in capsys.readouterr().err


def test_answers_are_found_wherever_they_were_moved_to(tmp_path):
    source = "x = 1\nchecks.bag(my_bag)"
    notebook = {"cells": [{"cell_type": "code", "source": "checks.bag(old)"}]}
    notebook["cells"].append({"cell_type": "code", "source": source, "metadata": {}})
    path = tmp_path / "16.ipynb"
    path.write_text(json.dumps(notebook))
    assert answers.answers(path) == {"bag": source} and answers.exercises(path) == ["bag"]
