"""tools/build_student.py: stubs, folded solutions, staleness.

And this checkout's edition is up to date.
"""

import ast
import json
import subprocess

import build_student
import notebook_cells
import pytest

SOLUTION = '''def my_mean(x):
    """The mean."""
    # solution
    total = sum(x)

    return total / len(x)
    # end solution


checks.mean(my_mean)'''
STUB = '''def my_mean(x):
    """The mean."""
    raise NotImplementedError("your turn")


checks.mean(my_mean)'''


def cell(source, kind="code", identity="a1", *tags):
    extra = {"outputs": [{"output_type": "stream"}], "execution_count": 7} if kind == "code" else {}
    return {
        "cell_type": kind,
        "id": identity,
        "metadata": {"tags": list(tags)},
        "source": source,
    } | extra


def write(folder, *cells, name="02_noise.ipynb"):
    folder.joinpath(name).write_text(
        json.dumps({"cells": cells, "metadata": {}, "nbformat": 4, "nbformat_minor": 5})
    )


@pytest.fixture
def folder(tmp_path):
    opening = cell(
        "See [the walker](../docs/walk.gif) and [the next](03_back.ipynb).", "markdown", "m1"
    )
    write(
        tmp_path,
        opening,
        cell("x = [1, 2]", "code", "c1", "imports"),
        cell(SOLUTION, "code", "s1", "solution"),
    )
    return tmp_path


def test_solution_becomes_a_stub_and_is_folded_after_it(folder):
    assert build_student.write(folder) == 1
    cells = notebook_cells.read(folder / "student" / "02_noise.ipynb")["cells"]
    assert [c["id"] for c in cells] == ["m1", "c1", "s1", "s1-solution"]
    assert cells[2]["source"] == STUB and cells[2]["metadata"]["tags"] == ["exercise"]
    told = cells[3]["source"]
    assert told.startswith("<details>") and "return total / len(x)" in told
    assert "# solution" not in told and "checks." not in told
    ast.parse(told.split("```python\n")[1].split("```")[0])


def test_links_out_of_the_folder_go_one_up_and_others_stay(folder):
    build_student.write(folder)
    text = notebook_cells.read(folder / "student" / "02_noise.ipynb")["cells"][0]["source"]
    assert text == "See [the walker](../../docs/walk.gif) and [the next](03_back.ipynb)."


def test_no_outputs_and_the_same_bytes_twice(folder):
    build_student.write(folder)
    path = folder / "student" / "02_noise.ipynb"
    first = path.read_bytes()
    build_student.write(folder)
    assert path.read_bytes() == first
    cells = notebook_cells.read(path)["cells"]
    assert all(
        c["outputs"] == [] and c["execution_count"] is None
        for c in cells
        if c["cell_type"] == "code"
    )


def test_check_finds_missing_changed_and_left_over(folder, capsys):
    check = ["--check", "--folder", str(folder)]
    assert build_student.main(check) == 1 and "02_noise.ipynb: missing" in capsys.readouterr().err
    assert build_student.main(["--folder", str(folder)]) == 0
    assert build_student.main(check) == 0
    write(folder, cell("x = [1, 2, 3]"))
    (folder / "student" / "09_old.ipynb").write_text("{}")
    assert build_student.main(check) == 1
    assert capsys.readouterr().err.splitlines()[1:] == [
        "02_noise.ipynb: changed",
        "09_old.ipynb: left over",
    ]
    assert (
        build_student.main(["--force", "--folder", str(folder)]) == 0
        and build_student.main(check) == 0
    )


def filled_in(path):
    """The edition's notebook with an answer in place of the stub."""
    return path.read_text("utf-8").replace(r"raise NotImplementedError(\"your turn\")", "return 7")


def git(folder, *arguments):
    own = ["-c", "user.name=a", "-c", "user.email=a@b.c", "-c", "commit.gpgsign=false"]
    subprocess.run(["git", *own, *arguments], cwd=folder, check=True, capture_output=True)


