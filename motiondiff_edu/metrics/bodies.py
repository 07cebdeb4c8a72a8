"""Measures of one moving body: bones, use of the floor, repetition, and what an eye finds wrong.

Bones: do the limbs keep their length? The networks generate 21 free points; no rule fixes them.
Positions are in metres, errors in centimetres, as in the papers' tables. Root frame and world give
the same numbers.

The floor: do the feet stand, does the figure turn, does it travel? These do not see whether a step
is a good one: a figure that slides along, or spins like a top, uses the floor as well.

Repetition: every pose is compared with every other, wherever the figure stands and whichever way it
faces. The matrix has a bright diagonal, because each pose equals itself; a loop of two seconds adds
bright lines two seconds beside it. A dance needs some repetition, as music does: compare with the
data's own value.

What an eye finds has no goal: compare it with that of the data or of a recording, for a figure that
does not move is perfect in some of them. Positions are in the world (metres, y up), those of
finished motions, for these are what one looks at. Where the noise of a capture would count, only
what is slower than 3 Hz is taken (`slow_part`).
Source: MoDiff IV-B, Tables I and II (bones); MoFusion 4.1 (repetitive dances, judged there by eye);
the others are ours.
Notebook: 08 (bones), 14
"""

import numpy as np
import scipy
from jaxtyping import Bool, Float

from ..motion.check import check_finite
from ..motion.root_frame import FPS, body_heading, estimate_root, forward_left, to_root_frame
from ..motion.skeleton import BONE_LENGTHS, HEELS, HIPS, PARENTS, TOES, check_joints, joint_index

# ---- bones ---------------------------------------------------------------------------------------
CM_PER_METRE = 100.0


def bone_lengths(positions: Float[np.ndarray, "*B T J 3"]) -> Float[np.ndarray, "*B T bones"]:
    """Length of every bone in every frame, in metres.

    l_b(t) = |p[t, b] - p[t, parent(b)]|, b = 1..20.

    Raises ValueError when the positions are not those of the course's 21 joints.
    """
    if positions.shape[-2] != len(PARENTS):
        raise ValueError(
            f"bones are measured on the course's {len(PARENTS)} joints, but these positions have "
            f"{positions.shape[-2]}: retarget the motion first (motion.retarget)"
        )
    positions = np.asarray(positions, np.float64)
    return np.linalg.norm(positions[..., 1:, :] - positions[..., PARENTS[1:], :], axis=-1)


def bone_rmse(
    positions: Float[np.ndarray, "*B T J 3"], reference: Float[np.ndarray, "bones"] = BONE_LENGTHS
) -> float:
    """The bone-length error in cm, over all clips, frames and bones together.

    RMSE = 100 * sqrt( mean over clips, t, b of (l_b(t) - reference_b)^2 ), lengths in metres.
    Constant errors and jitter both count. The paper says "RMSE (cm) of the bone length"; the
    formula is ours.
    Source: MoDiff IV-B, Table I.  Notebook: 08
    """
    return float(CM_PER_METRE * np.sqrt(np.mean((bone_lengths(positions) - reference) ** 2)))


def bone_rmse_within_clip(positions: Float[np.ndarray, "*B T J 3"]) -> float:
    """How much the bone lengths vary within a clip, in cm: the error against the clip's own means.

    RMSE = 100 * sqrt( mean over clips, t, b of (l_b(t) - mean_t l_b)^2 ). A figure that is too
    large but rigid has 0. This measure is ours, beside the paper's.
    """
    lengths = bone_lengths(positions)
    return float(CM_PER_METRE * np.sqrt(np.mean((lengths - lengths.mean(-2, keepdims=True)) ** 2)))


# ---- the floor -----------------------------------------------------------------------------------
STANDS = 0.15  # m/s: a Foot joint that is slower stands; a foot that rolls or turns is faster
TURN_SECONDS = 8.0  # four bars in four at 120 beats a minute: time for a dancer to face elsewhere
TRAVEL_SMOOTHING = 0.25  # seconds, as the root path of a recording (`root_frame`)


def standing_feet(positions: Float[np.ndarray, "T 21 3"], fps: float | int = FPS) -> float:
    """The share of time in which a foot stands, 0 to 1: the mean of both feet.

    A foot stands while its Foot joint is slower than 0.15 m/s, |p[t+1] - p[t-1]| fps / 2. 1 is a
    figure that never moves a foot; two recorded dances of CMU have 0.33 and 0.31.
    Raises ValueError for fewer than three frames, NaN, and another skeleton.
    """
    _check(positions)
    if len(positions) < 3:
        raise ValueError(
            f"whether a foot stands needs three frames, and this motion has {len(positions)}"
        )
    foot = positions[:, list(HEELS)]
    speed = np.linalg.norm(foot[2:] - foot[:-2], axis=-1) * fps / 2
    return float((speed < STANDS).mean())


