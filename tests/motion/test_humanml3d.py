"""HumanML3D: vectors and joints as positions in metres, statistics, captions, a folder.

The expected positions are those of a circle in closed form. Other vectors come from a writer of
our own, which follows the definition of the data set with scipy's rotations.
"""

import itertools

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from synthetic_walk import walk

import motiondiff_edu as md
from motiondiff_edu.__main__ import main
from motiondiff_edu.motion.formats import humanml3d, humanml3d_folder
from motiondiff_edu.motion.formats.humanml3d import HUMANML, Statistics
from motiondiff_edu.motion.motion import MotionError, MotionWarning
from motiondiff_edu.motion.retarget import load_clip, onto_our_bones
from motiondiff_edu.motion.root_frame import body_heading
from motiondiff_edu.motion.skeleton import BONE_LENGTHS, BONES, JOINTS, PARENTS, joint_index

# a standing figure, metres: x to its left, y up, z ahead, in the order of SMPL
STANDING = np.array(
    [
        [0.00, 0.94, 0.00],  # pelvis
        [0.06, 0.85, 0.00],  # left hip
        [-0.06, 0.85, 0.00],
        [0.00, 1.05, -0.01],  # spine1
        [0.10, 0.47, 0.01],  # left knee
        [-0.10, 0.47, 0.01],
        [0.00, 1.18, 0.01],  # spine2
        [0.09, 0.07, -0.02],  # left ankle
        [-0.09, 0.07, -0.02],
        [0.00, 1.24, 0.02],  # spine3
        [0.11, 0.00, 0.11],  # left foot
        [-0.11, 0.00, 0.11],
        [0.00, 1.45, 0.01],  # neck
        [0.08, 1.36, 0.00],  # left collar
        [-0.08, 1.36, 0.00],
        [0.00, 1.54, 0.06],  # head
        [0.18, 1.39, -0.01],  # left shoulder
        [-0.18, 1.39, -0.01],
        [0.22, 1.14, -0.03],  # left elbow
        [-0.22, 1.14, -0.03],
        [0.24, 0.90, 0.05],  # left wrist
        [-0.24, 0.90, 0.05],
    ]
)
RADIUS = 2.0


def circle(frames, turn):
    """The standing figure, carried to the left along a circle, from the origin ahead (z).

    `turn` is its angle a frame. The centre lies at x = RADIUS.
    """
    angle = turn * np.arange(frames)
    sin, cos = np.sin(angle)[:, None], np.cos(angle)[:, None]
    aside, up, ahead = STANDING.T
    x = RADIUS * (1 - cos) + aside * cos + ahead * sin
    z = RADIUS * sin - aside * sin + ahead * cos
    return np.stack([x, np.broadcast_to(up, x.shape), z], -1)


def vectors_of_circle(frames, turn):
    """The numbers of `circle`, worked out by hand.

    The root moves along a chord of 2 r sin(turn / 2), which lies half a turn to the left of the
    heading before it and half a turn to the right of the heading after it.
    """
    chord, half = 2 * RADIUS * np.sin(turn / 2), turn / 2
    row = np.zeros(263)
    row[0] = -half  # to the left is negative
    row[1:3] = chord * np.array([-np.sin(half), np.cos(half)])
    row[3] = 0.94
    row[4:67] = STANDING[1:].ravel()
    row[193], row[195] = chord * np.sin(half), chord * np.cos(half)
    row[259:] = [1, 0, 0, 1]
    return np.tile(row, (frames, 1))


def turned_left(angles):
    """Rotations about y; a positive angle (radians) turns z towards x, the left."""
    return Rotation.from_rotvec(np.outer(angles, [0.0, 1.0, 0.0]))


def as_vectors(joints, heading):
    """The 263 numbers of each frame but the last, as the data set defines them.

    q turns the world so that the figure faces z. Rotations are left at 0.
    """
    q = turned_left(-heading)
    rows = np.zeros((len(joints) - 1, 263))
    for t, row in enumerate(rows):
        row[0] = np.arcsin((q[t + 1] * q[t].inv()).as_quat(canonical=True)[1])
        move = joints[t + 1] - joints[t]
        row[1:3] = q[t + 1].apply(move[0])[[0, 2]]
        row[3] = joints[t, 0, 1]
        row[4:67] = q[t].apply(joints[t] - joints[t, 0] * [1, 0, 1])[1:].ravel()
        row[193:259] = q[t].apply(move).ravel()
        row[259:] = (move[[7, 10, 8, 11]] ** 2).sum(-1) < 0.002
    return rows


