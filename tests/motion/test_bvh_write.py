"""Writing BVH and reading it back.

Constant bones fitted to any motion, angles without flips, the same motion read back.
"""

import json
import shutil
import subprocess

import numpy as np
import pytest
from browser import PATIENCE
from synthetic_walk import walk

from motiondiff_edu.motion.formats.bvh import BvhError, read_bvh
from motiondiff_edu.motion.formats.bvh.fit import euler_zxy, fit, kabsch, least_turn
from motiondiff_edu.motion.formats.bvh.write import write_bvh
from motiondiff_edu.motion.formats.files import read_motion
from motiondiff_edu.motion.kinematics import euler_to_matrix, rot_x, rot_z
from motiondiff_edu.motion.retarget import load_clip
from motiondiff_edu.motion.skeleton import BONE_LENGTHS, BONES, JOINTS


def joints_of(path) -> np.ndarray:
    """World positions of the 21 joints in metres, as read back."""
    bvh = read_bvh(path)
    return bvh.world_positions()[:, [bvh.names.index(name) for name in JOINTS]] / 100


@pytest.fixture
def turning() -> np.ndarray:
    """A walk that turns through more than one circle."""
    world, _ = walk(frames=130, turn=1.4)
    return world


def test_constant_bones_come_back_exactly(tmp_path, turning, capsys):
    report = write_bvh(tmp_path / "walk.bvh", turning, fps=20)
    assert report.max_mm < 0.01 and report.bone_mm < 1e-9
    assert np.abs(joints_of(tmp_path / "walk.bvh") - turning).max() < 1e-5
    assert "the joints exactly where they were" in capsys.readouterr().out


def test_spine_and_collars_turn_freely(tmp_path, turning):
    bent = turning.copy()
    upper = [j for j in range(9, 21)]
    bent[:, upper] = (bent[:, upper] - bent[:, :1]) @ rot_x(0.3).T + bent[
        :, :1
    ]  # the trunk leans, the hips do not
    bent[:, 13:17] = (bent[:, 13:17] - bent[:, 11:12]) @ rot_z(0.2).T + bent[
        :, 11:12
    ]  # one shoulder is shrugged
    assert write_bvh(tmp_path / "bent.bvh", bent).max_mm < 0.01


def test_raw_output_reads_back_as_its_fit(tmp_path, turning):
    rng = np.random.default_rng(5)
    raw = turning + rng.normal(scale=0.004, size=turning.shape)
    report = write_bvh(tmp_path / "raw.bvh", raw, fps=30)
    back = joints_of(tmp_path / "raw.bvh")
    assert np.abs(back - report.positions).max() < 1e-3  # metres
    lengths = np.array([np.linalg.norm(back[:, c] - back[:, p], axis=-1) for p, c in BONES])
    assert np.ptp(lengths, axis=1).max() < 1e-6
    assert np.allclose(report.shift_mm, 1000 * np.linalg.norm(report.positions - raw, axis=-1))
    assert 1 < report.mean_mm < 10 and report.max_mm < 40 and report.bone_mm > 2
    assert read_bvh(tmp_path / "raw.bvh").fps == 30


def test_the_hierarchy_has_our_joints_and_end_sites(tmp_path, turning):
    write_bvh(tmp_path / "walk.bvh", turning)
    bvh = read_bvh(tmp_path / "walk.bvh")
    assert set(JOINTS) <= set(bvh.joints) and len(bvh.joints) == 24
    assert bvh.is_end.sum() == 5 and set(bvh.orders) == {"ZXY", ""}
    assert np.array_equal(bvh.offsets[0], [0, 0, 0])
    rest = bvh.rest_positions()
    assert (
        rest[bvh.names.index("LeftHand"), 0] > 50 and rest[bvh.names.index("LeftToeBase"), 1] < -80
    )  # cm


def test_angles_do_not_flip(tmp_path, turning):
    write_bvh(tmp_path / "walk.bvh", turning)
    angles = read_bvh(tmp_path / "walk.bvh").frames[:, 3:]
    assert np.abs(np.diff(angles, axis=0)).max() < 40
    assert np.ptp(angles[:, 2]) > 400  # the heading goes on past the circle


def test_euler_angles_are_the_rotation_and_continuous():
    t = np.linspace(0, 6 * np.pi, 301)
    angles = np.stack([0.3 * t, 2 * np.sin(t), t], -1)[
        :, None
    ]  # x passes 90 degrees, where the usual choice jumps
    found = euler_zxy(euler_to_matrix(angles, "ZXY"))
    assert np.abs(found - np.degrees(angles)).max() < 1e-6


def test_where_two_angles_do_the_same_nothing_is_said(recwarn):
    angles = np.tile([0.3, np.pi / 2, 0.2], (4, 1, 1))
    turns = euler_to_matrix(angles, "ZXY")
    found = np.radians(euler_zxy(turns))
    np.testing.assert_allclose(euler_to_matrix(found, "ZXY"), turns, atol=1e-7)
    assert [str(one.message) for one in recwarn] == []


