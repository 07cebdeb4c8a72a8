"""Wrong answers to the exercises of notebook 06."""

import math

import torch

from ....cross_modal_attention import relative_position_bucket


def _attend(q, k, v, bias, divide=lambda q, k: math.sqrt(q.shape[-1]), axis=-1):
    return (q @ k.T / divide(q, k) + bias).softmax(axis) @ v


def _wrong(divide=lambda q, k: math.sqrt(q.shape[-1]), axis=-1):
    return lambda q, k, v, bias: _attend(q, k, v, bias, divide, axis)


def _scores(q, k):
    return q @ k.T / math.sqrt(q.shape[-1])


def naive_softmax(q, k, v, bias):
    """Large scores overflow: infinity by infinity."""
    weights = torch.exp(_scores(q, k) + bias)
    return weights / weights.sum(-1, keepdim=True) @ v


def no_sum(q, k, v, bias):
    """exp without the division: the weights do not sum to one."""
    return torch.exp(_scores(q, k) + bias) @ v


def bias_in_place(q, k, v, bias):
    """Right numbers, but the bias has become the scores."""
    bias += _scores(q, k)
    return bias.softmax(-1) @ v


def query_in_place(q, k, v, bias):
    """Right numbers, but the queries are divided for good."""
    q /= math.sqrt(q.shape[-1])
    return (q @ k.T + bias).softmax(-1) @ v


def _look_up(table, distance):
    return table[relative_position_bucket(distance)].permute(2, 0, 1)


def _apart(query, key):
    return key[None] - query[:, None]


MISTAKES = {
    "attention_with_bias": {
        "the scores are not divided by anything: what does their size grow with?": _wrong(
            divide=lambda q, k: 1.0
        ),
        "the scores are divided by the square root of d, not multiplied": _wrong(
            divide=lambda q, k: 1 / math.sqrt(q.shape[-1])
        ),
        "d is the size of a query, not of a value": lambda q, k, v, bias: _attend(
            q, k, v, bias, lambda q, k: math.sqrt(v.shape[-1])
        ),
        "divide by the square root of d, not by d": _wrong(divide=lambda q, k: q.shape[-1]),
        "d is the size of a query, not the number of keys or queries": (
            _wrong(divide=lambda q, k: math.sqrt(len(k))),
            _wrong(divide=lambda q, k: math.sqrt(len(q))),
        ),
        "only the scores are divided; the bias is added after that": lambda q, k, v, bias: (
            ((q @ k.T + bias) / math.sqrt(q.shape[-1])).softmax(-1) @ v
        ),
        "the softmax runs over the wrong axis: each query's weights must sum to one": _wrong(
            axis=0
        ),
        "the bias belongs inside the softmax": lambda q, k, v, bias: (
            (_scores(q, k).softmax(-1) + bias) @ v
        ),
        "the bias is added, not multiplied": lambda q, k, v, bias: (
            (_scores(q, k) * bias).softmax(-1) @ v
        ),
        "you subtracted the bias; add it": lambda q, k, v, bias: _attend(q, k, v, -bias),
        "the bias is not used": lambda q, k, v, bias: _scores(q, k).softmax(-1) @ v,
        "these are scores times values; where is the softmax?": lambda q, k, v, bias: (
            (_scores(q, k) + bias) @ v
        ),
        "these are exponentials times values; the weights of a query must sum to one": no_sum,
        "these are the weights; multiply them by the values": lambda q, k, v, bias: (
            _scores(q, k) + bias
        ).softmax(-1),
        "exp of large scores is infinite: subtract the largest first, or use softmax": (
            naive_softmax
        ),
    },
    "split_into_heads": {
        "frames and channels are mixed: split the channels, then move the heads to the front": (
            lambda x, heads: x.reshape(x.shape[0], heads, x.shape[1], -1)
        ),
        "a head owns neighbouring channels, not every third, for example": lambda x, heads: (
            x.unflatten(-1, (-1, heads)).permute(0, 3, 1, 2)
        ),
        "the channels are split correctly; the heads must come before the frames": (
            lambda x, heads: x.unflatten(-1, (heads, -1))
        ),
        "each head has width / heads channels: the last two axes are exchanged": (
            lambda x, heads: x.unflatten(-1, (heads, -1)).permute(0, 2, 3, 1),
            lambda x, heads: x.unflatten(-1, (heads, -1)).permute(0, 3, 1, 2),
        ),
        "the batch must stay in front": lambda x, heads: x.unflatten(-1, (heads, -1)).permute(
            2, 0, 1, 3
        ),
    },
    "relative_bias": {
        "the distance is the key's time minus the query's": lambda table, query, key: _look_up(
            table, -_apart(query, key)
        ),
        "before and after must differ: do not take the absolute value": (
            lambda table, query, key: _look_up(table, _apart(query, key).abs())
        ),
        "use the bucket of the distance, not the distance": lambda table, query, key: table[
            _apart(query, key) % 32
        ].permute(2, 0, 1),
        "use the frames' times; these are their indices": lambda table, query, key: _look_up(
            table, _apart(torch.arange(len(query)), torch.arange(len(key)))
        ),
        "queries are rows and keys are columns: (H, T, M)": lambda table, query, key: _look_up(
            table, _apart(query, key)
        ).transpose(1, 2),
        "the values are right; the heads must come first: (H, T, M)": lambda table, query, key: (
            table[relative_position_bucket(_apart(query, key))]
        ),
        "reshape mixes heads and frames; permute moves the axis": lambda table, query, key: table[
            relative_position_bucket(_apart(query, key))
        ].reshape(table.shape[1], len(query), len(key)),
    },
}
OTHERS = {
    "attention_with_bias": {"the bias in place": bias_in_place, "q in place": query_in_place},
    "relative_bias": {
        "key minus query, rows and columns swapped": lambda table, query, key: _look_up(
            table, _apart(key, query)
        )
    },
}
