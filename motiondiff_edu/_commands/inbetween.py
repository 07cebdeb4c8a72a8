"""Keep every N-th frame of a motion as a keyframe, and make all frames between them anew."""

import argparse
from pathlib import Path

from . import outputs

HELP = "keep keyframes and make what lies between them"
EXAMPLE = "inbetween walk.bvh --every 20 --samples 3 --out made.bvh"


def arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", type=Path, help="a motion: .bvh or .npz")
    parser.add_argument(
        "--every", type=int, default=20, metavar="N", help="a keyframe every N frames (default: 20)"
    )
    outputs.add_out(parser)
    outputs.add_draws(parser, "versions")


def run(given: argparse.Namespace) -> None:
    paths = outputs.free_names(given.out, given.overwrite, given.samples)
    motion = outputs.reading(given.file)
    from .. import inbetween, keyframes

    outputs.say("filling in")
    known = keyframes(motion, every=given.every)
    outputs.write_all(inbetween(motion, known, samples=given.samples, seed=given.seed), paths)
