"""Checks of notebook 13.

The clean guess, the skeleton loss, and the asymmetry from the network's own numbers.
"""

import math

import numpy as np
import torch

from ._compare import compare
from ._drawn import schedule, tensors
from ._report import check
from .zoo.nb13 import MISTAKES


def _guesses(rng: np.random.Generator):
    """Steps with round roots, (.8, .6) and (.6, .8); others. Each sample has its own step."""
    alpha_bar = torch.tensor([1.0, 0.64, 0.36, 0.0784], dtype=torch.float64)
    yield tensors(rng, 2, 5, 3), torch.tensor([1, 2]), tensors(rng, 2, 5, 3), alpha_bar
    for B, T, D in ((4, 3, 2), (3, 2, 5)):
        s = torch.from_numpy(rng.permutation(6)[:B] + 1)
        yield tensors(rng, B, T, D), s, tensors(rng, B, T, D), schedule(rng, 7)


def unmixed(x_s, s, eps_hat, alpha_bar) -> torch.Tensor:
    """Sample by sample: the x0 that gives x_s with this noise (equation 2, solved)."""
    shares = [float(alpha_bar[int(step)]) for step in s]
    return torch.stack(
        [(x_s[i] - (1 - a) ** 0.5 * eps_hat[i]) / a**0.5 for i, a in enumerate(shares)]
    )


@check
def x0_hat(mine):
    """mine(x_s, s, eps_hat, alpha_bar)."""
    compare(mine, unmixed, _guesses, "x0_hat", MISTAKES["x0_hat"])
    return "An error of eps_hat becomes b / a times as large here, and b / a has no upper limit."


def _bones(rng: np.random.Generator):
    """Round lengths; bones that never change; others."""
    yield (
        torch.tensor(
            [[2.0, 5.0, 3.5], [1.0, 2.0, 4.0], [3.0, 2.0, 4.5], [2.0, 3.0, 4.0], [2.0, 3.0, 4.0]]
        ),
    )
    yield (torch.tensor([[0.4, 0.1]]).repeat(7, 1),)
    yield (tensors(rng, 6, 4).abs(),)


def variances(lengths) -> float:
    """numpy's variance of each bone, over frames minus one."""
    return float(np.mean([np.var(bone, ddof=1) for bone in lengths.numpy().T]))


@check
def skeleton_loss(mine):
    """mine(lengths) of one motion (T, K)."""
    compare(mine, variances, _bones, "L_s", MISTAKES["skeleton_loss"])
    return "A bone that is always too long costs nothing here: another loss has to notice it."


def _figures(rng: np.random.Generator):
    """Lengths of 3-4-5 triangles; then others, with a bone that has no partner."""
    bones, pairs = ((0, 1), (1, 2), (0, 3), (3, 4)), ((0, 2), (1, 3))
    about = torch.tensor(
        [
            [[0.5, 1, 2], [0.3, -0.4, 0], [0.3, -1.4, 0], [-0.6, -0.8, 0], [-0.6, -0.8, 1.5]],
            [[0.0, 1, 3], [0.0, -0.6, 0.8], [0.0, -0.6, 2.0], [0.0, -0.5, 0.0], [1.2, -0.5, 0.0]],
        ],
        dtype=torch.float64,
    )
    mean = torch.linspace(-0.4, 0.9, 15).double()
    std = torch.linspace(0.2, 0.7, 15).double()
    yield (about.flatten(1) - mean) / std, mean, std, bones, pairs
    bones = ((0, 5), (0, 1), (1, 2), (0, 3), (3, 4), (2, 6), (4, 7))
    pairs = ((1, 3), (2, 4), (5, 6))
    yield tensors(rng, 7, 24), tensors(rng, 24), tensors(rng, 24).abs() + 0.2, bones, pairs


def bone_by_bone(x0_hat, mean, std, bones, pairs) -> float:
    """Frame by frame and pair by pair with `math.dist`."""
    gaps = []
    for row in x0_hat:
        metres = [float(x * s + m) for x, s, m in zip(row, std, mean, strict=True)]
        pelvis, *others = [metres[i : i + 3] for i in range(0, len(metres), 3)]
        joints = [pelvis, *[[p + q for p, q in zip(pelvis, one, strict=True)] for one in others]]
        lengths = [math.dist(joints[parent], joints[child]) for parent, child in bones]
        gaps += [abs(lengths[i] - lengths[j]) for i, j in pairs]
    return sum(gaps) / len(gaps)


@check
def asymmetry_from_features(mine):
    """mine(x0_hat, mean, std, bones, pairs)."""
    compare(mine, bone_by_bone, _figures, "L_a", MISTAKES["asymmetry_from_features"])
    return (
        "Bone lengths are in metres, so the network's output must be "
        "converted to metres before they can be measured."
    )
