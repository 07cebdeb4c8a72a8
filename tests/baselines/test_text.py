"""A bag of words and a regression: what each of them cannot do, and that they are movers."""

from dataclasses import replace

import numpy as np
import pytest
import torch
from small_movers import SMALL, WORDS, mover_of

from motiondiff_edu.baselines.text import BagConfig, BagOfWords, RegressionConfig
from motiondiff_edu.conditions.word_encoder import ids_of
from motiondiff_edu.performers.mover import Mover
from motiondiff_edu.pretrained import checkpoints

FORTH, BACK = ("wave", "then", "kick"), ("kick", "then", "wave")


def mover(config: type) -> Mover:
    return mover_of(config(**vars(SMALL)))


def test_the_bag_is_the_mean_of_its_words():
    torch.manual_seed(0)
    bag = BagOfWords(len(WORDS), 20)
    ids = ids_of([FORTH, ("kick",), ()], WORDS)
    tokens, mask = bag.tokens_of(ids)
    assert tokens.shape == (3, 1, 20) and mask.all()
    torch.testing.assert_close(tokens[0, 0], bag.mix(bag.embed(ids[0]).mean(0)))
    torch.testing.assert_close(tokens[1, 0], bag.mix(bag.embed(ids[1, 0])))


def test_a_bag_cannot_tell_forth_from_back_and_a_sequence_can():
    ids, s = ids_of([FORTH, BACK], WORDS), torch.tensor([20, 20])
    x = torch.randn(1, 40, SMALL.D).expand(2, -1, -1)
    with torch.no_grad():
        both = mover(BagConfig).denoiser(ids, 40)(x, s)
        torch.testing.assert_close(both[0], both[1])
        apart = mover_of().denoiser(ids, 40)(x, s)
    assert (apart[0] - apart[1]).abs().max() > 1e-3


def test_a_regression_has_one_motion_for_a_text():
    one = mover(RegressionConfig)
    a, b = one.act("kicks", seconds=2, samples=2, seed=1, steps=3, progress=False)
    assert np.abs(a.positions - b.positions).max() < 1e-4
    other = one.act("waves", seconds=2, steps=3, progress=False)
    assert np.abs(a.positions - other.positions).max() > 1e-3


@pytest.mark.parametrize("config", [BagConfig, RegressionConfig])
def test_they_are_saved_and_loaded_as_movers_are(config, tmp_path):
    one = mover(config)
    checkpoints.save(one, tmp_path / "one.safetensors")
    again = checkpoints.load(tmp_path / "one.safetensors")
    assert again.config == one.config == replace(one.config)
    ids, noise = one.reader.encoded([one.reader.read("kicks").words]), torch.Generator
    made = [x.act_ids(ids, 40, steps=2, generator=noise().manual_seed(0)) for x in (one, again)]
    torch.testing.assert_close(*made, atol=5e-3, rtol=0)  # of half precision
