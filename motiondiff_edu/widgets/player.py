"""The player: moving figures.

Live in JupyterLab, alive in exported HTML, a picture where nothing runs.

Notebooks are to be saved without widget state: with it, exported pages look for the module on the
network. Space plays, arrows step (up and down by ten), Home and End jump, + and - zoom, F follows,
M mutes, R resets; drag to turn. With a sound, the sound is the clock: the frame shown is floor(time
heard x fps), at any speed.
Notebook: 00, 12
"""

import base64
import html
import json
import math
import os
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TypeAlias, TypeVar

import anywidget
import numpy as np
import traitlets
from numpy.typing import ArrayLike

from .._files import check_writable, replacing
from ..motion.arguments import checked_rate, is_number
from ..viz import body, style
from . import films, lane, module, packing, poster
from .lane import Soundtrack
from .still import page_on_picture, with_still

__all__ = ["Look", "Player", "Soundtrack", "describe"]

MODULE = module.es_module()
LOWEST, HIGHEST = 60, 4000  # pixels
HIGHEST_IN_DEMOS = 340  # pixels: so the buttons below are seen as well at 1280 x 720
GIF_FPS = 50  # browsers slow a GIF down whose pictures stay for less than 20 ms
_TRAITS = ("joints", "roots", "contacts", "sound", "strips")

Value = TypeVar("Value")
PerFigure: TypeAlias = Value | Sequence[Value | None] | None  # one value for all figures, or a list
Figures = ArrayLike | Sequence[ArrayLike]  # (T, J, 3), (N, T, J, 3), or a list of (T, J, 3)
Audio = ArrayLike | bytes | bytearray | memoryview | Soundtrack | None

PAGE = """<!doctype html><html lang="en"><head><meta charset="utf-8">\
<meta name="viewport" content="width=device-width, initial-scale=1"><title>{title}</title>
<style>html,body{{margin:0;height:100%}}@media print{{html,body{{height:auto}}}}</style></head>\
<body>
<script type="module">
{module}
document.body.style.background = "#fff";
mount(staticModel({record}), document.body, {{ fill: true }});
</script></body></html>"""


@dataclass(frozen=True)
class Look:
    """How figures are laid out and begin.

    `layout`: "side" (a field each) or "together" (one floor, `offset` (x, z) metres apart).
    `height`: pixels; in a demo no more than fit a projector together with the buttons.
    `autoplay`: by default only without a sound; with one the browser must allow it. In a demo a
    figure with a sound begins, too, but muted.
    `follow`: the camera goes with the figure.
    `parents`: each joint's parent, where the skeleton is not the course's.
    Raises ValueError for another layout, a height that is no picture's, an offset that is not
    finite, and parents that lead to no root.
    """

    layout: str = "side"
    offset: tuple[float, float] = (1.2, 0.0)
    height: int = 430
    autoplay: bool | None = None
    follow: bool = True
    parents: Sequence[int] | None = None

    def __post_init__(self):
        if self.layout not in ("side", "together"):
            raise ValueError(f'layout is "side" or "together", not {self.layout!r}')
        if not is_number(self.height) or not LOWEST <= self.height <= HIGHEST:
            raise ValueError(f"height is {LOWEST} to {HIGHEST} pixels, not {self.height!r:.40}")
        if len(self.offset) != 2 or not np.isfinite(self.offset).all():
            raise ValueError(f"offset is (x, z) in metres, not {self.offset!r:.40}")
        if self.parents is not None:
            check_parents(self.parents)


def check_parents(parents: Sequence[int]) -> None:
    """Raise ValueError unless the parents of each joint lead to a root, whose own parent is -1."""
    for joint, parent in enumerate(parents):
        if parent != int(parent) or not -1 <= parent < len(parents):
            raise ValueError(
                f"parents[{joint}] = {parent!r:.40}: it must be another joint's number, or -1 for "
                f"the root; there are {len(parents)} joints"
            )
    for joint in range(len(parents)):
        above = joint
        for _ in parents:
            above = parents[above] if above >= 0 else above
        if above >= 0:
            raise ValueError(f"parents: joint {joint} leads to no root, but in a circle")


USUAL = Look()


class _AsBefore:
    def __repr__(self) -> str:
        return "as before"


AS_BEFORE = _AsBefore()  # the default of each of `Player.show`'s parameters


