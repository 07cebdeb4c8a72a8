"""Attention over words: rows, layers, padding of the sentence, and what is refused."""

import numpy as np
import pytest
import small_movers
import torch

from data_synth.actions import clips
from motiondiff_edu.beyond import timeline
from motiondiff_edu.conditions.text import TextError
from motiondiff_edu.course.analyses.attention_on_words import (
    WordMaps,
    attention_of_the_plan,
    attention_on_words,
)
from motiondiff_edu.motion.moving_frame import to_features
from motiondiff_edu.performers.mover import Mover

SMALL = small_movers.SMALL
PLANNED = small_movers.PLANNED


@pytest.fixture(scope="module")
def positions() -> np.ndarray:
    return next(iter(clips(1, 8))).acted.positions[:64]


@pytest.fixture(scope="module", params=[SMALL, PLANNED], ids=["alone", "planned"])
def mover(positions, request) -> Mover:
    return small_movers.mover_of(request.param, small_movers.scaler_of(to_features(positions)))


def maps(mover, text, positions, s=20) -> WordMaps:
    plan = torch.zeros(1, len(positions), timeline.D) if mover.can_plan else None
    draws = torch.Generator().manual_seed(0)
    return attention_on_words(mover, text, positions, s, plan=plan, generator=draws)


def test_each_layer_has_a_row_for_each_of_its_frames_that_sums_to_one(mover, positions):
    found = maps(mover, "a person kicks with the left foot", positions)
    assert "kick" in found.words and "left" in found.words
    rows = {name: weights.shape for name, weights in found.levels.items()}
    M = len(found.words)
    assert rows["down.0.ask"] == (64, M) and rows["down.1.ask"] == (32, M)
    assert rows["middle.ask"] == (16, M) and len(rows) == 5
    for weights in found.levels.values():
        np.testing.assert_allclose(weights.sum(1), 1, atol=1e-5)


def test_the_mean_by_frame_repeats_the_rows_of_slow_layers():
    slow = np.array([[1.0, 0.0], [0.0, 1.0]])
    fast = np.full((4, 2), 0.5)
    found = WordMaps(("left", "right"), {"slow": slow, "fast": fast}).by_frame(4)
    np.testing.assert_allclose(found[:, 0], [0.75, 0.75, 0.25, 0.25])


def test_rows_that_the_network_adds_at_the_end_are_left_out(mover, positions):
    found = maps(mover, "a person kicks with the left foot", positions[:62])
    rows = {name: len(weights) for name, weights in found.levels.items()}
    assert rows["down.0.ask"] == 62 and rows["down.1.ask"] == 31 and rows["middle.ask"] == 16
    deepest = WordMaps(found.words, {k: found.levels[k] for k in ("down.0.ask", "middle.ask")})
    wanted = (found.levels["down.0.ask"] + found.levels["middle.ask"].repeat(4, 0)[:62]) / 2
    np.testing.assert_allclose(deepest.by_frame(62), wanted)


def test_the_words_are_those_that_the_network_reads(mover, positions):
    walk = maps(mover, "marches ahead", positions)  # read as walk
    assert walk.words[0] == "walk"
    other = maps(mover, "walks ahead", positions)
    np.testing.assert_array_equal(walk.by_frame(64), other.by_frame(64))


def test_a_plan_has_maps_of_its_own_and_the_motion_needs_it(positions):
    features = to_features(positions)
    mover = small_movers.mover_of(PLANNED, small_movers.scaler_of(features))
    text, draws = "kicks with the left foot", torch.Generator().manual_seed(0)
    plan = torch.zeros(1, 64, timeline.D)
    found = attention_of_the_plan(mover, text, plan, 20, generator=draws)
    assert found.words[0] == "kick" and found.by_frame(64).shape == (64, len(found.words))
    np.testing.assert_allclose(found.by_frame(64).sum(1), 1, atol=1e-5)
    other = maps(mover, text, positions)
    assert set(found.levels) != set(other.levels) or not np.allclose(
        found.by_frame(64), other.by_frame(64)
    )
    with pytest.raises(ValueError, match="plan: this mover needs one"):
        attention_on_words(mover, text, positions, 20)


def test_what_has_no_map_is_refused(mover, positions):
    for s in (0, 31):
        with pytest.raises(ValueError, match="steps are 1 to 30"):
            maps(mover, "walks", positions, s)
    with pytest.raises(TextError):
        maps(mover, "does a cartwheel", positions)
