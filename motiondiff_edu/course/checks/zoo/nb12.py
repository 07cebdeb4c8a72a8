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


def _rolled(x, weight, bias, stride):
    return (torch.cat([x.roll(1, 0), x, x.roll(-1, 0)], -1) @ weight.T + bias)[::stride]


def _filled(x, multiple):
    return F.pad(x, (0, 0, 0, -x.shape[1] % multiple))


def _weights(q, k, t, u, f, root=True, axis=-1):
    q, k = (rotary(x, 2 * math.pi * times[:, None] * f) for x, times in ((q, t), (k, u)))
    scores = q @ k.T / (math.sqrt(q.shape[-1]) if root else 1.0)
    return scores if axis is None else scores.softmax(axis)


def _times(x, fps):
    return torch.arange(len(x)) / fps


ZOO = {
    "frame_conv": {
        "the future only": lambda x, w, b, stride: _mix(x, w, b, (0, 1, 2), stride),
        "the past only": lambda x, w, b, stride: _mix(x, w, b, (-2, -1, 0), stride),
        "before and after exchanged": lambda x, w, b, stride: _mix(x, w, b, (1, 0, -1), stride),
        "wraps around": _rolled,
        "bias forgotten": lambda x, w, b, stride: _mix(x, w, 0 * b, (-1, 0, 1), stride),
        "stride forgotten": lambda x, w, b, stride: _mix(x, w, b, (-1, 0, 1)),
        "halving begins with the second frame": lambda x, w, b, s: _mix(x, w, b, (-1, 0, 1))[
            s - 1 :: s
        ],
        "halving drops the last frame": lambda x, w, b, s: _mix(x, w, b, (-1, 0, 1), s)[
            : len(x) // s
        ],
        "every second frame before its neighbours": lambda x, w, b, stride: _mix(
            x[::stride], w, b, (-1, 0, 1)
        ),
        "the ends repeated": lambda x, w, b, s: _mix(
            torch.cat([x[:1], x, x[-1:]]), w, b, (-1, 0, 1)
        )[1:-1:s],
        "channel by channel": lambda x, w, b, s: (
            F.pad(x, (0, 0, 1, 1)).unfold(0, 3, 1).flatten(1) @ w.T + b
        )[::s],
        "no zeros beyond the ends": lambda x, w, b, stride: _mix(x, w, b, (-1, 0, 1))[1:-1:stride],
    },
    "any_length": {
        "not filled up": lambda network, x, multiple: network(x),
        "the last frames dropped": lambda network, x, multiple: network(
            x[:, : x.shape[1] // multiple * multiple]
        ),
        "not cropped": lambda network, x, multiple: network(_filled(x, multiple)),
        "filled up in front": lambda network, x, multiple: network(
            F.pad(x, (0, 0, -x.shape[1] % multiple, 0))
        )[:, : x.shape[1]],
        "filled up and cropped in front": lambda network, x, multiple: network(
            F.pad(x, (0, 0, -x.shape[1] % multiple, 0))
        )[:, -x.shape[1] :],
        "eights whatever was asked": lambda network, x, multiple: network(_filled(x, 8))[
            :, : x.shape[1]
        ],
        "filled up with the last frame": lambda network, x, multiple: network(
            torch.cat([x, x[:, -1:].expand(-1, -x.shape[1] % multiple, -1)], 1)
        )[:, : x.shape[1]],
        "the features filled up": lambda network, x, multiple: network(
            F.pad(x, (0, -x.shape[1] % multiple))
        )[:, : x.shape[1]],
        "cropped in front": lambda network, x, multiple: network(_filled(x, multiple))[
            :, -x.shape[1] :
        ],
        "a whole multiple too many": lambda network, x, multiple: network(
            F.pad(x, (0, 0, 0, multiple - x.shape[1] % multiple))
        )[:, : x.shape[1]],
    },
    "clocks": {
        "indices instead of seconds": lambda q, k, a, b, f: _weights(
            q, k, _times(q, 1), _times(k, 1), f
        ),
        "one clock for both": lambda q, k, a, b, f: _weights(q, k, _times(q, a), _times(k, a), f),
        "the tokens' clock for both": lambda q, k, a, b, f: _weights(
            q, k, _times(q, b), _times(k, b), f
        ),
        "times the rate": lambda q, k, a, b, f: _weights(
            q, k, _times(q, 1 / a), _times(k, 1 / b), f
        ),
        "rates exchanged": lambda q, k, a, b, f: _weights(q, k, _times(q, b), _times(k, a), f),
        "only the queries turned": lambda q, k, a, b, f: _weights(
            q, k, _times(q, a), 0 * _times(k, b), f
        ),
        "turned against one another": lambda q, k, a, b, f: _weights(
            q, k, _times(q, a), -_times(k, b), f
        ),
        "two pi dropped": lambda q, k, a, b, f: _weights(
            q, k, _times(q, a), _times(k, b), f / (2 * math.pi)
        ),
        "root dropped": lambda q, k, a, b, f: _weights(
            q, k, _times(q, a), _times(k, b), f, root=False
        ),
        "softmax over the queries": lambda q, k, a, b, f: _weights(
            q, k, _times(q, a), _times(k, b), f, axis=0
        ),
        "no softmax": lambda q, k, a, b, f: _weights(
            q, k, _times(q, a), _times(k, b), f, axis=None
        ),
    },
}
