"""World <-> root frame + control: exact both ways, and right by hand."""

import numpy as np
import pytest

from motiondiff_edu.motion import root_frame as rf
from motiondiff_edu.motion.kinematics import rot_y
from motiondiff_edu.motion.skeleton import OFFSETS, PARENTS, J, joint_index


def long_run(seconds=60, fps=20, seed=3):
    """Poses and control of a run at 3 m/s.

    It turns both ways, steps aside, and passes +-pi several times.
    """
    rng = np.random.default_rng(seed)
    t = np.arange(seconds * fps) / fps
    control = np.stack([3 + 0 * t, 0.5 * np.sin(t), 1.2 * np.sin(0.3 * t) + 0.6], -1)
    rest = np.zeros((J, 3))
    for j in range(J):
        rest[j] = OFFSETS[j] + (rest[PARENTS[j]] if j else 0)
    return rest + 0.1 * rng.normal(size=(len(t), J, 3)), control


def test_round_trip_over_a_minute():
    poses, control = long_run()
    start = (4.0, -2.0, 2.5)
    world = rf.to_world(poses, control, start)
    back, control_back = rf.to_root_frame(world, *rf.root_path(control, start))
    np.testing.assert_allclose(back, poses, atol=1e-6)
    np.testing.assert_allclose(control_back[:-1], control[:-1], atol=1e-6)
    np.testing.assert_allclose(rf.to_world(back, control_back, start), world, atol=1e-6)
    assert np.abs(world[-1, 0, [0, 2]] - world[0, 0, [0, 2]]).max() > 1  # it did go somewhere


def test_the_last_row_of_control_repeats_and_is_not_used():
    poses, control = long_run(seconds=2)
    changed = control.copy()
    changed[-1] = 99
    assert np.array_equal(rf.to_world(poses, control), rf.to_world(poses, changed))
    again = rf.control_from_path(*rf.root_path(control))
    assert np.array_equal(again[-1], again[-2])


@pytest.mark.parametrize(
    "row, end",
    [((1.0, 0, 0), (0, 1, 0)), ((0, 1.0, 0), (1, 0, 0)), ((0, 0, np.pi / 2), (0, 0, np.pi / 2))],
)
def test_one_second_of_each_column(row, end):
    """Forward is z, left is x, yaw is counter-clockwise from above."""
    root, heading = rf.root_path(np.tile(np.array(row), (21, 1)))
    np.testing.assert_allclose([*root[-1], heading[-1]], end, atol=1e-12)


def test_a_circle_closes_exactly():
    """Walking a full turn at constant speed returns to the start.

    The halfway heading makes it a regular polygon.
    """
    frames = 80
    control = np.tile([1.3, 0.2, 2 * np.pi * rf.FPS / frames], (frames + 1, 1))
    root, heading = rf.root_path(control, (1.0, 2.0, 0.7))
    np.testing.assert_allclose(root[-1], [1.0, 2.0], atol=1e-12)
    assert heading[-1] - heading[0] == pytest.approx(2 * np.pi)
    assert np.linalg.norm(root - root.mean(0), axis=-1).min() > 0.5


def test_world_agrees_with_a_rotation_matrix():
    """The same thing written as a rotation about y: an independent way to place a pose."""
    poses, control = long_run(seconds=3)
    root, heading = rf.root_path(control, (0.0, 1.0, -0.4))
    placed = np.einsum("tij,tkj->tki", rot_y(heading), poses)
    placed[..., [0, 2]] += root[:, None]
    np.testing.assert_allclose(rf.to_world(poses, control, (0.0, 1.0, -0.4)), placed, atol=1e-12)


def test_another_rate_scales_the_step():
    control = np.tile([1.2, 0.0, 0.3], (31, 1))
    root, heading = rf.root_path(control, fps=30.0)
    assert heading[-1] == pytest.approx(0.3)
    np.testing.assert_allclose(rf.control_from_path(root, heading, fps=30.0), control, atol=1e-12)


def test_one_frame_has_no_velocity():
    with pytest.raises(ValueError, match="at least 2 frames"):
        rf.control_from_path(np.zeros((1, 2)), np.zeros(1))


