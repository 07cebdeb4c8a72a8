"""An edit of a motion: frames are pinned as keyframes, joints dragged, a part of the body kept.

A network generates the rest. The edit gives `known` and `positions`, as
`editing.inbetween.inbetween` takes them.
Source: MoFusion 4.4 (editing by seeds, keyframes and joints).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import torch
from jaxtyping import Bool, Float

from ..metrics.keyframes import keyframe_error, seam_jump
from ..motion.inverse_kinematics import drag
from ..motion.skeleton import JOINTS, joint_index
from .masks import PARTS, body_part, known_frames

Pose = Float[np.ndarray, "21 3"]
KEPT = tuple(name for name in PARTS if name != "whole body")  # parts that can be kept throughout
CM, MM = 100.0, 1000.0
# (positions, known, samples=, resample=, generator=) -> so many motions (metres): what generates
# the rest of an edit. `resample` is how often each step is made. For example
# `functools.partial(editing.inbetween.inbetween, md.load("inbetweener"))`
Make = Callable[..., Float[np.ndarray, "N T 21 3"]]


@dataclass(frozen=True, eq=False)
class Edit:
    """A motion (metres) with pinned frames and their poses, and a part of the body kept throughout.

    Each method returns a new edit. `moved` names the joints that were dragged in each pinned frame.
    """

    motion: Float[np.ndarray, "T 21 3"]
    pins: Mapping[int, Pose] = field(default_factory=dict)
    moved: Mapping[int, tuple[str, ...]] = field(default_factory=dict)
    part: str | None = None

    def __len__(self) -> int:
        return len(self.motion)

    def pin(self, frame: int, pose: Pose | None = None) -> "Edit":
        """Pin a frame as a keyframe, with its pose in the motion or with the given pose.

        Raises IndexError for a frame outside the motion.
        """
        frame = self.index(frame)
        pose = np.array(
            self.motion[frame] if pose is None else pose, np.float64
        )  # a copy, so that later changes of `pose` do not change the edit
        return replace(self, pins={**self.pins, frame: pose}, moved=_without(self.moved, frame))

    def unpin(self, frame: int) -> "Edit":
        """Release a frame, with everything that was dragged in it."""
        frame = self.index(frame)
        return replace(self, pins=_without(self.pins, frame), moved=_without(self.moved, frame))

    def drag(self, frame: int, joint: str, target: Float[np.ndarray, "3"]) -> "Edit":
        """Move a joint of a pinned frame to `target` (metres, world).

        The body follows, see `inverse_kinematics.drag`.

        Raises ValueError for a frame that is not pinned, KeyError for an unknown joint.
        """
        frame = self.index(frame)
        if frame not in self.pins:
            raise ValueError(f"frame {frame} is not pinned: pin it first, then drag its joints")
        pose = drag(self.pins[frame], joint_index(joint), np.asarray(target, np.float64))
        names = dict.fromkeys((*self.moved.get(frame, ()), joint))
        return replace(
            self, pins={**self.pins, frame: pose}, moved={**self.moved, frame: tuple(names)}
        )

    def keep(self, part: str | None) -> "Edit":
        """Keep a part of the body in every frame: one of `KEPT`, or None for no part.

        Raises KeyError for another name, with a list of the parts.
        """
        if part is not None and part not in KEPT:
            raise KeyError(f"no part is called {part!r}; there are {', '.join(KEPT)}, and None")
        return replace(self, part=part)

    @cached_property
    def known(self) -> Bool[np.ndarray, "T 21"]:
        """True where a joint's position is given."""
        known = known_frames(len(self), self.pins)
        return known if self.part is None else known | body_part(len(self), self.part)

    @cached_property
    def positions(self) -> Float[np.ndarray, "T 21 3"]:
        """The motion with the pinned poses inserted; elsewhere it is unchanged."""
        positions = np.array(self.motion)
        for frame, pose in self.pins.items():
            positions[frame] = pose
        return positions

    @property
    def torn(self) -> tuple[int, ...]:
        """Pinned frames in which a kept joint is not where the motion has it; expect a jump."""
        if self.part is None:
            return ()
        kept = body_part(1, self.part)[0]
        away = {f: np.abs(pose - self.motion[f])[kept].max() for f, pose in self.pins.items()}
        return tuple(frame for frame in sorted(away) if away[frame] > 1e-6)

    def __str__(self) -> str:
        if not self.pins and self.part is None:
            return "nothing is pinned or kept"
        count = len(self.pins)
        words = [f"{count} frame{'s' * (count != 1)} pinned" if count else "no frame pinned"]
        if self.moved:
            words[0] += f" ({len(self.moved)} edited)"
        return ", ".join(words + ([] if self.part is None else [f"{self.part} kept"]))

    def index(self, frame: int) -> int:
        """The index of a frame, from 0 on; -1 is the last frame.

        Raises IndexError for a frame outside the motion.
        """
        if not -len(self) <= frame < len(self):
            raise IndexError(
                f"frame {frame} is not within a motion of {len(self)} frames (0 to {len(self) - 1})"
            )
        return int(frame) % len(self)


