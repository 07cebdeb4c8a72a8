"""course/copies.py: copies are renewed, and nothing that a student changed is overwritten."""

import json
import re
from pathlib import Path

import links
import pytest

from motiondiff_edu.course import anchors, copies
from motiondiff_edu.course.copies import FolderError, hand_out, make_fresh
from motiondiff_edu.course.places import notebook_folder


def notebook(*sources: str, outputs: tuple = ()) -> str:
    """A notebook's text: the first cell markdown, the others code."""
    cells = [{"cell_type": "markdown", "id": "m", "metadata": {}, "source": [sources[0]]}]
    for number, source in enumerate(sources[1:]):
        cell = {"cell_type": "code", "id": f"c{number}", "metadata": {}, "source": [source]}
        cells.append(cell | {"execution_count": None, "outputs": list(outputs)})
    return json.dumps({"cells": cells, "metadata": {}, "nbformat": 4, "nbformat_minor": 5})


@pytest.fixture
def course(tmp_path) -> Path:
    """notebooks/ with a student edition of two, and docs/ beside it."""
    edition = tmp_path / "course" / "notebooks" / "student"
    (tmp_path / "course" / "docs" / "results").mkdir(parents=True)
    edition.mkdir(parents=True)
    (edition / "00_start.ipynb").write_text(notebook("See [this](../../docs/RESULTS.md).", "x = 1"))
    (edition / "03_back.ipynb").write_text(notebook("[first](00_start.ipynb)", "y = 2", "z = 3"))
    (tmp_path / "course" / "docs" / "RESULTS.md").write_text("![map](results/map.png)")
    (tmp_path / "course" / "docs" / "results" / "map.png").write_bytes(b"PNG")
    (tmp_path / "course" / "docs" / "results" / "walker.json").write_text("[]")
    (tmp_path / "course" / "docs" / ".editor").mkdir()
    (tmp_path / "course" / "docs" / ".editor" / "draft.md").write_text("not for students")
    return edition.parent


@pytest.fixture
def mine(course, tmp_path) -> Path:
    """The folder of copies after the first time."""
    hand_out(course, tmp_path / "mine")
    return tmp_path / "mine"


def upgrade(course: Path, name: str = "03_back.ipynb") -> str:
    """A newer version of one notebook; its text."""
    (course / "student" / name).write_text(new := notebook("newer", "y = 20", "z = 30"))
    return new


def test_what_is_handed_out_and_where_its_links_lead(mine):
    there = sorted(
        p.relative_to(mine).as_posix()
        for p in mine.rglob("*")
        if p.is_file() and ".lab" not in p.parts
    )
    assert there == ["00_start.ipynb", "03_back.ipynb", "docs/RESULTS.md", "docs/results/map.png"]
    cells = json.loads((mine / "00_start.ipynb").read_text())["cells"]
    assert cells[0]["source"] == ["See [this](docs/RESULTS.md)."]


def test_a_second_time_changes_nothing(course, mine):
    before = {path: (path.stat().st_mtime_ns, path.stat().st_ino) for path in mine.rglob("*")}
    assert hand_out(course, mine) == copies.Handout((), ())
    assert {
        path: (path.stat().st_mtime_ns, path.stat().st_ino) for path in mine.rglob("*")
    } == before


def test_an_untouched_copy_is_renewed(course, mine):
    new = upgrade(course)
    assert hand_out(course, mine) == copies.Handout(("03_back.ipynb",), ())
    assert (mine / "03_back.ipynb").read_text() == new
    assert hand_out(course, mine) == copies.Handout((), ())
    (course / "student" / "03_back.ipynb").write_text(notebook("newer still", "y = 2"))
    assert hand_out(course, mine) == copies.Handout(("03_back.ipynb",), ())


def test_a_copy_that_was_only_looked_at_counts_as_untouched(course, mine):
    path = mine / "03_back.ipynb"
    seen = json.loads(path.read_text())
    seen["metadata"]["language_info"] = {"name": "python", "version": "3.12.1"}
    seen["cells"][1]["metadata"]["collapsed"] = True
    path.write_text(json.dumps(seen, indent=1))
    new = upgrade(course)
    assert hand_out(course, mine).renewed == ("03_back.ipynb",) and path.read_text() == new


