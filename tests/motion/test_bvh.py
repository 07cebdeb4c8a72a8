"""Reading BVH: dialects of the text, forward kinematics against published positions, odd files."""

import csv
from pathlib import Path

import numpy as np
import pytest
from bvh_text import SMALL, random_bvh
from scipy.spatial.transform import Rotation

from motiondiff_edu.motion.formats.bvh import Bvh, BvhError, read_bvh
from motiondiff_edu.motion.formats.bvh.frames import rate
from motiondiff_edu.motion.kinematics import euler_to_matrix


def read(tmp_path: Path, text: str | bytes, **options) -> Bvh:
    path = tmp_path / "file.bvh"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_bvh(path, **options)


def same(a: Bvh, b: Bvh) -> bool:
    arrays = all(
        np.array_equal(getattr(a, n), getattr(b, n))
        for n in ("parents", "offsets", "frames", "is_end")
    )
    return arrays and a.names == b.names and a.channels == b.channels and a.fps == b.fps


def test_reads_what_is_written(tmp_path):
    bvh = read(tmp_path, SMALL)
    assert bvh.names == ("Hips", "Left Leg", "Left Leg_End", "Chest")
    assert bvh.joints == ("Hips", "Left Leg", "Chest")
    assert bvh.parents.tolist() == [-1, 0, 1, 0]
    assert bvh.orders == ("ZXY", "ZXY", "", "YX")
    assert bvh.frames.shape == (3, 11) and bvh.frames[1, 8] == 10.0
    assert (bvh.fps, bvh.frame_time, bvh.source) == (25.0, 0.04, "file")


@pytest.mark.parametrize(
    "change",
    [
        lambda s: s.replace("\n", "\r\n"),
        lambda s: s.replace("\n", "\r"),
        lambda s: "\ufeff" + s,
        lambda s: (
            s.replace(" ", "\t").replace("Left\tLeg", "Left Leg").replace("End\tSite", "End Site")
        ),
        lambda s: s.replace("\n{", " {").replace("\n  {", "{"),
        lambda s: s.replace("Frame Time: 0.04", "Frame Time:0.04"),
        lambda s: s.replace("Frame Time: 0.04", "frame time:\t4e-2"),
        lambda s: s.rstrip("\n"),
        lambda s: s + " \n\t\n\n",
        lambda s: (
            s.replace("MOTION", "\nmotion \n")
            .replace("ROOT", "root")
            .replace("CHANNELS", "Channels")
        ),
        lambda s: (
            s.replace("Zrotation", "ZROTATION")
            .replace("OFFSET", "offset")
            .replace("JOINT", "Joint")
        ),
        lambda s: s.replace("10 20 30", "10\n20 30"),
        lambda s: s.replace("Frames: 3", "Frames:3").replace("HIERARCHY", "\n Hierarchy"),
    ],
)
def test_spellings_of_one_file_read_equal(tmp_path, change):
    assert change(SMALL) != SMALL
    assert same(read(tmp_path, change(SMALL)), read(tmp_path, SMALL))


def test_names_may_be_other_than_ascii(tmp_path):
    assert read(tmp_path, SMALL.replace("Chest", "Hüfte").encode("latin-1")).names[3] == "Hüfte"
    assert read(tmp_path, SMALL.replace("Chest", "Hüfte")).names[3] == "Hüfte"


def test_a_joint_may_be_called_end(tmp_path):
    text = SMALL.replace("JOINT Chest", "JOINT End")
    assert read(tmp_path, text).names == ("Hips", "Left Leg", "Left Leg_End", "End")
    twin = SMALL.replace(
        "JOINT Chest", "JOINT Left Leg_End"
    )  # an end site gives way to a joint of its name
    assert read(tmp_path, twin).names == ("Hips", "Left Leg", "Left Leg_End_End", "Left Leg_End")


