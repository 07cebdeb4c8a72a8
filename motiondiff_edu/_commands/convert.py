"""Convert a motion from one file format to another. The endings of the two names say which. A BVH
file is retargeted to the course's skeleton and resampled to 20 frames a second."""

import argparse
from pathlib import Path

from . import outputs

HELP = "convert a motion from one file format to another"
EXAMPLE = "convert my_walk.bvh my_walk.mp4"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `convert`."""
    outputs.add_file(parser)
    parser.add_argument(
        "out",
        type=Path,
        help=f"the file to write: {outputs.endings()}; or a folder, for several files",
    )
    parser.add_argument(
        "--joints",
        metavar="NAMES",
        default="",
        help="BVH: joints whose names are not recognised, such as LeftArm=arm_l,RightArm=arm_r",
    )
    parser.add_argument(
        "--file-fps",
        type=float,
        metavar="FPS",
        help="BVH: the frames a second, if the file is wrong",
    )
    outputs.add_fps(parser)
    outputs.add_overwrite(parser)


def run(args: argparse.Namespace) -> None:
    """Write the motion in the other format."""
    mapping = _mapping(args.joints)
    paths = outputs.output_paths(args.out, args.overwrite, source=args.file)
    outputs.write_all(
        outputs.read(args.file, args, mapping=mapping, file_fps=args.file_fps), paths, args.fps
    )


def _mapping(names: str) -> dict[str, str] | None:
    """{joint of the course: joint of the file}, or None for no names."""
    pairs = [pair.split("=") for pair in names.split(",") if pair.strip()]
    wrong = next((pair for pair in pairs if len(pair) != 2), None)
    if wrong:
        raise ValueError(f"--joints {'='.join(wrong)}: write JOINT=NAME, such as LeftArm=arm_l")
    return {ours.strip(): theirs.strip() for ours, theirs in pairs} or None
