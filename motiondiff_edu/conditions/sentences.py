"""What a sentence asks for: acts, one after another and at once, read by a small grammar.

    "She strolls along, then waves hello twice with both hands"
        -> walk | wave, both                      *twice* is named: a wave has no count

A sentence is cut where it says *then* in some way, each part where it says *while*. In a part each
verb takes the words about it: sides, counts, speeds, directions. A way of walking and an act of the
arms in one part happen at once. Words that say nothing about a movement are passed over; what is
left is named, and nothing is dropped without a word.
Notebook: 16
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

from .acts import KINDS, ONE, USUALLY, Act, Parts
from .heads import Head, number_of, take
from .idioms import HEADS, LIMBS, NUMBERS, PACES, SIDES, VAGUE, WAYS, rewritten
from .pieces import acts_in
from .text import base_forms, words_of
from .verbs import is_light

# verbs of which each is to be seen, if it is in a sentence
PLAINLY = frozenset("walk run squat jump kick sit bow wave punch clap turn raise".split())
ONWARD = ("walk", "run", "back")  # what arms are moved along with, for "walks and waves"


@dataclass(frozen=True)
class Understood:
    """The acts of a sentence: parts in a row, in each the acts at once; and what is to be said."""

    parts: Parts
    notes: tuple[str, ...] = ()


def understand(text: str) -> Understood:
    """What a sentence asks for; a sentence without an act has no parts."""
    notes: list[str] = []
    low = rewritten(text)
    clauses = [" ".join(clause.split()) for clause in low.split("|")]
    parts: list[tuple[Act, ...]] = []
    for clause in filter(None, clauses):
        said = len(notes)
        more = parts_of(clause, notes) or again(clause, parts)
        if not more and len(notes) == said and says_something(clause):
            notes.append(f"not understood: {clause!r}")
        parts += more
    parts = counted_together(in_one_flow(parts))
    notes += [f"not understood, and left out: {word!r}" for word in unused(low, parts, notes)]
    return Understood(tuple(parts), tuple(dict.fromkeys(notes)))


def unused(text: str, parts: Sequence[tuple[Act, ...]], notes: Sequence[str]) -> list[str]:
    """Words of a text about acts that no act shows and no note names: the grammar went wrong.

    Looked for one by one, without grammar: sides, counts, speeds, *backwards*, *sideways*, verbs.
    """
    acts = [act for part in parts for act in part]
    verbs = {act.verb for act in acts}
    sides = {act.side for act in acts} | ({"both"} if verbs & {"jump", "clap", "squat"} else set())
    sides |= {*ONE} if "both" in sides else {"both"} if sides >= {*ONE} else set()
    most = max(sum(act.count or USUALLY.get(act.verb, 1) for act in acts), 1 + ("both" in sides))
    shown = {"back": {"back"}, "aside": {"aside"}, "walk": {"walk", "back", "aside"}}
    shown |= {"raise": {"raise", "hold"}}
    # "'kick' has no side: 'left' is left out"
    quoted = (one for note in notes for one in re.findall(r"'([^']*)'|(\d+)", note))
    named = {word for pair in quoted for one in pair for word in one.split()}
    found = []
    for word in words_of(text) if acts else ():
        verb = next((HEADS[form] for form in (word, *base_forms(word)) if form in HEADS), "")
        away = word in WAYS and word not in ("back", "reverse", "side") and WAYS[word]
        lost = (
            SIDES.get(word, "") not in {"", *sides}
            or word not in VAGUE
            and number_of(word) > most
            or PACES.get(word, "") not in {"", *(act.speed for act in acts)}
            or away in ("back", "aside")
            and not verbs & shown[away]
            and "point" not in verbs
            or verb in PLAINLY
            and not verbs & shown.get(verb, {verb})
        )
        if lost and not named & {word, SIDES.get(word), str(number_of(word))}:
            found.append(word)
    return list(dict.fromkeys(found))


def says_something(clause: str) -> bool:
    """Whether words about an act, or verbs that say nothing by themselves, are in a clause."""
    about = SIDES.keys() | NUMBERS.keys() | LIMBS.keys()
    return any(word in about or is_light(word) for word in re.findall(r"[\w-]+", clause))


def in_one_flow(parts: Sequence[tuple[Act, ...]]) -> list[tuple[Act, ...]]:
    """The same without what goes without saying: getting up from a squat or a bow, sitting of who
    sits already ("sits, then claps while sitting"), a walk that only goes on ("... as she walks").
    """
    found: list[tuple[Act, ...]] = []
    legs, seated = "", False
    for part in parts:
        if seated and len(part) == 2:
            part = tuple(act for act in part if act.verb != "sit")
        own = [act.verb for act in part if KINDS[act.verb].part != "arms"]
        if part == (Act("rise"),) and legs in ("squat", "bow"):
            continue
        if len(part) == 2 and found and found[-1] == tuple(a for a in part if a.verb in ONWARD):
            found.pop()
        found.append(part)
        legs = own[-1] if own else legs
        seated = legs == "sit"
    return found


def counted_together(parts: Sequence[tuple[Act, ...]]) -> list[tuple[Act, ...]]:
    """The same with "clap, clap, clap" as one act that is done three times."""
    found: list[tuple[Act, ...]] = []
    for part in parts:
        if found and len(part) == len(found[-1]) == 1:
            (last,), (act,) = found[-1], part
            times = max(last.count, 1) + max(act.count, 1)
            if replace(last, count=0) == replace(act, count=0) and times <= KINDS[act.verb].most:
                found[-1] = (replace(last, count=times),)
                continue
        found.append(part)
    return found


def again(clause: str, parts: list[tuple[Act, ...]]) -> list[tuple[Act, ...]]:
    """The last act once more, with another side if one is named; else nothing.

    "..., then with the right", "..., then does it again"
    """
    words = clause.split()
    said = Head("", "")
    for k, word in enumerate(words):
        take(said, word, words, k)
    once_more = {"again-it", "another", "more", "again"} & {*words}
    away = "back" in said.ways and bool(parts) and parts[-1][-1].verb in ONWARD
    if not parts or not (once_more or away or said.side or said.count or said.speed):
        return []
    *others, last = parts[-1]
    if away:  # "walks forward, and then back"
        return [(Act("back"),)]
    kind = KINDS[last.verb]
    if said.side and said.side not in kind.sides or said.speed and said.speed not in kind.speeds:
        return []
    way = next((way for way in said.ways if way in kind.directions), last.direction)
    count = said.count if 0 < said.count <= kind.most else last.count
    more = replace(last, count=count, direction=way)
    return [(*others, replace(more, side=said.side or last.side, speed=said.speed or last.speed))]


def parts_of(clause: str, notes: list[str]) -> list[tuple[Act, ...]]:
    """The parts of a clause: usually one, several where its acts cannot be done at once."""
    pieces = clause.split("&")
    if len(pieces) == 2 and not pieces[0].strip():  # "while he walks, he waves"
        pieces = pieces[1].split(",", 1)
    groups = [group for piece in pieces if (group := acts_in(piece, notes))]
    if not groups:
        return []
    joined = joined_acts(groups[0])
    for group in groups[1:]:
        more = joined_acts(group)
        both = at_once(joined[-1], more[0])
        verbs = [act.verb for part in both for act in part]
        if len(both) > 1 and "stand" not in verbs and len({*verbs}) > 1:
            first, then = (" and ".join(repr(act.verb) for act in part) for part in both)
            notes.append(f"{first} and {then} are done one after the other, not at once")
        joined[-1:] = both
        joined += more[1:]
    return joined


def joined_acts(group: list[tuple[Head, Act]]) -> list[tuple[Act, ...]]:
    """Acts of one piece: a way of walking and arms, or a participle, are at once."""
    parts: list[tuple[Act, ...]] = []
    for head, act in group:
        if parts and len(parts[-1]) == 1:
            (last,) = parts[-1]
            kinds = {KINDS[last.verb].part, KINDS[act.verb].part}
            held = "hold" in (last.verb, act.verb)
            if (
                "arms" in kinds
                and len(kinds) == 2
                and (
                    last.verb in ONWARD
                    and head.joined in ("and", "")
                    or head.joined == "ing"
                    or held
                )
            ):
                parts[-1:] = at_once(parts[-1], (act,))
                continue
        parts.append((act,))
    return parts


def at_once(first: tuple[Act, ...], second: tuple[Act, ...]) -> list[tuple[Act, ...]]:
    """Both together as one part, if one is of the legs and one of the arms; else one by one."""
    acts = (*first, *second)
    legs = [act for act in acts if KINDS[act.verb].part != "arms"]
    if len(acts) == 2 and len(legs) == 1:
        return [(legs[0], next(act for act in acts if act is not legs[0]))]
    return [first, second]
