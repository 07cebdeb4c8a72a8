"""`python -m motiondiff_edu`.

Which notebook opens where, what a demo sets, and a JupyterLab that really serves it.
"""

import json
import re
import subprocess
import sys
import time
import urllib.error
import urllib.request
from pathlib import Path

import pytest

from motiondiff_edu import __main__ as command


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
    monkeypatch.setattr(command, "PACKAGE", tmp_path / "repo" / "motiondiff_edu")
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

    monkeypatch.setattr(command, "serve", serve)
    return seen


def test_lab_opens_notebook_00_of_the_student_edition(checkout, calls):
    assert command.main(["lab", "--no-browser"]) == 0
    arguments = calls[0][0]
    assert f"--ServerApp.root_dir={checkout}" in arguments and arguments[-1] == "--no-browser"
    assert "--LabApp.default_url=/lab/tree/notebooks/student/00_start.ipynb" in arguments


def test_lab_from_a_wheel_opens_a_copy_and_keeps_what_is_there(
    checkout, calls, tmp_path, monkeypatch
):
    package = tmp_path / "site" / "motiondiff_edu"
    (checkout / "notebooks").rename(checkout / "elsewhere")
    package.mkdir(parents=True)
    (checkout / "elsewhere").rename(package / "notebooks")
    monkeypatch.setattr(command, "PACKAGE", package)
    monkeypatch.chdir(checkout)
    assert command.main(["lab"]) == 0
    mine = checkout / "motiondiff_notebooks" / "00_start.ipynb"
    assert f"--ServerApp.root_dir={mine.parent}" in calls[0][0] and mine.is_file()
    mine.write_text("my work")
    assert command.main(["lab"]) == 0 and mine.read_text() == "my work"


@pytest.mark.parametrize("number", ["07", "7"])
def test_demo_shows_a_copy_with_large_type_and_the_shipped_weights(checkout, calls, number):
    assert command.main(["demo", number]) == 0
    arguments, environment, files = calls[0]
    assert "--LabApp.default_url=/lab/tree/notebooks/07_modiff.ipynb" in arguments
    assert {"notebooks/07_modiff.ipynb", "docs/walk.gif", "matplotlibrc"} <= set(files)
    assert not any("student" in name for name in files)
    assert environment["MOTIONDIFF_DEMO"] == "1" and environment["MATPLOTLIBRC"].endswith(
        "matplotlibrc"
    )
    assert not any(str(checkout) in argument for argument in arguments)


def test_a_notebook_that_is_not_there_is_answered_with_those_that_are(checkout, calls, capsys):
    assert command.main(["demo", "12"]) == 1
    assert "no notebook 12" in (told := capsys.readouterr().err) and "00, 07" in told and not calls


def test_matplotlib_takes_the_large_type(tmp_path):
    environment = command.demo_environment(tmp_path)
    import matplotlib

    values = matplotlib.rc_params_from_file(environment["MATPLOTLIBRC"], use_default_template=False)
    assert values["figure.dpi"] == 150


def ask(address: str, attempts: int = 60) -> dict:
    """The JSON at an address; a server tells its address a moment before it listens there."""
    for _ in range(attempts):
        try:
            with urllib.request.urlopen(address, timeout=30) as answer:
                return json.load(answer)
        except urllib.error.URLError as error:
            reason = error
            time.sleep(0.5)
    raise reason


def test_jupyterlab_really_starts_and_serves_the_notebook(checkout):
    """Through the command itself: the server answers with the notebook that the address names."""
    code = (
        "import sys, pathlib; from motiondiff_edu import __main__ as m; "
        f"m.PACKAGE = pathlib.Path({str(checkout / 'motiondiff_edu')!r}); "
        "sys.exit(m.main(['lab', '--no-browser', '--port=0', '--IdentityProvider.token=walk']))"
    )
    server = subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.PIPE, text=True)
    try:
        start, address = time.monotonic(), None
        while address is None and time.monotonic() - start < 120:
            line = server.stderr.readline()
            assert line or server.poll() is None, "JupyterLab ended before it served anything"
            found = re.search(
                r"http://(?:localhost|127\.0\.0\.1):(\d+)(/lab/tree/\S*?)\?token", line
            )
            address = found and (found[1], found[2])
        port, page = address
        assert page == "/lab/tree/notebooks/student/00_start.ipynb"
        served = (
            f"http://127.0.0.1:{port}/api/contents/{page.removeprefix('/lab/tree/')}?token=walk"
        )
        assert ask(served)["type"] == "notebook"
        server.terminate()
        server.wait(timeout=60)
        with pytest.raises(urllib.error.URLError):  # ending the command ended JupyterLab, too
            urllib.request.urlopen(served, timeout=5)
    finally:
        server.kill()
        server.stderr.close()
        server.wait()
