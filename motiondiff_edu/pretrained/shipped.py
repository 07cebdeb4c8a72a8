"""The front door's functions that change a motion with shipped weights.

Notebook: 15, 17
"""

import warnings
from dataclasses import replace
from functools import lru_cache

import numpy as np
from jaxtyping import Bool, Float

from ..conditions.acts import in_words
from ..editing import by_words
from ..editing import reconstruct as reconstruction
from ..editing.by_words import STRENGTH
from ..editing.inbetween import clean_samples
from ..editing.plausible import each_until_plausible, longest_glide
from ..metrics.strays import strays
from ..motion.arguments import checked_count, checked_samples, checked_seed, checked_strength
from ..motion.cleanup import Body, clean_up, floor_under
from ..motion.known import checked_known
from ..motion.motion import Motion, MotionError, MotionWarning, as_motion
from ..motion.root_frame import FPS
from ..motion.skeleton import HIPS, TOES
from ..performers.inbetweener import Inbetweener
from ..performers.mover import LONGEST, SHORTEST, TRIES, Mover, until_shown, written
from ..performers.performer import STEPS, bar, generators
from ..performers.walker import Walker
from . import checkpoints
from .checkpoints import P

LEARNT = 5.0  # s: the windows of the in-betweener's training
STRONGER = 0.15  # of the noise, each time that an edit is drawn again


def inbetween(
    motion: Motion,
    known: Bool[np.ndarray, "T J"],
    *,
    samples: int = 1,
    seed: int = 0,
    steps: int = STEPS,
    progress: bool = True,
) -> Motion | list[Motion]:
    """Generate the joints that are not `known`, with the shipped in-betweener.

    Known joints stay exactly where they are. In a frame with a known joint, the pelvis must be
    known too. With `samples` above 1, the result is a list with this many motions.
    On a motion unlike those of the training a network can fail, and the figure jumps, sinks or
    folds. If a result moves much faster or lower than the given frames require, if its hips or
    shoulders come together, or its feet glide, it is drawn again there, and what is too fast or too
    low at last nearer to the lines between keyframes (`editing.plausible`). A MotionWarning says
    so, except of a fold or a glide that another draw mended; and one says where keyframes are
    farther apart than any in the training, and where a result leaves what was given
    (`metrics.strays`). The notes of each result say the same. The samples of a smaller number are
    the first ones of a larger number.
    Raises MotionError or ValueError if motion, mask or numbers do not fit.
    Source: MoFusion 4.4.  Notebook: 15
    """
    known, count = _fitting(motion, known), checked_samples(samples)
    checked_seed(seed)
    inbetweener = _shipped(Inbetweener)
    steps = min(checked_count(steps, "steps"), inbetweener.schedule.S)
    if known.all():
        raise MotionError(
            f"{motion.name}: every joint is known, so there is nothing to generate; give fewer"
        )
    words, apart = "", np.diff(np.flatnonzero(known.any(1))).max(initial=0) / FPS
    if not known.any():
        words = "no joint is known, so the result has nothing to do with this motion"
    elif apart > LEARNT:
        words = (
            f"given frames are {apart:.1f} s apart, and the network has learnt from pieces of "
            f"{LEARNT:g} s: what it makes there has little to do with this motion"
        )
    if words:
        warnings.warn(f"{motion.name}: {words}", MotionWarning, stacklevel=2)

    def generate(draws: list, remainder: float) -> Float[np.ndarray, "samples T 21 3"]:
        made = inbetweener.fill(
            motion.positions, known, samples=len(draws), steps=steps, remainder=remainder,
            generator=draws, watch=bar("filling in", steps + 1, progress),
        )  # fmt: skip
        return clean_samples(made, known)

    draws = generators(seed, count)
    made, notes = [], []
    first = generate(draws, 1.0)
    for positions, note in each_until_plausible(first, draws, motion.positions, known, generate):
        one = _made(motion, known, positions, "in-betweens")
        made.append(_looked_at(one, motion, known, words, note))
        notes += [note] if note else []
    if notes:
        which = f" ({len(notes)} of {count} samples)" if count > 1 else ""
        warnings.warn(f"{motion.name}{which}: {notes[0]}", MotionWarning, stacklevel=2)
    return made if samples > 1 else made[0]


