"""The prompt box: sentences, notes, refusals, and what stays on show."""

from dataclasses import replace

import numpy as np
import pytest
import small_movers

from motiondiff_edu.conditions.text import TextError
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.performers.mover import Mover
from motiondiff_edu.widgets.prompt import ANSWERS, Prompt

SMALL = replace(small_movers.SMALL, S=4)


@pytest.fixture(scope="module")
def mover() -> Mover:
    return small_movers.mover_of(SMALL, Scaler.nothing(SMALL.D))


def test_the_box_opens_with_four_answers_and_gives_those_of_act(mover):
    box = Prompt(mover, "walks", seconds=2.0, seed=5)
    wanted = mover.act("walks", seconds=2.0, samples=ANSWERS, seed=5, progress=False)
    assert len(box.motions) == ANSWERS == len(wanted)
    for one, other in zip(box.motions, wanted, strict=True):
        np.testing.assert_array_equal(one.positions, other.positions)


def test_a_new_sentence_length_or_seed_is_answered(mover):
    box = Prompt(mover, "walks", seconds=2.0)
    before = box.motions[0].positions
    box.text.value = "kicks with the left foot"
    assert np.abs(box.motions[0].positions - before).max() > 1e-6
    box.seconds.value = 3.0
    assert len(box.motions[0]) == 60
    before = box.motions[0].positions
    box.seed.value = 1
    assert np.abs(box.motions[0].positions - before).max() > 1e-3
    assert not box.button.disabled


def test_the_same_question_is_answered_once(mover, monkeypatch):
    box, asked = Prompt(mover, "walks", seconds=2.0), []
    act = Mover.act
    monkeypatch.setattr(Mover, "act", lambda *a, **k: asked.append(a) or act(*a, **k))
    box.act()
    box.button.click()
    assert not asked
    box.text.value = "runs"
    box.button.click()
    assert len(asked) == 1


@pytest.mark.parametrize(
    "text, told",
    [
        ("", "the text is empty"),
        ("does a cartwheel", "does not know"),
        ("geht vorwärts", "does not know"),
        ("walks " * 80, "the network reads"),
    ],
)
def test_what_cannot_be_acted_is_said_and_the_motions_stay(mover, text, told):
    box = Prompt(mover, "walks", seconds=2.0)
    before = box.motions
    box.text.value = text
    if not text:
        box.act()
    assert told in box.message.value and 'role="alert"' in box.message.value
    assert box.motions is before and "<script>" not in box.message.value
    box.text.value = "walks back"
    assert "alert" not in box.message.value and box.motions is not before
    with pytest.raises(TextError):
        Prompt(mover, "does a cartwheel")


def test_words_that_are_left_out_are_said_and_run_nothing(mover):
    box = Prompt(mover, "walks", seconds=2.0)
    box.text.value = "<b>walks</b> <script>alert(1)</script>"
    assert "left out: &#x27;script&#x27;" in box.message.value
    assert "<script>" not in box.message.value


def test_back_at_the_answered_sentence_the_refusal_goes(mover):
    box = Prompt(mover, "walks", seconds=2.0)
    box.text.value = "does a cartwheel"
    assert "cartwheel" in box.message.value
    box.text.value = "walks"
    assert "cartwheel" not in box.message.value and "alert" not in box.message.value


def test_an_error_that_nobody_expected_does_not_leave_the_box_moving(mover, monkeypatch):
    box = Prompt(mover, "walks", seconds=2.0)
    before = box.motions

    def broken(*args, **kwargs):
        raise MemoryError

    monkeypatch.setattr(Mover, "act", broken)
    with pytest.raises(MemoryError):
        box.seed.value = 3
    assert "stopped by an error" in box.message.value and box.motions is before
    assert not box.button.disabled


def test_a_word_that_is_read_as_another_is_said_below_the_box(mover):
    box = Prompt(mover, "walks", seconds=2.0)
    box.text.value = "marches ahead"
    assert "&#x27;marches&#x27; is read as &#x27;walk&#x27;" in box.message.value


@pytest.mark.parametrize("sizes", [{"seconds": 99.0}, {"seconds": 0.5}, {"seed": 123_456}])
def test_what_the_box_cannot_show_is_refused_and_not_put_right(mover, sizes):
    with pytest.raises(ValueError, match=f"{next(iter(sizes))} must be"):
        Prompt(mover, "walks", **sizes)


def test_what_is_not_to_be_seen_is_said_with_its_answer(mover):
    box = Prompt(mover, "kicks", seconds=2.0)  # an untrained network shows nothing
    assert "answer 2: asked: kicks; but &#x27;kick&#x27; (right) is not to" in box.message.value


def test_without_a_kernel_the_sentence_and_its_player_are_there(mover):
    bundle, _ = Prompt(mover, "walks <b>", seconds=2.0)._repr_mimebundle_()
    assert bundle["text/html"].startswith("<p>walks &lt;b&gt;</p>")
    assert bundle["text/html"].count("<iframe") == 1
