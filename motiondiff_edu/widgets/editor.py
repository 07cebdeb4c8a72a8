"""The editor: pin frames, drag joints, keep a part of the body, and generate the rest.

The page has a figure and a timeline. Enter pins a frame. J chooses a joint; arrows move it by 1 cm
(5 with Shift), Page Up and Page Down move it in depth. G generates; [ and ] choose an in-between.
Z undoes, R resets. Python keeps the edit and computes the inverse kinematics; the page draws, and
sends how far a joint was moved.   Notebook: 15
"""

import time
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import anywidget
import numpy as np
import torch
import traitlets
from jaxtyping import Bool, Float
from numpy.typing import ArrayLike

from ..editing.edit import Edit, Made, Make, drag_in_words, make_between
from ..motion.formats.bvh.fit import FitReport
from ..motion.formats.bvh.write import write_bvh
from ..motion.recordings import recordings
from ..motion.skeleton import JOINTS, J, joint_index
from . import editor_page, packing
from .editor_page import MODULE, MOST, complaint, frames_in_words
from .live import TURN
from .still import page_on_picture, with_still


@dataclass(frozen=True, eq=False)
class _Step:
    """A state that Undo restores."""

    edit: Edit
    made: Made | None = None
    chosen: int = 0
    presses: int = 0  # how often Generate was pressed before


@dataclass(frozen=True, eq=False)
class _Grip:
    """A run of small drags that Undo reverts together."""

    name: int | None = None  # the page's number of this grip
    by: Float[np.ndarray, "3"] = field(default_factory=lambda: np.zeros(3))  # total, metres
    before: Edit | None = None  # the edit before the drags; None after any other change
    since: Float[np.ndarray, "3"] = field(default_factory=lambda: np.zeros(3))  # `by` at `before`


