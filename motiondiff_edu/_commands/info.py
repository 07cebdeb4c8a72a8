"""Describe a motion file: its length, the distance and speed of the figure, what was corrected
while the file was read, and which of its joints were taken for which."""

import argparse
from pathlib import Path

from . import outputs

HELP = "describe a motion file"
EXAMPLE = "info my_walk.bvh"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `info`."""
    parser.add_argument("file", type=Path, nargs="+", help="motions: .bvh, .npz, .npy or .pkl")


def run(args: argparse.Namespace) -> None:
    """Describe every file that can be read; then raise ValueError if there was another."""
    faulty = 0
    for path in args.file:
        try:
            motion = outputs.read(path)
        except (ValueError, OSError) as error:
            if len(args.file) == 1:
                raise
            faulty += 1
            outputs.say(f"  {error}")
            continue
        print(motion)
        for line in [*lines_of(motion), *joints_of(path)]:
            print(f"  {line}")
    if faulty:
        raise ValueError(f"{faulty} of {len(args.file)} files cannot be read")


def lines_of(motion) -> list[str]:
    """Facts about a motion beside its length and frame rate."""
    import numpy as np

    if not motion.known.all():
        missing = np.flatnonzero(~motion.known.all(0))
        names = ", ".join(motion.skeleton.names[j] for j in missing)
        return [f"joints with missing positions: {names}"]
    ground = motion.positions[:, 0][:, [0, 2]]
    distance = np.linalg.norm(np.diff(ground, axis=0), axis=1).sum()
    away, heights = np.linalg.norm(ground[-1] - ground[0]), motion.positions[..., 1]
    lines = [
        f"the root moves {distance:.2f} m, {distance / motion.seconds:.2f} m/s on average, and "
        f"ends {away:.2f} m from its start",
        f"the joints are between {heights.min():.2f} and {heights.max():.2f} m high",
    ]
    if motion.audio is not None:
        lines.append(f"sound at {motion.sample_rate} Hz")
    return lines


def joints_of(path: Path) -> list[str]:
    """What is in a BVH file, and which of its joints was taken for which of the course."""
    from motiondiff_edu.motion.bvh import read_bvh
    from motiondiff_edu.motion.dialects import guess_mapping

    if path.suffix.lower() != ".bvh":
        return []
    bvh = read_bvh(path)
    found = guess_mapping(bvh)
    other = [f"{ours} is {own}" for ours, own in found.items() if ours != own]
    lines = [
        f"in the file: {len(bvh.frames)} frames at {bvh.fps:g} frames/s, {len(bvh.joints)} joints",
        f"joints by the course's names: {len(found) - len(other)}",
    ]
    return [*lines, f"joints by other names: {', '.join(other)}"] if other else lines