def statistics(whose):
    """Made-up statistics of each kind: constant within a group, as the published ones are."""
    mean = np.zeros(263)
    mean[3], mean[259:] = 0.94, 0.85
    mean[4:67] = STANDING[1:].ravel()
    groups = {0: 0.05, 1: 0.04, 3: 0.15, 4: 0.2, 67: 0.3, 193: 0.04, 259: 0.356}
    std = np.ones(263)
    for first, value in groups.items():
        small = whose == "evaluator" and first in (0, 1, 3, 259)
        std[first:] = value / 25 if small else value
    return Statistics(mean, std)


WALKED = walk(31, turn=0.7)[0]  # it turns to the left
STEPS = as_vectors(humanml3d.from_course(WALKED), 0.7 * np.arange(31) / 20)
STILL = as_vectors(np.tile(STANDING, (9, 1, 1)), np.zeros(9))


# -- vectors


@pytest.mark.parametrize("turn", [0.06, -0.11])
def test_a_circle_by_hand(turn):
    joints = humanml3d.joints_of(vectors_of_circle(53, turn))
    assert joints.shape == (53, 22, 3)
    np.testing.assert_allclose(joints, circle(53, turn), atol=1e-12)


def test_the_writer_of_these_tests_agrees_with_the_numbers_by_hand():
    ours, hand = as_vectors(circle(8, 0.06), 0.06 * np.arange(8)), vectors_of_circle(7, 0.06)
    np.testing.assert_allclose(ours[:, :67], hand[:, :67], atol=1e-12)
    np.testing.assert_allclose(ours[:, 193:196], hand[:, 193:196], atol=1e-12)


def test_a_walk_that_changes_its_speed_and_its_turning_comes_back():
    rng = np.random.default_rng(3)
    frames = 47
    heading = np.concatenate([[0.0], np.cumsum(rng.uniform(-0.4, 0.4, frames - 1))])
    moves = np.concatenate([[[0, 0]], rng.uniform(-0.05, 0.08, (frames - 1, 2))])
    joints = STANDING + rng.uniform(-0.02, 0.02, (frames, 22, 3))
    joints[:, 0, [0, 2]] = 0.0
    joints = np.einsum("tij,tkj->tki", turned_left(heading).as_matrix(), joints)
    joints[..., [0, 2]] += np.cumsum(moves, 0)[:, None]
    back = humanml3d.joints_of(as_vectors(joints, heading).astype(np.float32))
    np.testing.assert_allclose(back, joints[:-1], atol=2e-6)


def test_a_recorded_dance_comes_back(real_data):
    world = load_clip(real_data / "bvh" / "cmu_05_06_dance.bvh").world()
    heading = np.unwrap(body_heading(world))
    world = world - world[0, 0] * [1, 0, 1]
    world = np.einsum("ij,tkj->tki", turned_left(-heading[:1]).as_matrix()[0], world)
    joints = humanml3d.from_course(world)
    vectors = as_vectors(joints, heading - heading[0])
    np.testing.assert_allclose(humanml3d.joints_of(vectors), joints[:-1], atol=1e-9)
    for own, other in (("data set", "evaluator"), ("evaluator", "data set")):
        small = (vectors - statistics(own).mean) / statistics(own).std
        for first in range(0, len(small), 40):
            with pytest.raises(MotionError, match="is no figure in metres"):
                humanml3d.check_vectors(small[first : first + 40])
            with pytest.raises(MotionError, match=f"use those of the {own}"):
                humanml3d.unstandardise(small[first : first + 40], statistics(other))


