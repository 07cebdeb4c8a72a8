"""Checks of notebook 07.

The control held over the future, and the rollout that repeats Algorithm 2.
"""

import torch

from ._report import check, expect, expect_close


@check
def hold_control(mine):
    """mine(control, T_h): the row that leads out of the last past frame, repeated to the end."""
    control = torch.arange(21.0).reshape(7, 3)
    before = control.clone()
    got = mine(control, 4)
    expect(
        torch.equal(control, before), "the data themselves were changed; hold the control in a copy"
    )
    wanted = torch.cat([before[:4], before[3:4].expand(3, 3)])
    mistakes = {
        "one row too late: row T_h is a step that is not known yet": _held(before, 4, 4),
        (
            "one row too early: the step into the first predicted frame is known, it is row T_h - 1"
        ): _held(before, 4, 2),
        "row T_h is a future row, too": torch.cat([before[:5], before[3:4].expand(2, 3)]),
        "the control is unchanged: hold one row over the future": before,
        "the future is not zero, it repeats the last known step": torch.cat(
            [before[:4], torch.zeros(3, 3)]
        ),
        "the past must stay as it was; only the future is unknown": before[3:4].expand(7, 3),
    }
    expect_close(got, wanted, "control of 7 frames, held after a past of 4", mistakes)
    return "The walker knows one step ahead: the step that it is about to take."


def _held(control, T_h: int, row: int):
    return torch.cat([control[:T_h], control[row : row + 1].expand(len(control) - T_h, 3)])


class _Recorder:
    """A sampler that adds its control to the last pose, and records its inputs."""

    def __init__(self, T_p: int):
        self.T_p, self.calls = T_p, []

    def __call__(self, past, control):
        self.calls.append((past.clone(), control.clone()))
        future = past[:, -1:, :1] + torch.cumsum(control[:, -self.T_p :, :1], dim=1)
        return future.expand(-1, -1, past.shape[2])


@check
def rollout_by_hand(mine):
    """Check mine(sample, past, control, frames, T_p).

    The sampler records its inputs.
    """
    B = 2
    T_h = 4
    T_p = 3
    D = 6
    C = 1
    frames = 5
    past = (
        torch.arange(T_h).float()[None, :, None].expand(B, T_h, D)
        * torch.tensor([1.0, -1.0])[:, None, None]
    )
    control = (10.0 ** torch.arange(T_h + frames))[None, :, None].expand(B, -1, C).contiguous()
    sample = _Recorder(T_p)
    got = mine(sample, past.clone(), control.clone(), frames, T_p)
    expect(sample.calls, "the sampler was never called")
    _first_call(*sample.calls[0], past, control, T_h, T_p)
    often = (
        f"the sampler was called {len(sample.calls)} times for {frames} frames; "
        "keep only the first pose of each window"
    )
    expect(len(sample.calls) == frames, often)
    shown = sample.calls[1][0]
    expect(
        not torch.equal(shown, past),
        "the second window still has the first past: append the pose that was kept",
    )
    expect(
        shown.shape == past.shape,
        f"the second past has {shown.shape[1]} poses, not {T_h}; drop the oldest",
    )
    new = past[:, -1] + control[:, T_h - 1]
    expect_close(shown, torch.cat([past[:, 1:], new[:, None]], 1), "the past of the second window")
    steps = torch.cumsum(control[:, T_h - 1 : T_h - 1 + frames], dim=1)
    expect_close(got, past[:, -1:] + steps.expand(-1, -1, D), "the poses of the rollout", rtol=1e-3)
    return "After ten frames the network sees only its own poses, so its errors can add up."


def _first_call(past_seen, control_seen, past, control, T_h: int, T_p: int):
    expect_close(past_seen, past, "the past of the first window")
    rows = [control[:, :T_h], control[:, T_h - 1 : T_h].expand(-1, T_p, -1)]
    mistakes = {
        "this is look-ahead: the future control is not known yet; hold the last row": control[
            :, : T_h + T_p
        ],
        (
            "the row that is held is one too late: which step leads into the first new frame?"
        ): torch.cat([rows[0], control[:, T_h : T_h + 1].expand(-1, T_p, -1)], dim=1),
        "the rows beside the past are one frame too late": torch.cat(
            [control[:, 1 : T_h + 1], control[:, T_h : T_h + 1].expand(-1, T_p, -1)], dim=1
        ),
        "the unknown future is not zero": torch.cat([rows[0], torch.zeros_like(rows[1])], dim=1),
    }
    expect_close(control_seen, torch.cat(rows, dim=1), "the control of the first window", mistakes)
