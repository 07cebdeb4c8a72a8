"""Wrong answers to the exercises of notebook 17."""

import numpy as np
import torch


def _ranks(distances, own):
    return (distances < own).sum(1), (distances == own).sum(1)


def _rows(distances):
    return _ranks(distances, distances.diagonal()[:, None])


def _share(nearer, equal, k):
    return ((k - nearer) / equal).clip(0, 1).mean()


def by_motion(distances, k):
    """Chooses a text for each motion."""
    return _share(*_rows(distances.T), k)


def by_sorting(distances, k):
    """Of motions that are equally near, the one with the smaller number comes first."""
    nearest = distances.argsort(1, kind="stable")[:, :k]
    return (nearest == np.arange(len(distances))[:, None]).any(1).mean()


def own_as_a_row(distances, k):
    """Compares each text with another text's own motion."""
    own = distances.diagonal()[None]
    return _share((distances < own).sum(1), (distances == own).sum(1).clip(1), k)


def _noised(form):
    return lambda x0, alpha_bar, noise: form(x0, noise, alpha_bar**0.5, (1 - alpha_bar) ** 0.5)


def _without_limits(distances, k):
    """Places are shared, but a text can count more than 1, or less than 0."""
    nearer, equal = _rows(distances)
    return ((k - nearer) / equal).mean()


MISTAKES = {
    "r_precision": {
        "a rank of 0 is the nearest: the own motion must be among the first k": (
            lambda distances, k: _share(*_rows(distances), k + 1),
            lambda distances, k: (_rows(distances)[0] <= k).mean(),
        ),
        "this is exactly the k-th nearest; nearer ones count, too": lambda distances, k: (
            _rows(distances)[0] == k - 1
        ).mean(),
        "take the share, not the number": lambda distances, k: (
            _share(*_rows(distances), k) * len(distances)
        ),
        "rows are texts: choose a motion for each text, not a text for each motion": (
            by_motion,
            lambda distances, k: (_rows(distances.T)[0] < k).mean(),
            lambda distances, k: (_rows(distances.T)[0] <= k).mean(),
        ),
        "the own motion's distance belongs to its row, its text": own_as_a_row,
        "the nearest has the *smallest* distance": lambda distances, k: _share(
            *_rows(-distances), k
        ),
        "a network that always makes the same motion must not win: of motions that are equally "
        "near, each has an equal share": (
            lambda distances, k: (_rows(distances)[0] < k).mean(),
            by_sorting,
        ),
        "of motions that are equally near, each comes first equally often; this always puts the "
        "own one last": lambda distances, k: (sum(_rows(distances)) - 1 < k).mean(),
        "the nearer motions have taken their places: k minus their number are left to share": (
            lambda distances, k: (k / (sum(_rows(distances)))).clip(0, 1).mean()
        ),
        "each text counts from 0 to 1: 0 where nearer motions have taken all k places, 1 at most": (
            _without_limits
        ),
        "k is not used: this is the nearest alone": lambda distances, k: _share(
            *_rows(distances), 1
        ),
        "this is the mean rank; which share of the texts has one below k?": lambda distances, k: (
            _rows(distances)[0].mean()
        ),
    },
    "edit_start": {
        "that is noise alone: nothing of the motion is left": lambda x0, alpha_bar, noise: (
            noise.clone()
        ),
        "that is noise alone, scaled: where is the motion?": _noised(lambda x, e, a, b: b * e),
        "that is the motion alone, scaled: where is the noise?": _noised(lambda x, e, a, b: a * x),
        "the motion keeps its size, but it must shrink as in training": _noised(
            lambda x, e, a, b: x + b * e
        ),
        "the noise is scaled by the root of 1 - alpha_bar": _noised(lambda x, e, a, b: a * x + e),
        "take the roots of alpha_bar and of 1 - alpha_bar": _noised(
            lambda x, e, a, b: a**2 * x + b**2 * e
        ),
        "the root of alpha_bar is missing": _noised(lambda x, e, a, b: a**2 * x + b * e),
        "the root of 1 - alpha_bar is missing": _noised(lambda x, e, a, b: a * x + b**2 * e),
        "signal and noise are swapped": _noised(lambda x, e, a, b: b * x + a * e),
        "you subtracted the noise; add it": _noised(lambda x, e, a, b: a * x - b * e),
    },
    "composed": {
        "the mask is inverted: True is the lower body": lambda low, up, lower: torch.where(
            lower, up, low
        ),
        "this is the mean of both texts in every column": lambda low, up, lower: (low + up) / 2,
        "columns keep their places: here those of the lower body come first": (
            lambda low, up, lower: torch.cat([low[..., lower], up[..., ~lower]], -1)
        ),
        "this is their sum": lambda low, up, lower: low + up,
        "the other part is zero; it belongs to the other text": (
            lambda low, up, lower: low * lower,
            lambda low, up, lower: up * ~lower,
        ),
        "only the text of the lower body is left": lambda low, up, lower: low.clone(),
        "only the text of the upper body is left": lambda low, up, lower: up.clone(),
    },
}


def lower_in_place(eps_lower, eps_upper, lower):
    """Right, but the guess for the lower body is overwritten."""
    eps_lower[..., ~lower] = eps_upper[..., ~lower]
    return eps_lower


OTHERS = {"composed": {"in place": lower_in_place}}
