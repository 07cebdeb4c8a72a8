"""A Motion: the position of every joint in every frame, with root path, contacts and sound.

The functions of the package's front door take motions and return them.

    walk[20:60]   walk.between(1.0, 3.0)   walk.then(more)   walk.save("walk.bvh")
A `Clip` is the same motion for training: poses in the root frame with their control.  Notebook: 00
"""

import warnings
from dataclasses import dataclass, replace
from itertools import pairwise
from numbers import Integral
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Bool, Float

from .._files import home
from . import registry
from .arguments import MotionError, MotionWarning, checked_rate, is_number
from .check import lies_down, unlike_a_body
from .clip import Clip
from .faults import WILD
from .recordings import recordings
from .resample import resample_present
from .root_frame import FPS, control_from_path, estimate_root, root_path, to_root_frame
from .skeleton import COURSE, Skeleton

FARTHEST = 1e6  # metres from the origin; a larger value is a fault of the file


@dataclass(frozen=True, eq=False)
class Motion:
    """World positions in metres (y up), `fps` frames a second; a missing joint is NaN.

    Optional:
        root      the path on the ground (x, z in metres, heading in radians); control follows from
                  it. Jumps of the heading by whole turns are taken out
        contacts  whether the left and the right foot are planted
        audio     mono sound from -1 to 1; it begins with the first frame. It needs its
                  `sample_rate` in Hz
        source    where the motion comes from
        about     how a file was read: its axes, its unit, whether it stands on the floor;
                  or a sentence: what was understood
        notes     what was mended in it, or is doubtful
    Raises MotionError, with frame and joint, for arrays that do not fit.  Notebook: 00
    """

    positions: Float[np.ndarray, "T J 3"]
    fps: float = FPS
    skeleton: Skeleton = COURSE
    root: Float[np.ndarray, "T 3"] | None = None
    contacts: Bool[np.ndarray, "T 2"] | None = None
    audio: Float[np.ndarray, "N"] | None = None
    sample_rate: int | None = None
    source: str = ""
    about: str = ""
    notes: tuple[str, ...] = ()

    def __post_init__(self):
        try:
            fps = checked_rate(self.fps)
        except ValueError as error:
            raise MotionError(str(error)) from None
        values: dict[str, Any] = {
            "fps": fps,
            "positions": _positions(self.positions, self.skeleton),
            # with ? for what UTF-8 cannot write: a byte of a file's name that is not UTF-8
            "source": str(self.source or "").encode("utf-8", "replace").decode(),
        }
        T = len(values["positions"])
        values["root"] = root = _per_frame(self.root, "root", (T, 3), np.float64)
        if root is not None:
            root[:, 2] = np.unwrap(root[:, 2])
        values["contacts"] = _per_frame(self.contacts, "contacts", (T, 2), bool)
        values["audio"], values["sample_rate"] = _sound(self.audio, self.sample_rate)
        for name, value in values.items():
            object.__setattr__(self, name, value)

    @classmethod
    def of_clip(cls, clip: Clip, start: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> "Motion":
        """A clip in the world, its root starting at `start` (x, z, heading)."""
        place, heading = root_path(clip.control[:, :3], start, clip.fps)
        root = np.concatenate([place, heading[:, None]], axis=1)
        return cls(
            clip.world(start),
            clip.fps,
            COURSE,
            root,
            clip.contacts,
            source=clip.source,
            about=clip.info.get("about", ""),
            notes=tuple(clip.info.get("notes", ())),
        )

    def to_clip(self) -> Clip:
        """Root-frame poses and control for training, from `root` or from the smoothed pelvis.

        Raises MotionError for a missing joint, another skeleton, or a single frame.
        """
        root = self.path()
        poses, control = to_root_frame(self.positions, root[:, :2], root[:, 2], self.fps)
        return Clip(poses, control, self.fps, self.contacts, self.source)

    def path(self) -> Float[np.ndarray, "T 3"]:
        """The root in each frame (x, z, heading): `root`, or the smoothed pelvis on the ground.

        Raises MotionError as `to_clip` does.
        """
        self.check_whole()
        if self.root is not None:
            return self.root
        place, heading = estimate_root(self.positions, self.fps)
        return np.column_stack([place, heading])

    @property
    def control(self) -> Float[np.ndarray, "T 3"]:
        """The speeds of each frame: forward m/s, left m/s, turning rad/s; the last row repeats.

        Raises MotionError as `to_clip` does.
        """
        root = self.path()
        return control_from_path(root[:, :2], root[:, 2], self.fps)

    @property
    def name(self) -> str:
        """The source of the motion, or "motion"."""
        return self.source or "motion"

    @property
    def seconds(self) -> float:
        """Its length in seconds: the number of frames / fps."""
        return len(self) / self.fps

    @property
    def known(self) -> Bool[np.ndarray, "T J"]:
        """True where a joint has a position, False where it is missing (NaN)."""
        return np.isfinite(self.positions).all(-1)

    def all_but(
        self, joints: str | list[str] | tuple[str, ...], first: int = 0, last: int | None = None
    ) -> Bool[np.ndarray, "T J"]:
        """`known`, but False for these joints in frames first to last - 1 (default: to the end).

        `reconstruct` then fills these joints.
        Raises KeyError for an unknown joint, TypeError for what is no name, MotionError for frames
        outside the motion.
        """
        end = len(self) if last is None else last
        if not all(isinstance(frame, Integral) for frame in (first, end)):
            raise TypeError(f"frames are whole numbers, not {first!r:.40} and {end!r:.40}")
        if not 0 <= first < end <= len(self):
            if first >= end:
                raise MotionError(f"{self.name}: from frame {first} up to {end} there is no frame")
            raise MotionError(
                f"{self.name}: frames {first} to {end - 1} are not within its {len(self)} "
                f"(0 to {len(self) - 1})"
            )
        wanted = [joints] if isinstance(joints, str) else joints
        if not isinstance(wanted, (list, tuple)) or not all(isinstance(x, str) for x in wanted):
            raise TypeError(
                f"name the joints, such as 'LeftArm' or ['LeftArm', 'LeftForeArm'], not {joints!r}"
            )
        known = self.known
        known[first:end, [self.skeleton.index(joint) for joint in wanted]] = False
        return known

    def __len__(self) -> int:
        return len(self.positions)

    def __getitem__(self, frames: slice) -> "Motion":
        """Frames first..last-1, with their root, contacts and sound.

        Raises TypeError for a single index or a step, MotionError where no frame is left.
        """
        if not isinstance(frames, slice) or frames.step not in (None, 1):
            raise TypeError(
                f"cut a motion with motion[first:last], not [{frames!r}]; "
                f"motion.positions[frame] is one pose, motion.resampled(fps) changes the rate"
            )
        first, last, _ = frames.indices(len(self))
        if last <= first:
            raise MotionError(
                f"{self.name}: no frame lies within [{frames.start}:{frames.stop}]; it has frames "
                f"0 to {len(self) - 1}"
            )
        cut: dict[str, Any] = {"positions": self.positions[first:last]}
        for name in ("root", "contacts"):
            if getattr(self, name) is not None:
                cut[name] = getattr(self, name)[first:last]
        if self.audio is not None and self.sample_rate is not None:
            begin, end = (round(t / self.fps * self.sample_rate) for t in (first, last))
            cut["audio"] = self.audio[begin:end] if begin < len(self.audio) else None
        return replace(self, **cut)

    def between(self, first: float, last: float) -> "Motion":
        """The part between two times in seconds.  Raises MotionError outside the motion."""
        if not (is_number(first) and is_number(last)):
            raise TypeError(f"times are numbers of seconds, not {first!r:.40} and {last!r:.40}")
        if not (0 <= first < last <= self.seconds + 1e-6):
            raise MotionError(
                f"{self.name}: {first:g} to {last:g} s are not within its {self.seconds:.2f} s"
            )
        return self[round(first * self.fps) : round(last * self.fps)]

    def then(self, *others: "Motion") -> "Motion":
        """This motion, followed by the others.

        Each part stays where it is in the world; a MotionWarning tells where the figure jumps from
        one part to the next. `root`, `contacts` and `audio` are kept only if all parts have them.
        Raises MotionError for another frame rate or skeleton, TypeError for anything but a Motion.
        """
        parts = [self, *map(as_motion, others)]
        for other in others:
            if abs(other.fps - self.fps) > 1e-6 or other.skeleton != self.skeleton:
                raise MotionError(
                    f"{other.name} has {other.fps:g} frames/s and {len(other.skeleton)} joints, "
                    f"{self.name} {self.fps:g} and {len(self.skeleton)}; resampled(fps) changes "
                    f"the rate"
                )
        for one, other in pairwise(parts):
            jump = float(np.linalg.norm(other.positions[0, 0] - one.positions[-1, 0]))
            if jump * self.fps > WILD:
                warnings.warn(
                    f"the figure jumps by {jump:.1f} m from {one.name} to {other.name}",
                    MotionWarning,
                    stacklevel=2,
                )
        joined: dict[str, Any] = {"positions": np.concatenate([part.positions for part in parts])}
        for name in ("root", "contacts"):
            rows = [getattr(part, name) for part in parts]
            joined[name] = None if any(row is None for row in rows) else np.concatenate(rows)
        sounds = [part.sound_in_step() for part in parts]
        whole = all(sound is not None for sound in sounds)
        if whole and len({part.sample_rate for part in parts}) > 1:
            words = "the sounds have different sample rates and are left out: resample them first"
            warnings.warn(words, MotionWarning, stacklevel=2)
            whole = False
        joined["audio"] = np.concatenate([x for x in sounds if x is not None]) if whole else None
        return replace(self, **joined)

    def sound_in_step(self) -> Float[np.ndarray, "N"] | None:
        """The sound, cut or padded with silence to the length of the motion."""
        if self.audio is None or self.sample_rate is None:
            return None
        length = round(self.seconds * self.sample_rate)
        return np.pad(self.audio[:length], (0, max(0, length - len(self.audio))))

    def resampled(self, fps: float) -> "Motion":
        """The same motion at another frame rate, by a cubic spline.

        A low-pass comes first when frames are removed. A joint that is missing (NaN) at a time, or
        in the frame before or after it, is missing there in the new motion as well.

        Raises MotionError for fewer than two frames.
        """
        fps = checked_rate(fps)
        if abs(fps - self.fps) < 1e-6:
            return self
        if len(self) < 2:
            raise MotionError(f"{self.name}: a single frame cannot be resampled")
        positions = resample_present(self.positions, self.fps, fps)
        then, now = np.arange(len(self)) / self.fps, np.arange(len(positions)) / fps
        changed: dict[str, Any] = {"positions": positions, "fps": fps}
        if self.root is not None:
            rows = [np.interp(now, then, column) for column in self.root.T]
            changed["root"] = np.stack(rows, axis=1)
        if self.contacts is not None:
            nearest = np.minimum(np.rint(now * self.fps).astype(int), len(self) - 1)
            changed["contacts"] = self.contacts[nearest]
        return replace(self, **changed)

    def check_finite(self) -> None:
        """Raise MotionError with frame and joint where a position is missing."""
        missing = np.argwhere(~self.known)
        if len(missing):
            frame, joint = missing[0]
            raise MotionError(
                f"{self.name}: {self.skeleton.names[joint]} in frame {frame} has no position (NaN; "
                f"{len(missing)} in all). md.reconstruct(motion, motion.known) can fill them in"
            )

    def check_whole(self) -> None:
        """Raise MotionError unless it has all joints of the course, in at least two frames."""
        if self.skeleton != COURSE:
            raise MotionError(
                f"{self.name} has {len(self.skeleton)} joints; the course's networks know the "
                f"{len(COURSE)} of their own skeleton. Read the figure from a BVH file, which "
                f"retargets it"
            )
        self.check_finite()
        if len(self) < 2:
            raise MotionError(f"{self.name} has one frame; at least two are needed")
        self.check_size()

    def check_size(self) -> None:
        """Raise MotionError if the figure is not about as large as the course's, in metres.

        A MotionWarning says if it lies down in most frames: its axes may be others.
        """
        words = unlike_a_body(self.positions, self.skeleton)
        if words:
            raise MotionError(f"{self.name}: {words}")
        if words := lies_down(self.positions, self.skeleton):
            warnings.warn(f"{self.name}: {words}", MotionWarning, stacklevel=3)

    def save(self, path: str | Path, overwrite: bool = False) -> Path:
        """Write the motion to a file; the name's ending is .bvh, .npz, .mp4, .gif or .html.

        An existing file is replaced, but for a recording that `read_motion` has read, which would
        be lost. With `overwrite` it is replaced, too.

        Raises MotionError for an unknown ending, with a list of the known ones, for a folder, and
        for a recording; TypeError for what is no path.  Notebook: 00
        """
        path = checked_path(path)
        ending = path.suffix.lower()
        write = registry.writers.get(ending)
        if write is None:
            there = " ".join(registry.writers.names())
            what = f"unknown ending {ending}" if ending else "the name has no ending"
            raise MotionError(f"{path.name}: {what}; use one of {there}")
        with recordings.writing(path, overwrite):
            write(self, path)
        return path

    def __repr__(self) -> str:
        has = [f"{len(self)} frames at {self.fps:g} frames/s", f"{len(self.skeleton)} joints"]
        if self.audio is not None and self.sample_rate is not None:
            has.append(f"{len(self.audio) / self.sample_rate:.1f} s of sound")
        missing = int((~self.known).sum())
        if missing:
            has.append(f"{missing} joint positions missing")
        return f"Motion {self.name!r}: {self.seconds:.1f} s, {', '.join(has)}"

    def _repr_mimebundle_(self, include=None, exclude=None):
        """The player, if a layer above has registered one, else the text of `repr`."""
        show = registry.shows.get("player")
        if show is None:
            return {"text/plain": repr(self)}
        return show(self)


def as_motion(given: object) -> Motion:
    """The Motion, unchanged.  Raises TypeError, with what to do, for anything else."""
    if not isinstance(given, Motion):
        raise TypeError(
            f"this takes a Motion, not {type(given).__name__}; md.read_motion(path) reads one from "
            f"a file, md.Motion(positions, fps) makes one"
        )
    return given


def checked_path(path: str | Path) -> Path:
    """The path, with the home folder in place of ~.

    Raises TypeError for what is no path, MotionError for a folder.
    """
    if not isinstance(path, str | Path):
        raise TypeError(f"a file is named by a text or a Path, not by {path!r:.60}")
    path = home(path)
    if path.is_dir():
        raise MotionError(f"{path} is a folder; give the name of a file in it")
    return path


def _real(values, dtype: type) -> np.ndarray:
    """A copy as an array.  Raises TypeError or ValueError unless these are real numbers."""
    if np.iscomplexobj(values):  # numpy would only drop the imaginary part
        raise TypeError("complex numbers")
    return np.array(values, dtype)


def _positions(positions, skeleton: Skeleton) -> np.ndarray:
    """A copy in float64.  Raises MotionError unless every joint is near the origin or missing."""
    try:
        array = _real(positions, np.float64)
    except (TypeError, ValueError):
        raise MotionError("positions must be numbers (frames, joints, 3) in metres") from None
    if array.ndim != 3 or array.shape[-1] != 3 or not len(array):
        raise MotionError(
            f"positions must be (frames, joints, 3) in metres, with at least one frame; these are "
            f"{array.shape}"
        )
    if array.shape[1] != len(skeleton):
        if array.shape[0] == len(skeleton):
            how = "the axes look exchanged: they are (frames, joints, 3)"
        else:
            how = "for another skeleton pass skeleton=Skeleton(names, parents)"
        raise MotionError(
            f"positions have {array.shape[1]} joints, the skeleton {len(skeleton)}; {how}"
        )
    array[np.isnan(array).any(-1)] = np.nan
    wild = np.argwhere((np.abs(array) > FARTHEST).any(-1))
    if len(wild):
        frame, joint = wild[0]
        raise MotionError(
            f"{skeleton.names[joint]} in frame {frame} is at {array[frame, joint]} m, which is not "
            f"plausible; check where it was computed"
        )
    return array


def _per_frame(values, name: str, shape: tuple[int, int], dtype: type) -> np.ndarray | None:
    """A copy of an array.  Raises MotionError unless it has a finite row for each frame."""
    if values is None:
        return None
    try:
        array = _real(values, dtype)
    except (TypeError, ValueError):
        raise MotionError(f"{name} must be numbers {shape}, a row for each frame") from None
    if array.shape != shape or not np.isfinite(array).all():
        what = f"has shape {array.shape}" if array.shape != shape else "has NaN or infinite values"
        raise MotionError(f"{name} {what}; it must be {shape}, a row for each frame")
    return array


def _sound(audio, sample_rate: Any) -> tuple[np.ndarray | None, int | None]:
    """A copy in float32, and its rate.  Raises MotionError unless it is finite mono sound."""
    if sample_rate is not None:
        if not is_number(sample_rate) or sample_rate != sample_rate // 1:
            raise MotionError(
                f"sample_rate must be a whole number of hertz, not {sample_rate!r:.40}"
            )
        sample_rate = int(sample_rate)
    if audio is None:
        return None, sample_rate
    if sample_rate is None:
        raise MotionError(
            "audio needs its sample_rate in Hz, such as 44100: its samples do not say how fast "
            "they are played"
        )
    try:
        array = np.array(audio, np.float32)
    except (TypeError, ValueError):
        raise MotionError("audio must be numbers (N,), one channel of samples") from None
    if array.ndim != 1 or not len(array) or not np.isfinite(array).all() or sample_rate < 1:
        raise MotionError(
            f"audio must be one channel of finite samples (N,) and sample_rate at least 1 Hz, not "
            f"{array.shape} at {sample_rate}"
        )
    return array, sample_rate
