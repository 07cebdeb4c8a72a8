"""Windows never cross clips, half of them are held, and the scalers lead back to metres."""

from dataclasses import replace

import numpy as np
import pytest
import torch
from synthetic_walk import walk

import motiondiff_edu as md
from motiondiff_edu.motion.clip import Clip
from motiondiff_edu.performers.windows import Windows, typical_change

T_H, T_P = 4, 3


def ramp_clip(number: int, frames: int) -> Clip:
    """Every pose coordinate and control of frame t is 1000 number + t."""
    t = 1000.0 * number + np.arange(frames)
    poses = t[:, None, None] + np.zeros((frames, 21, 3))
    return Clip(poses, np.repeat(t[:, None], 3, 1), source=f"ramp {number}")


@pytest.fixture()
def windows() -> Windows:
    return Windows.of(
        [ramp_clip(n, frames) for n, frames in enumerate([9, 5, 13, 7, 30])], T_H, T_P
    )


def test_motions_are_taken_as_their_clips():
    motions = [md.Motion(walk(frames=frames, turn=0.3)[0], source="a") for frames in (9, 14)]
    ours, theirs = (Windows.of(x, T_H, T_P) for x in (motions, [m.to_clip() for m in motions]))
    torch.testing.assert_close(ours.poses, theirs.poses)
    torch.testing.assert_close(ours.control, theirs.control)
    with pytest.raises(ValueError, match="has 60 frames/s; resample it to 20 first"):
        Windows.of([motions[1].resampled(60)], T_H, T_P)


def metres(windows: Windows, batch: int = 400):
    past, future, control = windows.draw(batch, torch.Generator().manual_seed(1))
    back = windows.pose_scaler.inverse
    return back(past)[..., 0], back(future)[..., 0], windows.control_scaler.inverse(control)[..., 0]


def test_a_window_never_crosses_two_clips(windows: Windows):
    assert len(windows.starts) == (9 - 6) + 0 + (13 - 6) + 1 + (30 - 6)
    past, future, _ = metres(windows)
    frames = torch.cat([past, future], 1)
    assert frames.shape == (400, T_H + T_P)
    assert torch.allclose(
        frames.diff(dim=1), torch.ones(1), atol=0.01
    )  # 1 a frame; a border would jump by 1000
    assert (
        len({int(n) for n in (frames[:, 0] / 1000).floor()}) == 4
    )  # the clip of 5 frames is too short


def test_control_lies_beside_its_pose(windows: Windows):
    past, future, control = metres(windows)
    assert torch.allclose(control, torch.cat([past, future], 1), atol=0.01)


def test_scalers_standardise_and_lead_back(windows: Windows):
    assert torch.allclose(windows.poses.mean(0), torch.zeros(63), atol=1e-4)
    assert torch.allclose(windows.poses.std(0, correction=0), torch.ones(63), atol=1e-4)
    raw = ramp_clip(4, 30).features()
    assert np.allclose(windows.pose_scaler.inverse(windows.poses[-30:]), raw, atol=0.01)


def test_given_scalers_are_used(windows: Windows):
    scalers = (windows.pose_scaler, windows.control_scaler)
    other = Windows.of([ramp_clip(7, 20)], T_H, T_P, scalers)
    assert other.pose_scaler is scalers[0] and other.control_scaler is scalers[1]
    assert np.allclose(scalers[0].inverse(other.poses)[0, 0], 7000, atol=0.01)


def test_clips_that_are_too_short_are_refused():
    with pytest.raises(ValueError, match="no clip has the 7 frames of a window"):
        Windows.of([ramp_clip(0, 6)], T_H, T_P)
    with pytest.raises(ValueError, match="no clip"):
        Windows.of([], T_H, T_P)


def test_clips_of_another_frame_rate_are_refused():
    with pytest.raises(ValueError, match="clip 'quick' has 60 frames/s; resample it to 20 first"):
        Windows.of([ramp_clip(0, 30), replace(ramp_clip(1, 30), fps=60, source="quick")], T_H, T_P)


def gait_windows() -> Windows:
    rng = np.random.default_rng(0)
    poses = rng.normal(size=(300, 21, 3)).cumsum(0) * np.linspace(0.1, 1, 63).reshape(21, 3)
    return Windows.of([Clip(poses, rng.normal(size=(300, 3)), source="drift")], T_H, T_P)


def test_typical_change_is_that_from_one_frame_to_the_next():
    windows = gait_windows()
    step = torch.diff(windows.poses, dim=0).square().mean(0).sqrt()
    assert typical_change(windows) == pytest.approx(step, rel=0.1)
