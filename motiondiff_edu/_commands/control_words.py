"""A control in words: "3s 1.2; 4s 1.0 turn 0.6" is three seconds at 1.2 m/s, then four to the left.

    piece  = SECONDS"s" FORWARD [left SPEED | right SPEED] [turn RATE]
    words  = piece; piece; ...
Speeds in m/s, a turn in rad/s, counter-clockwise (to the left) seen from above; -1 walks backwards.
"""

import math
import re

FORM = '"3s 1.2; 4s 1.0 turn 0.6": seconds, speed ahead, then left, right or turn with a number'
SIDES = {"left": (2, 1.0), "right": (2, -1.0), "turn": (3, 1.0)}  # (column, sign)
LONGEST = 3600.0  # seconds


class ControlError(ValueError):
    """Words that are no control: what is wrong, and a mark under it."""

    def __init__(self, problem: str, words: str, at: int):
        mark = f"\n  {words}\n  {' ' * at}^"
        super().__init__(f"{problem} (character {at + 1} of the control){mark}\nIt reads {FORM}.")


def parse(words: str) -> list[tuple[float, float, float, float]]:
    """Segments for `joystick`: (seconds, forward, left, turn).  Raises ControlError."""
    segments, at = [], 0
    for piece in words.split(";"):
        found = [(match.group(), at + match.start()) for match in re.finditer(r"\S+", piece)]
        if found:
            segments.append(_segment(found, words, at + len(piece)))
        elif segments or at + len(piece) < len(words):
            if words[at:].strip(" ;\t\n"):
                raise ControlError("there is nothing between two semicolons", words, at)
        at += len(piece) + 1
    if not segments:
        raise ControlError("the control is empty", words, 0)
    if sum(segment[0] for segment in segments) > LONGEST:
        raise ControlError(f"this lasts longer than {LONGEST:g} s", words, 0)
    return segments


def _segment(found: list, words: str, end: int) -> tuple[float, float, float, float]:
    """One piece, word by word."""
    (first, at), *rest = found
    if not first.endswith("s"):
        raise ControlError(f"a piece begins with its seconds, as 3s, not {first!r}", words, at)
    seconds = _number(first[:-1], words, at)
    if not 0 < seconds <= LONGEST:
        raise ControlError(f"seconds are above 0 and at most {LONGEST:g}", words, at)
    if not rest:
        raise ControlError("after the seconds comes the speed ahead, in m/s", words, end)
    (speed, at), *rest = rest
    values = [seconds, _number(speed, words, at), 0.0, 0.0]
    told: set[int] = set()
    while rest:
        (name, at), *rest = rest
        if name not in SIDES:
            raise ControlError(f"{name!r} is none of left, right and turn", words, at)
        column, sign = SIDES[name]
        if column in told:
            raise ControlError(f"{name!r}: this was told already", words, at)
        if not rest:
            raise ControlError(f"a number is missing after {name!r}", words, end)
        (number, at), *rest = rest
        values[column] = sign * _number(number, words, at)
        told.add(column)
    return tuple(values)


def _number(text: str, words: str, at: int) -> float:
    """A finite number.  Raises ControlError with a hint for a comma."""
    try:
        number = float(text)
    except ValueError:
        hint = "; write a decimal point" if "," in text else ""
        raise ControlError(f"{text!r} is no number{hint}", words, at) from None
    if not math.isfinite(number):
        raise ControlError(f"{text!r} is no finite number", words, at)
    return number