def test_random_skeletons_come_back(tmp_path):
    rng = np.random.default_rng(3)
    for _ in range(25):
        text = random_bvh(rng)
        bvh = read(tmp_path, text)
        rows = np.array(
            [line.split() for line in text.split("Frame Time: 0.0083333\n")[1].splitlines()], float
        )
        assert np.array_equal(bvh.frames, rows) and bvh.fps == 120
        assert np.allclose(bvh.world_positions(), by_hand(bvh), atol=1e-9)


def by_hand(bvh: Bvh) -> np.ndarray:
    """Forward kinematics one node and one frame at a time, with another library's rotations."""
    world = np.zeros((len(bvh.frames), len(bvh.names), 3))
    for t, row in enumerate(bvh.frames):
        turns, column = [], 0
        for n, names in enumerate(bvh.channels):
            value = dict(zip(names, row[column : column + len(names)], strict=True))
            column += len(names)
            place = np.array(
                [value.get(a + "position", o) for a, o in zip("XYZ", bvh.offsets[n], strict=True)]
            )
            order = [name[0] for name in names if name.endswith("rotation")]
            turn = np.eye(3)
            for axis in order:
                turn = (
                    turn
                    @ Rotation.from_euler(axis, value[axis + "rotation"], degrees=True).as_matrix()
                )
            parent = bvh.parents[n]
            world[t, n] = place if parent < 0 else world[t, parent] + turns[parent] @ place
            turns.append(turn if parent < 0 else turns[parent] @ turn)
    return world


def test_root_position_replaces_its_offset(tmp_path):
    bvh = read(tmp_path, SMALL)
    assert np.array_equal(bvh.world_positions()[:, 0], bvh.frames[:, :3])
    assert np.array_equal(bvh.rest_positions()[0], [1, 90, 2])


@pytest.mark.parametrize(
    ("seconds", "fps"),
    [
        (0.0083333, 120),
        (0.03333, 30),
        (0.008342, 120000 / 1001),
        (0.0417083750417, 24000 / 1001),
        (0.042, 24),
        (0.0333, 30),
        (0.033, 30),
        (0.0083, 120),
        (0.0334, 1 / 0.0334),
        (0.043, 1 / 0.043),
    ],
)
def test_rounded_frame_times_are_understood(seconds, fps):
    assert rate(seconds) == pytest.approx(fps, rel=1e-12)


def test_fps_overrules_the_file(tmp_path):
    assert read(tmp_path, SMALL.replace("0.04", "24"), file_fps=24).fps == 24
    with pytest.raises(BvhError, match="If that is the time of a frame, pass 120"):
        read(tmp_path, SMALL, file_fps=1 / 120)
    for wrong in (0, -24, float("nan")):
        with pytest.raises(BvhError, match="fps must be a positive number"):
            read(tmp_path, SMALL, file_fps=wrong)


# ---- real files


def test_every_ok_file_reads_as_the_baseline(real_data):
    folder = real_data / "bvh_odd_and_broken"
    base = read_bvh(folder / "ok_baseline_40f.bvh")
    others = sorted(set(folder.glob("ok_*.bvh")) - {folder / "ok_baseline_40f.bvh"})
    assert len(others) >= 12
    for path in others:
        bvh = read_bvh(path)
        for field in ("frames", "parents", "offsets", "is_end"):
            assert np.array_equal(getattr(bvh, field), getattr(base, field)), (path.name, field)
        assert bvh.channels == base.channels and bvh.fps == base.fps == 24
        if path.stem not in ("ok_joint_named_End", "ok_names_with_spaces"):
            assert bvh.names == base.names, path.name
    assert "EndOfRightLeg" in read_bvh(folder / "ok_joint_named_End.bvh").names
    assert "Right Up Leg" in read_bvh(folder / "ok_names_with_spaces.bvh").names


