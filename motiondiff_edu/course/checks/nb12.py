"""Checks of notebook 12.

A frame convolution, motions of any length, and attention between two clocks.
"""

import math

import numpy as np
import torch
from torch.nn import functional as F

from ._compare import compare
from ._drawn import tensors
from ._report import check, expect
from .zoo.nb12 import MISTAKES


def _motions(rng: np.random.Generator):
    """Frames of 2 numbers in, of 4 out; others; odd and even lengths."""
    for T, W, out, stride in ((7, 2, 4, 1), (7, 2, 4, 2), (8, 3, 2, 2), (5, 1, 3, 1), (9, 2, 2, 3)):
        yield tensors(rng, T, W), tensors(rng, out, 3 * W), tensors(rng, out), stride


def by_torch(x, weight, bias, stride: int) -> torch.Tensor:
    """PyTorch's conv1d."""
    kernel = weight.unflatten(1, (3, x.shape[1])).transpose(1, 2)
    return F.conv1d(x.T[None], kernel, bias, stride=stride, padding=1)[0].T


@check
def frame_conv(mine):
    """mine(x, weight, bias, stride) against PyTorch's conv1d."""
    compare(mine, by_torch, _motions, "the output", MISTAKES["frame_conv"])
    return "Three frames go in, one comes out. All use the same weights: so any length will do."


class _Network:
    """Depends on each frame's place and on all other frames; takes multiples only."""

    def __init__(self, multiple: int, shape: tuple[int, ...]):
        self.multiple, self.shape = multiple, shape

    def __call__(self, x):
        B, _, D = self.shape
        expect(
            x.ndim == 3 and (x.shape[0], x.shape[2]) == (B, D),
            f"the network was given {tuple(x.shape)}: "
            "add the zeros to the frames, axis 1 of (B, T, D)",
        )
        expect(
            x.shape[1] % self.multiple == 0,
            f"the network was given {x.shape[1]} frames, no multiple of {self.multiple}: "
            "pad with zeros before you call it",
        )
        return x.cumsum(1) + x.sum(1, keepdim=True) + torch.arange(x.shape[1])[:, None]


def _lengths(rng: np.random.Generator):
    """One frame missing, none, seven; other multiples."""
    for T, multiple in ((13, 8), (16, 8), (1, 8), (3, 4), (13, 5)):
        x = tensors(rng, 2, T, 3)
        yield _Network(multiple, tuple(x.shape)), x, multiple


def filled_up(network, x, multiple: int) -> torch.Tensor:
    """Zero frames are added one by one until it fits."""
    frames = list(x.unbind(1))
    while len(frames) % multiple:
        frames.append(torch.zeros_like(frames[0]))
    return torch.stack(network(torch.stack(frames, 1)).unbind(1)[: x.shape[1]], 1)


@check
def any_length(mine):
    """mine(network, x, multiple): as many frames come out as came in."""
    compare(mine, filled_up, _lengths, "the output for any length", MISTAKES["any_length"])
    return (
        "The library also masks the added frames, "
        "so that attention and convolutions never see them."
    )


def _clocks(rng: np.random.Generator):
    """5 frames and 7 tokens with two pairs each; others."""
    yield tensors(rng, 5, 4), tensors(rng, 7, 4), 20.0, 15.625, torch.tensor([0.3, 2.0])
    f = torch.from_numpy(rng.uniform(0.1, 3.0, size=3))
    yield tensors(rng, 6, 6), tensors(rng, 4, 6), 20.0, 31.25, f
    yield tensors(rng, 3, 6), tensors(rng, 8, 6), 30.0, 12.0, f


def as_complex(q, k, fps_q: float, fps_k: float, f) -> torch.Tensor:
    """Pair by pair: the score of q and k is the real part of q conj(k) e^(i angle)."""
    half = q.shape[1] // 2
    a, b = torch.complex(q[:, :half], q[:, half:]), torch.complex(k[:, :half], k[:, half:])
    apart = torch.arange(len(q))[:, None] / fps_q - torch.arange(len(k)) / fps_k
    phase = torch.exp(2j * math.pi * apart[..., None] * f)
    scores = (a[:, None] * b.conj()[None] * phase).real.sum(-1)
    return (scores / math.sqrt(q.shape[1])).softmax(1)


@check
def clocks(mine):
    """mine(q, k, fps_q, fps_k, f) against cosines of the time differences."""
    compare(mine, as_complex, _clocks, "the weights of frames over tokens", MISTAKES["clocks"])
    return (
        "A minute later on both clocks, every weight is the same: only the time difference counts."
    )
