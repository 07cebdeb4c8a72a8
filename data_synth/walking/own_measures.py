"""The scores of the walking data themselves.

They are the spread of continuations, adherence, skating and the lean in turns, with their limits.
Every number of a network that was trained on these data is compared with them.
"""

import time

import numpy as np
from jaxtyping import Bool, Float

from motiondiff_edu.metrics.bodies import bone_lengths
from motiondiff_edu.metrics.distributions import spread
from motiondiff_edu.metrics.walks import adherence, skating
from motiondiff_edu.motion.clip import Clip
from motiondiff_edu.motion.skeleton import BONE_LENGTHS, TOES

from .gait_statistics import turning_lean
from .walks import continuations, dataset, random_control, walk


def spreads(pasts: int, n: int, seconds: float, seed: int = 0) -> Float[np.ndarray, "pasts"]:
    """Root-frame RMS spread (m) of n continuations, from 1 s on, for each of `pasts` pasts.

    Each past has its own control.
    """
    found = []
    for k, whole in enumerate(dataset(pasts, 4 + seconds, seed)):
        later = continuations(whole.cut(70, 80), whole.control[80:], n, seed + k)
        found.append(spread(np.stack([c.poses for c in later])))
    return np.array(found)


def own_measures(
    clips: int = 60, pasts: int = 20, n: int = 50, seconds: float = 12.0
) -> dict[str, float]:
    """Means over clips of spread (m), adherence, skating (m/s), and of the lean in turns
    (slope and correlation).
    """
    apart = spreads(pasts, n, seconds)
    walks = dataset(clips, seconds, 1)
    out = {
        "spread_m": apart.mean(),
        "spread_smallest_m": apart.min(),
        "spread_largest_m": apart.max(),
    }
    out["adherence_mps"] = np.mean([adherence(c.poses, c.control) for c in walks])
    out["skating_mps"] = np.nanmean([skating(c.poses, c.control) for c in walks])
    turns = [random_control(20.0, np.random.default_rng([2, k]), "turn") for k in range(12)]
    lean = np.array([turning_lean(walk(c, k, "neutral").world()) for k, c in enumerate(turns)])
    out["turning_lean_slope"], out["turning_lean_r"] = lean.mean(0)
    return {name: float(value) for name, value in out.items()}


def limits(clips: int = 600, seconds: float = 12.0, spots: int = 60) -> dict[str, float]:
    """The largest values in any frame of `clips` walks.

    Also the smallest distance of the feet in `spots` fast turns, and the speed of generation.
    """
    begun = time.process_time()
    walks = dataset(clips, seconds, 1)
    out = {"made_per_cpu_second": clips * seconds / (time.process_time() - begun)}
    knees = np.concatenate([knee_angles(c.poses) for c in walks])
    controls = np.concatenate([c.control for c in walks])
    out |= {"knee_smallest_deg": knees.min(), "knee_largest_deg": knees.max()}
    out["lowest_joint_mm"] = 1e3 * min(c.poses[..., 1].min() for c in walks)
    feet = [(c.world(), c.contacts) for c in walks if c.contacts is not None]
    out["planted_toe_mm_a_frame"] = 1e3 * max(planted_slip(*both) for both in feet)
    out["bone_error_m"] = max(bone_error(c.poses) for c in walks)
    out |= {"ahead_slowest_mps": controls[:, 0].min(), "ahead_fastest_mps": controls[:, 0].max()}
    out["aside_mps"] = np.abs(controls[:, 1]).max()
    out["turning_dps"] = np.degrees(np.abs(controls[:, 2]).max())
    out["speed_times_turning_mps2"] = np.abs(controls[:, 0] * controls[:, 2]).max()
    near = np.concatenate(
        [feet_apart(c)[fast] for c, fast in (_spot(k, seconds) for k in range(spots))]
    )
    out |= {"feet_within_4cm": (near < 0.04).mean(), "feet_nearest_cm": 100 * near.min()}
    return {name: float(value) for name, value in out.items()}


def knee_angles(positions: Float[np.ndarray, "T 21 3"]) -> Float[np.ndarray, "T 2"]:
    """Bend of the knees (degrees, 0 is straight), left and right."""
    thigh = positions[:, [2, 6]] - positions[:, [1, 5]]
    shank = positions[:, [3, 7]] - positions[:, [2, 6]]
    cos = (thigh * shank).sum(-1) / np.linalg.norm(thigh, axis=-1) / np.linalg.norm(shank, axis=-1)
    return np.degrees(np.arccos(np.clip(cos, -1, 1)))


def planted_slip(world: Float[np.ndarray, "T 21 3"], contacts: Bool[np.ndarray, "T 2"]) -> float:
    """The largest movement of a planted toe in one frame (m)."""
    moved = np.linalg.norm(np.diff(world[:, TOES], axis=0), axis=-1)
    return float((moved * (contacts[1:] & contacts[:-1])).max())


def bone_error(positions: Float[np.ndarray, "T 21 3"]) -> float:
    """The largest difference of a bone from its length (m)."""
    return float(np.abs(bone_lengths(positions) - BONE_LENGTHS).max())


def feet_apart(clip: Clip) -> Float[np.ndarray, "T"]:
    """Smallest distance (m) between the ankle-to-toe lines of both feet, at eleven points each."""
    share = np.linspace(0, 1, 11)[:, None]
    left, right = (
        p[:, :1] + share * (p[:, 1:] - p[:, :1]) for p in (clip.poses[:, 3:5], clip.poses[:, 7:9])
    )
    return np.linalg.norm(left[:, :, None] - right[:, None], axis=-1).min((1, 2))


def _spot(k: int, seconds: float) -> tuple[Clip, np.ndarray]:
    """A walk on the spot, and its frames that turn at 100 degrees/s or more."""
    clip = walk(random_control(seconds, np.random.default_rng([5, k]), "spot"), k)
    return clip, np.abs(clip.control[:, 2]) >= np.radians(100)
