"""Generate a motion from a sentence. The figure begins at the origin, facing z. Unknown words are
reported, and so are words that are read as others. The sentence is put into quotes."""

import argparse

from . import outputs

HELP = "do what a sentence says"
EXAMPLE = 'act "walks forward, then waves with the left hand" --out act.bvh'


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `act`."""
    parser.add_argument("text", help="the sentence, in quotes")
    parser.add_argument(
        "--seconds",
        type=float,
        metavar="S",
        help="the length of the motion, from 2 to 10 s (default: what its acts take)",
    )
    parser.add_argument(
        "--guidance",
        type=float,
        default=1.0,
        metavar="W",
        help="above 1 the motion follows the sentence more closely, and differs less (default: 1)",
    )
    outputs.add_out(parser)
    outputs.add_draws(parser, "motions")


def run(args: argparse.Namespace) -> None:
    """Make the motions, and write them."""
    paths = outputs.output_paths(args.out, args.overwrite, args.samples)
    from .. import load
    from ..performers.mover import checked_length

    if args.seconds is not None:
        checked_length(args.seconds)
    how = {"seconds": args.seconds, "guidance": args.guidance}
    made = load("mover").act(args.text, samples=args.samples, seed=args.seed, **how)
    outputs.write_acts(made, paths, args.fps)
