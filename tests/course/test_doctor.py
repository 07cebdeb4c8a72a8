"""course/doctor.py: each finding on a sound machine and on a broken one, and the page."""

import importlib.metadata
import shutil
import subprocess
import sys
import webbrowser
from pathlib import Path

import pytest

from motiondiff_edu import __main__ as command
from motiondiff_edu.course import doctor
from motiondiff_edu.course.doctor import Finding


def test_a_line_says_what_to_do_only_when_something_is_wrong():
    assert str(Finding("sound", "fine")) == "ok    sound     fine"
    assert str(Finding("sound", "bad", "mend it")).split("\n") == [
        "FAIL  sound     bad",
        f"{'':16}-> mend it",
    ]
    assert str(Finding("sound", "odd", "perhaps", note=True)).startswith("note")


def test_the_page_fails_when_a_finding_fails_and_not_for_a_note(capsys):
    well = Finding("a", "x")
    odd = Finding("b", "y", "z", note=True)
    bad = Finding("c", "y", "z")
    assert doctor.main([lambda: well, lambda: odd]) == 0
    assert "Everything works" in capsys.readouterr().out
    assert doctor.main([lambda: well, lambda: bad]) == 1
    assert "Failures: 1" in capsys.readouterr().out


def test_a_check_that_breaks_is_a_finding():
    def canvas():
        raise ModuleNotFoundError("No module named 'anywidget'")

    finding = doctor.guarded(canvas)
    assert (
        finding.name == "canvas"
        and "No module named 'anywidget'" in finding.detail
        and finding.remedy
    )


def test_missing_and_different_packages_are_named(monkeypatch):
    monkeypatch.setattr(doctor, "required_packages", lambda: ["torch", "anywidget", "tqdm"])
    monkeypatch.setattr(
        doctor, "constraints", lambda: {"torch": "2.13.0", "anywidget": "0.11.0", "tqdm": "4.70.1"}
    )
    installed = {"torch": "2.13.0+cpu", "anywidget": "0.10.0", "tqdm": "4.70.1"}
    monkeypatch.setattr(importlib.metadata, "version", installed.__getitem__)
    finding = doctor.versions()
    assert finding.note and finding.detail == "anywidget 0.10.0 (tested: 0.11.0)"

    def version(name):
        raise importlib.metadata.PackageNotFoundError(name)

    monkeypatch.setattr(importlib.metadata, "version", version)
    finding = doctor.versions()
    assert not finding.note and finding.detail == "missing: torch, anywidget, tqdm"


def test_the_pins_are_read_from_the_checkout():
    pins = doctor.constraints()
    assert pins["torch"] == "2.13.0" and len(pins) > 30


@pytest.mark.parametrize(
    "check", [doctor.python, doctor.compute, doctor.sound, doctor.hearing, doctor.writing]
)
def test_this_machine_is_sound(check):
    finding = check()
    assert not finding.remedy or finding.note, str(finding)


def test_a_tracker_that_dies_is_said_with_the_files_to_remove(monkeypatch):
    def dies(command, **_):
        return subprocess.CompletedProcess(command, -11, stdout="", stderr="")

    monkeypatch.setattr(doctor.subprocess, "run", dies)
    finding = doctor.hearing()
    assert "died (-11)" in finding.detail and not finding.note
    folder, pattern = finding.remedy.split(": ")[1].split("**")
    assert (Path(folder) / "beat.py").is_file() and pattern.endswith("*.nb?")


def test_the_kernel_starts_and_finds_the_package():
    assert doctor.kernel() == Finding("kernel", "it starts, and finds motiondiff_edu")


def test_a_folder_that_cannot_be_written_is_said(monkeypatch):
    def refuse(**_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(doctor.tempfile, "TemporaryFile", refuse)
    finding = doctor.writing()
    assert "Permission denied" in finding.detail and "folder of your own" in finding.remedy


def test_no_browser_is_a_note_and_no_module_a_failure(monkeypatch, tmp_path):
    def none():
        raise webbrowser.Error("none")

    monkeypatch.setattr(webbrowser, "get", none)
    folder = tmp_path / "widgets"
    shutil.copytree(doctor.PACKAGE / "widgets", folder)
    monkeypatch.setattr(doctor, "PACKAGE", tmp_path)
    assert doctor.canvas().note
    for name in ("js/player.js", "js/path.js"):
        (folder / name).unlink()
        assert name in doctor.canvas().detail and not doctor.canvas().note


def test_doctor_still_speaks_where_torch_cannot_be_imported():
    code = (
        "import sys; sys.modules['torch'] = None; sys.argv = ['motiondiff_edu', 'doctor']; "
        "from motiondiff_edu import __main__ as command; from motiondiff_edu.course import doctor; "
        "doctor.main.__defaults__ = ((doctor.python, doctor.compute, doctor.notebooks),); "
        "sys.exit(command.main())"
    )
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    compute = answer.stdout[answer.stdout.index("FAIL") :]
    assert answer.returncode == 1 and answer.stdout.startswith("ok    python")
    assert compute.startswith("FAIL  compute") and "-> python -m pip install" in compute
    assert "ok    notebooks" in compute and "Failures: 1" in compute


def test_doctor_and_lab_need_no_package_of_the_demo():
    absent = dict.fromkeys(["nbclient", "nbformat", "platformdirs", "tqdm"])
    code = (
        f"import sys; sys.modules |= {absent}; sys.argv = ['motiondiff_edu', 'doctor']; "
        "from motiondiff_edu import __main__ as command; from motiondiff_edu.course import doctor; "
        "doctor.main.__defaults__ = ((doctor.python,),); verbs, broken = command.imported(); "
        "print(sorted(verbs) == sorted(command.VERBS), broken); sys.exit(command.main())"
    )
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert answer.returncode == 0 and answer.stdout.startswith("True {}\nok    python")


def test_a_verb_that_cannot_be_imported_is_said_and_leaves_the_others(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "motiondiff_edu.course.demo", None)
    assert command.main(["demo", "07"]) == 1
    assert "motiondiff_edu.course.demo" in capsys.readouterr().err
    monkeypatch.setattr(doctor.main, "__defaults__", ((doctor.python,),))
    assert command.main(["doctor"]) == 0


def test_writing_is_tried_where_lab_puts_the_copies(monkeypatch, tmp_path):
    monkeypatch.setattr(doctor, "place_for_students", lambda: (tmp_path, tmp_path / "a" / "b"))
    assert doctor.writing() == Finding("writing", f"files can be written in {tmp_path}")
    (tmp_path / "a" / "b").mkdir(parents=True)
    assert doctor.writing() == Finding("writing", f"files can be written in {tmp_path / 'a' / 'b'}")
