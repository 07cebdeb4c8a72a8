"""Continuations of recordings: the windows, the same motion as `walk`, the records and the page."""

import warnings

import numpy as np
import pytest

import motiondiff_edu as md
from data_synth.walking import walk
from motiondiff_edu.conditions.control import constant_control
from motiondiff_edu.motion.bvh.write import write_bvh
from tools.results.recordings import continuations, page

RANGE = {"low": [-0.5, -0.5, -1.0], "high": [0.9, 0.5, 1.0]}


@pytest.fixture(scope="module")
def walker():
    return md.load("walker")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Two walks of 14 and 7 s, a short one, and a file that is none."""
    (tmp_path / "bvh").mkdir()
    for k, seconds in enumerate((14.0, 7.0, 3.0)):
        clip = walk(constant_control(1.1, seconds=seconds), seed=k)
        write_bvh(tmp_path / "bvh" / f"walk{k}.bvh", clip.world())
    (tmp_path / "bvh" / "broken.bvh").write_text("HIERARCHY\n")
    monkeypatch.setenv("MOTIONDIFF_REAL_DATA", str(tmp_path))
    return tmp_path


def test_windows_are_of_six_seconds_and_their_control_is_within_the_range(folder):
    found = list(continuations.windows(continuations.FULL, RANGE))
    assert [one.source for one in found] == ["walk0.bvh", "walk0.bvh", "walk1.bvh"]
    assert all(len(one.given) == 40 and one.control.shape == (80, 3) for one in found)
    assert all(one.control[0, 0] == pytest.approx(0.9) for one in found)
    assert len(list(continuations.windows(continuations.RecordedSize(each=1), RANGE))) == 2


def test_a_window_is_continued_as_walk_continues_it(walker, folder):
    window = next(continuations.windows(continuations.FULL, walker.card["control_range"]))
    blended, plain = continuations.continued(walker, window)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        wanted = walker.walk(window.given, window.control, progress=False)
    np.testing.assert_allclose(blended.world, wanted.positions, atol=1e-4)
    np.testing.assert_allclose(plain.world, wanted.positions, atol=1e-4)  # it does not jump
    row = continuations.row_of(window, plain)
    assert row["seam"] < 1.1 and row["skating"] < 0.1 and row["adherence"] < 0.1
    assert row["depth"] == pytest.approx(100 * max(0.0, -wanted.positions[..., 1].min()), abs=0.01)


def test_records_are_made_and_stand_in_the_page(walker, folder):
    made = continuations.recorded_records(walker, "0", continuations.QUICK, "python -m x")
    records = {one["name"]: one for one in made}
    assert records["real.blended_share"]["seeds"]["windows"] == 2
    assert 0 < records["real.seam_over_motion"]["value"] < 1.1
    text = page.section(records)
    assert "2 windows of 2 recordings" in text and all(
        words in text for words in page.ROWS.values()
    )
    assert "Not measured yet" in page.section({})


def test_without_recordings_it_says_what_to_set(monkeypatch, tmp_path):
    monkeypatch.setenv("MOTIONDIFF_REAL_DATA", str(tmp_path))
    with pytest.raises(SystemExit, match="MOTIONDIFF_REAL_DATA must name a folder"):
        list(continuations.windows(continuations.FULL, RANGE))
