"""A verb while its sentence is read: the words about it, and the acts that they make.

What a verb does not have, such as a side or a count, is named. Notebook: 16
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from .acts import KINDS, ONE, Act, Kind
from .idioms import LIMBS, NUMBERS, PACES, SIDES, VAGUE, WAYS


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


def acts_of(head: Head, notes: list[str]) -> Iterator[tuple[Head, Act]]:
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
    if head.word.startswith("fac") and side not in ONE and not ways & {"around", "back"}:
        notes.append(f"not understood, and left out: {head.word!r}")
        return
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
    if kind.part == "arms" and "leg" in head.limbs and "arm" not in head.limbs:
        notes.append(f"{head.word!r} is done with the hands: the feet are left out")
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
