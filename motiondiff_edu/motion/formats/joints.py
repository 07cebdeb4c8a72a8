"""Arrays of joints that keep their own bones: what is asked of them, and what is mended.

A file of positions does not say its axes, its unit or its sides, and some have a wrong end. What is
certain is mended, and said; what is doubtful is said.
"""

import warnings
from dataclasses import replace
from typing import Any

import numpy as np

from ..arguments import too_many_frames
from ..check import LONG, SHORT, bones_over_ours, unit_name, unlike_a_body
from ..motion import Motion, MotionError, MotionWarning
from ..normalise import unit_of_path, unmirror, whole_take
from ..questions import answers, on_the_floor
from ..skeleton import COURSE
from ..upright import rotate_y_up, which_way_up

STATED = "+y"  # up, by the formats of arrays that are read here
OFF = 1.6  # times as large or as small as a person: another unit


def check_header(file: Any, name: str) -> None:
    """Raise MotionError if an open .npy file says that its array has too many frames.

    The numbers are not read, so they take no memory. Raises ValueError for another file.
    """
    version, _ = np.lib.format.read_magic(file)
    shape, *_ = getattr(np.lib.format, f"read_array_header_{min(version, 2)}_0")(file)
    if words := too_many_frames(max(shape, default=0)):
        raise MotionError(f"{name}: an array {shape} has {words}")


def mended_joints(motion: Motion, name: str, up: str = "", unit: str = "") -> Motion:
    """A motion of the course's joints in metres, y up, with left on the left; `notes` say what was
    done, and what is doubtful. Each note is a MotionWarning, too.

    up, unit   as the user names them; else they are found from the figure
    Raises MotionError for a figure of no human size in any unit.
    """
    if motion.skeleton != COURSE or not motion.known.all() or len(motion) < 2:
        return motion
    notes = list(motion.notes)
    points, fps = motion.positions, motion.fps
    found = which_way_up(points, fps, None, STATED, up)
    if found.doubt:
        notes.append(found.doubt)
    if found.axis != STATED:
        points = rotate_y_up(points, found.axis)
        notes.append(f"{found.words}; the figure was turned")
    size = bones_over_ours(points)
    many = SHORT[unit] if unit else many_to_the_metre(size)
    points = points / many
    if many != 1:
        name_of = unit_name(1 / many)
        notes.append(f"the positions are in {LONG.get(name_of, name_of)}; they are read in metres")
    if words := unlike_a_body(points):
        raise MotionError(f"{name}: {words}")
    points, mirrored = unmirror(points)
    if mirrored:
        notes.append("left and right were exchanged in the file; the figure was mirrored")
    motion = replace(motion, positions=points)
    first, last, outside = whole_take(points, fps)
    if outside and last - first > 1:
        motion, points = motion[first:last], points[first:last]
        notes.append(f"{outside}; dropped")
    factor = unit_of_path(points, fps)
    if factor != 1:
        points = points + (factor - 1) * points[:, :1]
        notes.append(f"two units: the path was multiplied by {factor:.3g} to fit the bones")
    notes += answers(points, fps)
    for words in notes:
        warnings.warn(f"{name}: {words}", MotionWarning, stacklevel=4)
    stands = on_the_floor(points, fps)
    about = f"{found.words}; {unit_name(1 / many)}; feet on the floor in {stands:.0%} of frames"
    return replace(motion, positions=points, notes=tuple(notes), about=about)


def many_to_the_metre(size: float) -> float:
    """How many of a figure's unit make a metre, by its size over that of a person in metres."""
    if not size > 0 or 1 / OFF < size < OFF:
        return 1.0
    near = min(SHORT.values(), key=lambda many: abs(np.log(size / many)))
    return near if 1 / OFF < size / near < OFF else 1.0
