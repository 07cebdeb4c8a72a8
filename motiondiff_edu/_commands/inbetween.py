"""Keep every N-th frame of a motion as a keyframe, and generate the frames between them. The first
and the last frame are keyframes too."""

import argparse

from . import outputs

HELP = "keep keyframes and generate the frames between them"
EXAMPLE = "inbetween my_walk.bvh --every 20 --samples 3 --out made.bvh"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `inbetween`."""
    outputs.add_file(parser)
    parser.add_argument(
        "--every",
        type=int,
        default=20,
        metavar="N",
        help="a keyframe every N frames (default: 20); 1 fills in the frames that the file lacks",
    )
    outputs.add_out(parser)
    outputs.add_draws(parser, "versions")


def run(args: argparse.Namespace) -> None:
    """Fill in between the keyframes, and write the results."""
    paths = outputs.output_paths(args.out, args.overwrite, args.samples, args.file)
    motion = outputs.read(args.file, args)
    from .. import inbetween, keyframes

    outputs.say("generating the frames between the keyframes")
    known = keyframes(motion, every=args.every)
    outputs.write_all(inbetween(motion, known, samples=args.samples, seed=args.seed), paths)
