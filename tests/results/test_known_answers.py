"""Filling in where the right answer is a formula, and what both papers' repairs are given."""

import numpy as np
import pytest

from motiondiff_edu.baselines.known_answer import Method
from motiondiff_edu.motion.root_frame import to_world
from tools.results.inbetweens import known_answer
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