def test_the_left_hip_is_on_the_left_of_a_figure_that_walks_ahead():
    motion = humanml3d.to_course(humanml3d.joints_of(STEPS))
    ahead = motion[5, 0] - motion[0, 0]
    for part in ("UpLeg", "Leg", "Foot", "ToeBase", "Arm", "ForeArm", "Hand", "HandIndex1"):
        left, right = (motion[:5, joint_index(s + part)].mean(0) for s in ("Left", "Right"))
        assert np.cross(ahead, left - right)[1] > 0, part  # y = z cross x


# -- joints

# the course's joints, by their numbers in SMPL's order
NUMBERED = [0, 1, 4, 7, 10, 2, 5, 8, 11, 3, 6, 12, 15, 16, 18, 20, None, 17, 19, 21, None]


def test_19_joints_stay_and_the_tips_extend_the_forearms():
    joints = np.random.default_rng(0).normal(size=(4, 22, 3))
    course = humanml3d.to_course(joints)
    for ours, theirs in enumerate(NUMBERED):
        if theirs is not None:
            np.testing.assert_array_equal(course[:, ours], joints[:, theirs], JOINTS[ours])
    for tip, hand, elbow in ((16, 20, 18), (20, 21, 19)):
        forearm = joints[:, hand] - joints[:, elbow]
        np.testing.assert_allclose(course[:, tip], joints[:, hand] + 0.36 * forearm)


def test_bones_that_both_skeletons_have_keep_their_lengths():
    course = humanml3d.to_course(STANDING[None])[0]
    both = [
        (ours, parent)
        for ours, parent in enumerate(PARENTS)
        if ours and NUMBERED[ours] and HUMANML.parents[NUMBERED[ours]] == NUMBERED[parent]
    ]
    # legs 8, lower spine 2, head 1, upper arms and forearms 4
    assert len(both) == 15
    for ours, parent in both:
        bone = STANDING[NUMBERED[ours]] - STANDING[HUMANML.parents[NUMBERED[ours]]]
        assert np.linalg.norm(course[ours] - course[parent]) == pytest.approx(np.linalg.norm(bone))


def test_back_to_22_joints():
    joints = humanml3d.from_course(humanml3d.to_course(STANDING[None]))[0]
    off = np.linalg.norm(joints - STANDING, axis=-1)
    guessed = [HUMANML.names[j] for j in np.flatnonzero(off)]
    assert guessed == ["spine3", "left_collar", "right_collar"] and off.max() < 0.04
    again = humanml3d.to_course(humanml3d.from_course(WALKED))
    tips = [joint_index(side + "HandIndex1") for side in ("Left", "Right")]
    assert np.array_equal(np.delete(again, tips, 1), np.delete(WALKED, tips, 1))


def test_the_skeleton_has_the_chains_of_smpl():
    chains = ((0, 2, 5, 8, 11), (0, 1, 4, 7, 10), (0, 3, 6, 9, 12, 15))
    chains += ((9, 14, 17, 19, 21), (9, 13, 16, 18, 20))
    bones = {pair for chain in chains for pair in itertools.pairwise(chain)}
    assert {(parent, j) for j, parent in enumerate(HUMANML.parents) if j} == bones
    assert [n for n, name in enumerate(HUMANML.names) if name.startswith("left")] == [
        1, 4, 7, 10, 13, 16, 18, 20,
    ]  # fmt: skip


# -- statistics


@pytest.mark.parametrize("whose", ["data set", "evaluator"])
@pytest.mark.parametrize("vectors", [STEPS, STILL], ids=["walking", "still"])
def test_standardised_numbers_are_refused_and_undone_by_their_own_statistics(whose, vectors):
    other = statistics("data set" if whose == "evaluator" else "evaluator")
    own = statistics(whose)
    assert own.kind == whose
    small = (vectors - own.mean) / own.std
    with pytest.raises(MotionError, match="walk is no figure in metres.*standardised"):
        humanml3d.check_vectors(small, "walk")
    np.testing.assert_allclose(humanml3d.unstandardise(small, own), vectors, atol=1e-12)
    with pytest.raises(MotionError, match=f"statistics of the {other.kind}; use .* the {whose}"):
        humanml3d.unstandardise(small, other)


