"""Keep some frames of a motion as keyframes, every N-th or those of --at, and generate the frames
between them. The first and the last frame are keyframes too."""

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
    parser.add_argument(
        "--at",
        metavar="FRAMES",
        help="keyframes at these frames instead, such as 12,40-44,70 (20 frames a second)",
    )
    outputs.add_out(parser)
    outputs.add_draws(parser, "versions")


def run(args: argparse.Namespace) -> None:
    """Fill in between the keyframes, and write the results."""
    spans = outputs.spans(args.at, "--at") if args.at else []
    paths = outputs.output_paths(args.out, args.overwrite, args.samples, args.file)
    motion = outputs.read(args.file, args)
    from .. import inbetween, keyframes

    outputs.say("generating the frames between the keyframes")
    at = [frame for first, end in spans for frame in range(first, end or len(motion))]
    known = keyframes(motion, every=args.every, at=at or None)
    outputs.write_all(
        inbetween(motion, known, samples=args.samples, seed=args.seed), paths, args.fps
    )
