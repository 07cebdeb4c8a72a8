"""Synthetic actions: joins, truth, captions, splits; same seed, same bytes."""

import json
import re
from collections import Counter
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
import torch

from data_synth.actions import VERBS, Act, Phrase, act_out, clips, mirror
from data_synth.actions.acceptance import joins, measures, stands_between, worst
from data_synth.actions.captions import (
    TIMES,
    WORDINGS,
    caption,
    exchanged,
    vocabulary,
    worded_by,
    words_of,
)
from data_synth.actions.dataset import SPLITS, mirrored_sentence, worded
from data_synth.actions.join import crossfade
from data_synth.actions.neighbours import neighbour
from data_synth.actions.performance import JOIN
from data_synth.actions.sentences import (
    SIDES,
    all_pairs,
    draw,
    fitted,
    held_out,
    in_training,
    pairs,
)
from data_synth.actions.write import main as write
from motiondiff_edu.motion.formats.bvh import read_bvh
from motiondiff_edu.motion.skeleton import BONE_LENGTHS, BONES, MIRROR, joint_index

TOLD_APART = ("hand", "arm", "leg", "foot", "greet", "swing", "giv")  # wordings of waves and kicks
LEFT_HAND, RIGHT_HAND = joint_index("LeftHand"), joint_index("RightHand")
LEFT_TOE, RIGHT_TOE = joint_index("LeftToeBase"), joint_index("RightToeBase")
HEAD, HIPS = joint_index("Head"), 0


@pytest.fixture(scope="module")
def made():
    return list(clips(40, seed=2))


def alone(verb: str, seconds: float = 8.0, seed: int = 3, **said):
    act = Act(verb, **said)
    arms = VERBS[verb].kind == "arms"
    return act_out((Phrase(None, act) if arms else Phrase(act),), seconds, seed)


def span_of(acted, verb: str):
    return next(span for span in acted.spans if span.act.verb == verb)


def within(acted, verb: str) -> np.ndarray:
    span = span_of(acted, verb)
    return acted.positions[round(span.first * acted.fps) : round(span.last * acted.fps) + 1]


def peaks(curve: np.ndarray, least: float) -> int:
    """How often a curve rises above `least`."""
    above = curve > least
    return int((above[1:] & ~above[:-1]).sum() + above[0])


def test_every_ordered_pair_of_leg_acts_joins():
    pairs_made = joins(seed=1)
    legs = {name for name, verb in VERBS.items() if verb.kind != "arms"}
    cannot = {(name, "rise") for name in legs - {"sit"}} | {("sit", "sit")}
    assert pairs_made.keys() == set(product(legs, legs)) - cannot
    found = worst([measures(one) for one in pairs_made.values()])
    assert found["slip_mm"] < 1.0 and found["lowest_mm"] > -5.0 and found["bone_m"] < 1e-9
    assert 10 < found["knee_smallest"] and found["knee_largest"] < 140
    assert found["fastest_mps"] < 10 and found["jolt_mps2"] < 150
    assert max(stands_between(one) for one in pairs_made.values()) <= 0.5
    for (a, b), acted in pairs_made.items():  # both acts are there, in their order, to their ends
        first, second = [s for s in acted.spans if s.act.verb in (a, b)][-2:]
        assert (first.act.verb, second.act.verb) == (a, b)
        assert first.last <= second.first + 1e-9 and second.last <= 10.0


def test_clips_hold(made):
    found = worst([measures(clip.acted) for clip in made])
    assert found["slip_mm"] < 1.0 and found["lowest_mm"] > -5.0 and found["bone_m"] < 1e-9
    assert found["fastest_mps"] < 10 and found["jolt_mps2"] < 150
    for clip in made:
        assert len(clip.acted.contacts) == len(clip.acted) == len(clip.acted.positions)
        verbs = Counter(act.verb for phrase in clip.acted.sentence for act in phrase.acts)
        shown = Counter(span.act.verb for span in clip.acted.spans)
        assert all(shown[verb] >= times for verb, times in verbs.items())


def test_same_seed_same_bytes_and_other_seeds_are_other_right_answers():
    sentence = (Phrase(Act("walk"), Act("wave", "left")), Phrase(Act("kick", "right", 2)))
    one, same, other = (act_out(sentence, 9.0, seed) for seed in (4, 4, 5))
    assert one.positions.tobytes() == same.positions.tobytes() and one.spans == same.spans
    assert np.abs(one.positions - other.positions).max() > 0.1


