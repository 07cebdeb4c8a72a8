"""Motion without music.

Walks and dances by turns, the windows of them, and a network that hears nothing.
"""

from dataclasses import replace

import numpy as np
import pytest
import torch

from data_synth.mixed import motions
from motiondiff_edu.metrics.bodies import bone_rmse
from motiondiff_edu.pretrained.checkpoints import load, save
from motiondiff_edu.recipes.dancer import UNCONDITIONAL, train_dancer, training_windows

TINY = replace(
    UNCONDITIONAL,
    config=replace(UNCONDITIONAL.config, widths=(16, 24), S=20),
    songs=4,
    seconds=8.0,
    steps=3,
    batch=3,
)


def test_walks_and_dances_take_turns():
    made = list(motions(6, 3, 8.0))
    assert all(p.shape == (160, 21, 3) and c.shape == (160, 2) and c.dtype == bool for p, c in made)
    way = [np.linalg.norm(np.diff(p[::20, 0, [0, 2]], axis=0), axis=-1).sum() for p, _ in made]
    assert np.median(way[0::2]) > 2 * max(way[1::2])  # who walks gets farther than who dances
    assert all(bone_rmse(p) < 1e-6 for p, _ in made)
    again, other = list(motions(6, 3, 8.0)), list(motions(6, 4, 8.0))
    assert all(
        np.array_equal(a[0], b[0]) and np.array_equal(a[1], b[1])
        for a, b in zip(made, again, strict=True)
    )
    assert not any(np.array_equal(a[0], b[0]) for a, b in zip(made, other, strict=True))


def test_a_network_that_hears_nothing_is_trained_saved_and_read(tmp_path):
    windows = training_windows(TINY)
    motion, heard, stands = windows.take(torch.arange(5))
    assert heard.shape[2] == 0 and motion.shape == (5, 100, 63) and stands.shape == (5, 100, 2)
    assert len(windows) == 2 * 4 * (1 + (160 - 100) // 16)
    dancer = train_dancer(TINY, tmp_path / "run.safetensors", windows, log=lambda line: None)
    back = load(save(dancer, tmp_path / "weights.safetensors"))
    assert back.config.C == 0 and back.mel_scaler.mean.shape == (0,)
    x = torch.randn(2, 37, 63)
    assert back.denoiser(None, 37)(x, torch.tensor([3, 9])).shape == x.shape
    with pytest.raises(ValueError, match="takes no music"):
        back.denoiser(torch.zeros(2, 70, 80), 37)
