"""Sentences as people type them, and what `act` makes of them.

words.free_right    all that is asked for is to be seen, in its order, with sides and counts
words.free_refused  the sentence is refused
words.free_unsaid   something asked for is not to be seen, and nothing is said
words.free_seen_right, words.free_seen_unsaid    of the first hundred, by a vision model that looked
                    at sheets (`looked_at_free.json`) and did not know what was asked
edit.asked_is_shown, edit.unsaid    of edits of recordings whose legs and path are kept: acts, sides
                    and counts of the arms, by the rules of `metrics.texts`
edit.seen_asked_is_shown, edit.seen_unsaid    of half of them, by a vision model that looked at
                    sheets (`looked_at_edits.json`) and did not know what was asked

`free_sentences.json` has 200 sentences, written before the mover was trained by somebody who had
not seen the grammar, each with what a careful person must see. What the figure cannot do at all
counts as asked for, too: it is never right, and must be said. Judged by a network that the redraws
of `act` do not know (`second.py`); how well that one sees the data's own clips stands beside it.
"""

import json
import re
import warnings
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

import motiondiff_edu as md
from data_synth.actions import clips
from motiondiff_edu.beyond import timeline
from motiondiff_edu.conditions.text import TextError
from motiondiff_edu.editing.masks import body_part
from motiondiff_edu.metrics.texts import COUNTED, Asked, Recognised, actions, shortfalls
from motiondiff_edu.motion.motion import Motion
from motiondiff_edu.performers.mover import Mover
from motiondiff_edu.pretrained import checkpoints

from ..recordings.windows import FULL, recorded, trials
from ..walks.parts import weights_digest
from ..walks.scores import Measure, measure_of
from .second import tagged, trained

FREE = Path(__file__).with_name("free_sentences.json")
EDITED = 10  # windows of recorded walks, each edited in the ways of ARMS
# the gerund, and the verb, side and count that are to be seen
ARMS = (
    ("waving with the left hand", "wave", "left", 0),
    ("clapping three times", "clap", "", 3),
    ("raising both arms", "raise", "both", 1),
    ("pointing forward with the right hand", "point", "right", 0),
    ("punching with the right hand twice", "punch", "right", 2),
    ("raising the left arm", "raise", "left", 1),
)
SEEN_FREE = Path(__file__).with_name("looked_at_free.json")
SEEN_EDITS = Path(__file__).with_name("looked_at_edits.json")
KNOWN = 150  # clips of the data, on which the judge is judged
# notes that say that something is missing, and not only how a word was read
SAYS = re.compile("asked: |not understood|left out|at most|has no|one side|one speed|once, not")


@dataclass(frozen=True)
class Tried:
    """A sentence: whether it was refused, what is missing, what was said, and what was read."""

    text: str
    refused: bool
    missing: tuple[str, ...]
    said: tuple[str, ...]
    read: str = ""

    @property
    def right(self) -> bool:
        return not self.refused and not self.missing

    @property
    def unsaid(self) -> bool:
        return not self.refused and bool(self.missing) and not self.said


def sentences() -> list[dict]:
    """The sentences with what they ask for."""
    return json.loads(FREE.read_text(encoding="utf-8"))


def asked_of(record: dict) -> list[list[Asked]]:
    """The acts of a record as a recogniser takes them; a vague plural has no count."""
    return [
        [Asked(act["verb"], act.get("side", ""), act.get("count", 0)) for act in step]
        for step in record["steps"]
    ]


def missing_of(record: dict, found: list[Recognised]) -> list[str]:
    """What is not to be seen of a record."""
    words = list(record["beyond"])
    words += shortfalls(asked_of(record), found)
    for act in (act for step in record["steps"] for act in step if "min_count" in act):
        if act["verb"] not in COUNTED:  # steps are not counted
            continue
        times = [one.count for one in found if one.verb == act["verb"]]
        if times and max(times) < act["min_count"]:
            words.append(f"{act['verb']!r} is to be seen {max(times)} times")
    return words


