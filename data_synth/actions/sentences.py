"""Random sentences, and those that a training never sees.

The form of a sentence (its verbs) and the length of the clip are drawn first, and the counts last.
The clip has room for the largest counts that the form may have, so its length does not tell which
they are. Of a form too long for LONGEST seconds, the largest counts are lowered until it fits.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial

import numpy as np

from .acts import FACTORS as SPEED
from .acts import MOST, ONE_SIDE, PHRASES, UNEVEN, VERBS, Act, Phrase, Sentence, seated
from .performance import JOIN, SITS, WHILE_IT_LASTS, stops, with_rises
from .way import least_seconds

LEAST, LONGEST = 2.0, 10.0  # seconds of a clip
MARGIN = 0.8  # seconds left over in every clip
MOSTLY_SHORT = 1.6  # 1: as many long clips as short ones
WAY, SPOT, ARMS = (
    tuple(name for name, verb in VERBS.items() if verb.kind == kind)
    for kind in ("way", "spot", "arms")
)
# acts of the legs and of the arms that one can do at once
AT_ONCE = frozenset(
    [(legs, one) for legs in (*WAY, "squat", "sit", "rise") for one in ARMS] + [("jump", "hold")]
)
KINDS = {"way": 0.2, "spot": 0.32, "arms": 0.18, "way and arms": 0.22, "spot and arms": 0.08}
SEVERAL = (0.0, 0.45, 0.38, 0.17)  # shares of sentences with 0, 1, 2, 3 phrases
HELD_OUT = 0.16  # share of the pairs that a training never sees

SIDES = ("same side", "other side")  # of two acts

Pair = tuple[str, str, str]  # how two words belong together, a verb, and the other word
# kinds of pairs, and the part that no two pairs held out have in common
ONCE = {
    ("speed",): slice(1, 2),
    ("direction",): slice(1, 2),
    ("while",): slice(0, 3),
    ("then",): slice(0, 3),
    SIDES: slice(1, 3),
}


def draw(rng: np.random.Generator, seconds: float | None = None) -> tuple[Sentence, float]:
    """A sentence and the length of its clip in seconds (LEAST to LONGEST, or the one given)."""
    while True:
        n = int(rng.choice(PHRASES + 1, p=SEVERAL))
        form = tuple(_phrase(rng) for _ in range(n))
        if not _possible(form):
            continue
        fitting = fitted(form, LONGEST if seconds is None else seconds)
        if not fitting:
            continue
        if room(form) > LONGEST:
            form = fitting[int(rng.integers(len(fitting)))]
        else:
            form = fitting[-1]
        need = max(LEAST, room(form))
        spare = (LONGEST - need) * float(rng.random()) ** MOSTLY_SHORT
        length = need + spare if seconds is None else seconds
        return tuple(_counted(phrase, rng) for phrase in form), round(length, 1)


def fitted(form: Sentence, seconds: float) -> list[Sentence]:
    """The form with its largest counts lowered to 1, 2 ... MOST, as far as there is room."""
    lowered = [
        tuple(_with_counts(phrase, partial(min, most)) for phrase in form)
        for most in range(1, MOST + 1)
    ]
    return [one for one in lowered if room(one) <= seconds]


def _possible(form: Sentence) -> bool:
    """Whether no act follows itself, nobody gets up who stands, and nobody sits down on a seat."""
    for a, b in zip(form, form[1:], strict=False):
        if a == b or (a.legs is not None and b.legs is not None and a.legs.verb == b.legs.verb):
            return False
    try:
        seated(form)
    except ValueError:
        return False
    return True


def room(form: Sentence) -> float:
    """Seconds that the sentence needs at most."""
    whole = with_rises(form)
    return sum(map(_longest, whole)) + stops(whole) + MARGIN


def _longest(phrase: Phrase) -> float:
    """Seconds that a phrase whose counts are the largest ones can need."""
    found = []
    for act in phrase.acts:
        verb = VERBS[act.verb]
        if verb.kind == "way":
            found.append(least_seconds(act))
        else:
            speed = max(1.0, SPEED[act.speed]) if act.verb in WHILE_IT_LASTS else SPEED[act.speed]
            slowest = act.count * speed * (1 + UNEVEN) * verb.period
            more = {"arms": JOIN, "sit": SITS[1]}
            found.append(slowest + more.get(verb.kind, more.get(act.verb, 0.0)))
    return max(found)


def _phrase(rng: np.random.Generator) -> Phrase:
    """A phrase of random verbs with their largest counts."""
    kind = str(rng.choice(list(KINDS), p=list(KINDS.values())))
    legs = arms = None
    if kind.startswith("way"):
        legs = _act(str(rng.choice(WAY[:-1] if kind == "way" else WAY)), rng)
    if kind.endswith("arms"):
        arms = _act(str(rng.choice(ARMS)), rng)
    if kind.startswith("spot"):
        free = [verb for verb in SPOT if arms is None or (verb, arms.verb) in AT_ONCE]
        legs = _act(str(rng.choice(free)), rng)
    return Phrase(legs, arms)


def _act(verb: str, rng: np.random.Generator) -> Act:
    """An act with its largest count; some acts get a speed, slow or fast."""
    one = VERBS[verb]
    speeds = one.speeds if rng.random() < 0.45 else ("",)
    return Act(
        verb,
        str(rng.choice(one.sides)),
        one.most,
        str(rng.choice(speeds)),
        str(rng.choice(one.directions)),
    )


def _counted(phrase: Phrase, rng: np.random.Generator) -> Phrase:
    """The phrase with random counts, up to its own.

    Twice is twice as likely as once, and so on, for in long sentences there is room for once alone.
    """
    return _with_counts(phrase, lambda most: int(rng.choice(_TIMES[most])))


_TIMES = {most: np.repeat(range(1, most + 1), range(1, most + 1)) for most in range(1, MOST + 1)}


def _with_counts(phrase: Phrase, count: Callable[[int], int]) -> Phrase:
    """The phrase with other counts, out of its own."""
    legs, arms = (
        act and replace(act, count=count(act.count)) for act in (phrase.legs, phrase.arms)
    )
    return Phrase(legs, arms)


def pairs(sentence: Sentence) -> set[Pair]:
    """The pairs of a verb with its speed or direction, with another verb, and with its side.

    All clips are also mirrored, so one side of a single act is never held out. A pair of sides is
    one of two acts: on the same side, or on different sides.
    """
    found: set[Pair] = set()
    for phrase in sentence:
        for act in phrase.acts:
            found |= {
                (kind, act.verb, word)
                for kind in ("speed", "direction")
                if (word := getattr(act, kind))
            }
        if len(phrase.acts) == 2:
            found |= _pairs_of("while", *phrase.acts)
    for a, b in zip(sentence, sentence[1:], strict=False):
        found = found.union(*(_pairs_of("then", x, y) for x in a.acts for y in b.acts))
    return found


def _pairs_of(kind: str, a: Act, b: Act) -> set[Pair]:
    found = {(kind, a.verb, b.verb)}
    if a.side in ONE_SIDE and b.side in ONE_SIDE:
        found.add((SIDES[a.side != b.side], a.verb, b.verb))
    return found


def all_pairs() -> list[Pair]:
    """Every pair that a sentence can have."""
    found = []
    for name, verb in VERBS.items():
        found += [("speed", name, word) for word in verb.speeds if word]
        found += [("direction", name, word) for word in verb.directions if word]
    found += [("while", legs, arms) for legs, arms in sorted(AT_ONCE)]
    found += [("then", a, b) for a in VERBS for b in VERBS if a != b or VERBS[a].kind == "arms"]
    sided = [name for name, verb in VERBS.items() if "left" in verb.sides]
    found += [
        (kind, a, b)
        for kind in SIDES
        for a in sided
        for b in sided
        if a != b or VERBS[a].kind == "arms"
    ]
    return found


@cache
def held_out() -> frozenset[Pair]:
    """The pairs that a training never sees: HELD_OUT of each kind, and every word stays in others.

    Of each verb one speed or direction is held out at most, of two acts one relation of sides.
    """
    rng = np.random.default_rng(17)
    every, found = all_pairs(), set()
    for kinds, once in ONCE.items():
        own = [pair for pair in every if pair[0] in kinds]
        wanted = int(np.ceil(HELD_OUT * len(own)))
        taken: list[Pair] = []
        for pair in (own[k] for k in rng.permutation(len(own))):
            if len(taken) == wanted:
                break
            if not any(pair[once] == other[once] for other in taken):
                taken.append(pair)
        found |= set(taken)
    return frozenset(found)


def in_training(sentence: Sentence) -> bool:
    """Whether none of the sentence's pairs is held out."""
    return not pairs(sentence) & held_out()


__all__ = ["all_pairs", "draw", "held_out", "in_training", "pairs", "room"]
