"""`read_motion(path)`, `read_motions(folder)`, and formats: BVH, npz and AIST++'s keypoints.

Notebook: 00
"""

import warnings
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..._files import home, replacing
from .. import registry
from ..arguments import check_there
from ..check import SHORT, lies_down, unlike_a_body
from ..clip import Clip
from ..motion import Motion, MotionError, MotionWarning, checked_path
from ..recordings import recordings
from ..retarget import load_clip
from ..root_frame import FPS
from ..skeleton import COURSE, JOINTS, Skeleton
from ..upright import AXES
from .aist import COCO, full_pose, read_keypoints
from .bvh.tokens import LONGEST_NAME
from .bvh.write import write_bvh
from .humanml3d import motion_of_smpl
from .joints import check_header, mended_joints
from .keypoints import motion_of_keypoints

FORMAT = "motiondiff_edu motion 1"
LONGEST_SOURCE = 200  # letters
SLOWEST = 1.0  # frames a second: a smaller number is the time of a frame
# names of arrays in the files of other programs
OTHERS_SAY = {
    "posed_joints": "positions",
    "joints": "positions",
    "mocap_framerate": "fps",
    "mocap_frame_rate": "fps",
}
ANGLES = (
    "has joint angles (poses, trans), as AMASS has them, and no positions: those need the body "
    "model that the angles are for. With the package smplx and its model: joints = "
    "model(...).joints; numpy.savez('walk.npz', positions=joints[:, :22], fps=mocap_framerate)"
)
TAKES = {  # which option is for which files
    "mapping": (".bvh",),
    "file_fps": (".bvh",),
    "up": (".bvh", ".npz", ".npy", ".pkl"),
    "unit": (".npz", ".npy"),
}
EDGE_FPS = 30.0
LARGEST = 920_000_000  # bytes, unpacked: our joints at 120 frames/s, and their sound, for an hour
# endings of other files, and what to do with them
ELSEWHERE = {
    (".fbx", ".c3d", ".glb", ".gltf", ".usd", ".blend"): "export it as BVH, for example in Blender",
    (".amc", ".asf", ".vrma"): "export it as BVH",
    (".wav", ".mp3", ".ogg", ".flac"): 'this is sound; md.load("dancer").dance(path) dances to it',
    (".pickle",): "a pickle can run code and is not opened; save its arrays as npz",
}


def read_motion(
    path: str | Path,
    *,
    mapping: Mapping[str, str] | None = None,
    file_fps: float | int | None = None,
    up: str = "",
    unit: str = "",
) -> Motion:
    """Read a motion from a file; the name's ending says whether it is BVH, npz, npy or pkl.

    Any humanoid BVH is retargeted to the course's skeleton and resampled to 20 frames/s; so is an
    npz with the `names` of its joints that this package did not write (`formats/keypoints.py`), and
    a pkl, which has keypoints of AIST++ and is read without running its code. An npy is a motion of
    HumanML3D (`formats/humanml3d.py`).

    mapping   for a BVH file: {joint of the course: joint of the file}, for names not recognised
    file_fps  for a BVH file: its frames a second, if the file states a wrong number
    up        the axis that points up in the file, such as "z" or "-y"; else it is found
    unit      for npz and npy: "m", "cm", "mm", "inches" or "feet"; else it is found
    `about` of the motion says how it was read, `notes` what was mended or is doubtful.
    Raises FileNotFoundError for a missing file. Raises MotionError, BvhError or AistError
    (all are ValueErrors) for a faulty one, with the file, the fault and what to do, and TypeError
    for what is no path.  Notebook: 00
    """
    path = checked_path(path)
    check_there(path)
    ending = (path.suffix or path.name).lower()  # a file may be called .bvh
    read = registry.readers.get(ending)
    if read is None:
        advice = next((words for group, words in ELSEWHERE.items() if ending in group), "")
        *others, last = sorted(registry.readers.names())
        raise MotionError(
            f"{path.name} cannot be read as a motion; {', '.join(others)} and {last} can"
            f"{f'. {advice[0].upper()}{advice[1:]}' if advice else ''}"
        )
    given = {"mapping": mapping, "file_fps": file_fps, "up": checked_up(up), "unit": unit}
    options = {name: value for name, value in given.items() if value not in (None, "")}
    for name in options:
        if ending not in TAKES[name]:
            those = " and ".join(TAKES[name])
            raise MotionError(f"{path.name}: `{name}` is for {those}, not for {ending}")
    if unit and unit not in SHORT:
        raise MotionError(f"no unit is called {unit!r:.40}; there are {', '.join(SHORT)}")
    motion = read(path, **options)
    recordings.note_read(path)
    return motion


