"""The grammar of sentences: captions of the data, with verbs held out, and free ones."""

from dataclasses import replace

import numpy as np
import pytest

from data_synth.actions.acts import VERBS, seated
from data_synth.actions.captions import WORDINGS, caption, vocabulary, words_of
from data_synth.actions.sentences import draw
from motiondiff_edu.conditions.acts import KINDS, PLAIN, Act, in_words, scheduled, seconds_of
from motiondiff_edu.conditions.sentences import understand, unused


def acts_of(text: str) -> list[list[tuple]]:
    """Verb, side, count, speed and direction of each act, without what says nothing."""
    return [
        [
            tuple(x for x in (a.verb, a.side, a.count, a.speed, a.direction) if x not in ("", 0))
            for a in part
        ]
        for part in understand(text).parts
    ]


def counted(parts):
    """The same acts, each of which happens once where no count is given."""
    return tuple(tuple(replace(a, count=max(1, a.count)) for a in part) for part in parts)


def test_its_verbs_and_what_can_be_said_of_them_are_those_of_the_data():
    assert KINDS.keys() == VERBS.keys()
    for name, kind in KINDS.items():
        own = VERBS[name]
        assert (kind.part, kind.most) == (own.kind, own.most)
        assert {*kind.sides} | {*kind.speeds} | {*kind.directions} == (
            {*own.sides} | {*own.speeds} | {*own.directions}
        ) - {""}
    for (verb, direction), (third, gerund) in PLAIN.items():
        said = [(one.third, one.gerund) for one in WORDINGS[verb, direction][:-1]]
        assert (third.split()[0], gerund.split()[0]) in said
        assert {
            word for word in words_of(third) if word not in ("side", "hand", "limb")
        } <= vocabulary()


@pytest.mark.parametrize("held_out", [False, True])
def test_captions_of_the_data_are_understood_as_they_were_meant(held_out):
    rng = np.random.default_rng(3)
    for _ in range(400):
        sentence, _ = draw(rng)
        text = caption(sentence, rng, held_out)
        wanted = tuple(
            tuple(Act(a.verb, a.side, a.count, a.speed, a.direction) for a in phrase.acts)
            for phrase in sentence
        )
        found = understand(text)
        told = counted(found.parts)
        assert told == wanted, text
        assert found.notes == (), text
        assert counted(understand(in_words(told)).parts) == wanted  # what the network is told


