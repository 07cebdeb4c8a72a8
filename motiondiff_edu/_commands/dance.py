"""Generate a dance to a song (wav, flac, ogg, mp3). The dance lasts as long as the song, or
--seconds of it. A film (.mp4), a page (.html) and an .npz file contain the song as well; a BVH file
cannot."""

import argparse
from pathlib import Path

from ..motion.arguments import check_there
from . import outputs

HELP = "dance to a song"
EXAMPLE = "dance song.ogg --seconds 20 --out dance.bvh"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `dance`."""
    parser.add_argument("song", type=Path, help="a sound file")
    parser.add_argument(
        "--seconds",
        type=float,
        metavar="S",
        help="dance to the first S seconds (default: the whole song)",
    )
    parser.add_argument(
        "--guidance",
        type=float,
        metavar="W",
        help="above 1 the dance follows the music more closely; 1 is no guidance, as in the paper, "
        "and faster (default: 4)",
    )
    outputs.add_out(parser)
    outputs.add_draws(parser, "dances")


def run(args: argparse.Namespace) -> None:
    """Make the dances, and write them."""
    paths = outputs.output_paths(args.out, args.overwrite, args.samples)
    check_there(args.song)
    outputs.say(f"dancing to {args.song}")
    from .. import load

    draws = {"samples": args.samples, "seed": args.seed, "guidance": args.guidance}
    made = load("dancer").dance(args.song, seconds=args.seconds, **draws)
    outputs.write_all(made, paths, args.fps)
