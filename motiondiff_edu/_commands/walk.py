"""Continue a recorded walk. The control is a list of segments, separated by semicolons. A segment
is a duration and a forward speed in m/s, then optionally left or right with a speed in m/s, and
turn with a rate in rad/s (positive turns to the left). The output has only the new frames; --joined
adds the given frames before them."""

import argparse

from . import control_words, outputs

HELP = "continue a recorded walk along a control"
EXAMPLE = 'walk my_walk.bvh --control "3s 1.2; 4s 1.0 turn 0.6" --out more.bvh'


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `walk`."""
    outputs.add_file(parser, "the walk to continue")
    parser.add_argument(
        "--control", required=True, metavar="SEGMENTS", help='for example "3s 1.2; 4s 1.0 turn 0.6"'
    )
    parser.add_argument("--joined", action="store_true", help="write the given frames as well")
    outputs.add_out(parser)
    outputs.add_draws(parser, "continuations")


def run(args: argparse.Namespace) -> None:
    """Continue the walk, and write the results."""
    segments = control_words.parse(args.control)
    paths = outputs.output_paths(args.out, args.overwrite, args.samples, args.file)
    motion = outputs.read(args.file, args)
    from .. import joystick, load

    outputs.say("walking")
    made = load("walker").walk(motion, joystick(segments), samples=args.samples, seed=args.seed)
    made = outputs.as_list(made)
    if args.joined:
        before = motion.resampled(made[0].fps)
        made = [before.then(more) for more in made]
    outputs.write_all(made, paths, args.fps)