class Player(anywidget.AnyWidget):
    """Show one motion or several, world positions in metres, y up.

    One motion (T, J, 3), a batch (N, T, J, 3) or a list of motions.

    `past` frames were given and are drawn paler; `contacts` (T, 2) bool marks planted feet; `path`
    (n, 2) [x, z] is drawn on the floor; each may be one value for all figures or a list (one array
    of contacts belongs to the first figure).
    `audio`: the bytes of a sound file, or a `Soundtrack`, which takes samples with their rate. It
    is played with the motion, cut or filled up to its length (with a warning), above its waveform.
    `look`: layout, height, autoplay, and the parents of another skeleton's joints.
    `frame` and `playing` can be read and set; so can `notes`, lines of plain text below the
    figures, which another motion takes away.
    Raises ValueError with figure, frame and joint where a position is not finite or beyond reach,
    and for extras that do not fit the motion.   Notebook: 00, 12
    """

    _esm = MODULE
    scene = traitlets.Dict().tag(sync=True)
    joints = traitlets.Bytes().tag(sync=True)
    roots = traitlets.Bytes().tag(sync=True)
    contacts = traitlets.Bytes().tag(sync=True)
    music = traitlets.Dict().tag(sync=True)
    notes = traitlets.List(traitlets.Unicode()).tag(sync=True)
    sound = traitlets.Bytes().tag(sync=True)
    strips = traitlets.Bytes().tag(sync=True)
    frame = traitlets.Int(0).tag(sync=True)
    playing = traitlets.Bool(False).tag(sync=True)

    def __init__(
        self,
        positions: Figures,
        fps: float | int = 20.0,
        past: PerFigure[int] = None,
        contacts: PerFigure[ArrayLike] = None,
        labels: PerFigure[str] = None,
        path: PerFigure[ArrayLike] = None,
        audio: Audio = None,
        look: Look = USUAL,
    ):
        super().__init__()
        self._options = {}
        self._look = look
        self._editions = 0
        self.show(positions, fps, past, contacts, labels, path, audio)

    def show(
        self,
        positions: Figures,
        fps: float | int | _AsBefore = AS_BEFORE,
        past: PerFigure[int] | _AsBefore = AS_BEFORE,
        contacts: PerFigure[ArrayLike] | _AsBefore = AS_BEFORE,
        labels: PerFigure[str] | _AsBefore = AS_BEFORE,
        path: PerFigure[ArrayLike] | _AsBefore = AS_BEFORE,
        audio: Audio | _AsBefore = AS_BEFORE,
    ) -> None:
        """Show another motion in the same place; what is not given stays as it was."""
        given = {"fps": fps, "past": past, "contacts": contacts}
        given |= {"labels": labels, "path": path, "audio": audio}
        given = {name: value for name, value in given.items() if value is not AS_BEFORE}
        options = self._options | given
        options["fps"] = checked_rate(options["fps"])
        arrays = packing.as_figures(positions)
        packed = packing.pack(arrays)
        figures = _figures(arrays, options, self._look.parents)
        music = lane.of(options["audio"], max(packed.frames), options["fps"])
        self._figures = figures
        self._options = options
        self._music = music
        self._editions += 1  # another motion may have the same scene: this tells the page of it
        with self.hold_sync():
            self.joints, self.roots = packed.joints, packed.roots
            self.notes = []
            self.contacts = packing.pack_contacts([f.contacts for f in figures], packed.frames)
            self.frame = min(self.frame, max(packed.frames) - 1)
            self.sound, self.strips, self.music = (
                (b"", b"", {}) if music is None else music.traits()
            )
            self.scene = _scene(figures, options["fps"], self._look, music) | {
                "edition": self._editions
            }

    @property
    def description(self) -> str:
        """What is to be seen, in one sentence: the alternative text."""
        return self.scene["description"]

    @traitlets.validate("frame")
    def _frame_exists(self, proposal):
        last = self._last()
        if self.scene and not 0 <= proposal["value"] <= last:
            raise traitlets.TraitError(
                f"frame {proposal['value']} does not exist; frames are 0 to {last}"
            )
        return proposal["value"]

    def set_state(self, sync_data: dict) -> None:
        """Take what the page says; its frame may be one of a longer motion that was shown before.

        The page says it while a shorter motion is on its way there.
        """
        if "frame" in sync_data:
            frame = min(max(sync_data["frame"], 0), self._last())
            sync_data = sync_data | {"frame": frame}
        super().set_state(sync_data)

    def _last(self) -> int:
        return max((f["frames"] for f in self.scene.get("figures", [])), default=1) - 1

    def page(self) -> str:
        """A whole HTML page with the module and the motion in it.

        Needs no kernel and no network.
        """
        record = {name: base64.b64encode(getattr(self, name)).decode() for name in _TRAITS}
        record |= {"scene": self.scene, "music": self.music, "notes": self.notes}
        record |= {"frame": self.frame, "playing": False}
        text = json.dumps(record, allow_nan=False).replace("<", "\\u003c")
        return PAGE.format(title=html.escape(self.description), module=MODULE, record=text)

    def poster(self, n: int = 6):
        """A strip of n poses as a pillow image, the music lane below.

        What is shown where nothing runs.
        """
        strip = poster.filmstrip(self._figures, self._options["fps"], n)
        return strip if self._music is None else self._music.under(strip)

    def _repr_mimebundle_(self, **kwargs):
        height = self.scene["height"] + 90 + (self._music.height if self._music else 0)
        still = page_on_picture(
            self.page(), self.poster(), self.description, "motion player", height
        )
        return with_still(super()._repr_mimebundle_(**kwargs), still)

    def save_html(self, path: str | os.PathLike) -> Path:
        """Write the figure as one HTML file that plays anywhere, offline."""
        with replacing(path) as part:
            part.write_text(self.page(), "utf-8")
        return Path(path).expanduser()

    def save_gif(self, path: str | os.PathLike, size: tuple[int, int] = (400, 360)) -> Path:
        """Write the figure as an endless GIF, each figure `size` pixels.

        Raises OSError, before a picture is drawn, for a place where no file can be made.
        """
        check_writable(path)
        palette = poster.film_palette(self._figures, size)
        fps = self._options["fps"]
        every = math.ceil(fps / GIF_FPS)
        pictures = poster.film(self._figures, fps, size, every)
        first, *rest = (p.quantize(palette=palette, dither=0) for p in pictures)
        pauses = _hundredths(1 + len(rest), fps / every)
        with replacing(path) as part:
            first.save(
                part,
                "GIF",
                save_all=True,
                append_images=rest,
                duration=pauses,
                loop=0,
                optimize=False,
            )
        return Path(path).expanduser()

    def save_mp4(self, path: str | os.PathLike, size: tuple[int, int] = (480, 432)) -> Path:
        """Write the figure as MP4, each figure `size` pixels, with its sound.

        Raises as `films.write_mp4`: ImportError without imageio-ffmpeg, FilmError if it fails.
        """
        fps = self._options["fps"]
        pictures = poster.film(self._figures, fps, size)
        music = None if self._music is None else self._music.sound
        return films.write_mp4(path, pictures, (size[0] * len(self._figures), size[1]), fps, music)