def reconstruct(
    motion: Motion,
    known: Bool[np.ndarray, "T J"],
    *,
    samples: int = 1,
    seed: int = 0,
    progress: bool = True,
) -> Motion | list[Motion]:
    """Reconstruct the joints that are not `known`, with the shipped walker; any length of motion.

    Known joints stay exactly where they are. The pelvis must be known in every frame, because the
    control of the walk is derived from it. With `samples` above 1, the result is a list with this
    many motions; the first is that of samples=1. Where the figure is faster than in the walker's
    training, a MotionWarning says so.
    Raises MotionError if the pelvis is missing in a frame, or if motion and mask do not fit, and
    ValueError for a number of samples under 1.  Source: MoDiff III-E.
    """
    known, count = _fitting(motion, known), checked_samples(samples)
    checked_seed(seed)
    walker, draws = _shipped(Walker), generators(seed, count)
    watch = bar("reconstructing", reconstruction.ROUNDS, progress)
    made = [
        reconstruction.reconstruct(walker, motion.positions, known, generator=draw, watch=watch)
        for draw in draws
    ]
    doubt = reconstruction.other_side_in_doubt(walker, made[0], known, generators(seed, 1, 1)[0])
    for words in filter(None, [doubt]):
        warnings.warn(f"{motion.name}: {words}", MotionWarning, stacklevel=2)
    made = [
        _looked_at(_made(motion, known, positions, "reconstructed"), motion, known, doubt)
        for positions in made
    ]
    return made if samples > 1 else made[0]


def edit(
    motion: Motion,
    text: str,
    known: Bool[np.ndarray, "T J"] | None = None,
    *,
    strength: float = STRENGTH,
    samples: int = 1,
    seed: int = 0,
    tries: int = TRIES,
    progress: bool = True,
) -> Motion | list[Motion]:
    """Change a motion by a sentence, with the shipped mover.

    The motion is noised part of the way, and denoised under the sentence, which says what the whole
    figure does, the legs included. `known` joints keep their places about the root; while the
    pelvis is known from the first frame on, the path stays, too, and they are exactly where they
    were. Bones have the lengths of the motion's, and feet that stand do not slide
    (`motion/cleanup`). `strength`, above 0 and up to 1, is the share of the noise: higher values
    keep less of the motion; 1 keeps only the known joints. What does not show the acts of the
    sentence is drawn again, with more and more noise, `tries` times in all; a MotionWarning says
    what is not to be seen. With `samples` above 1, the result is a list with this many motions; the
    first is that of samples=1. A MotionWarning says where the feet slide, and did not before.
    Raises MotionError if motion and mask do not fit, or the motion is shorter or longer than those
    of the training, TextError for a text that cannot be read, and ValueError for numbers out of
    range.
    Source: SDEdit (Meng and others, 2022); MoFusion claims edits by text without a method.
    """
    _fitting(motion, as_motion(motion).known)
    if not motion.known.all():
        raise MotionError(
            f"{motion.name}: joints are missing; fill them in first, with "
            "md.reconstruct(motion, motion.known)"
        )
    if not SHORTEST <= motion.seconds <= LONGEST:
        cut = ": take a part of it, in Python motion[:200]" if motion.seconds > LONGEST else ""
        raise MotionError(
            f"{motion.name} lasts {motion.seconds:.1f} s; edits by words take {SHORTEST:g} to "
            f"{LONGEST:g} s{cut}"
        )
    mask = None if known is None else _fitting(motion, known)
    if mask is not None and mask.all():
        raise MotionError(f"{motion.name}: everything is known, so nothing can be edited")
    count = checked_samples(samples)
    checked_seed(seed)
    checked_strength(strength)
    tries = checked_count(tries, "tries")
    mover = _shipped(Mover)
    found = mover.reader.read(text)
    for note in found.notes:
        warnings.warn(note, MotionWarning, stacklevel=2)
    nothing = np.zeros((len(motion), len(motion.skeleton)), bool)
    kept = nothing if mask is None else mask
    body, floor = Body.of(motion.positions), floor_under(motion.positions)

    def draw(which: list[int], again: int) -> list[Float[np.ndarray, "T 21 3"]]:
        draws = generators(seed, count, *([again] if again else []))
        draws = [draws[k] for k in which]
        made = by_words.edit_by_words(
            mover, motion.positions, found, mask,
            strength=min(1.0, strength + again * STRONGER),
            plan=written(found.asked, len(motion), draws) if again else None, generator=draws,
            watch=bar("editing", shown=progress),
        )  # fmt: skip
        return [clean_up(one, FPS, kept, body=body, floor=floor) for one in made]

    made, wrong = until_shown(found.asked, draw, count, tries)
    _warn_of_glides(motion, made)
    edited = []
    for positions, words in zip(made, wrong, strict=True):
        notes = (f"asked: {text.strip():.80}; but {'; '.join(words)}",) if words else ()
        for note in notes:
            warnings.warn(f"{motion.name}: {note}", MotionWarning, stacklevel=2)
        one = _made(motion, nothing, positions, f"edited: {text.strip():.40}")
        about = in_words(found.asked)
        edited.append(replace(one, notes=(*one.notes, *found.notes, *notes), about=about))
    return edited if samples > 1 else edited[0]


