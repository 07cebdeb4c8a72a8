"""The repair bench.

Remove joints and frames from a walk, let the walker reconstruct them, see how far off they are.

Click a joint, or a frame below; the buttons bring ready-made faults. Keys: left and right choose a
frame, up and down a joint, Space knocks out or restores; P plays, T shows or hides the truth, R
resets; drag to turn.   Notebook: 10
"""

import base64
import html
import json
from collections.abc import Mapping
from typing import Any

import numpy as np
import traitlets
from jaxtyping import Bool

from ..editing.repair_bench import Outcome, RepairBench
from ..motion.clip import Clip
from ..motion.skeleton import JOINTS, PARENTS, J
from ..rollout import AnyWalker
from ..viz import body
from . import module, packing, poster
from .live import TURN, Starting
from .player import PAGE
from .still import page_on_picture, with_still

MODULE = module.es_module(module.BENCH)
_BYTES = ("joints", "roots", "mended_joints", "mended_roots")
HEIGHT = 320  # pixels
GHOST = "#009E73"  # as in js/bench_paint.js
HEARD = "Repairing: there and back, several times ..."  # the page waits for a word at once
_STATE = ("scene", "start", "first", "missing", "repaired", "message")


class Bench(Starting):
    """A walk: joints and frames of a window of T_h frames can be removed; `walker` repairs them.

    The walk is a Clip in the root frame.

    `faults` are buttons: name -> mask (T_h, 21), True where known. `first` (the window's first
    frame) and `missing` (numbers frame x 21 + joint) can be read and set; `repair()` is what the
    button does. The rest is as in RepairBench.
    Raises ValueError for a mask of another shape, and where RepairBench does.  Notebook: 10
    """

    _esm = MODULE
    KEPT = ("first", "missing")
    scene = traitlets.Dict().tag(sync=True)
    joints = traitlets.Bytes().tag(sync=True)
    roots = traitlets.Bytes().tag(sync=True)
    first = traitlets.Int(0).tag(sync=True)
    missing = traitlets.List(traitlets.Int()).tag(sync=True)
    asked = traitlets.Int(0).tag(
        sync=True
    )  # how often a repair was asked for, and how often answered
    answered = traitlets.Int(0).tag(sync=True)
    repaired = traitlets.Dict().tag(sync=True)  # of which window and holes the repairs below are
    mended_joints = traitlets.Bytes().tag(sync=True)
    mended_roots = traitlets.Bytes().tag(sync=True)
    message = traitlets.Unicode("").tag(sync=True)

    def __init__(
        self,
        walker: AnyWalker,
        clip: Clip,
        first: int | None = None,
        faults: Mapping[str, Bool[np.ndarray, "T_h J"]] | None = None,
        samples: int = 10,
        rounds: int = 5,
        steps: int = 10,
        seed: int = 0,
    ):
        super().__init__()
        self.bench = RepairBench(walker, clip, samples, rounds, steps, seed)
        self._truth = clip.world()
        packed = packing.pack([self._truth])
        self.joints, self.roots = packed.joints, packed.roots
        self.outcome: Outcome | None = None
        buttons = [
            {"name": name, "missing": self._numbers(name, known)}
            for name, known in (faults or {}).items()
        ]
        self.scene = {
            "fps": float(clip.fps),
            "frames": len(clip),
            "T_h": self.bench.T_h,
            "last_first": self.bench.last_first,
            "names": list(JOINTS),
            "parents": PARENTS.tolist(),
            "parts": body.parts_record(body.BODY),
            "faults": buttons,
            "height": HEIGHT,
            "kernel": True,
        }
        self.first = self.bench.last_first // 2 if first is None else int(first)

    def _numbers(self, name: str, known: Bool[np.ndarray, "_ _"]) -> list[int]:
        if known.shape != (self.bench.T_h, J):
            raise ValueError(
                f"the fault {name!r} is {known.shape}; "
                f"a mask of the window is ({self.bench.T_h}, {J})"
            )
        return np.flatnonzero(~known).tolist()

    def repair(self) -> None:
        """Mend the window as it is now, and show it and the progress after each round.

        Raises ValueError when nothing, or all, is missing.
        """
        asked = {"first": self.first, "missing": list(self.missing)}
        for outcome in self.bench.mend(**asked):
            self.message = outcome.words
        packed = packing.pack(list(outcome.motions))
        self.outcome = outcome
        with self.hold_sync():
            self.mended_joints, self.mended_roots = packed.joints, packed.roots
            self.repaired = asked | {
                "figures": len(outcome.motions),
                "edition": self.repaired.get("edition", 0) + 1,
            }

    @traitlets.observe("asked")
    def _answer(self, change):
        self.message = HEARD
        try:
            with TURN:
                self.repair()
        except KeyboardInterrupt:
            self.message = "Not repaired: stopped."
        except (
            Exception
        ) as error:  # nobody sees what a callback raises, so it is shown in the widget
            known = isinstance(error, ValueError)
            self.message = (
                f"Not repaired: {error}."
                if known
                else f"Not repaired, {type(error).__name__}: {error}."
            )
        finally:
            self.answered = change["new"]

    @traitlets.validate("first")
    def _within_the_walk(self, proposal):
        if not 0 <= proposal["value"] <= self.bench.last_first:
            raise traitlets.TraitError(
                f"the window may begin at frame 0 to {self.bench.last_first}, "
                f"not {proposal['value']}"
            )
        return proposal["value"]

    @traitlets.validate("missing")
    def _within_the_window(self, proposal):
        try:
            self.bench.known(proposal["value"])
        except IndexError as error:
            raise traitlets.TraitError(str(error)) from None
        return proposal["value"]

    @property
    def shows_repairs(self) -> bool:
        """Whether what is shown is mended: nothing was knocked out, restored or moved since."""
        return {"first": self.first, "missing": self.missing}.items() <= self.repaired.items()

    @property
    def description(self) -> str:
        """What is to be seen, in a sentence or two: the alternative text."""
        scene, last = self.scene, self.first + self.bench.T_h - 1
        words = (
            f"A walk of {scene['frames'] / scene['fps']:.1f} s. In the window, frames {self.first} "
            f"to {last}, {len(self.missing)} of {self.bench.T_h * J} places of joints are missing."
        )
        return f"{words} {self.message}" if self.shows_repairs else words

    def page(self) -> str:
        """A whole HTML page that plays the walk, mended where it was mended.

        Needs no kernel and no network.
        """
        record: dict[str, Any] = {
            name: base64.b64encode(getattr(self, name)).decode() for name in _BYTES
        }
        record |= {name: getattr(self, name) for name in _STATE} | {"asked": 0, "answered": 0}
        record["scene"] = self.scene | {"kernel": False}
        text = json.dumps(record, allow_nan=False).replace("<", "\\u003c")
        return PAGE.format(title=html.escape(self.description), module=MODULE, record=text)

    def poster(self):
        """Six poses of the window as a pillow image, what is missing marked.

        Below it the repairs against the truth.
        """
        first, end = self.first, self.first + self.bench.T_h
        away = np.zeros(self._truth.shape[:2], bool)
        away[first:end] = ~self.bench.known(self.missing)
        lost = poster.Thin(self._truth[None], away, body.INK, dashed=True)
        words = "as recorded; dashed: knocked out" if self.missing else "as recorded"
        figures = [poster.Figure(self._truth, words, thin=(lost,))]
        if self.shows_repairs:
            made = np.repeat(self._truth[None], len(self.outcome.motions), axis=0)
            made[:, first:end] = self.outcome.motions
            thin = (poster.Thin(made[1:], away, GHOST), lost)
            words = f"the mean of {len(made) - 1} repairs; green: each; dashed: the truth"
            figures.append(poster.Figure(made[0], words, thin=thin))
        return poster.filmstrip(figures, self.scene["fps"], between=(first, end - 1))

    def _repr_mimebundle_(self, **kwargs):
        height = self.scene["height"] + 330
        still = page_on_picture(
            self.page(), self.poster(), self.description, "repair bench", height
        )
        return with_still(super()._repr_mimebundle_(**kwargs), still)