class Editor(anywidget.AnyWidget):
    """Edit a motion (T, 21, 3), world positions in metres; `make` generates the rest.

    make   an `editing.edit.Make`, such as `partial(editing.inbetween.inbetween, inbetweener)`; it
           runs in the kernel with `samples` and `resample` from the page
    names  the names of the 21 joints on the page
    seed   the generator's seed is `seed` + the number of times Generate was pressed before
    `known`, `positions`, `samples` and `chosen` can be read. `pin`, `unpin`, `drag`, `keep`,
    `generate`, `undo`, `reset` and `save` do the same as the page's controls; errors that the page
    shows as messages are raised.
    Raises ValueError for a motion of another shape, or not finite.  Notebook: 15
    """

    _esm = MODULE
    scene = traitlets.Dict().tag(sync=True)
    joints = traitlets.Bytes().tag(sync=True)
    roots = traitlets.Bytes().tag(sync=True)
    poses = traitlets.Bytes().tag(sync=True)
    made_joints = traitlets.Bytes().tag(sync=True)
    made_roots = traitlets.Bytes().tag(sync=True)
    state = traitlets.Dict({}).tag(sync=True)
    frame = traitlets.Int(0).tag(sync=True)
    chosen = traitlets.Int(0).tag(sync=True)
    count = traitlets.Int(3, min=1, max=MOST).tag(sync=True)
    resample = traitlets.Int(1, min=1, max=10).tag(sync=True)
    busy = traitlets.Bool(False).tag(sync=True)
    file = traitlets.Unicode("in-between.bvh").tag(sync=True)

    def __init__(
        self,
        motion: ArrayLike,
        make: Make,
        *,
        fps: float | int = 20.0,
        names: Sequence[str] | None = None,
        seed: int = 0,
    ):
        super().__init__()
        motion = np.array(motion, np.float64)
        if motion.ndim != 3 or motion.shape[1:] != (J, 3):
            raise ValueError(
                f"a motion to edit must be (frames, {J}, 3), world positions in metres, not "
                f"{motion.shape}"
            )
        names = list(JOINTS if names is None else names)
        if len(names) != J:
            raise ValueError(f"{len(names)} names for the {J} joints")
        self._fps, self._seed = float(fps), int(seed)
        self._make = make
        self._step, self._past = _Step(Edit(motion)), []
        self._grip = _Grip()
        self._asked = 0  # the number of the page's last message that requested in-betweens
        # the last error of `make` after Generate was pressed, with its traceback
        self.error: Exception | None = None
        packed = packing.pack([motion])
        with self.hold_sync():
            self.joints, self.roots = packed.joints, packed.roots
            self.scene = editor_page.scene_of(self.edit, self._fps, names, True)
            self._tell("Pin frames (Enter), drag their joints, then Generate.")
        self.on_msg(self._receive)

    @property
    def edit(self) -> Edit:
        """The current edit."""
        return self._step.edit

    @property
    def known(self) -> Bool[np.ndarray, "T 21"]:
        """True where a joint's position is given."""
        return self.edit.known

    @property
    def positions(self) -> Float[np.ndarray, "T 21 3"]:
        """The motion with the pinned and edited poses."""
        return self.edit.positions

    @property
    def samples(self) -> Float[np.ndarray, "N T 21 3"] | None:
        """The last in-betweens, or None before the first ones."""
        return None if self._step.made is None else self._step.made.samples

    @property
    def description(self) -> str:
        """The alternative text: one sentence about what is shown."""
        return self.state["description"]

    def pin(self, *frames: int) -> str:
        """Pin frames with the pose that is shown: the chosen in-between's, or the motion's.

        Raises IndexError for a frame outside the motion.
        """
        edit, frames = self.edit, [self.edit.index(frame) for frame in frames]
        for frame in frames:
            if frame not in edit.pins:
                edit = edit.pin(
                    frame, None if self.samples is None else self.samples[self.chosen, frame]
                )
        return self._do(edit, f"Pinned {frames_in_words(frames)}.")

    def unpin(self, *frames: int) -> str:
        """Release frames."""
        edit, frames = self.edit, [self.edit.index(frame) for frame in frames]
        for frame in frames:
            edit = edit.unpin(frame)
        return self._do(edit, f"Released {frames_in_words(frames)}.")

    def drag(self, frame: int, joint: str, target) -> str:
        """Move a joint of a pinned frame to `target` (metres, world); bones keep their lengths."""
        return self._do(*self._dragged(self.edit, frame, joint, target))

    def keep(self, part: str | None) -> str:
        """Keep a part of the body in every frame, or None.  Raises KeyError for another name."""
        return self._do(
            self.edit.keep(part),
            f"The {part} is kept in every frame." if part else "No part is kept.",
        )

    def generate(self) -> str:
        """Generate `count` in-betweens.

        Raises the errors of `make`, and ValueError if there is nothing to generate.
        """
        begun, seed = time.perf_counter(), self._seed + self._step.presses
        self.busy = True
        try:
            draw = torch.Generator().manual_seed(seed)
            made = make_between(self.edit, self._make, draw, self.count, self.resample, self._fps)
            packing.pack(list(made.samples))  # raises for samples that cannot be shown
        finally:
            self.busy = False
        free = "" if self.known.any() else " Nothing was pinned or kept, so the result is random."
        took = time.perf_counter() - begun
        words = f"In-betweens generated: {self.count}, in {took:.1f} s (seed {seed}).{free}"
        return self._go(_Step(self.edit, made, 0, self._step.presses + 1), words)

    def undo(self) -> str:
        """Undo the last change.  Raises IndexError if there is none."""
        if not self._past:
            raise IndexError("there is nothing to undo")
        return self._go(self._past.pop(), "Undone.", remember=False)

    def reset(self) -> str:
        """Return to the original motion, without pins; undo() brings the edit back."""
        return self._go(_Step(Edit(self.edit.motion)), "The edit is reset; Undo brings it back.")

    def save(self, path: str | Path, overwrite: bool = False) -> FitReport:
        """Write the chosen in-between as BVH, or the motion with its pins if there is none yet.

        The file is written completely or not at all. Returns how far the constant-bone fit moved
        the joints. Raises the errors of `write_bvh`, and MotionError for a recording that
        `read_motion` has read, unless `overwrite`.
        """
        path = Path(path).expanduser()
        with recordings.writing(path, overwrite):
            return write_bvh(path, self._shown(), self._fps)

    def _receive(self, _, content: dict, buffers) -> None:
        if content["do"] == "ping":  # the page only tests whether the kernel answers
            return
        with TURN:
            self._answer(content)

    def _answer(self, content: dict) -> None:
        acts = {
            "toggle": lambda c: self._toggle(c["frame"]),
            "drag": lambda c: self._pull(c["frame"], JOINTS[c["joint"]], c["by"], c["grip"]),
            "keep": lambda c: self.keep(c["part"] or None),
            "generate": lambda c: self._pressed(c["after"], c["number"]),
            "undo": lambda c: self.undo(),
            "reset": lambda c: self.reset(),
            "save": lambda c: editor_page.save_as(self, c["name"].strip()),
        }
        try:
            self._see(content)
            words = acts[content["do"]](content)
        except KeyboardInterrupt:
            words = "Stopped."
        except Exception as error:  # shown in the page, and nowhere else
            words = complaint(error)
        self._tell(words, content["number"])

    def _see(self, content: dict) -> None:
        """Set the traits that a message needs, because their own messages can arrive later."""
        if "chosen" in content:
            last = 0 if self.samples is None else len(self.samples) - 1
            self.chosen = min(content["chosen"], last)
        for name in {"count", "resample"} & set(content):
            setattr(self, name, content[name])

    def _toggle(self, frame: int) -> str:
        return self.unpin(frame) if self.edit.index(frame) in self.edit.pins else self.pin(frame)

    def _pull(self, frame: int, joint: str, by: list, grip: int) -> str:
        """Move a joint by `by` metres from where its grip began.

        The drags of one grip start from the same pose, and are undone together. After another
        change, such as Undo, the grip starts again from the current pose, and only later movement
        is added.
        """
        by = np.asarray(by, np.float64)
        if by.shape != (3,) or not np.isfinite(by).all():
            raise ValueError(f"{joint} must be moved by three numbers (metres), not {by.tolist()}")
        last = self._grip if self._grip.name == grip else _Grip(grip)
        going = last.before is not None
        before, since = (last.before, last.since) if going else (self.edit, last.by)
        self._grip = _Grip(grip, by)
        start = before.positions[before.index(frame), joint_index(joint)]
        edit, words = self._dragged(before, frame, joint, start + by - since)
        if not going:
            self._past.append(self._here())
        self._grip = _Grip(grip, by, before, since)
        self._step = replace(self._here(), edit=edit)
        return words

    def _dragged(self, before: Edit, frame: int, joint: str, target) -> tuple[Edit, str]:
        frame, target = before.index(frame), np.asarray(target, np.float64)
        edit, name = before.drag(frame, joint, target), self.scene["names"][joint_index(joint)]
        return edit, f"{name} in frame {frame} {drag_in_words(before, edit, frame, joint, target)}."

    def _pressed(self, after: int, number: int) -> str | None:
        """Generate, except while another run is active, or for a press before the last answer."""
        if self.busy or after < self._asked:
            return None
        try:
            return self.generate()
        except Exception as error:
            self.error = error
            raise
        finally:
            self._asked = number

    def _shown(self) -> Float[np.ndarray, "T 21 3"]:
        return self.positions if self.samples is None else self.samples[self.chosen]

    def _here(self) -> _Step:
        return replace(self._step, chosen=self.chosen)

    def _do(self, edit: Edit, words: str) -> str:
        return self._go(replace(self._here(), edit=edit), words)

    def _go(self, step: _Step, words: str, remember: bool = True) -> str:
        if remember:
            self._past.append(self._here())
        others, self._step = step.made is not self._step.made, step
        self._grip = replace(self._grip, before=None)
        with self.hold_sync():
            if others:
                packed = None if step.made is None else packing.pack(list(step.made.samples))
                self.made_joints, self.made_roots = (
                    (b"", b"") if packed is None else (packed.joints, packed.roots)
                )
            self.chosen = step.chosen
            return self._tell(words)

    def _tell(self, words: str | None, number: int | None = None) -> str:
        """Send the edit to the page; `number` is that of the message that is answered."""
        edit = self.edit
        made = self._step.made
        last = self.state
        words = last.get("message", "") if words is None else words
        with self.hold_sync():
            self.poses = editor_page.poses_of(edit)
            self.state = editor_page.state_of(edit, made) | {
                "message": words, "undo": len(self._past),
                "received": max(last.get("received", 0), number or 0),
                "edition": last.get("edition", 0) + 1,
                "description": editor_page.alt_text(edit, made, self._fps),
            }  # fmt: skip
        return words

    @traitlets.validate("frame", "chosen")
    def _is_there(self, proposal):
        name, value = proposal["trait"].name, proposal["value"]
        count = (
            len(self.edit) if name == "frame" else 1 if self.samples is None else len(self.samples)
        )
        if not 0 <= value < count:
            raise traitlets.TraitError(f"{name} must be from 0 to {count - 1}, not {value}")
        return value

    def poster(self, n: int = 6):
        """A strip of n poses as a pillow image: the motion with its pins, and the in-between."""
        return editor_page.strip(
            self.edit, None if self.samples is None else self.samples[self.chosen], self._fps, n
        )

    def _repr_mimebundle_(self, **kwargs):
        page, height = editor_page.html_page(self), self.scene["height"] + 330
        still = page_on_picture(page, self.poster(), self.description, "motion editor", height)
        return with_still(super()._repr_mimebundle_(**kwargs), still)
