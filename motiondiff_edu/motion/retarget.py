"""Any human figure as a clip of the course: `load_clip("walk.bvh")`.

A `Figure` has the joints of a file, by whatever way they were found. The steps: scale to metres by
the leg length, rotate y up, drop a T-pose, resample to 20 frames/s, level the floor, put the bone
directions on our bones, plant the feet, and compute the root frame and the control.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float

from .check import unit_name
from .clip import Clip
from .directions import (
    UPLEGS,
    bone_directions,
    complete,
    has_our_bones,
    plain_directions,
    positions_from,
    rest_lean,
)
from .faults import WILD, wild_joints
from .formats.bvh import Bvh, BvhError, read_bvh
from .formats.bvh.frames import REPLACE_FPS
from .formats.dialects import TIPS, check_mapping, guess_mapping
from .normalise import (
    FLIP_X,
    floor_plane,
    level,
    pick,
    to_metres,
    unit_of_path,
    unmirror,
    warn,
    whole_take,
)
from .planting import find_contacts, flat_feet, plant
from .questions import answers, on_the_floor, speed
from .resample import resample_present
from .root_frame import FPS, estimate_root, to_root_frame
from .skeleton import HIPS, JOINTS, PARENTS, TOES
from .upright import ground_points, lowest, rotate_y_up, stands_upright, which_way_up

SHORTEST = 0.5  # s; a shorter clip shows no gait and no heading
NO_TIP = 0.001  # metres
TIP_JOINTS = tuple(JOINTS.index(side + tip) for side in ("Left", "Right") for tip, _ in TIPS)
SUNK = -0.05  # metres: no joint of a standing figure is so low


@dataclass(frozen=True, eq=False)
class Figure:
    """The course's joints in a file's unit and axes; NaN for joints that the file lacks.

    `rest`: the same joints as the file's skeleton stands, if it says so. `stated`: the axis that
    points up by the file's format; `up`: the one that the user names. `right_rate`: what to do
    about a wrong frame rate, for messages.
    """

    points: Float[np.ndarray, "T 21 3"]
    fps: float
    rest: Float[np.ndarray, "21 3"] | None = None
    source: str = ""
    stated: str = ""
    up: str = ""
    right_rate: str = REPLACE_FPS


def load_clip(
    path: str | Path,
    mapping: Mapping[str, str] | None = None,
    file_fps: float | int | None = None,
    up: str = "",
) -> Clip:
    """Read a BVH file and retarget it.

    `mapping` {course joint: joint of the file} names joints that are not guessed from their names.
    `file_fps` replaces the file's frame time. `up` is the axis that points up, such as "+z"; by
    default it is found.

    Raises BvhError. Issues a MotionWarning for each correction.
    """
    return retarget(read_bvh(path, file_fps), mapping, up)


def retarget(bvh: Bvh, mapping: Mapping[str, str] | None = None, up: str = "") -> Clip:
    """A motion with the course's 21 joints and bones, 20 frames/s, in metres, with floor 0.

    The bones keep the directions of the file, and planted toes stay still. `clip.info` records the
    units, the corrections and the mapping.
    Raises BvhError when joints are missing or the motion is shorter than half a second.
    """
    mapping = guess_mapping(bvh) if mapping is None else check_mapping(mapping, bvh)
    points, rest = bvh.world_positions(), bvh.rest_positions()[None]
    figure = Figure(
        pick(points, bvh, mapping), bvh.fps, pick(rest, bvh, mapping)[0], bvh.source, up=up
    )
    return retarget_figure(figure, {"mapping": dict(mapping)})


def retarget_figure(figure: Figure, info: dict | None = None) -> Clip:
    """A figure with the course's bones, as `retarget`; its `info` is added to `info`.

    Raises BvhError for a motion that is shorter than half a second.
    """
    points, found = normalise_figure(figure)
    world, contacts = onto_our_bones(points, found["rest_lean"], FPS)
    warn_sunk(world, FPS, figure.source, found["notes"])
    root, heading = estimate_root(world, FPS)
    poses, control = to_root_frame(world, root, heading, FPS)
    found |= {"start": (*root[0].tolist(), float(heading[0]))} | (info or {})
    return Clip(poses, control, contacts=contacts, source=figure.source, info=found)


def normalise_figure(figure: Figure) -> tuple[Float[np.ndarray, "T 21 3"], dict]:
    """The figure in metres, y up, 20 frames/s, on a level floor; and a record of corrections."""
    points, rest = figure.points, figure.rest
    notes: list[str] = []
    up = which_way_up(points, figure.fps, rest, figure.stated, figure.up)
    if up.doubt:
        warn(up.doubt, figure.source, notes)
    points, unit = to_metres(rotate_y_up(points, up.axis), figure.source)
    points = without_null_tips(points)
    points, mirrored = unmirror(points)
    lean = 0.0
    if rest is not None:
        rest = rotate_y_up(rest, up.axis)
        # a mirrored rest pose would have hips that face backwards
        lean = rest_lean(rest * FLIP_X if mirrored else rest)
    if mirrored:
        exchanged = "left and right were exchanged in the file; the figure was mirrored"
        warn(exchanged, figure.source, notes)
    first, last, outside = whole_take(points, figure.fps)
    if outside:
        warn(f"{outside}; dropped", figure.source, notes)
    points = complete(points[first:last])
    refuse_short(len(points), figure)
    factor = unit_of_path(points, figure.fps)
    if factor != 1:
        words = f"two units: the path was multiplied by {factor:.3g} to fit the bones"
        warn(words, figure.source, notes)
        points = points + (factor - 1) * points[:, :1]
    for words in answers(points, figure.fps):
        warn(words, figure.source, notes)
    speeds = speed(points, figure.fps)
    warn_wild(speeds, figure, first, notes)
    stands = on_the_floor(points, figure.fps)
    points = resample_present(points, figure.fps, FPS)
    wild = wild_joints(speeds, figure.fps, len(points), FPS)
    ours = has_our_bones(points)
    if ours:
        plane = np.zeros(3)
    elif stands_upright(points):
        plane = floor_plane(ground_points(points), FPS)
    else:  # who lies or stands on the hands does not stand on the feet
        plane = np.array([np.percentile(lowest(points), 2), 0.0, 0.0])
    info = dict(
        file_fps=figure.fps,
        unit_m=unit,
        up=up.axis,
        dropped_frames=first,
        floor_slope=tuple(plane[1:]),
        notes=notes,
        about=f"{up.words}; {unit_name(unit)}; feet on the floor in {stands:.0%} of frames",
    )
    return level(points, plane), info | {"rest_lean": lean, "wild": wild}


def without_null_tips(points: Float[np.ndarray, "T 21 3"]) -> Float[np.ndarray, "T 21 3"]:
    """Toes and hand tips that lie on their ankle or wrist are missing (NaN): they show nothing.

    Many files end a hand with End Site OFFSET 0 0 0.
    """
    points = points.copy()
    for tip in TIP_JOINTS:
        lengths = np.linalg.norm(points[:, tip] - points[:, PARENTS[tip]], axis=-1)
        if np.median(lengths) < NO_TIP:
            points[:, tip] = np.nan
    return points


def onto_our_bones(
    points: Float[np.ndarray, "T 21 3"], lean: float, fps: float
) -> tuple[Float[np.ndarray, "T 21 3"], Bool[np.ndarray, "T 2"]]:
    """World positions with the course's bones and planted feet, and the contacts.

    A figure that already has the course's bones, as in files that the course wrote, keeps its pose.
    """
    contacts = find_contacts(ground_points(points), fps)
    if has_our_bones(points):
        return positions_from(points[:, HIPS], plain_directions(points)), contacts
    raw = positions_from(points[:, HIPS], bone_directions(points, flat_feet(points, fps), lean))
    raw += (points[:, UPLEGS].mean(1) - raw[:, UPLEGS].mean(1))[:, None]
    if not stands_upright(points):
        raw[..., 1] -= np.percentile(lowest(raw), 2)
        return raw, np.zeros_like(contacts)
    standing = raw[:, list(TOES), 1][contacts]
    raw[..., 1] -= np.median(standing) if len(standing) else np.percentile(raw[:, list(TOES), 1], 2)
    return plant(raw, contacts, fps), contacts


def warn_sunk(
    world: Float[np.ndarray, "T 21 3"], fps: float, source: str, notes: list[str]
) -> None:
    """Warn about joints deep in the floor: the capture is faulty, or the person rolls on it."""
    t, joint = np.unravel_index(world[..., 1].argmin(), world.shape[:2])
    if world[t, joint, 1] < SUNK:
        depth, when = -100 * world[t, joint, 1], t / fps
        deep = f"{JOINTS[joint]} is {depth:.0f} cm under the floor {when:.2f} s into the clip"
        warn(deep, source, notes)


def refuse_short(count: int, figure: Figure) -> None:
    """Raise BvhError for a clip that is too short to show a heading."""
    if count < 2 or count / figure.fps < SHORTEST:
        problem = (
            f"{count} frame{'s' * (count != 1)} at {figure.fps:g} frames/s last "
            f"{count / figure.fps:.2f} s; at least {SHORTEST} s and two frames are needed."
        )
        raise BvhError(f"{problem} If the rate is wrong, {figure.right_rate}.", figure.source)


def warn_wild(
    speeds: Float[np.ndarray, "T 21"], figure: Figure, dropped: int, notes: list[str]
) -> None:
    """Warn about joints that are faster than any actor's, which is a fault of the capture.

    `info["wild"]` says which joints are affected.
    """
    wild = np.flatnonzero(np.nanmax(speeds, axis=1) > WILD)
    if len(wild):
        where = f"frames {wild[0] + dropped} to {wild[-1] + dropped}"
        fast = f"a joint moves faster than {WILD:g} m/s within {where}: a fault of the capture?"
        warn(fast, figure.source, notes)
