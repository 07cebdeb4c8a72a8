"""A dance with a sound and without it, from the same noise."""

import numpy as np
import pytest
import torch
from bursts import clicks
from small_dancers import dancer_to_mel as dancer

from motiondiff_edu.conditions.music import log_mel
from motiondiff_edu.course.analyses.occlusion import occlusion


def test_occlusion_dances_again_from_the_same_noise():
    one, song = dancer(), clicks(2.0, (0.5, 1.0), tone=0.0)
    times = np.array([0.5, 1.0, 1.6])
    found = occlusion(one, song, times, 33, generator=torch.Generator().manual_seed(7), steps=3)
    start = torch.randn(1, 33, 63, generator=torch.Generator().manual_seed(7))
    plain = one.dance_mel(log_mel(song, 16_000)[None], 33, start=start, steps=3, eta=0.0)
    plain = plain[0].double().numpy()
    assert found.dance == pytest.approx(plain, abs=1e-5)
    assert found.without.shape == (3, 33, 21, 3) and found.moved.shape == (3, 33)
    by_hand = np.sqrt(((found.without[1, 20] - plain[20]) ** 2).sum(-1)).mean()
    assert found.moved[1, 20] == pytest.approx(by_hand, abs=1e-5)
    assert found.moved[:2].max(1).min() > 1e-4  # a silenced burst changes something
    assert found.moved[2].max() < 1e-5  # silenced silence changes nothing
    in_turn = occlusion(
        one, song, times, 33, generator=torch.Generator().manual_seed(7), steps=3, batch=1
    )
    assert in_turn.without == pytest.approx(found.without, abs=1e-5)


def test_without_a_generator_two_calls_agree():
    one, song = dancer(), clicks(2.0, (0.5, 1.0), tone=0.0)
    first, again = (occlusion(one, song, np.array([0.5]), 33, steps=2) for _ in range(2))
    np.testing.assert_array_equal(first.dance, again.dance)
