"""Sentences that differ from a given one in one thing: a side, a count, the order, a speed.

A judge that takes only a bag of words cannot tell them apart.
"""

from dataclasses import replace

import numpy as np

from .acts import ONE_SIDE, OTHER_SIDE, VERBS, Act, Sentence
from .sentences import in_training

KINDS = ("side", "count", "order", "speed")
OPPOSITE = {"slowly": "quickly", "quickly": "slowly"}


def changed(sentence: Sentence, kind: str, rng: np.random.Generator) -> Sentence | None:
    """The sentence with one thing changed; None where it has nothing of this kind."""
    if kind == "order":
        return sentence[::-1] if len(sentence) > 1 else None
    change = {"side": _side, "count": _count, "speed": _speed}[kind]
    places = [
        (p, part)
        for p, phrase in enumerate(sentence)
        for part in ("legs", "arms")
        if (act := getattr(phrase, part)) is not None and change(act, rng) is not None
    ]
    if not places:
        return None
    p, part = places[int(rng.integers(len(places)))]
    act = change(getattr(sentence[p], part), rng)
    return (*sentence[:p], replace(sentence[p], **{part: act}), *sentence[p + 1 :])


def _side(act: Act, rng: np.random.Generator) -> Act | None:
    return replace(act, side=OTHER_SIDE[act.side]) if act.side in ONE_SIDE else None


def _count(act: Act, rng: np.random.Generator) -> Act | None:
    most = VERBS[act.verb].most
    others = [count for count in range(1, most + 1) if count != act.count]
    return replace(act, count=int(rng.choice(others))) if others else None


def _speed(act: Act, rng: np.random.Generator) -> Act | None:
    other = OPPOSITE.get(act.speed, "")
    return replace(act, speed=other) if other in VERBS[act.verb].speeds and other else None


def neighbour(sentence: Sentence, rng: np.random.Generator) -> Sentence | None:
    """A sentence that differs in one thing, of a random kind; None where there is none.

    It has no pair that is held out, which a judge would otherwise know from wrong captions alone.
    """
    for kind in rng.permutation(KINDS):
        other = changed(sentence, str(kind), rng)
        if other is not None and other != sentence and in_training(other):
            return other
    return None
