"""Wrong answers to the exercises of notebook 01."""

import numpy as np

from ....motion.skeleton import CENTRE, MIRROR

_SEEN, _LED = np.array([-1.0, 1, 1]), np.array([1.0, -1, -1])
LEGS = [1, 2, 3, 4, 5, 6, 7, 8]  # of the 21 joints


def _bones(positions, bones):
    parent, child = np.array(bones).T
    return positions[:, child] - positions[:, parent]


def _turn(pose, heading):
    x, y, z = pose.T
    return np.stack(
        [np.cos(heading) * x + np.sin(heading) * z, y, np.cos(heading) * z - np.sin(heading) * x],
        -1,
    )


def _exchanged(pose, heading):
    """Turned with sine and cosine exchanged."""
    x, y, z = pose.T
    s, c = np.sin(heading), np.cos(heading)
    return np.stack([s * x + c * z, y, s * z - c * x], -1)


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


def only(joints):
    """Exchanges the names of these joints only; all positions are mirrored."""

    def answer(poses, control):
        partner = np.arange(poses.shape[1])
        partner[joints] = np.asarray(MIRROR)[joints]
        return poses[:, partner] * _SEEN, control * _LED

    return answer


def one_pair_left_out(poses, control):
    """Exchanges all but the hips."""
    partner = np.array(MIRROR)
    hips = [1, int(partner[1])]
    partner[hips] = hips
    return poses[:, partner] * _SEEN, control * _LED


def in_place(poses, control):
    """Right numbers, but the caller's poses are mirrored with them."""
    poses *= _SEEN
    return poses[:, MIRROR], control * _LED


def _moved(turned):
    return lambda pose, x, z, heading: turned(pose, heading) + np.array([x, 0, z])


# the bug zoo of the notebook, whose letters do not tell
CAGES = {"A": control_stays, "B": right, "C": names_stay}
MISTAKES = {
    "lengths_of_bones": {
        "these are squared lengths; the square root is missing": lambda p, b: (
            _bones(p, b) ** 2
        ).sum(-1),
        "a bone joins a joint to its parent, not to the joint before it in the list": lambda p, b: (
            np.linalg.norm(np.diff(p, axis=1), axis=-1)
        ),
        "sum over x, y, z, not over the bones": (
            lambda p, b: np.linalg.norm(_bones(p, b), axis=1),
            lambda p, b: np.linalg.norm(_bones(p, b), axis=1).T,
        ),
        "add the squares up under the root; you took their mean": lambda p, b: np.sqrt(
            (_bones(p, b) ** 2).mean(-1)
        ),
        "sum over x, y, z, not over the frames": lambda p, b: np.sqrt((_bones(p, b) ** 2).sum(0)),
        "these are sums of coordinates; how long is a vector in space?": (
            lambda p, b: np.abs(_bones(p, b)).sum(-1),
            lambda p, b: _bones(p, b).sum(-1),
        ),
        "each frame has its own lengths; this is their mean over the frames": lambda p, b: (
            np.linalg.norm(_bones(p, b), axis=-1).mean(0)
        ),
        "these are distances from the origin; a bone leads from the parent to the child": (
            lambda p, b: np.linalg.norm(p[:, [c for _, c in b]], axis=-1),
            lambda p, b: np.linalg.norm(p[:, [a for a, _ in b]], axis=-1),
        ),
        "these are the vectors; take their lengths": _bones,
        "the height is missing: a length has all three coordinates": lambda p, b: np.linalg.norm(
            _bones(p, b)[..., [0, 2]], axis=-1
        ),
    },
    "place_in_world": {
        "the figure turned clockwise; yaw is counter-clockwise seen from above": _moved(
            lambda pose, heading: _turn(pose, -heading)
        ),
        "turn the pose first, then move it: the root's position must not be turned": (
            lambda pose, x, z, heading: _turn(pose + np.array([x, 0, z]), heading)
        ),
        "the root's position is missing": lambda pose, x, z, heading: _turn(pose, heading),
        "the pose was moved but not turned": _moved(lambda pose, heading: pose),
        "left has the wrong sign: the pose is mirrored": _moved(
            lambda pose, heading: _turn(pose * [-1, 1, 1], heading)
        ),
        "x and z are exchanged": lambda pose, x, z, heading: _moved(_turn)(pose, x, z, heading)[
            :, [2, 1, 0]
        ],
        "the height must stay as it is": lambda pose, x, z, heading: (
            (_turn(pose, heading) + np.array([x, 0, z])) * [1, 0, 1]
        ),
        "x and z of the root are exchanged": lambda pose, x, z, heading: (
            _turn(pose, heading) + np.array([z, 0, x])
        ),
        "the heading is in radians already": _moved(
            lambda pose, heading: _turn(pose, np.radians(heading))
        ),
        "sine and cosine are exchanged: at heading 0 the pose must not turn": _moved(_exchanged),
        "you subtracted the root's position; add it": (
            lambda pose, x, z, heading: _turn(pose, heading) - np.array([x, 0, z])
        ),
    },
    "mirror_walk": {
        "x is negated, but left and right must swap names too": names_stay,
        "left and right are swapped, but no coordinate has changed its sign: which one does a "
        "mirror change?": lambda poses, control: (poses[:, MIRROR], control * _LED),
        "the wrong coordinate changes sign; x points to the left": (
            lambda poses, control: (poses[:, MIRROR] * [1, 1, -1], control * _LED),
            lambda poses, control: (poses[:, MIRROR] * [1, -1, 1], control * _LED),
        ),
        "the central joints must be mirrored, too: their x changes sign as well": (
            central_joints_stay
        ),
        "only some joints swap their names; all pairs do, legs and arms": (
            only(LEGS),
            only([j for j in range(21) if j not in LEGS]),
            only([3, 7]),
            one_pair_left_out,
        ),
        "the poses are as they were": lambda poses, control: (poses.copy(), control * _LED),
        "the control is that of the unmirrored walk": control_stays,
        "a figure in a mirror turns the other way, too": yaw_stays,
        "a figure in a mirror steps to the other side, too": lambda poses, control: (
            right(poses, control)[0],
            control * [1, 1, -1],
        ),
        "a figure in a mirror still walks forwards": (
            walks_backwards,
            lambda poses, control: (right(poses, control)[0], control * [-1, 1, 1]),
        ),
    },
}
OTHERS = {
    "mirror_walk": {
        "changes its input": in_place,
        "poses alone": lambda poses, control: right(poses, control)[0],
    },
    "lengths_of_bones": {"bones first": lambda p, b: np.linalg.norm(_bones(p, b), axis=-1).T},
}