def checked_up(up: str) -> str:
    """An axis with its sign, "+z" for "z"; "" for none.  Raises MotionError for another word."""
    signed = up if not up or up[0] in "+-" else f"+{up}"
    if signed and signed not in AXES:
        raise MotionError(f"up is an axis such as 'z' or '-y', not {up!r:.40}")
    return signed


def read_motions(folder: str | Path) -> list[Motion]:
    """The motions of a folder, and of the folders in it, that a network can be trained on.

    They have 20 frames/s, and are in the order of their names. A MotionWarning names each file that
    cannot be read or is too short, or in which a joint is missing, and says why.
    Raises MotionError if the folder does not exist, or no file in it can be used.
    """
    folder = home(folder)
    if not folder.is_dir():
        raise MotionError(f"{folder} is no folder with motions")
    endings = set(registry.readers.names())
    found = []
    for path in sorted(folder.rglob("*")):
        if path.suffix.lower() not in endings or not path.is_file():
            continue
        try:
            motion = read_motion(path)
            motion.check_whole()
            motion = motion.resampled(FPS)
            motion.check_whole()
            found.append(motion)
        except ValueError as error:
            file = "" if path.name in str(error) else f"{path.name}: "
            warnings.warn(f"left out: {file}{error}", MotionWarning, stacklevel=2)
    if not found:
        raise MotionError(
            f"no file in {folder} could be used as a motion; {', '.join(sorted(endings))} can"
        )
    return found


@registry.readers.register(".bvh")
def read_bvh_motion(
    path: Path,
    mapping: Mapping[str, str] | None = None,
    file_fps: float | int | None = None,
    up: str = "",
) -> Motion:
    """Any humanoid BVH, retargeted; the figure keeps its place in the world.  Raises BvhError."""
    clip = load_clip(path, mapping, file_fps, up)
    return Motion.of_clip(clip, clip.info["start"])


@registry.readers.register(".pkl")
def read_aist(path: Path, up: str = "") -> Motion:
    """A dance of AIST++, retargeted, or joints of SMPL as EDGE writes them.

    Raises AistError for another pickle; none is run.
    """
    joints = full_pose(path)
    if joints is not None:
        made = motion_of_smpl(joints, EDGE_FPS, path.name, path.stem, up)
        if made is not None:
            return made
    dance = read_keypoints(path)
    return motion_of_keypoints(dance.positions, COCO, dance.fps, dance.source, "+y", up)


@registry.writers.register(".bvh")
def write_bvh_motion(motion: Motion, path: Path) -> None:
    """Write BVH, for example for Blender; print how far the constant bones moved the joints.

    Raises MotionError for another skeleton, or where a joint is missing.
    """
    if motion.skeleton != COURSE:
        raise MotionError(
            f"{motion.name} has {len(motion.skeleton)} joints; BVH can only be written for the "
            f"{len(COURSE)} of the course's skeleton. Save as .npz, which takes any skeleton"
        )
    motion.check_finite()
    write_bvh(path, motion.positions, motion.fps)


@registry.writers.register(".npz")
def write_npz(motion: Motion, path: Path) -> None:
    """Write the whole motion exactly, as plain arrays; the file contains no code."""
    arrays = {
        "format": np.array(FORMAT),
        "positions": motion.positions,
        "fps": np.array(motion.fps),
        "names": np.array(motion.skeleton.names),
        "parents": np.array(motion.skeleton.parents),
        "source": np.array(motion.source),
    }
    for name in ("root", "contacts", "audio", "sample_rate"):
        if getattr(motion, name) is not None:
            arrays[name] = np.asarray(getattr(motion, name))
    with replacing(path) as aside, open(aside, "wb") as file:
        np.savez_compressed(file, **arrays)  # type: ignore[arg-type]  # no array is a flag


