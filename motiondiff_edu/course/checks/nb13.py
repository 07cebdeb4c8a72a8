"""Checks of notebook 13.

The clean guess, the skeleton loss, and the asymmetry from the network's own numbers.
"""

import torch

from ._report import check, expect_close


@check
def x0_hat(mine):
    """Check mine(x_s, s, eps_hat, alpha_bar).

    With the right eps_hat the result is x0. Each sample has its own step.
    """
    # a, b by step: (1, 0), (0.8, 0.6), (0.6, 0.8), (0.28, 0.96)
    alpha_bar = torch.tensor([1.0, 0.64, 0.36, 0.0784], dtype=torch.float64)
    draw = torch.Generator().manual_seed(13)
    x0, eps = torch.randn(2, 2, 5, 3, generator=draw, dtype=torch.float64)
    s = torch.tensor([1, 2])
    a = torch.tensor([0.8, 0.6]).double()[:, None, None]
    b = torch.tensor([0.6, 0.8]).double()[:, None, None]
    x_s = a * x0 + b * eps
    mistakes = {
        "the second alpha_bar needs its index as well; this takes the last of the table": x_s / a
        - 0.96 / 0.28 * eps,
        "this uses the last alpha_bar everywhere; look up the one of each sample's step": (
            x_s - 0.96 * eps
        )
        / 0.28,
        "this takes the alpha_bar of one step earlier; the table begins at s = 0": torch.stack(
            [x_s[0], (x_s[1] - 0.6 * eps[1]) / 0.8]
        ),
        "every sample has its own step; this uses the first one's for all": (x_s - 0.6 * eps) / 0.8,
        "the square roots are missing": x_s / a**2 - (b / a) ** 2 * eps,
        "the first root is missing": x_s / a**2 - b / a * eps,
        "divide both x_s and the noise by the root of alpha_bar, not x_s alone": x_s / a - b * eps,
        "the root of 1 / alpha_bar - 1 is missing": x_s / a - (b / a) ** 2 * eps,
        "the noise was added, so it is subtracted": x_s / a + b / a * eps,
        "undo the mixing completely: the signal was scaled down, too": x_s - b * eps,
    }
    expect_close(mine(x_s, s, eps, alpha_bar), x0, "x0_hat of a right eps_hat", mistakes)
    return "An error of eps_hat becomes b / a times as large here, and b / a has no upper limit."


@check
def skeleton_loss(mine):
    """mine(lengths) of one motion (T, K); expected values by hand, and from torch.var."""
    lengths = torch.tensor(
        [[2.0, 5.0, 3.5], [1.0, 2.0, 4.0], [3.0, 2.0, 4.5], [2.0, 3.0, 4.0], [2.0, 3.0, 4.0]]
    )
    # bone 0: 2 / 4, bone 1: 6 / 4, bone 2: 0.5 / 4
    wanted = torch.tensor((0.5 + 1.5 + 0.125) / 3)
    off = lengths - lengths.mean(0)
    mistakes = {
        (
            "this is the variance over the bones of a frame; bones may differ, but not over time"
        ): lengths.var(1).mean(),
        "divide by the number of frames minus one": lengths.var(0, correction=0).mean(),
        "this is the standard deviation; equation 6 has no root": lengths.std(0).mean(),
        "average over the bones, do not add them up": lengths.var(0).sum(),
        "this is the variance of all lengths together; each bone has a mean of its own": (
            lengths.var()
        ),
        "there is one mean for all bones here: each bone has a mean of its own": (
            (lengths - lengths.mean()) ** 2
        )
        .sum(0)
        .mean()
        / 4,
        "the mean over the bones is missing: this is one number for each bone": lengths.var(0),
        "these are squared lengths; take the length itself": (lengths**2).var(0).mean(),
        "this compares with the first frame; compare with the mean": ((lengths - lengths[0]) ** 2)
        .sum(0)
        .mean()
        / 4,
        "the deviations are not squared": off.abs().sum(0).mean() / 4,
        "this compares each frame with the next; compare with the mean": (
            lengths.diff(dim=0) ** 2
        ).mean(),
    }
    expect_close(mine(lengths), wanted, "L_s of a motion of 5 frames and 3 bones", mistakes)
    still = torch.tensor([[0.4, 0.1]]).repeat(7, 1)
    expect_close(mine(still), torch.tensor(0.0), "L_s of bones that never change")
    return "A bone that is always too long costs nothing here: another loss has to notice it."


