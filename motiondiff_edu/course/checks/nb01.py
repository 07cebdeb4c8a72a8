"""Checks of notebook 01: lengths of bones, a pose placed in the world, a walk in the mirror."""

import numpy as np

from ._report import check, expect, expect_close


@check
def lengths_of_bones(mine):
    """mine(positions, bones) on a small skeleton whose bones are 5, 12 and 3 long."""
    bones = [(0, 1), (1, 2), (0, 3)]
    positions = np.zeros((2, 4, 3))
    positions[:, 1:] = [[3, 4, 0], [3, 4, 12], [1, 2, 2]]  # bones of 5, 12 and 3
    positions[1] *= 2  # the second frame twice as large
    positions[1] += [1.0, -2, 0.5]
    wanted = np.array([[5.0, 12, 3], [10, 24, 6]])
    neighbours = np.linalg.norm(np.diff(positions, axis=1), axis=-1)
    vectors = np.stack([positions[:, c] - positions[:, p] for p, c in bones], 1)
    mistakes = {
        "these are squared lengths; the square root is missing": wanted**2,
        "a bone joins a joint to its parent, not to the joint before it in the list": neighbours,
        "sum over x, y, z, not over the frames": np.sqrt((vectors**2).sum(0)),
        "these are sums of coordinates; how long is a vector in space?": np.abs(vectors).sum(-1),
    }
    expect_close(
        mine(positions, bones),
        wanted,
        "the lengths of two poses with bones of 5, 12 and 3",
        mistakes,
    )
    return (
        "A bone should have one length. Nothing in the 63 coordinates of a pose makes sure of that."
    )


@check
def place_in_world(mine):
    """Check mine(pose, x, z, heading).

    The check turns and moves four joints, at headings whose sines are known.
    """
    pose = np.array([[0.0, 1.0, 0.0], [0.2, 1.5, 0.0], [0.0, 0.1, 0.3], [-0.1, 0.4, 0.05]])
    quarter = mine(pose, 2.0, 5.0, np.pi / 2)  # facing +x, so left is -z
    x, y, z = pose.T
    wanted = np.stack([2 + z, y, 5 - x], -1)
    mistakes = {
        "the figure turned clockwise; yaw is counter-clockwise seen from above": np.stack(
            [2 - z, y, 5 + x], -1
        ),
        "turn the pose first, then move it: the root's position must not be turned": np.stack(
            [5 + z, y, -2 - x], -1
        ),
        "the root's position is missing": np.stack([z, y, -x], -1),
        "the pose was moved but not turned": pose + [2, 0, 5],
        "the height must stay as it is": np.stack([2 + z, 0 * y, 5 - x], -1),
    }
    expect_close(quarter, wanted, "a pose at (2, 5), turned by a quarter to the left", mistakes)
    eighth = mine(pose, 0.0, 0.0, np.pi / 6)
    c, s = np.sqrt(3) / 2, 0.5
    expect_close(
        eighth, np.stack([c * x + s * z, y, -s * x + c * z], -1), "a pose turned by 30 degrees"
    )
    return "One turn and one shift for each pose lead from the root frame to the world."


def _small_walk():
    """Six poses of the 21 joints, no two numbers alike, and their control."""
    rng = np.random.default_rng(8)
    return rng.normal(size=(6, 21, 3)), rng.normal(size=(6, 3))


def _expect_poses(seen, poses):
    # by hand: the names of the skeleton
    left_foot = 3
    right_foot = 7
    neck = 11
    mistakes = {
        "x is negated, but left and right must swap names too": poses[:, left_foot] * [-1, 1, 1],
        (
            "left and right are swapped, but no coordinate has changed its sign: "
            "which one does a mirror change?"
        ): poses[:, right_foot],
        "the wrong coordinate changes sign; x points to the left": poses[:, right_foot]
        * [1, 1, -1],
    }
    expect_close(
        seen[:, left_foot], poses[:, right_foot] * [-1, 1, 1], "the mirrored left foot", mistakes
    )
    expect_close(seen[:, right_foot], poses[:, left_foot] * [-1, 1, 1], "the mirrored right foot")
    stayed = {"the central joints are mirrored, too: their x changes sign as well": poses[:, neck]}
    expect_close(seen[:, neck], poses[:, neck] * [-1, 1, 1], "the mirrored neck", stayed)


@check
def mirror_walk(mine):
    """mine(poses, control): every joint changes side, and so do two columns of the control."""
    poses, control = _small_walk()
    before = poses.copy(), control.copy()
    answer = mine(poses, control)
    expect(
        isinstance(answer, tuple | list) and len(answer) == 2,
        "return two things: the poses, and the control",
    )
    same = np.array_equal(poses, before[0]) and np.array_equal(control, before[1])
    expect(same, "your answer changed its input; work on a copy")
    _expect_poses(np.asarray(answer[0]), poses)
    forward, aside, yaw = control.T
    wrong = {
        "the control is that of the unmirrored walk": control,
        "a figure in a mirror turns the other way, too": np.stack([forward, -aside, yaw], -1),
        "a figure in a mirror steps to the other side, too": np.stack([forward, aside, -yaw], -1),
        "a figure in a mirror still walks forwards": -control,
    }
    expect_close(answer[1], np.stack([forward, -aside, -yaw], -1), "the mirrored control", wrong)
    return "One sign and one permutation give twice as much data, if every joint takes part."
