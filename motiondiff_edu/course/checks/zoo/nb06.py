"""Wrong answers to the exercises of notebook 06."""

import math

from ....cross_modal_attention import relative_position_bucket


def _scores(q, k):
    return q @ k.T / math.sqrt(q.shape[-1])


def _look_up(table, distance):
    return table[relative_position_bucket(distance)].permute(2, 0, 1)


ZOO = {
    "attention_with_bias": {
        "root dropped": lambda q, k, v, bias: (q @ k.T + bias).softmax(-1) @ v,
        "divided by d": lambda q, k, v, bias: (q @ k.T / q.shape[-1] + bias).softmax(-1) @ v,
        "root of the number of keys": lambda q, k, v, bias: (
            (q @ k.T / math.sqrt(len(k)) + bias).softmax(-1) @ v
        ),
        "softmax over the queries": lambda q, k, v, bias: (_scores(q, k) + bias).softmax(0) @ v,
        "bias after the softmax": lambda q, k, v, bias: (_scores(q, k).softmax(-1) + bias) @ v,
        "bias divided too": lambda q, k, v, bias: (
            ((q @ k.T + bias) / math.sqrt(q.shape[-1])).softmax(-1) @ v
        ),
        "bias forgotten": lambda q, k, v, bias: _scores(q, k).softmax(-1) @ v,
        "no softmax": lambda q, k, v, bias: (_scores(q, k) + bias) @ v,
        "weights returned": lambda q, k, v, bias: (_scores(q, k) + bias).softmax(-1),
    },
    "split_into_heads": {
        "plain reshape": lambda x, heads: x.reshape(x.shape[0], heads, x.shape[1], -1),
        "channels interleaved": lambda x, heads: x.unflatten(-1, (-1, heads)).permute(0, 3, 1, 2),
        "heads after frames": lambda x, heads: x.unflatten(-1, (heads, -1)),
        "heads and channels swapped": lambda x, heads: x.unflatten(-1, (heads, -1)).permute(
            0, 3, 1, 2
        ),
    },
    "relative_bias": {
        "query minus key": lambda table, query, key: _look_up(table, query[:, None] - key[None]),
        "absolute distance": lambda table, query, key: _look_up(
            table, (key[None] - query[:, None]).abs()
        ),
        "rows and columns swapped": lambda table, query, key: _look_up(
            table, key[:, None] - query[None]
        ),
        "heads last": lambda table, query, key: table[
            relative_position_bucket(key[None] - query[:, None])
        ],
        "no buckets": lambda table, query, key: table[(key[None] - query[:, None]) % 32].permute(
            2, 0, 1
        ),
    },
}
