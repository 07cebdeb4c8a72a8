"""A Motion: where every joint is in every frame, and what came along.

The front door takes motions and gives them.

    walk[20:60]   walk.between(1.0, 3.0)   walk.then(more)   walk.save("walk.bvh")
`Clip` is its training view: poses in the root frame with their control.  Notebook: 00
"""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float

from . import registry
from .checks import checked_rate
from .clip import Clip
from .normalise import resample as down
from .resample import resample as up
from .root_frame import FPS, control_from_path, estimate_root, root_path, to_root_frame
from .skeleton import COURSE, Skeleton

FARTHEST = 1e6  # metres from the origin; more is a fault of a file
SAMPLE_RATE = 16_000


class MotionError(ValueError):
    """A motion, or a file of one, that cannot be used: what is wrong, where, what to do."""


@dataclass(frozen=True, eq=False)
class Motion:
    """World positions in metres (y up), `fps` frames a second; a joint that is missing is NaN.

    What may come along: `root`, the way on the ground (x, z in metres, heading in radians), from
    which the control follows; `contacts`, left and right foot planted; `audio`, mono sound from -1
    to 1 at `sample_rate` Hz that begins with the first frame; `source`, where it comes from.
    Raises MotionError, with frame and joint, for arrays that do not fit.  Notebook: 00
    """

    positions: Float[np.ndarray, "T J 3"]
    fps: float = FPS
    skeleton: Skeleton = COURSE
    root: Float[np.ndarray, "T 3"] | None = None
    contacts: Bool[np.ndarray, "T 2"] | None = None
    audio: Float[np.ndarray, "N"] | None = None
    sample_rate: int = SAMPLE_RATE
    source: str = ""

    def __post_init__(self):
        try:
            fps = checked_rate(self.fps)
        except ValueError as error:
            raise MotionError(str(error)) from None
        values = {
            "fps": fps,
            "positions": _positions(self.positions, self.skeleton),
            "source": str(self.source),
            "sample_rate": int(self.sample_rate),
        }
        T = len(values["positions"])
        values["root"] = _beside(self.root, "root", (T, 3), np.float64)
        values["contacts"] = _beside(self.contacts, "contacts", (T, 2), bool)
        values["audio"] = _sound(self.audio, values["sample_rate"])
        for name, value in values.items():
            object.__setattr__(self, name, value)

    @classmethod
    def of_clip(cls, clip: Clip, start: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> "Motion":
        """A clip in the world, its root starting at `start` (x, z, heading)."""
        place, heading = root_path(clip.control, start, clip.fps)
        root = np.concatenate([place, heading[:, None]], axis=1)
        return cls(clip.world(start), clip.fps, COURSE, root, clip.contacts, source=clip.source)

    def to_clip(self) -> Clip:
        """Its training view: root-frame poses and control, by `root` or the smoothed pelvis.

        Raises MotionError where a joint is missing, for another skeleton, and for a single frame.
        """
        root = self.rooted().root
        poses, control = to_root_frame(self.positions, root[:, :2], root[:, 2], self.fps)
        return Clip(poses, control, self.fps, self.contacts, self.source)

    def rooted(self) -> "Motion":
        """The same with a `root`: its own, or the smoothed pelvis on the ground.

        Raises as `to_clip`.
        """
        self.check_whole()
        if self.root is not None:
            return self
        place, heading = estimate_root(self.positions, self.fps)
        return replace(self, root=np.concatenate([place, heading[:, None]], axis=1))

    @property
    def control(self) -> Float[np.ndarray, "T 3"]:
        """Forward m/s, left m/s, turning rad/s of each frame; the last row repeats.

        Raises MotionError as `to_clip`.
        """
        root = self.rooted().root
        return control_from_path(root[:, :2], root[:, 2], self.fps)

    @property
    def name(self) -> str:
        """Its source, or "motion"."""
        return self.source or "motion"

    @property
    def seconds(self) -> float:
        """How long it is: frames over frames a second."""
        return len(self) / self.fps

    @property
    def known(self) -> Bool[np.ndarray, "T J"]:
        """True where a joint has a position, False where it is missing (NaN)."""
        return np.isfinite(self.positions).all(-1)

    def all_but(
        self, joints: str | list[str] | tuple[str, ...], first: int = 0, last: int | None = None
    ) -> Bool[np.ndarray, "T J"]:
        """`known`, but False for these joints in frames first to last - 1 (by default to the end):
        what `reconstruct` is to find.

        Raises KeyError for a name no joint has, MotionError for frames that are not there.
        """
        end = len(self) if last is None else last
        if not 0 <= first < end <= len(self):
            raise MotionError(
                f"{self.name}: frames {first} to {end - 1} are not within its {len(self)} "
                f"(0 to {len(self) - 1})"
            )
        wanted = [joints] if isinstance(joints, str) else list(joints)
        known = self.known
        known[first:end, [self.skeleton.index(joint) for joint in wanted]] = False
        return known

    def __len__(self) -> int:
        return len(self.positions)

    def __getitem__(self, frames: slice) -> "Motion":
        """Frames first..last-1, with what came along.

        Raises TypeError for a single number and for a step, MotionError where no frame is left.
        """
        if not isinstance(frames, slice) or frames.step not in (None, 1):
            raise TypeError(
                f"a motion is cut by motion[first:last], not [{frames!r}]; one pose is "
                f"motion.positions[frame], fewer frames are motion.resampled(fps)"
            )
        first, last, _ = frames.indices(len(self))
        if last <= first:
            raise MotionError(
                f"{self.name}: no frame lies within [{frames.start}:{frames.stop}]; it has frames "
                f"0 to {len(self) - 1}"
            )
        cut = {"positions": self.positions[first:last]}
        for name in ("root", "contacts"):
            if getattr(self, name) is not None:
                cut[name] = getattr(self, name)[first:last]
        if self.audio is not None:
            begin, end = (round(t / self.fps * self.sample_rate) for t in (first, last))
            cut["audio"] = self.audio[begin:end] if begin < len(self.audio) else None
        return replace(self, **cut)

    def between(self, first: float, last: float) -> "Motion":
        """What lies between two moments, in seconds.  Raises MotionError where nothing does."""
        if not (0 <= first < last <= self.seconds + 1 / self.fps):
            raise MotionError(
                f"{self.name}: {first:g} to {last:g} s are not within its {self.seconds:.2f} s"
            )
        return self[round(first * self.fps) : round(last * self.fps)]

    def then(self, *others: "Motion") -> "Motion":
        """This motion and then the others, one after the other.

        Each stays where it is in the world. What did not come along with all of them is left out.
        Raises MotionError for another frame rate or skeleton.
        """
        parts = [self, *others]
        for other in others:
            if abs(other.fps - self.fps) > 1e-6 or other.skeleton != self.skeleton:
                raise MotionError(
                    f"{other.name} has {other.fps:g} frames/s and {len(other.skeleton)} joints, "
                    f"{self.name} {self.fps:g} and {len(self.skeleton)}; resampled(fps) changes "
                    f"the rate"
                )
        joined = {"positions": np.concatenate([part.positions for part in parts])}
        for name in ("root", "contacts"):
            rows = [getattr(part, name) for part in parts]
            joined[name] = None if any(row is None for row in rows) else np.concatenate(rows)
        sounds = [part.sound_in_step() for part in parts if part.sample_rate == self.sample_rate]
        whole = len(sounds) == len(parts) and all(sound is not None for sound in sounds)
        joined["audio"] = np.concatenate(sounds) if whole else None
        return replace(self, **joined)

    def sound_in_step(self) -> Float[np.ndarray, "N"] | None:
        """The sound, cut or filled up with silence to the length of the motion."""
        if self.audio is None:
            return None
        length = round(self.seconds * self.sample_rate)
        return np.pad(self.audio[:length], (0, max(0, length - len(self.audio))))

    def resampled(self, fps: float) -> "Motion":
        """The same motion at another frame rate: a spline.

        A low-pass first where half or more of the frames go.

        Raises MotionError where a joint is missing, or for fewer than two frames.
        """
        fps = checked_rate(fps)
        if abs(fps - self.fps) < 1e-6:
            return self
        if not self.known.all() or len(self) < 2:
            self.check_finite()
            raise MotionError(f"{self.name}: one frame cannot be brought to another rate")
        faster = fps > self.fps
        positions = (up if faster else down)(self.positions, self.fps, fps)
        then, now = np.arange(len(self)) / self.fps, np.arange(len(positions)) / fps
        changed = {"positions": positions, "fps": fps}
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
                f"{len(missing)} such in all). md.reconstruct(motion, motion.known) can find them"
            )

    def check_whole(self) -> None:
        """Raise MotionError unless the course's joints are all there, in two frames at least."""
        if self.skeleton != COURSE:
            raise MotionError(
                f"{self.name} has {len(self.skeleton)} joints; the course's networks know the "
                f"{len(COURSE)} of their own skeleton. Read the figure from a BVH file: it is "
                f"retargeted"
            )
        self.check_finite()
        if len(self) < 2:
            raise MotionError(f"{self.name} has one frame: a motion takes two at least")

    def save(self, path: str | Path) -> Path:
        """Write it to a file, in the way its name's ending says: .bvh .npz .mp4 .gif .html.

        An existing file is replaced.

        Raises MotionError for an ending that nobody knows, with those there are.  Notebook: 00
        """
        path = Path(path).expanduser()
        registry.writers.get(check_ending(path))(self, path)
        return path

    def __repr__(self) -> str:
        has = [f"{len(self)} frames at {self.fps:g} frames/s", f"{len(self.skeleton)} joints"]
        if self.audio is not None:
            has.append(f"{len(self.audio) / self.sample_rate:.1f} s of sound")
        missing = int((~self.known).sum())
        if missing:
            has.append(f"{missing} joint positions missing")
        return f"Motion {self.name!r}: {self.seconds:.1f} s, {', '.join(has)}"

    def _repr_mimebundle_(self, include=None, exclude=None):
        """The player, where a layer above brings one; else its words."""
        show = registry.shows.get("player")
        if show is None:
            return {"text/plain": repr(self)}
        return show(self)


