"""`python -m motiondiff_edu`: verbs, messages, which notebook opens where, what a demo sets, and a
real JupyterLab."""

import json
import os
import re
import subprocess
import sys
import time
import urllib.error
import urllib.request
from pathlib import Path

import pytest
from browser import PATIENCE

import motiondiff_edu
from motiondiff_edu import __main__ as command
from motiondiff_edu.course import demo, jupyter, lab, places


@pytest.fixture
def checkout(tmp_path, monkeypatch):
    """A checkout with two notebooks, and the package in it."""
    for name in (
        "notebooks/00_start.ipynb",
        "notebooks/student/00_start.ipynb",
        "notebooks/07_modiff.ipynb",
    ):
        path = tmp_path / "repo" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(
            json.dumps({"cells": [], "metadata": {}, "nbformat": 4, "nbformat_minor": 5})
        )
    (tmp_path / "repo" / "docs").mkdir()
    (tmp_path / "repo" / "docs" / "walk.gif").write_bytes(b"GIF89a")
    (tmp_path / "repo" / "pyproject.toml").touch()
    monkeypatch.setattr(places, "PACKAGE", tmp_path / "repo" / "motiondiff_edu")
    monkeypatch.delenv("MAKELEVEL", raising=False)
    return tmp_path / "repo"


@pytest.fixture
def calls(monkeypatch):
    """Instead of starting JupyterLab: (command, what the demo's files and environment held)."""
    seen = []

    def serve(arguments, env):
        root = next(a.split("=")[1] for a in arguments if "root_dir" in a)
        files = sorted(p.relative_to(root).as_posix() for p in Path(root).rglob("*") if p.is_file())
        seen.append((arguments, env, files))
        return 0

    monkeypatch.setattr(jupyter, "serve", serve)
    return seen


def test_lab_opens_notebook_00_in_a_copy_of_the_student_edition(checkout, calls):
    assert command.main(["lab", "--no-browser"]) == 0
    arguments, _, files = calls[0]
    assert f"--ServerApp.root_dir={checkout}" in arguments and arguments[-1] == "--no-browser"
    assert "--LabApp.default_url=/lab/tree/motiondiff_notebooks/00_start.ipynb" in arguments
    assert "motiondiff_notebooks/00_start.ipynb" in files


def test_lab_has_tabs_of_its_own_and_adds_to_the_jupyter_settings_there_are(
    checkout, calls, monkeypatch
):
    monkeypatch.setenv("JUPYTER_CONFIG_PATH", "theirs")
    assert command.main(["lab"]) == 0
    environment = calls[0][1]
    workspaces = Path(environment["JUPYTERLAB_WORKSPACES_DIR"])
    assert workspaces.is_relative_to(checkout / "motiondiff_notebooks")
    assert environment["JUPYTER_CONFIG_PATH"].endswith("jupyter_config" + os.pathsep + "theirs")
    assert "JUPYTERLAB_SETTINGS_DIR" not in environment  # a student's own theme and keys stay


def test_lab_says_what_is_old_and_how_to_get_the_new_one(checkout, calls, capsys, monkeypatch):
    shipped, mine = (
        checkout / name / "00_start.ipynb" for name in ("notebooks/student", "motiondiff_notebooks")
    )
    assert command.main(["lab"]) == 0 and "kept" not in capsys.readouterr().out
    mine.write_text("my answers")
    shipped.write_text("a newer edition")
    assert command.main(["lab"]) == 0
    told = capsys.readouterr().out
    assert (
        "newer ones: 00_start.ipynb" in told and "python -m motiondiff_edu lab --fresh 00" in told
    )
    monkeypatch.setenv("MAKELEVEL", "1")
    assert command.main(["lab"]) == 0 and "make lab FRESH=00" in capsys.readouterr().out
    assert command.main(["lab", "--fresh", "0"]) == 0
    told = capsys.readouterr().out
    assert (
        "00_start.ipynb is fresh; yours is now 00_start_mine.ipynb" in told and "kept" not in told
    )
    assert (
        mine.read_text() == "a newer edition"
        and mine.with_stem("00_start_mine").read_text() == "my answers"
    )
    assert command.main(["lab"]) == 0 and "kept" not in capsys.readouterr().out


def test_lab_says_which_copies_it_renewed(checkout, calls, capsys):
    assert command.main(["lab"]) == 0 and "renewed" not in capsys.readouterr().out
    (checkout / "notebooks" / "student" / "00_start.ipynb").write_text("a newer edition")
    assert (
        command.main(["lab"]) == 0
        and "Renewed, because you had not changed them: 00_start" in capsys.readouterr().out
    )


