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
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from difflib import get_close_matches

from .acts import KINDS, ONE, Act, Kind, Parts
from .idioms import (
    ADDRESSED,
    FILLERS,
    HEADS,
    LIGHT,
    LIMBS,
    NUMBERS,
    PACES,
    REWRITTEN,
    SIDES,
    THINGS,
    TOWARDS,
    VAGUE,
    WAYS,
    WHOSE,
)
from .text import base_forms, synonyms

ONWARD = ("walk", "run", "back")  # what arms are moved along with, for "walks and waves"
SYNONYMS_SAY = {"get up": "rise", "step back": "back", "move back": "back"}


@dataclass
class Head:
    """An act while it is read: its verb, what is said of it, and how it joins what is before it."""

    verb: str
    word: str
    joined: str = ""  # "and", "," or "ing": a participle without "and"
    side: str = ""
    count: int = 0
    vague: bool = False  # "a few times", which is not counted exactly
    speed: str = ""
    ways: list[str] = field(default_factory=list)
    limbs: list[str] = field(default_factory=list)


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


def rewritten(text: str) -> str:
    """The text in small letters, with | between acts in a row and & between acts at once."""
    low = re.sub(r"[’`]", "'", text.lower())
    low = re.sub(r"[.;!?:\n]+", " | ", low)
    for pattern, other in REWRITTEN:
        low = " ".join(pattern.sub(other, low).split())
    return other_side(in_their_order(low))


def in_their_order(low: str) -> str:
    """Acts in the order in which they are done, for "X after Y", "before X, Y", "X, but first Y"."""
    for word, first in ((r"\bafter\b", 1), (r"(?:[|,]|\bbut\b|\band\b)* ?\bbefore-it\b,?", 1)):
        pieces = re.split(word, low)
        if len(pieces) == 2 and pieces[0].strip(" |,"):
            low = f"{pieces[first]} | {pieces[1 - first]}"
        elif len(pieces) == 2:
            low = pieces[1].replace(",", " | ", 1)
    match = re.match(r"[ |,]*before\b([^,|]*),(.*)", low)
    low = f"{match[2]} | {match[1]}" if match else low
    return re.sub(r"\bbefore\b", " | ", low)


def other_side(low: str) -> str:
    """With "left" or "right" in place of "the other hand"."""
    last, words = "", low.split()
    for k, word in enumerate(words):
        last = word if word in ONE else last
        if (
            word == "other"
            and last
            and words[k + 1 : k + 2]
            and words[k + 1] in {*LIMBS, "side", "one"}
        ):
            words[k] = last = ONE[1 - ONE.index(last)]
    return " ".join(words)


def parts_of(clause: str, notes: list[str]) -> list[tuple[Act, ...]]:
    """The parts of a clause: usually one, several where its acts cannot be done at once."""
    pieces = clause.split("&")
    if len(pieces) == 2 and not pieces[0].strip():  # "while he walks, he waves"
        pieces = pieces[1].split(",", 1)
    groups = [group for piece in pieces for group in [list(acts_in(piece, notes))] if group]
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


def acts_in(piece: str, notes: list[str]) -> Iterator[tuple[Head, Act]]:
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
        verb = head_of(token, tokens[k + 1 : k + 2], heads, notes)
        if verb and token in THINGS and tokens[max(k - 1, 0)] in ("a", "the"):
            verb = ""  # "picks up a box"
        if verb and heads and named_again(verb, heads[-1], tokens[:k]):
            say_of(heads[-1], before)
            before = Head("", "")
            continue
        if verb:
            participle = token.endswith("ing") and joined != "and"
            head = Head(verb, token, "ing" if participle else joined)
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
            who = not heads and not token.endswith("ing")
            subject += [token] if who else []
    give_back(before, heads)
    if not heads and before.limbs and "up" in before.ways:  # "arms up"
        heads.append(replace_head(before, "hold"))
    acts = [act for head in heads for act in made(head, notes)]
    yield from acts
    if heads:  # what stands before the first verb is who does it
        unknown = [word for word in unknown if word not in subject]
    if unknown:
        left = "not understood, and left out" if heads else "not understood"
        words = [repr(word.replace("-", " ")) for word in dict.fromkeys(unknown)]
        notes.append(f"{left}: {', '.join(words)}")


