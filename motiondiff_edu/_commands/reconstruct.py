"""Reconstruct joints that are missing from a recording. --missing names them; without it they are
the positions that the file itself lacks (NaN in an npz). The pelvis (Hips) must be known in every
frame."""

import argparse
import re

from . import outputs

HELP = "reconstruct missing joints"
EXAMPLE = (
    "reconstruct my_walk.bvh --missing RightArm,RightForeArm,RightHand --frames 20-39 "
    "--out whole.bvh"
)


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `reconstruct`."""
    outputs.add_file(parser, frames=False)
    parser.add_argument(
        "--missing",
        metavar="JOINTS",
        nargs="+",
        help="the joints to reconstruct, separated by commas or spaces",
    )
    parser.add_argument(
        "--frames",
        dest="missing_frames",
        metavar="A-B",
        help="where they are missing: frames A to B, both included, or one frame; separate several "
        "spans by commas (default: all frames)",
    )
    outputs.add_out(parser)
    outputs.add_draws(parser, "reconstructions")


def run(args: argparse.Namespace) -> None:
    """Make the missing joints, and write the results."""
    frames = outputs.spans(args.missing_frames)
    if args.missing_frames and not args.missing:
        raise ValueError("--frames needs --missing, which names the joints")
    joints = [name for name in re.split(r"[,\s]+", " ".join(args.missing or [])) if name]
    if args.missing and not joints:
        raise ValueError("--missing names no joint")
    from ..motion.skeleton import COURSE

    for name in joints:
        COURSE.index(name)  # an unknown one is told before anything is read
    paths = outputs.output_paths(args.out, args.overwrite, args.samples, args.file)
    motion = outputs.read(args.file, args)
    from .. import reconstruct

    known = motion.known
    for first, last in frames if joints else []:
        known &= motion.all_but(joints, first, last)
    if known.all():
        raise ValueError(f"{args.file} lacks no joint: name some, such as --missing LeftHand")
    outputs.say(f"reconstructing {int((~known).sum())} joint positions")
    outputs.write_all(
        reconstruct(motion, known, samples=args.samples, seed=args.seed), paths, args.fps
    )
