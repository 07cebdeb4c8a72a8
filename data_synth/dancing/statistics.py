"""The measures of a dance, the same for ours and for real ones.

They take world positions in metres, at 20 frames/s.

The range of real dances was measured with these functions, and holds only for them. Three of them
differ a little from similar functions in motiondiff_edu.metrics: `joint_speed`, `kinematic_beats`
and `root_frame` say how.
"""

import numpy as np
from jaxtyping import Bool, Float
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d
from scipy.signal import argrelmin, welch

from motiondiff_edu.metrics.bodies import (
    TURN_SECONDS,
    autocorrelation,
    standing_feet,
    travel,
    turning,
)
from motiondiff_edu.motion.skeleton import HEELS, joint_index

SMOOTHING = 0.083  # seconds, of the mean joint speed before its minima are taken
FINE = 3  # the speed is resampled this many times finer before its minima are timed


def joint_speed(world: Float[np.ndarray, "T 21 3"], fps: float) -> Float[np.ndarray, "T2"]:
    """Mean joint speed, in m/s.

    It is the mean over joints of |p(t + 1) - p(t - 1)| fps / 2, for frames with two neighbours.

    `metrics.dances.mean_speed` uses a single step: quick movements count more there.
    """
    return np.linalg.norm(world[2:] - world[:-2], axis=-1).mean(-1) * fps / 2


def kinematic_beats(
    world: Float[np.ndarray, "T 21 3"], fps: float = 20.0
) -> Float[np.ndarray, "N"]:
    """Times (s) of the local minima of the mean joint speed.

    The speed is smoothed by a Gaussian of SMOOTHING; the times come from a cubic spline.

    `metrics.dances.kinematic_beats` first resamples the motion itself to 60 frames/s, and so finds
    stops that the two-frame speed misses: 2 % more on our dances.
    """
    speed = gaussian_filter1d(joint_speed(world, fps), SMOOTHING * fps)
    t = (1 + np.arange(len(speed))) / fps
    fine = np.arange(t[0], t[-1], 1 / (FINE * fps))
    return fine[argrelmin(CubicSpline(t, speed)(fine))[0]]


def looks_planted(world: Float[np.ndarray, "T 21 3"], fps: float) -> Bool[np.ndarray, "T2 2"]:
    """Foot joints slower than 0.3 m/s and lower than 60 mm over their 10th percentile."""
    foot = world[:, list(HEELS)]
    speed = np.linalg.norm(foot[2:] - foot[:-2], axis=-1) * fps / 2
    return (speed < 0.3) & (foot[1:-1, :, 1] < np.percentile(foot[..., 1], 10, axis=0) + 0.06)


def _across(world: Float[np.ndarray, "T 21 3"], fps: float) -> Float[np.ndarray, "T 2"]:
    """The horizontal line (x, z) across hips and shoulders, to the left, of length 1."""
    across = sum(
        world[:, joint_index("Left" + n)] - world[:, joint_index("Right" + n)]
        for n in ("UpLeg", "Arm")
    )
    across = gaussian_filter1d(across[:, [0, 2]], 0.1 * fps, axis=0, mode="nearest")
    return across / np.linalg.norm(across, axis=-1, keepdims=True)


def root_frame(world: Float[np.ndarray, "T 21 3"], fps: float) -> Float[np.ndarray, "T 63"]:
    """Joints minus hips, turned so that hips and shoulders face z (smoothed by 0.1 s).

    `metrics.bodies.pose_changes` keeps the height of the hips, and does not smooth.
    """
    left = _across(world, fps)
    p = world - world[:, :1]
    x = p[..., 0] * left[:, :1] + p[..., 2] * left[:, 1:]
    z = -p[..., 0] * left[:, 1:] + p[..., 2] * left[:, :1]
    return np.stack([x, p[..., 1], z], -1).reshape(len(p), -1)


def repeats(world: Float[np.ndarray, "T 21 3"], fps: float = 20.0, least: float = 0.5) -> float:
    """The highest autocorrelation of the root-frame pose; 1 is a loop.

    Lags go from `least` seconds to half the dance.
    """
    x = root_frame(world, fps)
    x = x - x.mean(0)
    lags = range(round(least * fps), len(x) // 2)
    return max(autocorrelation(x, lag) for lag in lags)


def statistics(world: Float[np.ndarray, "T 21 3"], fps: float = 20.0) -> dict[str, float]:
    """The measures of the acceptance table; metres, seconds, shares."""
    speed = joint_speed(world, fps)
    planted = looks_planted(world, fps)
    local = root_frame(world, fps)
    share = np.cumsum(np.linalg.svd(local - local.mean(0), compute_uv=False) ** 2)
    velocity = np.diff(local, axis=0) * fps
    f, power = welch(velocity, fps, "hann", min(len(velocity), round(4 * fps)), axis=0)
    power = power.sum(1)
    hips = np.percentile(world[:, 0, 1], (5, 95))
    return {
        "speed": float(speed.mean()),
        "speed_sd": float(speed.std() / speed.mean()),
        "each_planted": float(planted.mean()),
        "neither_planted": float((~planted).all(1).mean()),
        "hips_spread": float(hips[1] - hips[0]),
        "beats_per_second": len(kinematic_beats(world, fps)) / (len(world) / fps),
        "pca95": float(np.searchsorted(share / share[-1], 0.95) + 1),
        "jerk": float(np.linalg.norm(np.diff(world, 3, axis=0), axis=-1).mean() * fps**3),
        "power4": float(power[f <= 4].sum() / power.sum()),
        "standing_feet": standing_feet(world, fps),
        "turn_8s": turning(world, fps, min(TURN_SECONDS, (len(world) - 1) / fps)),
        "travel": travel(world, fps),
    }
