"""The goals of measures: which are met, which were missed, and which are near their limits.

A line of a `goals` block of the template is `record | limit | words`; a line `# words` begins a
group. A limit is `at least 2`, `at most 2` or `1 to 2`.
"""

import re
from dataclasses import dataclass

from .records import cell, interval, number, table

LIMIT = re.compile(
    r"(?:at least (?P<least>\S+)|at most (?P<most>\S+)|(?P<low>\S+) to (?P<high>\S+))$"
)


@dataclass(frozen=True)
class Goal:
    """A record, the range that it should lie in, its words, and its group."""

    name: str
    limit: str
    words: str
    group: str

    @property
    def range(self) -> tuple[float, float]:
        """The least and the largest value that meet it. Raises ValueError for an unclear limit."""
        found = LIMIT.match(self.limit)
        if found is None:
            raise ValueError(f"{self.name}: write 'at least x', 'at most x' or 'x to y', "
                             f"not {self.limit!r}")  # fmt: skip
        low, high = found["least"] or found["low"], found["most"] or found["high"]
        return float(low or "-inf"), float(high or "inf")

    def met(self, value: float) -> bool:
        low, high = self.range
        return low <= value <= high

    def shown(self, value: float) -> str:
        """Three digits, or as many as show on which side of the limit the value lies."""
        texts = (number(value), *(f"{value:.{digits}g}" for digits in range(4, 18)))
        return next(text for text in texts if self.met(float(text)) == self.met(value))


def read_goals(block: str) -> list[Goal]:
    """The goals of a block of the template."""
    goals, group = [], ""
    for line in block.splitlines():
        if line.startswith("# "):
            group = line[2:]
        else:
            goals.append(Goal(*line.split(" | "), group))
    return goals


def judged(goals: list[Goal], records: dict[str, dict]) -> dict[Goal, str]:
    """Met, close (met, but the interval reaches past the limit), missed, or not measured."""
    found = {}
    for goal in goals:
        one = records.get(goal.name)
        if one is None or one["value"] is None:
            found[goal] = "not measured"
        elif not goal.met(one["value"]):
            found[goal] = "missed"
        else:
            ends = [one[side] for side in ("low", "high") if one[side] is not None]
            found[goal] = "met" if all(map(goal.met, ends)) else "close"
    return found


def places(goals: list[Goal], records: dict[str, dict]) -> dict[str, str]:
    """What the template can name: numbers of goals, and tables of them."""
    found = judged(goals, records)
    counts = {word: list(found.values()).count(word) for word in ("met", "close", "missed")}
    texts = {f"goals {word}": _listed(found, records, word) for word in ("missed", "close")}
    groups = {goal.group: [0, 0] for goal in goals}
    for goal, said in found.items():
        groups[goal.group][0] += said in ("met", "close")
        groups[goal.group][1] += 1
    texts["goals by group"] = "; ".join(f"{name} {m} of {n}" for name, (m, n) in groups.items())
    return texts | {
        "number of goals": str(len(goals)),
        "number of goals met": str(counts["met"] + counts["close"]),
        "number of goals missed": str(counts["missed"]),
        "number of goals close": str(counts["close"]),
    }


def goals_table(goals: list[Goal], records: dict[str, dict]) -> str:
    """All goals, with what was measured."""
    rows = [
        [goal.words, f"`{goal.name}`", goal.limit, _measured(goal, records), said]
        for goal, said in judged(goals, records).items()
    ]
    return table(["goal", "record", "limit", "measured", ""], rows)


def _listed(found: dict[Goal, str], records: dict[str, dict], word: str) -> str:
    rows = [
        [goal.words, goal.limit, _measured(goal, records)]
        for goal, said in found.items()
        if said == word
    ]
    return table(["what", "goal", "measured"], rows) if rows else "None.\n"


def _measured(goal: Goal, records: dict[str, dict]) -> str:
    one = records.get(goal.name)
    if one is None or one["value"] is None:
        return cell(one)
    return f"{goal.shown(one['value'])} {interval(one)}".strip()
