"""Bring a motion from one kind of file to another, by their names' endings. A BVH file is brought
to the course's skeleton and 20 frames a second on its way."""

import argparse
from pathlib import Path

from . import outputs

HELP = "from one kind of file to another"
EXAMPLE = "convert my_walk.bvh my_walk.mp4"


def arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", type=Path, help="a motion: .bvh or .npz")
    parser.add_argument("out", type=Path, help="what to write")
    outputs.add_overwrite(parser)


def run(given: argparse.Namespace) -> None:
    paths = outputs.free_names(given.out, given.overwrite)
    outputs.write_all(outputs.reading(given.file), paths)
