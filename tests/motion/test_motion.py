"""A Motion: what it takes and refuses, cutting and joining, its training view, and its files."""

import json
import os
import tracemalloc
import zipfile
from dataclasses import replace

import numpy as np
import pytest
from synthetic_walk import walk as figure

from data_synth.dancing.write import main as write_dances
from data_synth.walking import walk
from data_synth.walking.write import main as write_walks
from motiondiff_edu.motion.arguments import too_many_frames
from motiondiff_edu.motion.formats import files
from motiondiff_edu.motion.formats.aist import AistError
from motiondiff_edu.motion.formats.bvh import BvhError, read_bvh
from motiondiff_edu.motion.formats.bvh.write import write_bvh
from motiondiff_edu.motion.formats.files import read_motion
from motiondiff_edu.motion.motion import Motion, MotionError, MotionWarning
from motiondiff_edu.motion.registry import Registry
from motiondiff_edu.motion.skeleton import JOINTS, PARENTS, Skeleton

STICK = Skeleton(("root", "knee", "toe"), (-1, 0, 1))
CONTROL = np.tile([1.1, 0.1, 0.4], (37, 1))


def walking(frames: int = 37) -> Motion:
    return Motion.of_clip(walk(CONTROL[:frames], seed=3), (2.0, -1.0, 0.7))


def test_a_clip_comes_back_as_it_was():
    clip = walk(CONTROL, seed=3)
    motion = Motion.of_clip(clip, (2.0, -1.0, 0.7))
    assert motion.positions.shape == (37, 21, 3) and motion.positions.dtype == np.float64
    np.testing.assert_array_equal(motion.positions, clip.world((2.0, -1.0, 0.7)))
    np.testing.assert_allclose(motion.root[0], [2.0, -1.0, 0.7])
    np.testing.assert_allclose(motion.control, clip.control, atol=1e-9)
    back = motion.to_clip()
    np.testing.assert_allclose(back.poses, clip.poses, atol=1e-12)
    np.testing.assert_array_equal(back.contacts, clip.contacts)
    assert back.source == clip.source and back.fps == 20


def test_without_a_root_the_control_is_that_of_the_smoothed_pelvis():
    """A figure that goes 1.2 m/s and turns .3 rad/s, by construction; the ends are smoothed."""
    world, _ = figure(60, speed=1.2, turn=0.3)
    inner = Motion(world).control[15:-15]
    np.testing.assert_allclose(inner[:, 2], 0.3, atol=0.05)
    np.testing.assert_allclose(np.linalg.norm(inner[:, :2], axis=1), 1.2, atol=0.05)


def test_a_motion_is_a_copy():
    positions = figure(5)[0]
    motion = Motion(positions)
    positions[:] = 0
    assert motion.positions.any()


def test_cutting_takes_along_what_belongs_to_the_frames():
    sound = np.arange(37 * 50, dtype=np.float32) / 2_000  # 1000 Hz: 50 samples a frame
    motion = walking()
    motion = Motion(
        motion.positions, 20.0, root=motion.root, contacts=motion.contacts, audio=sound,
        sample_rate=1_000, source="a walk",
    )  # fmt: skip
    cut = motion[10:24]
    assert len(cut) == 14 and cut.seconds == 0.7 and cut.source == "a walk"
    np.testing.assert_array_equal(cut.positions, motion.positions[10:24])
    np.testing.assert_array_equal(cut.root, motion.root[10:24])
    np.testing.assert_array_equal(cut.contacts, motion.contacts[10:24])
    np.testing.assert_array_equal(cut.audio, sound[500:1200])
    np.testing.assert_allclose(cut.to_clip().poses, motion.to_clip().poses[10:24], atol=1e-12)
    assert len(motion.between(0.5, 1.2)) == 14
    np.testing.assert_array_equal(motion.between(0.5, 1.2).positions, cut.positions)
    assert len(motion[-3:]) == 3
    whole = motion[:10].then(motion[10:24], motion[24:])
    np.testing.assert_array_equal(whole.positions, motion.positions)
    np.testing.assert_array_equal(whole.audio, sound)
    np.testing.assert_allclose(whole.control, motion.control)


