"""A continuation that goes on from the motion that it continues, with its body and without a jump.

A walker that gets a pose unlike its training begins with one that it knows: a joint may move by
half a metre from the last given frame to the first new one. So it is in nearly all recordings. The
clean-up blends the seam (`motion/cleanup`); where a joint would jump far, a warning says so.

Networks know figures of one size, the course's, so the motion is brought to it and back. A child
that keeps its own size would float over the floor in what they generate: its legs are too short for
the height of the pelvis.
"""

from dataclasses import dataclass, replace

import numpy as np
import torch
from jaxtyping import Bool, Float
from torch import Tensor

from ..conditions.control import splice
from ..metrics.keyframes import AROUND, seam_step
from ..motion.check import lies_down
from ..motion.cleanup import clean_up
from ..motion.motion import Motion, MotionError
from ..motion.planting import SHANK, THIGH
from ..motion.root_frame import FPS, root_path, to_root_frame, to_world
from ..motion.skeleton import JOINTS, PARENTS, J, joint_index
from ..rollout import Units

# m: a joint that goes this much farther at the seam than in the frames beside it is said to jump;
# after synthetic walks it is under 3 cm
FAR = 0.25
# standard deviations of the training, over the coordinates of a joint; no frame of 120 unseen
# synthetic walks is as far (at most 4.64)
UNLIKE = 5.0
NAMED = 3  # joints in a message
SUDDEN = 2.0  # m/s within half a second; controls of the training change by 1.4 at most
OFF_FLOOR = 0.15  # m: a figure whose lowest joint is higher rests on nothing


@dataclass(frozen=True, eq=False)
class Start:
    """Where a continuation begins, and the way that it takes.

    given    the motion that is continued, in the world (metres)
    past     its last frames in the root frame
    control  of these frames and of those to come
    path     of the root on the ground under this control
    size     of the figure, over the course's; all of the above are in metres of the course's figure
    """

    given: Float[np.ndarray, "N 21 3"]
    past: Float[np.ndarray, "T_h 21 3"]
    control: Float[np.ndarray, "T 3"]
    path: Float[np.ndarray, "T 3"]
    size: float = 1.0

    @classmethod
    def of(cls, motion: Motion, control: Float[np.ndarray, "n 3"], T_h: int) -> "Start":
        """From the last T_h frames of a motion at 20 frames/s on.  Raises MotionError for fewer."""
        if words := lies_down(motion.positions, motion.skeleton):
            raise MotionError(f"{motion.name}: {words}")
        motion.check_whole()
        size = leg_size(motion.positions)
        motion = resize_motion(motion.resampled(FPS), 1 / size)
        before = motion.path()
        if len(motion) < T_h:
            raise MotionError(
                f"{motion.name} has {len(motion)} frames; the walker needs at least {T_h} "
                f"({T_h / FPS:g} s) to continue it"
            )
        poses, given = to_root_frame(motion.positions, before[:, :2], before[:, 2])
        rows = splice(given, control / [size, size, 1.0], T_h)
        place, heading = root_path(rows, tuple(before[-T_h]))
        path = np.column_stack([place, heading])
        return cls(motion.positions, poses[-T_h:], rows, path, size)

    def in_world(self, new: Float[np.ndarray, "n 21 3"]) -> Float[np.ndarray, "n 21 3"]:
        """New frames of the root frame, placed in the world."""
        first = len(self.past)
        return to_world(new, self.control[first:], tuple(self.path[first]))


def finish_continuation(
    start: Start, new: Float[np.ndarray, "T 21 3"]
) -> tuple[Float[np.ndarray, "T 21 3"], float]:
    """New frames in the world, and how much farther a joint stepped at the seam than beside it.

    The step is that of the network (m), before the clean-up.
    """
    whole, known = around_seam(start, new)
    k = len(whole) - len(new)
    jump = seam_step(whole, k) if 2 <= k < len(whole) - 1 else 0.0
    return clean_up(whole, FPS, known)[k:], jump