def meant(token: str) -> str:
    """The word that a word about an act stands for, if it is misspelled; else ""."""
    if len(token) < 4:
        return ""
    words = [
        word for word in (*SIDES, *WAYS, *PACES, *NUMBERS, *LIMBS, "times", "down") if len(word) > 3
    ]
    swapped = [word for word in words if sorted(word) == sorted(token)]
    near = swapped or get_close_matches(token, words, 1, 0.84)
    return near[0] if near and near[0][0] == token[0] else ""


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


def replace_head(head: Head, verb: str) -> Head:
    """The same words about another verb."""
    return replace(head, verb=verb)


def is_light(token: str) -> bool:
    """Whether a word is a verb that says nothing by itself, as in "does a jump"."""
    return token in LIGHT or any(form in LIGHT for form in base_forms(token))


def head_of(token: str, following: Sequence[str], heads: list[Head], notes: list[str]) -> str:
    """The verb that a word names, or ""."""
    if token in ("has", "have", "had") and not {*following} & {
        *LIMBS,
        *SIDES,
        "the",
        "his",
        "her",
        "their",
    }:
        return ""
    if (
        token not in HEADS
        and token in FILLERS
        or token in WAYS
        or token in PACES
        or token in SIDES
        or token in NUMBERS
    ):
        return ""
    known = HEADS.get(token) or next(
        (HEADS[form] for form in base_forms(token) if form in HEADS), ""
    )
    if known:
        return known
    for form in (token, *base_forms(token)):
        other = synonyms().get(form, "")
        verb = SYNONYMS_SAY.get(other) or HEADS.get(other, "")
        if verb:
            notes.append(f"{token!r} is read as {other!r}")
            return verb
    if len(token) > 3:
        swapped = [word for word in spelled() if sorted(word) == sorted(token)]
        near = swapped or get_close_matches(token, spelled(), 1, 0.84)
        if near and near[0][0] == token[0]:
            notes.append(f"{token!r} is read as {near[0]!r}")
            return (
                HEADS[near[0]]
                if near[0] in HEADS
                else HEADS[next(f for f in base_forms(near[0]) if f in HEADS)]
            )
    return ""


def spelled() -> list[str]:
    """The verbs in the forms in which they are written."""
    found = []
    for word in HEADS:
        stem = word.removesuffix("e")
        found += [word, word + "s", stem + "ing", stem + word[-1] + "ing", stem + "ed"]
    return found


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


def take(head: Head, token: str, tokens: Sequence[str], k: int) -> bool:
    """Take a word about an act; whether it is one."""
    if token in SIDES and head.verb == "point":
        by_limb = bool({*tokens[k + 1 : k + 3]} & LIMBS.keys())
        if by_limb or not head.side:
            head.side = SIDES[token]
        if not by_limb:
            head.ways.append("aside")
    elif token in SIDES:
        other = head.side and SIDES[token] and head.side != SIDES[token]
        head.side = "both" if other else SIDES[token] or head.side
    elif token in NUMBERS or token.isdigit():
        if tokens[k + 1 : k + 2] and tokens[k + 1] in (
            "hand",
            "hands",
            "arms",
            "foot",
            "feet",
            "leg",
        ):
            head.side = "both" if NUMBERS.get(token) == 2 else head.side
        else:
            head.count = NUMBERS.get(token) or int(token)
            head.vague = token in VAGUE
    elif token in PACES:
        head.speed = PACES[token]
    elif token in WAYS:
        head.ways.append(WAYS[token])
    elif token in LIMBS:
        head.limbs.append(LIMBS[token])
        if token in ("hands", "arms", "feet", "legs") and not head.side:
            head.side = "both"
    else:
        return False
    return True


def say_of(head: Head, more: Head) -> None:
    """Add what stands before a verb."""
    head.side = more.side or head.side
    head.count, head.vague = (more.count, more.vague) if more.count else (head.count, head.vague)
    head.speed = more.speed or head.speed
    head.ways += more.ways
    head.limbs += more.limbs


def give_back(more: Head, heads: list[Head]) -> None:
    """Words that no verb came after belong to the verb before them."""
    if heads:
        last = heads[-1]
        if more.limbs and "up" in more.ways and KINDS.get(last.verb, KINDS["walk"]).part != "arms":
            heads.append(replace_head(more, "hold"))
            heads[-1].joined = "ing"
            return
        say_of(last, more)


