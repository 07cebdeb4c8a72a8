"""An ear hears a piece alike whole and in parts, and networks with one add what it hears."""

import numpy as np
import pytest
import torch

from data_synth.music.song import GENRES as SONG_GENRES
from motiondiff_edu.baselines.transformer import HearingTransformer, HearingTransformerConfig
from motiondiff_edu.cross_modal_attention import angles_of
from motiondiff_edu.ddpm import cosine_schedule
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.performers.dancer import Dancer
from motiondiff_edu.performers.ear import GENRES, LONGEST, Ear, EarConfig, in_parts
from motiondiff_edu.performers.hearing_mofusion import HearingConfig, HearingMoFusion
from motiondiff_edu.pretrained.checkpoints import load, save
from motiondiff_edu.recipes.ear import EAR

SMALL = EarConfig(C=5, width=16, heads=2, blocks=2, music_layers=1)
NETWORKS = [
    (
        HearingMoFusion,
        HearingConfig(C=5, S=12, widths=(16, 24), heads=2, music_layers=1, ear_width=16),
    ),
    (
        HearingTransformer,
        HearingTransformerConfig(C=5, S=12, width=16, heads=2, layers=1, ear_width=16),
    ),
]


def moved(model: torch.nn.Module) -> torch.nn.Module:
    """The network with weights of no symmetry, so that every part has an effect."""
    generator = torch.Generator().manual_seed(1)
    with torch.no_grad():
        for weight in model.parameters():
            weight.add_(0.2 * torch.randn(weight.shape, generator=generator))
    return model.eval().requires_grad_(False)


def piece(B: int, M: int) -> tuple[torch.Tensor, torch.Tensor]:
    return torch.randn(B, M, 5, generator=torch.Generator().manual_seed(2)), torch.arange(M) / 31.25


def test_the_genres_are_those_of_the_songs():
    assert tuple(SONG_GENRES) == GENRES


def test_tokens_and_what_they_say():
    ear = moved(Ear(SMALL))
    mel, times = piece(2, 41)
    tokens = ear(mel, times)
    assert tokens.shape == (2, 21, 16)
    said = ear.read(tokens)
    assert said.beat.shape == said.bar.shape == (2, 21, 2)
    assert said.sounds.shape == (2, 21) and said.genre.shape == (2, 21, len(GENRES))


def test_tokens_hear_all_of_the_piece_and_only_the_time_between_matters():
    ear = moved(Ear(SMALL))
    mel, times = piece(1, 201)
    tokens = ear(mel, times)
    torch.testing.assert_close(ear(mel, times + 7), tokens, atol=2e-4, rtol=0)
    changed = mel.clone()
    changed[:, -1] += 3
    assert (ear(changed, times) - tokens)[0, 0].abs().max() > 1e-5


def test_padding_is_not_heard():
    ear = moved(Ear(SMALL))
    mel, times = piece(2, 60)
    mask = torch.ones(2, 60, dtype=torch.bool)
    mask[1, 40:] = False
    both = ear(mel, times, mask)
    torch.testing.assert_close(both[1, :20], ear(mel[1:, :40], times[:40])[0], atol=1e-5, rtol=0)
    torch.testing.assert_close(both[:1], ear(mel[:1], times), atol=1e-5, rtol=0)


def test_the_longest_piece_is_that_of_training():
    assert LONGEST == -(-max(EAR.frames) // Ear(EAR.config).stride)


def test_a_long_piece_is_heard_in_parts():
    """Each is what the block makes of it and its neighbours alone."""
    ear = moved(Ear(SMALL))
    part, M = LONGEST // 2, 3 * LONGEST + 7
    tokens = torch.randn(2, M, 16, generator=torch.Generator().manual_seed(4))
    angles = angles_of(torch.arange(M) / 15.625, 8, SMALL.slowest, SMALL.fastest)
    seen = torch.ones(2, M, dtype=torch.bool)
    seen[1, -20:] = False
    block = ear.blocks[0]
    made = in_parts(block, tokens, angles, seen)
    for first in range(0, M, part):
        own = slice(first, first + part)
        start = int(np.clip(first - 28, 0, M - 112))  # 112 tokens, also at both ends
        near = slice(start, start + 112)
        for k in range(2):
            heard = tokens[k : k + 1, near][:, seen[k, near]]
            at = angles[near][seen[k, near]]
            alone = block(tokens[k : k + 1, own], block.norm(heard), None, (angles[own], at))
            torch.testing.assert_close(made[k : k + 1, own], alone, atol=1e-5, rtol=1e-4)
    whole = in_parts(block, tokens[:, :LONGEST], angles[:LONGEST], None)
    there = tokens.clone()
    there[:, LONGEST - 1] *= -1
    changed = in_parts(block, there[:, :LONGEST], angles[:LONGEST], None) - whole
    assert changed[:, 0].any()  # still in one part: the first hears the last


def test_an_end_is_not_heard_at_the_beginning():
    ear = moved(Ear(SMALL))
    mel, times = piece(1, 8 * LONGEST)
    late = mel.clone()
    late[:, -10:] += 3
    changed = (ear(late, times) - ear(mel, times))[0].abs().amax(-1)
    assert torch.isfinite(changed).all() and changed[-5:].min() > 1e-5
    far = SMALL.blocks * LONGEST + 20  # how far back each block carries it, at most
    assert changed[: 4 * LONGEST - far].max() == 0 and changed[-LONGEST:-60].max() > 0


def test_impossible_sizes_are_refused():
    with pytest.raises(ValueError, match="multiple of 2 x 4 heads, not 20"):
        EarConfig(width=20)
    with pytest.raises(ValueError, match="blocks"):
        EarConfig(blocks=0)


@pytest.mark.parametrize(("network", "config"), NETWORKS, ids=["mofusion", "transformer"])
def test_a_network_adds_what_its_ear_hears(network, config):
    model = moved(network(config))
    mel, times = piece(2, 41)
    music = model.listen(mel, times)
    without = model.music(mel, mel.new_ones(1, 41, 1))
    torch.testing.assert_close(music.tokens, without + model.from_ear(model.ear(mel, times)))
    assert not any(weight.requires_grad for weight in network(config).ear.parameters())


@pytest.mark.parametrize(("network", "config"), NETWORKS, ids=["mofusion", "transformer"])
def test_a_network_with_an_ear_is_saved_and_read(network, config, tmp_path):
    motion = Scaler(torch.zeros(63), torch.full((63,), 0.2))
    dancer = Dancer(moved(network(config)), cosine_schedule(12), motion, Scaler.nothing(5))
    again = load(save(dancer, tmp_path / "one.safetensors", bits=32))
    assert again.config == config
    mel, _ = piece(2, 41)
    x, s = torch.randn(2, 20, 63, generator=torch.Generator().manual_seed(3)), torch.tensor([3, 9])
    torch.testing.assert_close(again.denoiser(mel, 20)(x, s), dancer.denoiser(mel, 20)(x, s))
