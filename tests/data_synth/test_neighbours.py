"""Sentences that differ in one thing: which thing, and that they can be performed."""

import numpy as np
import pytest

from data_synth.actions import Act, Phrase, clips
from data_synth.actions.neighbours import KINDS, changed, neighbour

WALK, KICK = Act("walk", speed="slowly"), Act("kick", "left", 2)
SENTENCE = (Phrase(WALK), Phrase(KICK))


def rng(seed: int = 0) -> np.random.Generator:
    return np.random.default_rng(seed)


def test_each_kind_changes_one_thing():
    assert changed(SENTENCE, "order", rng()) == SENTENCE[::-1]
    assert changed(SENTENCE, "side", rng())[1].legs == Act("kick", "right", 2)
    count = {changed(SENTENCE, "count", rng(k))[1].legs.count for k in range(30)}
    assert count == {1, 3, 4}
    assert changed(SENTENCE, "speed", rng())[0].legs == Act("walk", speed="quickly")


@pytest.mark.parametrize("kind", KINDS)
def test_there_is_nothing_to_change_in_a_bare_sentence(kind):
    assert changed((Phrase(Act("run")),), kind, rng()) is None
    assert neighbour((Phrase(Act("run")),), rng()) is None


def test_neighbours_of_many_sentences_are_other_sentences_that_exist():
    made = [one.acted.sentence for one in clips(60, 9)]
    others = [neighbour(sentence, rng(k)) for k, sentence in enumerate(made)]
    assert sum(other is not None for other in others) > 40
    assert all(other != sentence for sentence, other in zip(made, others, strict=True))
