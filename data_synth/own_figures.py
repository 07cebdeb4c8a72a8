"""What the walking data themselves score: spread of continuations, adherence, skating, lean in turns.

These stand beside every figure of a network that was trained on them.
"""

import numpy as np
from jaxtyping import Float

from motiondiff_edu.metrics.adherence import adherence
from motiondiff_edu.metrics.diversity import spread
from motiondiff_edu.metrics.skating import skating

from .gait_statistics import turning_lean
from .walking import continuations, dataset, random_control, walk


def spreads(pasts: int, n: int, seconds: float, seed: int = 0) -> Float[np.ndarray, "pasts"]:
    """Root-frame RMS spread (m) from 1 s on of n continuations, for `pasts` pasts and the controls they had anyway."""
    found = []
    for k, whole in enumerate(dataset(pasts, 4 + seconds, seed)):
        later = continuations(whole.cut(70, 80), whole.control[80:], n, seed + k)
        found.append(spread(np.stack([c.poses for c in later])))
    return np.array(found)


def own_figures(clips: int = 60, pasts: int = 20, n: int = 50, seconds: float = 12.0) -> dict[str, float]:
    """Means over clips: spread (m), adherence and skating (m/s), slope and correlation of the lean in turns."""
    apart, walks = spreads(pasts, n, seconds), dataset(clips, seconds, 1)
    out = {"spread_m": apart.mean(), "spread_smallest_m": apart.min(), "spread_largest_m": apart.max()}
    out["adherence_mps"] = np.mean([adherence(c.poses, c.control) for c in walks])
    out["skating_mps"] = np.nanmean([skating(c.poses, c.control) for c in walks])
    turns = [random_control(20.0, np.random.default_rng([2, k]), "turn") for k in range(12)]
    lean = np.array([turning_lean(walk(c, k, "neutral").world()) for k, c in enumerate(turns)])
    out["turning_lean_slope"], out["turning_lean_r"] = lean.mean(0)
    return {name: float(value) for name, value in out.items()}
