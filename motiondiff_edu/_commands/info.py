"""Say what a file of motion holds: its length, how far and how fast it goes, what was put right."""

import argparse
from pathlib import Path

from . import outputs

HELP = "what a file holds"
EXAMPLE = "info my_walk.bvh"


def arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", type=Path, nargs="+", help="motions: .bvh or .npz")


def run(given: argparse.Namespace) -> None:
    for path in given.file:
        motion = outputs.reading(path)
        print(motion)
        for line in lines_of(motion):
            print(f"  {line}")


def lines_of(motion) -> list[str]:
    """What there is to say beside length and rate."""
    import numpy as np

    if not motion.known.all():
        missing = np.flatnonzero(~motion.known.all(0))
        return [f"missing at times: {', '.join(motion.skeleton.names[j] for j in missing)}"]
    ground = motion.positions[:, 0][:, [0, 2]]
    way = np.linalg.norm(np.diff(ground, axis=0), axis=1).sum()
    away, heights = np.linalg.norm(ground[-1] - ground[0]), motion.positions[..., 1]
    lines = [
        f"the root goes {way:.2f} m, {way / motion.seconds:.2f} m/s on average, and ends "
        f"{away:.2f} m from its start",
        f"height from {heights.min():.2f} to {heights.max():.2f} m",
    ]
    if motion.audio is not None:
        lines.append(f"sound at {motion.sample_rate} Hz")
    return lines
