"""`motiondiff-edu collect` and copies that are broken or hostile in all kinds of ways."""

import sys
from pathlib import Path

import pytest

from motiondiff_edu.course import answers
from tools.results.course import bad_copies

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="collect needs fork")


@pytest.fixture(scope="module")
def collected(tmp_path_factory):
    """What it prints, and the rows of its file."""
    folder = tmp_path_factory.mktemp("handed_in")
    bad_copies.hand_in(folder, bad_copies.QUICK, bad_copies.WATCHED)
    return bad_copies.collected(folder, tmp_path_factory.mktemp("out") / "class.csv")


def test_every_right_copy_is_right_beside_the_bad_ones(collected):
    assert len(bad_copies.QUICK) >= 50
    kept = bad_copies.survivors(collected[1], bad_copies.WATCHED)
    assert kept == dict.fromkeys(bad_copies.WATCHED, True)


@pytest.mark.parametrize("kind", bad_copies.QUICK)
def test_a_bad_copy_has_a_row_and_is_not_right(collected, kind):
    result, message = bad_copies.results(collected[1])[bad_copies.shown(bad_copies.student(kind))]
    assert result in answers.RESULTS and result != "right"
    assert message.isprintable() and len(message) < 600


def test_nothing_is_told_falsely(collected):
    found = bad_copies.results(collected[1])
    killed = "the process was ended by SIGKILL, perhaps because it was out of memory"
    unreadable = f"{bad_copies.NAME} is not a readable notebook"
    for kind, told in {
        "exit_0": ("died", "the process ended by itself, with status 0"),
        "exit_3": ("died", "the process ended by itself, with status 3"),
        "crash": ("died", "the process was ended by SIGSEGV"),
        "kills_itself": ("died", killed),
        "alarm_off": ("too slow", f"stopped after {bad_copies.SECONDS} s"),
        "prints_right": ("not attempted", "its check was not reached"),
        "fifo": ("unreadable", f"{unreadable} (it is not a regular file)"),
        "broken_link": (
            "unreadable",
            f"{unreadable} (it is not there, or a link to a file that is not there)",
        ),
    }.items():
        assert found[kind] == told


def test_nothing_reaches_the_terminal_or_a_spreadsheet_as_it_is(collected):
    said, rows = collected
    assert all(line.isprintable() for line in said.splitlines())
    assert "\r" not in said and "\x1b" not in said
    assert "'=1+1" in bad_copies.results(rows)
    assert bad_copies.results(rows)["'=1+1"][1] == '\'=HYPERLINK("x")'
    assert not [cell for row in rows for cell in row.values() if cell[:1] in tuple("=+-@\t\r")]


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere they cannot be found")
def test_a_process_in_a_session_of_its_own_ends_as_well(collected):
    running = [path.read_bytes() for path in Path("/proc").glob("[0-9]*/cmdline") if path.exists()]
    assert not [command for command in running if b"318.5" in command]
