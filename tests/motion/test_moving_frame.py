"""The features of described motions: to the world and back, mirrored, moved, turned."""

import numpy as np
import pytest
import torch

from data_synth.actions import clips
from motiondiff_edu.kinematic_loss import kinematic_parts
from motiondiff_edu.motion import moving_frame
from motiondiff_edu.motion.dance_frame import mirror
from motiondiff_edu.motion.root_frame import estimate_root, to_root_frame, to_world
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.motion.skeleton import TOES


@pytest.fixture(scope="module")
def motions() -> list[np.ndarray]:
    return [one.acted.positions for one in clips(12, 5)]


def test_features_give_the_positions_back(motions):
    for positions in motions:
        features = torch.from_numpy(moving_frame.to_features(positions))
        back = moving_frame.to_positions(features).numpy()
        poses, control = to_root_frame(positions, *estimate_root(positions))
        np.testing.assert_allclose(back, to_world(poses, control), atol=1e-9)
        # the same motion, but for where it begins and which way it faces
        apart = np.linalg.norm(back[:, :, None] - back[:, None], axis=-1)
        wanted = np.linalg.norm(positions[:, :, None] - positions[:, None], axis=-1)
        np.testing.assert_allclose(apart, wanted, atol=1e-9)


def test_features_do_not_depend_on_the_place_or_on_the_direction(motions):
    turn = np.array([[0.6, 0.0, 0.8], [0.0, 1.0, 0.0], [-0.8, 0.0, 0.6]])
    for positions in motions[:4]:
        elsewhere = positions @ turn.T + np.array([3.0, 0.0, -7.0])
        features, same = map(moving_frame.to_features, (positions, elsewhere))
        np.testing.assert_allclose(features, same, atol=1e-8)


def test_a_mirrored_motion_has_mirrored_features(motions):
    for positions in motions[:4]:
        features = torch.from_numpy(moving_frame.to_features(positions))
        wanted = moving_frame.to_features(mirror(positions))
        np.testing.assert_allclose(moving_frame.mirror_features(features), wanted, atol=1e-8)


def test_moves_are_those_of_the_world_for_a_figure_that_does_not_turn(motions):
    features = torch.from_numpy(moving_frame.to_features(motions[0]))
    features[:, -1] = 0.0
    world = moving_frame.to_positions(features).diff(dim=0)
    torch.testing.assert_close(moving_frame.moves(features), world)
    both = torch.stack([features, 2 * features])
    torch.testing.assert_close(moving_frame.moves(both)[1], 2 * moving_frame.moves(both)[0])


def test_the_kinematic_losses_of_data_are_small_and_planted_feet_stand(motions):
    made = next(iter(clips(1, 5))).acted
    features = torch.from_numpy(moving_frame.to_features(made.positions)).float()[None]
    scaler = Scaler.fit(features)
    x0 = scaler.transform(features)
    planted = torch.from_numpy(made.contacts)[None]
    parts = kinematic_parts(x0, x0, moving_frame.body_of(scaler), planted)
    assert parts["skeleton"] < 1e-8 and parts["slide"] < 2e-3
    moved = scaler.transform(features + 0.02 * torch.randn(features.shape))
    worse = kinematic_parts(moved, x0, moving_frame.body_of(scaler), planted)
    assert worse["skeleton"] > 1e-5 and worse["slide"] > 10 * parts["slide"]
    assert list(moving_frame.body_of(scaler).toes) == list(TOES)


def test_another_skeleton_is_refused():
    with pytest.raises(ValueError, match="21 joints with 3 coordinates"):
        moving_frame.to_features(np.zeros((10, 22, 3)))