def test_the_body_faces_where_hips_and_shoulders_look_together():
    """Hips turned by 0.4 and shoulders by 1.0: between them, by how wide each is."""
    world = np.zeros((2, 21, 3))
    for part, width, angle in (("UpLeg", 0.1, 0.4), ("Arm", 0.3, 1.0)):
        left = width * np.array([np.cos(angle), 0.0, -np.sin(angle)])
        world[0, joint_index("Left" + part)] = left
        world[0, joint_index("Right" + part)] = -left
    world[1] = world[0] * [-1.0, 1.0, -1.0]  # half a turn
    wanted = np.angle(0.1 * np.exp(0.4j) + 0.3 * np.exp(1.0j))
    np.testing.assert_allclose(rf.body_heading(world), [wanted, wanted - np.pi], atol=1e-12)


def test_estimated_root_finds_path_and_heading_of_a_swaying_figure():
    """The pelvis sways at gait frequency.

    The estimate has a tenth of the sway, and heading passes pi unbroken.
    """
    frames, fps = 240, 20
    t = np.arange(frames) / fps
    control = np.tile([1.2, 0.0, 0.5], (frames, 1))
    pose = long_run(seconds=1)[0].mean(0)
    poses = np.tile(pose, (frames, 1, 1))
    poses[..., 0] += 0.03 * np.sin(2 * np.pi * t)[:, None]
    true_root, true_heading = rf.root_path(control, (0.0, 0.0, 1.0))
    root, heading = rf.estimate_root(rf.to_world(poses, control, (0.0, 0.0, 1.0)))
    inner = slice(30, -30)
    assert np.abs(heading - true_heading - (heading - true_heading)[120])[inner].max() < 0.03
    across = ((root - true_root) * rf.forward_left(true_heading)[1]).sum(-1)[inner]
    assert across.std() < 0.01 < (0.03 * np.sin(2 * np.pi * t)).std()


@pytest.mark.parametrize("frames", [11, 19, 47])
def test_estimated_root_of_a_short_clip_keeps_its_speed(frames):
    """Half a second is shorter than the Gaussian.

    A steady walk must not seem to slow down at its ends.
    """
    control = np.tile([1.3, 0.2, 0.0], (frames, 1))
    poses = np.tile(long_run(seconds=1)[0].mean(0), (frames, 1, 1))
    root, heading = rf.estimate_root(rf.to_world(poses, control))
    found = rf.control_from_path(root, heading - heading[0])
    speed = np.linalg.norm(found[:, :2], axis=1)
    np.testing.assert_allclose(speed, np.hypot(1.3, 0.2), rtol=1e-9)


def test_the_estimated_root_is_smoothed_by_gaussians_of_these_lengths():
    """A Gaussian of sigma seconds leaves exp(-(2 pi f sigma)^2 / 2) of a sine of f Hz.

    Way .25 s, turns .33 s.
    """
    t, pose = np.arange(400) / 20, long_run(seconds=1)[0].mean(0)
    sway = 0.05 * np.sin(2 * np.pi * 0.6 * t)
    turn = 0.2 * np.sin(2 * np.pi * 0.6 * t)
    world = np.tile(pose, (400, 1, 1))
    still, heading = rf.estimate_root(world)
    world[..., 0] += sway[:, None]
    root, _ = rf.estimate_root(world)
    kept = np.ptp((root - still)[60:-60, 0]) / np.ptp(sway)
    assert kept == pytest.approx(np.exp(-((2 * np.pi * 0.6 * 0.25) ** 2) / 2), rel=0.02)
    left, up, ahead = np.moveaxis(np.tile(pose - pose[0] * [1, 0, 1], (400, 1, 1)), -1, 0)
    cos, sin = np.cos(turn)[:, None], np.sin(turn)[:, None]
    turned = np.stack([left * cos + ahead * sin, up, ahead * cos - left * sin], -1)
    kept = np.ptp(rf.estimate_root(turned)[1][60:-60]) / np.ptp(turn)
    assert kept == pytest.approx(np.exp(-((2 * np.pi * 0.6 * 0.33) ** 2) / 2), rel=0.02)


def test_the_heading_is_that_of_hips_and_shoulders_together():
    pose = np.zeros((1, 21, 3))
    for name, x, z in (("UpLeg", 0.1, 0.0), ("Arm", 0.3 * np.cos(0.4), -0.3 * np.sin(0.4))):
        pose[0, joint_index("Left" + name)] = (x, 1, z)
        pose[0, joint_index("Right" + name)] = (-x, 1, -z)
    _, heading = rf.estimate_root(np.tile(pose, (60, 1, 1)))
    by_hand = np.arctan2(
        0.3 * np.sin(0.4), 0.1 + 0.3 * np.cos(0.4)
    )  # hips ahead, shoulders turned by 0.4
    assert heading == pytest.approx(np.full(60, by_hand))
