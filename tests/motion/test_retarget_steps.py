"""The steps of retargeting one by one: axes, floor, T-pose, contacts, planted feet."""

import numpy as np
import pytest
from synthetic_walk import walk

from data_synth.walking import walk as walked
from motiondiff_edu.motion.cleanup import runs
from motiondiff_edu.motion.directions import rest_lean
from motiondiff_edu.motion.normalise import (
    MotionWarning,
    floor_plane,
    level,
    unit_of_path,
    unmirror,
    whole_take,
)
from motiondiff_edu.motion.planting import find_contacts, plant, shift_to_pins, solve_leg
from motiondiff_edu.motion.retarget import warn_sunk
from motiondiff_edu.motion.skeleton import BONE_LENGTHS, HEELS, OFFSETS, PARENTS, TOES, joint_index
from motiondiff_edu.motion.upright import rotate_y_up


def test_turning_up_keeps_handedness():
    axes = np.eye(3)
    for up in ("+x", "-x", "+y", "-y", "+z", "-z"):
        turned = rotate_y_up(axes, up)
        sign = -1 if up[0] == "-" else 1
        assert np.linalg.det(turned) == pytest.approx(1) and turned["xyz".index(up[1]), 1] == sign


def test_a_mirrored_figure_is_told_by_its_feet():
    world, _ = walk(frames=30)
    assert not unmirror(world)[1]
    back, mirrored = unmirror(world * [-1, 1, 1])
    assert mirrored and np.allclose(back, world)
    world[:, list(TOES)] = world[:, list(HEELS)] - [0, 0.1, 0]  # feet straight down tell nothing
    assert not unmirror(world)[1]


def test_pointed_toes_do_not_hide_that_a_figure_is_mirrored():
    world, _ = walk(frames=30)
    toes, heels = list(TOES), list(HEELS)
    flat = (world[:, toes] - world[:, heels]) * [1.0, 0.0, 1.0]
    world[:, toes] = world[:, heels] + 0.4 * flat - [0.0, 0.15, 0.0]
    assert not unmirror(world)[1]
    back, mirrored = unmirror(world * [-1, 1, 1])
    assert mirrored and np.allclose(back, world)


def test_a_tilted_floor_is_found_and_levelled():
    world, _ = walk(frames=200, turn=0.4)
    tilt = np.array([0.12, 0.03, -0.02])  # height, slope along x and z
    lifted = world.copy()
    lifted[..., 1] += tilt[0] + world[..., 0] * tilt[1] + world[..., 2] * tilt[2]
    toes = lifted[:, list(TOES)]
    assert np.allclose(floor_plane(toes, 20.0), tilt, atol=0.012)
    flat = level(lifted, tilt)
    assert np.allclose(flat[:, list(TOES), 1], world[:, list(TOES), 1], atol=3e-3)
    apart = np.linalg.norm(lifted[:, 3] - lifted[:, 11], axis=-1)
    assert np.allclose(
        np.linalg.norm(flat[:, 3] - flat[:, 11], axis=-1), apart
    )  # turned, not sheared


def test_a_calibration_pose_and_a_lost_figure_are_no_part_of_a_motion():
    world, _ = walk(frames=60)
    pose = np.repeat(world[:1] + [0.4, 0.0, 0.3], 45, 0)
    pose[:, [15, 16, 19, 20], 1] += 0.7  # both arms up
    assert whole_take(world, 20.0) == (0, 60, "")
    for frames, said in ((1, "frame 0 is"), (2, "frames 0 to 1 are"), (45, "frames 0 to 44 are")):
        first, last, words = whole_take(np.concatenate([pose[:frames], world]), 20.0)
        assert (first, last) == (frames, frames + 60) and words.startswith(f"{said} a calibration")
    heap = np.repeat(world[-1:, :1] * [1, 0, 1], 21, 1)
    for frames in (1, 5):
        lost = np.concatenate([world, np.repeat(heap, frames, 0)])
        first, last, words = whole_take(lost, 20.0)
        assert (first, last) == (0, 60) and "a lost figure" in words
    # a figure that stands still and then walks has no calibration pose
    stands = np.concatenate([np.repeat(world[:1], 40, 0), world])
    assert whole_take(stands, 20.0) == (0, 100, "")


def test_a_path_in_another_unit_is_told_by_the_feet():
    world = walked(np.tile([1.1, 0.0, 0.2], (100, 1)), seed=3).world()
    assert unit_of_path(world, 20.0) == 1
    for factor in (100.0, 0.01, 39.37):
        moved = world + (factor - 1) * world[:, :1]
        assert unit_of_path(moved, 20.0) == pytest.approx(1 / factor, rel=0.01)
    assert unit_of_path(world - world[:, :1], 20.0) == 1  # no path, and none in another unit