def test_kabsch_finds_the_rotation():
    rng = np.random.default_rng(2)
    rest = rng.normal(size=(3, 3))
    turns = euler_to_matrix(rng.uniform(-3, 3, (7, 3)), "ZXY")
    assert np.allclose(kabsch(rest, np.einsum("tij,kj->tki", turns, rest)), turns)
    assert np.allclose(np.linalg.det(kabsch(rest, rng.normal(size=(5, 3, 3)))), 1)


def test_least_turn_carries_over_and_invents_no_twist():
    rng = np.random.default_rng(4)
    start, end = rng.normal(size=(2, 9, 3))
    turn = least_turn(start, end)
    carried = np.einsum("tij,tj->ti", turn, start / np.linalg.norm(start, axis=1, keepdims=True))
    assert np.allclose(carried, end / np.linalg.norm(end, axis=1, keepdims=True))
    axis = np.cross(start, end)
    assert np.allclose(np.einsum("tij,tj->ti", turn, axis), axis)
    assert np.allclose(least_turn(start, start), np.eye(3))


def test_least_turn_between_opposite_directions_is_half_a_turn():
    start = np.concatenate([np.eye(3), [[0, -0.41, 0], [1, 2, 3]]])
    turn = least_turn(start, -2 * start)
    assert np.allclose(np.einsum("tij,tj->ti", turn, start), -start)
    assert np.allclose(np.linalg.det(turn), 1)


def test_fitted_bones_are_the_medians(turning):
    taller = turning * 1.08
    taller[7] *= 3  # a frame gone astray: a mean would follow it
    fitted = fit(taller).report.positions
    lengths = np.array([np.linalg.norm(fitted[0, c] - fitted[0, p]) for p, c in BONES])
    assert np.allclose(lengths, 1.08 * BONE_LENGTHS)


def test_our_own_file_loads_as_it_was(tmp_path, turning):
    write_bvh(tmp_path / "walk.bvh", turning)
    clip = load_clip(tmp_path / "walk.bvh")
    world = clip.world()
    assert clip.info["notes"] == [] and clip.fps == 20
    apart = np.linalg.norm(world[:, :, None] - world[:, None], axis=-1)
    given = np.linalg.norm(turning[:, :, None] - turning[:, None], axis=-1)
    assert np.abs(apart - given).max() < 1e-6  # the same poses, wherever the clip starts
    moved = np.linalg.norm(world[:, 0] - world[0, 0], axis=-1)
    assert np.abs(moved - np.linalg.norm(turning[:, 0] - turning[0, 0], axis=-1)).max() < 1e-6


@pytest.mark.parametrize("away", [0.0, 30.0, -200.0])
def test_a_generated_motion_stays_where_it_is_in_the_world(tmp_path, turning, away):
    """Its bones are not exactly ours, and not quite constant."""
    rng = np.random.default_rng(0)
    uneven = turning + rng.normal(0, 0.002, turning.shape) + np.array([away, 0, -away])
    uneven[:, 2:5] += 0.005 * (turning[:, 2:5] - turning[:, 1:2])  # legs of another length
    report = write_bvh(tmp_path / "walk.bvh", uneven)
    motion = read_motion(tmp_path / "walk.bvh")
    apart = np.linalg.norm(motion.positions - uneven, axis=-1)
    assert apart.mean() < 0.008 and np.linalg.norm(apart.mean(0)) < 0.05
    assert np.abs(motion.positions[:, 0] - uneven[:, 0]).max() < 0.01, report


def test_nothing_is_left_behind_when_the_motion_is_refused(tmp_path, turning):
    (tmp_path / "walk.bvh").write_text("precious")
    turning[3, 4, 1] = np.nan
    with pytest.raises(BvhError, match="not finite"):
        write_bvh(tmp_path / "walk.bvh", turning)
    with pytest.raises(BvhError, match="no frames"):
        write_bvh(tmp_path / "walk.bvh", turning[:0])
    with pytest.raises(BvhError, match="fps"):
        write_bvh(tmp_path / "walk.bvh", turning[:2], fps=0)
    assert [path.name for path in tmp_path.iterdir()] == ["walk.bvh"]
    assert (tmp_path / "walk.bvh").read_text() == "precious"


@pytest.mark.skipif(
    shutil.which("blender") is None, reason="no Blender here; docs/BLENDER.md tells how to try"
)
def test_blender_agrees(tmp_path, turning, root):
    write_bvh(tmp_path / "walk.bvh", turning)
    script = root / "docs" / "blender_import.py"
    command = [
        "blender",
        "--background",
        "--factory-startup",
        "--python-exit-code",
        "1",
        "--python",
        script,
    ]
    command += ["--", tmp_path / "walk.bvh", tmp_path / "joints.json"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE / 1000)
    assert done.returncode == 0, done.stdout + done.stderr
    seen = json.loads((tmp_path / "joints.json").read_text())
    assert seen["fps"] == 20
    for frame, places in seen["frames"].items():
        x, y, z = np.array([places[name] for name in JOINTS]).T  # Blender: z up
        assert np.abs(np.stack([x, z, -y], -1) - turning[int(frame)]).max() < 1e-4
    assert len(seen["frames"]) == 3
