"""Is a generated motion plausible beside what was given?

On motions unlike its training a network can fail badly: the figure jumps by metres between
keyframes that are close together, or sinks into the floor. Where it turns between two keyframes, it
can fold: its hips or shoulders come together. And a walk can lose its steps: then the figure
glides, standing, from keyframe to keyframe.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
import torch
from jaxtyping import Bool, Float

from ..motion.cleanup import runs
from ..motion.directions import ARMS, UPLEGS
from ..motion.faults import WILD
from ..motion.root_frame import FPS
from ..motion.skeleton import HIPS, TOES

# All from motions of training persons and synthetic walks (`recipes/recordings.py`).
# The pelvis may be so many times as fast as is needed, plus so many m/s times the root of the
# seconds between two given frames: so are 99 % of the gaps in recorded dances and fights.
FACTOR, SLACK = 3.0, 1.65
# In dances both feet slide for at most 0.35 s (a turn in a salsa), in walks never; in failed
# in-betweens of a walk for 0.7 s and more.
LOW = 0.08  # m above the 5th percentile of the toes' heights
SLIDES = 0.6  # m/s
GLIDE = 0.4  # s

# times the given width of hips and shoulders: nobody's are under 0.97 of their median
FOLDED = 0.7

# m in a second: of 473 gaps of a second in recorded dances and fights, none sinks so far
SINKS = 0.4

AGAIN = "So it was generated again there. Check the result"
CALMED = "So it was generated again there, nearer to the lines between keyframes. Check the result"
STILL = "Other draws are no better: give more keyframes, or draw straight lines between them"
DRAWS = (
    4  # of a sample that is not plausible, before its remainder around the lines is made smaller
)
CALMER = (0.5, 0.25, 0.0)  # times the remainder


@dataclass(frozen=True, order=True)
class Fault:
    """What is wrong with a generated motion. The worse of two is the greater one.

    Too fast or too low is worse than folded, and that is worse than any glide; `words` do not
    count.
    """

    wild: bool
    folded: int  # frames
    glide: int  # frames that both feet slide
    words: str = field(compare=False)


def fault_of(
    made: Float[np.ndarray, "T 21 3"],
    given: Float[np.ndarray, "T 21 3"],
    known: Bool[np.ndarray, "T 21"],
) -> Fault:
    """The worst fault of a generated motion; without one, its words are empty."""
    first, last = longest_glide(made, known)
    wild = wilder_than_given(made, given, known) or lower_than_given(made, given, known)
    flat = np.flatnonzero(folded(made, given, known))
    folds = f"the figure folds flat near frame {flat[len(flat) // 2]}" if len(flat) else ""
    glides = f"both feet slide between frames {first} and {last}" if last > first else ""
    return Fault(bool(wild), len(flat), last - first, wild or folds or glides)


def until_plausible(
    made: Float[np.ndarray, "T 21 3"],
    given: Float[np.ndarray, "T 21 3"],
    known: Bool[np.ndarray, "T 21"],
    again: Callable[[float], Float[np.ndarray, "T 21 3"]],
) -> tuple[Float[np.ndarray, "T 21 3"], str]:
    """A generated motion, drawn again where it is not plausible, and what there is to say about it.

    `again(remainder)` draws another one (`Inbetweener.fill`). It is called with 1, up to DRAWS - 1
    times. What is still too fast or too low is drawn with smaller and smaller remainders around
    the lines between what is given.
    Between two frames that are given whole, the best draw is taken. Nothing is said of a fold or a
    glide that another draw mended.
    """
    first = fault = fault_of(made, given, known)
    for _ in range(DRAWS - 1):
        if not fault.words:
            return made, f"{first.words}. {AGAIN}" if first.wild else ""
        made = better_parts(made, again(1.0), given, known)
        fault = fault_of(made, given, known)
    end = AGAIN
    for remainder in CALMER:
        if not fault.wild:
            break
        made, end = better_parts(made, again(remainder), given, known), CALMED
        fault = fault_of(made, given, known)
    if fault.wild:
        return made, f"{fault.words}. {STILL}"
    if fault.words:
        return made, (
            f"{fault.words}, and no other of {DRAWS} draws was better. Give a keyframe there, or "
            f"try another seed"
        )
    return made, f"{first.words}. {end}" if first.wild else ""


def better_parts(
    made: Float[np.ndarray, "T 21 3"],
    other: Float[np.ndarray, "T 21 3"],
    given: Float[np.ndarray, "T 21 3"],
    known: Bool[np.ndarray, "T 21"],
) -> Float[np.ndarray, "T 21 3"]:
    """The motion, and the other one in the parts where it has a smaller fault.

    A part lies between two frames that are given whole, where both motions agree. If no part has a
    fault by itself, the motion is one part.
    """
    parts = [
        part for part in parts_of(known) if fault_of(made[part], given[part], known[part]).words
    ]
    best = made.copy()
    for part in parts or [slice(None)]:
        faults = [fault_of(one[part], given[part], known[part]) for one in (made, other)]
        if faults[1] < faults[0]:
            best[part] = other[part]
    return best


def parts_of(known: Bool[np.ndarray, "T 21"]) -> list[slice]:
    """The parts between frames that are given whole, both of them included."""
    cuts = sorted({0, *np.flatnonzero(known.all(1)).tolist(), len(known) - 1})
    return [slice(a, b + 1) for a, b in pairwise(cuts) if b - a > 1]


def each_until_plausible(
    samples: Iterable[Float[np.ndarray, "T 21 3"]],
    draws: Sequence[torch.Generator],
    given: Float[np.ndarray, "T 21 3"],
    known: Bool[np.ndarray, "T 21"],
    generate: Callable[[list, float], Float[np.ndarray, "N T 21 3"]],
) -> list[tuple[Float[np.ndarray, "T 21 3"], str]]:
    """`until_plausible` of every sample; each is drawn again by its own generator.

    `generate(draws, remainder)` draws a motion for each of the generators.
    """

    def again(draw: torch.Generator) -> Callable[[float], Float[np.ndarray, "T 21 3"]]:
        return lambda share: generate([draw], share)[0]

    return [
        until_plausible(first, given, known, again(draw))
        for draw, first in zip(draws, samples, strict=True)
    ]


def wilder_than_given(
    made: Float[np.ndarray, "T J 3"],
    given: Float[np.ndarray, "T J 3"],
    known: Bool[np.ndarray, "T J"],
) -> str:
    """What is too fast in a generated motion, in words; "" if nothing was found.

    Between two frames with a known pelvis, the given motion asks for a speed: the distance over the
    time. A pelvis that moves much faster is not plausible, nor is a joint faster than any actor's.
    Frames before the first and after the last known pelvis are not judged by this speed.
    """
    there = np.flatnonzero(known[:, HIPS])
    paces = FPS * np.linalg.norm(np.diff(made[:, HIPS], axis=0), axis=-1)
    found = []
    for first, last in zip(there[:-1], there[1:], strict=True):
        if last - first < 2:
            continue
        asked = FPS * np.linalg.norm(given[last, HIPS] - given[first, HIPS]) / (last - first)
        pace = paces[first:last].max()
        if pace > FACTOR * asked + SLACK * ((last - first) / FPS) ** 0.5:
            found.append((pace, asked, first, last))
    if found:
        pace, asked, first, last = max(found)
        others = f" ({len(found)} such gaps)" if len(found) > 1 else ""
        return (
            f"the generated figure moves at up to {pace:.1f} m/s between frames {first} and {last},"
            f" where {asked:.1f} m/s would do{others}. The network knows walks and dances, and this"
            f" motion may be too different"
        )
    joints = FPS * np.linalg.norm(np.diff(made, axis=0), axis=-1)
    joints = np.where(known[1:] & known[:-1], 0.0, joints)
    if joints.size and joints.max() > WILD:
        frame = int(np.unravel_index(joints.argmax(), joints.shape)[0])
        return (
            f"a generated joint moves at {joints.max():.0f} m/s near frame {frame}, faster than any"
            f" actor's"
        )
    return ""


def lower_than_given(
    made: Float[np.ndarray, "T J 3"],
    given: Float[np.ndarray, "T J 3"],
    known: Bool[np.ndarray, "T J"],
) -> str:
    """Where a generated pelvis sinks far below the given ones before and after, in words; or ""."""
    there, height = np.flatnonzero(known[:, HIPS]), made[:, HIPS, 1]
    for first, last in zip(there[:-1], there[1:], strict=True):
        ends = min(given[first, HIPS, 1], given[last, HIPS, 1])
        lowest = height[first : last + 1].min()
        if ends - lowest > SINKS * max(1.0, (last - first) / FPS):
            return (
                f"the generated pelvis sinks to {lowest:.2f} m between frames {first} and {last}, "
                f"where it is given at {ends:.2f} m and higher"
            )
    return ""


def folded(
    made: Float[np.ndarray, "T J 3"],
    given: Float[np.ndarray, "T J 3"],
    known: Bool[np.ndarray, "T J"],
) -> Bool[np.ndarray, "T"]:
    """The frames in which generated hips or shoulders are closer together than bodies allow.

    The width is that of the given frames; a pair that is given in none is not judged.
    """
    found = np.zeros(len(made), bool)
    for left, right in (UPLEGS, ARMS):
        there = known[:, left] & known[:, right]
        if there.any():
            width = np.linalg.norm(given[there, left] - given[there, right], axis=-1)
            gap = np.linalg.norm(made[:, left] - made[:, right], axis=-1)
            found |= ~there & (gap < FOLDED * np.median(width))
    return found


def longest_glide(
    made: Float[np.ndarray, "T J 3"], known: Bool[np.ndarray, "T J"]
) -> tuple[int, int]:
    """The frames (first, last) of the longest glide: both feet slide, and are generated.

    Both toes are low and fast. (0, 0) if no run is as long as GLIDE.
    """
    toes = made[:, list(TOES)]
    speed = FPS * np.linalg.norm(np.diff(toes[..., [0, 2]], axis=0), axis=-1)
    low = toes[..., 1] < np.percentile(toes[..., 1], 5) + LOW
    generated = ~(known[1:] & known[:-1])[:, list(TOES)]
    slides = ((speed > SLIDES) & low[1:] & low[:-1] & generated).all(1)
    found = [(last - first, first, last) for first, last in runs(slides).tolist()]
    length, first, last = max(found, default=(0, 0, 0))
    return (first, last) if length >= GLIDE * FPS else (0, 0)