RAN = [{"output_type": "stream", "name": "stdout", "text": ["2\n"]}]


@pytest.mark.parametrize(
    "changed",
    [
        pytest.param(notebook("[first](00_start.ipynb)", "y = my_answer", "z = 3"), id="an answer"),
        pytest.param(notebook("my notes", "y = 2", "z = 3"), id="a note"),
        pytest.param(
            notebook("[first](00_start.ipynb)", "y = 2", "z = 3", "mine"), id="a cell more"
        ),
        pytest.param(
            notebook("[first](00_start.ipynb)", "y = 2", "z = 3", outputs=RAN), id="outputs"
        ),
        pytest.param("half a notebo", id="no notebook"),
        pytest.param('{"cells": 3}', id="no cells"),
        pytest.param("", id="empty"),
    ],
)
def test_a_changed_copy_is_kept_and_named_when_it_is_old(course, mine, changed):
    path = mine / "03_back.ipynb"
    path.write_text(changed)
    assert hand_out(course, mine) == copies.Handout((), ())  # changed, but of the current version
    upgrade(course)
    for _ in range(2):
        assert hand_out(course, mine) == copies.Handout((), ("03_back.ipynb",))
        assert path.read_text() == changed


def test_bytes_that_are_no_text_are_kept_too(course, mine):
    (mine / "03_back.ipynb").write_bytes(b"\xff\xfe\x00")
    upgrade(course)
    assert hand_out(course, mine).kept == ("03_back.ipynb",)
    assert (mine / "03_back.ipynb").read_bytes() == b"\xff\xfe\x00"


def test_what_was_there_before_the_first_time_is_kept(course, tmp_path):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "03_back.ipynb").write_text("of unknown origin")
    assert hand_out(course, tmp_path / "mine").kept == ("03_back.ipynb",)
    assert (tmp_path / "mine" / "03_back.ipynb").read_text() == "of unknown origin"


@pytest.mark.parametrize("record", [None, "{", "[]"])
def test_without_a_readable_record_equal_copies_are_known_again(course, mine, record):
    (mine / copies.RECORD).unlink()
    if record is not None:
        (mine / copies.RECORD).write_text(record)
    (mine / "00_start.ipynb").write_text("my answers")
    assert hand_out(course, mine).kept == ("00_start.ipynb",)
    upgrade(course)
    assert hand_out(course, mine) == copies.Handout(("03_back.ipynb",), ("00_start.ipynb",))


def test_a_copy_that_was_removed_comes_back(course, mine):
    (mine / "03_back.ipynb").unlink()
    assert hand_out(course, mine) == copies.Handout((), ())
    assert (mine / "03_back.ipynb").is_file()


def test_what_the_course_no_longer_has_goes_only_when_untouched(course, mine):
    for name in ("00_start.ipynb", "03_back.ipynb"):
        (course / "student" / name).rename(
            course / "student" / name.replace(".ipynb", "_again.ipynb")
        )
    (mine / "00_start.ipynb").write_text("my answers")
    (mine / "04_my_own.ipynb").write_text("mine from the start")
    hand_out(course, mine)
    there = sorted(path.name for path in mine.glob("*.ipynb"))
    assert there == [
        "00_start.ipynb",
        "00_start_again.ipynb",
        "03_back_again.ipynb",
        "04_my_own.ipynb",
    ]
    hand_out(course, mine)
    assert (mine / "00_start.ipynb").read_text() == "my answers"


def test_notes_in_a_page_are_kept_and_an_untouched_page_is_renewed(course, mine):
    (mine / "docs" / "RESULTS.md").write_text("my notes")
    (course.parent / "docs" / "RESULTS.md").write_text("newer")
    (course.parent / "docs" / "results" / "map.png").write_bytes(b"PNG2")
    assert hand_out(course, mine) == copies.Handout(("docs/results/map.png",), ("docs/RESULTS.md",))
    assert (mine / "docs" / "RESULTS.md").read_text() == "my notes"
    assert (mine / "docs" / "results" / "map.png").read_bytes() == b"PNG2"