def _warn_of_glides(motion: Motion, made: list[Float[np.ndarray, "T 21 3"]]) -> None:
    """A MotionWarning where the feet of an edited motion slide, and did not before."""
    nothing = np.zeros((len(motion), len(motion.skeleton)), bool)
    glides = [glide for one in made if any(glide := longest_glide(one, nothing))]
    if glides and not any(longest_glide(motion.positions, nothing)):
        which = f" ({len(glides)} of {len(made)} samples)" if len(made) > 1 else ""
        first, last = glides[0]
        warnings.warn(
            f"{motion.name}{which}: both feet slide between frames {first} and {last}. The "
            "sentence must say what the legs do as well, such as 'walks forward while waving', and "
            "match the joints that are kept",
            MotionWarning,
            stacklevel=3,
        )


def _looked_at(made: Motion, motion: Motion, known: Bool[np.ndarray, "T 21"], *said: str) -> Motion:
    """The motion with notes: what was said, and where it leaves the joints of `motion` that were
    known, which is a MotionWarning, too.
    """
    given = np.where(known[..., None], motion.positions, np.nan)
    found = strays(made.positions, given, ~known)
    for words in found:
        warnings.warn(f"{made.name}: {words}", MotionWarning, stacklevel=3)
    return replace(made, notes=(*made.notes, *filter(None, said), *found))


@lru_cache(maxsize=4)  # nobody else gets them, so one copy serves all verbs
def _shipped(kind: type[P]) -> P:
    """The shipped performer of the usual name."""
    made = checkpoints.load(kind.__name__.lower())
    assert isinstance(made, kind)
    return made


def _fitting(motion: Motion, known) -> Bool[np.ndarray, "T J"]:
    """The mask, checked.  Raises MotionError unless mask and frame rate fit the networks."""
    if abs(as_motion(motion).fps - FPS) > 1e-6:
        raise MotionError(
            f"{motion.name} has {motion.fps:g} frames/s, but the networks need {FPS:g}: use "
            f"motion.resampled({FPS:g}), and a `known` mask for that motion"
        )
    motion.check_size()
    return checked_known(motion, known)


def _made(motion: Motion, known: np.ndarray, positions: np.ndarray, how: str) -> Motion:
    """The motion with new positions.

    It keeps its root if no pelvis was generated, and its contacts if no toe was.
    """
    return replace(
        motion,
        positions=positions,
        root=motion.root if known[:, HIPS].all() else None,
        contacts=motion.contacts if known[:, list(TOES)].all() else None,
        source=f"{motion.name}, {how}",
    )
