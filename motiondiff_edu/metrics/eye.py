"""What an eye finds wrong in a moving figure, as numbers.

None has a goal: compare it with that of the data or of a recording, for a figure that does not move
is perfect in some of them. Positions are in the world (metres, y up). They are those of finished
motions, for these are what one looks at. Where the noise of a capture would count, only what is
slower than 3 Hz is taken (`slow_part`).
Source: ours.
"""

import numpy as np
import scipy.signal
from jaxtyping import Bool, Float

from ..motion.finite import check_finite
from ..motion.root_frame import FPS, body_heading, forward_left, to_root_frame
from ..motion.skeleton import HEELS, HIPS, TOES, joint_index

SLOW = 3.0  # Hz: limbs move slower, and the noise of a capture is faster
FLUTTER = 0.2  # m/s: a centimetre in a frame of the course
STRIDES = (0.7, 1.7)  # s: two steps, from a brisk run to a slow walk
HANDS = (joint_index("LeftHand"), joint_index("RightHand"))
ELBOWS = tuple(
    tuple(joint_index(side + part) for part in ("Arm", "ForeArm", "Hand"))
    for side in ("Left", "Right")
)
NECK = joint_index("Neck1")
SHORTEST = 16  # frames that can be smoothed


def slow_part(x: Float[np.ndarray, "T *D"], fps: float | int = FPS) -> Float[np.ndarray, "T *D"]:
    """The part below 3 Hz: a Butterworth filter of order 2, forwards and backwards.

    Raises ValueError for fewer than 16 frames, and for NaN.
    """
    check_finite(x, "positions")
    if len(x) < SHORTEST:
        raise ValueError(f"{len(x)} frames are too few to smooth: {SHORTEST} are needed")
    b, a = scipy.signal.butter(2, SLOW, fs=fps)
    return scipy.signal.filtfilt(b, a, x, axis=0)


def toe_flutter(positions: Float[np.ndarray, "T 21 3"], fps: float | int = FPS) -> float:
    """How often in a second a toe goes up and at once down again, or down and up; of both toes.

    Two following changes of a toe's height count when both are faster than 0.2 m/s and their signs
    differ. The positions are not smoothed.
    Raises ValueError for fewer than three frames, and for NaN.
    """
    check_finite(positions, "positions")
    if len(positions) < 3:
        raise ValueError(f"a reversal needs three frames, and this motion has {len(positions)}")
    speed = np.diff(positions[:, list(TOES), 1], axis=0) * fps
    before, after = speed[:-1], speed[1:]
    reversed_ = (before * after < 0) & (np.minimum(abs(before), abs(after)) > FLUTTER)
    return float(reversed_.sum() * fps / len(reversed_))


def stride_change(positions: Float[np.ndarray, "T 21 3"], fps: float | int = FPS) -> float:
    """How much a pose differs from that of a stride later, in cm: a metronome has 0.

    The least over strides of 0.7 to 1.7 s of the RMS distance of a joint, in the frame of the
    pelvis and the heading of the body, below 3 Hz.
    Raises ValueError for a motion shorter than two of the longest strides, and for NaN.
    """
    shortest, longest = (round(seconds * fps) for seconds in STRIDES)
    if len(positions) < 2 * longest:
        raise ValueError(
            f"{len(positions) / fps:.1f} s are too short to compare strides: "
            f"{2 * STRIDES[1]:.1f} s are needed"
        )
    slow = slow_part(positions, fps)
    poses, _ = to_root_frame(slow, slow[:, HIPS][:, [0, 2]], body_heading(slow), fps)
    lags = range(shortest, longest + 1)
    squares = [((poses[lag:] - poses[:-lag]) ** 2).sum(-1).mean() for lag in lags]
    return float(100 * np.sqrt(min(squares)))


def hand_swing(positions: Float[np.ndarray, "T 21 3"], fps: float | int = FPS) -> float:
    """How far the hands swing forwards and backwards, in cm: the mean of both.

    The 95th minus the 5th percentile of a hand's place before the pelvis, in the heading of the
    body, below 3 Hz. Raises ValueError as `slow_part`.
    """
    slow = slow_part(positions, fps)
    ahead, _ = forward_left(body_heading(slow))
    away = slow[:, list(HANDS)][..., [0, 2]] - slow[:, HIPS][:, None, [0, 2]]
    low, high = np.percentile((away * ahead[:, None]).sum(-1), [5, 95], axis=0)
    return float(100 * (high - low).mean())


def hand_above_given(
    positions: Float[np.ndarray, "T 21 3"], given: Float[np.ndarray, "N 21 3"]
) -> float:
    """How far a hand rises above its highest place in the given motion, in cm; 0 if it does not.

    Heights are over the pelvis, and the larger excess of the two hands counts: a continuation that
    raises a hand which hung in all of the past invents a gesture. Raises ValueError for NaN.
    """
    check_finite(positions, "positions")
    check_finite(given, "the given positions")
    made, had = (
        x[:, list(HANDS), 1] - x[:, HIPS, 1][:, None] for x in (positions, given)
    )  # (T, 2), (N, 2)
    return float(100 * max(0.0, (made.max(0) - had.max(0)).max()))


