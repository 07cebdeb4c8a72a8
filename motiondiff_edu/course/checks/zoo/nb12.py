"""Wrong answers to the exercises of notebook 12."""

import math

import torch
from torch.nn import functional as F

from ....cross_modal_attention import rotary


def _mix(x, weight, bias, offsets, stride=1):
    """Frames at these offsets side by side, zeros beyond the ends, through the weights."""
    reach = max(abs(by) for by in offsets)
    padded = F.pad(x, (0, 0, reach, reach))
    parts = [padded[reach + by : reach + by + len(x)] for by in offsets]
    return (torch.cat(parts, -1) @ weight.T + bias)[::stride]


def _at(*offsets):
    return lambda x, w, b, stride: _mix(x, w, b, offsets, stride)


def _rolled(x, weight, bias, stride):
    return (torch.cat([x.roll(1, 0), x, x.roll(-1, 0)], -1) @ weight.T + bias)[::stride]


def _ends_repeated(x, w, b, stride):
    return _mix(torch.cat([x[:1], x, x[-1:]]), w, b, (-1, 0, 1))[1:-1][::stride]


def _by_channel(x, w, b, stride):
    return (F.pad(x, (0, 0, 1, 1)).unfold(0, 3, 1).flatten(1) @ w.T + b)[::stride]