def as_motion(given: object) -> Motion:
    """A Motion as it is.  Raises TypeError, with what to do, for anything else."""
    if not isinstance(given, Motion):
        raise TypeError(
            f"this takes a Motion, not {type(given).__name__}; md.read_motion(path) reads one from "
            f"a file, md.Motion(positions, fps) makes one"
        )
    return given


def check_ending(path: str | Path) -> str:
    """The ending by which `save` writes.  Raises MotionError for one that nobody knows."""
    ending = Path(path).suffix.lower()
    if registry.writers.get(ending) is None:
        there = " ".join(registry.writers.names())
        what = f"nothing is written as {ending}" if ending else "the name has no ending"
        raise MotionError(f"{Path(path).name}: {what}; there are {there}")
    return ending


def _positions(positions, skeleton: Skeleton) -> np.ndarray:
    """A copy in float64, if every joint is somewhere or missing."""
    try:
        array = np.array(positions, np.float64)
    except (TypeError, ValueError):
        raise MotionError("positions are numbers, (frames, joints, 3), in metres") from None
    if array.ndim != 3 or array.shape[-1] != 3 or not len(array):
        raise MotionError(
            f"positions are (frames, joints, 3) in metres, with a frame at least; these are "
            f"{array.shape}"
        )
    if array.shape[1] != len(skeleton):
        raise MotionError(
            f"positions have {array.shape[1]} joints, the skeleton {len(skeleton)}: for another "
            f"one pass skeleton=Skeleton(names, parents)"
        )
    array[np.isnan(array).any(-1)] = np.nan
    wild = np.argwhere((np.abs(array) > FARTHEST).any(-1))
    if len(wild):
        frame, joint = wild[0]
        raise MotionError(
            f"{skeleton.names[joint]} in frame {frame} is at {array[frame, joint]} m, which is "
            f"nowhere: look where it was computed"
        )
    return array


def _beside(values, name: str, shape: tuple[int, int], dtype: type) -> np.ndarray | None:
    """A copy of what came along, if it has a row for each frame."""
    if values is None:
        return None
    array = np.array(values, dtype)
    if array.shape != shape or not np.isfinite(array).all():
        what = f"are {array.shape}" if array.shape != shape else "hold NaN or infinity"
        raise MotionError(f"{name} {what}; it takes {shape} numbers, a row for each frame")
    return array


def _sound(audio, sample_rate: int) -> np.ndarray | None:
    """A copy in float32, if it can be heard."""
    if audio is None:
        return None
    array = np.array(audio, np.float32)
    if array.ndim != 1 or not len(array) or not np.isfinite(array).all() or sample_rate < 1:
        raise MotionError(
            f"audio is one channel of finite samples (N,) at so many Hz, not {array.shape} at "
            f"{sample_rate}"
        )
    return array
