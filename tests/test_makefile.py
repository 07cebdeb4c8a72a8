"""Makefile: what it says when Python is missing or old, or pip has no network."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(not shutil.which("make"), reason="no make here")
OLD = 'import sys; sys.version_info = (3, 10, 13); exec(sys.argv[sys.argv.index("-c") + 1])'


def script(path: Path, text: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("#!/bin/sh\n" + text)
    path.chmod(0o755)
    return path


@pytest.fixture
def checkout(root, tmp_path) -> Path:
    """A project with this Makefile and nothing to install."""
    shutil.copy(root / "Makefile", tmp_path)
    (tmp_path / "pyproject.toml").write_text('[build-system]\nrequires = ["setuptools>=77"]\n')
    for name in ("constraints.txt", "setup.py"):
        (tmp_path / name).touch()
    return tmp_path


def make(checkout: Path, *arguments: str, **environment: str) -> subprocess.CompletedProcess:
    clean = {k: v for k, v in os.environ.items() if not k.startswith(("MAKE", "PIP_", "PYTHON"))}
    command = ["make", *arguments]
    return subprocess.run(
        command, cwd=checkout, env=clean | environment, capture_output=True, text=True
    )


def old_python(path: Path) -> Path:
    """A Python that says it is 3.10 when it is asked for its version, and can do nothing else."""
    return script(path, f"""exec '{sys.executable}' -c '{OLD}' "$@"\n""")


def test_an_interpreter_that_is_not_there_is_named(checkout):
    answer = make(checkout, "lab", "PYTHON=/nonexistent")
    assert answer.returncode and "There is no Python at /nonexistent." in answer.stdout
    assert "venv" not in answer.stdout and not (checkout / ".venv").exists()


def test_an_old_interpreter_is_named(checkout):
    python = old_python(checkout / "bin" / "python3.10")
    answer = make(checkout, "lab", f"PYTHON={python}")
    assert answer.returncode and f"{python} is too old: Python 3.11 or newer" in answer.stdout
    assert not (checkout / ".venv").exists()


def test_an_old_virtual_environment_is_named_before_pip_is_asked(checkout):
    old_python(checkout / ".venv" / "bin" / "python")
    answer = make(checkout, "lab")
    assert answer.returncode and ".venv was made with a Python older than 3.11" in answer.stdout
    assert "rm -rf .venv" in answer.stdout and not (checkout / ".venv" / "pip.log").exists()


def test_an_interpreter_without_venv_is_told_apart(checkout):
    old = 'case "$1" in -m) exit 1;; esac'
    python = script(checkout / "bin" / "python3", f"""{old}\nexec '{sys.executable}' "$@"\n""")
    answer = make(checkout, "lab", f"PYTHON={python}")
    assert (
        answer.returncode and "python3-venv" in answer.stdout and not (checkout / ".venv").exists()
    )


def test_without_a_network_the_word_is_plain(checkout):
    """The real pip, with an index that nobody answers for."""
    script(checkout / ".venv" / "bin" / "python", f"""exec '{sys.executable}' "$@"\n""")
    closed = {
        "PIP_INDEX_URL": "http://127.0.0.1:9/simple",
        "PIP_RETRIES": "0",
        "PIP_CONFIG_FILE": os.devnull,
    }
    answer = make(checkout, "lab", PIP_TARGET=str(checkout / "target"), **closed)
    assert answer.returncode and "No network: pip could not reach" in answer.stdout
    told = answer.stdout + answer.stderr
    assert "Traceback" not in told and "subprocess" not in told and len(told.splitlines()) < 8
    assert "127.0.0.1" in (checkout / ".venv" / "pip.log").read_text()
    assert not (checkout / ".venv" / ".lab").exists()


def test_another_failure_of_pip_is_shown_whole(checkout):
    pip = 'case "$2" in pip) echo "ERROR: no space left on device" >&2; exit 1;; esac'
    script(checkout / ".venv" / "bin" / "python", f"""{pip}\nexec '{sys.executable}' "$@"\n""")
    answer = make(checkout, "lab")
    assert answer.returncode and "ERROR: no space left on device" in answer.stdout
    assert "network" not in answer.stdout


@pytest.mark.parametrize(
    "arguments, wanted",
    [
        (["lab"], "-m motiondiff_edu lab"),
        (
            ["lab", "FRESH=03 05", "OPTIONS=--no-browser"],
            "-m motiondiff_edu lab --fresh 03 --fresh 05 --no-browser",
        ),
        (["demo", "NB=12"], "-m motiondiff_edu demo 12"),
        (["student", "FORCE=1"], "tools/build_student.py --force"),
        (["student"], "tools/build_student.py"),
    ],
)
def test_what_make_is_told_reaches_the_command(checkout, arguments, wanted):
    script(checkout / ".venv" / "bin" / "python", 'echo ran "$@"\n')
    answer = make(checkout, *arguments)
    assert answer.returncode == 0, answer.stdout + answer.stderr
    assert answer.stdout.splitlines()[-1].split() == ["ran", *wanted.split()]