def test_odd_files_by_their_rule(real_data):
    folder = real_data / "bvh_odd_and_broken"
    base = read_bvh(folder / "ok_baseline_40f.bvh")
    without = read_bvh(folder / "odd_no_end_sites.bvh")
    assert without.names == base.joints and np.array_equal(without.frames, base.frames)
    above = read_bvh(folder / "odd_root_zero_channels.bvh")
    assert above.names == ("Armature", *base.names) and above.channels[0] == ()
    assert np.allclose(above.world_positions()[:, 1:], base.world_positions(), atol=1e-12)


def test_forward_kinematics_is_the_published(real_data):
    bvh = read_bvh(real_data / "bvh/bvhtoolbox_walk01.bvh")
    with (real_data / "oracle/fk/bvhtoolbox_walk01_pos.csv").open() as file:
        head, *rows = csv.reader(file)
    published = np.array(rows, dtype=float)[:, 1:].reshape(len(rows), -1, 3)
    assert [name[:-2] for name in head[1::3]] == list(bvh.names)
    assert published.shape == (101, 24, 3)
    assert np.abs(bvh.world_positions() - published).max() < 1e-5


def test_sinusoidal_positions_are_the_published(real_data):
    world = read_bvh(real_data / "bvh/fairmotion_sinusoidal.bvh").world_positions()
    assert np.allclose(world[[0, 100], 0], (-3, 6, 5), atol=1e-9)
    assert np.allclose(world[100, 2], (-8, 11, 5), atol=1e-4)


def test_facts_of_bvh_python_hold(real_data):
    bvh = read_bvh(real_data / "bvh/bvhpython_test_mocapbank.bvh")
    value = {(n, c): bvh.frames[22, bvh.first_column[i] + k] for i, n in enumerate(bvh.names)
             for k, c in enumerate(bvh.channels[i])}  # fmt: skip
    assert len(bvh.frames) == 455 and len(bvh.joints) == 19
    assert bvh.orders[bvh.names.index("LeftElbow")] == "ZXY"
    assert np.allclose(bvh.offsets[bvh.names.index("RightElbow")], (-2.6865, -25.0857, 1.2959))
    assert value["Hips", "Xrotation"] == pytest.approx(-20.98) and value[
        "Chest", "Xrotation"
    ] == pytest.approx(17.65)
    assert value["Neck", "Xrotation"] == pytest.approx(-6.77) and value[
        "Head", "Yrotation"
    ] == pytest.approx(8.47)
    free = read_bvh(real_data / "bvh/bvhpython_test_freebvh.bvh")
    assert len(free.frames) == 69 and free.frame_time == 0.0333333


def test_rotation_tables_of_pybvh(real_data):
    table = np.load(real_data / "oracle/pybvh/euler_zyx_to_rotmat.npz")
    assert "degree" not in str(table["meta"]) or np.abs(table["euler"]).max() > 7
    assert np.abs(euler_to_matrix(table["euler"], "ZYX") - table["rotmat"]).max() < 1e-12


def test_mixed_orders_and_positions_after_rotations(real_data):
    first = read_bvh(real_data / "bvh/pybvh_rotation_first_root.bvh")
    assert first.channels[0][:3] == ("Zrotation", "Xrotation", "Yrotation")
    assert set(first.orders) == {"ZXY", "ZYX", "XYZ", ""}
    assert np.array_equal(first.world_positions()[:, 0], first.frames[:, 3:6])
    assert set(read_bvh(real_data / "bvh/pybvh_bvh_test1.bvh").orders) == {
        "XZY",
        "ZYX",
        "YZX",
        "XYZ",
        "",
    }


def test_every_one_of_two_thousand_frames_is_read(tmp_path):
    head = SMALL.replace("Frames: 3", "Frames: 2000").rsplit("\n", 4)[0]
    world = read(
        tmp_path, "\n".join([head, *(f"{t} 90 2 0 0 0 0 0 0 0 0" for t in range(2000))])
    ).world_positions()
    assert np.array_equal(world[:, 0], [(t, 90, 2) for t in range(2000)]) and world.shape[1] == 4
