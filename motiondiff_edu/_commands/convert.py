"""Convert a motion from one file format to another. The endings of the two names say which. A BVH
file is retargeted to the course's skeleton and resampled to 20 frames a second."""

import argparse
from pathlib import Path

from . import outputs

HELP = "convert a motion from one file format to another"
EXAMPLE = "convert my_walk.bvh my_walk.mp4"


def arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", type=Path, help="a motion: .bvh or .npz")
    parser.add_argument("out", type=Path, help=f"the file to write: {outputs.endings()}")
    outputs.add_overwrite(parser)


def run(args: argparse.Namespace) -> None:
    paths = outputs.output_paths(args.out, args.overwrite)
    outputs.write_all(outputs.read(args.file), paths)
