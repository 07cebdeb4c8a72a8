"""Sentences of actions: which acts there are, and what can be said of each.

An `Act` is one verb with what is said of it. A `Phrase` has an act of the legs, an act of the arms,
or both at once ("while"). A sentence is up to three phrases in a row ("then").
"""

from dataclasses import dataclass, replace

MOST = 4  # times that an act is repeated
PHRASES = 3  # of the longest sentence


@dataclass(frozen=True)
class Act:
    """One verb, and what is said of it; an empty word says nothing.

    side       "left", "right" or "both"
    count      1 to MOST
    speed      "slowly" or "quickly"
    direction  "forward", "aside" or "around"
    """

    verb: str
    side: str = ""
    count: int = 1
    speed: str = ""
    direction: str = ""


@dataclass(frozen=True)
class Verb:
    """What can be said of a verb, and the part of the body that it needs.

    kind    "way" (the legs travel or stand), "spot" (the legs act where they are) or "arms"
    period  seconds of one time, when nothing is said of the speed; of "way" the shortest duration

    Who sits down stays there until "rise", or until the legs do something else. A sentence that
    begins with "rise" begins on a seat.
    """

    kind: str
    period: float
    sides: tuple[str, ...] = ("",)
    most: int = 1
    speeds: tuple[str, ...] = ("",)
    directions: tuple[str, ...] = ("",)


ANY_SPEED = ("", "slowly", "quickly")
ONE_SIDE = ("left", "right")
ANY_SIDE = (*ONE_SIDE, "both")
VERBS: dict[str, Verb] = {
    "walk": Verb("way", 1.8, speeds=ANY_SPEED),
    "run": Verb("way", 1.8, speeds=("", "quickly")),
    "back": Verb("way", 1.8, speeds=("", "slowly")),
    "aside": Verb("way", 1.8, ONE_SIDE, speeds=("", "slowly")),
    "turn": Verb("way", 1.0, ONE_SIDE, directions=("", "around")),
    "stand": Verb("way", 1.2),
    "squat": Verb("spot", 1.35, most=MOST, speeds=ANY_SPEED),
    "jump": Verb("spot", 1.0, most=MOST, directions=("", "forward")),
    "kick": Verb("spot", 1.35, ONE_SIDE, MOST, ANY_SPEED),
    "sit": Verb("spot", 1.5, speeds=("", "slowly")),
    "rise": Verb("spot", 1.3, speeds=("", "slowly")),
    "bow": Verb("spot", 1.7, most=MOST, speeds=ANY_SPEED),
    "wave": Verb("arms", 2.2, ANY_SIDE, speeds=ANY_SPEED),
    "raise": Verb("arms", 1.6, ANY_SIDE, MOST, ANY_SPEED),
    "hold": Verb("arms", 2.2, ANY_SIDE),  # an arm up, for as long as the phrase lasts
    "punch": Verb("arms", 0.8, ONE_SIDE, MOST, ANY_SPEED),
    "clap": Verb("arms", 0.65, most=MOST, speeds=ANY_SPEED),
    "point": Verb("arms", 1.9, ONE_SIDE, directions=("forward", "aside")),
}
FACTORS = {"slowly": 1.4, "": 1.0, "quickly": 0.72}  # of the period
UNEVEN = 0.12  # share by which a period differs at most from its mean

OTHER_SIDE = {"left": "right", "right": "left"}


@dataclass(frozen=True)
class Phrase:
    """What happens at one time: an act of the legs, of the arms, or both."""

    legs: Act | None = None
    arms: Act | None = None

    def __post_init__(self):
        """Raises ValueError for a phrase without an act, and for an act that nobody can do."""
        if self.legs is None and self.arms is None:
            raise ValueError("a phrase needs an act of the legs or of the arms")
        for act, kinds in ((self.legs, ("way", "spot")), (self.arms, ("arms",))):
            if act is not None:
                check(act, kinds)

    @property
    def acts(self) -> tuple[Act, ...]:
        """The acts that there are, legs first."""
        return tuple(act for act in (self.legs, self.arms) if act is not None)


Sentence = tuple[Phrase, ...]


def check(act: Act, kinds: tuple[str, ...]) -> None:
    """Raise ValueError unless the act is a verb of these kinds, with words that suit it."""
    verb = VERBS.get(act.verb)
    if verb is None or verb.kind not in kinds:
        there = ", ".join(name for name, one in VERBS.items() if one.kind in kinds)
        raise ValueError(f"no such act is called {act.verb!r}; there are {there}")
    said = (("side", verb.sides), ("speed", verb.speeds), ("direction", verb.directions))
    for name, allowed in said:
        if getattr(act, name) not in allowed:
            words = ", ".join(repr(word) for word in allowed)
            raise ValueError(f"the {name} of {act.verb!r} is {getattr(act, name)!r}, not {words}")
    if not 1 <= act.count <= verb.most:
        raise ValueError(f"{act.verb!r} happens 1 to {verb.most} times, not {act.count}")


def mirrored(act: Act | None) -> Act | None:
    """The same act with left and right exchanged."""
    return act and replace(act, side=OTHER_SIDE.get(act.side, act.side))


def seated(sentence: Sentence) -> tuple[bool, ...]:
    """Whether the figure sits when each phrase begins, and at the end of the sentence.

    Raises ValueError where a figure that stands gets up, or one that sits sits down.
    """
    legs = [phrase.legs.verb for phrase in sentence if phrase.legs]
    now = bool(legs) and legs[0] == "rise"
    found = [now]
    for phrase in sentence:
        if phrase.legs is not None:
            verb = phrase.legs.verb
            if verb == ("sit" if now else "rise"):
                raise ValueError(f"a figure that {'sits' if now else 'stands'} cannot {verb}")
            now = verb == "sit"
        found.append(now)
    return tuple(found)
