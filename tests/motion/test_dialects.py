"""Joints by their names in the dialects of many programs, and by how they hang together."""

from dataclasses import replace

import numpy as np
import pytest
from foreign_walk import foreign, without

from motiondiff_edu.motion.formats.bvh import BvhError, read_bvh
from motiondiff_edu.motion.formats.dialects import (
    check_mapping,
    common_prefix,
    guess_mapping,
    without_shared,
)
from motiondiff_edu.motion.retarget import load_clip, retarget
from motiondiff_edu.motion.skeleton import JOINTS

CENTRAL = ("Hips", "Spine", "Spine1", "Neck1", "Head")
SIDE = ("UpLeg", "Leg", "Foot", "ToeBase", "Arm", "ForeArm", "Hand", "HandIndex1")


def names(central: str, sided: str, left: str, right: str) -> dict[str, str]:
    """{joint of the course: name in a dialect}; `*` stands for the side in the sided names."""
    found = dict(zip(CENTRAL, central.split(), strict=True))
    for side, mark in (("Left", left), ("Right", right)):
        words = [word.replace("*", mark) for word in sided.split()]
        found |= {side + part: word for part, word in zip(SIDE, words, strict=True)}
        found[f"{side}Shoulder"] = f"{mark}_Collar"
    return {joint: name.replace("+", " ") for joint, name in found.items()}


DIALECTS = {
    "Character Creator": names(
        "CC_Base_Hip CC_Base_Spine01 CC_Base_Spine02 CC_Base_NeckTwist01 CC_Base_Head",
        "CC_Base_*_Thigh CC_Base_*_Calf CC_Base_*_Foot CC_Base_*_ToeBase CC_Base_*_Upperarm "
        "CC_Base_*_Forearm CC_Base_*_Hand CC_Base_*_Mid1",
        "L", "R",
    ),
    "CMU's ASF": names(
        "root lowerback thorax lowerneck head",
        "*femur *tibia *foot *toes *humerus *radius *wrist *fingers", "l", "r",
    ),
    "Mixamo": names(
        "mixamorig5:Hips mixamorig5:Spine mixamorig5:Spine1 mixamorig5:Neck mixamorig5:Head",
        "mixamorig5:*UpLeg mixamorig5:*Leg mixamorig5:*Foot mixamorig5:*ToeBase mixamorig5:*Arm "
        "mixamorig5:*ForeArm mixamorig5:*Hand mixamorig5:*HandIndex1",
        "Left", "Right",
    ),
    "Rokoko": names(
        "hips spine1 spine2 neck head",
        "*Thigh *Shin *Foot *Toe *Arm *ForeArm *Hand *Finger1", "left", "right",
    ),
    "Xsens": names(
        "Hips Chest Chest2 Neck Head",
        "*Hip *Knee *Ankle *Toe *Shoulder *Elbow *Wrist *Palm", "Left", "Right",
    ),
    "Xsens's segments": names(
        "Pelvis L3 T8 Neck Head",
        "*UpperLeg *LowerLeg *Foot *Toe *UpperArm *Forearm *Hand *Fingers", "Left", "Right",
    ),
    "OptiTrack": names(
        "Skeleton_001_Hip Skeleton_001_Ab Skeleton_001_Chest Skeleton_001_Neck Skeleton_001_Head",
        "Skeleton_001_*Thigh Skeleton_001_*Shin Skeleton_001_*Foot Skeleton_001_*Toe "
        "Skeleton_001_*UArm Skeleton_001_*FArm Skeleton_001_*Hand Skeleton_001_*Index1",
        "L", "R",
    ),
    "Unity": names(
        "Hips Spine UpperChest Neck Head",
        "*UpperLeg *LowerLeg *Foot *Toes *UpperArm *LowerArm *Hand *MiddleProximal",
        "Left", "Right",
    ),
    "VRM": names(
        "J_Bip_C_Hips J_Bip_C_Spine J_Bip_C_Chest J_Bip_C_Neck J_Bip_C_Head",
        "J_Bip_*_UpperLeg J_Bip_*_LowerLeg J_Bip_*_Foot J_Bip_*_ToeBase J_Bip_*_UpperArm "
        "J_Bip_*_LowerArm J_Bip_*_Hand J_Bip_*_Middle1",
        "L", "R",
    ),
    "SMPL": names(
        "pelvis spine1 spine2 neck head",
        "*_hip *_knee *_ankle *_foot *_shoulder *_elbow *_wrist *_hand", "left", "right",
    ),
    "Daz": names(
        "hip abdomenLower chestUpper neckLower head",
        "*ThighBend *Shin *Foot *Toe *ShldrBend *ForearmBend *Hand *Mid1", "l", "r",
    ),
    "Rigify": names(
        "spine.000 spine.001 spine.003 spine.004 spine.006",
        "thigh.* shin.* foot.* toe.* upper_arm.* forearm.* hand.* palm.*", "L", "R",
    ),
    "3ds Max": names(
        "Bip001+Pelvis Bip001+Spine Bip001+Spine1 Bip001+Neck Bip001+Head",
        "Bip001+*+Thigh Bip001+*+Calf Bip001+*+Foot Bip001+*+Toe0 Bip001+*+UpperArm "
        "Bip001+*+Forearm Bip001+*+Hand Bip001+*+Finger1",
        "L", "R",
    ),
    "Unreal": names(
        "pelvis spine_01 spine_02 neck_01 head",
        "thigh_* calf_* foot_* ball_* upperarm_* lowerarm_* hand_* middle_01_*", "l", "r",
    ),
    "names that end alike": names(
        "hips_JNT spine_JNT spine1_JNT neck_JNT head_JNT",
        "*_upLeg_JNT *_leg_JNT *_foot_JNT *_toe_JNT *_arm_JNT *_forearm_JNT *_hand_JNT *_mid1_JNT",
        "l", "r",
    ),
    "Kinect": names(
        "SPINE_BASE SPINE_MID SPINE_SHOULDER NECK HEAD",
        "HIP_* KNEE_* ANKLE_* FOOT_* SHOULDER_* ELBOW_* WRIST_* HAND_TIP_*", "LEFT", "RIGHT",
    ),
}  # fmt: skip
MADE_UP = {"Spine", "Spine1", "Neck1", "LeftHandIndex1", "RightHandIndex1"}  # may be computed


