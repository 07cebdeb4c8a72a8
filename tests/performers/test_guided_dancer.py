"""Guidance of a dancer by its music: closed form, both networks, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest
import torch
from small_dancers import dancer_to_mel

from motiondiff_edu.baselines.transformer import DanceTransformer, TransformerConfig
from motiondiff_edu.beyond.classifier_free import without
from motiondiff_edu.mofusion import Music
from motiondiff_edu.performers.dancer import FARTHEST, USUAL_GUIDANCE, Dancer
from motiondiff_edu.prediction import x0_from_eps

GUIDED = replace(dancer_to_mel(), card={"recipe": {"no_music": 0.15}})
MEL = torch.randn(2, 70, 80, generator=torch.Generator().manual_seed(1)) - 6
X = torch.randn(2, 40, 63, generator=torch.Generator().manual_seed(2))


def test_no_music_is_the_same_for_all_songs():
    music = Music(torch.randn(3, 4, 5), torch.arange(4.0))
    assert not without(music).tokens.any() and without(music).times is music.times
    some = without(music, torch.tensor([True, False, True])).tokens
    assert not some[[0, 2]].any() and torch.equal(some[1], music.tokens[1])


def test_guidance_goes_away_from_no_music():
    s = torch.tensor([8, 11])
    at = [GUIDED.denoiser(MEL, 40, w)(X, s) for w in (0, 1, 3)]
    torch.testing.assert_close(at[2], at[0] + 3 * (at[1] - at[0]), atol=1e-5, rtol=1e-5)
    assert (at[1] - at[0]).abs().max() > 1e-3
    other = GUIDED.denoiser(MEL.flip(0), 40, 0)(X, s)
    torch.testing.assert_close(other, at[0])  # w = 0 hears no music
    assert (GUIDED.denoiser(MEL.flip(0), 40, 1)(X, s) - at[1]).abs().max() > 1e-3


def test_the_first_and_the_last_steps_have_no_guidance():
    """Alpha_bar at these steps is .85 and almost 0; w below 1 mixes at all of them."""
    s = torch.tensor([3, 12])
    none, half, three = (GUIDED.denoiser(MEL, 40, w)(X, s) for w in (1, 0.5, 3))
    torch.testing.assert_close(three, none)
    assert (half - none).abs().amax((1, 2)).min() > 1e-3


def test_dances_have_the_usual_guidance():
    def danced(dancer, **how):
        return dancer.dance_mel(MEL, 20, generator=torch.Generator().manual_seed(0), steps=4, **how)

    assert torch.equal(danced(GUIDED), danced(GUIDED, guidance=USUAL_GUIDANCE))
    assert not torch.allclose(danced(GUIDED), danced(GUIDED, guidance=1))
    plain = dancer_to_mel()
    assert plain.usual_guidance == 1 and torch.equal(danced(plain), danced(plain, guidance=1))
    sound = 0.1 * np.sin(np.arange(32_000) / 9)
    usual, one = (
        GUIDED.dance(sound, sample_rate=16_000, steps=4, progress=False, **how)
        for how in ({}, {"guidance": 1})
    )
    assert np.abs(usual.positions - one.positions).max() > 1e-4


def test_the_guess_of_an_eps_network_is_clamped_once_after_guidance():
    eps, s = replace(dancer_to_mel(target="eps"), card=GUIDED.card), torch.tensor([12, 12])
    for w in (1, 4):
        guess = x0_from_eps(X, s, eps.denoiser(MEL, 40, w)(X, s), eps.schedule)
        assert guess.abs().max() == pytest.approx(FARTHEST, rel=1e-3)


def regression() -> Dancer:
    config = TransformerConfig(S=12, width=16, heads=2, layers=1, deterministic=True)
    return replace(GUIDED, model=DanceTransformer(config).eval(), card={})


def test_what_cannot_be_guided_says_so():
    with pytest.raises(ValueError, match="never without its music"):
        regression().dance_mel(MEL, 20, guidance=2)
    with pytest.raises(ValueError, match="guidance must be a number"):
        regression().dance_mel(MEL, 20, guidance=-5)
    for card in ({}, {"recipe": "mine"}, {"recipe": {}}):
        assert not replace(GUIDED, card=card).can_be_guided
    with pytest.raises(ValueError, match="never without its music"):
        dancer_to_mel().dance_mel(MEL, 20, steps=2, guidance=2)
    with pytest.raises(ValueError, match="guidance must be a number"):
        GUIDED.dance(np.zeros(16_000), sample_rate=16_000, guidance=-1, progress=False)
