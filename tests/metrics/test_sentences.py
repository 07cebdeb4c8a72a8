"""How far a motion does what a sentence says: by hand, and on performed sentences."""

from dataclasses import replace

import numpy as np
import pytest

from data_synth.actions import clips
from motiondiff_edu.metrics.texts import Asked, Recognised, actions, agreement, confusion, rows_of


def seen(verb: str, side: str = "", count: int = 1, at: float = 1.0) -> Recognised:
    return Recognised(verb, side, count, "", at - 0.5, at + 0.5)


KICK = Asked("kick", "left", 2)
WAVE = Asked("wave", "right")
WALK = Asked("walk")


@pytest.mark.parametrize(
    "phrases, found, wanted",
    [
        ([[KICK]], [seen("kick", "left", 2)], (1.0, 1.0, 1.0, np.nan)),
        ([[KICK]], [seen("kick", "right", 3)], (1.0, 0.0, 0.0, np.nan)),
        ([[KICK]], [], (0.0, np.nan, np.nan, np.nan)),
        ([[KICK]], [seen("kick", "left", 2), seen("jump")], (0.5, 1.0, 1.0, np.nan)),
        ([[KICK], [WALK]], [seen("kick", "left", 2), seen("walk", at=4)], (1.0, 1.0, 1.0, 1.0)),
        ([[KICK], [WALK]], [seen("kick", "left", 2, 4), seen("walk")], (1.0, 1.0, 1.0, 0.0)),
        ([[WALK, WAVE]], [seen("walk", at=2), seen("wave", "right")], (1.0, 1.0, np.nan, np.nan)),
        ([[WALK, WAVE], [KICK]], [seen("walk")], (1 / 3, np.nan, np.nan, np.nan)),
        ([], [], (np.nan,) * 4),
        ([], [seen("jump")], (0.0, np.nan, np.nan, np.nan)),
    ],
)
def test_agreement_by_hand(phrases, found, wanted):
    one = agreement(phrases, found)
    np.testing.assert_allclose((one.action, one.side, one.count, one.order), wanted)


@pytest.mark.parametrize(
    "phrases, found, whole",
    [
        ([[KICK], [WALK]], [seen("kick", "left", 2), seen("walk", at=4)], 1),
        ([[KICK], [WALK]], [seen("kick", "left", 2, 4), seen("walk")], 0),  # order
        ([[KICK]], [seen("kick", "right", 2)], 0),
        ([[KICK]], [seen("kick", "left", 1)], 0),
        ([[KICK]], [seen("kick", "left", 2), seen("jump")], 0),
        ([[KICK]], [], 0),
        ([[Asked("jump", direction="forward")]], [seen("jump")], 0),
        ([], [], 1),  # nothing but standing is asked for
        ([], [seen("jump")], 0),
    ],
)
def test_a_motion_is_right_as_a_whole_if_nothing_is_wrong_missing_or_too_much(
    phrases, found, whole
):
    assert agreement(phrases, found).whole == whole


def test_two_acts_of_one_verb_are_matched_by_their_sides():
    """In whichever order they are asked for, and with one of them missing."""
    left, right = Asked("punch", "left", 3), Asked("punch", "right", 1)
    found = [seen("punch", "right", 1, 5.0), seen("punch", "left", 3, 1.0)]
    assert agreement([[left], [right]], found).order == 1
    assert agreement([[right], [left]], found).order == 0
    for phrases in ([[left], [right]], [[right], [left]]):
        one = agreement(phrases, found)
        assert (one.action, one.side, one.count) == (1.0, 1.0, 1.0)
        lone = agreement(phrases, found[1:])
        assert (lone.action, lone.side, lone.count) == (0.5, 1.0, 1.0)


def asked_of(acted) -> list[list[Asked]]:
    return [
        [Asked(a.verb, a.side, a.count, a.direction) for a in phrase.acts if a.verb != "stand"]
        for phrase in acted.sentence
    ]


def test_performed_sentences_agree_and_shuffled_ones_do_not():
    made = [clip.acted for clip in clips(60, 95, "test")]
    sentences, found = [asked_of(one) for one in made], [actions(one.positions) for one in made]
    own = {kind: np.nanmean(row) for kind, row in rows_of(sentences, found).items()}
    assert own["action"] > 0.97
    assert min(own[kind] for kind in ("side", "count", "order", "direction")) > 0.95
    other = rows_of(sentences[7:] + sentences[:7], found)
    assert np.nanmean(other["action"]) < 0.25
    assert own["whole"] > 0.9 > 0.1 > other["whole"].mean()


def test_confusion_counts_sides():
    sentences = [[[KICK]], [[KICK]], [[KICK]], [[WAVE]], [[WALK]]]
    found = [[seen("kick", "left")], [seen("kick", "right")], [], [seen("wave", "right")], []]
    assert confusion(sentences, found) == {
        ("left", "left"): 1,
        ("left", "right"): 1,
        ("left", "none"): 1,
        ("right", "right"): 1,
    }


def test_an_act_on_both_sides_is_no_right_side_unless_both_were_asked_for():
    left, right = Asked("raise", "left"), Asked("raise", "right")
    twice = [seen("raise", "left"), seen("raise", "right", at=3)]
    assert confusion([[[left]]], [twice]) == {("left", "both"): 1}
    assert confusion([[[left]]], [[seen("raise", "both")]]) == {("left", "both"): 1}
    both = {("left", "left"): 1, ("right", "right"): 1}
    assert confusion([[[left], [right]]], [twice]) == both
    assert confusion([[[left], [right]]], [twice[:1]]) == {
        ("left", "left"): 1,
        ("right", "none"): 1,
    }


def test_one_side_and_then_both_are_no_confusion():
    left, both = Asked("raise", "left"), Asked("raise", "both")
    found = [seen("raise", "left"), seen("raise", "both", at=3)]
    assert confusion([[[left], [both]]], [found]) == {("left", "left"): 1}
    assert confusion([[[left], [both]]], [found[1:]]) == {("left", "none"): 1}


def test_directions_are_judged_where_a_verb_has_them():
    around, ahead = Asked("turn", "left", direction="around"), Asked("point", "left", 1, "forward")
    turned = Recognised("turn", "left", 1, "", 0.0, 1.0)
    aside = Recognised("point", "left", 1, "aside", 2.0, 3.0)
    assert agreement([[around], [ahead]], [turned, aside]).direction == 0
    half = replace(turned, direction="around")
    assert agreement([[around], [ahead]], [half, aside]).direction == 0.5
    assert np.isnan(agreement([[WALK]], [seen("walk")]).direction)