def test_joining_leaves_out_what_only_one_of_them_has():
    motion = walking()
    bare = Motion(motion.positions)
    joined = motion.then(bare)
    assert len(joined) == 74 and joined.root is None and joined.contacts is None
    with pytest.raises(MotionError, match="30 frames/s"):
        motion.then(Motion(motion.positions, fps=30))


@pytest.mark.parametrize("cut", [1, 9, 18, 30, 36])
def test_joining_two_parts_makes_nobody_spin(cut):
    """Each part knows its heading only up to whole turns."""
    whole = walking()
    turned = whole.root + np.array([0, 0, 2 * np.pi])
    parts = whole[:cut], replace(whole, root=turned)[cut:]
    np.testing.assert_allclose(parts[0].then(parts[1]).control, whole.control, atol=1e-9)
    wrapped = whole.root.copy()
    wrapped[:, 2] = (wrapped[:, 2] + 2.1 + np.pi) % (2 * np.pi) - np.pi
    assert np.ptp(wrapped[:, 2]) > 6  # it jumps at pi
    assert np.abs(replace(whole, root=wrapped).control[:, 2]).max() < 1


def test_resampling_there_and_back():
    motion = walking()
    fast = motion.resampled(60)
    assert fast.fps == 60 and len(fast) == 109  # 36 steps of 50 ms are 108 of 1/60 s
    np.testing.assert_allclose(fast.positions[::3], motion.positions, atol=1e-9)
    np.testing.assert_allclose(fast.root[::3], motion.root, atol=1e-9)
    np.testing.assert_array_equal(fast.contacts[::3], motion.contacts)
    assert abs(fast.resampled(20).positions - motion.positions)[3:-3].max() < 0.02
    assert motion.resampled(20) is motion


@pytest.mark.parametrize("fps", [30, 60, 120])
def test_holes_stay_holes_at_another_rate(fps):
    whole = walking().resampled(fps)
    first, last = 10 * fps // 20, 20 * fps // 20
    holes = whole.positions.copy()
    holes[first:last, 7] = np.nan
    holes[:, 16] = np.nan
    motion = Motion(holes, fps).resampled(20)
    missing = ~motion.known
    assert missing[:, 16].all() and np.flatnonzero(missing[:, 7]).tolist() in (
        list(range(10, 20)),
        list(range(10, 21)),  # the first frame after the hole lies between two of the file
    )
    others = [joint for joint in range(21) if joint not in (7, 16)]
    usual = whole.resampled(20).positions
    np.testing.assert_array_equal(motion.positions[:, others], usual[:, others])
    near = motion.known[:, 7]
    assert np.abs(motion.positions[near, 7] - usual[near, 7]).max() < 0.03
    np.testing.assert_allclose(motion.positions[2:8, 7], usual[2:8, 7], atol=2e-3)


def test_sounds_of_different_rates_are_not_joined_in_silence():
    motion = walking()
    one, two = (
        replace(motion, audio=np.ones(2 * rate), sample_rate=rate) for rate in (8000, 16000)
    )
    with pytest.warns(MotionWarning, match="different sample rates and are left out"):
        assert one.then(two).audio is None
    assert len(two.then(two).audio) == 2 * round(motion.seconds * 16000)