def test_a_fresh_copy_leaves_every_earlier_one_beside_it(course, mine):
    path, given = mine / "03_back.ipynb", (mine / "03_back.ipynb").read_text()
    assert make_fresh(course, mine, path.name) is None  # nothing to put aside
    for count, name in (
        (1, "03_back_mine.ipynb"),
        (2, "03_back_mine_2.ipynb"),
        (3, "03_back_mine_3.ipynb"),
    ):
        path.write_text(f"answers {count}")
        assert make_fresh(course, mine, path.name) == mine / name
        assert path.read_text() == given
    aside = [(mine / f"03_back_mine{end}.ipynb").read_text() for end in ("", "_2", "_3")]
    assert aside == ["answers 1", "answers 2", "answers 3"]
    upgrade(course)
    assert hand_out(course, mine) == copies.Handout(("03_back.ipynb",), ())


def test_a_fresh_copy_is_current_also_once_it_is_filled_in_and_others_stay_known(course, mine):
    for name in ("00_start.ipynb", "03_back.ipynb"):
        (mine / name).write_text("answers")
    upgrade(course)
    make_fresh(course, mine, "03_back.ipynb")
    (mine / "03_back.ipynb").write_text("new answers")
    assert hand_out(course, mine) == copies.Handout((), ())


def test_the_refusal_of_the_system_is_passed_on_in_words(course, tmp_path, monkeypatch):
    def refuse(*_, **__):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(copies.tempfile, "TemporaryFile", refuse)
    with pytest.raises(FolderError, match="(?s)mine.*Permission denied.*--folder"):
        hand_out(course, tmp_path / "mine")
    with pytest.raises(FolderError):
        make_fresh(course, tmp_path / "mine", "03_back.ipynb")


def test_every_link_of_this_courses_copies_leads_to_one_of_them(root, tmp_path):
    hand_out(root / "notebooks", tmp_path)
    assert "docs/RESULTS.md" in links.to_files(tmp_path / "07_modiff_train_and_steer.ipynb")
    assert links.dead(tmp_path) == []


def test_dead_links_are_found(tmp_path):
    (tmp_path / "a.ipynb").write_text(
        notebook('[b](b.md), [c](docs/c.md#x), [d](../d.md), <img src="e.png">')
    )
    (tmp_path / "b.md").write_text("[out](https://example.org) `[code](f.md)` [a](a.ipynb)")
    (tmp_path.parent / "d.md").touch()
    assert links.dead(tmp_path) == ["a.ipynb: docs/c.md", "a.ipynb: ../d.md", "a.ipynb: e.png"]


def test_links_to_headings_are_those_of_jupyterlab(tmp_path):
    """In all notebooks and pages that students get."""
    mine = tmp_path / "mine"
    hand_out(notebook_folder(), mine)
    seen = set()
    for path in [*mine.glob("*.ipynb"), *(mine / "docs").rglob("*.md")]:
        for page, anchor in re.findall(r"\]\(([\w./-]*\.md)#([^)\s]+)\)", path.read_text()):
            text = (path.parent / page).read_text()
            assert anchor in [h.replace(" ", "-") for h in anchors.headings(text)], (path, anchor)
            seen.add(anchor)
    assert {"DDIM", "Kullback-Leibler-divergence", "U-Net", "noise-schedule"} <= seen


def test_anchors_of_headings():
    page = "# The `walk`\n\n```\n# no heading\n```\n## [A link](x.md), *so*\n[up](#the-walk)"
    assert list(anchors.headings(page)) == ["The walk", "A link, so"]
    told = "[a](docs/P.md#a-link-so) [b](P.md#gone) [c](Q.md#the-walk) "
    told += "[d](n.ipynb#1.-Go) [e](#the-walk)"
    found = anchors.for_jupyterlab(told, {"P.md": page}, own="P.md")
    assert found == (
        "[a](docs/P.md#A-link,-so) [b](P.md#gone) [c](Q.md#the-walk) [d](n.ipynb#1.-Go) "
        "[e](#The-walk)"
    )
