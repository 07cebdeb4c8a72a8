"""The sections on filling in where the right answer is a formula, and on both papers' repairs."""

import numpy as np
import pytest

from motiondiff_edu.baselines.known_answer import Method
from motiondiff_edu.motion.root_frame import to_world
from tools.results.inbetweens import known_answer, known_tables
from tools.results.inbetweens.known_answer import KnownSize
from tools.results.repairs.both import WINDOW, masked_window
from tools.results.repairs.repair import FAULTS
from tools.results.walks.trials import unseen


@pytest.fixture(scope="module")
def records():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            known_answer, "METHODS", (Method("exact"), Method("masked", 50))
        )  # the quick ones
        found = known_answer.known_answer_records(
            KnownSize(questions=2, samples=30, clips=6), "a command"
        )
    return {one["name"]: one for one in found}


def test_draws_from_the_wanted_err_least_and_masking_is_off(records):
    for hole in ("seed", "keyframes", "lower body", "past-frames", "past-leg"):
        exact, masked = (
            records[f"known-answer.{hole}.{way}.mean"]["value"] for way in ("exact", "masked.50")
        )
        assert exact < 0.4 < masked, hole
    gibbs, back = (
        records[f"known-answer.past-leg.{way}.20.mean"]["value"]
        for way in ("gibbs", "there-and-back")
    )
    assert gibbs < 0.4 and gibbs < back


def test_the_table_has_a_row_for_each_way_and_a_column_for_each_hole(records):
    said = known_tables.known_answers(records)
    assert "| way | seed | keyframes | lower body | past-frames | past-leg |" in said
    assert (
        said.count("<br>`masked.50` |") == said.count("<br>`gibbs.20` |") == 3
        and "2 windows and 30 samples" in said
    )
    assert known_tables.known_answers({}) == known_tables.both({}) == ""


def test_the_masking_network_sees_what_the_walker_sees():
    trials = unseen(3, 4)
    broken = FAULTS["frames"](trials.past)
    world, known = masked_window(trials, broken.known)
    assert (
        world.shape == (3, WINDOW, 21, 3) and known[:, 10:20].sum() == 3 * 10
    )  # the pelvis' path, ten frames on
    assert known[:, 3:7].sum() == 3 * 4
    whole = to_world(np.concatenate([trials.past[0], trials.truth[0]]), trials.control[0])
    np.testing.assert_allclose(world[0], whole[:WINDOW], atol=1e-9)


def test_both_papers_repairs_in_a_row_each():
    measures = [
        (f, w, k)
        for f in ("arm", "leg")
        for w in ("masked", "there_and_back")
        for k in ("mean", "one")
    ]
    names = [f"mend-both.{fault}.{way}.{kind}_cm" for fault, way, kind in measures]
    seeds = {"samples": 10, "clips": 40}
    records = {
        n: {"value": i, "low": i, "high": i, "seeds": seeds, "unit": "cm"}
        for i, n in enumerate(names, 1)
    }
    said = known_tables.both(records)
    assert "| way | arm, mean | arm, one | leg, mean | leg, one |" in said
    assert "<br>`masked` | 1 | 2 | 5 | 6 |" in said and "mean of 10 repairs" in said