@check
def asymmetry_from_features(mine):
    """Check mine(x0_hat, mean, std, bones, pairs).

    Five joints in two frames; the lengths are those of 3-4-5 triangles.
    """
    bones, pairs = ((0, 1), (1, 2), (0, 3), (3, 4)), ((0, 2), (1, 3))
    # pelvis in the world, then left hip, left knee, right hip, right knee minus the pelvis; metres
    about = torch.tensor(
        [
            [[0.5, 1, 2], [0.3, -0.4, 0], [0.3, -1.4, 0], [-0.6, -0.8, 0], [-0.6, -0.8, 1.5]],
            [[0.0, 1, 3], [0.0, -0.6, 0.8], [0.0, -0.6, 2.0], [0.0, -0.5, 0.0], [1.2, -0.5, 0.0]],
        ],
        dtype=torch.float64,
    )
    # left: 0.5, 1.0 and 1.0, 1.2; right: 1.0, 1.5 and 0.5, 1.2
    wanted = torch.tensor((0.5 + 0.5 + 0.5 + 0.0) / 4)
    flat = about.flatten(1)
    mean = torch.linspace(-0.4, 0.9, 15).double()
    std = torch.linspace(0.2, 0.7, 15).double()
    x0_hat = (flat - mean) / std
    world = torch.cat([about[:, :1], about[:, 1:] + about[:, :1]], 1)
    lengths = _lengths(world, bones)
    unscaled = x0_hat.unflatten(1, (5, 3))
    in_std = torch.cat([unscaled[:, :1], unscaled[:, 1:] + unscaled[:, :1]], 1)
    gap = lengths[:, [0, 1]] - lengths[:, [2, 3]]
    mistakes = {
        "these lengths are in standardised units; go back to metres first": _asymmetry(
            _lengths(in_std, bones), pairs
        ),
        "these are standardised units without the pelvis: first metres, then the pelvis": (
            _asymmetry(_lengths(unscaled, bones), pairs)
        ),
        "only half-way back to metres: the mean is missing": _asymmetry(
            _lengths(_placed((x0_hat * std).unflatten(1, (5, 3))), bones), pairs
        ),
        (
            "the pelvis is not added to the other joints, or is added to itself as well: "
            "bones at the pelvis come out wrong"
        ): _asymmetry(_lengths(about, bones), pairs),
        "only half-way back to metres: the std is missing": _asymmetry(
            _lengths(_placed((x0_hat + mean).unflatten(1, (5, 3))), bones), pairs
        ),
        "the mean is missing, and the pelvis is not added": _asymmetry(
            _lengths((x0_hat * std).unflatten(1, (5, 3)), bones), pairs
        ),
        "the pelvis is left at the origin while the others are moved": _asymmetry(
            _lengths(torch.cat([0 * about[:, :1], world[:, 1:]], 1), bones), pairs
        ),
        "this compares left bones with left ones": (lengths[:, 0] - lengths[:, 1]).abs().mean(),
        "left and right are paired the wrong way: follow `pairs`": (
            (lengths[:, [0, 2]] - lengths[:, [1, 3]]).abs().mean()
        ),
        "the signs must not cancel: take the absolute value of each difference": gap.mean(),
        "the signs must not cancel: take absolute values before the mean": gap.mean().abs(),
        "L_a is in metres: the difference itself, not its square": gap.square().mean(),
        "take the mean over pairs and frames, not the sum": gap.abs().sum(),
        "take the mean over the pairs as well, not the sum": gap.abs().sum(1).mean(),
        "take the mean over the frames as well, not the sum": gap.abs().sum(0).mean(),
    }
    expect_close(mine(x0_hat, mean, std, bones, pairs), wanted, "L_a of two frames", mistakes)
    return (
        "Bone lengths are in metres, so the network's output must be "
        "converted to metres before they can be measured."
    )


def _placed(about):
    return torch.cat([about[:, :1], about[:, 1:] + about[:, :1]], 1)


def _lengths(joints, bones):
    return torch.stack(
        [(joints[:, child] - joints[:, parent]).norm(dim=-1) for parent, child in bones], 1
    )


def _asymmetry(lengths, pairs):
    return torch.stack([(lengths[:, i] - lengths[:, j]).abs() for i, j in pairs], 1).mean()
