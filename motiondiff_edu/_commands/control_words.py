"""A control as text.

"3s 1.2; 4s 1.0 turn 0.6" is three seconds at 1.2 m/s, then four seconds at 1.0 m/s in a left turn.

    segment = SECONDS"s" FORWARD [left SPEED | right SPEED] [turn RATE]
    control = segment; segment; ...
Speeds are in m/s; a negative FORWARD walks backwards. RATE is in rad/s, counter-clockwise (to the
left) seen from above.
"""

import math
import re

FORM = (
    '"3s 1.2; 4s 1.0 turn 0.6": the duration in seconds, the forward speed in m/s, '
    "then optionally left, right or turn with a number"
)
SIDES = {"left": (2, 1.0), "right": (2, -1.0), "turn": (3, 1.0)}  # (column, sign)
LONGEST = 3600.0  # seconds


class ControlError(ValueError):
    """The text is not a control; the message says what is wrong and marks the place."""

    def __init__(self, problem: str, words: str, at: int):
        mark = f"\n  {words}\n  {' ' * at}^"
        super().__init__(
            f"{problem} (character {at + 1} of the control){mark}\nA control looks like {FORM}."
        )


def parse(words: str) -> list[tuple[float, float, float, float]]:
    """Segments for `joystick`: (seconds, forward, left, turn).  Raises ControlError."""
    segments, at = [], 0
    for part in words.split(";"):
        found = [(match.group(), at + match.start()) for match in re.finditer(r"\S+", part)]
        if found:
            segments.append(_segment(found, words, at + len(part)))
        elif segments or at + len(part) < len(words):
            if words[at:].strip(" ;\t\n"):
                raise ControlError("there is nothing between two semicolons", words, at)
        at += len(part) + 1
    if not segments:
        raise ControlError("the control is empty", words, 0)
    if sum(segment[0] for segment in segments) > LONGEST:
        raise ControlError(f"the control lasts longer than {LONGEST:g} s", words, 0)
    return segments


def _segment(found: list, words: str, end: int) -> tuple[float, float, float, float]:
    """Parse one segment, word by word."""
    (first, at), *rest = found
    if not first.endswith("s"):
        raise ControlError(f"a segment begins with its duration, as 3s, not {first!r}", words, at)
    seconds = _number(first[:-1], words, at)
    if not 0 < seconds <= LONGEST:
        raise ControlError(f"a duration is above 0 and at most {LONGEST:g} s", words, at)
    if not rest:
        raise ControlError("the forward speed (m/s) is missing after the duration", words, end)
    (speed, at), *rest = rest
    values = [seconds, _number(speed, words, at), 0.0, 0.0]
    filled: set[int] = set()  # columns
    while rest:
        (name, at), *rest = rest
        if name not in SIDES:
            raise ControlError(f"{name!r} is not left, right or turn", words, at)
        column, sign = SIDES[name]
        if column in filled:
            raise ControlError(f"{name!r}: this speed is already given", words, at)
        if not rest:
            raise ControlError(f"a number is missing after {name!r}", words, end)
        (number, at), *rest = rest
        values[column] = sign * _number(number, words, at)
        filled.add(column)
    seconds, forward, left, turn = values
    return seconds, forward, left, turn


def _number(text: str, words: str, at: int) -> float:
    """Parse a finite number.  Raises ControlError, with a hint for a decimal comma."""
    try:
        number = float(text)
    except ValueError:
        hint = "; write a decimal point" if "," in text else ""
        raise ControlError(f"{text!r} is not a number{hint}", words, at) from None
    if not math.isfinite(number):
        raise ControlError(f"{text!r} is not a finite number", words, at)
    return number
