"""How far a motion does what a sentence says, by the actions that are recognised in it.

A sentence is a list of phrases, each a list of what is asked for at one time.
Notebook: 17
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from jaxtyping import Float

from .actions import SIDES, Recognised

COUNTED = frozenset(("squat", "jump", "kick", "bow", "raise", "punch", "clap"))
DIRECTED = frozenset(("turn", "jump", "point"))  # around, forward, to the side, or none


@dataclass(frozen=True)
class Asked:
    """One act of a sentence; standing is not asked for, because it is no action."""

    verb: str
    side: str = ""
    count: int = 1
    direction: str = ""


Phrases = Sequence[Sequence[Asked]]


@dataclass(frozen=True)
class Agreement:
    """The shares of one motion that are right, from 0 to 1; NaN where nothing can be right.

    action     acts found, over the acts asked for or the recognised ones, whichever are more
    side       of the acts found that have a side: with this side
    count      of the acts found that are counted: exactly so often
    order      of the pairs of acts in different phrases, both found: in the order of the phrases
    direction  of the turns, jumps and pointing arms found: around or not, forward, to the side
    whole      1 if all of that is right and nothing else is shown, otherwise 0
    """

    action: float
    side: float
    count: float
    order: float
    direction: float
    whole: float


KINDS = tuple(one.name for one in fields(Agreement))


def agreement(phrases: Phrases, found: Sequence[Recognised]) -> Agreement:
    """Compare a sentence with what was recognised. Each act is matched with one recognised action.

    Among recognised actions with the verb, that with the same side and count is taken first.
    """
    matched, _ = _matched(phrases, found)
    most = max(sum(len(phrase) for phrase in phrases), len(found))
    middles = [(k, (one.first + one.last) / 2) for k, _, one in matched]
    shares = (
        len(matched) / most if most else np.nan,
        _share([one.side == act.side for _, act, one in matched if act.side]),
        _share([one.count == act.count for _, act, one in matched if act.verb in COUNTED]),
        _share([a < b for i, a in middles for j, b in middles if i < j]),
        _share([one.direction == act.direction for _, act, one in matched if act.verb in DIRECTED]),
    )
    return Agreement(*shares, float(all(share == 1 or np.isnan(share) for share in shares)))


def _matched(
    phrases: Phrases, found: Sequence[Recognised]
) -> tuple[list[tuple[int, Asked, Recognised]], list[Recognised]]:
    """The acts that are shown, as (phrase, asked, recognised), and what else is recognised."""
    acts = [(k, act) for k, phrase in enumerate(phrases) for act in phrase]
    left = list(found)
    matched = []
    for k, act in sorted(acts, key=lambda pair: -_specific(pair[1], found)):
        same = [one for one in left if one.verb == act.verb]
        if same:
            best = max(same, key=lambda one: (one.side == act.side, one.count == act.count))
            left.remove(best)
            matched.append((k, act, best))
    return matched, left


def _specific(act: Asked, found: Sequence[Recognised]) -> int:
    """How well the best recognised action fits: acts that fit exactly choose first."""
    same = [one for one in found if one.verb == act.verb]
    return max(((one.side == act.side) + (one.count == act.count) for one in same), default=-1)


def _share(right: list[bool]) -> float:
    return float(np.mean(right)) if right else np.nan


def rows_of(
    sentences: Sequence[Phrases], found: Sequence[Sequence[Recognised]]
) -> dict[str, Float[np.ndarray, "N"]]:
    """The agreement of many motions, an array for each kind."""
    every = [agreement(phrases, one) for phrases, one in zip(sentences, found, strict=True)]
    return {kind: np.array([getattr(one, kind) for one in every]) for kind in KINDS}


def confusion(
    sentences: Sequence[Phrases], found: Sequence[Sequence[Recognised]]
) -> dict[tuple[str, str], int]:
    """How often an asked side was recognised as which, of acts with one side, by (asked, found).

    "both": the act is shown on the asked side and on the other one, which nobody asked for.
    "none": the act is not shown.
    """
    table: Counter[tuple[str, str]] = Counter()
    for phrases, recognised in zip(sentences, found, strict=True):
        matched, more = _matched(phrases, recognised)
        asked = [act for phrase in phrases for act in phrase if act.side in SIDES]
        for _, act, one in matched:
            if act.side in SIDES:
                asked.remove(act)
                shown = {one.side, *(other.side for other in more if other.verb == act.verb)} - {""}
                both = "both" in shown or len(shown) > 1
                table[act.side, "both" if both else next(iter(shown), "none")] += 1
        table.update((act.side, "none") for act in asked)
    return dict(table)