def _last_dropped(x, w, b, stride):
    return _mix(x, w, b, (-1, 0, 1), stride)[: len(x) // stride]


def _means(x, w, b, stride):
    """Averages neighbours where every second one is kept."""
    whole = _mix(x, w, b, (-1, 0, 1))
    if stride == 1:
        return whole
    return torch.stack([whole[i : i + stride].mean(0) for i in range(0, len(whole), stride)])


def _filled(x, multiple):
    return F.pad(x, (0, 0, 0, -x.shape[1] % multiple))


def _held(x, multiple):
    return torch.cat([x, x[:, -1:].expand(-1, -x.shape[1] % multiple, -1)], 1)


def _front(x, multiple):
    return F.pad(x, (0, 0, -x.shape[1] % multiple, 0))


def _turned(x, times, f):
    return rotary(x, 2 * math.pi * times[:, None] * f)


def _times(x, fps):
    return torch.arange(len(x)) / fps


def _clocks(t, u, root=lambda d: math.sqrt(d), axis=-1, turn=1.0):
    """The right weights, but for times of queries and keys, as functions of (q, k, fps, fps)."""

    def answer(q, k, fps_q, fps_k, f):
        at, to = t(q, k, fps_q, fps_k), u(q, k, fps_q, fps_k)
        scores = _turned(q, at * turn, f) @ _turned(k, to * turn, f).T / root(q.shape[-1])
        return scores if axis is None else scores.softmax(axis)

    return answer


def _own_q(q, k, fps_q, fps_k):
    return _times(q, fps_q)


def _own_k(q, k, fps_q, fps_k):
    return _times(k, fps_k)


def _cropped(network, x, multiple):
    return network(_filled(x, multiple))[:, : x.shape[1]]


MISTAKES = {
    "frame_conv": {
        "this looks into the future only: the middle third of the weights belongs to the frame "
        "itself": _at(0, 1, 2),
        "this looks into the past only: the middle third of the weights belongs to the frame "
        "itself": _at(-2, -1, 0),
        "the frames before and after are swapped: the first third of the weights belongs to the "
        "frame before": _at(1, 0, -1),
        "the frame itself is in the wrong place: before, itself, after": (
            _at(0, -1, 1),
            _at(-1, 1, 0),
        ),
        "this wraps around: before the first frame there are zeros, not the last frame": _rolled,
        "beyond both ends there are zeros, not copies of the first and the last frame": (
            _ends_repeated
        ),
        "these columns are ordered by channel; the weights expect one whole frame, then the next": (
            _by_channel
        ),
        "the bias is missing": lambda x, w, b, stride: _mix(x, w, 0 * b, (-1, 0, 1), stride),
        "you subtracted the bias; add it": lambda x, w, b, stride: _mix(
            x, w, -b, (-1, 0, 1), stride
        ),
        "keep every second frame, and begin with the *first* one": (
            lambda x, w, b, stride: _mix(x, w, b, (-1, 0, 1))[stride - 1 :: stride],
            lambda x, w, b, stride: _mix(x, w, b, (-1, 0, 1))[1::stride],
        ),
        "the stride is not used": lambda x, w, b, stride: _mix(x, w, b, (-1, 0, 1)),
        "take the neighbours first, then every second result: here the frames between are never "
        "used": lambda x, w, b, stride: _mix(x[::stride], w, b, (-1, 0, 1)),
        "the last frame is missing: every second one of 7 frames makes 4": _last_dropped,
        "every second result is kept as it is, not averaged with the next": _means,
        "the ends are missing: zeros before the first and after the last frame": (
            lambda x, w, b, stride: _mix(x, w, b, (-1, 0, 1))[1:-1][::stride]
        ),
        "`stride` is an argument: this always keeps every second frame": lambda x, w, b, stride: (
            _mix(x, w, b, (-1, 0, 1), 2)
        ),
    },
    "any_length": {
        "add the zeros after the motion: before it, they move every frame to another time": (
            lambda network, x, multiple: network(_front(x, multiple))[:, : x.shape[1]]
        ),
        "add the zeros after the motion, even if you cut them off again: before it, they move "
        "every frame to another time": (
            lambda network, x, multiple: network(_front(x, multiple))[:, -x.shape[1] :]
        ),
        "cut off at the end, not at the start": lambda network, x, multiple: network(
            _filled(x, multiple)
        )[:, -x.shape[1] :],
        "pad with zeros: copies of the last frame mean that the dancer freezes": (
            lambda network, x, multiple: network(_held(x, multiple))[:, : x.shape[1]]
        ),
        "the last frames are missing: pad to a multiple, do not cut down to one": (
            lambda network, x, multiple: network(x[:, : x.shape[1] // multiple * multiple])
        ),
        "cut off what you added: as many frames come out as came in": (
            lambda network, x, multiple: network(_filled(x, multiple))
        ),
    },
    "clocks": {
        "these are indices: divide each by its own rate, because only seconds mean the same on "
        "both sides": _clocks(lambda q, k, a, b: _times(q, 1), lambda q, k, a, b: _times(k, 1)),
        "both sides use the motion's rate; the tokens have their own": _clocks(
            _own_q, lambda q, k, a, b: _times(k, a)
        ),
        "both sides use the tokens' rate; the motion has its own": _clocks(
            lambda q, k, a, b: _times(q, b), _own_k
        ),
        "frame n is at n / fps seconds: divide by the rate": _clocks(
            lambda q, k, a, b: _times(q, 1 / a), lambda q, k, a, b: _times(k, 1 / b)
        ),
        "the rates are swapped": _clocks(
            lambda q, k, a, b: _times(q, b), lambda q, k, a, b: _times(k, a)
        ),
        "only the queries are turned": _clocks(_own_q, lambda q, k, a, b: 0 * _times(k, b)),
        "only the keys are turned": _clocks(lambda q, k, a, b: 0 * _times(q, a), _own_k),
        "nothing was turned": _clocks(
            lambda q, k, a, b: 0 * _times(q, a), lambda q, k, a, b: 0 * _times(k, b)
        ),
        "queries and keys are turned in opposite directions: turn both the same way": _clocks(
            _own_q, lambda q, k, a, b: -_times(k, b)
        ),
        "both are turned backwards: turn them by plus the angle": _clocks(
            _own_q, _own_k, turn=-1.0
        ),
        "a whole turn is 2 pi": _clocks(_own_q, _own_k, turn=1 / (2 * math.pi)),
        "a whole turn is 2 pi, not pi": _clocks(_own_q, _own_k, turn=0.5),
        "the scores are not divided by the root of d": _clocks(_own_q, _own_k, root=lambda d: 1.0),
        "divide by the root of d, not by d": _clocks(_own_q, _own_k, root=lambda d: d),
        "d is the number of entries of a query, not of its pairs": _clocks(
            _own_q, _own_k, root=lambda d: math.sqrt(d / 2)
        ),
        "the softmax runs over the wrong axis: each query's weights must sum to one": _clocks(
            _own_q, _own_k, axis=0
        ),
        "these are scores; where is the softmax?": _clocks(_own_q, _own_k, axis=None),
        "the first frame is at 0 seconds": (
            _clocks(lambda q, k, a, b: (torch.arange(len(q)) + 1) / a, _own_k),
            _clocks(_own_q, lambda q, k, a, b: (torch.arange(len(k)) + 1) / b),
        ),
    },
}
OTHERS = {
    "any_length": {
        "not filled up": lambda network, x, multiple: network(x),
        "the features filled up": lambda network, x, multiple: network(
            F.pad(x, (0, -x.shape[1] % multiple))
        )[:, : x.shape[1]],
        "the network left out": lambda network, x, multiple: x.clone(),
        "eights whatever was asked": lambda network, x, multiple: _cropped(network, x, 8),
    }
}
