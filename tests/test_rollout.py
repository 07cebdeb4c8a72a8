"""Rollout: which rows of control are seen, when the sampler is asked, what is refused.

The samplers here are fakes.
"""

import warnings
from types import SimpleNamespace

import pytest
import torch

from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.rollout import generate, rollout_steps

B = 2
T_H = 4
T_P = 3
D = 5
C = 1


def generator() -> torch.Generator:
    return torch.Generator().manual_seed(0)


def numbered_control(frames: int) -> torch.Tensor:
    """Row t holds t (and t + 100 in the second walk)."""
    return torch.arange(frames).float()[None, :, None] + torch.tensor([0.0, 100.0])[:, None, None]


class Echo:
    """A sampler that returns the control of the future frames as poses.

    It remembers what it was given.
    """

    def __init__(self):
        self.calls = []

    def __call__(self, past, control, generator):
        self.calls.append((past.clone(), control.clone()))
        return control[:, T_H:].expand(-1, -1, D)


def roll(sample, control, frames: int, **options) -> torch.Tensor:
    past = torch.zeros(B, T_H, D)
    loop = rollout_steps(sample, past, control, frames, T_P, generator=generator(), **options)
    return torch.stack([frame.pose for frame in loop], 1)


def test_hold_sees_only_the_step_about_to_be_taken():
    echo = Echo()
    poses = roll(echo, numbered_control(T_H + 6), 6)
    assert poses.shape == (B, 6, D)
    # the frame T_h + t is reached by control[T_h - 1 + t]
    assert poses[0, :, 0].tolist() == [3, 4, 5, 6, 7, 8]
    assert poses[1, :, 0].tolist() == [103, 104, 105, 106, 107, 108]
    assert [call[1][0, :, 0].tolist() for call in echo.calls[:2]] == [
        [0, 1, 2, 3, 3, 3, 3],
        [1, 2, 3, 4, 4, 4, 4],
    ]


def test_look_ahead_sees_what_comes_and_repeats_the_last_row():
    echo = Echo()
    poses = roll(echo, numbered_control(T_H + 6), 6, hold=False)
    assert poses[0, :, 0].tolist() == [4, 5, 6, 7, 8, 9]
    assert echo.calls[0][1][0, :, 0].tolist() == [0, 1, 2, 3, 4, 5, 6]
    assert echo.calls[-1][1][0, :, 0].tolist() == [5, 6, 7, 8, 9, 9, 9]