def test_missing_joints_are_counted_and_named():
    positions = walking().positions.copy()
    positions[4, 7, 1] = np.nan  # one coordinate: the joint is missing
    motion = Motion(positions)
    assert not motion.known[4, 7] and motion.known.sum() == 37 * 21 - 1
    assert np.isnan(motion.positions[4, 7]).all() and "1 joint positions missing" in repr(motion)
    with pytest.raises(MotionError, match=f"{JOINTS[7]} in frame 4 has no position"):
        motion.to_clip()
    known = motion.all_but(["RightHand", "Head"], 10, 12)
    assert known.sum() == 37 * 21 - 1 - 4
    assert not known[10:12, [JOINTS.index("RightHand"), JOINTS.index("Head")]].any()
    assert not motion.all_but("Head")[:, JOINTS.index("Head")].any()
    with pytest.raises(KeyError, match="no joint is called 'Hed'"):
        motion.all_but(["Hed"])
    with pytest.raises(MotionError, match="frames 30 to 39 are not within its 37"):
        motion.all_but(["Head"], 30, 40)
    with pytest.raises(MotionError, match="from frame 30 up to 20 there is no frame"):
        motion.all_but(["Head"], 30, 20)


def test_it_says_what_it_is():
    said = repr(walking())
    assert "1.9 s, 37 frames at 20 frames/s, 21 joints" in said
    assert "3 joints" in repr(Motion(np.zeros((2, 3, 3)), 50, STICK))


P = np.zeros((4, 21, 3))
HOLE = np.where(np.arange(252).reshape(4, 21, 3) == 100, np.inf, 0.0)


@pytest.mark.parametrize(
    "make, told",
    [
        (lambda: Motion(np.zeros((0, 21, 3))), "at least one frame"),
        (lambda: Motion(np.zeros((4, 17, 3))), "17 joints, the skeleton 21"),
        (lambda: Motion(HOLE), f"{JOINTS[12]} in frame 1 is at"),
        (lambda: Motion(P + 2e6), "not plausible"),
        (lambda: Motion(P, fps=0), "frames a second above 0 and at most 10,000, not 0"),
        (lambda: Motion(P, fps=float("nan")), "frames a second above 0"),
        (
            lambda: Motion(P, audio=np.full(9, np.nan), sample_rate=16_000),
            "one channel of finite samples",
        ),
        (lambda: Motion(P, audio=np.zeros(9)), "audio needs its sample_rate in Hz"),
        (lambda: Motion(P)[7:], r"no frame lies within \[7:None\]"),
        (lambda: Motion(P).between(0.1, 9), "0.1 to 9 s are not within its 0.20 s"),
        (lambda: Motion(P[:1]).to_clip(), "one frame"),
        (lambda: Motion(np.zeros((4, 3, 3)), 20, STICK).to_clip(), "3 joints; the course's"),
        (lambda: Skeleton(("a", "b"), (-1, 1)), r"the parent of b \(joint 1\) is 1"),
        (lambda: Skeleton(("a", "a"), (-1, 0)), "no name twice"),
    ],
)
def test_what_is_no_motion_is_refused_in_words(make, told):
    with pytest.raises(ValueError, match=told):
        make()


def test_every_second_frame_is_another_rate():
    with pytest.raises(TypeError, match=r"motion\[first:last\].*motion.resampled"):
        Motion(P)[0:4:2]


def test_npz_keeps_everything_exactly(tmp_path):
    rng = np.random.default_rng(0)
    given = Motion(
        rng.normal(size=(5, 3, 3)), 50.0, STICK, rng.normal(size=(5, 3)),
        rng.random((5, 2)) > 0.5, rng.normal(size=77).astype(np.float32), 8_000, "ünï",
    )  # fmt: skip
    back = read_motion(given.save(tmp_path / "a folder" / "m.npz"))
    for name in ("positions", "root", "contacts", "audio"):
        np.testing.assert_array_equal(getattr(back, name), getattr(given, name))
    assert (back.fps, back.sample_rate, back.source) == (50.0, 8_000, "ünï")
    assert back.skeleton == STICK
    bare = read_motion(Motion(P).save(tmp_path / "bare.NPZ"))
    assert bare.root is None and bare.contacts is None and bare.audio is None
    assert bare.sample_rate is None