def around_seam(
    start: Start, new: Float[np.ndarray, "T 21 3"]
) -> tuple[Float[np.ndarray, "T2 21 3"], Bool[np.ndarray, "T2 21"]]:
    """A second of what is given and all new frames, in the world, and which joints are given."""
    before = start.given[-round(AROUND * FPS) - 1 :]
    whole = np.concatenate([before, start.in_world(new)])
    known = np.zeros((len(whole), J), bool)
    known[: len(before)] = True
    return whole, known


def unlike_training(
    scaler: Units, past: Float[Tensor, "T D"], known: Bool[np.ndarray, "T J"] | None = None
) -> dict[str, float]:
    """Joints that are far from the training's poses, in its standard deviations, farthest first.

    A joint counts by the frame in which it is farthest away; where it is not `known`, it does not.
    """
    away = scaler.transform(past.to(scaler.mean)).reshape(len(past), J, 3)
    far = away.square().mean(-1).sqrt().cpu()
    if known is not None:
        far = far.where(torch.from_numpy(known), 0.0)
    far = far.amax(0).tolist()
    order = sorted(range(J), key=far.__getitem__, reverse=True)
    return {JOINTS[joint]: far[joint] for joint in order if far[joint] > UNLIKE}


def change_of(control: Float[np.ndarray, "T 3"]) -> float:
    """The largest change of a control's velocity within half a second, in m/s."""
    half = min(round(0.5 * FPS), len(control) - 1)
    return float(
        np.linalg.norm(control[half:, :2] - control[: len(control) - half, :2], axis=1).max()
    )


def in_words(start: Start, jump: float, unlike: dict[str, float]) -> str:
    """What there is to say about a continuation; "" if there is nothing.

    jump    of the joint that would go farthest, in metres of a figure of the course's size
    What is said is in metres of the figure itself.
    """
    words, size = [], start.size
    height = size * start.given[-1, :, 1].min()
    change = change_of(start.control[len(start.past) - 2 :])
    if change > SUDDEN:
        words.append(
            f"the control changes by {size * change:.1f} m/s within half a second, faster than any "
            "of the training, so feet may slide there"
        )
    if unlike:
        words.append(f"the poses to continue are unlike the walker's training {farthest(unlike)}")
    if height > OFF_FLOOR:
        words.append(
            f"the last pose is {height:.2f} m off the floor, and the walker comes down to it"
        )
    if jump > FAR:
        words.append(
            f"a joint would jump by {100 * size * jump:.0f} cm from the last pose, so the first "
            "frames are blended"
        )
    return "; ".join(words)


def farthest(unlike: dict[str, float]) -> str:
    """The joints that are farthest from the training, in brackets."""
    most = [f"{name} {far:.1f}" for name, far in list(unlike.items())[:NAMED]]
    return f"(standard deviations away: {', '.join(most)})"


LEGS = [joint_index(f"{side}{part}") for side in ("Left", "Right") for part in ("Leg", "Foot")]
SAME = 1e-3  # a size that differs from 1 by less is 1


def leg_size(positions: Float[np.ndarray, "T 21 3"]) -> float:
    """How long the legs are, over those of the course's skeleton; missing joints do not count.

    Thigh and shank of both legs; the median over frames. 1 where no leg is given.
    """
    long = np.linalg.norm(positions[:, LEGS] - positions[:, PARENTS[LEGS]], axis=-1).sum(-1)
    if not np.isfinite(long).any():
        return 1.0
    size = float(np.nanmedian(long) / (2 * (THIGH + SHANK)))
    return 1.0 if abs(size - 1) < SAME else size


def resize_motion(motion: Motion, factor: float) -> Motion:
    """The motion with all lengths times `factor`: a figure of another size, and its path."""
    root = None if motion.root is None else motion.root * [factor, factor, 1.0]
    return replace(motion, positions=factor * motion.positions, root=root)