@registry.readers.register(".npz")
def read_npz(path: Path, up: str = "", unit: str = "") -> Motion:
    """Read our own npz, or one of data_synth: walks have poses and control, dances have positions.

    Raises MotionError for another npz, with a list of its arrays. Pickled objects are not opened.
    """
    arrays = _arrays(path)
    told = arrays.get("source", np.array(path.stem))
    source = str(told)[:LONGEST_SOURCE] if told.ndim == 0 else path.stem
    try:
        angles = {"poses", "trans"} <= arrays.keys()
        for theirs, ours in OTHERS_SAY.items():
            if theirs in arrays and ours not in arrays:
                arrays[ours] = arrays[theirs]
        if {"positions", "poses"} & arrays.keys() and "fps" not in arrays:
            _note(path, f"the file has no `fps`; {FPS:g} frames/s are assumed")
        if "positions" in arrays:
            if arrays["positions"].shape[1:2] != (len(JOINTS),) and "names" not in arrays:
                points = arrays["positions"]
                smpl = motion_of_smpl(points, _rate(arrays), path.name, path.stem, up, unit)
                if smpl is not None:
                    return smpl
            motion = _from_positions(arrays, source or path.stem, up)
            if {"format", "root"} & arrays.keys() and not (up or unit):  # written by us
                figure = motion.positions, motion.skeleton
                if words := unlike_a_body(*figure) or lies_down(*figure):
                    _note(path, words)
                return motion
            return motion if motion.about else mended_joints(motion, path.name, up, unit)
        if {"poses", "control"} <= arrays.keys():
            fps = _rate(arrays)
            poses = arrays["poses"].astype(np.float64)
            contacts = arrays.get("contacts")
            return Motion.of_clip(Clip(poses, arrays["control"], fps, contacts, source))
    except (ValueError, TypeError, IndexError) as error:
        raise MotionError(f"{path.name}: {error}") from None
    if angles:
        raise MotionError(f"{path.name} {ANGLES}")
    there = ", ".join(f"{name:.80} {array.shape}" for name, array in arrays.items())
    raise MotionError(
        f"{path.name} contains {there or 'nothing'}; a motion has `positions` (frames, joints, 3) "
        f"in metres and `fps`, and for another skeleton the `names` of its joints as well"
    )


def _from_positions(arrays: dict[str, np.ndarray], source: str, up: str) -> Motion:
    skeleton = COURSE
    fps = _rate(arrays)
    names = _names(arrays)
    if _is_named(arrays):
        points = arrays["positions"].astype(np.float64)
        return motion_of_keypoints(points, names, fps, source, up=up)
    if "parents" in arrays:
        skeleton = Skeleton(names, tuple(arrays["parents"].tolist()))
    along: dict[str, Any] = {
        name: arrays[name] for name in ("root", "contacts", "audio") if name in arrays
    }
    if "sample_rate" in arrays:
        along["sample_rate"] = int(arrays["sample_rate"])
    return Motion(arrays["positions"], fps, skeleton, source=source, **along)


def named_joints(path: Path) -> tuple[tuple[str, ...], int, float] | None:
    """Names, frames and rate of a file whose joints are known by their names alone.

    None for a file of our own skeleton.  Raises MotionError or AistError for one that is damaged.
    """
    if path.suffix.lower() == ".pkl":
        dance = read_keypoints(path)
        return COCO, len(dance.positions), dance.fps
    arrays = _arrays(path)
    if "positions" not in arrays or not _is_named(arrays):
        return None
    return _names(arrays), len(arrays["positions"]), _rate(arrays)


def _names(arrays: dict[str, np.ndarray]) -> tuple[str, ...]:
    names = tuple(map(str, arrays["names"].tolist())) if "names" in arrays else JOINTS
    if long := [name for name in names if len(name) > LONGEST_NAME]:
        raise MotionError(f"the name {long[0]:.40}... has {len(long[0]):,} letters; shorten it")
    return names


def _is_named(arrays: dict[str, np.ndarray]) -> bool:
    """Whether the joints of a file are others than ours, and it was not written by us."""
    return _names(arrays) != JOINTS and "format" not in arrays


def _rate(arrays: dict[str, np.ndarray]) -> float:
    """The frames a second of a file.  Raises ValueError for what is no rate of a motion."""
    given = np.asarray(arrays.get("fps", FPS))
    if given.size != 1:
        raise ValueError(f"fps must be one number, not an array {given.shape}")
    fps = float(given.reshape(()))
    if 0 < fps < SLOWEST:
        raise ValueError(
            f"fps is {fps:g} frames a second. If that is the time of a frame, write fps = "
            f"{1 / fps:g}"
        )
    return fps


def _note(path: Path, words: str) -> None:
    warnings.warn(f"{path.name}: {words}", MotionWarning, stacklevel=4)


def _arrays(path: Path) -> dict[str, np.ndarray]:
    """The arrays of an npz file, without pickles.  Raises MotionError for another file."""
    try:
        with zipfile.ZipFile(path) as packed:
            size = sum(entry.file_size for entry in packed.infolist())
            if size > LARGEST:
                raise MotionError(f"{path.name} unpacks to {size / 1e9:.1f} GB; cut it into takes")
            for name in set(packed.namelist()) - {"audio.npy"}:  # it has samples, not frames
                check_header(packed.open(name), path.name)
        with np.load(path, allow_pickle=False) as file:
            return {name: file[name] for name in file.files}
    except MotionError:
        raise
    except Exception as error:  # a damaged file may raise anything
        pickled = "pickle" in str(error)
        reason = "it contains pickled objects" if pickled else "it is not an npz file, or damaged"
        raise MotionError(
            f"{path.name} cannot be read as npz: {reason}. Save plain arrays with numpy.savez"
        ) from None