def test_an_npz_with_sound_of_an_unknown_rate_is_refused(tmp_path):
    np.savez(tmp_path / "song.npz", positions=P, fps=20, audio=np.zeros(900))
    with pytest.raises(MotionError, match=r"song\.npz: audio needs its sample_rate in Hz"):
        read_motion(tmp_path / "song.npz")


def test_bvh_there_and_back_within_its_rounding(tmp_path, capsys):
    """The file holds centimetres and degrees with six digits; the figure stands where it stood."""
    given = walking()
    back = read_motion(given.save(tmp_path / "m.bvh"))
    assert "the joints exactly where they were" in capsys.readouterr().out
    assert len(back) == 37 and back.source == "m"
    np.testing.assert_allclose(back.positions, given.positions, atol=1e-6)
    np.testing.assert_allclose(
        read_bvh(tmp_path / "m.bvh").world_positions()[:, 0], 100 * given.positions[:, 0], atol=1e-3
    )


def test_files_of_data_synth_are_read(tmp_path):
    write_walks(["--out", str(tmp_path), "--clips", "1", "--seconds", "2"])
    write_dances(["--out", str(tmp_path), "--dances", "1", "--seconds", "9"])
    both = read_motion(tmp_path / "walk_000.npz"), read_motion(tmp_path / "walk_000.bvh")
    for one in both:
        assert len(one) == 40
        at_start = one.positions - one.positions[:1, :1] * [1, 0, 1]
        assert np.abs(at_start[:, 0, 1] - 0.95).max() < 0.15  # metres: it stands
    np.testing.assert_allclose(both[0].positions, both[1].positions, atol=1e-5)
    dance = read_motion(next(tmp_path.glob("dance_*.npz")))
    assert dance.positions.shape[1:] == (21, 3) and dance.contacts is not None


def test_a_recording_that_was_read_is_not_replaced_by_what_was_read_of_it(tmp_path, capsys):
    path = tmp_path / "recording.bvh"
    walking().save(path)  # what was not read is replaced
    walking().save(path)
    write_bvh(path, walking(30).positions)  # a recording, as by another program
    before = path.read_bytes()
    motion = read_motion(path)
    with pytest.raises(MotionError, match="recording.bvh was read, and it would be lost: choose"):
        motion[:20].save(tmp_path / "." / "recording.bvh")
    assert path.read_bytes() == before
    motion[:20].save(path, overwrite=True)
    motion[:10].save(path)  # now it is our own
    assert len(read_motion(path)) == 10


def test_what_was_written_here_can_be_read_and_written_again(tmp_path):
    path = tmp_path / "made.bvh"
    for _ in range(2):  # as when all cells of a notebook are run a second time
        walking().save(path)
        assert len(read_motion(path)) == len(walking())
    other = tmp_path / "other.bvh"
    write_bvh(other, walking(30).positions)
    os.replace(other, path)  # somebody else's, under the same name
    again = read_motion(path)
    with pytest.raises(MotionError, match="made.bvh was read"):
        again.save(path)
    again.save(path, overwrite=True)
    read_motion(path).save(path)