def test_a_wrong_number_after_a_right_one_moves_nothing(checkout, calls, capsys):
    assert command.main(["lab"]) == 0
    mine = checkout / "motiondiff_notebooks" / "00_start.ipynb"
    mine.write_text("my answers")
    assert command.main(["lab", "--fresh", "00", "--fresh", "12"]) == 1 and len(calls) == 1
    assert "no notebook 12" in capsys.readouterr().err and mine.read_text() == "my answers"


def test_lab_opens_the_notebook_whose_number_comes_first(checkout, calls, capsys):
    there = checkout / "notebooks" / "student" / "01_next.ipynb"
    there.write_text("{}")
    assert command.main(["lab", "1", "--no-browser"]) == 0
    arguments, _, files = calls[0]
    assert "--LabApp.default_url=/lab/tree/motiondiff_notebooks/01_next.ipynb" in arguments
    assert arguments[-1] == "--no-browser" and "1" not in arguments
    assert command.main(["lab", "--port", "8890"]) == 0  # the value of an option is no number
    assert calls[1][0][-2:] == ["--port", "8890"]
    assert command.main(["lab", "7"]) == 1 and len(calls) == 2
    assert "no notebook 7" in capsys.readouterr().err


def test_a_folder_of_copies_that_is_a_file_is_refused(checkout, calls, tmp_path, capsys):
    (tmp_path / "file").touch()
    assert command.main(["lab", "--folder", str(tmp_path / "file")]) == 1 and not calls
    assert "is a file; --folder takes the folder of your copies" in capsys.readouterr().err


def test_lab_takes_a_folder_by_name(checkout, calls, tmp_path):
    assert command.main(["lab", "--folder", str(tmp_path / "mine")]) == 0
    arguments, _, files = calls[0]
    assert f"--ServerApp.root_dir={tmp_path / 'mine'}" in arguments and "00_start.ipynb" in files
    assert not (checkout / "motiondiff_notebooks").exists()


def test_a_folder_that_cannot_be_written_is_said_without_a_traceback(
    checkout, calls, tmp_path, capsys
):
    (tmp_path / "file").touch()
    assert command.main(["lab", "--folder", str(tmp_path / "file" / "mine")]) == 1
    told = capsys.readouterr().err
    assert str(tmp_path / "file" / "mine") in told and "lab --folder FOLDER" in told and not calls


@pytest.mark.parametrize("verb", command.VERBS)
def test_each_verb_explains_itself_with_an_example(verb, capsys):
    with pytest.raises(SystemExit) as ended:
        command.main([verb, "--help"])
    assert ended.value.code == 0
    example = re.search(r"example: python -m motiondiff_edu (.*)", capsys.readouterr().out)[1]
    assert example.split()[0] == verb


def test_without_a_verb_all_are_listed(capsys):
    assert command.main([]) == 2
    told = capsys.readouterr().out
    assert all(verb in told for verb in ("lab", "demo", "doctor"))


def test_the_version_is_the_packages(capsys):
    with pytest.raises(SystemExit) as ended:
        command.main(["--version"])
    assert ended.value.code == 0
    assert capsys.readouterr().out == f"motiondiff_edu {motiondiff_edu.__version__}\n"


def test_options_go_on_to_jupyterlab_but_not_from_doctor(checkout, calls, capsys):
    assert command.main(["demo", "7", "--unrun", "--port", "8899"]) == 0
    assert calls[0][0][-2:] == ["--port", "8899"]
    with pytest.raises(SystemExit):
        command.main(["doctor", "--port"])
    assert "doctor does not know --port" in capsys.readouterr().err


def test_a_fault_of_the_program_keeps_its_traceback(monkeypatch):
    def broken(chosen):
        raise ValueError("operands could not be broadcast together")

    monkeypatch.setattr(lab, "run", broken)
    with pytest.raises(ValueError, match="broadcast"):
        command.main(["lab"])


def test_the_script_and_the_module_name_themselves(monkeypatch):
    monkeypatch.setattr("sys.argv", ["bin/motiondiff-edu", "lab"])
    assert places.program() == "motiondiff-edu"
    monkeypatch.setattr("sys.argv", ["motiondiff_edu/__main__.py", "lab"])
    assert places.program() == "python -m motiondiff_edu"


