"""`motiondiff-edu export`: what it refuses, and what it leaves of other widgets."""

import nbformat
import pytest
from nbformat import v4

from motiondiff_edu import __main__ as command
from motiondiff_edu.course.export import LIVE, still_alive


def notebook(*outputs: dict):
    data = [v4.new_output("display_data", one) for one in outputs]
    return v4.new_notebook(cells=[v4.new_code_cell("1", outputs=data)])


@pytest.mark.parametrize(
    "made, told",
    [
        (None, "there is no file"),
        ("HIERARCHY", "is no notebook"),
        (nbformat.writes(notebook()), "has no outputs: run all of its cells"),
    ],
)
def test_what_cannot_be_exported_is_told(made, told, tmp_path, capsys):
    path = tmp_path / "mine.ipynb"
    if made is not None:
        path.write_text(made)
    assert command.main(["export", str(path)]) == 1
    assert told in capsys.readouterr().err and not path.with_suffix(".html").exists()


def test_a_page_that_is_there_is_kept(tmp_path, capsys):
    path = tmp_path / "mine.ipynb"
    nbformat.write(notebook({"text/plain": "3"}), path)
    path.with_suffix(".html").write_text("mine")
    assert command.main(["export", str(path)]) == 1
    assert "exists already" in capsys.readouterr().err
    assert path.with_suffix(".html").read_text() == "mine"
    assert command.main(["export", str(path), "--out", str(tmp_path / "x.pdf")]) == 1
    assert "must end in .html" in capsys.readouterr().err
    assert command.main(["export", str(path), "--overwrite"]) == 0
    assert "<pre>3</pre>" in path.with_suffix(".html").read_text()


def test_widgets_of_others_stay_and_keep_their_state():
    ours, other = {LIVE: {}, "text/html": "<p>"}, {LIVE: {}, "text/plain": "slider"}
    alone, both = notebook(ours), notebook(ours, other)
    for others, one in enumerate((alone, both)):
        one.metadata["widgets"] = {}
        assert still_alive(one) == (1, others)
    assert "widgets" not in alone.metadata and "widgets" in both.metadata
    assert [LIVE in out.data for out in both.cells[0].outputs] == [False, True]
