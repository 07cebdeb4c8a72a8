"""Where a command writes: the name is looked at before anything is computed."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from ..motion import registry


def add_out(parser: argparse.ArgumentParser) -> None:
    """--out and --overwrite."""
    endings = " ".join(registry.writers.names())
    parser.add_argument(
        "--out", required=True, type=Path, metavar="FILE", help=f"what to write: {endings}"
    )
    add_overwrite(parser)


def add_overwrite(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--overwrite", action="store_true", help="replace a file that is there")


def add_draws(parser: argparse.ArgumentParser, what: str) -> None:
    """--samples and --seed."""
    parser.add_argument(
        "--samples", type=int, default=1, metavar="N", help=f"so many {what}, in numbered files"
    )
    parser.add_argument(
        "--seed", type=int, default=0, metavar="N", help="another number, another result"
    )


def free_names(out: Path, overwrite: bool, samples: int = 1) -> list[Path]:
    """The files to be written: `out`, or made-1.bvh, made-2.bvh ... for several samples.

    Raises ValueError for an ending that nobody writes, a folder, or a file that is there.
    """
    if samples < 1:
        raise ValueError(f"--samples is a number from 1 on, not {samples}")
    there = registry.writers.names()
    if out.suffix.lower() not in there:
        what = f"nothing is written as {out.suffix}" if out.suffix else "the name has no ending"
        raise ValueError(f"--out {out}: {what}; there are {' '.join(there)}")
    out = out.expanduser()
    digits = len(str(samples))
    numbers = [""] if samples == 1 else [f"-{k:0{digits}d}" for k in range(1, samples + 1)]
    paths = [out.with_name(f"{out.stem}{number}{out.suffix}") for number in numbers]
    for path in paths:
        if path.is_dir():
            raise ValueError(f"--out {path} is a folder; name a file in it")
        if path.exists() and not overwrite:
            raise ValueError(f"{path} is there already: choose another --out, or add --overwrite")
    return paths


def reading(path: Path):
    """A motion from a file; says so first, for the libraries take a moment."""
    say(f"reading {path}")
    from .. import read_motion

    return read_motion(path)


def write_all(motions: object, paths: Sequence[Path]) -> None:
    """Write each motion to its file, and say what is there now."""
    motions = motions if isinstance(motions, list) else [motions]
    for motion, path in zip(motions, paths, strict=True):
        motion.save(path)
        print(f"{path}: {motion.seconds:.1f} s, {len(motion)} frames")


def say(words: str) -> None:
    """To whoever waits, beside the output."""
    print(words, file=sys.stderr, flush=True)
