"""Any humanoid BVH as a clip of the course: dialects, units, axes, feet; and real files."""

import warnings

import numpy as np
import pytest
from foreign_walk import foreign, seen_in_a_mirror, sound

from motiondiff_edu.motion.clip import Clip
from motiondiff_edu.motion.formats.bvh import BvhError, read_bvh
from motiondiff_edu.motion.formats.dialects import check_mapping, guess_mapping, plain, spellings
from motiondiff_edu.motion.motion import MotionWarning
from motiondiff_edu.motion.retarget import load_clip, retarget
from motiondiff_edu.motion.root_frame import forward_left
from motiondiff_edu.motion.skeleton import JOINTS, TOES

SMPL = dict(
    zip(
        JOINTS,
        "Pelvis L_Hip L_Knee L_Ankle L_Foot R_Hip R_Knee R_Ankle R_Foot Spine1 Spine2 Neck Head "
        "L_Shoulder L_Elbow L_Wrist L_Hand R_Shoulder R_Elbow R_Wrist R_Hand".split(),
        strict=True,
    )
)
SMPL |= {"LeftShoulder": "L_Collar", "RightShoulder": "R_Collar"}
HUMANOIDS = (
    "animdraw_cmu1_jumping_jacks animdraw_fair1_dab bvhpython_test_freebvh "
    "bvhpython_test_mocapbank bvhtoolbox_walk01 cmu_02_01_walk cmu_05_06_dance "
    "cmu_12_01_walk_pybvh cmu_acrnn_salsa_10 cmu_max_131_01 pybvh_bvh_test1 "
    "pymo_AV_8Walk_Meredith_HVHA_Rep1"
).split()


def cruise(clip: Clip) -> float:
    """Mean speed of the root without the first and last second, m/s."""
    return float(np.hypot(*clip.control[20:-20, :2].T).mean())


def test_another_body_walks_at_its_own_pace(tmp_path):
    clip = load_clip(foreign(tmp_path / "walk.bvh", speed=1.3))
    sound(clip)
    assert len(clip) == 61 and clip.info["dropped_frames"] == 0 and clip.info["up"] == "+y"
    legs = 0.41 * 1.15 + 0.425 * 0.8  # m, of the other body
    assert clip.info["unit_m"] == pytest.approx(0.0254 * 0.835 / legs, rel=1e-3)
    assert clip.control[:, 0].mean() == pytest.approx(1.3 * 0.835 / legs, rel=0.02)
    assert np.abs(clip.control[:, 1:]).max() < 0.08


@pytest.mark.parametrize(
    "options", [{"unit": 0.01}, {"unit": 1.0}, {"z_up": True}, {"t_pose": True}, {"names": SMPL}]
)
def test_units_axes_names_and_t_pose_make_no_difference(tmp_path, options):
    plain_clip = load_clip(foreign(tmp_path / "a.bvh", turn=0.3))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MotionWarning)
        clip = load_clip(foreign(tmp_path / "b.bvh", turn=0.3, **options))
    assert clip.poses.shape == plain_clip.poses.shape
    assert np.abs(clip.poses - plain_clip.poses).max() < 2e-3
    assert np.abs(clip.control - plain_clip.control).max() < 5e-3
    assert clip.info["up"] == ("+z" if "z_up" in options else "+y")
    assert clip.info["dropped_frames"] == int("t_pose" in options)


def test_a_turn_to_the_left_is_positive_yaw(tmp_path):
    clip = load_clip(foreign(tmp_path / "walk.bvh", turn=0.5))
    assert clip.control[10:-10, 2].mean() == pytest.approx(0.5, abs=0.03)
    ahead, _ = forward_left(np.zeros(len(clip)))
    feet = clip.poses[:, 4, [0, 2]] - clip.poses[:, 3, [0, 2]]
    assert (feet * ahead).sum(-1).mean() > 0.05  # toes point where the figure heads


def test_left_and_right_exchanged_make_no_difference(tmp_path):
    bvh = read_bvh(foreign(tmp_path / "walk.bvh", turn=0.3))
    bvh.offsets[bvh.names.index("Neck1"), 2] -= 0.05 / 0.0254  # shoulders that lie behind the hips
    usual = retarget(bvh)
    with pytest.warns(MotionWarning, match="left and right were exchanged"):
        clip = retarget(seen_in_a_mirror(bvh))
    assert np.degrees(usual.info["rest_lean"]) > 4
    assert clip.info["rest_lean"] == pytest.approx(usual.info["rest_lean"])
    np.testing.assert_allclose(clip.poses, usual.poses, atol=1e-9)
    np.testing.assert_allclose(clip.control, usual.control, atol=1e-9)


def test_a_dropped_t_pose_is_told(tmp_path):
    with pytest.warns(MotionWarning, match="calibration pose"):
        clip = load_clip(foreign(tmp_path / "walk.bvh", t_pose=True))
    assert "calibration" in clip.info["notes"][0]