@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_what_is_counted_happens_so_often(count):
    squat, jump = alone("squat", count=count), alone("jump", count=count)
    assert peaks(-squat.positions[:, HIPS, 1], -0.75) == count
    assert peaks(jump.positions[:, [LEFT_TOE, RIGHT_TOE], 1].min(1), 0.05) == count
    bow = alone("bow", count=count, seconds=9.5)
    ahead = bow.positions[:, HEAD] - bow.positions[:, HIPS]
    assert peaks(-ahead[:, 1], -0.45) == count
    for side, toe, hand in (("left", LEFT_TOE, LEFT_HAND), ("right", RIGHT_TOE, RIGHT_HAND)):
        kick = alone("kick", side=side, count=count, seconds=9.0)
        assert peaks(kick.positions[:, toe, 1], 0.3) == count
        raised = alone("raise", side=side, count=count, seconds=9.0)
        assert peaks(raised.positions[:, hand, 1], 1.6) == count
        punch = within(alone("punch", side=side, count=count), "punch")
        reach = np.linalg.norm(punch[:, hand] - punch[:, 11], axis=-1)
        assert peaks(reach, 0.555) == count
    clap = within(alone("clap", count=count), "clap")
    apart = np.linalg.norm(clap[:, LEFT_HAND] - clap[:, RIGHT_HAND], axis=-1)
    assert peaks(-apart, -0.25) == count


def test_sides_and_directions():
    for sign, side in ((1, "left"), (-1, "right")):
        aside = alone("aside", side=side).positions[:, HIPS, 0]
        assert sign * (aside[-1] - aside[0]) > 1.0
        for direction, angle in (("", 90), ("around", 180)):
            turned = alone("turn", side=side, direction=direction, seconds=5.0).positions
            across = turned[:, 1] - turned[:, 5]
            heading = np.unwrap(np.arctan2(-across[:, 2], across[:, 0]))
            assert np.degrees(sign * (heading[-1] - heading[0])) == pytest.approx(angle, abs=20)
        hand, other = (LEFT_HAND, RIGHT_HAND) if sign > 0 else (RIGHT_HAND, LEFT_HAND)
        waved = alone("wave", side=side).positions
        assert np.median(waved[:, hand, 1]) > 1.4 and waved[:, other, 1].max() < 1.2
        shown = alone("point", side=side, direction="aside").positions
        assert np.median(sign * (shown[:, hand, 0] - shown[:, HEAD, 0])) > 0.5
        shown = alone("point", side=side, direction="forward").positions
        assert np.median(shown[:, hand, 2] - shown[:, HEAD, 2]) > 0.4
    for verb, least, most in (("walk", 0.7, 1.8), ("run", 2.0, 3.4), ("back", -0.7, -0.2)):
        moved = alone(verb).positions[:, HIPS, 2]
        assert least < (moved[-1] - moved[0]) / 8.0 < most
    forward = alone("jump", direction="forward", count=3).positions[:, HIPS, 2]
    assert forward[-1] - forward[0] > 0.6
    sits, rises = (alone(verb).positions[:, HIPS, 1] for verb in ("sit", "rise"))
    assert sits[0] > 0.9 and 0.5 < sits[-1] < 0.68 and (sits < 0.7).mean() * 8.0 > 0.8
    assert 0.5 < rises[0] < 0.68 and rises[-1] > 0.9
    held = within(alone("hold", side="both"), "hold")[20:-20, [LEFT_HAND, RIGHT_HAND], 1]
    assert held.min() > 1.6


def test_speeds_are_in_their_order():
    def walked(speed):
        way = alone("walk", speed=speed, seed=6).positions[:, HIPS, 2]
        return way[-1] - way[0]

    assert walked("slowly") < 0.8 * walked("") and 1.2 * walked("") < walked("quickly")
    for verb in ("squat", "kick", "punch", "clap"):
        side = "left" if "left" in VERBS[verb].sides else ""
        lasts = [
            np.mean([_lasts(alone(verb, side=side, speed=speed, seed=k)) for k in range(4)])
            for speed in ("quickly", "", "slowly")
        ]
        assert lasts[0] < 0.85 * lasts[1] < 0.85 * 0.85 * lasts[2]


def _lasts(acted) -> float:
    span = acted.spans[-1]
    return span.last - span.first


@pytest.fixture(scope="module")
def drawn():
    """Sentences and their seconds."""
    rng = np.random.default_rng(1)
    return [draw(rng) for _ in range(12_500)]


def test_the_count_cannot_be_read_from_the_length(drawn):
    rows = []
    for sentence, seconds in drawn[:6000]:
        for phrase in sentence:
            rows += [(a.verb, a.count, seconds) for a in phrase.acts if VERBS[a.verb].most > 1]
    counts = np.array([row[1] for row in rows])
    lengths = np.array([row[2] for row in rows])
    constant = Counter(counts).most_common(1)[0][1] / len(counts)
    near = np.digitize(lengths, np.arange(2.5, 10, 0.5))
    best = sum(Counter(counts[near == k]).most_common(1)[0][1] for k in set(near)) / len(counts)
    assert constant < 0.46 and best < constant + 0.01
    assert abs(np.corrcoef(counts, lengths)[0, 1]) < 0.07
    means = [lengths[counts == count].mean() for count in (1, 2, 3, 4)]
    assert max(means) - min(means) < 0.7


