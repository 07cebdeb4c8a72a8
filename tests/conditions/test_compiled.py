"""conditions/compiled.py: librosa is loaded by one process at a time."""

import importlib
import sys
from types import SimpleNamespace

import pytest
from filelock import FileLock, Timeout

NAME = "motiondiff_edu.conditions.compiled"


def held(path) -> bool:
    try:
        with FileLock(path, timeout=0):
            return False
    except Timeout:
        return True


@pytest.fixture
def load(monkeypatch):
    """Loads the module anew, with a librosa whose tracker calls `track`."""

    def load(folder, track):
        fake = SimpleNamespace(beat=SimpleNamespace(beat_track=lambda **_: track()))
        monkeypatch.setitem(sys.modules, "librosa", fake)
        monkeypatch.setenv("NUMBA_CACHE_DIR", str(folder))
        monkeypatch.delitem(sys.modules, NAME, raising=False)
        loaded = importlib.import_module(NAME)
        del sys.modules[NAME]  # not by monkeypatch, which would bring the fake back in the end
        assert loaded.librosa is fake
        return loaded

    package = importlib.import_module("motiondiff_edu.conditions")
    before = package.__dict__.get("compiled")
    yield load
    package.__dict__.pop("compiled", None)
    if before is not None:
        package.compiled = before


def test_the_lock_is_held_while_the_tracker_compiles_and_not_afterwards(load, tmp_path):
    seen = []
    lock = tmp_path / "new" / "folder" / "librosa.lock"
    load(lock.parent, lambda: seen.append(held(lock)))
    assert seen == [True] and not held(lock)


def test_where_nothing_can_be_written_librosa_is_loaded_all_the_same(load, tmp_path):
    (tmp_path / "file").touch()
    seen = []
    load(tmp_path / "file" / "folder", lambda: seen.append(1))
    assert seen == [1]
