"""Free sentences: what counts as right, refused and unsaid, and the second judge's counting."""

import json
import re
import warnings
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from data_synth.actions import Act, Phrase, act_out
from motiondiff_edu.beyond import timeline
from motiondiff_edu.conditions.text import TextError
from motiondiff_edu.metrics.texts import Recognised, actions
from motiondiff_edu.motion.motion import MotionWarning
from tools.results.words import free
from tools.results.words.second import times_of


def mover_that(says: str = "", refuses: bool = False):
    """A mover that kicks twice with the left foot whatever it is asked."""
    positions = act_out((Phrase(Act("kick", "left", count=2)),), 5.0, 3).positions

    def act(text, seed, progress):
        if refuses:
            raise TextError("what?")
        if says:
            warnings.warn(says, MotionWarning, stacklevel=1)
        return SimpleNamespace(positions=positions, about="kicks")

    return SimpleNamespace(act=act)


KICKS = {"text": "kicks twice", "steps": [[{"verb": "kick", "count": 2}]], "beyond": []}


@pytest.mark.parametrize(
    "mover, record, right, refused, unsaid",
    [
        (mover_that(), {}, True, False, False),
        (mover_that(), {"beyond": ["a ball"]}, False, False, True),
        (mover_that("not understood, and left out: 'ball'"), {"beyond": ["a ball"]},
         False, False, False),
        (mover_that("'boots' is read as 'kicks'"), {"beyond": ["a ball"]}, False, False, True),
        (mover_that(), {"steps": [[{"verb": "kick", "count": 3}]]}, False, False, True),
        (mover_that(), {"steps": [[{"verb": "kick", "min_count": 2}]]}, True, False, False),
        (mover_that(), {"steps": [[{"verb": "kick", "min_count": 3}]]}, False, False, True),
        (mover_that(), {"steps": [[{"verb": "kick", "side": "right"}]]}, False, False, True),
        (mover_that("asked: kicks, jumps; but 'jump' is not to be seen"),
         {"steps": [[{"verb": "kick"}], [{"verb": "jump"}]]}, False, False, False),
        (mover_that(refuses=True), {}, False, True, False),
    ],
)  # fmt: skip
def test_a_sentence_is_right_refused_or_unsaid(mover, record, right, refused, unsaid):
    found = free.tried(mover, KICKS | record, actions, 0)
    assert (found.right, found.refused, found.unsaid) == (right, refused, unsaid)


def test_steps_are_not_counted():
    steps = [Recognised("back", "", 1, "", 0.0, 2.0), Recognised("kick", "left", 1, "", 2.0, 3.0)]
    for verb, missing in (("back", []), ("kick", ["'kick' is to be seen 1 times"])):
        record = {"beyond": [], "steps": [[{"verb": verb, "min_count": 2}]]}
        assert free.missing_of(record, steps) == missing


def test_the_sentences_ask_for_acts_that_there_are():
    records = free.sentences()
    assert len(records) == 200 and len({one["text"] for one in records}) == 200
    verbs = {act["verb"] for one in records for step in one["steps"] for act in step}
    assert verbs <= {*timeline.VERBS} and len(verbs) > 12
    assert all(one["steps"] or one["beyond"] for one in records)
    assert all(re.search("[a-zA-Z]", one["text"]) for one in records)


@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_the_second_judge_counts_hills(count):
    act = timeline.Timed("kick", "left", count, 1.0, 1.0 + 1.3 * count)
    made = timeline.timeline([act], 140)
    rng = np.random.default_rng(count)
    assert times_of(act, made + 0.05 * rng.standard_normal(made.shape)) == count
    assert times_of(timeline.Timed("walk", "", 1, 0.0, 3.0), made) == 1


def test_edits_that_were_looked_at_are_counted_for_their_weights_alone():
    record = json.loads(free.SEEN_EDITS.read_text(encoding="utf-8"))
    assert len(record["edits"]) == 30 and free.seen_measures("others") == []
    shown, unsaid = (one.value for one in free.seen_measures(record["weights"]))
    assert 0.5 < shown < 1 and unsaid <= 1 - shown
    assert free.fits(("clap", "", 3), ["clap", "", 3])
    assert not free.fits(("clap", "", 3), ["clap", "", 2])
    assert not free.fits(("wave", "left", 0), ["wave", "right", 1])


def test_sentences_that_were_looked_at_are_counted_for_their_weights_alone():
    record = json.loads(free.SEEN_FREE.read_text(encoding="utf-8"))
    rows = record["sentences"]
    made = [free.Tried("", one["refused"], (), (), one.get("read", "")) for one in rows]
    assert len(rows) == 100 and free.seen_free_measures("others", made) == []
    others = [*made[:50], replace(made[50], read="jumps up"), *made[51:]]
    assert free.seen_free_measures(record["weights"], others) == []  # it was read otherwise
    right, unsaid = (one.value for one in free.seen_free_measures(record["weights"], made))
    refused = sum(one["refused"] for one in record["sentences"]) / 100
    assert 0 < refused < 0.2 and 0.3 < right <= 1 - refused and unsaid < 1 - right - refused
