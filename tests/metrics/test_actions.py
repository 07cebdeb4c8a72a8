"""Actions read off by rules: right on performed sentences, nothing on what is no action."""

from collections import Counter

import numpy as np
import pytest
from gaits import rest_pose

from data_synth.actions import Act, Phrase, act_out, clips, mirror
from motiondiff_edu.metrics.texts import Recognised, actions, has_a_body

LIKE = ("verb", "side", "count", "direction")


def performed(verb: str, seconds: float = 8.0, seed: int = 4, **said) -> np.ndarray:
    act = Act(verb, **said)
    arms = verb in ("wave", "raise", "punch", "clap", "point")
    return act_out((Phrase(None if arms else act, act if arms else None),), seconds, seed).positions


def of(act: Act | Recognised) -> tuple:
    return tuple(getattr(act, name) for name in LIKE)


def expected(acted) -> list[tuple]:
    """What was performed, as a recogniser can tell it: to stand still is no action."""
    return [of(span.act) for span in acted.spans if span.act.verb != "stand"]


@pytest.fixture(scope="module")
def unseen():
    return [clip.acted for clip in clips(150, 91, "test")]


def test_nearly_every_performed_sentence_is_read_as_it_is(unseen):
    """Verbs, sides, counts and directions, all of a clip; measured .98 on other seeds."""
    right = [Counter(expected(a)) == Counter(map(of, actions(a.positions))) for a in unseen]
    assert np.mean(right) >= 0.95


def test_the_order_of_phrases_is_read(unseen):
    """Of the clips whose acts are all found, each once."""
    wrong = tried = 0
    for acted in unseen:
        found = {of(one)[:2]: (one.first + one.last) / 2 for one in actions(acted.positions)}
        phrases = [
            [found.get((act.verb, act.side)) for act in phrase.acts if act.verb != "stand"]
            for phrase in acted.sentence
        ]
        names = [(act.verb, act.side) for phrase in acted.sentence for act in phrase.acts]
        if None in sum(phrases, []) or len(set(names)) < len(names):
            continue
        for before, after in zip(phrases, phrases[1:], strict=False):
            tried += len(before) * len(after)
            wrong += sum(a > b for a in before for b in after)
    assert tried > 40 and wrong <= 0.03 * tried


@pytest.mark.parametrize("verb", ["squat", "jump", "kick", "bow", "raise", "punch", "clap"])
@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_what_is_counted_is_counted(verb, count):
    side = {"side": "right"} if verb in ("kick", "raise", "punch") else {}
    (one,) = actions(performed(verb, 10.0, count=count, **side))
    assert (one.verb, one.count, one.side) == (verb, count, side.get("side", ""))


def test_left_becomes_right_in_a_mirror():
    swap = {"left": "right", "right": "left"}
    for clip in clips(25, 92, "test"):
        found = [of(one) for one in actions(clip.acted.positions)]
        turned = [of(one) for one in actions(mirror(clip).acted.positions)]
        assert Counter((v, swap.get(s, s), *r) for v, s, *r in found) == Counter(
            (v, s, *r) for v, s, *r in turned
        )


def test_where_the_figure_stands_and_faces_does_not_matter():
    for clip in clips(15, 93, "test"):
        positions = clip.acted.positions
        turn = np.array([[0.6, 0.0, 0.8], [0.0, 1.0, 0.0], [-0.8, 0.0, 0.6]])
        moved = positions @ turn.T + [3.0, 0.1, -7.0]
        assert [of(one) for one in actions(moved)] == [of(one) for one in actions(positions)]


def test_half_as_many_frames_a_second_more_show_the_same_actions():
    """At 30 frames a second, instead of 20."""
    same = 0
    for clip in clips(20, 94, "test"):
        positions = clip.acted.positions
        at, now = np.arange(len(positions)) / 20, np.arange(0, (len(positions) - 1) / 20, 1 / 30)
        flat = positions.reshape(len(positions), -1)
        faster = np.stack([np.interp(now, at, column) for column in flat.T], -1)
        found = actions(faster.reshape(len(now), 21, 3), 30.0)
        same += Counter(map(of, found)) == Counter(map(of, actions(positions)))
    assert same >= 18


def nothing(kind: str, rng: np.random.Generator) -> np.ndarray:
    still = np.repeat(rest_pose()[None] if rest_pose().ndim == 2 else rest_pose(), 120, 0)
    stands = performed("stand", 6.0, int(rng.integers(1000)))
    if kind == "noise":
        return stands.mean() + 0.4 * rng.standard_normal(stands.shape)
    if kind == "shaken":
        return still + 0.02 * rng.standard_normal(still.shape)
    if kind == "the mean pose":
        return np.repeat(performed("walk").mean(0, keepdims=True), 120, 0)
    if kind == "noise over time":
        return stands + np.cumsum(0.02 * rng.standard_normal(stands.shape), 0)
    return {"rest": still, "standing": stands}[kind]


@pytest.mark.parametrize(
    "kind", ["noise", "shaken", "the mean pose", "noise over time", "rest", "standing"]
)
def test_what_is_no_action_is_none(kind):
    rng = np.random.default_rng(5)
    found = [actions(nothing(kind, rng)) for _ in range(20)]
    assert sum(one == [] for one in found) >= 19, found


def test_too_short_or_not_finite_is_none():
    kicks = performed("kick", side="left", count=2)
    assert actions(kicks) and actions(kicks[:15]) == []
    broken = kicks.copy()
    broken[40, 3] = np.nan
    assert actions(broken) == []
    assert has_a_body(kicks) and not has_a_body(1.5 * kicks)
