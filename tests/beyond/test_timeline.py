"""The timeline of a motion: its columns by hand, its mirror, and that of generated clips."""

import numpy as np
import pytest
import torch

from data_synth.actions import clips, mirror
from data_synth.actions.acts import VERBS as ACTS
from motiondiff_edu.beyond.timeline import (
    ARMS,
    LEGS,
    MIDDLE,
    SHORTEST,
    SIDE,
    TO_COME,
    VERBS,
    WITH_TIMES,
    D,
    Timed,
    acts_of,
    mirrored,
    of_the_legs,
    tidied,
    timeline,
)
from motiondiff_edu.metrics import texts
from motiondiff_edu.motion.root_frame import FPS
from motiondiff_edu.recipes.mover import timeline_of


def test_its_verbs_are_those_of_the_sentences():
    assert set(VERBS) == set(ACTS) and len(VERBS) == len(set(VERBS))
    assert {verb for verb in ACTS if ACTS[verb].kind == "arms"} == set(ARMS)
    last_on = {verb for verb in ACTS if ACTS[verb].kind == "way"} | {"sit"}
    assert last_on == set(LEGS) - set(WITH_TIMES)
    assert texts.COUNTED <= set(WITH_TIMES)


def test_two_acts_of_the_legs_and_one_of_the_arms_by_hand():
    acts = [
        Timed("kick", "left", 2, 0.1, 0.3),
        Timed("bow", "", 1, 0.4, 0.5),
        Timed("punch", "right", 3, 0.15, 0.3),
    ]
    made = timeline(acts[::-1], 12)
    kick, bow, punch = (VERBS.index(verb) for verb in ("kick", "bow", "punch"))
    assert np.flatnonzero(made[:, kick]).tolist() == [2, 3, 4, 5]
    assert np.flatnonzero(made[:, bow]).tolist() == [8, 9]
    assert np.flatnonzero(made[:, punch]).tolist() == [3, 4, 5]
    assert made[:, SIDE].tolist() == [0, 0, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0]
    assert made[:, SIDE + 1].tolist() == [0, 0, 0, -1, -1, -1, 0, 0, 0, 0, 0, 0]
    legs = [2, 2, 2, 2, 1, 1, 1, 1, 1, 1, 0, 0]  # two kicks; then the bow is the next
    assert made[:, TO_COME].tolist() == legs
    assert made[:, TO_COME + 1].tolist() == [3, 3, 3, 3, 2, 1] + [0] * 6
    legs = [0, 0, 0, 1, 0, 1, 0, 0, 0, 1, 0, 0]
    np.testing.assert_allclose(made[:, MIDDLE], legs, atol=1e-9)
    np.testing.assert_allclose(made[:, MIDDLE + 1], 0, atol=1e-9)  # a frame long, they begin at 0
    others = [k for k in range(D) if k not in (kick, bow, punch, *range(SIDE, D))]
    assert not made[:, others].any()


def test_a_walk_is_not_counted():
    made = timeline([Timed("walk", "", 1, 0.0, 1.0)], 20)
    assert (made[:, VERBS.index("walk")] == 1).all() and made.sum() == 20


def test_who_sits_down_sits_until_he_gets_up():
    sit = VERBS.index("sit")
    sits, rises = Timed("sit", "", 1, 0.5, 1.5), Timed("rise", "", 1, 3.0, 4.0)
    made = timeline([sits, rises], 120)
    assert np.flatnonzero(made[:, sit]).tolist() == list(range(10, 60))
    assert np.flatnonzero(timeline([sits], 120)[:, sit]).tolist() == list(range(10, 120))
    assert np.flatnonzero(timeline([rises], 120)[:, sit]).tolist() == list(range(60))
    again = timeline([rises, Timed("sit", "", 1, 4.5, 5.5)], 120)
    assert np.flatnonzero(again[:, sit]).tolist() == [*range(60), *range(90, 120)]


