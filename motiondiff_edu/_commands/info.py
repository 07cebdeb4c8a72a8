"""Describe a motion file: its length, the distance and speed of the figure, what was corrected
while the file was read, and which of its joints were taken for which."""

import argparse
from pathlib import Path

from . import outputs

HELP = "describe a motion file"
EXAMPLE = "info my_walk.bvh"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `info`."""
    outputs.add_file(parser, "motions", together=True)


def run(args: argparse.Namespace) -> None:
    """Describe every file that can be read; then raise ValueError if there was another."""
    paths, faulty = outputs.files(args.file), 0
    for path in paths:
        try:
            motion = outputs.read(path, args)
        except (ValueError, OSError) as error:
            if len(paths) == 1:
                raise
            faulty += 1
            outputs.say(f"  {error}")
            continue
        print(motion)
        for line in [*lines_of(motion), *joints_of(path)]:
            print(f"  {line}")
    if faulty:
        raise ValueError(f"{faulty} of {len(paths)} files cannot be read")


def lines_of(motion) -> list[str]:
    """Facts about a motion beside its length and frame rate."""
    import numpy as np

    said = [motion.about] if motion.about else []
    said += [f"note: {note}" for note in motion.notes]
    if not motion.known.all():
        missing = np.flatnonzero(~motion.known.all(0))
        names = ", ".join(motion.skeleton.names[j] for j in missing)
        return [*said, f"joints with missing positions: {names}"]
    ground = motion.positions[:, 0][:, [0, 2]]
    distance = np.linalg.norm(np.diff(ground, axis=0), axis=1).sum()
    away, heights = np.linalg.norm(ground[-1] - ground[0]), motion.positions[..., 1]
    lines = [
        *said,
        f"the root moves {distance:.2f} m, {distance / motion.seconds:.2f} m/s on average, and "
        f"ends {away:.2f} m from its start",
        f"the joints are between {heights.min():.2f} and {heights.max():.2f} m high",
    ]
    if motion.audio is not None:
        lines.append(f"sound at {motion.sample_rate} Hz")
    return lines


def joints_of(path: Path) -> list[str]:
    """What is in a file that is retargeted, and which of its joints was taken for which."""
    described = {".bvh": bones_of, ".npz": names_of, ".pkl": names_of}.get(path.suffix.lower())
    return described(path) if described else []


def bones_of(path: Path) -> list[str]:
    """Of a BVH file."""
    from motiondiff_edu.motion.formats.bvh import read_bvh
    from motiondiff_edu.motion.formats.dialects import guess_mapping

    bvh = read_bvh(path)
    found = guess_mapping(bvh)
    other = [f"{ours} is {own}" for ours, own in found.items() if ours != own]
    lines = [
        counts(len(bvh.frames), bvh.fps, len(bvh.joints)),
        f"joints by the course's names: {len(found) - len(other)}",
    ]
    return [*lines, f"joints by other names: {', '.join(other)}"] if other else lines


def names_of(path: Path) -> list[str]:
    """Of a file whose joints are known by their names alone; nothing for one of our own."""
    from motiondiff_edu.motion.formats.files import named_joints
    from motiondiff_edu.motion.formats.keypoints import sources_of
    from motiondiff_edu.motion.skeleton import JOINTS

    there = named_joints(path)
    if there is None:
        return []
    names, frames, fps = there
    found = sources_of(names)
    taken = ", ".join(f"{ours} is {' + '.join(own)}" for ours, own in found.items())
    computed = ", ".join(joint for joint in JOINTS if joint not in found)
    lines = [counts(frames, fps, len(names)), f"joints by their names: {taken}"]
    return [*lines, f"joints computed from the others: {computed}"] if computed else lines


def counts(frames: int, fps: float, joints: int) -> str:
    """How much there is in a file."""
    return f"in the file: {frames} frames at {fps:g} frames/s, {joints} joints"