# ---- from words to acts --------------------------------------------------------------------------
def made(head: Head, notes: list[str]) -> Iterator[tuple[Head, Act]]:
    """The act of a verb with what is said of it; sometimes two."""
    verb = head.verb
    side = head.side
    ways = set(head.ways)
    held = None
    if verb == "strike":
        verb = "kick" if "leg" in head.limbs else "punch"
    if (
        verb in ("walk", "run", "stand", "sit", "squat", "jump", "turn", "back", "spin")
        and "arm" in head.limbs
        and "up" in ways
    ):
        held = Act("hold", side or "both")
        side, ways = "", ways - {"up"}
    if verb in ("walk", "run"):
        if "back" in ways:
            verb = "back"
        elif "aside" in ways or (
            side in ONE and head.word.startswith(("step", "shuffl", "mov", "go"))
        ):
            verb = "aside"
        elif "around" in ways and head.word.startswith(("turn", "fac")):
            verb = "turn"
    if verb == "turn" and "back" in ways and side not in ONE:
        ways.add("around")
    direction = ""
    if verb == "spin":
        verb, direction = "turn", "around"
    if verb == "turn" and "around" in ways:
        direction = "around"
    if verb == "jump" and "forward" in ways:
        direction = "forward"
    if verb == "point":
        direction = "aside" if "aside" in ways else "forward"
    if verb in ("raise", "hold") and "leg" in head.limbs and "arm" not in head.limbs:
        notes.append("the figure raises arms, no legs")
    if verb == "hold":
        if "up" not in ways and "arm" in head.limbs and ("forward" in ways or "aside" in ways):
            verb, direction = "point", "aside" if "aside" in ways else "forward"
        elif "arm" not in head.limbs and not ways:
            notes.append(f"not understood, and left out: {head.word!r}")
            return
    if (
        verb == "raise"
        and "arm" not in head.limbs
        and head.word.startswith(("put", "reach", "stretch"))
    ):
        notes.append(f"not understood, and left out: {head.word!r}")
        return
    kind = KINDS[verb]
    if verb == "punch" and side == "both":
        for one in ONE:
            yield head, Act(verb, one, 0, *said(kind, head, notes))
        return
    side = allowed_side(verb, kind, side, notes)
    count = allowed_count(verb, kind, 0 if head.vague and kind.most == 1 else head.count, notes)
    if kind.part == "spot" and ways & {"aside", "back"}:
        notes.append(f"{verb!r} has no way to the side or back, and is done on the spot")
    if kind.part != "arms" and "arm" in head.limbs and not held:
        notes.append(f"not understood, and left out: the arms of {verb!r}")
    yield head, Act(verb, side, count, *said(kind, head, notes), direction)
    if held:
        yield Head("hold", "hold", "ing"), held


def said(kind: Kind, head: Head, notes: list[str]) -> tuple[str]:
    """The speed, if the verb has it."""
    if head.speed and head.speed not in kind.speeds:
        if kind.speeds or head.verb not in ("run",):
            notes.append(f"{head.word!r} is done at one speed, not {head.speed}")
        return ("",)
    return (head.speed,)


def allowed_side(verb: str, kind: Kind, side: str, notes: list[str]) -> str:
    """The side, if the verb has sides; one that needs a side gets one."""
    if not kind.sides:
        if side in ONE:
            notes.append(f"{verb!r} has no side: {side!r} is left out")
        return ""
    if side == "both" and "both" not in kind.sides:
        notes.append(f"{verb!r} is done with one side at a time: the right one")
        return "right"
    return side or "right"


def allowed_count(verb: str, kind: Kind, count: int, notes: list[str]) -> int:
    """The count, if the verb is counted, up to the most that were learnt."""
    if count > kind.most and kind.part == "way":
        notes.append(f"{verb!r} is not counted: {count} is left out")
    elif count > kind.most:
        most = f"{kind.most} times at most" if kind.most > 1 else "once"
        notes.append(f"{verb!r} is done {most}, not {count} times")
    return min(count, kind.most) if kind.most > 1 else 0