def test_a_verb_that_there_is_not_is_refused():
    with pytest.raises(ValueError, match="no verb is called 'fly'; there are walk, run"):
        timeline([Timed("fly", "", 1, 0.0, 1.0)], 20)


@pytest.mark.parametrize("k", range(8))
def test_the_mirrored_clip_has_the_mirrored_timeline(k):
    (*_, one) = clips(k + 1, 5)
    made = timeline_of(one.acted.spans, len(one.acted))
    turned = mirrored(torch.from_numpy(made)).numpy()
    other = mirror(one).acted
    np.testing.assert_array_equal(timeline_of(other.spans, len(other)), turned)
    assert made.shape == (len(one.acted), D)
    counts = [a.count for p in one.acted.sentence for a in p.acts if a.verb in WITH_TIMES]
    assert made[:, TO_COME:MIDDLE].max() == max(counts, default=0)
    assert made[-1, TO_COME:MIDDLE].max() <= 1  # all is done at the end


def test_no_timeline_stays_none():
    assert mirrored(torch.zeros(3, 4, 0)).shape == (3, 4, 0)


def test_each_column_is_that_of_the_legs_or_of_the_arms():
    kick, clap = (timeline([Timed(v, "left", 2, 0.0, 1.0)], 20) for v in ("kick", "clap"))
    legs = of_the_legs().numpy()
    assert not kick[:, ~legs].any() and not clap[:, legs].any()
    assert (kick.any(0) | clap.any(0)).sum() == 2 * 4


@pytest.mark.parametrize("k", range(12))
def test_the_acts_of_a_timeline_are_those_that_it_was_made_of(k):
    (*_, one) = clips(k + 1, 9)
    made = timeline_of(one.acted.spans, len(one.acted))
    long = [s for s in one.acted.spans if s.last - s.first > SHORTEST / FPS]
    assert all(s.act.verb == "stand" for s in one.acted.spans if s not in long)
    asked = [(s.act.verb, s.act.side.replace("both", ""), s.act.count) for s in long]
    seats = [s for s in long if s.act.verb in ("sit", "rise")]
    if seats and seats[0].act.verb == "rise" and seats[0].first > SHORTEST / FPS:
        asked.append(("sit", "", 1))  # from the beginning
    found = [(act.verb, act.side, act.count) for act in acts_of(made)]
    assert sorted(found) == sorted(asked)
    again = timeline(acts_of(made), len(made))
    assert np.abs(again - made)[:, :MIDDLE].mean() < 0.02  # edges move by a frame at most
    assert np.abs(again - made)[:, MIDDLE:].max() < 0.5
    np.testing.assert_array_equal(timeline(acts_of(again), len(made)), again)


def test_acts_of_one_verb_that_touch_are_told_apart():
    acts = [Timed("kick", "left", 2, 0.5, 2.5), Timed("kick", "right", 3, 2.5, 5.5)]
    assert acts_of(timeline(acts, 120)) == acts
    acts = [Timed("clap", "", 2, 0.5, 2.0), Timed("clap", "", 2, 2.0, 3.5)]
    assert acts_of(timeline(acts, 120)) == acts


def test_a_blurred_timeline_is_tidied():
    clean = timeline([Timed("kick", "right", 3, 1.0, 4.0)], 120)
    rng = np.random.default_rng(0)
    noisy = clean + 0.15 * rng.standard_normal(clean.shape)
    noisy[40:42, VERBS.index("kick")] = 0  # a short pause is none
    noisy[100:104, VERBS.index("clap")] = 1  # and a short act is none
    (act,) = acts_of(noisy)
    assert (act.verb, act.side, act.count) == ("kick", "right", 3)
    assert abs(act.first - 1) < 0.11 and abs(act.last - 4) < 0.11
    batch = torch.from_numpy(np.stack([noisy, clean])).float()
    assert tidied(batch).shape == batch.shape
    torch.testing.assert_close(tidied(batch)[1].double(), torch.from_numpy(clean))