@pytest.mark.parametrize(
    "turn, told",
    [
        (lambda x: np.stack([x[..., 0], -x[..., 2], x[..., 1]], -1), "z up"),
        (lambda x: np.stack([x[..., 0], x[..., 2], -x[..., 1]], -1), "-z up"),
        (lambda x: np.stack([x[..., 1], -x[..., 0], x[..., 2]], -1), "x up"),
        (lambda x: np.stack([-x[..., 1], x[..., 0], x[..., 2]], -1), "-x up"),
        (lambda x: x * [1, -1, -1], "-y up"),
    ],
)
def test_another_axis_that_points_up_is_told_and_turned(tmp_path, turn, told):
    positions = walking().positions
    np.savez(tmp_path / "up.npz", positions=turn(positions), fps=20.0)
    with pytest.warns(MotionWarning, match=f"up.npz: {told}: .*the feet.*; the figure was turned"):
        made = read_motion(tmp_path / "up.npz")
    assert made.about.startswith(told) and any("turned" in note for note in made.notes)
    # it is upright, not mirrored, and walks as it did, wherever it heads
    np.testing.assert_allclose(made.positions[..., 1], positions[..., 1], atol=1e-9)
    apart = [
        np.linalg.norm(x[:, :, None] - x[:, None], axis=-1) for x in (positions, made.positions)
    ]
    np.testing.assert_allclose(*apart, atol=1e-9)
    left, up, ahead = (
        made.positions[:, a] - made.positions[:, b] for a, b in ((1, 5), (11, 0), (4, 3))
    )
    assert np.median(np.einsum("ti,ti->t", np.cross(left, up), ahead)) > 0


def test_an_unknown_ending_says_which_there_are(tmp_path):
    for name, told in (("m.xyz", "unknown ending .xyz"), ("m", "the name has no ending")):
        with pytest.raises(MotionError, match=told + "; use one of .bvh .npz .mp4 .gif .html"):
            Motion(P).save(tmp_path / name)
    assert not list(tmp_path.iterdir())


def test_what_cannot_be_bvh_is_not_written(tmp_path):
    broken = walking().positions
    broken[3, 5] = np.nan
    wrong = {"3 joints": Motion(np.zeros((4, 3, 3)), 20, STICK), "frame 3": Motion(broken)}
    for told, motion in wrong.items():
        with pytest.raises(MotionError, match=told):
            motion.save(tmp_path / "m.bvh")
    assert not list(tmp_path.iterdir())


def _npz(path, **arrays):
    np.savez(path, **arrays)


def _broken_npz(path):
    whole = path.with_name("whole.npz")
    Motion(P).save(whole)
    path.write_bytes(whole.read_bytes()[:200])


def _huge(path):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as packed:
        head = b"\x93NUMPY\x01\x00v\x00"
        shape = json.dumps({"shape": [1]}).encode().ljust(118)
        packed.writestr("positions.npy", head + shape)


def test_too_many_frames_are_refused_before_they_take_memory(tmp_path):
    path = tmp_path / "many.npz"
    np.savez_compressed(path, positions=np.zeros((432_001, 21, 3), np.float32), fps=20.0)
    tracemalloc.start()
    with pytest.raises(MotionError, match=r"many.npz.* 432,001 frames, and 432,000 at most are"):
        read_motion(path)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert path.stat().st_size < 200_000 and most < 5_000_000 < 432_001 * 63 * 4
    assert files.LARGEST < 975_000_000  # whatever fills it: a file of 196 kB took so much
    assert not too_many_frames(10 * 60 * 120)  # ten minutes of a studio's
    quiet = Motion(P, 20.0, audio=np.zeros(432_001), sample_rate=48_000)
    assert len(read_motion(quiet.save(tmp_path / "quiet.npz")).audio) == 432_001


def test_a_long_name_is_not_printed_whole(tmp_path):
    names = ["n" * 100_000, *JOINTS[1:]]
    for written in ({}, {"parents": PARENTS, "format": "motiondiff_edu motion 1"}):
        np.savez(tmp_path / "m.npz", positions=walking().positions, fps=20, names=names, **written)
        with pytest.raises(MotionError, match=r"m.npz: the name n+\.\.\. has 100,000 ") as caught:
            read_motion(tmp_path / "m.npz")
        assert len(str(caught.value)) < 200
    np.savez(tmp_path / "m.npz", **{"n" * 60_000: P})
    with pytest.raises(MotionError, match="m.npz contains nnn") as caught:
        read_motion(tmp_path / "m.npz")
    assert len(str(caught.value)) < 400


