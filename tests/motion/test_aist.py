"""AIST++ keypoints.

What is read, in which unit, and that a hostile pickle is refused before it runs.
"""

import codecs
import os
import pickle
from pathlib import Path

import numpy as np
import pytest
from numpy._core.multiarray import _reconstruct
from numpy._core.numeric import _frombuffer as frombuffer

from motiondiff_edu.motion.formats import aist
from motiondiff_edu.motion.formats.aist import AistError, read_keypoints
from motiondiff_edu.motion.formats.files import read_motion

NAME = "gJS_sBM_cAll_d03_mJS4_ch06.pkl"


def made_up(frames=7):
    """A figure 1.7 m tall whose lowest joint is 70 cm up, in cm."""
    rng = np.random.default_rng(1)
    keypoints = rng.uniform(80, 240, (frames, 17, 3))
    keypoints[:, 15, 1] = 70.0
    return keypoints


def written(folder, content, name=NAME, protocol=4):
    path = folder / name
    path.write_bytes(pickle.dumps(content, protocol=protocol))
    return path


def test_real_clips_are_read(real_data):
    folder = real_data / "aist" / "keypoints3d"
    clip = read_keypoints(folder / "gBR_sBM_cAll_d06_mBR2_ch06.pkl")
    assert clip.positions.shape == (576, 17, 3) and clip.fps == 60
    assert np.isfinite(clip.positions).all()
    assert 0.67 < clip.floor < 0.72  # the lowest joint, metres, as others measured
    height = clip.positions[:, 0, 1] - clip.positions[:, 15:, 1].min(1)
    assert 1.3 < np.percentile(height, 95) < 1.8  # nose above the lower ankle


@pytest.mark.parametrize("protocol", [2, 4, 5])
def test_centimetres_become_metres_above_the_floor(tmp_path, protocol):
    content = {"keypoints3d": made_up(5) + 50, "keypoints3d_optim": made_up()}
    clip = read_keypoints(written(tmp_path, content, protocol=protocol))
    assert clip.floor == pytest.approx(0.7) and clip.source == NAME
    np.testing.assert_allclose(clip.positions, made_up() / 100 - [0, 0.7, 0])


def test_one_bad_frame_does_not_lower_the_floor(tmp_path):
    keypoints = made_up(300)
    keypoints[40, 3, 1] = -90.0
    assert read_keypoints(
        written(tmp_path, {"keypoints3d_optim": keypoints})
    ).floor == pytest.approx(0.7)


def test_missing_joints_stay_missing(tmp_path):
    keypoints = made_up()
    keypoints[2, 5, 0] = np.nan
    clip = read_keypoints(written(tmp_path, {"keypoints3d_optim": keypoints}))
    assert np.argwhere(np.isnan(clip.positions)).tolist() == [[2, 5, 0]]
    assert clip.floor == pytest.approx(0.7)
    keypoints[:, 1] = np.nan
    with pytest.raises(AistError, match="every frame"):
        read_keypoints(written(tmp_path, {"keypoints3d_optim": keypoints}))


class Hostile:
    """Unpickled plainly, this makes a folder; a worse one could do anything."""

    def __init__(self, folder):
        self.folder = str(folder)

    def __reduce__(self):
        return os.mkdir, (self.folder,)


def test_a_hostile_pickle_is_refused_and_does_not_run(tmp_path):
    trap = tmp_path / "sprung"
    path = written(tmp_path, {"keypoints3d_optim": made_up(), "more": Hostile(trap)})
    with pytest.raises(AistError, match=r"names (posix|nt)\.mkdir.*may run a program"):
        read_keypoints(path)
    assert not trap.exists()
    pickle.loads(path.read_bytes())  # and it was a trap
    assert trap.exists()


@pytest.mark.parametrize("what", [eval, getattr, np.load, codecs.decode, Hostile])
def test_nothing_but_arrays_is_named(tmp_path, what):
    with pytest.raises(AistError, match="an array does not need"):
        read_keypoints(written(tmp_path, {"keypoints3d_optim": what}))


