"""Windows never cross clips, and half of them are held.

The scalers lead back to metres, and the loss is Algorithm 1.
"""

from dataclasses import replace

import numpy as np
import pytest
import torch
from torch import nn

from motiondiff_edu.ddpm import linear_schedule, q_sample
from motiondiff_edu.diffusion_dropout import Dropout
from motiondiff_edu.modiff import MoDiff, MoDiffConfig
from motiondiff_edu.motion.clip import Clip
from motiondiff_edu.performers.windows import Windows, shaken, typical_change, window_loss
from motiondiff_edu.prediction import target_of

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


def metres(windows: Windows, batch: int = 400, held: float = 0.5):
    past, future, control = windows.draw(batch, torch.Generator().manual_seed(1), held)
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


def test_control_lies_beside_its_pose_and_half_is_held(windows: Windows):
    past, future, control = metres(windows)
    assert torch.allclose(control[:, :T_H], past, atol=0.01)
    held = (control[:, T_H:] - control[:, T_H - 1 : T_H]).abs().amax(1) < 0.01
    assert torch.allclose(control[~held][:, T_H:], future[~held], atol=0.01)
    assert 0.4 < held.float().mean() < 0.6
    for share in (0.0, 1.0):
        _, _, control = metres(windows, held=share)
        is_held = (control[:, T_H:] - control[:, T_H - 1 : T_H]).abs().amax(1) < 0.01
        assert is_held.float().mean() == share


def test_drawing_a_held_batch_leaves_the_data_alone(windows: Windows):
    before = windows.control.clone()
    windows.draw(50, torch.Generator().manual_seed(2), held=1.0)
    assert torch.equal(windows.control, before)


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
    with pytest.raises(ValueError, match="clip 'quick' has 60 frames/s; bring it to 20 first"):
        Windows.of([ramp_clip(0, 30), replace(ramp_clip(1, 30), fps=60, source="quick")], T_H, T_P)


@pytest.mark.parametrize("target", ["eps", "x0", "v"])
def test_the_loss_is_algorithm_1(windows: Windows, target: str):
    """The same draws, in the same order, one noise for each window, the whole network called."""
    config = MoDiffConfig(T_h=T_H, T_p=T_P, S=6, width=16, heads=2, hidden=24, target=target)
    torch.manual_seed(0)
    model, schedule = MoDiff(config), linear_schedule(6, 0.2, 0.95)
    loss = window_loss(windows, schedule, batch=5, noises=2, held=0.3)(
        model, torch.Generator().manual_seed(8)
    )
    generator = torch.Generator().manual_seed(8)
    past, x0, control = windows.draw(5, generator, 0.3)
    past, x0, control = (x.repeat_interleave(2, 0) for x in (past, x0, control))
    s = torch.randint(1, 7, (10,), generator=generator)
    eps = torch.randn(10, T_P, 63, generator=generator)
    output = model(q_sample(x0, s, schedule, eps), s, past, control)
    expected = (target_of(x0, eps, s, schedule, target) - output).square().mean()
    assert loss.item() == pytest.approx(expected.item(), rel=1e-5)


def test_the_past_is_dropped_at_the_step_of_its_own_target(windows: Windows):
    """Each window has two noises, each with the past that dropout makes at its own step.

    The draws are the same.
    """
    config = MoDiffConfig(T_h=T_H, T_p=T_P, S=6, width=16, heads=2, hidden=24, target="x0")
    torch.manual_seed(0)
    model, schedule = MoDiff(config), linear_schedule(6, 0.2, 0.95)
    dropout = Dropout(schedule, lambda done: 0.5, steps=1)
    settings = {"batch": 5, "noises": 2, "held": 0.3}
    loss = window_loss(windows, schedule, **settings, dropout=dropout)(
        model, torch.Generator().manual_seed(8)
    )
    generator = torch.Generator().manual_seed(8)
    past, x0, control = (x.repeat_interleave(2, 0) for x in windows.draw(5, generator, 0.3))
    s = torch.randint(1, 7, (10,), generator=generator)
    hit = torch.rand(10, generator=generator) < 0.5
    seen = q_sample(past, s, schedule, torch.randn(past.shape, generator=generator))
    seen = seen.where(hit[:, None, None], past)
    eps = torch.randn(x0.shape, generator=generator)
    expected = (x0 - model(q_sample(x0, s, schedule, eps), s, seen, control)).square().mean()
    assert 0 < hit.sum() < 10 and loss.item() == pytest.approx(expected.item(), rel=1e-5)
    none = window_loss(
        windows, schedule, **settings, dropout=Dropout(schedule, lambda done: 0.0, steps=1)
    )
    assert none(model, torch.Generator().manual_seed(8)).item() != pytest.approx(
        loss.item(), rel=1e-4
    )


def gait_windows() -> Windows:
    rng = np.random.default_rng(0)
    poses = rng.normal(size=(300, 21, 3)).cumsum(0) * np.linspace(0.1, 1, 63).reshape(21, 3)
    return Windows.of([Clip(poses, rng.normal(size=(300, 3)), source="drift")], T_H, T_P)


def assert_even_on_a_log_scale(sizes: torch.Tensor, largest: float):
    """Over two decades, up to `largest`."""
    for quantile, level in ((0.1, 10**-1.8), (0.5, 0.1), (0.9, 10**-0.2)):
        assert sizes.quantile(quantile) == pytest.approx(level * largest, rel=0.25)


