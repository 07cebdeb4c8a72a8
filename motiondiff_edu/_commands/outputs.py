"""What every command asks before it computes anything: numbers in range, names it can write.

A new option with a number needs a line in CHECKS.
"""

import argparse
import re
import sys
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from .._files import check_writable, home
from ..motion import registry
from ..motion.arguments import (
    check_there,
    checked_count,
    checked_guidance,
    checked_rate,
    checked_samples,
    checked_seconds,
    checked_seed,
    checked_strength,
)

# an option of any verb, as it is called in Python -> its check
CHECKS: dict[str, Callable[[Any], object]] = {
    "every": partial(checked_count, name="--every"),
    "file_fps": partial(checked_rate, name="--file-fps"),
    "fps": partial(checked_rate, name="--fps"),
    "guidance": checked_guidance,
    "samples": partial(checked_samples, name="--samples"),
    "seconds": checked_seconds,
    "seed": checked_seed,
    "strength": checked_strength,
}


def endings() -> str:
    """The file endings that can be written."""
    return " ".join(registry.writers.names())


def add_out(parser: argparse.ArgumentParser) -> None:
    """Add --out, --fps and --overwrite."""
    parser.add_argument(
        "--out",
        required=True,
        type=Path,
        metavar="FILE",
        help=f"the file to write: {endings()}; or a folder, for several files that are read",
    )
    add_fps(parser)
    add_overwrite(parser)


def add_fps(parser: argparse.ArgumentParser) -> None:
    """Add --fps."""
    parser.add_argument(
        "--fps",
        type=float,
        help="the frames a second of the file that is written (default: 20, as the networks have "
        "it; between those they are interpolated)",
    )


def add_overwrite(parser: argparse.ArgumentParser) -> None:
    """Add --overwrite."""
    parser.add_argument("--overwrite", action="store_true", help="replace an existing file")


def add_draws(parser: argparse.ArgumentParser, what: str) -> None:
    """Add --samples and --seed."""
    parser.add_argument(
        "--samples",
        type=int,
        default=1,
        metavar="N",
        help=f"the number of {what}, each in its own numbered file (default: 1)",
    )
    add_seed(parser)


def add_seed(parser: argparse.ArgumentParser) -> None:
    """Add --seed."""
    parser.add_argument(
        "--seed",
        type=int,
        default=0,
        metavar="N",
        help="the random seed; another seed gives another result (default: 0)",
    )


def output_paths(
    out: Path, overwrite: bool, samples: int = 1, source: Path | None = None
) -> list[Path]:
    """The files to write: `out`, or made-1.bvh, made-2.bvh ... for several samples.

    Raises ValueError for an unknown ending, a folder, a file that exists, and for the file that is
    read (`source`), also with --overwrite; OSError for a place where no file can be made.
    """
    if out.suffix.lower() not in registry.writers.names():
        what = f"unknown ending {out.suffix}" if out.suffix else "the name has no ending"
        raise ValueError(f"{out}: {what}; use one of {endings()}")
    out = home(out)
    digits = len(str(samples))
    numbers = [""] if samples == 1 else [f"-{k:0{digits}d}" for k in range(1, samples + 1)]
    paths = [out.with_name(f"{out.stem}{number}{out.suffix}") for number in numbers]
    given = home(source or Path())  # the folder here, if no file is read
    for path in paths:
        if path.is_dir():
            raise ValueError(f"{path} is a folder; give the name of a file in it")
        if path.exists() and given.exists() and path.samefile(given):
            raise ValueError(
                f"{path} is the file that is read, and it would be lost: choose another name"
            )
        if path.exists() and not overwrite:
            raise ValueError(f"{path} exists already: choose another name, or add --overwrite")
        check_writable(path)
    return paths


def check_arguments(args: argparse.Namespace) -> None:
    """Raise ValueError for a number of any verb that is out of range, before anything is read."""
    for name, check in CHECKS.items():
        value = getattr(args, name, None)
        if value is not None:
            check(value)


def add_file(
    parser: argparse.ArgumentParser, what: str = "a motion", together=False, frames=True, count="+"
) -> None:
    """Add the files to read, --up, --unit and, for a part of each, --frames.

    They are worked on one by one, each for its own output, if they are not taken `together`.
    """
    parser.add_argument(
        "file",
        type=Path,
        nargs=count,
        help=f"{what}: .bvh, .npz, .npy or .pkl; a folder stands for those in it",
    )
    if not together:
        parser.add_argument(
            "--ending",
            default=".bvh",
            help="how the names end in the folder that is written, for several files (default: "
            ".bvh)",
        )
    parser.add_argument(
        "--up",
        default="",
        metavar="AXIS",
        help="the axis that points up in the file, such as z, or --up=-y (default: it is found)",
    )
    parser.add_argument(
        "--unit",
        default="",
        help="the unit of an npz or npy: m, cm, mm, inches or feet (default: it is found)",
    )
    if frames:
        parser.add_argument(
            "--frames",
            metavar="A-B",
            help="only frames A to B, both included, at 20 frames a second (default: all)",
        )


