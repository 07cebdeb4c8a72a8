"""A verb while its sentence is read: the words about it, and the acts that they make.

What a verb does not have, such as a side or a count, is named. Notebook: 16
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

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
    toward: str = ""  # the side to which an arm points


def take(head: Head, token: str, tokens: Sequence[str], k: int) -> bool:
    """Take a word about an act; whether it is one."""
    if token in SIDES and head.verb == "point":
        by_limb = bool({*tokens[k + 1 : k + 3]} & LIMBS.keys()) or "with" in tokens[k - 2 : k]
        if by_limb:
            head.side = SIDES[token]
        else:
            head.side, head.toward = head.side or SIDES[token], SIDES[token]
            head.ways.append("aside")
    elif token in SIDES:
        other = head.side and SIDES[token] and head.side != SIDES[token]
        head.side = "both" if other else SIDES[token] or head.side
    elif number_of(token):
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
            head.count = number_of(token)
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


def number_of(token: str) -> int:
    """The number that a word says; 0 for none. Beyond 9999 there are no digits to read."""
    return NUMBERS.get(token) or (int(token[:4]) if token.isdecimal() else 0)


def say_of(head: Head, more: Head) -> None:
    """Add what stands before a verb."""
    head.side = more.side or head.side
    head.count, head.vague = (more.count, more.vague) if more.count else (head.count, head.vague)
    head.speed = more.speed or head.speed
    head.ways += more.ways
    head.limbs += more.limbs


def acts_of(head: Head, notes: list[str]) -> Iterator[tuple[Head, Act]]:
    """The act of a verb with what is said of it; sometimes two."""
    if says_no_act(head):
        notes.append(f"not understood, and left out: {head.word!r}")
        return
    held = holds(head)
    if held:
        head = replace(head, side="", ways=[way for way in head.ways if way != "up"])
    verb = verb_of(head)
    kind, side = KINDS[verb], head.side
    if head.verb == "stretch":
        side = side or "both"
    notes += wayless(head, verb)
    if head.toward in ONE and side in ONE and head.toward != side:
        notes.append(f"the {side} arm has no way to point to the {head.toward}: to its own side")
    if verb in ("punch", "kick") and side == "both":  # one after the other
        for k, one in enumerate(ONE):
            count = allowed_count(verb, kind, (head.count + 1 - k) // 2, notes)
            yield head, Act(verb, one, count, *said(kind, head, notes))
        return
    side = allowed_side(verb, kind, side, notes)
    count = allowed_count(verb, kind, 0 if head.vague and kind.most == 1 else head.count, notes)
    if kind.part == "arms" and "leg" in head.limbs and "arm" not in head.limbs:
        notes.append(f"{head.word!r} is done with the hands: the feet are left out")
    if kind.part != "arms" and "arm" in head.limbs and not held:
        notes.append(f"not understood, and left out: the arms of {verb!r}")
    yield head, Act(verb, side, count, *said(kind, head, notes), direction_of(verb, head))
    if held:
        yield Head("hold", "hold", "ing"), held


def says_no_act(head: Head) -> bool:
    """Whether a verb needs another word that is not there: "faces", "holds", "reaches"."""
    around, arm = head.side in ONE or {*head.ways} & {"around", "back"}, "arm" in head.limbs
    if head.word.startswith("fac"):
        return not around
    if head.verb == "hold":
        return not arm and not head.ways
    return head.word.startswith(("put", "reach", "stick")) and not arm


def holds(head: Head) -> Act | None:
    """The arms that are up during an act of the legs: "squats with both arms up"."""
    legs = head.verb == "spin" or head.verb in KINDS and KINDS[head.verb].part != "arms"
    up = "arm" in head.limbs and "up" in head.ways
    return Act("hold", head.side or "both") if legs and up and head.verb != "rise" else None


def verb_of(head: Head) -> str:
    """What a verb is with the words about it: to step to the left is *aside*."""
    ways, verb = {*head.ways}, head.verb
    if verb in ("walk", "run"):
        steps = head.word.startswith(("step", "shuffl", "mov", "go", "edg", "inch"))
        if "back" in ways:
            return "back"
        if "aside" in ways or steps and head.side in ONE:
            return "aside"
    if verb == "strike":
        return "kick" if "leg" in head.limbs else "punch"
    if verb == "hold" and "arm" in head.limbs and "up" not in ways and ways & {"forward", "aside"}:
        return "point"
    if verb == "rise" and "arm" in head.limbs:
        return "raise"
    return {"spin": "turn", "stretch": "raise"}.get(verb, verb)


def direction_of(verb: str, head: Head) -> str:
    """The direction of a turn, a jump or a pointing arm."""
    if verb == "turn":
        back = "back" in head.ways and head.side not in ONE
        return "around" if head.verb == "spin" or "around" in head.ways or back else ""
    if verb == "jump":
        return "forward" if "forward" in head.ways else ""
    if verb == "point":
        return "aside" if "aside" in head.ways else "forward"
    return ""


# the ways that an act can have, of those with which another act would be seen
ONLY = {
    "raise": ("up",), "clap": (), "punch": ("forward",), "point": ("forward", "aside"),
    "jump": ("up", "forward"), "kick": ("up", "forward"),
    "bow": ("forward",), "sit": ("back",), "squat": ("up",), "rise": ("up",),
}  # fmt: skip
IN_WORDS = {"up": "up", "forward": "forward", "aside": "to the side", "back": "back"}


def wayless(head: Head, verb: str) -> list[str]:
    """What to say of ways that an act does not have."""
    if "place" in head.ways and head.verb in ("walk", "run"):
        return [f"{head.word!r} has no way to stay on the spot, and goes along"]
    other = {*head.ways} - {*ONLY.get(verb, IN_WORDS)}
    if head.verb in ("walk", "run") and {"forward", "back"} <= {*head.ways}:
        other.add("forward")  # it goes back
    wrong = [words for way, words in IN_WORDS.items() if way in other]
    return [f"{head.word!r} has no way {way}: it is left out" for way in wrong]


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