def test_two_acts_on_the_spot_come_in_a_row_in_clips_of_every_length(drawn):
    lengths = [
        seconds
        for sentence, seconds in drawn
        if [(p.legs.verb if p.legs else "") for p in sentence] == ["kick", "bow"]
    ]
    assert len(lengths) > 5 and min(lengths) < 7 < 9 < max(lengths)
    form = (Phrase(Act("kick", "left", 4)), Phrase(Act("bow", count=4)))
    counts = [[p.legs.count for p in one] for one in fitted(form, 10.0)]
    assert counts == [[1, 1], [2, 2]] and fitted(form, 3.0) == []


def test_captions_are_many_and_have_several_wordings(drawn):
    rng = np.random.default_rng(1)
    bare, texts = set(), set()
    for sentence, _ in drawn:
        acts = [replace(act, speed="") for phrase in sentence for act in phrase.acts]
        bare.add(tuple(sorted(map(str, acts))))
        texts.add(caption(sentence, rng))
    assert len(bare) >= 3000 and len(texts) > 10_000
    assert len({words for text in texts for words in words_of(text)} - vocabulary()) == 0
    four = worded((Phrase(Act("squat", count=3)),), rng)
    assert len(set(four)) == 4 and all(any(t in text for t in TIMES[3]) for text in four)


def test_held_out_wordings_occur_nowhere_else(made):
    new = {w for w in vocabulary(held_out=True)} - vocabulary()
    last = {choices[-1].third for choices in WORDINGS.values()}
    assert {word for verb in last for word in words_of(verb)} <= new | {"leans", "stretches"}
    assert not new & {word for clip in made for text in clip.captions for word in words_of(text)}
    rng = np.random.default_rng(2)
    for (verb, direction), choices in WORDINGS.items():
        side = "left" if "left" in VERBS[verb].sides else ""
        act = Act(verb, side, direction=direction)
        phrase = Phrase(None, act) if VERBS[verb].kind == "arms" else Phrase(act)
        assert choices[-1].third in caption((phrase,), rng, held_out=True)
        assert len({caption((phrase,), rng) for _ in range(60)}) >= 4


def test_mirroring_exchanges_motion_truth_and_words(made):
    clip = next(c for c in made if any("left" in t for t in c.captions))
    turned = mirror(clip)
    back = mirror(turned)
    np.testing.assert_allclose(back.acted.positions, clip.acted.positions)
    assert torch.from_numpy(turned.acted.contacts).shape == (len(clip.acted), 2)
    assert back.captions == clip.captions and back.acted.spans == clip.acted.spans
    assert turned.captions == tuple(map(exchanged, clip.captions))
    assert exchanged("the left hand, leftover") == "the right hand, leftover"
    x = clip.acted.positions[:, MIRROR, 0]
    np.testing.assert_allclose(turned.acted.positions[..., 0], -x)
    sides = [s.act.side for s in clip.acted.spans]
    swap = {"left": "right", "right": "left"}
    assert [s.act.side for s in turned.acted.spans] == [swap.get(side, side) for side in sides]


def test_held_out_pairs_are_enough_and_every_word_is_trained(drawn):
    out, every = held_out(), all_pairs()
    for kinds in (("speed",), ("direction",), ("while",), ("then",), SIDES):
        own = [pair for pair in every if pair[0] in kinds]
        assert sum(pair in out for pair in own) >= 0.15 * len(own)
    sides = [pair[1:] for pair in out if pair[0] in SIDES]
    assert len(sides) == len(set(sides)), "of two acts, nothing would teach the sides"
    seen = Counter()
    for sentence, _ in drawn[:4000]:
        if in_training(sentence):
            seen.update(word for pair in pairs(sentence) for word in pair[1:])
            seen.update(act.side for phrase in sentence for act in phrase.acts)
            seen.update(act.verb for phrase in sentence for act in phrase.acts)
    assert set(VERBS) | {"left", "right", "slowly", "quickly", "forward", "around"} <= set(seen)


def test_nothing_that_is_held_out_comes_into_a_training_by_the_mirror_or_a_neighbour(drawn):
    """The sentence of every clip, that of its mirrored twin, and the wrong one that judges get."""
    rng = np.random.default_rng(4)
    kept = [s for s, _ in drawn[:3000] if in_training(s)]
    assert len(kept) > 1500
    for sentence in kept:
        assert pairs(mirrored_sentence(sentence)) == pairs(sentence)
        other = neighbour(sentence, rng)
        assert other is None or in_training(other)
    crossed = (Phrase(Act("kick", "left"), None), Phrase(None, Act("wave", "right")))
    assert ("other side", "kick", "wave") in pairs(crossed) and len(pairs(crossed)) == 2


