"""Files as people have described them in public: each is read right, or refused in our words.

The files of `reports` are read where they lie; each case has its opposite, made here.
"""

import shutil
import warnings
from pathlib import Path

import numpy as np
import pytest
from foreign_walk import foreign

import motiondiff_edu as md
from data_synth.walking import walk
from motiondiff_edu.motion.formats import humanml3d
from motiondiff_edu.motion.motion import MotionError, MotionWarning

HEAD, TOES = 12, [4, 8]


@pytest.fixture
def reports(real_data) -> Path:
    return real_data / "reports"


@pytest.fixture(scope="module")
def walked() -> np.ndarray:
    return walk(np.tile([1.1, 0.0, 0.2], (80, 1)), seed=3).world()


def read(path: Path, **options) -> tuple[md.Motion, str]:
    """The motion, and what was said."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        made = md.read_motion(path, **options)
    assert tuple(str(one.message).split(": ", 1)[1] for one in said) == made.notes
    return made, " ".join(made.notes)


def stands(motion: md.Motion) -> float:
    """How far the head is above the toes."""
    return float(np.median(motion.positions[:, HEAD, 1] - motion.positions[:, TOES, 1].mean(1)))


def path_of(motion: md.Motion) -> float:
    steps = np.diff(motion.positions[:, 0][:, [0, 2]], axis=0)
    return float(np.linalg.norm(steps, axis=-1).sum())


# -- which way is up -----------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["01_lying_on_back", "02_face_down"])
def test_who_lies_lies(reports, name):
    made, said = read(reports / f"{name}.bvh")
    assert abs(stands(made)) < 0.3 and made.positions[..., 1].min() > -0.25
    assert "the rest pose says that +y is up, but the figure says" in said
    other = said.split("pass up=")[1][1:3]
    assert stands(read(reports / f"{name}.bvh", up=other)[0]) > 1.3


def test_a_handstand_stands_on_the_hands(reports):
    made, said = read(reports / "03_handstand.bvh")
    assert stands(made) < -1.3 and made.positions[..., 1].min() > -0.05
    assert "the rest pose and the floor at 0 say that +y is up, but the figure says -y" in said
    assert stands(read(reports / "03_handstand.bvh", up="-y")[0]) > 1.3


def test_a_walk_in_a_file_that_is_upside_down_is_upright(tmp_path, walked):
    """Its rest pose is upright: the feet know better."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        usual = md.read_motion(foreign(tmp_path / "walk.bvh", turn=0.3))
    np.savez(tmp_path / "over.npz", positions=walked * [1, -1, -1], fps=20)
    made, said = read(tmp_path / "over.npz")
    assert stands(made) > 1.3 and said.startswith("-y up: ") and "the figure was turned" in said
    assert stands(usual) > 1.3 and usual.notes == ()


@pytest.mark.parametrize("name, up", [("10_joints_z_up", "z"), ("11_joints_upside_down", "-y")])
def test_joints_in_other_axes_are_turned_and_it_is_said(reports, name, up):
    made, said = read(reports / f"{name}.npy")
    usual, _ = read(reports / "14_mdm_22_3_T.npy")
    assert said.startswith(f"{up} up: the figure, ") and made.about.startswith(f"{up} up")
    np.testing.assert_allclose(made.positions[..., 1], usual.positions[..., 1], atol=1e-6)
    assert path_of(made) == pytest.approx(path_of(usual), rel=1e-6)


def test_an_axis_that_is_none_and_a_unit_that_is_none_are_refused(tmp_path, walked):
    np.savez(tmp_path / "a.npz", positions=walked, fps=20)
    with pytest.raises(MotionError, match="up is an axis such as 'z' or '-y'"):
        md.read_motion(tmp_path / "a.npz", up="sky")
    with pytest.raises(MotionError, match="no unit is called 'ells'; there are m,"):
        md.read_motion(tmp_path / "a.npz", unit="ells")
    with pytest.raises(MotionError, match="`unit` is for .npz and .npy"):
        md.read_motion(foreign(tmp_path / "walk.bvh"), unit="cm")
    turned, _ = read(tmp_path / "a.npz", up="z")  # the user knows
    assert abs(stands(turned)) < 0.5 and turned.about.startswith("z up: as given")


# -- a person, whole, on the floor ---------------------------------------------------------------


def test_a_dog_with_the_names_of_a_human_is_doubted(reports):
    _, said = read(reports / "05_dog_with_human_names.bvh")
    assert "trunk and legs are at a right angle in all frames" in said and "path" not in said


def test_a_path_in_another_unit_is_mended(reports):
    made, said = read(reports / "06_root_100x.bvh")
    base, _ = read(reports / "00_base.bvh")
    assert "two units: the path was multiplied by 0.01" in said
    np.testing.assert_allclose(made.positions, base.positions, atol=0.02)