@pytest.mark.parametrize("factor, told", [(25, "large"), (1 / 25, "small")])
def test_the_root_alone_betrays_the_wrong_statistics(factor, told):
    """Of a generated array: its contacts are nowhere near those of the wrong statistics."""
    vectors = STEPS.copy()
    vectors[:, :3] *= factor
    with pytest.raises(MotionError, match=f"the contacts are too {told}"):
        humanml3d.check_vectors(vectors)


def test_other_statistics_are_told_apart(tmp_path):
    own = statistics("data set")
    with pytest.raises(MotionError, match="neither the statistics.*exchanged"):
        Statistics(own.std, own.mean + 1).kind  # noqa: B018
    with pytest.raises(MotionError, match="neither"):
        Statistics(own.mean, own.std / 5).kind  # noqa: B018
    with pytest.raises(MotionError, match="std contains NaN or, as a deviation, a number not"):
        Statistics(own.mean, own.std * 0)
    np.save(tmp_path / "Mean.npy", own.mean)
    np.save(tmp_path / "Std.npy", own.std.astype(np.float32))
    read = humanml3d.read_statistics(tmp_path / "Mean.npy", tmp_path / "Std.npy")
    assert read.kind == "data set" and np.array_equal(read.mean, own.mean)
    np.save(tmp_path / "Std.npy", own.std[:251])
    with pytest.raises(MotionError, match=r"Std.npy has shape \(251,\)"):
        humanml3d.read_statistics(tmp_path / "Mean.npy", tmp_path / "Std.npy")


def test_legs_too_short_or_of_changing_length_are_no_legs():
    for scale in (np.full(30, 0.1), np.linspace(0.6, 1.4, 30), np.full(30, 2.0)):
        vectors = STEPS.copy()
        vectors[:, 4:67] *= scale[:, None]
        with pytest.raises(MotionError, match="is no figure in metres"):
            humanml3d.check_vectors(vectors)


def test_figures_that_lie_or_make_one_frame_are_not_taken_for_standardised():
    lying = STANDING[:, [0, 2, 1]] * [1, 1, -1] + [0, 0.2, 0]
    flat = as_vectors(np.tile(lying, (6, 1, 1)), np.zeros(6))
    for vectors in (flat, STEPS[:1], STILL[:1]):
        assert len(humanml3d.joints_of(vectors)) == len(vectors)
    generated = STEPS + np.random.default_rng(2).normal(0, 0.01, STEPS.shape)
    assert len(humanml3d.joints_of(generated)) == 30


# -- files


def test_read_motion_reads_vectors_and_joints(tmp_path, capsys):
    for name, array, what in (
        ("000021.npy", STEPS.astype(np.float32), "HumanML3D, 263 numbers a frame"),
        ("M000021.npy", humanml3d.joints_of(STEPS).astype(np.float32), "HumanML3D, 22 joints"),
    ):
        np.save(tmp_path / name, array)
        motion = md.read_motion(tmp_path / name)
        assert motion.fps == 20 and len(motion) == 30 and motion.root is None
        np.testing.assert_allclose(
            np.delete(motion.positions, [16, 20], 1),
            np.delete(WALKED[:30] - WALKED[0, 0] * [1, 0, 1], [16, 20], 1),
            atol=1e-6,
        )
        assert main(["info", str(tmp_path / name)]) in (0, None)
        said = capsys.readouterr().out
        assert f"{name[:-4]} ({what})" in said and "21 joints" in said
        again = motion.save(tmp_path / f"{name}-again.npz")
        np.testing.assert_array_equal(md.read_motion(again).positions, motion.positions)


def test_the_course_s_bones_can_be_put_on(tmp_path):
    np.save(tmp_path / "circle.npy", vectors_of_circle(40, 0.02))
    motion = md.read_motion(tmp_path / "circle.npy")
    world, _ = onto_our_bones(motion.positions, 0.0, motion.fps)
    bones = np.linalg.norm(np.diff(world[:, np.array(BONES)], axis=2)[:, :, 0], axis=-1)
    np.testing.assert_allclose(bones, np.tile(BONE_LENGTHS, (40, 1)), rtol=1e-6)
    assert np.abs(world - motion.positions).max() < 0.25