def tried(mover: Mover, record: dict, judge, seed: int) -> Tried:
    """What `act` makes of one sentence."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        try:
            made = mover.act(record["text"], seed=seed, progress=False)
        except TextError:
            return Tried(record["text"], True, (), ())
    missing = missing_of(record, judge(made.positions))
    notes = tuple(str(one.message) for one in said if SAYS.search(str(one.message)))
    return Tried(record["text"], False, tuple(missing), notes, made.about)


def edited(motion: Motion, text: str, record: dict, seed: int) -> Tried:
    """What `edit` makes of one sentence about the arms of a recording, whose legs are kept."""
    legs = body_part(len(motion), "lower body")
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        made = md.edit(motion, text, legs, seed=seed, progress=False)
    wanted = [act for act in asked_of(record)[0] if act.verb != "walk"]  # of the arms
    missing = shortfalls([wanted], actions(made.positions))
    notes = tuple(str(one.message) for one in said if SAYS.search(str(one.message)))
    return Tried(text, False, tuple(missing), notes)


def edit_measures(most: int | None = None) -> list[Measure]:
    """The measures of 60 edits of recorded walks.

    By the rules: the network was trained on synthetic clips, and sees recordings badly.
    """
    windows = [one for _, one in recorded(trials(), replace(FULL, each=2)) if walks(one)][:EDITED]
    tries = [(motion, arms) for motion in windows for arms in ARMS][:most]
    found = []
    for k, (motion, (gerund, verb, side, count)) in enumerate(tries):
        record = {"steps": [[{"verb": verb, "side": side, "count": count}]]}
        found.append(edited(motion, f"walks forward while {gerund}", record, k))
    return [
        share("asked_is_shown", [one.right for one in found]),
        share("unsaid", [one.unsaid for one in found]),
    ]


def seen_measures(digest: str) -> list[Measure]:
    """What was seen of edits, beside what was asked; nothing if other weights were looked at."""
    record = json.loads(SEEN_EDITS.read_text(encoding="utf-8"))
    if record["weights"] != digest:
        return []
    wanted = {gerund: (verb, side, count) for gerund, verb, side, count in ARMS}
    shown = [any(fits(wanted[one["asked"]], act) for act in one["seen"]) for one in record["edits"]]
    said = [one["said"] for one in record["edits"]]
    return [
        share("seen_asked_is_shown", shown),
        share("seen_unsaid", [not (a or b) for a, b in zip(shown, said, strict=True)]),
    ]


def seen_free_measures(digest: str, found: list[Tried]) -> list[Measure]:
    """The same of what was seen of sentences; a sentence that is refused was not looked at.

    `found`: what `act` makes today. Nothing if it reads one of them otherwise.
    """
    record = json.loads(SEEN_FREE.read_text(encoding="utf-8"))
    today = [(one.refused, one.read) for one in found]
    looked = [(one["refused"], one.get("read", "")) for one in record["sentences"]]
    if record["weights"] != digest or today[: len(looked)] != looked[: len(today)]:
        return []
    right, unsaid = [], []
    for sentence, one in zip(sentences(), record["sentences"], strict=False):
        acts = [Recognised(*act, "", k, k + 0.5) for k, act in enumerate(one["seen"])]
        missing = missing_of(sentence, acts)
        right.append(not one["refused"] and not missing)
        unsaid.append(not one["refused"] and bool(missing) and not one["said"])
    return [share("free_seen_right", right), share("free_seen_unsaid", unsaid)]


def fits(wanted: tuple[str, str, int], seen: list) -> bool:
    """Whether an act that was seen is the one that was asked for; 0 times says nothing."""
    return all(not want or want == one for want, one in zip(wanted, seen, strict=True))


def walks(motion: Motion) -> bool:
    """Whether somebody walks in a recording, and does nothing that has a name with the arms."""
    seen = {one.verb for one in actions(motion.positions)}
    return "walk" in seen and not seen & {*timeline.ARMS} and len(motion) >= 60


def share(name: str, rows: list[bool]) -> Measure:
    return measure_of(name, "share", np.mean, np.array(rows, float))


def free_records(weights: Path, command: str, quick: bool) -> list[dict]:
    """All records."""
    mover, most = checkpoints.load(weights), 6 if quick else None
    model, scaler = trained()

    def judge(positions):
        return tagged(model, scaler, positions)

    about = {"weights": weights_digest(weights)}
    made = [tried(mover, record, judge, k) for k, record in enumerate(sentences()[:most])]
    found = [*free_measures(made, judge), *seen_free_measures(about["weights"], made)]
    records = [
        one.as_record("words.", about | {"sentences": len(sentences())}, command) for one in found
    ]
    edits = [*edit_measures(most), *seen_measures(about["weights"])]
    count = EDITED * len(ARMS)
    return records + [one.as_record("edit.", about | {"edits": count}, command) for one in edits]


def free_measures(made: list[Tried], judge) -> list[Measure]:
    """The measures of the sentences, and of how well the judge sees the data's own clips."""
    known = [one.acted for one in clips(KNOWN, 301, "test")]
    seen = []
    for acted in known:
        phrases = [[Asked(a.verb, a.side, a.count) for a in p.acts] for p in acted.sentence]
        seen.append(not shortfalls(phrases, judge(acted.positions)))
    return [
        share("free_right", [one.right for one in made]),
        share("free_refused", [one.refused for one in made]),
        share("free_unsaid", [one.unsaid for one in made]),
        share("free_judge", seen),
    ]
