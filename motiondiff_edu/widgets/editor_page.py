"""The data that the editor sends to its page: the scene, the current edit, and texts.

It also makes the page for places where no kernel runs.
"""

import base64
import contextlib
import html
import io
import json
import re
from itertools import count
from pathlib import Path

import numpy as np

from ..editing.edit import KEPT, Edit, Made
from ..editing.masks import body_part
from ..motion.recordings import recordings
from ..motion.skeleton import J, joint_index
from ..viz import body
from . import module, poster
from .player import PAGE

MODULE = module.es_module(module.EDITOR)
MOST = 6  # in-betweens at once: more ghosts are hard to distinguish
BINARY = ("joints", "roots", "poses", "made_joints", "made_roots")
PLAIN = ("scene", "state", "frame", "chosen", "count", "resample", "busy", "file")


def scene_of(edit: Edit, fps: float, names: list[str], strength: bool) -> dict:
    """The data that do not change: the length, the joints' names, the drawn body.

    `strength` says whether `make` has a resampling.
    """
    return {"frames": len(edit), "joints": J, "fps": fps, "names": names,
            "parts": body.parts_record(body.BODY), "keep": list(KEPT), "most": MOST,
            "strength": strength, "height": 380}  # fmt: skip


def state_of(edit: Edit, made: Made | None) -> dict:
    """The edit and its in-betweens as numbers and texts."""
    pins = sorted(edit.pins)
    kept = [] if edit.part is None else np.flatnonzero(body_part(1, edit.part)[0]).tolist()
    return {
        "pins": pins,
        "moved": [[joint_index(name) for name in edit.moved.get(f, ())] for f in pins],
        "part": edit.part or "", "kept": kept, "held": given_in_words(edit),
        "made": 0 if made is None else len(made.samples),
        "old": made is not None and made.edit is not edit,
        "measured": [] if made is None else [made.measured(k) for k in range(len(made.samples))],
    }  # fmt: skip


def given_in_words(edit: Edit) -> str:
    """A text: what is given now, and the frames where it contradicts itself."""
    words = f"{edit}."
    if edit.torn:
        words += (
            f" In {frames_in_words(edit.torn)} the pinned pose moves the part that is kept "
            "throughout: expect a jump."
        )
    return words


def poses_of(edit: Edit) -> bytes:
    """The pinned poses in the order of their frames, as bytes of float32."""
    return np.array([edit.pins[frame] for frame in sorted(edit.pins)], "<f4").tobytes()


def alt_text(edit: Edit, made: Made | None, fps: float) -> str:
    """The alternative text."""
    some = "" if made is None else f" {len(made.samples)} in-betweens generated."
    return (
        f"Motion editor: a skeleton moves for {len(edit) / fps:.1f} s, "
        f"{len(edit)} frames; {edit}.{some}"
    )


def frames_in_words(frames) -> str:
    """The first six frames as a text."""
    frames = sorted(frames)
    some = ", ".join(map(str, frames[:6])) + (" ..." if len(frames) > 6 else "")
    return f"frame{'s' * (len(frames) != 1)} {some}"


def complaint(error: Exception) -> str:
    """The message of an error; for an error of another library, with its type."""
    text = str(error.args[0]) if isinstance(error, KeyError) and error.args else str(error)
    ours = isinstance(error, ValueError | IndexError | KeyError)
    text = text if ours and text else f"{type(error).__name__}: {text}"
    return text[:1].upper() + text[1:] + ("" if text.endswith(".") else ".")


ENDING = re.compile(
    r"(.*)(\.[a-z][a-z0-9]{0,4})", re.IGNORECASE
)  # "a walk.txt", but not "take 1.5"


def file_of(name: str) -> str:
    """A name typed on the page, with the ending of the file that is written.

    Raises ValueError for an empty name, a name with a folder, and another ending.
    """
    if set(name) & set("/\\:"):
        raise ValueError(
            f"not saved: {name!r} contains a folder. Type only a name: the file goes to the "
            f"notebook's folder ({Path.cwd()}). To write elsewhere, name the editor and call its "
            "save(path) in a cell"
        )
    found = ENDING.fullmatch(name)
    stem, ending = found.groups() if found else (name, ".bvh")
    if not stem.strip(". "):
        raise ValueError("give the file a name")
    if ending.lower() != ".bvh":
        raise ValueError(f"not saved: only .bvh can be written, not {ending}. Type {stem}.bvh")
    return stem + ending


def free_name(path: Path) -> Path:
    """The first of walk-2.bvh, walk-3.bvh ... that no file has."""
    names = (path.with_stem(f"{path.stem}-{number}") for number in count(2))
    return next(name for name in names if not name.exists())


def save_as(editor, name: str) -> str:
    """Save to the notebook's folder under a name typed on the page; return a message.

    Raises ValueError for what is no name, and for that of a file which this kernel has not written,
    with a name that is free.
    """
    path = Path(file_of(name))
    ours = recordings.is_ours(path)
    if path.exists() and not ours:
        why = "was read" if path in recordings else "is from before this kernel"
        raise ValueError(
            f"not saved: {path} {why}, and it would be lost. Type another name, for instance "
            f"{free_name(path)}"
        )
    with contextlib.redirect_stdout(io.StringIO()):  # the page shows what `save` prints
        report = str(editor.save(path)).split(": ", 1)[1]
    what = "the in-between that is shown"
    if editor.samples is None:
        what = "the motion with its pinned poses; nothing is generated yet"
    over = ", which replaced the file saved before" * ours
    return f"Saved {path.resolve()} ({what}){over}: {report}."


def html_page(editor) -> str:
    """An HTML page with the editor in its current state.

    It needs no kernel and no network, but it cannot generate.
    """
    record = {name: base64.b64encode(getattr(editor, name)).decode() for name in BINARY}
    record |= {name: getattr(editor, name) for name in PLAIN} | {"busy": False}
    text = json.dumps(record, allow_nan=False).replace("<", "\\u003c")
    return PAGE.format(title=html.escape(editor.description), module=MODULE, record=text)


def strip(edit: Edit, sample: np.ndarray | None, fps: float, n: int = 6):
    """n poses as a pillow image: the motion with pinned poses, and below it the in-between."""
    figures = [poster.Figure(edit.positions, "with the pinned poses" if edit.pins else "")]
    figures += [] if sample is None else [poster.Figure(sample, "in-between")]
    return poster.filmstrip(figures, fps, n)