def nan_in(vectors, frame):
    vectors = vectors.copy()
    vectors[frame:, 100] = np.nan
    return vectors


OTHER_ARRAYS = {
    "kit.npy": (np.zeros((7, 251)), r"shape \(7, 251\).*KIT-ML"),
    "kit_joints.npy": (np.zeros((7, 21, 3)), r"21 joints .*positions=x, fps=20"),
    "several.npy": (np.zeros((2, 22, 3, 7)), r"several motions; .*numpy.save\(.one.npy., x\[0\]\)"),
    "coco.npy": (np.zeros((7, 17, 3)), "17 joints are COCO"),
    "features.npy": (np.zeros((7, 34)), "34 normalised features"),
    "Mean.npy": (np.zeros(263), "statistics such as Mean.npy"),
    "batch.npy": (np.zeros((2, 7, 263)), "several motions"),
    "sampled.npy": (np.zeros((2, 263, 1, 7)), "several motions"),
    "odd.npy": (np.zeros((7, 5)), r"shape \(7, 5\).*none of the arrays"),
    "scalar.npy": (np.array(1.0), r"shape \(\)"),
    "empty.npy": (np.zeros((0, 263)), r"shape \(0, 263\).*at least one frame"),
    "bare.npy": (np.zeros((0, 22, 3)), r"shape \(0, 22, 3\).*at least one frame"),
    "whole.npy": (np.zeros((7, 263), int), "contains int64"),
    "whole_joints.npy": (np.zeros((7, 22, 3), int), "contains int64"),
    "zeros.npy": (np.zeros((7, 263)), "probably standardised"),
    "007975.npy": (nan_in(STEPS, 27), "3 of 30 frames contain NaN.*first frame 27"),
}


@pytest.mark.parametrize("name", OTHER_ARRAYS)
def test_other_arrays_are_refused_with_what_they_are(tmp_path, name):
    array, told = OTHER_ARRAYS[name]
    np.save(tmp_path / name, array)
    with pytest.raises(MotionError, match=f"{name}.*{told}"):
        md.read_motion(tmp_path / name)


def test_other_files_are_refused(tmp_path):
    np.save(tmp_path / "objects.npy", np.array([{}], object))
    np.save(tmp_path / "cut.npy", STEPS)
    whole = (tmp_path / "cut.npy").read_bytes()
    (tmp_path / "cut.npy").write_bytes(whole[:5000])
    (tmp_path / "head.npy").write_bytes(whole[:20])
    (tmp_path / "page.npy").write_bytes(b"<html>404</html>")
    (tmp_path / "void.npy").write_bytes(b"")
    with (tmp_path / "many.npy").open("wb") as file:  # a header alone
        header = {"descr": "<f4", "fortran_order": False, "shape": (22, 3, 10**9)}
        np.lib.format.write_array_header_1_0(file, header)
    for name, told in (
        ("objects.npy", r"Python objects.*If you trust it.*allow_pickle=True\)\.item\(\)"),
        ("cut.npy", "damaged or cut off"),
        ("head.npy", "damaged or cut off"),
        ("many.npy", r"\(22, 3, 1000000000\) has 1,000,000,000 frames, and 432,000 at most"),
        ("page.npy", "is no .npy file"),
        ("void.npy", "is no .npy file"),
    ):
        with pytest.raises(MotionError, match=f"{name}.*{told}"):
            md.read_motion(tmp_path / name)
    with pytest.raises(FileNotFoundError, match="none.npy"):
        md.read_motion(tmp_path / "none.npy")


def test_joints_in_centimetres_and_joints_with_gaps(tmp_path):
    joints = humanml3d.joints_of(STEPS)
    np.save(tmp_path / "cm.npy", 100 * joints)
    with pytest.warns(MotionWarning, match="cm.npy: the positions are in centimetres"):
        read = md.read_motion(tmp_path / "cm.npy")
    np.testing.assert_allclose(read.positions, humanml3d.to_course(joints), atol=1e-9)
    joints[4, 3] = np.nan
    np.save(tmp_path / "gap.npy", joints)
    with pytest.raises(MotionError, match="gap.npy: 1 of 30 frames contain NaN"):
        md.read_motion(tmp_path / "gap.npy")