def test_the_shaken_past_has_one_steady_error_of_any_size():
    """Where nothing changes from frame to frame, only the steady part is left.

    The same noise in all frames.
    """
    past = torch.zeros(4000, 6, 50)
    noise = shaken(past, 0.3, torch.zeros(50), torch.Generator().manual_seed(0))
    assert torch.equal(noise, noise[:, :1].expand_as(noise))
    assert_even_on_a_log_scale(
        noise[:, 0].std(1), 0.3
    )  # one level for a window, in standard deviations
    assert abs(torch.corrcoef(noise[:, 0].T)[0, 1]) < 0.1  # and each column its own error


def test_the_shaken_past_has_fresh_errors_as_large_as_columns_change():
    past = torch.zeros(4000, 6, 3)
    change = torch.tensor([0.5, 1.0, 2.0])
    noise = shaken(past, 0.3, change, torch.Generator().manual_seed(0))
    fresh = noise - noise.mean(1, keepdim=True)
    assert fresh.std((0, 1)) == pytest.approx(change * fresh.std((0, 1))[1], rel=0.05)
    assert_even_on_a_log_scale(
        fresh[..., 1].std(1), 1.0
    )  # jitter 0.3 is once the change of a frame
    assert (shaken(past, 0.03, change, torch.Generator().manual_seed(0)) * 10).allclose(
        noise, atol=1e-6
    )


def test_typical_change_grows_as_a_random_walk_does():
    found, windows = typical_change(gait_windows()), gait_windows()
    step = torch.diff(windows.poses, dim=0).square().mean(0).sqrt()
    expected = step * torch.arange(1, T_P + 1)[:, None].sqrt()
    assert found == pytest.approx(expected, rel=0.25)


SLOPES = np.linspace(
    0.1, 1, 63
)  # metres a frame: each column moves steadily, so frame k is k times as far as frame 1


class OffByOne(nn.Module):
    """Tells the future of steady motion exactly, but for one entry at one step.

    There it errs by 1.
    """

    config = MoDiffConfig(T_h=T_H, T_p=T_P, S=6, target="x0")

    def __init__(self, frame: int, column: int, step: int):
        super().__init__()
        self.where, self.times = (frame, column, step), 0
        self.unused = nn.Parameter(torch.zeros(1))

    def encode(self, past, control):
        return past[:, -1:] + torch.arange(1, T_P + 1)[:, None] * (past[:, -1:] - past[:, -2:-1])

    def decode(self, x_s, s, memory):
        frame, column, step = self.where
        self.times = int((s == step).sum())
        x0_hat = memory.clone()
        x0_hat[s == step, frame, column] += 1
        return x0_hat


def cost(frame: int = 0, column: int = 0, step: int = 1, **weights) -> float:
    """What one error of 1 costs there; without weights it is 1."""
    poses = (np.arange(40)[:, None] * SLOPES).reshape(40, 21, 3)
    windows = Windows.of([Clip(poses, np.zeros((40, 3)), source="steady")], T_H, T_P)
    schedule = linear_schedule(6, 0.2, 0.95)
    model = OffByOne(frame, column, step)
    loss = window_loss(windows, schedule, batch=40, noises=1, **weights)(
        model, torch.Generator().manual_seed(8)
    )
    return loss.item() * (40 * T_P * 63) / model.times


def test_without_weights_every_error_costs_the_same():
    assert [cost(), cost(2), cost(0, 50), cost(1, 20, 6)] == pytest.approx([1.0] * 4, rel=1e-3)


def test_columns_are_weighted_by_how_far_they_move():
    """A column that moves three times as far costs nine times as much.

    In metres, by its squared error.
    """
    a, b = 12, 56
    ratio = SLOPES[b] / SLOPES[a]
    assert cost(column=b, metres=1.0) / cost(column=a, metres=1.0) == pytest.approx(ratio, rel=1e-3)
    assert cost(column=b, metres=2.0) / cost(column=a, metres=2.0) == pytest.approx(
        ratio**2, rel=1e-3
    )
    assert np.mean([cost(column=d, metres=2.0) for d in range(63)]) == pytest.approx(1, rel=1e-3)


def test_frames_are_weighted_by_how_little_has_moved_till_then():
    for metres in (0.0, 2.0):
        first, second, third = (cost(frame, 5, near=1.0, metres=metres) for frame in range(3))
        assert first / third == pytest.approx(3, rel=1e-3) and first / second == pytest.approx(
            2, rel=1e-3
        )
    assert cost(0, near=0.5) / cost(2, near=0.5) == pytest.approx(3**0.5, rel=1e-3)
    assert np.mean([cost(frame, near=1.0) for frame in range(T_P)]) == pytest.approx(1, rel=1e-3)


def test_steps_are_weighted_by_their_noise():
    """beta 0.2, 0.35, 0.5, 0.65 ... leave 0.8, 0.52, 0.26, 0.091 of the signal.

    Noise / signal is capped at 3.
    """
    wanted = [1 + 0.2 / 0.8, 1 + 0.48 / 0.52, 1 + 0.74 / 0.26, 1 + 3, 1 + 3, 1 + 3]
    assert [cost(step=s, high_noise=3.0) for s in range(1, 7)] == pytest.approx(wanted, rel=1e-3)
