"""Change a motion by a sentence, which says what the whole figure does, the legs included: "walks
forward while clapping". --keep keeps a part of the body as it is, such as the legs and the path.
The sentence is put into quotes."""

import argparse

from . import outputs

HELP = "change a motion by a sentence"
EXAMPLE = 'edit my_walk.bvh "walks forward while clapping" --keep "lower body" --out clap.bvh'


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `edit`."""
    outputs.add_file(parser, "a motion of 2 to 10 s", count=1)
    parser.add_argument("text", help="the sentence, in quotes")
    parser.add_argument(
        "--keep",
        metavar="PART",
        help='a part of the body that stays: "upper body", "lower body" or "trajectory"; the '
        "path of the pelvis stays with it, so the sentence should change the other parts alone, "
        "along that path",
    )
    parser.add_argument(
        "--strength",
        type=float,
        default=0.3,
        metavar="X",
        help="how much noise the motion gets before it is denoised: above 0; with 1 nothing but "
        "what is kept is left (default: 0.3)",
    )
    outputs.add_out(parser)
    outputs.add_draws(parser, "motions")


def run(args: argparse.Namespace) -> None:
    """Edit the motion, and write the results."""
    paths = outputs.output_paths(args.out, args.overwrite, args.samples, args.file)
    from .. import edit
    from ..editing.masks import body_part, checked_part

    part = checked_part(args.keep.lower().replace("-", " ")) if args.keep else None
    motion = outputs.read(args.file, args)
    known = body_part(len(motion), part) if part else None
    how = {"strength": args.strength, "samples": args.samples, "seed": args.seed}
    outputs.write_acts(edit(motion, args.text, known, **how), paths, args.fps)
