"""Words as a network knows them: base forms, synonyms in the open, and refusals by name."""

import numpy as np
import pytest

from data_synth.actions import captions, clips
from data_synth.actions.dataset import worded
from motiondiff_edu.conditions.text import (
    MOST_WORDS,
    TextError,
    base_vocabulary,
    lemma,
    read_words,
    synonyms,
    words_of,
)

WORDS = ("a", "clap", "foot", "hand", "kick", "left", "raise", "run", "stride", "times", "walk")


def test_words_are_lower_case_and_without_marks():
    assert words_of("Walks, then KICKS 3 times!") == ["walks", "then", "kicks", "3", "times"]
    assert words_of("She's  walking\n- left") == ["she's", "walking", "left"]


@pytest.mark.parametrize(
    "form, base",
    [
        ("walks", "walk"),
        ("walking", "walk"),
        ("walked", "walk"),
        ("striding", "stride"),
        ("raises", "raise"),
        ("clapped", "clap"),
        ("clapping", "clap"),
        ("running", "run"),
        ("ran", "run"),
        ("feet", "foot"),
        ("times", "times"),
        ("walrus", "walrus"),
    ],
)
def test_forms_of_a_word_are_the_word(form, base):
    assert lemma(form, set(WORDS)) == base


@pytest.mark.parametrize("word", ["toes", "outing", "overly", "manly", "armed", "lefts", "rightly"])
def test_a_word_that_only_looks_like_a_form_is_not_read_as_one(word):
    known = ("arm", "left", "man", "out", "over", "right", "to", "walk")
    assert lemma(word, frozenset(known)) == word
    with pytest.raises(TextError, match=word):
        read_words(f"walks {word}", known)


def test_known_words_are_read_and_others_passed_over_or_replaced_in_the_open():
    found = read_words("She strolls, then kicks with... the left feet", [*WORDS, "then", "with"],
                 {"stroll": "walk"})  # fmt: skip
    assert found.words == ("walk", "then", "kick", "with", "left", "foot")
    assert found.notes == ("'strolls' is read as 'walk'",)


@pytest.mark.parametrize(
    "text, said",
    [
        ("", "is empty: say what the figure does"),
        ("  \n", "is empty"),
        ("歩く", "has no English words"),
        ("?!", "has no English words"),
        ("is it", "says nothing about a movement"),
        ("a cartwheel", "does not know 'cartwheel'. It was trained on a small vocabulary"),
        ("a cartwheel", "it knows walk, run, kick, raise, clap and others"),
        ("left", "'left' names no act: say what the figure does; it knows walk"),
        ("wlak left", r"'wlak' \(did you mean walk\?\)"),
        ("wakls left", r"'wakls' \(did you mean walk\?\)"),
        ("er geht nach vorne und winkt", "does not know 'er', 'geht', .* and 1 more"),
        ("walk " * (MOST_WORDS + 1), f"has {MOST_WORDS + 1} words; the network reads {MOST_WORDS}"),
    ],
)
def test_what_cannot_be_read_is_said(text, said):
    with pytest.raises(TextError, match=said):
        read_words(text, WORDS)


def test_every_caption_is_read_whole_and_held_out_verbs_are_unknown():
    words = base_vocabulary(captions.vocabulary())

    rng = np.random.default_rng(0)
    refused = 0
    for clip in clips(30, 5):
        for text in clip.captions:
            assert read_words(text, words, {}).notes == ()
        for text in worded(clip.acted.sentence, rng, new_verbs=True):
            try:
                read_words(text, words, {})
            except TextError:
                refused += 1
    assert refused > 100 and len(words) < 140


def test_counts_are_read_from_digits_and_other_counts_are_refused_with_those_there_are():
    known = base_vocabulary(captions.vocabulary())
    assert read_words("jumps 1 time", known).words == ("jump", "one", "time")
    assert read_words("jumps 2 times", known).words[1] == "2"
    for text in ("jumps five times", "jumps 7 times"):
        with pytest.raises(TextError, match="did you mean once or twice or three or four"):
            read_words(text, known)
    with pytest.raises(TextError, match="'läuft', 'vorwärts'"):
        read_words("läuft vorwärts", known)
    with pytest.raises(TextError, match="'without'"):
        read_words("walks without waving", known)


def test_a_text_that_grows_by_being_read_is_not_too_long_for_the_network():
    known = base_vocabulary(captions.vocabulary())
    assert len(read_words("walks " * 2 + "thrice " * 31, known).words) == MOST_WORDS
    with pytest.raises(TextError, match="has 66 words; the network reads 64"):
        read_words("thrice " * 33, known)


def test_a_limb_that_does_not_do_an_act_is_said():
    words = ["kick", "wave", "with", "left", "hand", "foot", "then", "clap"]
    told = {
        "kicks with the left hand": ("the figure does 'kick' with a foot, not with the hand",),
        "waves with the left foot": ("the figure does 'wave' with a hand, not with the foot",),
        "kicks with the left foot, then waves with the hand": (),
        "claps, then kicks": (),
    }
    assert {text: read_words(text, words, {}).notes for text in told} == told


def test_synonyms_lead_from_unknown_words_to_known_ones():
    known = set(base_vocabulary(captions.vocabulary()))
    table = synonyms()
    assert len(table) > 150 and not known & set(table)
    assert {lemma(part, known) for other in table.values() for part in other.split()} <= known
    found = read_words("He marches ahead rapidly, then applauds thrice", sorted(known))
    assert " ".join(found.words) == "walk ahead quick then clap three time"
    assert found.notes[0] == "'marches' is read as 'walk'" and len(found.notes) == 4
