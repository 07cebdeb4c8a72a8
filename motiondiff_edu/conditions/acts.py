"""Acts that a sentence can ask for: what can be said of each, its words, and how long it takes.

Notebook: 16
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

Parts = tuple[tuple["Act", ...], ...]


@dataclass(frozen=True)
class Act:
    """One verb, and what is said of it; an empty word, and a count of 0, say nothing.

    side  "left", "right" or "both";  speed  "slowly" or "quickly"
    direction  "forward", "aside" or "around"
    """

    verb: str
    side: str = ""
    count: int = 0
    speed: str = ""
    direction: str = ""


@dataclass(frozen=True)
class Kind:
    """What can be said of a verb: of the legs ("way", "spot") or of the arms."""

    part: str
    sides: tuple[str, ...] = ()
    most: int = 1
    speeds: tuple[str, ...] = ()
    directions: tuple[str, ...] = ()


ONE, ANY = ("left", "right"), ("left", "right", "both")
SPEEDS = ("slowly", "quickly")
KINDS = {
    "walk": Kind("way", speeds=SPEEDS),
    "run": Kind("way", speeds=("quickly",)),
    "back": Kind("way", speeds=("slowly",)),
    "aside": Kind("way", ONE, speeds=("slowly",)),
    "turn": Kind("way", ONE, directions=("around",)),
    "stand": Kind("way"),
    "squat": Kind("spot", most=4, speeds=SPEEDS),
    "jump": Kind("spot", most=4, directions=("forward",)),
    "kick": Kind("spot", ONE, 4, SPEEDS),
    "sit": Kind("spot", speeds=("slowly",)),
    "rise": Kind("spot", speeds=("slowly",)),
    "bow": Kind("spot", most=4, speeds=SPEEDS),
    "wave": Kind("arms", ANY, speeds=SPEEDS),
    "raise": Kind("arms", ANY, 4, SPEEDS),
    "hold": Kind("arms", ANY),
    "punch": Kind("arms", ONE, 4, SPEEDS),
    "clap": Kind("arms", most=4, speeds=SPEEDS),
    "point": Kind("arms", ONE, directions=("forward", "aside")),
}


# ---- in the plain words of the training ----------------------------------------------------------
PLAIN = {
    ("walk", ""): ("walks forward", "walking forward"),
    ("run", ""): ("runs forward", "running forward"),
    ("back", ""): ("walks backwards", "walking backwards"),
    ("aside", ""): ("steps to the {side}", "stepping to the {side}"),
    ("turn", ""): ("turns to the {side}", "turning to the {side}"),
    ("turn", "around"): ("turns around to the {side}", "turning around to the {side}"),
    ("stand", ""): ("stands still", "standing still"),
    ("squat", ""): ("squats", "squatting"),
    ("jump", ""): ("jumps up", "jumping up"),
    ("jump", "forward"): ("jumps forward", "jumping forward"),
    ("kick", ""): ("kicks with the {side} foot", "kicking with the {side} foot"),
    ("sit", ""): ("sits down", "sitting down"),
    ("rise", ""): ("gets up", "getting up"),
    ("bow", ""): ("bows", "bowing"),
    ("wave", ""): ("waves with {hand}", "waving with {hand}"),
    ("raise", ""): ("raises {limb}", "raising {limb}"),
    ("hold", ""): ("holds {limb} up", "holding {limb} up"),
    ("punch", ""): ("punches with the {side} hand", "punching with the {side} hand"),
    ("clap", ""): ("claps", "clapping"),
    ("point", "forward"): (
        "points forward with the {side} hand",
        "pointing forward with the {side} hand",
    ),
    ("point", "aside"): ("points to the {side}", "pointing to the {side}"),
}
TIMES = {0: "", 1: "once", 2: "twice", 3: "three times", 4: "four times"}
USUALLY = {"clap": 3}  # times, where nothing is said of them


def in_words(parts: Parts) -> str:
    """The acts in the plain words of a training: "walks forward while clapping, then bows"."""
    return ", then ".join(part_in_words(part) for part in parts)


def part_in_words(part: Sequence[Act]) -> str:
    """What happens at one time."""
    first, *others = part
    words = act_in_words(first, 0)
    for act in others:
        words += f" while {act_in_words(act, 1)}"
    return words


def act_in_words(act: Act, form: int) -> str:
    """An act in the third person (form 0) or as a gerund (1)."""
    verb = PLAIN[act.verb, act.direction][form]
    both = act.side == "both"
    limb = "both arms" if both else f"the {act.side} arm"
    hand = "both hands" if both else f"the {act.side} hand"
    times = TIMES[act.count or USUALLY.get(act.verb, 0)]
    words = (verb.format(side=act.side, limb=limb, hand=hand), times, act.speed)
    return " ".join(word for word in words if word)


# ---- time ----------------------------------------------------------------------------------------
PERIODS = {
    "squat": 1.35, "jump": 1.0, "kick": 1.35, "sit": 2.2, "rise": 1.6, "bow": 1.7, "wave": 2.4,
    "raise": 1.6, "hold": 2.6, "punch": 0.8, "clap": 0.65, "point": 2.2,
}  # fmt: skip
ON_THE_WAY = 2.4  # seconds of walking, turning and the like
FACTORS = {"slowly": 1.5, "quickly": 0.9}
BESIDE = 1.4  # seconds before and after all acts
STOPS = 0.8  # seconds from a way of walking to an act on the spot
BETWEEN = 0.3  # seconds between two other acts
TURNING = {"": 1.1, "around": 1.9}  # seconds of a turn; it stands the rest of the time
LASTING = ("walk", "run", "back", "aside", "stand")  # as long as there is time
FILLING = ("wave", "hold", "point")  # of the arms: as long as what the legs do
LATER = 0.17  # seconds from the beginning of what legs do to that of the arms


def own_seconds(act: Act) -> float:
    """About the seconds that an act takes."""
    times = act.count or USUALLY.get(act.verb, 1)
    return times * PERIODS.get(act.verb, ON_THE_WAY) * FACTORS.get(act.speed, 1.05)


def of_the_part(part: Sequence[Act]) -> float:
    """About the seconds that the acts of one time take."""
    return max(map(own_seconds, part))


def seconds_of(parts: Parts) -> float:
    """About the seconds that the acts take, from 2.5 to 10; 0 for none."""
    if not parts:
        return 0.0
    stops = STOPS * sum(on_the_way(part) for part in parts) if len(parts) > 1 else 0.0
    total = BESIDE + sum(map(of_the_part, parts)) + stops
    return round(min(max(total, 2.5), 10.0), 1)


def on_the_way(part: Sequence[Act]) -> bool:
    """Whether the figure goes somewhere, turns or stands."""
    return any(KINDS[act.verb].part == "way" for act in part)


def scheduled(
    parts: Parts, seconds: float, rng: np.random.Generator
) -> Iterator[tuple[Act, float, float]]:
    """When each act may happen, from when to when (seconds), within `seconds`.

    Who sits gets up before the legs do something else. What time is left goes to walking and the
    like, or before and after all acts; where there is too little, all acts are quicker.
    """
    parts = with_rises(parts)
    lasts = [of_the_part(part) for part in parts]
    gaps = [STOPS if on_the_way(part) else BETWEEN for part in parts[:-1]]
    lasting = [any(act.verb in LASTING for act in part) for part in parts]
    before, after = ((not lasting[k]) * BESIDE / 2 for k in (0, -1))
    need = before + sum(lasts) + sum(gaps) + after
    pace, left = min(seconds / need, 1.0), max(seconds - need, 0.0)
    if any(lasting):
        shares = rng.dirichlet(np.full(sum(lasting), 3.0))
        for k, share in zip(np.flatnonzero(lasting), shares, strict=True):
            lasts[k] += left * float(share)
    else:
        before += left * float(rng.uniform(0.1, 0.6))
    for part, whole, gap in zip(parts, lasts, (*gaps, after), strict=True):
        for act in part:
            first, last = within(act, whole, len(part) > 1, rng)
            yield act, pace * (before + first), pace * (before + last)
        before += whole + gap


def with_rises(parts: Parts) -> Parts:
    """The parts in which a seated figure gets up before its legs do something else."""
    made: list[tuple[Act, ...]] = []
    sits = False
    for part in parts:
        for act in (one for one in part if KINDS[one.verb].part != "arms"):
            if sits and act.verb != "rise":
                made.append((Act("rise"),))
            sits = act.verb == "sit"
        made.append(part)
    return tuple(made)


def within(act: Act, whole: float, beside: bool, rng: np.random.Generator) -> tuple[float, float]:
    """When an act happens in a part of `whole` seconds; `beside` another one or alone."""
    if act.verb == "turn":
        return 0.0, TURNING[act.direction]
    if act.verb in LASTING:
        return 0.0, whole
    first = LATER if beside and KINDS[act.verb].part == "arms" else 0.0
    if act.verb in FILLING:
        return first, whole
    spare = max(whole - own_seconds(act) - first, 0.0)
    first += spare * float(rng.uniform(0.1, 0.8)) if first else 0.0
    return first, first + own_seconds(act)