WRONG_FILES = {
    "text.npz": (lambda p: p.write_text("hello"), "cannot be read as npz"),
    "empty.npz": (lambda p: p.write_bytes(b""), "cannot be read as npz"),
    "half.npz": (_broken_npz, "cannot be read as npz"),
    "head.npz": (_huge, "cannot be read as npz"),
    "pickle.npz": (lambda p: _npz(p, positions=np.array([{}], object)), "pickled objects"),
    "other.npz": (lambda p: _npz(p, trans=np.zeros((2, 3))), r"contains trans \(2, 3\)"),
    "rate.npz": (lambda p: _npz(p, positions=P, fps=-20.0), "frames a second above 0"),
    "smpl.npz": (lambda p: _npz(p, poses=np.zeros((2, 156)), control=np.zeros((2, 3))), "smpl.npz"),
    "walk.png": (
        lambda p: p.write_bytes(b"\x89PNG"),
        "cannot be read as a motion; .bvh, .npy, .npz and .pkl can",
    ),
    "song.ogg": (lambda p: p.write_bytes(b"OggS"), "pkl can. This is sound"),
    "walk.fbx": (lambda p: p.write_bytes(b"Kaydara"), "Export it as BVH"),
    "walk.pickle": (lambda p: p.write_bytes(b"\x80"), "A pickle can run code"),
    "walk.pkl": (lambda p: p.write_bytes(b"\x80"), "not a pickle, or a damaged one"),
    "empty.bvh": (lambda p: p.write_bytes(b""), "the file is empty"),
    "png.bvh": (lambda p: p.write_bytes(b"\x89PNG\0\0"), "binary file"),
}


@pytest.mark.parametrize("name", WRONG_FILES)
def test_a_file_that_is_no_motion_is_named_with_its_fault(name, tmp_path):
    make, told = WRONG_FILES[name]
    make(tmp_path / name)
    with pytest.raises((MotionError, BvhError, AistError), match=told) as caught:
        read_motion(tmp_path / name)
    assert name in str(caught.value)


def test_no_file_and_a_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(
        FileNotFoundError, match="there is no file nope.bvh in .*check the spelling"
    ):
        read_motion("nope.bvh")
    walking().save("m.bvh")
    (tmp_path / "m.bvh").rename(tmp_path / ".bvh")
    assert len(read_motion(".bvh")) == 37
    (tmp_path / "folder.bvh").mkdir()
    with pytest.raises(MotionError, match="folder.bvh is a folder; give the name of a file in it"):
        walking().save(tmp_path / "folder.bvh")
    with pytest.raises(MotionError, match="is a folder"):
        read_motion(tmp_path)


def test_every_recording_of_a_humanoid_is_read_or_refused_in_words(real_data):
    files = sorted((real_data / "bvh").glob("*.bvh"))
    read, refused = {}, {}
    for path in files:
        try:
            read[path.stem] = read_motion(path)
        except BvhError as error:
            refused[path.stem] = str(error)
    assert len(read) >= 12 and len(read) + len(refused) == len(files)
    for name, motion in read.items():
        assert motion.fps == 20 and motion.known.all(), name
        assert motion.source == name and np.isfinite(motion.control).all()
    assert all(name in words for name, words in refused.items())


def test_names_are_announced_before_their_module_is_imported():
    registry = Registry()
    registry.announce("no_such_module_at_all", ".late")
    registry.register(".now")(len)
    assert registry.names() == [".late", ".now"] and registry.get(".now") is len
    assert registry.get(".never") is None
    with pytest.raises(ModuleNotFoundError):
        registry.get(".late")


def test_a_source_that_is_no_text_is_passed_over(tmp_path):
    path, positions = tmp_path / "mine.npz", walking().positions
    np.savez(path, positions=positions, fps=20.0, source=np.zeros((90, 90)))
    assert read_motion(path).source == "mine"
    np.savez(path, positions=positions, fps=20.0, source="long " * 100)
    assert read_motion(path).source == ("long " * 100)[:200]
