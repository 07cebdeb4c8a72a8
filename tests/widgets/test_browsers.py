"""A browser that is a snap gets no file that it cannot open."""

import numpy as np
import pytest
from jupyter_server.serverapp import ServerApp

import motiondiff_edu as md
from motiondiff_edu.course import doctor, jupyter
from motiondiff_edu.motion.skeleton import OFFSETS
from motiondiff_edu.widgets import browsers

STANDS = md.Motion(np.repeat(np.cumsum(OFFSETS, 0)[None], 20, 0))


@pytest.fixture
def snap(monkeypatch, tmp_path):
    """A machine with Ubuntu's Firefox, a screen, and a home folder."""
    (tmp_path / "snap").mkdir()
    (tmp_path / "snap" / "firefox").touch()
    (tmp_path / "home").mkdir()
    monkeypatch.setattr(browsers, "SNAPS", tmp_path / "snap")
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.setenv("USERPROFILE", str(tmp_path / "home"))
    monkeypatch.setenv("BROWSER", "true")
    return tmp_path


@pytest.fixture
def command(monkeypatch, tmp_path):
    """Instead of starting JupyterLab: a function that gives the command's last words."""
    seen = []
    monkeypatch.setattr(jupyter, "serve", lambda words, _: seen.append(words) or 0)

    def start(*options: str) -> list[str]:
        jupyter.open_lab(tmp_path, tmp_path / "00.ipynb", list(options), {})
        return seen[-1]

    return start


def test_a_page_of_play_lies_where_the_browser_can_open_it(snap, capsys):
    page = md.play(STANDS, open_page=False)
    assert page.parent == (snap / "home").resolve() and "<html" in page.read_text()
    (snap / "snap" / "firefox").unlink()
    page = md.play(STANDS, open_page=False)
    assert page.parent != (snap / "home").resolve()
    page.unlink()


def test_jupyter_opens_its_address_and_no_hidden_file(snap, command):
    assert "--ServerApp.use_redirect_file=False" in command()
    theirs = "--ServerApp.use_redirect_file=True"
    assert [w for w in command(theirs) if "use_redirect_file" in w] == [theirs]
    (snap / "snap" / "firefox").unlink()
    assert not any("use_redirect_file" in word for word in command())


def test_doctor_tells_of_the_snap(snap, monkeypatch):
    monkeypatch.setattr("webbrowser.get", lambda *_: None)  # it looks for browsers only once
    finding = doctor.canvas()
    assert finding.note and "firefox is a snap" in finding.detail
    (snap / "snap" / "firefox").unlink()
    assert not doctor.canvas().note


def test_jupyter_has_an_option_of_that_name():
    assert "use_redirect_file" in ServerApp.class_traits()
