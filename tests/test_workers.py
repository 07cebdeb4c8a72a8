"""`make test` with two workers.

One that dies ends the run as a failure, and each has a numba cache of its own.
"""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from browser import PATIENCE

DIES = """
import os, signal
def test_before(): pass
def test_dies(): os.kill(os.getpid(), signal.SIGKILL)
def test_after(): pass
"""


@pytest.fixture
def run(root, tmp_path, monkeypatch):
    """Runs pytest on the files of the test, with the workers of the Makefile."""
    workers = (
        re.search(r"^WORKERS := (.*)$", (root / "Makefile").read_text(), re.M).group(1).split()
    )
    assert "auto" in workers
    # no other plugins: each of the three processes would import them, for six seconds
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")

    def run(**files: str) -> subprocess.CompletedProcess:
        for name, text in files.items():
            (tmp_path / f"test_{name}.py").write_text(text)
        flags = ["2" if flag == "auto" else flag for flag in workers]
        command = [
            sys.executable,
            "-m",
            "pytest",
            "-q",
            "-p",
            "no:cacheprovider",
            "-p",
            "xdist.plugin",
            *flags,
            "--dist",
            "loadfile",
        ]
        command.append(str(tmp_path))
        patience = PATIENCE / 1000
        return subprocess.run(
            command, cwd=tmp_path, capture_output=True, text=True, timeout=patience
        )

    return run


def test_a_worker_that_dies_fails_the_run(run):
    done = run(
        **{f"calm_{k}": "def test_a(): pass\ndef test_b(): pass" for k in range(5)}, dies=DIES
    )
    assert done.returncode == 1 and "crashed while running" in done.stdout


def test_workers_do_not_share_what_numba_compiled(run, root, tmp_path, monkeypatch):
    """Each worker compiles into a cache of its own, which begins as a copy of what is compiled.

    Else two of them write the halves of one function, and the reader dies (numba issue 10128).
    """
    for inherited in ("NUMBA_CACHE_DIR", "PYTEST_XDIST_WORKER"):
        monkeypatch.delenv(inherited, raising=False)
    shutil.copy(root / "conftest.py", tmp_path)
    first = tmp_path / "build" / "numba" / "first"  # what `make tracker` compiled
    first.mkdir(parents=True)
    (first / "beat.nbi").touch()
    seen = (
        "from numba import config\ndef test_it():\n    open('NAME', 'w').write(config.CACHE_DIR)\n"
    )
    # one test alone would go to the other's worker
    seen += "def test_more(): pass\ndef test_yet_more(): pass\n"
    assert run(a=seen.replace("NAME", "a"), b=seen.replace("NAME", "b")).returncode == 0
    one, other = ((tmp_path / name).read_text() for name in "ab")
    assert one != other and {one[-3:], other[-3:]} == {"gw0", "gw1"}
    assert all(Path(place, "beat.nbi").is_file() for place in (one, other))
    assert sorted(path.name for path in first.parent.iterdir()) == ["first", "gw0", "gw1"]
