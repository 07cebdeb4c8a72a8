"""Joints by their names: AIST++, COCO, OpenPose, MediaPipe and SMPL become the course's figure."""

import numpy as np
import pytest

import motiondiff_edu as md
from data_synth.dancing import dances
from data_synth.walking import walk
from motiondiff_edu.motion.formats.aist import COCO, read_keypoints
from motiondiff_edu.motion.formats.bvh.tokens import BvhError
from motiondiff_edu.motion.formats.keypoints import motion_of_keypoints, sources_of
from motiondiff_edu.motion.motion import Motion, MotionError
from motiondiff_edu.motion.resample import resample_present
from motiondiff_edu.motion.skeleton import JOINTS, joint_index

LIMBS = ("UpLeg", "Leg", "Foot", "Arm", "ForeArm", "Hand")
OURS = [side + limb for side in ("Left", "Right") for limb in LIMBS]
OPENPOSE = "Nose Neck RShoulder RElbow RWrist LShoulder LElbow LWrist MidHip RHip RKnee RAnkle LHip"
OPENPOSE += " LKnee LAnkle REye LEye REar LEar LBigToe LSmallToe LHeel RBigToe RSmallToe RHeel"
MEDIAPIPE = "nose left_ear right_ear left_shoulder right_shoulder left_elbow right_elbow left_wrist"
MEDIAPIPE += " right_wrist left_index right_index left_hip right_hip left_knee right_knee"
MEDIAPIPE += " left_ankle right_ankle left_heel right_heel left_foot_index right_foot_index"
SMPL = "Pelvis L_Hip R_Hip Spine1 L_Knee R_Knee Spine2 L_Ankle R_Ankle Spine3 L_Foot R_Foot Neck"
SMPL += (
    " L_Collar R_Collar Head L_Shoulder R_Shoulder L_Elbow R_Elbow L_Wrist R_Wrist L_Hand R_Hand"
)
PARTS = {"Shoulder": "Arm", "Elbow": "ForeArm", "Wrist": "Hand", "Hip": "UpLeg", "Knee": "Leg"}
PARTS |= {"Ankle": "Foot"}


def coco(positions: np.ndarray) -> np.ndarray:
    """COCO's joints of our figure; nose, eyes and ears about the head."""
    found = []
    for name in COCO:
        side = next((one for one in ("Left", "Right") if name.startswith(one)), "")
        part = PARTS.get(name.removeprefix(side), "")
        if part:
            found.append(positions[:, joint_index(side + part)])
        else:
            aside = {"Left": 0.07, "Right": -0.07, "": 0.0}[side]
            found.append(positions[:, joint_index("Head")] + [aside, 0.0, 0.0])
    return np.stack(found, 1)


def angles(positions: np.ndarray, of: dict[str, np.ndarray]) -> np.ndarray:
    """Degrees at knees and elbows."""
    found = []
    for side in ("Left", "Right"):
        for upper, middle, lower in (LIMBS[:3], LIMBS[3:]):
            a, b, c = (positions[:, of[side + part]] for part in (upper, middle, lower))
            one, other = a - b, c - b
            cosine = (one * other).sum(-1)
            cosine /= np.linalg.norm(one, axis=-1) * np.linalg.norm(other, axis=-1)
            found.append(np.degrees(np.arccos(np.clip(cosine, -1, 1))))
    return np.stack(found)


@pytest.mark.parametrize("unit, up", [(1.0, "y"), (100.0, "z")])
def test_a_walk_known_by_seventeen_keypoints_is_that_walk(unit, up):
    clip = walk(np.tile([1.1, 0.0, 0.3], (81, 1)), seed=3)
    truth = clip.world()
    points = coco(truth) * unit
    if up == "z":
        points = points[..., [2, 0, 1]]
    made = motion_of_keypoints(points, COCO, 20.0, "walk")
    assert isinstance(made, Motion) and made.fps == 20 and len(made) == len(truth)
    limbs = [joint_index(name) for name in OURS]
    apart = made.positions[:, limbs] - made.positions[:, :1]
    wanted = truth[:, limbs] - truth[:, :1]
    turn = made.to_clip().control[:, 2].mean() - clip.control[:, 2].mean()
    assert abs(turn) < 0.05
    if up == "y":  # with another axis up the world is turned about it
        error = np.linalg.norm(apart - wanted, axis=-1)
        assert error.mean() < 0.03 and error.max() < 0.12
    own = {name: joint_index(name) for name in OURS}
    apart = np.abs(angles(made.positions, own) - angles(truth, own))
    assert apart[::2].mean() < 12  # knees: feet without toes are planted anew
    assert apart[1::2].max() < 0.01  # elbows
    assert made.positions[..., 1].min() > -0.02