@pytest.mark.parametrize(
    "text, wanted",
    [
        ("squats with both arms raised", [[("squat",), ("hold", "both")]]),
        ("She waves her left hand, and then kicks.", [[("wave", "left")], [("kick", "right")]]),
        ("walks backwards and waves with both hands", [[("back",), ("wave", "both")]]),
        ("sits down, then gets back on their feet", [[("sit",)], [("rise",)]]),
        ("shuffles sideways to the left", [[("aside", "left")]]),
        ("two right jabs followed by a left kick", [[("punch", "right", 2)], [("kick", "left")]]),
        ("before he bows, he claps 3 times", [[("clap", 3)], [("bow",)]]),
        ("claps 3 times before he bows", [[("clap", 3)], [("bow",)]]),
        ("Jump, but first wave.", [[("wave", "right")], [("jump",)]]),
        ("he bows; before that he claps", [[("clap",)], [("bow",)]]),
        ("once she's done clapping, she bows", [[("clap",)], [("bow",)]]),
        ("clap clap clap", [[("clap", 3)]]),
        ("turns left and claps", [[("turn", "left")], [("clap",)]]),
        ("walks forward, clapping", [[("walk",), ("clap",)]]),
        ("while walking the man claps", [[("walk",), ("clap",)]]),
        ("show me a person bowing", [[("bow",)]]),
        ("greets us with a wave", [[("wave", "right")]]),
        ("several quick kicks", [[("kick", "right", 3, "quickly")]]),
        ("does squats", [[("squat", 2)]]),
        ("rapid punches with the left hand", [[("punch", "left", 2, "quickly")]]),
        ("jumping up and down", [[("jump", 3)]]),
        ("throws a flurry of punches", [[("punch", "right", 3)]]),
        ("throws quick left punches", [[("punch", "left", 2, "quickly")]]),
        ("walks, then breaks into a run", [[("walk",)], [("run",)]]),
        ("kicks with the left foot, then with the other foot",
         [[("kick", "left")], [("kick", "right")]]),
        ("turns around and walks back", [[("turn", "right", "around")], [("walk",)]]),
        ("jumps and claps together", [[("jump",), ("clap",)]]),
        ("an old woman gets up, then keeps walking", [[("rise",)], [("walk",)]]),
        ("bows after clapping twice", [[("clap", 2)], [("bow",)]]),
        ("while walking, he applauds", [[("walk",), ("clap",)]]),
        ("gets up from the chair and strolls along", [[("rise",)], [("walk",)]]),
        ("HOPS ON THE SPOT 2x!", [[("jump", 2)]]),
        ("squatting and clapping", [[("squat",)], [("clap",)]]),
        ("squats clapping", [[("squat",), ("clap",)]]),
        ("keeps an arm in the air while running fast", [[("run", "quickly"), ("hold", "right")]]),
        ("spins around", [[("turn", "right", "around")]]),
        ("walks forward and then back", [[("walk",)], [("back",)]]),
        ("can't stop clapping", [[("clap",)]]),
        ("she stops waving", [[("stand",)]]),
        ("waves without moving", [[("wave", "right")]]),
        ("keeps jumping", [[("jump", 2)]]),
        ("kick with both legs three times", [[("kick", "left", 2)], [("kick", "right", 1)]]),
        ("punches forward with both hands", [[("punch", "left")], [("punch", "right")]]),
        ("kicks with the left leg, then with the right", [[("kick", "left")], [("kick", "right")]]),
        ("punches left, right, left", [[("punch", one)] for one in ("left", "right", "left")]),
        ("jab, jab with the left", [[("punch", "left", 2)]]),
        ("kicks with one leg, then the other", [[("kick", "right")], [("kick", "left")]]),
        ("jumps, then does it again", [[("jump", 2)]]),
        ("kicks left and repeats with the right", [[("kick", "left")], [("kick", "right")]]),
        ("bows once, and then twice more", [[("bow", 3)]]),
        ("walks fast, then slowly", [[("walk", "quickly")], [("walk", "slowly")]]),
        ("squats and comes back up", [[("squat",)]]),
        ("starts seated and gets up", [[("rise",)]]),
        ("sits, then claps while sitting", [[("sit",)], [("clap",)]]),
        ("walks forward, clapping as he goes", [[("walk",), ("clap",)]]),
        ("walking backward, she waves", [[("back",), ("wave", "right")]]),
        ("simultaneously: walk, wave R hand", [[("walk",), ("wave", "right")]]),
        ("walks and claps at the same time", [[("walk",), ("clap",)]]),
        ("before he sits down he bows", [[("bow",)], [("sit",)]]),
        ("raises an arm once he has got up", [[("rise",)], [("raise", "right")]]),
        ("rotate 180 degrees, then walk", [[("turn", "right", "around")], [("walk",)]]),
        ("turns around with hands up, then bows",
         [[("turn", "right", "around"), ("hold", "both")], [("bow",)]]),
        ("right arm up, right arm down, left arm up", [[("hold", "right")], [("hold", "left")]]),
        ("points forward with the left, then to the side with the right",
         [[("point", "left", "forward")], [("point", "right", "aside")]]),
        ("reach for the sky", [[("raise", "both")]]),
        ("left-footed kick", [[("kick", "left")]]),
        ("move rightwards without turning", [[("aside", "right")]]),
        ("don't move", [[("stand",)]]),
        ("she's going to sit", [[("sit",)]]),
        ("strolls by, in no hurry at all", [[("walk", "slowly")]]),
        ("spins counterclockwise", [[("turn", "left", "around")]]),
        ("lowers himself into a chair", [[("sit",)]]),
        ("bows in greeting", [[("bow",)]]),
    ],
)  # fmt: skip
def test_what_people_write(text, wanted):
    assert acts_of(text) == wanted
    assert understand(text).notes == ()


@pytest.mark.parametrize(
    "text, named",
    [
        ("juggles and walks", "'juggles'"),
        ("walks in a circle", "'circle'"),
        ("jumps five times", "'jump' is done 4 times at most, not 5 times"),
        ("jmups twice", "'jmups' is read as 'jumps'"),
        ("walks to the left", "'walk' has no side: 'left' is left out"),
        ("scratches his head, then bows", "'scratches', 'head'"),
        ("kicks a ball", "'ball'"),
        ("walks and picks up the box", "'picks', 'box'"),
        ("waves with both feet", "'waves' is done with the hands: the feet are left out"),
        ("faces the camera, then bows", "left out: 'faces'"),
        ("walks four steps", "'walk' is not counted: 4"),
        ("kicks with the rihgt leg", "'rihgt' is read as 'right'"),
        ("squats with his arms in front", "the arms of 'squat'"),
        ("jumps to the side", "'jumps' has no way to the side"),
        ("raises both arms forward", "'raises' has no way forward"),
        ("claps overhead", "'claps' has no way up"),
        ("jogs in place", "'jogs' has no way to stay on the spot"),
        ("hops on one leg", "'on one leg'"),
        ("runs back and forth", "'back and forth'"),
        ("does a roundhouse kick", "'roundhouse'"),
        ("walks for five seconds", "how long an act takes is left out"),
        ("walks and doesn't wave", "'not done'"),
        ("instead of walking, he runs", "'not done'"),
        ("walks backwards and forwards", "no way forward"),
        ("points left with the right arm", "the right arm has no way to point to the left"),
        ("waves while clapping", "'wave' and 'clap' are done one after the other"),
        ("roundhouse kick", "'roundhouse'"),
        ("steps left, right, left with hands on hips", "'left'"),
        ("bows, says hello and sings", "'sings'"),
        ("stands there, then throws hands", "not understood: 'throws hands'"),
        ("bows, i mean, claps", "'i mean'"),
    ],
)
def test_what_is_not_understood_is_named(text, named):
    found = understand(text)
    assert found.parts or "juggles" in text
    assert named in " ".join(found.notes)


