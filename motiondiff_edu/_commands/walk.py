"""Continue a walk under a control: seconds and speed ahead (m/s), then left, right (m/s) or turn
(rad/s, to the left), with semicolons between the pieces. Written are the new frames; --joined puts
the given ones before them."""

import argparse
from pathlib import Path

from . import control_words, outputs

HELP = "continue a recorded walk as you steer it"
EXAMPLE = 'walk my_walk.bvh --control "3s 1.2; 4s 1.0 turn 0.6" --out more.bvh'


def arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", type=Path, help="the walk to continue: .bvh or .npz")
    parser.add_argument("--control", required=True, metavar="WORDS", help="where to go")
    parser.add_argument("--joined", action="store_true", help="write the given frames as well")
    outputs.add_out(parser)
    outputs.add_draws(parser, "continuations")


def run(given: argparse.Namespace) -> None:
    segments = control_words.parse(given.control)
    paths = outputs.free_names(given.out, given.overwrite, given.samples)
    motion = outputs.reading(given.file)
    from .. import joystick, load

    outputs.say("walking")
    made = load("walker").walk(motion, joystick(segments), samples=given.samples, seed=given.seed)
    made = made if isinstance(made, list) else [made]
    if given.joined:
        before = motion.resampled(made[0].fps)
        made = [before.then(more) for more in made]
    outputs.write_all(made, paths)
