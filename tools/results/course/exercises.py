"""The checks of the exercises, measured: on mutants of every solution, on the wrong answers of the
bug zoo, and on unusual right answers.

A diagnosis is wrong if it names another mistake than the one that was planted; or, for a mutant,
if the hint changes with the inputs of the check: then it was not true of the mutant.
"""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field

from motiondiff_edu.course.checks import zoo
from motiondiff_edu.course.checks._compare import other_inputs

from ... import mutants
from ...right_answers import RIGHT
from ..walks.scores import Measure

SEEDS = (1, 2, 3)  # of other inputs


@dataclass
class Tally:
    """Counts over all exercises, and what is to be mended."""

    counts: Counter = field(default_factory=Counter)
    faults: list[str] = field(default_factory=list)

    def add(self, what: str, right: bool, fault: str) -> None:
        self.counts[what] += 1
        self.counts[f"{what} failed"] += not right
        if not right:
            self.faults.append(f"{what}: {fault}")

    def share(self, what: str) -> float:
        """The share that failed."""
        return self.counts[f"{what} failed"] / max(1, self.counts[what])


def hint_of(told: str, hints) -> str | None:
    """The hint that a message ends with."""
    return next((hint for hint in hints if told.endswith(f": {hint}")), None)


def tallied(exercise: mutants.Exercise, tally: Tally, most: int | None = None) -> None:
    """Add what the check of one exercise makes of all kinds of answers."""
    mistakes, others = (table.get(exercise.check, {}) for table in zoo.load_all())
    judged = exercise.judged(most)
    tally.counts["mutants"] += judged.wrong
    tally.counts["mutants failed"] += len(judged.passing)
    tally.faults += [f"mutants: {exercise.check}, {words}" for words, _ in judged.passing]
    for words, (source, told) in judged.refused.items():
        hint = hint_of(told, mistakes)
        if hint:
            stable = all(one == told for one in _elsewhere(exercise, exercise.answer(source)))
            tally.add("diagnoses", stable, f"{exercise.check}, {words}: {hint}")
    planted = [(hint, one) for hint, wrong in mistakes.items() for one in zoo.several(wrong)]
    for hint, answer in planted:
        told = exercise.told(answer)
        tally.add("zoo", told is not None, f"{exercise.check}, {hint}")
        named = hint_of(told or "", mistakes)
        if named:
            tally.add("diagnoses", named == hint, f"{exercise.check}, {hint}: told {named}")
    for what, answer in others.items():
        tally.add("zoo", exercise.told(answer) is not None, f"{exercise.check}, {what}")
    for i, answer in enumerate(RIGHT[exercise.check]):
        told = exercise.told(answer)
        tally.add("right answers", told is None, f"{exercise.check}, {i}: {told}")


def _elsewhere(exercise: mutants.Exercise, answer) -> Iterator[str | None]:
    """What an answer is told on other inputs."""
    for seed in SEEDS:
        with other_inputs(seed):
            yield exercise.told(answer)


def course_records(command: str, most: int | None = None) -> list[dict]:
    """Mutants that pass, wrong answers that are caught, wrong diagnoses, right answers rejected."""
    tally = Tally()
    for path in mutants.notebook_cells.sources():
        for exercise in mutants.exercises(path):
            tallied(exercise, tally, most)
    for fault in tally.faults:
        print(fault)
    counts = tally.counts
    values = {
        "mutants_passing": (counts["mutants failed"], "count"),
        "zoo_caught": (1 - tally.share("zoo"), "share"),
        "wrong_diagnosis": (tally.share("diagnoses"), "share"),
        "right_answers_rejected": (counts["right answers failed"], "count"),
    }
    about = {what: counts[what] for what in ("mutants", "zoo", "diagnoses", "right answers")}
    return [
        Measure(name, float(value), float(value), float(value), unit).as_record(
            "course.", about, command
        )
        for name, (value, unit) in values.items()
    ]