def test_names_of_openpose_mediapipe_and_smpl_are_known():
    for names in (OPENPOSE, MEDIAPIPE, SMPL):
        found = sources_of(names.split())
        for side, letter in (("Left", "l"), ("Right", "r")):
            for ours, theirs in (("UpLeg", "hip"), ("Arm", "shoulder"), ("Hand", "wrist")):
                (name,) = found[side + ours]
                assert name.lower().replace("_", "") in (letter + theirs, side.lower() + theirs)
    assert sources_of(OPENPOSE.split())["Hips"] == ("MidHip",)
    assert sources_of(OPENPOSE.split())["LeftToeBase"] == ("LBigToe",)
    assert sources_of(MEDIAPIPE.split())["RightToeBase"] == ("right_foot_index",)
    assert sources_of(MEDIAPIPE.split())["Head"] == ("left_ear", "right_ear")
    assert sources_of(MEDIAPIPE.split())["Hips"] == ("left_hip", "right_hip")
    assert sources_of(SMPL.split())["LeftFoot"] == ("L_Ankle",)
    assert sources_of(SMPL.split())["LeftToeBase"] == ("L_Foot",)


def test_npz_with_names_is_retargeted_and_our_own_is_read_as_it_is(tmp_path):
    truth = walk(np.tile([1.1, 0.0, 0.0], (61, 1)), seed=3).world()
    np.savez(tmp_path / "keys.npz", positions=coco(truth), names=COCO, fps=20.0)
    made = md.read_motion(tmp_path / "keys.npz")
    assert made.skeleton.names == JOINTS and made.source == "keys"
    made.save(tmp_path / "ours.npz")
    again = md.read_motion(tmp_path / "ours.npz")
    np.testing.assert_array_equal(again.positions, made.positions)


@pytest.mark.parametrize(
    "change, told",
    [
        (lambda p, n: (p, [*n[:-1], n[0]]), "'Nose' stands twice"),
        (lambda p, n: (p[:, :-1], n), r"must be \(frames, 17, 3\)"),
        (lambda p, n: (p, [*n[:-1], "Tail"]), "no joint found for RightFoot. The names are: Nose"),
        (
            lambda p, n: (np.where(np.arange(17)[:, None] == 9, np.nan, p), n),
            "LeftWrist is missing",
        ),
        (
            lambda p, n: (np.where((np.arange(len(p)) // 5 == 2)[:, None, None], 0.0, p), n),
            r"in one place in 5 of 41 frames, first in frame 10, as where .* writes zeros",
        ),
        (lambda p, n: (p * np.where(np.arange(17)[:, None] == 13, 9.0, 1.0), n), "no figure"),
    ],
)
def test_what_is_wrong_with_named_joints_is_said(change, told):
    points = coco(walk(np.tile([1.1, 0.0, 0.0], (41, 1)), seed=3).world())
    with pytest.raises(MotionError, match=told):
        motion_of_keypoints(*change(points, list(COCO)), 20.0, "file")


def test_of_a_figure_that_lies_the_file_must_say_what_is_up():
    points = coco(walk(np.tile([1.1, 0.0, 0.0], (41, 1)), seed=3).world())
    points = points[..., [0, 2, 1]] * [1.0, 1.0, -1.0]  # it lies on its back: up is y all the same
    guessed, told = (motion_of_keypoints(points, COCO, 20.0, up=up) for up in ("", "+y"))
    assert guessed.positions[0, joint_index("Head"), 1] > 1.3
    assert told.positions[0, joint_index("Head"), 1] < 0.5


def test_half_a_second_is_needed():
    points = coco(walk(np.tile([1.1, 0.0, 0.0], (41, 1)), seed=3).world())
    with pytest.raises(BvhError, match="at least 0.5 s .* correct the `fps` of the file"):
        motion_of_keypoints(points[:5], COCO, 20.0, "file")
    with pytest.raises(BvhError, match="1 frame at 1 frames/s .* two frames"):
        motion_of_keypoints(points[:1], COCO, 1.0, "file")


def test_a_dance_of_aist_keeps_its_knees_and_elbows(real_data):
    for path in sorted((real_data / "aist" / "keypoints3d").glob("*.pkl")):
        there = read_keypoints(path)
        made = md.read_motion(path)
        source = resample_present(there.positions, there.fps, made.fps)[: len(made)]
        theirs = {
            side + ours: COCO.index(side + part)
            for side in ("Left", "Right")
            for part, ours in PARTS.items()
        }
        own = {name: joint_index(name) for name in OURS}
        apart = np.abs(angles(made.positions[: len(source)], own) - angles(source, theirs))
        assert np.median(apart) < 1 and np.percentile(apart, 95) < 15, path.name
        assert made.positions[..., 1].min() > -0.06
        hips = source[:, [theirs["LeftUpLeg"], theirs["RightUpLeg"]]].mean(1)
        way, own_way = (np.ptp(one[:, [0, 2]], axis=0) for one in (hips, made.positions[:, 0]))
        assert np.abs(way / own_way - 1).max() < 0.25
        made.check_whole()


def test_a_synthetic_dance_survives_its_keypoints():
    own = {name: joint_index(name) for name in OURS}
    for _, made in dances(3, 7, 6.0):
        again = motion_of_keypoints(coco(made.positions), COCO, made.fps, made.genre)
        apart = np.abs(angles(again.positions, own) - angles(made.positions, own))
        assert np.median(apart) < 0.1
        assert np.linalg.norm(again.positions - made.positions, axis=-1).mean() < 0.06
