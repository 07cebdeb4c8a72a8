"""Several repairs of one past.

Given entries stay, errors agree with the measures, and what cannot be is said.
"""

from types import SimpleNamespace

import numpy as np
import pytest
import torch

from data_synth.imperfect import ARM, dead_joints
from data_synth.walking import walk
from motiondiff_edu.editing.repairs import Reconstructions, sample_reconstructions, with_bones
from motiondiff_edu.metrics import keyframes as measures
from motiondiff_edu.metrics.bodies import bone_rmse
from motiondiff_edu.motion.scaler import Scaler

T_H = 10
CLIP = walk(np.tile([1.2, 0.0, 0.3], (2 * T_H, 1)), seed=6)


class Drawing:
    """A walker that stands still but for noise: each row of the batch draws its own."""

    class config:
        T_h = T_H
        T_p = 5
        D = 63
        C = 3

    pose_scaler = Scaler(torch.from_numpy(CLIP.poses.mean(0)).float().flatten(), torch.ones(63))
    control_scaler = Scaler.nothing(3)

    def window_sampler(self, steps=None):
        def sample(past, control, generator):
            return past[:, -1:] + 0.01 * torch.randn(len(past), 5, 63, generator=generator)

        return sample


def mended(fault, **options):
    generator = torch.Generator().manual_seed(1)
    return list(
        sample_reconstructions(
            Drawing(), fault.positions, fault.known, CLIP.control, generator=generator, **options
        )
    )


def test_each_repair_keeps_what_was_given_and_fills_the_rest_in_its_own_way():
    fault = dead_joints(CLIP.poses[:T_H])
    *_, last = mended(fault, n=4, rounds=3)
    assert last.samples.shape == (4, T_H, 21, 3) and last.round == 3 and last.change > 0
    assert np.isfinite(last.samples).all()
    for poses in (*last.samples, last.mean):
        assert np.array_equal(
            poses[fault.known], fault.positions[fault.known]
        )  # float64, bit by bit
    assert (np.ptp(last.samples, axis=0)[~fault.known] > 0).all()


def test_the_errors_are_those_of_the_measures():
    fault = dead_joints(CLIP.poses[:T_H])
    samples = np.where(fault.known[..., None], CLIP.poses[:T_H], CLIP.poses[:T_H] + 0.01)
    found = Reconstructions(
        np.stack([samples, samples + np.where(fault.known[..., None], 0, 0.01)]),
        fault.known,
        1,
        0.0,
    )
    errors = found.errors(CLIP.poses[:T_H])
    assert (
        errors["one repair"] == pytest.approx(1.5 * 3**0.5) == pytest.approx(errors["their mean"])
    )
    assert errors["spread"] == measures.missing_spread(found.samples, fault.known)
    assert "spread" not in Reconstructions(samples[None], fault.known, 1, 0.0).errors(
        CLIP.poses[:T_H]
    )


def test_several_pasts_are_mended_as_each_alone_but_for_the_draws():
    fault = dead_joints(np.stack([CLIP.poses[:T_H], CLIP.poses[3 : 3 + T_H] + 0.1]))
    control = np.stack([CLIP.control] * 2)
    generator = torch.Generator().manual_seed(1)
    *_, both = sample_reconstructions(
        Drawing(), fault.positions, fault.known, control, 5, generator=generator, rounds=2
    )
    assert both.samples.shape == (5, 2, T_H, 21, 3) and both.mean.shape == (2, T_H, 21, 3)
    assert np.array_equal(both.samples[3][fault.known], fault.positions[fault.known])
    # a walker that stands: the holes stay where they began, at the mean pose, but for its noise
    start = np.broadcast_to(CLIP.poses.mean(0), fault.positions.shape)
    assert np.abs(both.samples - start)[:, ~fault.known].max() < 0.3


def test_bones_of_the_holes_get_the_lengths_that_they_have_where_it_walks():
    """The elbow of the arm hangs on a given shoulder: shaken, its bones tear, and are mended.

    The given stays.
    """
    truth = torch.from_numpy(CLIP.poses).flatten(-2)[None]
    known = torch.from_numpy(dead_joints(CLIP.poses[:T_H], ARM).known).repeat_interleave(3, -1)[
        None
    ]
    shaken = (
        truth[:, :T_H]
        + 0.05 * torch.randn(1, T_H, 63, generator=torch.Generator().manual_seed(0)) * ~known
    )
    settled = with_bones(shaken, known, truth[:, T_H:])
    assert torch.equal(settled[known], shaken[known]) and settled.dtype == shaken.dtype
    assert (
        bone_rmse(settled.unflatten(-1, (21, 3)).numpy())
        < 0.01
        < 1
        < bone_rmse(shaken.unflatten(-1, (21, 3)).numpy())
    )


def test_what_cannot_be_mended_is_said():
    whole = dead_joints(CLIP.poses[:T_H], [])
    with pytest.raises(ValueError, match="nothing is missing"):
        mended(whole)
    with pytest.raises(ValueError, match="nothing is known"):
        mended(type(whole)(whole.positions, ~whole.known))
    with pytest.raises(ValueError, match="an entry for each joint of each frame"):
        mended(SimpleNamespace(positions=whole.positions, known=whole.known[:-1]))