def test_an_answer_typed_into_the_edition_is_not_overwritten(folder, capsys):
    make = ["--folder", str(folder)]
    assert build_student.main(make) == 0
    path = folder / "student" / "02_noise.ipynb"
    path.write_text(answered := filled_in(path), "utf-8")
    assert "return 7" in answered
    assert build_student.main(make) == 1 and path.read_text("utf-8") == answered
    told = capsys.readouterr().err
    assert "  student/02_noise.ipynb\n" in told and "make student FORCE=1" in told
    assert build_student.main([*make, "--force"]) == 0 and "return 7" not in path.read_text("utf-8")


def test_a_notebook_of_a_students_own_is_not_removed(folder, capsys):
    (folder / "student").mkdir()
    (folder / "student" / "my_notes.ipynb").write_text("mine")
    assert (
        build_student.main(["--folder", str(folder)]) == 1
        and "my_notes.ipynb" in capsys.readouterr().err
    )
    assert (folder / "student" / "my_notes.ipynb").read_text() == "mine"
    assert not (folder / "student" / "02_noise.ipynb").exists()


def test_what_was_written_last_is_written_again_after_the_source_changed(folder):
    make = ["--folder", str(folder)]
    for source in ("x = [1, 2, 3]", "x = [1, 2, 3, 4]"):
        assert build_student.main(make) == 0
        write(folder, cell(source))
    write(folder, cell("y = 5"), name="05_other.ipynb")
    (folder / "02_noise.ipynb").unlink()
    assert build_student.main(make) == 0
    assert [path.name for path in (folder / "student").glob("*.ipynb")] == ["05_other.ipynb"]


def test_without_a_record_an_edition_that_would_not_change_is_no_obstacle(folder):
    make = ["--folder", str(folder)]
    assert build_student.main(make) == 0
    (folder / "student" / build_student.RECORD).unlink()
    assert build_student.main(make) == 0
    (folder / "student" / build_student.RECORD).unlink()
    write(folder, cell("x = [1, 2, 3]"))
    assert build_student.main(make) == 1


def test_in_a_fresh_clone_what_is_committed_may_be_overwritten_and_nothing_else(folder):
    make, path = ["--folder", str(folder)], folder / "student" / "02_noise.ipynb"
    build_student.write(folder)
    (folder / ".gitignore").write_text("student/*.json\n")
    git(folder, "init")
    git(folder, "add", ".")
    git(folder, "commit", "-m", "all")
    (folder / "student" / build_student.RECORD).unlink()
    write(folder, cell("x = [1, 2, 3]"))
    assert build_student.main(make) == 0
    path.write_text(answered := path.read_text("utf-8").replace("[1, 2, 3]", "[1]"), "utf-8")
    assert build_student.main(make) == 1 and path.read_text("utf-8") == answered
    git(folder, "add", ".")  # what is only staged can still be lost
    assert build_student.main(make) == 1
    git(folder, "commit", "-m", "answers")
    assert build_student.main(make) == 0


@pytest.mark.parametrize(
    "source, message",
    [
        ("def f(x):\n    return x\n\nchecks.f(f)", "needs `# solution`"),
        ("def f(x):\n    # solution\n    return x\n\nchecks.f(f)", "needs `# solution`"),
        ("# solution\ny = 3\n# end solution\nchecks.y(y)", "body of a function"),
    ],
)
def test_solution_cell_of_another_form_is_refused_by_name(tmp_path, capsys, source, message):
    write(tmp_path, cell(source, "code", "s7", "solution"))
    assert build_student.main(["--folder", str(tmp_path)]) == 1
    told = capsys.readouterr().err
    assert message in told and "02_noise.ipynb, cell 0 (s7)" in told


def test_stub_within_a_loop_keeps_its_indent():
    source = (
        "def f(x):\n    for i in x:\n"
        "        # solution\n        y = i\n        # end solution\n    return y"
    )
    wanted = (
        'def f(x):\n    for i in x:\n        raise NotImplementedError("your turn")\n    return y'
    )
    assert build_student.stub(source, "here") == wanted
