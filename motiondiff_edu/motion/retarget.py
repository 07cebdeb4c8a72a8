"""Any humanoid BVH as a clip of the course: `load_clip("walk.bvh")`.

The steps: find the joints, scale to metres by the leg length, rotate y up, drop a T-pose, resample
to 20 frames/s, level the floor, put the bone directions on our bones, plant the feet, and compute
the root frame and the control.
"""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float

from .bvh import Bvh, BvhError, read_bvh
from .bvh.frames import REPLACE_FPS
from .clip import Clip
from .dialects import TIPS, check_mapping, guess_mapping
from .directions import (
    UPLEGS,
    bone_directions,
    build,
    complete,
    has_our_bones,
    plain_directions,
    rest_lean,
)
from .faults import WILD, wild_joints
from .normalise import (
    FLIP_X,
    calibration_frames,
    floor_plane,
    level,
    pick,
    rotate_y_up,
    speed,
    to_metres,
    unmirror,
    up_axis,
    warn,
)
from .planting import find_contacts, flat_feet, plant
from .resample import resample_present
from .root_frame import estimate_root, to_root_frame
from .skeleton import HEELS, HIPS, JOINTS, PARENTS, TOES

SHORTEST = 0.5  # s; a shorter clip shows no gait and no heading
NO_TIP = 0.001  # metres
TIP_JOINTS = tuple(JOINTS.index(side + tip) for side in ("Left", "Right") for tip, _ in TIPS)
SUNK = -0.05  # metres: no joint of a standing figure is so low


def load_clip(
    path: str | Path, mapping: Mapping[str, str] | None = None, file_fps: float | int | None = None
) -> Clip:
    """Read a BVH file and retarget it.

    `mapping` {course joint: joint of the file} names joints that are not guessed from their names.
    `file_fps` replaces the file's frame time.

    Raises BvhError. Issues a MotionWarning for each correction.
    """
    return retarget(read_bvh(path, file_fps), mapping)


def retarget(bvh: Bvh, mapping: Mapping[str, str] | None = None, fps: float | int = 20.0) -> Clip:
    """A motion with the course's 21 joints and bones, `fps` frames/s, in metres, with floor 0.

    The bones keep the directions of the file, and planted toes stay still. `clip.info` records the
    units, the corrections and the mapping.
    Raises BvhError when joints are missing or the motion is shorter than half a second.
    """
    fps = float(fps)
    if not 0 < fps < np.inf:
        raise BvhError(
            f"fps must be a positive number of frames a second, not {fps:g}.", bvh.source
        )
    mapping = guess_mapping(bvh) if mapping is None else check_mapping(mapping, bvh)
    points, info = normalised(bvh, mapping, fps)
    world, contacts = onto_our_bones(points, info["rest_lean"], fps)
    warn_sunk(world, fps, bvh.source, info["notes"])
    root, heading = estimate_root(world, fps)
    poses, control = to_root_frame(world, root, heading, fps)
    return Clip(
        poses,
        control,
        fps=fps,
        contacts=contacts,
        source=bvh.source,
        info=info | {"mapping": dict(mapping), "start": (*root[0].tolist(), float(heading[0]))},
    )


def normalised(
    bvh: Bvh, mapping: Mapping[str, str], fps: float
) -> tuple[Float[np.ndarray, "T 21 3"], dict]:
    """The figure in metres, y up, at `fps`, on a level floor; and a record of the corrections."""
    points, notes = pick(bvh.world_positions(), bvh, mapping), []
    rest = pick(bvh.rest_positions()[None], bvh, mapping)
    up = up_axis(points, rest[0])
    points, unit = to_metres(rotate_y_up(points, up), bvh.source)
    points = without_null_tips(points)
    points, mirrored = unmirror(points)
    rest = rotate_y_up(rest, up)[0]
    if mirrored:
        rest = rest * FLIP_X  # otherwise its hips would face backwards
        notes.append(
            warn("left and right were exchanged in the file; the figure was mirrored", bvh.source)
        )
    dropped = calibration_frames(points)
    if dropped:
        which = "frame 0 is" if dropped == 1 else f"frames 0 to {dropped - 1} are"
        notes.append(
            warn(f"{which} a calibration pose, not part of the motion; dropped", bvh.source)
        )
    points = complete(points[dropped:])
    refuse_short(len(points), bvh)
    speeds = speed(points, bvh.fps)
    warn_wild(speeds, bvh, dropped, notes)
    points = resample_present(points, bvh.fps, fps)
    wild = wild_joints(speeds, bvh.fps, len(points), fps)
    ours = has_our_bones(points)
    plane = np.zeros(3) if ours else floor_plane(ground_points(points), fps)
    info = dict(
        file_fps=bvh.fps,
        unit_m=unit,
        up=up,
        dropped_frames=dropped,
        floor_slope=tuple(plane[1:]),
        notes=notes,
    )
    return level(points, plane), info | {"rest_lean": rest_lean(rest), "wild": wild}


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


def ground_points(points: Float[np.ndarray, "T 21 3"]) -> Float[np.ndarray, "T 2 3"]:
    """Toes, or ankles where a file has no toes."""
    toes = points[:, list(TOES)]
    return points[:, list(HEELS)] if np.isnan(toes).any() else toes


def onto_our_bones(
    points: Float[np.ndarray, "T 21 3"], lean: float, fps: float
) -> tuple[Float[np.ndarray, "T 21 3"], Bool[np.ndarray, "T 2"]]:
    """World positions with the course's bones and planted feet, and the contacts.

    A figure that already has the course's bones, as in files that the course wrote, keeps its pose.
    """
    contacts = find_contacts(ground_points(points), fps)
    if has_our_bones(points):
        return build(points[:, HIPS], plain_directions(points)), contacts
    raw = build(points[:, HIPS], bone_directions(points, flat_feet(points, fps), lean))
    raw += (points[:, UPLEGS].mean(1) - raw[:, UPLEGS].mean(1))[:, None]
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
        notes.append(
            warn(
                f"{JOINTS[joint]} is {depth:.0f} cm under the floor {when:.2f} s into the clip",
                source,
            )
        )


def refuse_short(count: int, bvh: Bvh) -> None:
    """Raise BvhError for a clip that is too short to show a heading."""
    if count / bvh.fps < SHORTEST:
        problem = (
            f"{count} frame{'s' * (count != 1)} at {bvh.fps:g} frames/s last "
            f"{count / bvh.fps:.2f} s; at least {SHORTEST} s are needed."
        )
        raise BvhError(f"{problem} If the frame time is wrong, {REPLACE_FPS}.", bvh.source)


def warn_wild(speeds: Float[np.ndarray, "T 21"], bvh: Bvh, dropped: int, notes: list[str]) -> None:
    """Warn about joints that are faster than any actor's, which is a fault of the capture.

    `info["wild"]` says which joints are affected.
    """
    wild = np.flatnonzero(np.nanmax(speeds, axis=1) > WILD)
    if len(wild):
        where = f"frames {wild[0] + dropped} to {wild[-1] + dropped}"
        notes.append(
            warn(
                f"a joint moves faster than {WILD:g} m/s within {where}: a fault of the capture?",
                bvh.source,
            )
        )