@pytest.mark.parametrize("dialect", DIALECTS)
def test_a_walk_in_this_dialect_is_the_same_walk(tmp_path, dialect):
    ours = DIALECTS[dialect]
    path = foreign(tmp_path / "walk.bvh", names=ours)
    found = guess_mapping(read_bvh(path))
    needed = {
        joint: name for joint, name in ours.items() if joint in JOINTS and joint not in MADE_UP
    }
    assert {joint: found.get(joint) for joint in needed} == needed
    clip, usual = load_clip(path), load_clip(foreign(tmp_path / "usual.bvh"))
    legs = [j for j, name in enumerate(JOINTS) if "Leg" in name or "Foot" in name or "Toe" in name]
    np.testing.assert_allclose(clip.poses[:, legs], usual.poses[:, legs], atol=1e-9)
    assert np.abs(clip.poses - usual.poses).max() < 0.06


def test_what_names_share_is_left_out_and_nothing_else():
    assert without_shared(["A_b_Hip", "A_b_L_Leg", "Scene", "A_b_C"]) == [
        "Hip",
        "L_Leg",
        "Scene",
        "C",
    ]
    assert without_shared(["hip_jnt", "l_leg_jnt", "scene"]) == ["hip", "l_leg", "scene"]
    plain = ["Hips", "LeftLeg", "LeftArm", "RightLeg", "RightArm", "L_Leg", "R_Leg", "Head"]
    assert without_shared(plain) == plain
    assert without_shared(["A_", "A_b", "A_c"]) == ["A_", "b", "c"]


def test_names_without_end_take_no_memory():
    """Of each name all beginnings are compared."""
    names = ["_" * 100_000 + end for end in "abc"]
    assert (
        len(common_prefix(names)) <= 200
        and common_prefix(["a_" * 3 + end for end in "xyz"]) == "a_a_a_"
    )


def test_hips_without_a_name_are_where_the_legs_meet(tmp_path):
    path = foreign(tmp_path / "walk.bvh", names={"Hips": "bone 7"})
    assert guess_mapping(read_bvh(path))["Hips"] == "bone 7"


def test_joints_that_do_not_hang_together_are_refused(tmp_path):
    bvh = read_bvh(foreign(tmp_path / "walk.bvh"))
    swapped = {"LeftUpLeg": "LeftLeg", "LeftLeg": "LeftUpLeg"}
    with pytest.raises(
        BvhError, match="LeftLeg .'LeftUpLeg'. does not hang on LeftUpLeg .'LeftLeg'"
    ):
        check_mapping(swapped, bvh)


def test_bones_of_one_limb_are_about_as_long(tmp_path):
    bvh = read_bvh(foreign(tmp_path / "walk.bvh"))
    offsets = bvh.offsets.copy()
    offsets[bvh.names.index("RightForeArm")] *= 3.5
    with pytest.raises(BvhError, match=r"RightArm .* to RightForeArm .* is 3.\d* times as long"):
        retarget(replace(bvh, offsets=offsets))
    offsets[bvh.names.index("RightForeArm")] /= 2
    assert len(retarget(replace(bvh, offsets=offsets))) == 61


def test_a_head_without_a_name_is_not_an_arm(tmp_path):
    bvh = read_bvh(foreign(tmp_path / "walk.bvh", names={"Head": "top"}))
    assert guess_mapping(bvh)["Head"] == "top"
    with pytest.raises(BvhError, match="no joint found for Head"):
        guess_mapping(without(bvh, {"top"}))


# ---- real files
@pytest.mark.filterwarnings("ignore::motiondiff_edu.motion.motion.MotionWarning")
def test_every_file_of_the_collection_is_read(real_data):
    files = sorted((real_data / "cmu30").glob("*.bvh"))
    assert len(files) == 51
    for path in files:
        mapping = guess_mapping(read_bvh(path))
        assert {"LeftToeBase", "RightToeBase", "LeftHandIndex1"} <= mapping.keys(), path
        assert not any("Twist" in name for joint, name in mapping.items() if joint != "Neck1")


@pytest.mark.filterwarnings("ignore::motiondiff_edu.motion.motion.MotionWarning")
def test_one_dance_in_two_conversions_is_one_dance(real_data):
    clips = [
        load_clip(real_data / name) for name in ("cmu30/cmu_005_06.bvh", "bvh/cmu_05_06_dance.bvh")
    ]
    one, two = (clip.poses[3:145] for clip in clips)
    apart = np.linalg.norm(one - two, axis=-1)
    later = np.linalg.norm(one[:-4] - two[4:], axis=-1)
    assert apart.mean() < 0.14 and later.mean() > 1.5 * apart.mean()
    moving = [np.diff(x - x.mean(0), axis=0) for x in (one, two)]
    assert np.corrcoef(moving[0].ravel(), moving[1].ravel())[0, 1] > 0.9