def test_captions_with_one_number_differ_where_the_sentences_do():
    first = (Phrase(Act("walk"), Act("wave", "left")), Phrase(Act("kick", "right", 2)))
    second = (first[0], Phrase(Act("kick", "right", 3)))
    rng = np.random.default_rng(5)
    for number in range(40):
        one, other = (worded_by(sentence, number) for sentence in (first, second))
        assert min(one.count(time) for time in TIMES[3]) == 0
        for two, three in product(TIMES[2], TIMES[3]):
            one, other = one.replace(two, "so often"), other.replace(three, "so often")
        assert one == other
        there, back = (
            {word for word in TOLD_APART if word in text}
            for text in (worded_by(first, number), worded_by(first[::-1], number))
        )
        assert there == back
    assert len({caption(first, rng) for _ in range(100)}) > 90
    sat = {worded_by((Phrase(Act("sit"), Act("clap")),), number) for number in range(200)}
    assert not any(re.search(r"sitting .* and (gets|stands)", text) for text in sat)


def test_splits_share_no_clip_and_keep_their_pairs():
    drawn = {split: list(clips(6, 0, split)) for split in SPLITS}
    for split, some in drawn.items():
        assert all(in_training(c.acted.sentence) == (split != "combinations") for c in some)
    first = {c.acted.positions[:20].tobytes() for some in drawn.values() for c in some}
    assert len(first) == 6 * len(SPLITS)
    with pytest.raises(ValueError, match="no split is called 'dev'"):
        next(clips(1, 0, "dev"))


@pytest.mark.parametrize(
    "make, words",
    [
        (lambda: Act("fly"), "no such act is called 'fly'"),
        (lambda: Act("wave", "left"), "no such act is called 'wave'"),
        (lambda: Act("kick"), "side of 'kick' is ''"),
        (lambda: Act("walk", direction="up"), "direction of 'walk'"),
        (lambda: Act("squat", count=5), "1 to 4 times, not 5"),
        (lambda: Act("stand", speed="slowly"), "speed of 'stand'"),
    ],
)
def test_acts_that_cannot_be_done_are_refused(make, words):
    with pytest.raises(ValueError, match=words):
        Phrase(make())


def test_sentences_that_do_not_fit_are_refused():
    with pytest.raises(ValueError, match="needs a phrase"):
        act_out((), 5.0, 0)
    with pytest.raises(ValueError, match="an act of the legs or of the arms"):
        Phrase()
    with pytest.raises(ValueError, match=r"the sentence needs .* s, and the clip has 3 s"):
        act_out((Phrase(Act("squat", count=4)),), 3.0, 0)


def test_a_crossfade_begins_and_ends_as_its_motions_do_and_keeps_bones():
    a = alone("stand").positions[:9]
    b = a + np.array([0.0, 0.0, 0.0])
    b[:, 9:] = alone("stand", seed=8).positions[20:29, 9:]
    b[:, 9:] += b[:, :1] - alone("stand", seed=8).positions[20:29, :1]
    share = np.linspace(0, 1, 9)
    mixed = crossfade(a, b, share)
    np.testing.assert_allclose(mixed[0], a[0], atol=1e-9)
    np.testing.assert_allclose(mixed[-1], b[-1], atol=1e-9)
    bones = mixed[:, [c for _, c in BONES]] - mixed[:, [p for p, _ in BONES]]
    assert np.abs(np.linalg.norm(bones, axis=-1) - BONE_LENGTHS).max() < 1e-9
    with pytest.raises(ValueError, match="does not reach its foot"):
        crossfade(a + [2.0, 0, 0], a, share)
    high = crossfade(a + [0, 0.2, 0], a, share)  # hips too far from the feet come down
    assert high[0, 0, 1] < a[0, 0, 1] + 0.1
    assert JOIN * 20 == 8


def test_files_have_motion_truth_and_words(tmp_path, capsys):
    write(["--out", str(tmp_path), "--clips", "2", "--seed", "5"])
    assert "2 clips" in capsys.readouterr().out
    clip = next(clips(1, 5))
    kept = np.load(tmp_path / "action_000.npz", allow_pickle=False)
    np.testing.assert_allclose(kept["positions"], clip.acted.positions, atol=1e-5)
    assert [json.loads(text)["verb"] for text in kept["acts"]] == [
        span.act.verb for span in clip.acted.spans
    ]
    lines = (tmp_path / "action_001.txt").read_text(encoding="utf-8").splitlines()
    assert len(lines) == 4 and tuple(kept["captions"]) == clip.captions
    assert len(read_bvh(tmp_path / "action_000.bvh").frames) == len(clip.acted)
    with pytest.raises(SystemExit):
        write(["--out", str(tmp_path), "--clips", "0"])
