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

from .acts import KINDS, ONE, Act, Parts
from .heads import Head, acts_of, say_of, take
from .idioms import (
    ADDRESSED,
    FILLERS,
    HEADS,
    LIMBS,
    NUMBERS,
    PACES,
    SIDES,
    THINGS,
    TOWARDS,
    WAYS,
    WHOSE,
    rewritten,
)
from .text import base_forms
from .verbs import head_of, is_light, meant

ONWARD = ("walk", "run", "back")  # what arms are moved along with, for "walks and waves"


@dataclass(frozen=True)
class Understood:
    """The acts of a sentence: parts in a row, in each the acts at once; and what is to be said."""

    parts: Parts
    notes: tuple[str, ...] = ()


def understand(text: str) -> Understood:
    """What a sentence asks for; a sentence without an act has no parts."""
    notes: list[str] = []
    clauses = [" ".join(clause.split()) for clause in rewritten(text).split("|")]
    parts: list[tuple[Act, ...]] = []
    for clause in filter(None, clauses):
        parts += parts_of(clause, notes) or again(clause, parts)
    return Understood(tuple(counted_together(parts)), tuple(dict.fromkeys(notes)))


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
    """The last act with another side, for "..., then with the right"; else nothing."""
    sides = [SIDES[word] for word in clause.split() if SIDES.get(word)]
    if not parts or not sides or sides[0] not in KINDS[parts[-1][-1].verb].sides:
        return []
    return [(replace(parts[-1][-1], side=sides[0]),)]


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
        joined[-1:] = at_once(joined[-1], more[0])
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


def acts_in(piece: str, notes: list[str]) -> list[tuple[Head, Act]]:
    """The acts of a piece without "while", in their order."""
    tokens = re.findall(r"[a-z]+(?:[-'][a-z]*)*|\d+|,", piece)
    heads: list[Head] = []
    before = Head("", "")  # what is said before its verb
    unknown: list[str] = []
    subject: list[str] = []
    joined = ""
    for k, token in enumerate(tokens):
        if token.startswith("hold-"):
            one = token.removeprefix("hold-")
            heads.append(
                Head("hold", token, "ing", one if one in ONE else "both" if one else "right")
            )
            heads[-1].ways, heads[-1].limbs = ["up"], ["arm"]
            before, joined = Head("", ""), ""
            continue
        if token in (",", "and"):
            joined = "," if "," in (token, joined) else "and"
            give_back(before, heads)
            if not heads:
                subject = []  # "juggles and walks": what comes before "and" was no subject
            before = Head("", "")
            continue
        verb = head_of(token, tokens[k + 1 : k + 2], notes)
        if verb and token in THINGS and tokens[max(k - 1, 0)] in ("a", "the"):
            verb = ""  # "picks up a box"
        if verb and heads and named_again(verb, heads[-1], tokens[:k]):
            say_of(heads[-1], before)
            before = Head("", "")
            continue
        if verb:
            participle = token.endswith("ing") and joined != "and"
            head = Head(verb, token, "ing" if participle else joined)
            if plural(tokens, k):
                head.count, head.vague = 2, True
            say_of(head, before)
            heads.append(head)
            before, joined = Head("", ""), ""
            continue
        target = before if leads(tokens, k) or not heads else heads[-1]
        if take(target, token, tokens, k) or token in FILLERS or is_light(token):
            continue
        near = meant(token)
        if near:
            notes.append(f"{token!r} is read as {near!r}")
            take(target, near, tokens, k)
            continue
        if not addressed(tokens, k, heads):
            unknown.append(token)
            who = not heads and not token.endswith("ing") and token != "i-mean"
            subject += [token] if who else []
    give_back(before, heads)
    if not heads and before.limbs and "up" in before.ways:  # "arms up"
        heads.append(replace(before, verb="hold"))
    acts = [act for head in heads for act in acts_of(head, notes)]
    if heads:  # what stands before the first verb is who does it
        unknown = [word for word in unknown if word not in subject]
    if unknown:
        left = "not understood, and left out" if heads else "not understood"
        words = [repr(word.replace("-", " ")) for word in dict.fromkeys(unknown)]
        notes.append(f"{left}: {', '.join(words)}")
    return acts


def plural(tokens: Sequence[str], k: int) -> bool:
    """Whether a verb is a noun in the plural: "does squats", "quick punches"."""
    before = list(tokens[:k])
    quick = bool(before) and before[-1] in PACES and not before[-1].endswith("ly")
    while before and before[-1] in (*SIDES, *PACES, "some"):
        before.pop()
    return tokens[k].endswith("s") and (quick or bool(before) and is_light(before[-1]))


def named_again(verb: str, last: Head, before: Sequence[str]) -> bool:
    """Whether a word names the act of the last verb: "greets her with a wave", "goes two steps"."""
    while before and before[-1] in (*SIDES, *PACES, *WAYS, "very"):
        before = before[:-1]
    if last.verb == verb == "walk":
        return bool(before) and (
            before[-1] in ("a", "one") or before[-1] in NUMBERS or before[-1].isdigit()
        )
    return last.verb == verb and tuple(before[-2:]) in (("with", "a"), ("in", "a"))


def addressed(tokens: Sequence[str], k: int, heads: Sequence[Head]) -> bool:
    """Whether a word says at whom somebody waves, bows, claps or points."""
    if not heads or heads[-1].verb not in ADDRESSED:
        return False
    before = list(tokens[:k])
    while before and before[-1] in WHOSE:
        before.pop()
    return bool(before) and before[-1] in TOWARDS


def leads(tokens: Sequence[str], k: int) -> bool:
    """Whether a word belongs to a verb after it: nothing but such words lie between."""
    for token in tokens[k + 1 :]:
        if token in ("and", ",", "with", "to", "the", "of"):
            return False
        if (
            token in SIDES
            or token in NUMBERS
            or token in PACES
            or token.isdigit()
            or token in ("a", "an", "very", "times", "quick")
        ):
            continue
        if token in WAYS or token in LIMBS:
            return False
        return bool(HEADS.get(token) or any(form in HEADS for form in base_forms(token)))
    return False


def give_back(more: Head, heads: list[Head]) -> None:
    """Words that no verb came after belong to the verb before them."""
    if heads:
        last = heads[-1]
        if more.limbs and "up" in more.ways and KINDS.get(last.verb, KINDS["walk"]).part != "arms":
            heads.append(replace(more, verb="hold", joined="ing"))
            return
        say_of(last, more)
