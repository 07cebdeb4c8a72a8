"""Dance to a song: wav, flac, ogg, mp3. The dance lasts as long as the song, or --seconds of it. A
film (.mp4) or page (.html) has the sound along, BVH cannot."""

import argparse
from pathlib import Path

from . import outputs

HELP = "dance to a song"
EXAMPLE = "dance song.ogg --seconds 20 --out dance.bvh"


def arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("song", type=Path, help="a sound file")
    parser.add_argument(
        "--seconds", type=float, metavar="S", help="of the song, from its start (default: all)"
    )
    outputs.add_out(parser)
    outputs.add_draws(parser, "dances")


def run(given: argparse.Namespace) -> None:
    paths = outputs.free_names(given.out, given.overwrite, given.samples)
    outputs.say(f"dancing to {given.song}")
    from .. import load

    draws = {"samples": given.samples, "seed": given.seed}
    made = load("dancer").dance(given.song, seconds=given.seconds, **draws)
    outputs.write_all(made, paths)