@pytest.mark.parametrize(
    "text", ["", "   ", "hello", "do a cartwheel", "の歩く", "1234", ",,, and then"]
)
def test_a_sentence_without_an_act_has_none(text):
    assert understand(text).parts == ()


def test_no_word_of_a_sentence_is_dropped_in_silence():
    """A strange word anywhere in a caption is named, but for who does it."""
    rng = np.random.default_rng(4)
    for _ in range(120):
        text = caption(draw(rng)[0], rng).split()
        at = int(rng.integers(1, len(text) + 1))
        found = understand(" ".join([*text[:at], "zorbing", *text[at:]]))
        assert "'zorbing'" in " ".join(found.notes), " ".join([*text[:at], "zorbing", *text[at:]])


def test_the_time_grows_with_what_is_asked():
    one, three = (seconds_of(understand(t).parts) for t in ("squats", "squats three times"))
    assert 2.5 <= one < three <= 10 and seconds_of(()) == 0
    long = "walks, then squats four times slowly, then bows four times slowly"
    assert seconds_of(understand(long).parts) == 10


def test_who_claps_without_a_count_claps_more_than_once():
    (((clap,),),) = (understand("claps").parts,)
    assert clap.count == 0 and in_words(((clap,),)) == "claps three times"
    assert in_words(understand("claps once").parts) == "claps once"


def test_who_sits_and_who_stands():
    stands = [[("walk",)], [("sit",)], [("wave", "left")], [("rise",)]]
    assert acts_of("walks, then sits down, then waves with the left hand, then stands up") == stands
    with pytest.raises(ValueError, match="a figure that stands cannot rise"):
        from data_synth.actions import Act as Done
        from data_synth.actions import Phrase

        seated((Phrase(Done("walk")), Phrase(Done("rise"))))


def plan_of(text: str, seconds: float, seed: int = 0) -> list[tuple]:
    rng = np.random.default_rng(seed)
    return [(a.verb, x, y) for a, x, y in scheduled(understand(text).parts, seconds, rng)]


@pytest.mark.parametrize("seconds", [3.0, 6.0, 10.0])
def test_acts_in_a_row_are_scheduled_one_after_another_within_the_time(seconds):
    for seed in range(4):
        for text in ("walks, then bows twice, then kicks", "kicks, then turns around, then claps"):
            spans = plan_of(text, seconds, seed)
            ends = [0.0, *(last for _, _, last in spans)]
            firsts = [*(first for _, first, _ in spans), seconds]
            assert all(e <= f for e, f in zip(ends, firsts, strict=True))
            assert all(first < last for _, first, last in spans)
    assert plan_of("kicks", 6, 1) != plan_of("kicks", 6, 2)
    (_, first, last), (_, kicks, ends) = plan_of("walks, then kicks", 9.0)
    assert first == 0 and last > 5 and ends - kicks == pytest.approx(1.35 * 1.05)


def test_acts_at_once_are_scheduled_at_once():
    (_, walks, stops), (_, first, last) = plan_of("walks while clapping twice", 6.0)
    assert walks == 0 and stops == pytest.approx(6) and 0 < first < last <= 6
    assert last - first == pytest.approx(2 * 0.65 * 1.05)
    (_, first, last), (_, up, down) = plan_of("squats with both arms raised", 5.0)
    assert first < up < last < down <= 5  # a held arm is seen for longer than a squat takes


def test_who_sits_gets_up_before_the_legs_do_something_else():
    assert [verb for verb, *_ in plan_of("sits down, then walks", 8)] == ["sit", "rise", "walk"]
    verbs = [verb for verb, *_ in plan_of("sits down, then waves, then stands up, then bows", 10)]
    assert verbs == ["sit", "wave", "rise", "bow"]


@pytest.mark.parametrize("text", ["jumps ² times", "claps " + "9" * 5000 + " times", "kicks ①"])
def test_strange_numbers_raise_nothing(text):
    assert understand(text).parts


@pytest.mark.parametrize(
    "text, parts, lost",
    [
        ("kicks with both legs", [("kick", "right")], ["both"]),
        ("waves right, then left", [("wave", "right")], ["left"]),
        ("claps, then bows", [("clap",)], ["bows"]),
        ("three kicks", [("kick", "right")], ["three"]),
        ("slow walk", [("walk",)], ["slow"]),
        ("walks backwards", [("walk",)], ["backwards"]),
        ("walks backwards", [("back",)], []),
        ("points to the left with the right arm", [("point", "right", 0, "", "aside")], ["left"]),
        ("jumps with both feet", [("jump",)], []),
        ("a few kicks", [("kick", "left")], []),
        ("waves his left hand, then turns", [("wave", "left"), ("turn", "right")], []),
        ("walks sideways", [("aside", "left")], []),
    ],
)
def test_words_about_acts_that_no_act_shows_are_found(text, parts, lost):
    """Where the grammar goes wrong; as if it had made these parts of the text."""
    assert unused(text, [(Act(*part),) for part in parts], []) == lost
    assert unused(text, [(Act(*part),) for part in parts], [f"{lost}"]) == []