class Spelled:
    """What a pickle may name, called with other arguments than numpy's own pickles have."""

    def __init__(self, call, *arguments, state=None):
        self.parts = (call, arguments) if state is None else (call, arguments, state)

    def __reduce__(self):
        return self.parts


ADDRESSES = b"A" * 8  # numpy would take them for the address of an object


@pytest.mark.parametrize(
    "array",
    [
        Spelled(np.ndarray, (1,), np.dtype("O"), ADDRESSES),
        Spelled(np.ndarray, Spelled(np.ndarray, (1,), "O", ADDRESSES)),
        Spelled(np.dtype, "O"),
        Spelled(np.dtype, "f8", state=(3, "!", None, None, None, -1, -1, 0)),
        Spelled(frombuffer, ADDRESSES, np.dtype("f8"), (2,), "C"),
        Spelled(frombuffer, ADDRESSES, np.dtype("f8"), (-1,), "C"),
        Spelled(frombuffer, ADDRESSES, np.dtype("f8"), ADDRESSES, "C"),
        Spelled(frombuffer, ADDRESSES, "f8", (1,), "C"),
        Spelled(_reconstruct, np.ndarray, (0,), b"b"),
        Spelled(
            _reconstruct, np.ndarray, (0,), b"b", state=(1, (9, 17, 3), np.dtype("f8"), 0, b"")
        ),
    ],
)
def test_an_array_is_made_of_checked_parts_alone(tmp_path, array):
    """numpy, called with these, would read memory that is not the file's."""
    path = written(tmp_path, {"keypoints3d_optim": array})
    with pytest.raises(AistError, match=f"{NAME}: "):
        read_keypoints(path)


def test_a_pickle_cannot_change_the_reader(tmp_path):
    changed = Spelled(codecs.encode, "a", "latin1")
    raw = pickle.dumps({"keypoints3d_optim": made_up(), "more": changed}, protocol=2)
    call = b"c_codecs\nencode\n}X\x01\x00\x00\x00aK\x01sb"  # BUILD of the function itself
    (tmp_path / NAME).write_bytes(raw[:2] + call + b"0" + raw[2:])
    with pytest.raises(AistError, match="changes a function"):
        read_keypoints(tmp_path / NAME)


@pytest.mark.parametrize("code", ["<f4", ">f8", "<f2"])
def test_numbers_of_every_size_and_order_are_read(tmp_path, code):
    for order in "CF":
        keypoints = np.array(made_up(), code, order=order)
        clip = read_keypoints(written(tmp_path, {"keypoints3d_optim": keypoints}))
        np.testing.assert_allclose(clip.positions, made_up() / 100 - [0, 0.7, 0], atol=2e-3)


def test_only_the_codec_of_old_pickles_is_admitted(tmp_path):
    class Compressed:
        def __reduce__(self):
            return codecs.encode, ("aa", "rot13")

    with pytest.raises(AistError, match="codec 'rot13'"):
        read_keypoints(written(tmp_path, {"keypoints3d_optim": Compressed()}))


def test_what_is_endless_to_print_is_not_printed(tmp_path):
    nested: object = ()
    for _ in range(40):  # 2^40 brackets, and a few bytes in the file
        nested = (nested, nested)
    for content in (Spelled(np.dtype, nested), Spelled(codecs.encode, "a", nested)):
        with pytest.raises(AistError) as caught:
            read_keypoints(written(tmp_path, content))
        assert len(str(caught.value)) < 400


def test_a_small_pickle_cannot_ask_for_much_memory_or_time(tmp_path):
    nested: object = ()
    for _ in range(40):  # its hash takes 2^40 steps
        nested = (nested, nested)
    place = (2**31 - 1).to_bytes(4, "little")
    many = b"\x80\x02" + b"]0" * 10**5
    key = b"\x80\x02}" + pickle.dumps(nested, 2)[2:-1] + b"K\x01s."  # {nested: 1}
    alike = pickle.dumps({k * (2**61 - 1): 0 for k in range(24_000)})  # all hashes are 0
    for raw in (key, b"\x80\x02]r" + place + b".", many, alike):
        (tmp_path / NAME).write_bytes(raw)
        with pytest.raises(AistError, match="more parts than arrays need"):
            read_keypoints(tmp_path / NAME)
    both = np.array(made_up())
    for protocol in range(6):  # arrays of all protocols are read, and the same one twice
        content = {"keypoints3d_optim": both, "keypoints3d": both, "more": both.copy()}
        assert len(read_keypoints(written(tmp_path, content, NAME, protocol)).positions)