def _without(table: Mapping, key) -> dict:
    return {k: v for k, v in table.items() if k != key}


@dataclass(frozen=True, eq=False)
class Made:
    """In-betweens of an edit, with their measures in metres and m/s, one for each in-between."""

    edit: Edit
    samples: Float[np.ndarray, "N T 21 3"]
    keyframe_error: Float[np.ndarray, "N"]  # NaN if nothing is given
    seam_jump: Float[np.ndarray, "N"]  # NaN without a seam
    motions_jump: float  # seam jump of the edited motion, at the same seams

    def measured(self, which: int) -> str:
        """The measures of one in-between as a text."""
        error, jump = self.keyframe_error[which], self.seam_jump[which]
        words = ["no keyframe" if np.isnan(error) else f"keyframe error {MM * error:.1f} mm"]
        if not np.isnan(jump):
            words.append(f"seam jump {jump:.2f} m/s (the motion before: {self.motions_jump:.2f})")
        return ", ".join(words)


def make_between(
    edit: Edit,
    make: Make,
    generator: torch.Generator,
    samples: int = 1,
    resample: int = 1,
    fps: float = 20.0,
) -> Made:
    """Generate the rest of an edit with `make`, and measure the result; nothing is corrected.

    Raises ValueError if everything is given, or if the result has another shape or is not finite.
    """
    if edit.known.all():
        raise ValueError("every frame is pinned, so there is nothing to generate. Release some")
    answer = make(
        edit.positions, edit.known, samples=samples, resample=resample, generator=generator
    )
    made = _checked(answer, (samples, *edit.motion.shape))
    truth = np.broadcast_to(edit.positions, made.shape)
    given = edit.known.any()
    error = keyframe_error(made, truth, edit.known) if given else np.full(len(made), np.nan)
    before = float(seam_jump(edit.motion[None], edit.known, fps)[0])
    return Made(edit, made, error, seam_jump(made, edit.known, fps), before)


def _checked(answer, shape: tuple[int, ...]) -> Float[np.ndarray, "N T 21 3"]:
    """The result as an array.  Raises ValueError unless it has this shape and is finite."""
    made = np.asarray(answer, np.float64)
    if made.shape != shape:
        raise ValueError(
            f"the in-betweening gave an array of shape {made.shape}; {shape} is needed"
        )
    bad = np.argwhere(~np.isfinite(made).all(-1))
    if len(bad):
        one, frame, joint = bad[0]
        raise ValueError(
            f"in-between {one + 1} is not finite in frame {frame}, "
            f"{JOINTS[joint]} ({len(bad)} joints in all)"
        )
    return made


def drag_in_words(
    before: Edit, after: Edit, frame: int, joint: str, target: Float[np.ndarray, "3"]
) -> str:
    """A text: how far a drag has moved a joint, and how far from its target it had to stop."""
    j, frame = joint_index(joint), after.index(frame)
    old, new = before.pins[frame][j], after.pins[frame][j]
    words = f"moved by {CM * np.linalg.norm(new - old):.0f} cm"
    short = CM * np.linalg.norm(np.asarray(target) - new)
    return words + (
        f"; the target is {short:.0f} cm out of reach of its bones" if short > 0.5 else ""
    )