def turning(
    positions: Float[np.ndarray, "T 21 3"],
    fps: float | int = FPS,
    seconds: float | int = TURN_SECONDS,
) -> float:
    """The angle within which a figure faces during `seconds`, in degrees.

    mean over all spans of that length of (largest - smallest heading in the span); the heading is
    unwrapped, and smoothed as in `root_frame.estimate_root`. A turn there and back counts once,
    and swaying counts as far as it goes; two full turns are 720.
    Raises ValueError for a shorter clip, NaN, and another skeleton.
    """
    _check(positions)
    span = round(seconds * fps)
    if len(positions) <= span:
        raise ValueError(
            f"turning within {seconds:g} s needs a longer clip than {len(positions) / fps:g} s"
        )
    heading = estimate_root(positions, fps)[1]
    windows = np.lib.stride_tricks.sliding_window_view(heading, span + 1)
    return float(np.degrees(np.ptp(windows, axis=-1).mean()))


def travel(positions: Float[np.ndarray, "T 21 3"], fps: float | int = FPS) -> float:
    """Mean horizontal speed of the pelvis in m/s, its velocity smoothed by a Gaussian of 0.25 s.

    A sway from foot to foot counts a little: 0 is a figure whose pelvis stays where it is.
    Raises ValueError for fewer than two frames, NaN, and another skeleton.
    """
    _check(positions)
    if len(positions) < 2:
        raise ValueError("a speed needs two frames, and this motion has one")
    velocity = np.diff(positions[:, 0][:, [0, 2]], axis=0) * fps
    smooth = scipy.ndimage.gaussian_filter1d(velocity, TRAVEL_SMOOTHING * fps, 0, mode="nearest")
    return float(np.linalg.norm(smooth, axis=-1).mean())


def _check(positions: Float[np.ndarray, "T 21 3"]) -> None:
    check_joints(positions)
    if not np.isfinite(positions).all():
        raise ValueError("positions contain NaN or infinity: fill or cut them first")


# ---- repetition ----------------------------------------------------------------------------------
LAGS = (1.0, 8.0)  # s: a shorter lag is a sway, and a short clip cannot show a longer one
OVERLAP = 2.0  # s to compare at each lag; a shorter overlap can agree by chance


def pose_changes(positions: Float[np.ndarray, "T 21 3"]) -> Float[np.ndarray, "T 63"]:
    """Poses with the pelvis above the origin, facing z in every frame, minus the clip's mean pose.

    In metres. The heading is that of hips and shoulders together.
    Raises ValueError for NaN.
    """
    if not np.isfinite(positions).all():
        raise ValueError(
            "positions contain NaN or infinity: fill or cut them before you look for repetition"
        )
    poses, _ = to_root_frame(positions, positions[:, HIPS][:, [0, 2]], body_heading(positions))
    flat = poses.reshape(len(poses), -1)
    return flat - flat.mean(0)


def self_similarity(positions: Float[np.ndarray, "T 21 3"]) -> Float[np.ndarray, "T T"]:
    """S[t, u] = <x_t, x_u> / (|x_t| |x_u|), with x the `pose_changes`.

    It is 1 for the same pose and -1 for the opposite one.
    Raises ValueError for NaN and for a figure that keeps one pose.  Notebook: 14
    """
    x = _moving(pose_changes(positions))
    x = x / np.maximum(np.linalg.norm(x, axis=1, keepdims=True), 1e-12)
    return x @ x.T


def autocorrelation(x: Float[np.ndarray, "T F"], lag: int) -> float:
    """Normalised autocorrelation of a motion at `lag` frames; 1 for a loop of that length.

    r = sum_t <x_t, x_{t+lag}> / sqrt(sum_t |x_t|^2 sum_t |x_{t+lag}|^2), summed over the overlap.
    """
    a, b = x[: len(x) - lag], x[lag:]
    return float((a * b).sum() / np.sqrt(max((a**2).sum() * (b**2).sum(), 1e-24)))


def repeat_score(positions: Float[np.ndarray, "T 21 3"], fps: float | int = FPS) -> float:
    """The largest `autocorrelation` at 1 to 8 seconds: 1 for a loop, near 0 for noise.

    A clip of T seconds shows lags up to T - 2 s, so compare only clips of one length. Smooth
    movement without repetition is still a little similar to itself by chance.
    Raises ValueError for a clip under 3 s, NaN, and a figure that keeps one pose.   Notebook: 14
    """
    x = _moving(pose_changes(positions))
    first, last = (round(lag * fps) for lag in LAGS)
    lags = range(first, min(last, len(x) - round(OVERLAP * fps)) + 1)
    if not lags:
        raise ValueError(
            f"{len(positions) / fps:g} s are too short for a lag of {LAGS[0]:g} s "
            f"with {OVERLAP:g} s to compare"
        )
    return max(autocorrelation(x, lag) for lag in lags)


def _moving(x: Float[np.ndarray, "T F"]) -> Float[np.ndarray, "T F"]:
    if np.abs(x).max() < 1e-6:
        raise ValueError("this figure keeps one pose, so no movement can repeat")
    return x


# ---- what an eye finds ---------------------------------------------------------------------------
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
    positions: Float[np.ndarray, "T 21 3"], beats: Float[np.ndarray, "K"], fps: float | int = FPS
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
    positions: Float[np.ndarray, "T 21 3"], keyframes: Bool[np.ndarray, "T"], fps: float | int = FPS
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
