"""A notebook for a demo: run once and kept, with outputs that need no kernel."""

import json
import os
from pathlib import Path

import nbformat
import pytest
from nbformat.sign import NotebookNotary

from motiondiff_edu.course import demo, prepared

PLAYER = """import numpy as np
from motiondiff_edu.widgets.player import Player
Player(np.zeros((3, 21, 3)) + np.random.rand(21, 3), labels="alive")"""


def cell(source, *tags, kind="code"):
    made = nbformat.v4.new_code_cell(source) if kind == "code" else nbformat.v4.new_markdown_cell()
    made.source = source
    made.metadata["tags"] = list(tags)
    return made


@pytest.fixture
def place(tmp_path: Path, monkeypatch) -> Path:
    monkeypatch.setenv("MOTIONDIFF_CACHE", str(tmp_path / "cache"))
    return tmp_path / "07_shown.ipynb"


def write(path: Path, *cells) -> None:
    nbformat.write(nbformat.v4.new_notebook(cells=list(cells)), path)


@pytest.fixture(scope="module")
def run(tmp_path_factory) -> tuple[nbformat.NotebookNode, Path]:
    """A notebook with all kinds of outputs, run once; and its file."""
    folder = tmp_path_factory.mktemp("shown")
    path = folder / "07_shown.ipynb"
    write(
        path,
        cell("# Shown", kind="markdown"),
        cell("import os\nprint(os.environ['MOTIONDIFF_LARGE'], os.getcwd())", "imports"),
        cell(PLAYER),
        cell("import ipywidgets\nipywidgets.Button(description='Go')"),
        cell("x = 1", "solution"),
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("MOTIONDIFF_CACHE", str(folder / "cache"))
        return prepared.prepare_notebook(path, folder), path


def outputs(cell) -> dict:
    return cell.outputs[0].get("data", {})


def test_the_first_moving_figure_stands_above_the_title(run):
    first, title = run[0].cells[:2]
    assert prepared.MOVING in outputs(first)["text/html"] and title.source == "# Shown"
    assert outputs(first) == outputs(run[0].cells[3])


def test_nothing_waits_for_a_kernel(run):
    assert prepared.WIDGET not in json.dumps(run[0])
    assert "Run All Cells" in outputs(run[0].cells[4])["text/html"]
    assert "widgets" not in run[0].metadata


def test_it_runs_in_its_folder_with_large_figures(run):
    told = run[0].cells[2].outputs[0].text
    assert told.split() == ["1", str(run[1].parent)]


def test_imports_and_solutions_are_folded_and_nothing_else_but_the_figure(run):
    folded = [c.metadata.get("jupyter", {}).get("source_hidden", False) for c in run[0].cells]
    assert folded == [True, False, True, False, False, True]


def test_a_second_demo_runs_nothing(run, monkeypatch):
    monkeypatch.setenv("MOTIONDIFF_CACHE", str(run[1].parent / "cache"))
    monkeypatch.setattr(prepared, "run_cells", lambda *_: pytest.fail("it was run again"))
    again = prepared.prepare_notebook(run[1], run[1].parent)
    assert [c.source for c in again.cells] == [c.source for c in run[0].cells]


def test_a_changed_notebook_is_run_again_and_the_old_one_is_not_kept(place, monkeypatch):
    monkeypatch.setattr(prepared, "run_cells", lambda notebook, *_: notebook)
    for source in ("x = 1", "x = 2"):
        write(place, cell(source))
        assert prepared.prepare_notebook(place, place.parent).cells[0].source == source
    assert len(list((place.parent / "cache").iterdir())) == 1


def test_changed_code_of_the_package_counts_as_another_notebook(place, monkeypatch, tmp_path):
    write(place, cell("x = 1"))
    monkeypatch.setattr(prepared, "PACKAGE", tmp_path / "package")
    (tmp_path / "package").mkdir()
    before = prepared.digest(place)
    (tmp_path / "package" / "walker.py").write_text("speed = 1")
    changed = prepared.digest(place)
    assert changed != before
    (tmp_path / "package" / "walker.json").write_text("{}")  # the card of new weights
    assert prepared.digest(place) not in (before, changed)


def test_a_changed_player_and_another_profile_count_as_well(place, monkeypatch, tmp_path):
    write(place, cell("x = 1"))
    monkeypatch.delenv("MOTIONDIFF_PROFILE", raising=False)
    monkeypatch.setattr(prepared, "PACKAGE", tmp_path / "package")
    (tmp_path / "package" / "widgets" / "js").mkdir(parents=True)
    found = [prepared.digest(place)]
    (tmp_path / "package" / "widgets" / "js" / "player.js").write_text("export const speed = 1;")
    found.append(prepared.digest(place))
    monkeypatch.setenv("MOTIONDIFF_PROFILE", "full")
    found.append(prepared.digest(place))
    assert len(set(found)) == 3
    monkeypatch.setenv("MOTIONDIFF_PROFILE", "fast")
    assert prepared.digest(place) == found[1]


def test_an_error_is_told_in_words_and_the_notebook_opens_as_it_is(place, capsys, tmp_path):
    write(place, cell("1 / 0"))
    before = place.read_bytes()
    with pytest.raises(prepared.PreparationError, match="07_shown stopped with ZeroDivisionError"):
        prepared.prepare_notebook(place, place.parent)
    demo.prepare(place, tmp_path / "jupyter")
    assert "It opens without outputs" in capsys.readouterr().out and place.read_bytes() == before


@pytest.mark.parametrize(
    "source, told",
    [
        ("import os\nos._exit(9)", "the kernel of 07_shown died"),
        ("import time\ntime.sleep(60)", "a cell of 07_shown took more than 5 s"),
    ],
)
def test_a_kernel_that_dies_or_hangs_leaves_the_notebook_as_it_is(
    source, told, place, capsys, tmp_path, monkeypatch
):
    monkeypatch.setattr(prepared, "SECONDS", 5)
    write(place, cell(source))
    before = place.read_bytes()
    demo.prepare(place, tmp_path / "jupyter")
    assert f"{told}. It opens without outputs." in capsys.readouterr().out
    assert place.read_bytes() == before


def test_where_nothing_can_be_kept_it_is_shown_all_the_same(place, monkeypatch, capsys):
    (place.parent / "cache").write_text("a file where the folder should be")
    monkeypatch.setattr(prepared, "run_cells", lambda notebook, *_: notebook)
    write(place, cell("x = 1"))
    assert prepared.prepare_notebook(place, place.parent).cells[0].source == "x = 1"
    assert "cannot be kept" in capsys.readouterr().out


def test_the_copy_is_trusted_so_its_figures_may_move(run, tmp_path):
    path, data = tmp_path / "07_copy.ipynb", tmp_path / "jupyter"
    prepared.write_trusted(run[0], path, data)
    notary = NotebookNotary(data_dir=str(data))
    assert notary.check_signature(nbformat.read(path, as_version=4))
    other = NotebookNotary(data_dir=str(tmp_path / "elsewhere"))
    os.makedirs(other.data_dir)
    assert not other.check_signature(nbformat.read(path, as_version=4))
