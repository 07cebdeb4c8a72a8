"""Checks of notebook 12.

A frame convolution, motions of any length, and attention between two clocks.
"""

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
    # 7 frames of 2 numbers in, of 4 numbers out
    x = _numbers(7, 2)
    weight = _numbers(4, 6, seed=1)
    bias = _numbers(4, seed=2)
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
            (
                "the frames before and after are swapped: "
                "the first third of the weights belongs to the frame before"
            ): mixed(after, x, before),
            "this wraps around: before the first frame there are zeros, not the last frame": mixed(
                x.roll(1, 0), x, x.roll(-1, 0)
            ),
            "beyond both ends there are zeros, not copies of the first and the last frame": mixed(
                torch.cat([x[:1], x[:-1]]), x, torch.cat([x[1:], x[-1:]])
            ),
            (
                "these columns are ordered by channel; "
                "the weights expect one whole frame, then the next"
            ): mixed(torch.stack([before, x, after], -1).flatten(1)),
        }
        mistakes = {hint: wrong[::stride] for hint, wrong in same_length.items()} | {
            "the bias is missing": wanted - bias
        }
        if stride == 2:
            whole = mixed(before, x, after)
            mistakes |= {
                "keep every second frame, and begin with the *first* one": whole[1::2],
                "the stride is not used": whole,
                (
                    "take the neighbours first, then every second result: "
                    "here the frames between are never used"
                ): (mixed(_shifted(x[::2], -1), x[::2], _shifted(x[::2], 1))),
                "the last frame is missing: every second one of 7 frames makes 4": whole[::2][:3],
            }
        expect_close(
            mine(x, weight, bias, stride),
            wanted,
            f"the output for 7 frames and stride {stride}",
            mistakes,
        )
    return "Three frames go in, one comes out. All use the same weights: so any length will do."


@check
def any_length(mine):
    """Check mine(network, x, multiple).

    The network of this check depends on each frame's position, and on all other frames.
    """

    def sums(x):  # shows whether frames were added before or after the motion, or cut off
        return x.cumsum(1) + x.sum(1, keepdim=True) + torch.arange(x.shape[1])[:, None]

    for T, multiple in ((13, 8), (16, 8), (1, 8), (3, 4)):
        x, lengths = _numbers(2, T, 3, seed=T), []

        def network(x, lengths=lengths, multiple=multiple):
            lengths.append(x.shape[1])
            expect(
                x.shape[0] == 2 and x.shape[2] == 3,
                (
                    f"the network was given {tuple(x.shape)}: "
                    "add the zeros to the frames, axis 1 of (B, T, D)"
                ),
            )
            expect(
                x.shape[1] % multiple == 0,
                (
                    f"the network was given {x.shape[1]} frames, no multiple of {multiple}: "
                    "pad with zeros before you call it"
                ),
            )
            return sums(x)

        got = torch.as_tensor(mine(network, x, multiple))
        more = -(-T // multiple) * multiple
        whole = sums(F.pad(x, (0, 0, 0, more - T)))
        late = sums(F.pad(x, (0, 0, more - T, 0)))
        held = sums(torch.cat([x, x[:, -1:].expand(-1, more - T, -1)], 1))[:, :T]
        moved = "add the zeros after the motion: before it, they move every frame to another time"
        expect(bool(lengths), "the network was not called at all")
        expect(
            got.shape[1] >= T,
            f"{T} frames came in and {got.shape[1]} came out: the last ones are missing",
        )
        expect(
            got.shape[1] == T,
            f"{T} frames came in and {got.shape[1]} came out: cut off what you added",
        )
        expect(lengths[-1] == more, f"{T} frames need {more - T} more, not {lengths[-1] - T}")
        mistakes = {
            moved: late[:, :T],
            f"{moved}, even if you cut them off again": late[:, more - T :],
            "cut off at the end, not at the start": whole[:, more - T :],
            "pad with zeros: copies of the last frame mean that the dancer freezes": held,
        }
        expect_close(
            got, sums(x), f"the output for {T} frames and multiples of {multiple}", mistakes
        )
    return (
        "The library also masks the added frames, "
        "so that attention and convolutions never see them."
    )


@check
def clocks(mine):
    """mine(q, k, fps_q, fps_k, f) against cosines of the time differences."""
    q, k = _numbers(5, 4), _numbers(7, 4, seed=1)  # 5 frames, 7 tokens, two pairs
    fps_q = 20.0
    fps_k = 15.625
    f = torch.tensor([0.3, 2.0])

    def weights(t, u, root=2.0, softmax=-1):
        """Pair by pair as complex numbers.

        The score of q and k is the real part of q conj(k) e^(i angle).
        """
        a = torch.complex(q[:, :2], q[:, 2:])
        b = torch.complex(k[:, :2], k[:, 2:])
        phase = torch.exp(1j * (t[:, None, None] - u[None, :, None]) * f)
        scores = (a[:, None] * b.conj()[None] * phase).real.sum(-1) / root
        return scores if softmax is None else scores.softmax(softmax)

    n = torch.arange(5.0)
    m = torch.arange(7.0)
    turn = 2 * math.pi
    t, u = turn * n / fps_q, turn * m / fps_k
    mistakes = {
        (
            "these are indices: divide each by its own rate, "
            "because only seconds mean the same on both sides"
        ): weights(turn * n, turn * m),
        "both sides use the motion's rate; the tokens have their own": weights(t, turn * m / fps_q),
        "both sides use the tokens' rate; the motion has its own": weights(turn * n / fps_k, u),
        "frame n is at n / fps seconds: divide by the rate": weights(
            turn * n * fps_q, turn * m * fps_k
        ),
        "the rates are swapped": weights(turn * n / fps_k, turn * m / fps_q),
        "only the queries are turned": weights(t, 0 * u),
        "only the keys are turned": weights(0 * t, u),
        "queries and keys are turned in opposite directions: turn both the same way": weights(
            t, -u
        ),
        "a whole turn is 2 pi": weights(t / turn, u / turn),
        "the scores are not divided by the root of d": weights(t, u, root=1.0),
        "divide by the root of d, not by d": weights(t, u, root=4.0),
        "the softmax runs over the wrong axis: each query's weights must sum to one": weights(
            t, u, softmax=0
        ),
        "these are scores; where is the softmax?": weights(t, u, softmax=None),
        "nothing was turned": weights(0 * t, 0 * u),
    }
    expect_close(
        mine(q, k, fps_q, fps_k, f),
        weights(t, u),
        "the weights of 5 frames over 7 tokens",
        mistakes,
    )
    return (
        "A minute later on both clocks, every weight is the same: only the time difference counts."
    )