def files(given: Sequence[Path]) -> list[Path]:
    """These files, and in place of a folder those in it that can be read as motions, by name.

    Raises ValueError for a folder without any.
    """
    found = []
    for path in given:
        if not home(path).is_dir():
            found.append(path)
            continue
        inside = sorted(home(path).iterdir())
        motions = [one for one in inside if one.suffix.lower() in registry.readers.names()]
        if not motions:
            raise ValueError(f"{path}: no file in this folder can be read as a motion")
        found += motions
    return found


def one_by_one(args: argparse.Namespace) -> list[argparse.Namespace]:
    """The arguments for each of the files that are read, with the file that it is written to.

    One file is written to --out; for several, or those of a folder, --out is a folder.
    Raises ValueError as `output_paths` does, before anything is read.
    """
    given, out = files(args.file), home(args.out)
    alone = len(args.file) == 1 and given == args.file
    if not alone and out.suffix.lower() in registry.writers.names():
        raise ValueError(
            f"{out}: several files go into a folder; give its name, and --ending {out.suffix}"
        )
    ending = "." + args.ending.lower().removeprefix(".")
    jobs = [
        argparse.Namespace(
            **vars(args) | {"file": path, "out": out if alone else out / f"{path.stem}{ending}"}
        )
        for path in given
    ]
    paths = [
        path
        for job in jobs
        for path in output_paths(job.out, job.overwrite, getattr(job, "samples", 1), job.file)
    ]
    twice = [path.name for path in paths if paths.count(path) > 1]
    if twice:
        raise ValueError(f"two files would be written to {twice[0]}: give one of them another name")
    return jobs


def read(
    path: Path,
    args: argparse.Namespace,
    mapping: dict[str, str] | None = None,
    file_fps: float | None = None,
):
    """Read a motion, as the options of `add_file` say.

    A line on stderr comes first, because the imports take a moment.
    """
    frames = spans(getattr(args, "frames", None))
    if len(frames) > 1:
        raise ValueError(f"--frames {args.frames}: give one span of frames")
    check_there(path)
    say(f"reading {path}")
    from .. import read_motion

    motion = read_motion(path, mapping=mapping, file_fps=file_fps, up=args.up, unit=args.unit)
    ((first, end),) = frames
    if end is not None and end > len(motion):
        raise ValueError(
            f"--frames {args.frames}: {path} has frames 0 to {len(motion) - 1}, at "
            f"{motion.fps:g} frames/s"
        )
    return motion[first:end]


def spans(words: str | None, option: str = "--frames") -> list[tuple[int, int | None]]:
    """(first, last + 1) of each span in "40-80,100-120", or of all frames.  Raises ValueError."""
    if words is None:
        return [(0, None)]
    found: list[tuple[int, int | None]] = []
    for piece in words.split(","):
        match = re.fullmatch(r"\s*(\d+)\s*(?:-\s*(\d+)\s*)?", piece, re.ASCII)
        if not match:
            what = f"{piece!r} is not a span of frames such as 20-39, nor a single frame"
            raise ValueError(f"{option} {words}: {what}")
        first, last = int(match[1]), int(match[2] or match[1])
        if first > last:
            raise ValueError(f"{option} {words}: {first} comes after {last}")
        found.append((first, last + 1))
    return found


def as_list(made: object) -> list:
    """The result of a verb as a list: it is one motion, or a list for several samples."""
    return made if isinstance(made, list) else [made]


def write_all(made: object, paths: Sequence[Path], fps: float | None = None) -> None:
    """Write each motion to its file, at `fps` if that is given, and print what was written."""
    for motion, path in zip(as_list(made), paths, strict=True):
        if fps is not None:
            motion = motion.resampled(fps)
        motion.save(path, overwrite=True)  # `output_paths` has checked the names
        print(f"{path}: {motion.seconds:.1f} s, {len(motion)} frame{'s' * (len(motion) > 1)}")


def write_acts(made: object, paths: Sequence[Path], fps: float | None = None) -> None:
    """The same for motions made from a sentence; it says first what was read."""
    say(f"read as: {as_list(made)[0].about}")
    write_all(made, paths, fps)


def say(words: str) -> None:
    """Print progress to stderr, so that stdout holds the results alone."""
    print(words, file=sys.stderr, flush=True)
