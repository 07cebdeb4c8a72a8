"""Checks of notebook 12: a frame convolution, motions of any length, and attention between two clocks."""

import math

import torch
from torch.nn import functional as F

from ._report import check, expect, expect_close


def _numbers(*shape: int, seed: int = 0) -> torch.Tensor:
    return torch.randn(*shape, generator=torch.Generator().manual_seed(seed))


def _shifted(x: torch.Tensor, by: int) -> torch.Tensor:
    """x[t + by], with zeros beyond both ends."""
    return F.pad(x, (0, 0, max(-by, 0), max(by, 0)))[max(by, 0) : max(by, 0) + len(x)]


@check
def frame_conv(mine):
    """mine(x, weight, bias, stride) against PyTorch's conv1d."""
    x, weight, bias = _numbers(7, 2), _numbers(4, 6, seed=1), _numbers(4, seed=2)  # 7 frames of 2, answers of 4
    kernel = weight.unflatten(1, (3, 2)).transpose(1, 2)

    def mixed(*parts):
        return torch.cat(parts, -1) @ weight.T + bias

    before, after = _shifted(x, -1), _shifted(x, 1)
    middle = "the middle third of the weights belongs to the frame itself"
    for stride in (1, 2):
        wanted = F.conv1d(x.T[None], kernel, bias, stride=stride, padding=1)[0].T
        same_length = {
            f"this looks into the future only: {middle}": mixed(x, after, _shifted(x, 2)),
            f"this looks into the past only: {middle}": mixed(_shifted(x, -2), before, x),
            "before and after are exchanged: the first third of the weights belongs to the frame before": mixed(
                after, x, before
            ),
            "it wraps around: before the first frame comes not the last one, but zeros": mixed(
                x.roll(1, 0), x, x.roll(-1, 0)
            ),
        }
        mistakes = {hint: wrong[::stride] for hint, wrong in same_length.items()} | {
            "the bias is missing": wanted - bias
        }
        if stride == 2:
            whole = mixed(before, x, after)
            mistakes |= {
                "every second frame is kept, the *first* one included": whole[1::2],
                "the stride is not used": whole,
                "the last frame got lost: of 7 frames, every second kept, 4 are left": whole[::2][:3],
            }
        expect_close(mine(x, weight, bias, stride), wanted, f"the answer for 7 frames and stride {stride}", mistakes)
    return "Three frames in, one out; the same weights at every moment, so that any length will do."


@check
def any_length(mine):
    """mine(network, x, multiple) with a network that remembers where each frame lay."""
    asked = []

    def network(x):  # the running sum: what is put before the motion, or cut off it, shows
        asked.append(x.shape[1])
        expect(
            x.shape[1] % 8 == 0,
            f"the network was given {x.shape[1]} frames, and takes whole eights only: fill up before you ask",
        )
        return x.cumsum(1) + 3

    for T in (13, 16, 1):
        x = _numbers(2, T, 3, seed=T)
        asked.clear()
        got = torch.as_tensor(mine(network, x, 8))
        more = -(-T // 8) * 8
        whole = F.pad(x, (0, 0, 0, more - T)).cumsum(1) + 3
        before = (F.pad(x, (0, 0, more - T, 0)).cumsum(1) + 3)[:, :T]
        expect(bool(asked), "the network was not asked at all")
        expect(got.shape[1] >= T, f"{T} frames came in and {got.shape[1]} went out: the last ones got lost")
        expect(got.shape[1] == T, f"{T} frames came in and {got.shape[1]} went out: crop what was filled up")
        expect(asked[-1] == more, f"{T} frames need {more - T} more, and not {asked[-1] - T}")
        mistakes = {
            "fill up behind the motion: before it, every frame moves to another time": before,
            "crop at the end, not at the start": whole[:, more - T :],
        }
        expect_close(got, x.cumsum(1) + 3, f"the answer for {T} frames", mistakes)
    return "In the library the filling is masked as well, so that attention and neighbours never see it."


@check
def clocks(mine):
    """mine(q, k, fps_q, fps_k, f) against cosines of the time between."""
    q, k = _numbers(5, 4), _numbers(7, 4, seed=1)  # 5 frames, 7 tokens, two pairs
    fps_q, fps_k, f = 20.0, 15.625, torch.tensor([0.3, 2.0])

    def weights(t, u, root=2.0, softmax=-1):
        """Pair by pair as complex numbers: the score of q and k is the real part of q conj(k) e^(i angle)."""
        a, b = torch.complex(q[:, :2], q[:, 2:]), torch.complex(k[:, :2], k[:, 2:])
        phase = torch.exp(1j * (t[:, None, None] - u[None, :, None]) * f)
        scores = (a[:, None] * b.conj()[None] * phase).real.sum(-1) / root
        return scores if softmax is None else scores.softmax(softmax)

    n, m, turn = torch.arange(5.0), torch.arange(7.0), 2 * math.pi
    t, u = turn * n / fps_q, turn * m / fps_k
    mistakes = {
        "these are indices: divide each by its own rate, for only seconds mean the same on both sides": weights(
            turn * n, turn * m
        ),
        "both sides were counted by the motion's clock; the tokens have their own": weights(t, turn * m / fps_q),
        "the rates are exchanged": weights(turn * n / fps_k, turn * m / fps_q),
        "only the queries are turned": weights(t, 0 * u),
        "only the keys are turned": weights(0 * t, u),
        "queries and keys turn against one another: turn both the same way": weights(t, -u),
        "a whole turn is 2 pi": weights(t / turn, u / turn),
        "the scores are not divided by the root of d": weights(t, u, root=1.0),
        "the softmax runs over the wrong axis: each query's weights must sum to one": weights(t, u, softmax=0),
        "these are scores; where is the softmax?": weights(t, u, softmax=None),
        "nothing was turned": weights(0 * t, 0 * u),
    }
    expect_close(mine(q, k, fps_q, fps_k, f), weights(t, u), "the weights of 5 frames over 7 tokens", mistakes)
    return "A minute later on both clocks, and every weight is the same: only the time between them counts."