def feet_apart(positions: Float[np.ndarray, "T 21 3"], stands: Bool[np.ndarray, "T"]) -> float:
    """How far one ankle is before the other while the figure stands still, in cm.

    The mean over the frames that `stands` marks, in the heading of the body: a figure that stops in
    the middle of a step has half of its step there. Raises ValueError if no frame is marked, and
    for NaN.
    """
    check_finite(positions, "positions")
    if not stands.any():
        raise ValueError("the figure stands in no frame, so its feet cannot be judged")
    still = positions[stands]
    ahead, _ = forward_left(body_heading(still))
    left, right = (still[:, heel][:, [0, 2]] for heel in HEELS)
    return float(100 * np.abs(((left - right) * ahead).sum(-1)).mean())


def elbow_spread(positions: Float[np.ndarray, "T 21 3"], fps: float | int = FPS) -> float:
    """The standard deviation of an elbow's angle over time, in degrees, below 3 Hz: mean of both.

    Stiff forearms have a small one. Raises ValueError as `slow_part`.
    """
    slow, spreads = slow_part(positions, fps), []
    for shoulder, elbow, hand in ELBOWS:
        upper, lower = slow[:, shoulder] - slow[:, elbow], slow[:, hand] - slow[:, elbow]
        lengths = np.linalg.norm(upper, axis=-1) * np.linalg.norm(lower, axis=-1)
        cosine = (upper * lower).sum(-1) / np.maximum(lengths, 1e-12)
        spreads.append(np.degrees(np.arccos(cosine.clip(-1, 1))).std())
    return float(np.mean(spreads))


def trunk_lean(positions: Float[np.ndarray, "T 21 3"]) -> float:
    """The angle between the line from pelvis to neck and the vertical, in degrees: mean over time.

    Raises ValueError for NaN.
    """
    check_finite(positions, "positions")
    trunk = positions[:, NECK] - positions[:, HIPS]
    across = np.linalg.norm(trunk[:, [0, 2]], axis=-1)
    return float(np.degrees(np.arctan2(across, trunk[:, 1])).mean())


def accents(
    positions: Float[np.ndarray, "T 21 3"],
    beats: Float[np.ndarray, "K"],
    fps: float | int = FPS,
) -> float:
    """How much the strength of a dance's movement differs from beat to beat.

    The standard deviation over the mean of the joints' mean speed in the spans between beats (s),
    below 3 Hz. Soft accents have a small one. Raises ValueError for fewer than three spans within
    the motion, and as `slow_part`.
    """
    speed = np.linalg.norm(np.diff(slow_part(positions, fps), axis=0), axis=-1).mean(-1) * fps
    edges = np.unique((beats[(beats >= 0) & (beats * fps <= len(speed))] * fps).round().astype(int))
    if len(edges) < 4:
        raise ValueError(f"{max(0, len(edges) - 1)} spans between beats: three are needed")
    each = np.array([speed[a:b].mean() for a, b in zip(edges, edges[1:], strict=False)])
    return float(each.std() / each.mean())


def tick_at_keyframes(
    positions: Float[np.ndarray, "T 21 3"],
    keyframes: Bool[np.ndarray, "T"],
    fps: float | int = FPS,
) -> float:
    """How much stronger joints are accelerated at keyframes than elsewhere: their ratio.

    The median over keyframes within the motion of the joints' mean acceleration
    |p[t+1] - 2 p[t] + p[t-1]| fps^2, over the median of all other frames. A motion that passes its
    keyframes without a tick has about 1. The positions are not smoothed. Raises ValueError where
    there is no keyframe, or nothing else, between the first and the last frame, and for NaN.
    """
    check_finite(positions, "positions")
    inside = keyframes[1:-1]
    if not inside.any() or inside.all():
        raise ValueError("acceleration at keyframes needs some, and other frames, within a motion")
    bend = positions[2:] - 2 * positions[1:-1] + positions[:-2]
    each = np.linalg.norm(bend, axis=-1).mean(-1) * fps**2
    return float(np.median(each[inside]) / max(np.median(each[~inside]), 1e-9))


def still_share(positions: Float[np.ndarray, "T 21 3"], fps: float | int = FPS) -> float:
    """The share of the time in which no joint is faster than 0.2 m/s, below 3 Hz: from 0 to 1.

    Raises ValueError as `slow_part`.
    """
    speed = np.linalg.norm(np.diff(slow_part(positions, fps), axis=0), axis=-1) * fps
    return float((speed.max(-1) < FLUTTER).mean())
