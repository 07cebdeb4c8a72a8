"""Wrong answers to the exercises of notebook 01."""

import numpy as np

from ....motion.skeleton import CENTRE, MIRROR

_SEEN, _LED = np.array([-1.0, 1, 1]), np.array([1.0, -1, -1])


def _bones(positions, bones):
    parent, child = np.array(bones).T
    return positions[:, child] - positions[:, parent]


def _turn(pose, heading):
    x, y, z = pose.T
    return np.stack(
        [np.cos(heading) * x + np.sin(heading) * z, y, np.cos(heading) * z - np.sin(heading) * x],
        -1,
    )


def right(poses, control):
    """The right answer, among the wrong ones of the bug zoo."""
    return poses[:, MIRROR] * _SEEN, control * _LED


def central_joints_stay(poses, control):
    """The public preprocessing of the data set does this."""
    seen = poses[:, MIRROR] * _SEEN
    seen[:, CENTRE, 0] = poses[:, CENTRE, 0]
    return seen, control * _LED


def names_stay(poses, control):
    """Mirrors the positions but not the names.

    The left arm now hangs on the right side of the body.
    """
    return poses * _SEEN, control * _LED


def control_stays(poses, control):
    """The body steps into a turn to one side, and its control turns to the other."""
    return poses[:, MIRROR] * _SEEN, control.copy()


def yaw_stays(poses, control):
    """Sidesteps are mirrored and turns are not, as if only one of them had a left and a right."""
    return poses[:, MIRROR] * _SEEN, control * [1, -1, 1]


def walks_backwards(poses, control):
    """Negates the forward speed, too, which a mirror leaves as it is."""
    return poses[:, MIRROR] * _SEEN, -control


def in_place(poses, control):
    """Right numbers, but the caller's poses are mirrored with them."""
    poses *= _SEEN
    return poses[:, MIRROR], control * _LED


# the bug zoo of the notebook, whose letters do not tell
CAGES = {"A": control_stays, "B": right, "C": names_stay}
ZOO = {
    "lengths_of_bones": {
        "root dropped": lambda p, b: (_bones(p, b) ** 2).sum(-1),
        "neighbours in the list, not parents": lambda p, b: np.linalg.norm(
            np.diff(p, axis=1), axis=-1
        ),
        "summed over frames": lambda p, b: np.sqrt((_bones(p, b) ** 2).sum(0)),
        "sum of coordinates": lambda p, b: np.abs(_bones(p, b)).sum(-1),
        "mean over frames": lambda p, b: np.linalg.norm(_bones(p, b), axis=-1).mean(0),
    },
    "place_in_world": {
        "turned clockwise": lambda pose, x, z, heading: _turn(pose, -heading) + [x, 0, z],
        "moved before it is turned": lambda pose, x, z, heading: _turn(pose + [x, 0, z], heading),
        "not moved": lambda pose, x, z, heading: _turn(pose, heading),
        "not turned": lambda pose, x, z, heading: pose + [x, 0, z],
        "x and z swapped": lambda pose, x, z, heading: _turn(pose, heading) + [z, 0, x],
        "degrees for radians": lambda pose, x, z, heading: (
            _turn(pose, np.radians(heading)) + [x, 0, z]
        ),
    },
    "mirror_walk": {
        "central joints stay": central_joints_stay,
        "left and right keep their names": names_stay,
        "control stays": control_stays,
        "yaw stays": yaw_stays,
        "walks backwards": walks_backwards,
        "changes its input": in_place,
        "z negated": lambda poses, control: (poses[:, MIRROR] * [1, 1, -1], control * _LED),
        "only names swapped": lambda poses, control: (poses[:, MIRROR], control * _LED),
    },
}