@pytest.mark.parametrize(
    "content, told",
    [
        (
            {"smpl_poses": np.zeros((3, 72)), "smpl_trans": np.zeros((3, 3))},
            "joint angles: take the file of that name",
        ),
        (
            {"keypoints3d_optim": np.zeros((3, 24, 3))},
            r"has shape \(3, 24, 3\); it should be \(frames, 17, 3\)",
        ),
        ({"keypoints3d_optim": np.zeros((0, 17, 3))}, r"shape \(0, 17, 3\)"),
        ({"keypoints3d_optim": [1, 2]}, "is not an array of numbers"),
        ([1, 2], "contains list, but no keypoints3d_optim"),
    ],
)
def test_other_contents_are_told_apart(tmp_path, content, told):
    with pytest.raises(AistError, match=told):
        read_keypoints(written(tmp_path, content))


def test_other_files_are_told_apart(tmp_path, real_data):
    np.save(tmp_path / "dance.npy", np.zeros((90, 34)))
    with pytest.raises(AistError, match="34 normalised music or motion features"):
        read_keypoints(tmp_path / "dance.npy")
    np.save(tmp_path / "joints.npy", np.zeros((90, 22, 3)))
    with pytest.raises(AistError, match=r"shape \(90, 22, 3\)"):
        read_keypoints(tmp_path / "joints.npy")
    np.save(tmp_path / "objects.npy", np.array([{}], dtype=object))
    with pytest.raises(AistError, match="Python objects"):
        read_keypoints(tmp_path / "objects.npy")
    whole = written(tmp_path, {"keypoints3d_optim": made_up()}).read_bytes()
    for name, raw in (
        ("cut.pkl", whole[:200]),
        ("empty.pkl", b""),
        ("page.pkl", b"<html>not found</html>"),
    ):
        (tmp_path / name).write_bytes(raw)
        with pytest.raises(AistError, match=f"{name}: not a pickle, or a damaged one"):
            read_keypoints(tmp_path / name)
    with pytest.raises(AistError, match="folder"):
        read_keypoints(tmp_path)
    with pytest.raises(AistError, match="joint angles"):
        read_keypoints(real_data / "aist" / "motions" / "gBR_sBM_cAll_d06_mBR2_ch06.pkl")
    with pytest.raises(FileNotFoundError):
        read_keypoints(tmp_path / "none.pkl")


def test_too_many_frames_and_too_large_a_file_are_refused(tmp_path, monkeypatch):
    path = written(tmp_path, {"keypoints3d_optim": np.zeros((432_001, 1), np.int8)})
    with pytest.raises(AistError, match=f"{NAME}.* 432,001 frames, and 432,000 at most are read"):
        read_keypoints(path)
    monkeypatch.setattr(aist, "LARGEST", 400_000)
    monkeypatch.setattr(Path, "read_bytes", lambda _: pytest.fail("it was read"))
    with pytest.raises(AistError, match="larger than 0 MB"):
        read_motion(path)


def test_places_beyond_ten_kilometres_and_endless_names_are_refused(tmp_path):
    far = made_up()
    far[2, 3, 1] = -1e300
    with pytest.raises(AistError, match="keypoints3d_optim goes ten kilometres away"):
        read_keypoints(written(tmp_path, {"keypoints3d_optim": far}))
    with pytest.raises(AistError, match="contains kkk") as caught:
        read_keypoints(written(tmp_path, {"k" * 1_000_000: made_up()}))
    assert len(str(caught.value)) < 400
