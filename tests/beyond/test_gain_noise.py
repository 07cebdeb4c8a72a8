"""Music as from different loudspeakers: another level and another balance, at all times alike."""

import pytest
import torch

from motiondiff_edu.beyond.gain_noise import gain_noise


def test_music_with_gain_noise_differs_in_level_and_balance_alone():
    generator = torch.Generator().manual_seed(0)
    mel = torch.randn(400, 20, 5, generator=generator)
    change = gain_noise(mel, 0.3, generator) - mel
    alike = change[:, :1].expand_as(change)
    torch.testing.assert_close(change, alike, atol=1e-5, rtol=0)
    level = change[:, 0].mean(-1)
    tilt = (change[:, 0, -1] - change[:, 0, 0]) / 2
    line = level[:, None] + tilt[:, None] * torch.linspace(-1, 1, 5)
    torch.testing.assert_close(change[:, 0], line, atol=1e-5, rtol=0)
    assert level.std().item() == pytest.approx(0.3, rel=0.15)
    assert tilt.std().item() == pytest.approx(0.3, rel=0.15)
    assert abs(torch.corrcoef(torch.stack([level, tilt]))[0, 1]) < 0.2  # neither follows the other