@pytest.mark.parametrize("name", ["08_mediapipe_hip_centred.npz", "09_rotations_only.bvh"])
def test_a_file_without_a_path_is_read_and_it_is_said(reports, name):
    made, said = read(reports / name)
    assert stands(made) > 1.3 and "the file has no path of its own" in said
    assert read(reports / "00_base.bvh")[1] == ""


def test_centimetres_are_converted(reports):
    made, said = read(reports / "13_joints_cm.npy")
    assert said == "the positions are in centimetres; they are read in metres"
    usual, _ = read(reports / "14_mdm_22_3_T.npy")
    np.testing.assert_allclose(made.positions, usual.positions, atol=1e-6)


def test_a_t_pose_that_is_held_before_a_cut_is_left_out(reports):
    made, said = read(reports / "31_tpose_held_2s_then_cut.bvh")
    base, _ = read(reports / "00_base.bvh")
    assert said.startswith("frames 0 to 59 are a calibration pose") and len(made) == len(base)
    np.testing.assert_allclose(made.positions, base.positions, atol=1e-4)


# -- outputs of other programs -------------------------------------------------------------------


@pytest.mark.parametrize(
    "name",
    [
        "14_mdm_22_3_T.npy",
        "15_mdm_1_22_3_T.npy",
        "18_npz_22_without_names.npz",
        "20_kimodo.npz",
        "21_smplx_55.npy",
    ],
)
def test_positions_of_other_programs_are_read(reports, name):
    made, said = read(reports / name)
    assert said == "" and len(made) == 80 and made.fps == 20
    assert stands(made) == pytest.approx(1.5, abs=0.1) and path_of(made) == pytest.approx(
        4.74, abs=0.1
    )


def test_the_line_that_makes_results_of_mdm_readable_does(reports, tmp_path, monkeypatch):
    shutil.copy(reports / "16_mdm_results.npy", tmp_path / "results.npy")
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ValueError, match="which can run code") as refused:
        md.read_motion("results.npy")
    line = str(refused.value).split("take a motion out of it: ")[1]
    exec(line, {"numpy": np})
    assert stands(md.read_motion("one.npy")) == pytest.approx(1.5, abs=0.1)


def test_joint_angles_alone_are_refused_with_the_way_to_positions(reports):
    with pytest.raises(ValueError, match=r"joint angles .*smplx.*numpy.savez\('walk.npz'"):
        md.read_motion(reports / "19_amass.npz")
    with pytest.raises(ValueError, match="all joints of a frame are in one place"):
        md.read_motion(reports / "17_edge.pkl")  # its positions are zeros


def test_the_first_22_joints_of_every_smpl_are_read(tmp_path, walked):
    joints = humanml3d.from_course(walked)
    more = np.concatenate([joints, np.zeros((len(joints), 122, 3))], 1)
    for count in (22, 24, 52, 55, 127, 144):
        for shape in (more[:, :count], more[:, :count].transpose(1, 2, 0), more[None, :, :count]):
            found = humanml3d.first_22(shape)
            np.testing.assert_array_equal(found, joints)
    for other in (more[:, :23], more[:, :21], np.stack([joints, joints]), joints[0]):
        assert humanml3d.first_22(other) is None


# -- small things --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "name", ["32_EndSite_one_word", "33_ctrl_z", "35_zero_positions", "39_makehuman"]
)
def test_odd_files_are_the_same_walk(reports, name):
    made, said = read(reports / f"{name}.bvh")
    base, _ = read(reports / "00_base.bvh")
    assert said == "" and len(made) == len(base)
    # MakeHuman has no joint between the hips: they are the lower end of its spine
    far = 0.15 if name == "39_makehuman" else 0.02
    assert np.abs(made.positions - base.positions).max() < far


def test_two_people_in_one_file_are_told(reports):
    with pytest.raises(ValueError, match="2 figures: their joints begin with A_ and B_"):
        md.read_motion(reports / "34_two_people_one_root.bvh")


def test_names_of_another_language_are_listed(reports):
    with pytest.raises(ValueError, match="no joint found for Hips.*センター.*mapping="):
        md.read_motion(reports / "40_mmd_japanese.bvh")


def test_an_address_is_told_to_be_one():
    for address in ("https://example.org/walk.bvh", Path("https://example.org/walk.bvh")):
        with pytest.raises(
            OSError, match="^https://example.org/walk.bvh is an address: download the file first"
        ):
            md.read_motion(address)


def test_what_is_right_is_read_without_a_word(tmp_path, walked):
    np.savez(tmp_path / "walk.npz", positions=walked, fps=20)
    with warnings.catch_warnings():
        warnings.simplefilter("error", MotionWarning)
        made = md.read_motion(tmp_path / "walk.npz")
    assert made.notes == () and made.about.startswith("y up: the format, the figure, the feet")
    assert "; m; feet on the floor in" in made.about
    share = float(made.about.split("feet on the floor in ")[1].split("%")[0])
    assert share > 80