# -- captions and the folder

TEXT = (
    "a man walks # slowly.#a/DET man/NOUN walk/VERB slowly/ADV#0.0#0.0\n"
    "\n"
    "he turns left/right.#he/PRON turn/VERB left/right/ADV#0.5#1.25\n"
    "he stops.#he/PRON stop/VERB#nan#nan\n"
    "he steps#step/VERB#0.5#1.25\n"
)


def test_captions_are_read(tmp_path):
    (tmp_path / "000021.txt").write_text(TEXT, encoding="utf-8")
    walks, turns, stops, steps = humanml3d_folder.read_captions(tmp_path / "000021.txt")
    assert walks.text == "a man walks # slowly." and walks.span is None
    assert walks.tokens == (("a", "DET"), ("man", "NOUN"), ("walk", "VERB"), ("slowly", "ADV"))
    assert turns.tokens[-1] == ("left/right", "ADV") and turns.span == steps.span == (0.5, 1.25)
    assert stops.span is None


@pytest.mark.parametrize(
    "line, told",
    [
        ("a man walks", "not of the form caption#tokens#start#end"),
        ("a man walks#man/NOUN#0.0", "not of the form"),
        (" #man/NOUN#0.0#0.0", "the caption is empty"),
        ("he runs#he#0.0#0.0", "the token 'he' is not of the form word/TAG"),
        ("he runs#he/PRON#one#2.0", "must be seconds, not 'one' and '2.0'"),
        ("he runs#he/PRON#2.0#1.5", "not 2 to 1.5"),
        ("he runs#he/PRON#-1.0#1.5", "not -1 to 1.5"),
        ("he runs#he/PRON#0.0#inf", "not 0 to inf"),
    ],
)
def test_a_faulty_line_is_named(tmp_path, line, told):
    (tmp_path / "000021.txt").write_text(f"he walks#walk/VERB#0.0#0.0\n\n{line}\n", "utf-8")
    with pytest.raises(MotionError, match=f"000021.txt, line 3: .*{told}"):
        humanml3d_folder.read_captions(tmp_path / "000021.txt")


def test_a_text_without_captions_or_in_another_encoding_is_refused(tmp_path):
    (tmp_path / "000021.txt").write_text("\n")
    with pytest.raises(MotionError, match="000021.txt contains no caption"):
        humanml3d_folder.read_captions(tmp_path / "000021.txt")
    (tmp_path / "000021.txt").write_bytes("caf\xe9#".encode("latin1"))
    with pytest.raises(MotionError, match="000021.txt cannot be read as text in UTF-8"):
        humanml3d_folder.read_captions(tmp_path / "000021.txt")


@pytest.fixture
def folder(tmp_path):
    """Two clips with their mirror images, one in new_joints alone, and a list of names."""
    for name in ("new_joint_vecs", "new_joints", "texts"):
        (tmp_path / name).mkdir()
    mirrored = walk(31, turn=0.7)[0] * [-1, 1, 1]
    swap = [JOINTS.index(n.replace("Left", "X").replace("Right", "Left").replace("X", "Right"))
            for n in JOINTS]  # fmt: skip
    mirrored = as_vectors(humanml3d.from_course(mirrored[:, swap]), -0.7 * np.arange(31) / 20)
    np.save(tmp_path / "new_joint_vecs" / "000021.npy", STEPS)
    np.save(tmp_path / "new_joint_vecs" / "M000021.npy", mirrored)
    np.save(tmp_path / "new_joints" / "000007.npy", np.tile(STANDING, (9, 1, 1)))
    for name in ("000021", "M000021"):
        (tmp_path / "texts" / f"{name}.txt").write_text(TEXT)
    (tmp_path / "texts" / "000007.txt").write_text("a man stands#man/NOUN stand/VERB#0.0#0.0")
    (tmp_path / "train.txt").write_text("000021\nM000021\n\n000007\n")
    return tmp_path


