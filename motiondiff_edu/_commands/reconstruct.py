"""Find joints that a recording lost. Without --missing they are those that the file itself leaves
out (NaN in an npz). The pelvis (Hips) must be known throughout."""

import argparse
import re
from pathlib import Path

from . import outputs

HELP = "find joints that are missing"
EXAMPLE = (
    "reconstruct walk.bvh --missing RightArm,RightForeArm,RightHand --frames 40-80 --out whole.bvh"
)


def arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", type=Path, help="a motion: .bvh or .npz")
    parser.add_argument("--missing", metavar="JOINTS", help="joints to find, with commas between")
    parser.add_argument(
        "--frames",
        metavar="A-B",
        help="in frames A to B, both included; several with commas (default: all frames)",
    )
    parser.add_argument(
        "--seed", type=int, default=0, metavar="N", help="another number, another result"
    )
    outputs.add_out(parser)


def run(given: argparse.Namespace) -> None:
    frames = spans(given.frames)
    if given.frames and not given.missing:
        raise ValueError("--frames says when; say as well which joints, by --missing")
    (path,) = outputs.free_names(given.out, given.overwrite)
    motion = outputs.reading(given.file)
    from .. import reconstruct

    known = motion.known
    for first, last in frames if given.missing else []:
        joints = [name.strip() for name in given.missing.split(",") if name.strip()]
        known &= motion.all_but(joints, first, last)
    outputs.say(f"reconstructing {int((~known).sum())} joint positions")
    outputs.write_all(reconstruct(motion, known, seed=given.seed), [path])


def spans(words: str | None) -> list[tuple[int, int | None]]:
    """(first, last + 1) of each span in "40-80,100-120", or of all frames.  Raises ValueError."""
    if words is None:
        return [(0, None)]
    found = []
    for piece in words.split(","):
        match = re.fullmatch(r"\s*(\d+)\s*-\s*(\d+)\s*", piece, re.ASCII)
        if not match or int(match[1]) > int(match[2]):
            raise ValueError(f"--frames {words}: {piece!r} is no span of frames such as 40-80")
        found.append((int(match[1]), int(match[2]) + 1))
    return found