def test_contacts_and_pins():
    toe = np.zeros((9, 3))
    toe[:, 0] = [0, 0.001, 0.002, 0.2, 0.4, 0.6, 0.8, 0.801, 0.802]
    contact = np.array([1, 1, 1, 0, 0, 0, 1, 1, 1], bool)
    assert runs(contact).tolist() == [[0, 3], [6, 9]]
    moved = toe + shift_to_pins(toe, contact)
    assert np.allclose(moved[:3], moved[0]) and np.allclose(moved[6:], moved[6])
    both = np.stack([toe, toe + [0, 0.2, 0]], axis=1)
    assert find_contacts(both, 20.0).tolist() == [[c, False] for c in (1, 1, 0, 0, 0, 0, 0, 1, 1)]


def test_planting_stills_the_toes_and_keeps_the_bones():
    world, _ = walk(frames=70)
    rng = np.random.default_rng(1)
    contacts = find_contacts(world[:, list(TOES)], 20.0)
    contacts[20:30, 0] = contacts[35:45, 1] = True
    world = world + 0.02 * np.cumsum(rng.normal(size=(70, 1, 3)), axis=0) * [1, 0.1, 1]
    planted = plant(world, contacts, 20.0)
    bones = np.linalg.norm(planted[:, 1:] - planted[:, PARENTS[1:]], axis=-1)
    assert np.abs(bones - BONE_LENGTHS).max() < 1e-9
    steps = np.linalg.norm(np.diff(planted[:, list(TOES)], axis=0), axis=-1)
    assert np.median(steps[contacts[1:] & contacts[:-1]]) < 1e-6


def test_knees_bend_forward_even_where_they_did_not():
    hip = np.array([[0.0, 0.9, 0.0]])
    ankle = np.array([[0.0, 0.12, 0.1]])
    for behind in (0.05, 0.0, -0.05):
        knee, reached = solve_leg(
            hip, ankle, np.array([[0.0, 0.5, behind]]), np.array([[0.0, 0.0, 1.0]])
        )
        assert np.allclose(reached, ankle)
        assert knee[0, 2] > 0.05 and np.linalg.norm(knee - hip) == pytest.approx(0.41)
    _, far = solve_leg(hip, ankle - [[0, 1, 0]], hip - [[0, 0.4, 0]], np.array([[0.0, 0.0, 1.0]]))
    assert np.linalg.norm(far - hip) == pytest.approx(0.9995 * 0.835)


def test_the_rest_pose_tells_the_lean_of_joint_placement():
    standing = np.zeros((21, 3))
    for joint in range(21):
        standing[joint] = OFFSETS[joint] + (standing[PARENTS[joint]] if joint else 0)
    assert rest_lean(standing) == pytest.approx(0, abs=1e-9)
    back = standing.copy()
    back[9:, 2] -= 0.2 * (back[9:, 1] - back[1, 1])
    assert np.degrees(rest_lean(back)) == pytest.approx(np.degrees(np.arctan(0.2)), abs=0.1)


def test_a_joint_deep_in_the_floor_is_told():
    world = np.zeros((30, 21, 3))
    notes = []
    world[12, joint_index("LeftHand")] = [0.3, -0.04, 0.0]
    warn_sunk(world, 20.0, "take", notes)
    assert notes == []
    world[12, joint_index("LeftHand"), 1] = -0.117
    with pytest.warns(
        MotionWarning, match="take: LeftHand is 12 cm under the floor 0.60 s into the clip"
    ):
        warn_sunk(world, 20.0, "take", notes)
    assert len(notes) == 1


def test_a_contact_has_no_gap_of_a_frame_and_lasts_longer_than_one():
    toes = np.zeros((12, 2, 3))
    toes[4, 0, 1] = 0.05  # a toe that is a little higher for a frame
    toes[:, 1, 1] = 0.2
    toes[7, 1, 1] = 0.0  # and one that is low for a frame
    contacts = find_contacts(toes, 10.0)
    assert contacts[:, 0].all() and not contacts[:, 1].any()


def test_the_body_does_not_tremble_with_a_foot_that_is_planted():
    world = np.repeat(walk(frames=2)[0][:1], 30, axis=0)
    foot = [HEELS[0], TOES[0]]
    world[::2, foot, 0] += 0.02
    made = plant(world, np.ones((30, 2), bool), 20.0)
    assert np.ptp(made[:, TOES[0], 0]) < 1e-6, "the toe is on one point"
    assert np.abs(np.diff(made[:, 0, 0], 2)).max() < 0.004
