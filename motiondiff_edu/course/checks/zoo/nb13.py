"""Wrong answers to the exercises of notebook 13."""

from itertools import pairwise

import torch


def _shape(values):
    return torch.as_tensor(values).reshape(-1, 1, 1)


def _guess(x_s, eps_hat, first, second):
    first, second = _shape(first), _shape(second)
    return x_s / first**0.5 - (1 / second - 1) ** 0.5 * eps_hat


def _from(row):
    """The shares of another row of the table for both terms."""
    return lambda x_s, s, eps_hat, alpha_bar: _guess(
        x_s, eps_hat, alpha_bar[row(s)], alpha_bar[row(s)]
    )


def _mixed(form):
    """Another form of the right shares: form(x_s, eps_hat, a, b) with a, b the two roots."""
    return lambda x_s, s, eps_hat, alpha_bar: form(
        x_s, eps_hat, _shape(alpha_bar[s]) ** 0.5, _shape(1 - alpha_bar[s]) ** 0.5
    )


def mean_over_bones(lengths):
    """Compares the bones with each other, and no body has bones of one length."""
    return ((lengths - lengths.mean(1, keepdim=True)) ** 2).sum(1).div(lengths.shape[1] - 1).mean()


def _around(lengths, mean, root=False):
    off = ((lengths - mean) ** 2).sum(0) / (len(lengths) - 1)
    return (off**0.5 if root else off).mean()


def _joints(x0_hat, mean, std, add_pelvis=True):
    joints = (x0_hat * std + mean).reshape(len(x0_hat), -1, 3)
    return torch.cat([joints[:, :1], joints[:, 1:] + joints[:, :1]], 1) if add_pelvis else joints


def _lengths(joints, bones):
    return torch.stack(
        [(joints[:, child] - joints[:, parent]).norm(dim=-1) for parent, child in bones], 1
    )


def _apart(joints, bones, pairs):
    lengths = _lengths(joints, bones)
    left, right = zip(*pairs, strict=True)
    return lengths[:, list(left)] - lengths[:, list(right)]


def _asymmetry(joints=_joints, reduce=lambda gap: gap.abs().mean(), pairs=lambda pairs: pairs):
    """The right loss, but for how joints are made, differences are reduced, or bones paired."""

    def answer(x0_hat, mean, std, bones, of):
        return reduce(_apart(joints(x0_hat, mean, std), bones, pairs(of)))

    return answer


def _pelvis_lost(x0_hat, mean, std):
    joints = _joints(x0_hat, mean, std)
    return torch.cat([0 * joints[:, :1], joints[:, 1:]], 1)


def _pelvis_doubled(x0_hat, mean, std):
    joints = _joints(x0_hat, mean, std, add_pelvis=False)
    return joints + joints[:, :1]


def by_all_bones(x0_hat, mean, std, bones, pairs):
    """Divides by the number of all bones, also of those that have no partner."""
    gap = _apart(_joints(x0_hat, mean, std), bones, pairs).abs()
    return gap.sum() / (len(gap) * len(bones))


def in_place(x0_hat, mean, std, bones, pairs):
    """The right number, but the network's output is in metres afterwards."""
    x0_hat *= std
    x0_hat += mean
    return _asymmetry()(x0_hat, 0.0, 1.0, bones, pairs)


