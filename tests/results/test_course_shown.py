"""What is counted of pages, text and demos, on small ones made for it."""

import json

import pytest

from tools.results.course import shown


def test_the_form_of_this_checkouts_notebooks_is_within_its_limits():
    found = shown.form()
    assert 1000 < found["words_max"] < 1800 and 1 <= found["ideas_max"] <= 3


def test_figures_that_nobody_printed_are_counted(tmp_path, capsys):
    told = "<details><summary>What happened</summary>\n\nIt is 0.37 m/s.\n</details>"
    cells = [
        {"cell_type": "code", "source": "x", "outputs": [], "metadata": {}},
        {"cell_type": "markdown", "source": told, "metadata": {}},
    ]
    (tmp_path / "02_a.ipynb").write_text(json.dumps({"cells": cells}))
    assert shown.unbacked(tmp_path) == 1 and "0.37" in capsys.readouterr().out
    cells[0]["outputs"] = [{"output_type": "stream", "name": "stdout", "text": ["0.37"]}]
    (tmp_path / "02_a.ipynb").write_text(json.dumps({"cells": cells}))
    assert shown.unbacked(tmp_path) == 0


@pytest.mark.browser
def test_raw_formulas_and_widgets_are_counted_on_all_pages(browser, tmp_path):
    (tmp_path / "docs").mkdir()
    (tmp_path / "a.html").write_text("<p>where $x_0$ is</p><pre class='told'>Button(value=1)</pre>")
    (tmp_path / "docs" / "b.html").write_text("<p>and \\frac{1}{2}; <code>$a$</code></p>")
    found = shown.raw_on_pages(browser, tmp_path)
    assert found == {"pages_raw_formulas": 2, "pages_raw_widgets": 1}


def test_without_pages_it_says_what_to_do(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit, match="make pages"):
        shown.shown_records("c")
