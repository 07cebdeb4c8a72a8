"""A file of another body: a reader finds the motion again, through everything that differs."""

import numpy as np
import pytest

import motiondiff_edu as md
from data_synth.foreign import BODY, FPS, NAMES, write_foreign
from data_synth.mixed import motions
from motiondiff_edu.motion.formats.bvh import read_bvh
from motiondiff_edu.motion.skeleton import BONE_LENGTHS


@pytest.fixture(scope="module")
def walk() -> np.ndarray:
    return next(iter(motions(1, 3, 6.0)))[0]


def test_the_file_is_another_bodys_in_another_unit_and_at_another_rate(walk, tmp_path):
    bvh = read_bvh(write_foreign(tmp_path / "new" / "one.bvh", walk, 0))
    names = [name for name in bvh.names if not name.startswith("End")]
    assert all(name.startswith("mixamorig:") for name in names)
    assert {f"mixamorig:{name}" for name in NAMES.values()} <= set(names)
    assert 1 / bvh.frame_time == pytest.approx(FPS, rel=1e-6)
    assert len(bvh.frames) == 3 * (len(walk) - 1) + 1
    shank = np.linalg.norm(bvh.offsets[bvh.names.index("mixamorig:LeftFoot")])
    assert shank == pytest.approx(BODY["LeftFoot"] * BONE_LENGTHS[2] * 100 / 2.54, rel=1e-3)


def test_reading_it_gives_the_motion_on_the_courses_body(walk, tmp_path):
    read = md.read_motion(write_foreign(tmp_path / "one.bvh", walk, 0))
    assert len(read) == len(walk) and read.fps == 20
    off = np.linalg.norm(read.positions - walk, axis=-1)
    assert 0.001 < off.mean() < 0.02 and off.max() < 0.15


def test_the_noise_is_drawn_by_the_seed(walk, tmp_path):
    one, same, other = (
        write_foreign(tmp_path / f"{k}.bvh", walk, seed).read_bytes()
        for k, seed in enumerate((0, 0, 1))
    )
    assert one == same != other