def test_lab_from_a_wheel_opens_a_copy_and_keeps_what_is_there(
    checkout, calls, tmp_path, monkeypatch
):
    package = tmp_path / "site" / "motiondiff_edu"
    (checkout / "notebooks").rename(checkout / "elsewhere")
    package.mkdir(parents=True)
    (checkout / "elsewhere").rename(package / "notebooks")
    monkeypatch.setattr(places, "PACKAGE", package)
    monkeypatch.chdir(checkout)
    assert command.main(["lab"]) == 0
    mine = checkout / "motiondiff_notebooks" / "00_start.ipynb"
    assert f"--ServerApp.root_dir={mine.parent}" in calls[0][0] and mine.is_file()
    mine.write_text("my work")
    assert command.main(["lab"]) == 0 and mine.read_text() == "my work"
    monkeypatch.chdir(mine.parent)  # from within: the same copies, not copies below copies
    assert command.main(["lab"]) == 0 and not (mine.parent / "motiondiff_notebooks").exists()


@pytest.mark.parametrize("number", ["07", "7"])
def test_demo_shows_a_copy_with_large_type_and_the_shipped_weights(checkout, calls, number):
    assert command.main(["demo", number, "--unrun"]) == 0
    arguments, environment, files = calls[0]
    # without tabs and side bar
    assert "--LabApp.default_url=/doc/tree/notebooks/07_modiff.ipynb" in arguments
    assert {"notebooks/07_modiff.ipynb", "docs/walk.gif"} <= set(files)
    assert not any("student" in name for name in files)
    assert environment["MOTIONDIFF_DEMO"] == "1"
    assert not any(str(checkout) in argument for argument in arguments)
    home = next(a.split("=")[1] for a in arguments if "root_dir" in a)
    assert environment["JUPYTERLAB_WORKSPACES_DIR"].startswith(home)  # its tabs end with it


def test_a_notebook_that_is_not_there_is_answered_with_those_that_are(checkout, calls, capsys):
    assert command.main(["demo", "12"]) == 1
    assert "no notebook 12" in (told := capsys.readouterr().err) and "00, 07" in told and not calls


def test_figures_of_a_demo_are_half_as_large_again(tmp_path):
    code = (
        "import io; from PIL import Image; from motiondiff_edu.viz import style; "
        "print(Image.open(io.BytesIO(style.figure(4, 3, 'words')[0].as_png())).size)"
    )
    sizes = []
    for demo_or_not in ({}, demo.demo_environment(tmp_path)):
        run = [sys.executable, "-c", code]
        env = {k: v for k, v in os.environ.items() if k != "MOTIONDIFF_LARGE"} | demo_or_not
        sizes.append(subprocess.run(run, capture_output=True, text=True, env=env).stdout.strip())
    assert sizes == ["(400, 300)", "(600, 450)"]


def ask(address: str) -> dict:
    """The JSON at an address; a server tells its address a moment before it listens there."""
    start = time.monotonic()
    while True:
        try:
            with urllib.request.urlopen(address, timeout=PATIENCE / 1000) as answer:
                return json.load(answer)
        except urllib.error.URLError:
            if time.monotonic() - start > PATIENCE / 1000:
                raise
            time.sleep(0.5)


def test_jupyterlab_really_starts_and_serves_the_notebook(checkout):
    """Through the command itself: the server answers with the notebook that the address names."""
    code = (
        "import sys, pathlib; from motiondiff_edu import __main__ as m; "
        "from motiondiff_edu.course import places; "
        f"places.PACKAGE = pathlib.Path({str(checkout / 'motiondiff_edu')!r}); "
        "sys.exit(m.main(['lab', '--no-browser', '--port=0', '--IdentityProvider.token=walk']))"
    )
    server = subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.PIPE, text=True)
    try:
        start, address = time.monotonic(), None
        while address is None and time.monotonic() - start < PATIENCE / 1000:
            line = server.stderr.readline()
            assert line or server.poll() is None, "JupyterLab ended before it served anything"
            found = re.search(
                r"http://(?:localhost|127\.0\.0\.1):(\d+)(/lab/tree/\S*?)\?token", line
            )
            address = found and (found[1], found[2])
        port, page = address
        assert page == "/lab/tree/motiondiff_notebooks/00_start.ipynb"
        served = (
            f"http://127.0.0.1:{port}/api/contents/{page.removeprefix('/lab/tree/')}?token=walk"
        )
        assert ask(served)["type"] == "notebook"
        plugin = "@jupyterlab/apputils-extension:notification"
        news = ask(f"http://127.0.0.1:{port}/lab/api/settings/{plugin}?token=walk")["schema"][
            "properties"
        ]
        assert (
            news["fetchNews"]["default"] == "false" and news["checkForUpdates"]["default"] is False
        )
        server.terminate()
        server.wait(timeout=PATIENCE / 1000)
        with pytest.raises(urllib.error.URLError):  # ending the command ended JupyterLab, too
            urllib.request.urlopen(served, timeout=5)
    finally:
        server.kill()
        server.stderr.close()
        server.wait()