def test_unknown_names_are_shown_and_can_be_given(tmp_path):
    strange = {name: f"joint_{i:02d}" for i, name in enumerate(JOINTS)}
    path = foreign(tmp_path / "walk.bvh", names=strange)
    with pytest.raises(BvhError, match="joint_07.*mapping="):
        load_clip(path)
    mapped = load_clip(path, mapping=strange)
    usual = load_clip(foreign(tmp_path / "usual.bvh"))
    assert np.abs(mapped.poses - usual.poses).max() < 1e-6


def test_a_wrong_mapping_is_refused(tmp_path):
    bvh = read_bvh(foreign(tmp_path / "walk.bvh"))
    with pytest.raises(BvhError, match="no joint of the course"):
        check_mapping({"Tail": "Hips"}, bvh)
    with pytest.raises(BvhError, match="'Knee'.*the file has"):
        check_mapping({"LeftLeg": "Knee"}, bvh)
    with pytest.raises(BvhError, match="no joint found for LeftHand"):
        check_mapping({"LeftHandIndex1": "LeftHand"}, bvh)  # one joint cannot be two
    moved = check_mapping({"Spine1": "Spine"}, bvh)
    assert (moved["Spine1"], moved["Spine"], moved["Head"]) == ("Spine", "LowerBack", "Head")


def test_a_short_file_is_refused(tmp_path):
    with pytest.raises(BvhError, match="0.5 s"):
        load_clip(foreign(tmp_path / "walk.bvh", frames=31))


def test_names_are_compared_bare():
    assert plain("mixamorig:Left_Up Leg") == "leftupleg" and plain("Bip01 L Thigh") == "lthigh"
    assert "kneel" in spellings("LeftLeg") and "rightshldr" in spellings("RightArm")


# ---- real files


@pytest.mark.filterwarnings("ignore::motiondiff_edu.motion.normalise.MotionWarning")
@pytest.mark.parametrize("name", HUMANOIDS)
def test_real_figures_stand_on_our_bones(real_data, name):
    clip = load_clip(real_data / "bvh" / f"{name}.bvh")
    world = sound(clip)
    assert set(guess_mapping(read_bvh(real_data / "bvh" / f"{name}.bvh"))) >= {
        "LeftToeBase",
        "RightToeBase",
    }
    assert clip.source == name and clip.contacts.shape == (len(clip), 2)
    assert 0.6 < np.median(world[:, 0, 1]) < 1.0  # hips
    assert np.median(world[:, 12, 1]) > np.median(world[:, 0, 1]) + 0.2  # the head is above


@pytest.mark.filterwarnings("ignore::motiondiff_edu.motion.normalise.MotionWarning")
@pytest.mark.parametrize(
    ("name", "speed"),
    [("cmu_02_01_walk", 1.27), ("cmu_12_01_walk_pybvh", 0.96), ("bvhtoolbox_walk01", 1.33)],
)
def test_real_walks(real_data, name, speed):
    clip = load_clip(real_data / "bvh" / f"{name}.bvh")
    world = clip.world()
    assert cruise(clip) == pytest.approx(speed, rel=0.03)
    thigh = world[:, [2, 6]] - world[:, [1, 5]]
    shank = world[:, [3, 7]] - world[:, [2, 6]]
    left = (world[:, 1] - world[:, 5])[:, None]
    bend = np.degrees(
        np.arctan2(
            (np.cross(thigh, shank) * left).sum(-1) / np.linalg.norm(left, axis=-1),
            (thigh * shank).sum(-1),
        )
    )
    assert bend.min() > -5 and 55 < bend.max() < 85
    lift = world[:, list(TOES), 1].max(0)
    assert (0.05 < lift).all() and (lift < 0.25).all()
    trunk = world[:, 11] - world[:, 0]
    ahead = np.cross(left[:, 0], [0, 1, 0])
    lean = np.degrees(
        np.arctan2((trunk * ahead).sum(-1) / np.linalg.norm(ahead, axis=-1), trunk[:, 1])
    )
    assert -8 < lean.mean() < 12
    assert 0.35 < clip.contacts.mean() < 0.75


def test_the_fast_walk_is_fast(real_data):
    place = load_clip(real_data / "bvh/pymo_AV_8Walk_Meredith_HVHA_Rep1.bvh").control[:, 0]
    assert np.percentile(place, 90) == pytest.approx(2.0, abs=0.08)


def test_t_pose_of_cgspeed_files_is_dropped_and_glitches_are_told(real_data):
    with pytest.warns(MotionWarning, match="calibration pose"):
        assert load_clip(real_data / "bvh/cmu_12_01_walk_pybvh.bvh").info["dropped_frames"] == 1
    with pytest.warns(MotionWarning, match="faster than"):
        load_clip(real_data / "bvh/cmu_acrnn_salsa_10.bvh")
    with warnings.catch_warnings():
        warnings.simplefilter("error", MotionWarning)
        assert load_clip(real_data / "bvh/cmu_02_01_walk.bvh").info["dropped_frames"] == 0


def test_what_is_no_figure_is_refused_with_its_joints(real_data):
    with pytest.raises(BvhError, match="base, child1, child2, child3"):
        load_clip(real_data / "bvh/fairmotion_sinusoidal.bvh")
    with pytest.raises(BvhError, match="2 frames"):
        retarget(read_bvh(real_data / "bvh/bvhio_example.bvh"))