def _hundredths(n: int, fps: float) -> list[int]:
    """How long to show each of n pictures, in ms: whole hundredths of a second that sum up right.

    A GIF knows no shorter time, so at 30 pictures a second some stay for 3 and some for 4.
    """
    ends = [10 * round(100 * k / fps) for k in range(n + 1)]
    return [end - start for start, end in pairwise(ends)]


def _figures(arrays: list, options: dict, parents: Sequence | None) -> list[poster.Figure]:
    count = len(arrays)
    parts = body.parts_for(arrays[0].shape[1], parents)
    contacts = packing.as_contacts(options["contacts"], [len(a) for a in arrays])
    labels = [label or "" for label in packing.per_figure(options["labels"], count, "labels")]
    pasts = packing.per_figure(options["past"], count, "past")
    paths = (
        options["path"] if isinstance(options["path"], list | tuple) else [options["path"]] * count
    )
    paths = [
        None if p is None else np.asarray(p, dtype=np.float64)
        for p in packing.per_figure(paths, count, "path")
    ]
    columns = zip(arrays, labels, pasts, contacts, paths, strict=True)
    return [poster.Figure(a, label, past, c, p, parts) for a, label, past, c, p in columns]


def _scene(figures: list[poster.Figure], fps: float, look: Look, music: lane.Lane | None) -> dict:
    records = [
        {"frames": len(f), "label": f.label, "past": f.past, "contacts": f.contacts is not None,
         "path": None if f.path is None else f.path.round(4).tolist()}
        for f in figures
    ]  # fmt: skip
    words = (
        describe(figures, fps) if music is None else f"{describe(figures, fps)} {music.description}"
    )
    parts = body.parts_record(figures[0].parts)
    muted = style.PROJECTED and music is not None and look.autoplay is None
    autoplay = (music is None or muted) if look.autoplay is None else bool(look.autoplay)
    highest = HIGHEST_IN_DEMOS if style.PROJECTED else HIGHEST
    offset = look.offset if look.layout == "together" else (0, 0)
    return {
        "layout": look.layout,
        "offset": [float(v) for v in offset],
        "height": min(int(look.height), highest),
        "follow": bool(look.follow),
        "parents": None if look.parents is None else [int(p) for p in look.parents],
        "fps": fps,
        "figures": records,
        "joints": figures[0].positions.shape[1],
        "parts": parts,
        "autoplay": autoplay,
        "muted": muted,
        "description": words,
    }


def describe(figures: list[poster.Figure], fps: float) -> str:
    """One sentence for those who cannot see it.

    How many figures, how long, how far they go, what was given.
    """
    words = []
    for i, f in enumerate(figures, 1):
        way = np.linalg.norm(f.positions[-1, 0, [0, 2]] - f.positions[0, 0, [0, 2]])
        given = "" if f.past is None else f", the first {f.past / fps:.1f} s given and drawn paler"
        words.append(
            f"{f.label or f'figure {i}'}: {len(f) / fps:.1f} s, "
            f"ends {way:.1f} m from its start{given}"
        )
    return "Moving skeletons, left limbs blue and right limbs orange. " + "; ".join(words) + "."