@pytest.mark.parametrize("keep", [1, 2, 3])
def test_keep_asks_the_sampler_every_keep_frames_and_feeds_back_what_was_kept(keep: int):
    """The same as calling the sampler by hand."""

    def sample(past, control, generator):
        return past[:, -1:] + control[:, T_H:] + torch.randn(B, T_P, D, generator=generator)

    calls, control = [], numbered_control(T_H + 7)
    poses = roll(lambda *given: calls.append(1) or sample(*given), control, 7, keep=keep)
    past = torch.zeros(B, T_H, D)
    random = generator()
    expected = []
    for t in range(0, 7, keep):
        known = control[:, t : t + T_H]
        window = sample(past, torch.cat([known, known[:, -1:].repeat(1, T_P, 1)], 1), random)[
            :, :keep
        ]
        expected.append(window)
        past = torch.cat([past, window], 1)[:, -T_H:]
    assert torch.equal(poses, torch.cat(expected, 1)[:, :7])
    assert len(calls) == -(-7 // keep)


def test_a_frame_carries_its_number_and_the_window_it_was_taken_from():
    loop = rollout_steps(
        Echo(),
        torch.zeros(B, T_H, D),
        numbered_control(12),
        5,
        T_P,
        generator=generator(),
        keep=2,
        hold=False,
    )
    frames = list(loop)
    assert [frame.t for frame in frames] == [0, 1, 2, 3, 4]
    assert torch.equal(frames[3].pose, frames[3].window[:, 1])
    assert frames[2].window is frames[3].window


@pytest.mark.parametrize(("hold", "asked_first"), [(True, range(T_H)), (False, range(T_H + T_P))])
def test_control_as_a_function_is_asked_when_needed_and_can_change_on_the_fly(
    hold: bool, asked_first: range
):
    asked, speed = [], 1.0

    def control(t: int) -> torch.Tensor:
        asked.append(t)
        return torch.full((B, C), speed)

    echo = Echo()
    loop = rollout_steps(
        echo, torch.zeros(B, T_H, D), control, 4, T_P, generator=generator(), hold=hold
    )
    assert asked == []
    assert next(loop).pose[0, 0] == 1
    assert asked == list(asked_first)
    speed = 7.0
    assert next(loop).pose[0, 0] == 7
    assert max(asked) == max(asked_first) + 1


def test_the_rows_already_walked_under_are_not_asked_again():
    """A hand on a joystick only knows its present position.

    The network must be told what it was before.
    """
    asked, seen = [], []

    def hand(t: int) -> torch.Tensor:
        asked.append(t)
        return torch.full((B, C), 1.0 if len(seen) == 0 else 7.0)

    def sample(past, control, generator):
        seen.append(control[0, :, 0].tolist())
        return torch.zeros(B, T_P, D)

    list(rollout_steps(sample, torch.zeros(B, T_H, D), hand, 2, T_P, generator=generator()))
    assert asked == list(range(T_H + 1))
    assert seen == [[1.0] * (T_H + T_P), [1.0] * (T_H - 1) + [7.0] * (1 + T_P)]


def test_a_function_and_a_table_say_the_same():
    table = numbered_control(T_H + 5)
    assert torch.equal(roll(Echo(), table, 5), roll(Echo(), lambda t: table[:, t], 5))


@pytest.mark.parametrize("keep", [0, 4, -1])
def test_keep_beyond_the_window_is_refused(keep: int):
    with pytest.raises(ValueError, match=f"keep must be between 1 and T_p = 3, not {keep}"):
        roll(Echo(), numbered_control(9), 2, keep=keep)


def trained_between(low: float, high: float) -> SimpleNamespace:
    """A walker that says which control it was trained on."""
    return SimpleNamespace(
        config=SimpleNamespace(T_h=T_H, T_p=T_P, D=D, C=C),
        pose_scaler=Scaler.nothing(D),
        control_scaler=Scaler.nothing(C),
        window_sampler=lambda steps: Echo(),
        card={"control_range": {"low": [low], "high": [high]}},
    )


@pytest.mark.parametrize(("value", "named"), [(3.3, True), (3.1, False), (0.9, False), (0.7, True)])
def test_a_control_is_named_when_it_is_a_tenth_of_the_range_beyond_the_training(value, named):
    """From 1 to 3 the range is 2, and a tenth of it 0.2."""
    walker = trained_between(1.0, 3.0)
    control = torch.full((T_H + 3, C), 2.0)
    control[T_H + 1] = value
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        generate(walker, torch.zeros(T_H, D), control)
    assert len(told) == named
    if named:
        assert f"a column 0 of {value} in frame 2 of the future" in str(told[0].message)


@pytest.mark.parametrize(
    ("value", "refused"), [(4.1, True), (3.9, False), (0.1, False), (-0.1, True)]
)
def test_a_control_is_refused_when_it_is_half_of_the_range_beyond_the_training(value, refused):
    """From 1 to 3 the range is 2, and half of it 1: refused above 4 and below 0."""
    walker, control = trained_between(1.0, 3.0), torch.full((T_H + 3, C), 2.0)
    control[T_H + 1] = value
    if refused:
        with pytest.raises(ValueError, match=f"by over half its width: a column 0 of {value}"):
            generate(walker, torch.zeros(T_H, D), control)
    else:
        with pytest.warns(UserWarning, match=f"it will not follow well: a column 0 of {value}"):
            generate(walker, torch.zeros(T_H, D), control)


@pytest.mark.parametrize("row", [0, T_H - 2, T_H - 1, T_H, T_H + 1, T_H + 2])
def test_only_rows_that_lead_to_new_frames_are_checked(row):
    """Row T_h - 1 leads from the last given pose to the first new one; the last row leads on."""
    walker, control = trained_between(1.0, 3.0), torch.full((T_H + 3, C), 2.0)
    control[row] = 50.0
    if T_H - 1 <= row < T_H + 2:
        with pytest.raises(ValueError, match=f"50 in frame {row - T_H + 1} of the future"):
            generate(walker, torch.zeros(T_H, D), control)
    else:
        assert len(generate(walker, torch.zeros(T_H, D), control)) == 3


def test_a_network_that_looks_ahead_sees_the_last_row_and_it_is_checked():
    walker, control = trained_between(1.0, 3.0), torch.full((T_H + 3, C), 2.0)
    control[-1] = 50.0
    with pytest.raises(ValueError, match="50 in frame 3 of the future"):
        generate(walker, torch.zeros(T_H, D), control, hold=False)
