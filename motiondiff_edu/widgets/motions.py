"""A Motion in the player, as a film (.mp4, .gif) and as a page (.html).

Notebook: 00
"""

import os
import sys
import tempfile
import webbrowser
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Float

from ..motion import registry
from ..motion.motion import Motion, MotionError, as_motion
from ..motion.skeleton import COURSE
from .browsers import folder_for_pages, has_a_screen
from .player import Look, Player, Soundtrack


def player_of(motions: Sequence[Motion], labels: Sequence[str] | None = None) -> Player:
    """Several motions side by side, at the frame rate of the first, with the first sound.

    The notes of the motions stand below them. Contacts are shown on the course's skeleton alone,
    whose heels and toes they belong to.
    Raises MotionError for a missing joint, different skeletons, or a wrong number of labels.
    """
    first = motions[0]
    for motion in motions:
        motion.check_finite()
        if motion.skeleton != first.skeleton:
            raise MotionError(
                f"{first.name} and {motion.name} have different skeletons: play them separately"
            )
    if labels is not None and len(labels) != len(motions):
        raise MotionError(f"{len(labels)} labels for {len(motions)} motions: pass one for each")
    shown = [motion.resampled(first.fps) for motion in motions]
    sounding = next((motion for motion in shown if motion.audio is not None), first)
    longest = max(shown, key=len)
    sound = None
    if sounding.audio is not None:
        sound = Soundtrack(_as_long(sounding, longest), sample_rate=sounding.sample_rate)
    ours = first.skeleton == COURSE
    names = _distinct_labels(shown) if labels is None else list(labels)
    player = Player(
        [motion.positions for motion in shown],
        fps=first.fps,
        contacts=[motion.contacts if ours else None for motion in shown],
        labels=names,
        audio=sound,
        look=Look(parents=None if ours else list(first.skeleton.parents)),
    )
    player.notes = _notes(shown, names)
    return player


def _notes(motions: Sequence[Motion], labels: Sequence[str]) -> list[str]:
    """The notes of all motions, each once; of several, with the labels of those that have it."""
    whose: dict[str, list[str]] = {}
    for k, motion in enumerate(motions):
        for note in dict.fromkeys(motion.notes):
            whose.setdefault(note, []).append(labels[k] or f"figure {k + 1}")
    if len(motions) == 1:
        return list(whose)
    return [f"{', '.join(names)}: {note}" for note, names in whose.items()]


def _distinct_labels(motions: Sequence[Motion]) -> list[str]:
    """The sources of the motions; those that occur more than once are numbered."""
    names = [motion.source for motion in motions]
    many = {name for name in names if name and names.count(name) > 1}
    return [
        f"{name} ({names[: k + 1].count(name)})" if name in many else name
        for k, name in enumerate(names)
    ]


def _as_long(sounding: Motion, longest: Motion) -> Float[np.ndarray, "N"]:
    """The sound, cut or padded with silence to the length of the longest motion."""
    assert sounding.sample_rate is not None  # a motion with sound has it
    count = round(longest.seconds * sounding.sample_rate)
    sound = sounding.sound_in_step()[:count]
    return np.pad(sound, (0, count - len(sound)))


def play(
    *motions: Motion | Sequence[Motion],
    labels: Sequence[str] | None = None,
    path: str | Path | None = None,
    open_page: bool = True,
) -> Path | None:
    """Show motions side by side: in a notebook as a player, elsewhere as a page in the browser.

    path       where to write the page (default: a temporary file, or one in your home folder if
               your browser cannot read those); it is printed and returned
    open_page  False writes the page without opening the browser
    Raises MotionError as `player_of` does, TypeError for anything but a Motion.
    """
    figures = []
    for given in motions:
        figures += list(given) if isinstance(given, list | tuple) else [given]
    if not figures:
        raise TypeError("play needs at least one motion; md.read_motion(path) reads one")
    for one in figures:
        as_motion(one)
    if path is not None and Path(path).suffix.lower() != ".html":
        raise MotionError(
            f"{path}: play writes a page, so its name ends in .html; motion.save(path) writes films"
        )
    player = player_of(figures, labels)
    if path is None and _in_a_notebook():
        from IPython.display import display

        display(player)
        return None
    if path is None:
        folder = folder_for_pages()
        handle, name = tempfile.mkstemp(prefix="motiondiff_", suffix=".html", dir=folder)
        os.close(handle)
        path = name
    page = player.save_html(Path(path).expanduser()).resolve()
    print(f"the page is {page}", flush=True)
    if open_page and has_a_screen():
        webbrowser.open(page.as_uri())
    return page


def _in_a_notebook() -> bool:
    """Whether this process shows its outputs in a notebook."""
    shell = sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None
    return shell is not None and hasattr(shell, "kernel")


@registry.shows.register("player")
def show(motion: Motion):
    """The MIME bundle of the motion's player, or its text if a joint is missing."""
    if not motion.known.all():
        return {"text/plain": repr(motion)}
    bundle, metadata = player_of([motion])._repr_mimebundle_()
    return bundle | {"text/plain": repr(motion)}, metadata


@registry.writers.register(".html")
def write_page(motion: Motion, path: Path) -> None:
    """Write a page that plays in any browser, offline."""
    player_of([motion]).save_html(path)


@registry.writers.register(".gif")
def write_gif(motion: Motion, path: Path) -> None:
    """Write a GIF that repeats forever."""
    player_of([motion]).save_gif(path)


@registry.writers.register(".mp4")
def write_film(motion: Motion, path: Path) -> None:
    """Write a film with its sound.  Raises ImportError without imageio-ffmpeg."""
    player_of([motion]).save_mp4(path)
