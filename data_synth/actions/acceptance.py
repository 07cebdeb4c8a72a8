"""Do the actions hold? The worst of many clips, and every join of two acts of the legs.

python -m data_synth.actions.acceptance [--clips 200]
"""

import argparse
from itertools import product

import numpy as np
from jaxtyping import Float

from motiondiff_edu.motion.cleanup import runs

from ..walking.own_measures import bone_error, knee_angles, planted_slip
from .acts import VERBS, Act, Phrase
from .dataset import clips
from .performance import Acted, act_out

LEGS = tuple(
    Act(name, side="left" if "left" in verb.sides else "", count=min(2, verb.most))
    for name, verb in VERBS.items()
    if verb.kind != "arms"
)
QUIET = 0.25  # m/s: slower than this in every joint, a figure stands still
PAIR_SECONDS = 10.0


def joins(seed: int = 0) -> dict[tuple[str, str], Acted]:
    """A clip for every ordered pair of acts of the legs that can follow one another."""
    return {
        (a.verb, b.verb): act_out((Phrase(a), Phrase(b)), PAIR_SECONDS, seed)
        for a, b in product(LEGS, LEGS)
        if b.verb != ("sit" if a.verb == "sit" else "rise") or (a.verb, b.verb) == ("sit", "rise")
    }


def measures(acted: Acted) -> dict[str, float]:
    """Slip of a planted toe (mm a frame), lowest joint (mm), bones (m), knees, speeds, jolts."""
    p = acted.positions
    knees = knee_angles(p)
    return {
        "slip_mm": 1e3 * planted_slip(p, acted.contacts),
        "lowest_mm": float(1e3 * p[..., 1].min()),
        "bone_m": bone_error(p),
        "knee_smallest": float(knees.min()),
        "knee_largest": float(knees.max()),
        "fastest_mps": float(speeds(acted).max()),
        "jolt_mps2": float(np.linalg.norm(np.diff(p, 2, axis=0), axis=-1).max() * acted.fps**2),
    }


def speeds(acted: Acted) -> Float[np.ndarray, "n 21"]:
    """Of every joint, m/s."""
    return np.linalg.norm(np.diff(acted.positions, axis=0), axis=-1) * acted.fps


def stands_between(acted: Acted) -> float:
    """Seconds for which the figure stands still between two acts of its legs, at the longest."""
    still = speeds(acted).max(1) < QUIET
    legs = [span for span in acted.spans if VERBS[span.act.verb].kind != "arms"]
    longest = 0.0
    for a, b in zip(legs, legs[1:], strict=False):
        if "stand" in (a.act.verb, b.act.verb) or a.act.verb == "sit":  # who sits, sits still
            continue
        first, last = round(a.last * acted.fps), round((b.first + 0.2) * acted.fps)
        for begun, ended in runs(still[first:last]):
            longest = max(longest, (ended - begun) / acted.fps)
    return longest


def worst(rows: list[dict[str, float]]) -> dict[str, float]:
    """The worst of each measure."""
    small = ("lowest_mm", "knee_smallest")
    return {name: (min if name in small else max)(row[name] for row in rows) for name in rows[0]}


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="python -m data_synth.actions.acceptance")
    parser.add_argument("--clips", type=int, default=200)
    given = parser.parse_args()
    pairs = joins()
    print(
        "joins:", {k: round(v, 3) for k, v in worst([measures(a) for a in pairs.values()]).items()}
    )
    print("stands between acts for at most", max(map(stands_between, pairs.values())), "s")
    rows = [measures(clip.acted) for clip in clips(given.clips, 0)]
    print("clips:", {k: round(v, 3) for k, v in worst(rows).items()})
