"""Checks of what a user passes: a value out of range, or a missing file, raises a clear error."""

import math
from numbers import Integral, Real
from pathlib import Path

from .._files import home

LONGEST = 3600.0  # seconds: an hour
MOST_FRAMES = 432_000  # of a file of motion: an hour at 120 frames/s
MOST_SAMPLES = 256  # made at once, in memory
GUIDANCE = 20  # the largest weight; figures break long before it


class MotionError(ValueError):
    """A motion or its file cannot be used; the message says what is wrong, where, what to do."""


class MotionWarning(UserWarning):
    """Something was corrected or looks wrong; the motion is usable."""


def is_number(value: object) -> bool:
    """Whether a value is a real number; True and False are none."""
    return isinstance(value, Real) and not isinstance(value, bool)


def checked_seconds(seconds: float) -> float:
    """Seconds above 0 and up to an hour.  Raises ValueError for anything else."""
    if not is_number(seconds) or not math.isfinite(seconds):
        raise ValueError(f"seconds must be a number above 0, not {seconds!r}")
    if not 0 < seconds <= LONGEST:
        raise ValueError(f"seconds must be above 0 and at most {LONGEST:g}, not {seconds:g}")
    return float(seconds)


def checked_seed(seed: int) -> int:
    """A whole number from 0 to 2^63 - 1, as torch takes it.  Raises ValueError for others."""
    if isinstance(seed, bool) or not isinstance(seed, Integral) or not 0 <= seed < 2**63:
        raise ValueError(f"seed must be a whole number from 0 to 2^63 - 1, not {seed!r:.40}")
    return int(seed)


def checked_count(count: int, name: str) -> int:
    """A whole number of at least 1.  Raises ValueError for anything else."""
    if isinstance(count, bool) or not isinstance(count, Integral) or count < 1:
        raise ValueError(f"{name} must be a whole number of at least 1, not {count!r}")
    return int(count)


def checked_samples(samples: int, name: str = "samples") -> int:
    """A number of results, from 1 to MOST_SAMPLES.  Raises ValueError for anything else."""
    if checked_count(samples, name) > MOST_SAMPLES:
        raise ValueError(f"{name} must be at most {MOST_SAMPLES}, not {samples}: use more seeds")
    return int(samples)


def checked_steps(steps: int | None, S: int) -> int | None:
    """A number of diffusion steps: a whole number of at least 1, or None for all of them.

    There are S at most; a larger number counts as S.
    Raises ValueError for anything else.
    """
    return None if steps is None else min(checked_count(steps, "steps"), S)


def checked_guidance(guidance: float) -> float:
    """A weight of guidance, from 0 to GUIDANCE.  Raises ValueError for anything else."""
    if not is_number(guidance) or not 0 <= guidance <= GUIDANCE:
        raise ValueError(f"guidance must be a number from 0 to {GUIDANCE}, not {guidance!r:.40}")
    return float(guidance)


def checked_strength(strength: float) -> float:
    """The strength of an edit, above 0 and up to 1.  Raises ValueError for anything else."""
    if not is_number(strength) or not 0 < strength <= 1:
        raise ValueError(f"strength must be a number above 0 and at most 1, not {strength!r:.40}")
    return float(strength)


def too_many_frames(frames: int) -> str:
    """Why a file with so many frames is not read, in words; "" if it is."""
    words = f"{frames:,} frames, and {MOST_FRAMES:,} at most are read; cut it into shorter takes"
    return words if frames > MOST_FRAMES else ""


def check_there(path: Path) -> None:
    """Raise FileNotFoundError if there is neither a file nor a folder of that name."""
    if not home(path).is_file() and not home(path).is_dir():
        where = "" if path.is_absolute() else f" in {Path.cwd()}"
        raise FileNotFoundError(f"there is no file {path}{where}; check the spelling")


def checked_rate(fps: float, name: str = "fps") -> float:
    """Frames a second, above 0 and up to 10,000.  Raises ValueError for anything else."""
    if not is_number(fps) or not 0 < fps <= 10_000:
        raise ValueError(
            f"{name} must be a number of frames a second above 0 and at most 10,000, not {fps!r}"
        )
    return float(fps)