MISTAKES = {
    "x0_hat": {
        "the second alpha_bar needs its index as well; this takes the last of the table": (
            lambda x_s, s, eps_hat, alpha_bar: _guess(x_s, eps_hat, alpha_bar[s], alpha_bar[-1])
        ),
        "this uses the last alpha_bar everywhere; look up the one of each sample's step": _from(
            lambda s: [-1]
        ),
        "this takes the alpha_bar of one step earlier; the table begins at s = 0": _from(
            lambda s: s - 1
        ),
        "every sample has its own step; this uses the first one's for all": _from(lambda s: s[:1]),
        "the square roots are missing": _mixed(lambda x, e, a, b: x / a**2 - (b / a) ** 2 * e),
        "the first root is missing": _mixed(lambda x, e, a, b: x / a**2 - b / a * e),
        "divide both x_s and the noise by the root of alpha_bar, not x_s alone": _mixed(
            lambda x, e, a, b: x / a - b * e
        ),
        "divide both x_s and the noise by the root of alpha_bar, not the noise alone": _mixed(
            lambda x, e, a, b: x - b / a * e
        ),
        "the root of 1 / alpha_bar - 1 is missing": _mixed(
            lambda x, e, a, b: x / a - (b / a) ** 2 * e
        ),
        "the noise was added, so it is subtracted": _mixed(lambda x, e, a, b: x / a + b / a * e),
        "undo the mixing completely: the signal was scaled down, too": _mixed(
            lambda x, e, a, b: x - b * e
        ),
        "the root of 1 - alpha_bar is missing": _mixed(lambda x, e, a, b: x / a - b**2 / a * e),
        "divide by the root of alpha_bar; this multiplies by it": (
            _mixed(lambda x, e, a, b: a * (x - b * e)),
            _mixed(lambda x, e, a, b: a * x - b / a * e),
        ),
        "signal and noise are swapped: a is the root of alpha_bar, b that of 1 - alpha_bar": _mixed(
            lambda x, e, a, b: (x - a * e) / b
        ),
        "this adds noise again; x_s is divided by a, not multiplied": _mixed(
            lambda x, e, a, b: a * x + b * e
        ),
    },
    "skeleton_loss": {
        "this is the variance over the bones of a frame; bones may differ, but not over time": (
            mean_over_bones
        ),
        "divide by the number of frames minus one": lambda lengths: lengths.var(
            0, correction=0
        ).mean(),
        "this is the standard deviation; equation 6 has no root": lambda lengths: lengths.std(
            0
        ).mean(),
        "average over the bones, do not add them up": lambda lengths: lengths.var(0).sum(),
        "this is the variance of all lengths together; each bone has a mean of its own": (
            lambda lengths: lengths.var()
        ),
        "there is one mean for all bones here: each bone has a mean of its own": (
            lambda lengths: _around(lengths, lengths.mean()),
            lambda lengths: lengths.var(correction=0),
        ),
        "the mean over the bones is missing: this is one number for each bone": lambda lengths: (
            lengths.var(0)
        ),
        "these are squared lengths; take the length itself": lambda lengths: (
            (lengths**2).var(0).mean()
        ),
        "this compares with the first frame; compare with the mean": lambda lengths: _around(
            lengths, lengths[0]
        ),
        "the deviations are not squared": (
            lambda lengths: (lengths - lengths.mean(0)).abs().sum(0).mean() / (len(lengths) - 1),
            lambda lengths: (lengths - lengths.mean(0)).abs().mean(),
        ),
        "this compares each frame with the next; compare with the mean": lambda lengths: (
            lengths.diff(dim=0).square().mean()
        ),
        "divide by the number of frames minus one, not of bones": lambda lengths: (
            ((lengths - lengths.mean(0)) ** 2).sum(0) / (lengths.shape[1] - 1)
        ).mean(),
        "this is the sum over the frames; divide by their number minus one": lambda lengths: (
            ((lengths - lengths.mean(0)) ** 2).sum(0).mean()
        ),
    },
    "asymmetry_from_features": {
        "these lengths are in standardised units; go back to metres first": _asymmetry(
            lambda x, mean, std: _joints(x, 0.0, 1.0)
        ),
        "these are standardised units without the pelvis: first metres, then the pelvis": (
            _asymmetry(lambda x, mean, std: _joints(x, 0.0, 1.0, add_pelvis=False))
        ),
        "only half-way back to metres: the mean is missing": _asymmetry(
            lambda x, mean, std: _joints(x, 0.0, std)
        ),
        "only half-way back to metres: the std is missing": _asymmetry(
            lambda x, mean, std: _joints(x, mean, 1.0)
        ),
        "back to metres is times std, then plus mean: the order is exchanged": _asymmetry(
            lambda x, mean, std: _joints((x + mean) * std, 0.0, 1.0)
        ),
        "back to metres is times std plus mean; this standardises once more": _asymmetry(
            lambda x, mean, std: _joints((x - mean) / std, 0.0, 1.0)
        ),
        "the pelvis is not added to the other joints, or is added to itself as well: bones at the "
        "pelvis come out wrong": (
            _asymmetry(lambda x, mean, std: _joints(x, mean, std, add_pelvis=False)),
            _asymmetry(_pelvis_doubled),
        ),
        "the mean is missing, and the pelvis is not added": _asymmetry(
            lambda x, mean, std: _joints(x, 0.0, std, add_pelvis=False)
        ),
        "the pelvis is left at the origin while the others are moved": _asymmetry(_pelvis_lost),
        "this compares left bones with left ones": _asymmetry(
            pairs=lambda pairs: tuple((one[0], two[0]) for one, two in pairwise([*pairs, pairs[0]]))
        ),
        "left and right are paired the wrong way: follow `pairs`": (
            _asymmetry(pairs=lambda pairs: tuple((2 * i, 2 * i + 1) for i in range(len(pairs)))),
            _asymmetry(
                pairs=lambda pairs: tuple(
                    (one[0], two[1]) for one, two in zip(pairs, pairs[::-1], strict=True)
                )
            ),
        ),
        "the signs must not cancel: take the absolute value of each difference": _asymmetry(
            reduce=lambda gap: gap.mean()
        ),
        "the signs must not cancel: take absolute values before the mean": (
            _asymmetry(reduce=lambda gap: gap.mean().abs()),
            _asymmetry(reduce=lambda gap: gap.mean(0).abs().mean()),
            _asymmetry(reduce=lambda gap: gap.mean(1).abs().mean()),
        ),
        "L_a is in metres: the difference itself, not its square": (
            _asymmetry(reduce=lambda gap: gap.square().mean()),
            _asymmetry(reduce=lambda gap: gap.square().mean().sqrt()),
        ),
        "take the mean over pairs and frames, not the sum": _asymmetry(
            reduce=lambda gap: gap.abs().sum()
        ),
        "take the mean over the pairs as well, not the sum": _asymmetry(
            reduce=lambda gap: gap.abs().sum(1).mean()
        ),
        "take the mean over the frames as well, not the sum": _asymmetry(
            reduce=lambda gap: gap.abs().sum(0).mean()
        ),
        "divide by the number of pairs, not of all bones": by_all_bones,
    },
}
OTHERS = {"asymmetry_from_features": {"in place": in_place}}