def test_clips_come_with_their_captions_and_spans(folder):
    read = list(humanml3d_folder.read_clips(folder, "train"))
    assert [name for name, _, _ in read] == ["000021", "000021", "M000021", "M000021", "000007"]
    (_, whole, about_all), (_, part, about_part), *_ = read
    assert [c.text for c in about_all] == ["a man walks # slowly.", "he stops."]
    assert [c.text for c in about_part] == ["he turns left/right.", "he steps"]
    assert len(whole) == 30 and len(part) == 15 and whole.fps == part.fps == 20
    np.testing.assert_array_equal(part.positions, whole.positions[10:25])
    assert whole.source == "000021" and len(read[4].motion) == 9


def test_a_mirrored_clip_is_the_mirror_image(folder):
    read = list(humanml3d_folder.read_clips(folder, "train"))
    plain, mirrored = read[0].motion.positions, read[2].motion.positions
    left, right = (joint_index(s + "Foot") for s in ("Left", "Right"))
    np.testing.assert_allclose(mirrored[:, left], plain[:, right] * [-1, 1, 1], atol=1e-9)
    names = [c.name for c in humanml3d_folder.read_clips(folder, "train", mirrored=False)]
    assert names == ["000021", "000021", "000007"]


def test_without_a_list_every_file_is_read_in_order(folder):
    names = [name for name, _, _ in humanml3d_folder.read_clips(folder)]
    assert names == ["000007", "000021", "000021", "M000021", "M000021"]


def test_missing_files_are_counted_and_faulty_ones_named(folder):
    with open(folder / "train.txt", "a") as names:
        names.write("000100\n000101\n000102\n000103\n000200\n000201\n000202\n")
    np.save(folder / "new_joint_vecs" / "000200.npy", STEPS)
    for name, vectors, text in (
        ("000201", nan_in(STEPS, 3), TEXT),
        ("000202", STEPS, "no caption"),
    ):
        np.save(folder / "new_joint_vecs" / f"{name}.npy", vectors)
        (folder / "texts" / f"{name}.txt").write_text(text)
    with pytest.warns(MotionWarning) as told:
        read = list(humanml3d_folder.read_clips(folder, "train"))
    assert len(read) == 5
    faulty, wrong, motionless, wordless = [str(one.message) for one in told]
    assert faulty.startswith("000201 is skipped: 000201.npy: 27 of 30 frames contain NaN")
    assert wrong.startswith("000202 is skipped: 000202.txt, line 1: ")
    assert motionless == (
        "4 of 10 clips have no motion file and were skipped: 000100, 000101, 000102 ..."
    )
    assert wordless == "1 of 10 clips have no text file and were skipped: 000200"


def test_a_span_after_the_end_is_skipped_and_a_long_one_cut(folder):
    lines = "he waits#wait/VERB#1.0#9.0\nhe leaves#leave/VERB#1.5#2.0\n"
    (folder / "texts" / "000021.txt").write_text(lines)
    (folder / "train.txt").write_text("000021\n")
    with pytest.warns(
        MotionWarning, match="000021.txt: no frame lies between 1.5 and 2 s .*1.50 s"
    ):
        (read,) = humanml3d_folder.read_clips(folder, "train")
    assert len(read.motion) == 10 and read.captions[0].text == "he waits"


def test_fractions_of_a_frame_are_dropped():
    assert humanml3d_folder.frames_of((1.07, 3.24), 100) == (21, 64)
    assert humanml3d_folder.frames_of((0.15, 4.35), 100) == (3, 87)  # 0.15 * 20 = 3 in decimals


def test_another_folder_is_refused_before_the_first_clip(folder, tmp_path_factory):
    with pytest.raises(FileNotFoundError, match="there is no file .*nowhere"):
        humanml3d_folder.read_clips(folder / "nowhere")
    with pytest.raises(FileNotFoundError, match="test.txt"):
        humanml3d_folder.read_clips(folder, "test")
    other = tmp_path_factory.mktemp("other")
    with pytest.raises(MotionError, match="needs a folder new_joint_vecs or new_joints, and a"):
        humanml3d_folder.read_clips(other)
    (folder / "train.txt").write_text("000021\n000021.npy 3\n")
    with pytest.raises(MotionError, match="train.txt, line 2: '000021.npy 3' is no name"):
        humanml3d_folder.read_clips(folder, "train")
