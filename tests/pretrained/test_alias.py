"""`python -m motiondiff_edu.recipes --alias NAME`.

The name `walker` can only stand for weights that are there.
"""

import json
from pathlib import Path

import pytest

from motiondiff_edu.pretrained import checkpoints
from motiondiff_edu.pretrained.checkpoints import available
from motiondiff_edu.recipes import __main__ as command


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Three weights files, and an alias that holds already."""
    for name in ("walker-eps", "walker-mine", "walker-x0"):
        (tmp_path / f"{name}.safetensors").touch()
    (tmp_path / "aliases.json").write_text('{"walker": "walker-x0"}')
    monkeypatch.setattr(checkpoints, "FOLDER", tmp_path)
    return tmp_path


def point(folder: Path, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.argv", ["pretrained", "--out", str(folder), "--alias", name])
    command.main()


def test_an_alias_points_to_the_weights_named(folder: Path, monkeypatch: pytest.MonkeyPatch):
    point(folder, "walker-mine", monkeypatch)
    assert available()["walker"] == folder / "walker-mine.safetensors"


@pytest.mark.parametrize("name", ["walker-xo", "walker", "walker-eps.safetensors"])
def test_an_alias_to_nothing_is_refused_with_what_is_there(
    folder: Path, monkeypatch: pytest.MonkeyPatch, name: str
):
    with pytest.raises(
        SystemExit, match=f"'{name}'; there are: walker-eps, walker-mine, walker-x0$"
    ):
        point(folder, name, monkeypatch)
    assert json.loads((folder / "aliases.json").read_text()) == {"walker": "walker-x0"}


def test_an_empty_folder_has_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    with pytest.raises(SystemExit, match="there are: none"):
        point(tmp_path, "walker-x0", monkeypatch)
    assert not list(tmp_path.iterdir())
