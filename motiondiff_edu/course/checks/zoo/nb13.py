"""Wrong answers to the exercises of notebook 13."""

import torch


def _guess(x_s, eps_hat, first, second):
    first, second = (torch.as_tensor(x).reshape(-1, 1, 1) for x in (first, second))
    return x_s / first**0.5 - (1 / second - 1) ** 0.5 * eps_hat


def index_left_out(x_s, s, eps_hat, alpha_bar):
    """As printed in the paper: one alpha_bar has its index and the other has none."""
    return _guess(x_s, eps_hat, alpha_bar[s], alpha_bar[-1])


def last_step_for_all(x_s, s, eps_hat, alpha_bar):
    """Treats every sample as pure noise: the guess for a clean one becomes enormous."""
    return _guess(x_s, eps_hat, alpha_bar[-1], alpha_bar[-1])


def one_step_earlier(x_s, s, eps_hat, alpha_bar):
    """Reads the table as if it began at s = 1."""
    return _guess(x_s, eps_hat, alpha_bar[s - 1], alpha_bar[s - 1])


def first_step_for_all(x_s, s, eps_hat, alpha_bar):
    """Reads the table for the first sample only; a batch of one does not show it."""
    return _guess(x_s, eps_hat, alpha_bar[s[0]], alpha_bar[s[0]])


def no_roots(x_s, s, eps_hat, alpha_bar):
    """Uses the shares of the variance as amplitudes."""
    share = alpha_bar[s][:, None, None]
    return x_s / share - (1 / share - 1) * eps_hat


def second_root_forgotten(x_s, s, eps_hat, alpha_bar):
    """Takes one root of two: too little noise is removed at small s, too much at large s."""
    share = alpha_bar[s][:, None, None]
    return x_s / share**0.5 - (1 / share - 1) * eps_hat


def noise_added_again(x_s, s, eps_hat, alpha_bar):
    """The sign is wrong: the noise is doubled instead of removed."""
    return _guess(x_s, -eps_hat, alpha_bar[s], alpha_bar[s])


def mean_over_bones(lengths):
    """Compares the bones with each other, and no body has bones of one length."""
    return ((lengths - lengths.mean(1, keepdim=True)) ** 2).sum(1).div(lengths.shape[1] - 1).mean()


def divided_by_n(lengths):
    """Squares around their own mean are too small; N - 1 corrects that."""
    return ((lengths - lengths.mean(0)) ** 2).mean()


def _joints(x0_hat, mean, std, add_pelvis=True):
    joints = (x0_hat * std + mean).reshape(len(x0_hat), -1, 3)
    return torch.cat([joints[:, :1], joints[:, 1:] + joints[:, :1]], 1) if add_pelvis else joints


def _apart(joints, bones, pairs):
    lengths = torch.stack(
        [(joints[:, child] - joints[:, parent]).norm(dim=-1) for parent, child in bones], 1
    )
    left, right = zip(*pairs, strict=True)
    return lengths[:, list(left)] - lengths[:, list(right)]


def standardised_units(x0_hat, mean, std, bones, pairs):
    """Measures in standardised units, in which every coordinate has its own scale."""
    return _apart(_joints(x0_hat, 0.0, 1.0), bones, pairs).abs().mean()


def mean_not_added(x0_hat, mean, std, bones, pairs):
    """Multiplies by the standard deviation but forgets the mean: the joints lie in a heap."""
    return _apart(_joints(x0_hat, 0.0, std), bones, pairs).abs().mean()


def root_dropped(x0_hat, mean, std, bones, pairs):
    """The joints stay relative to the pelvis, so bones at the pelvis have a wrong start."""
    return _apart(_joints(x0_hat, mean, std, add_pelvis=False), bones, pairs).abs().mean()


def left_with_left(x0_hat, mean, std, bones, pairs):
    """Compares each left bone with the next left one, a thigh with an upper arm."""
    left = [i for i, _ in pairs]
    return (
        _apart(
            _joints(x0_hat, mean, std), bones, tuple(zip(left, left[1:] + left[:1], strict=True))
        )
        .abs()
        .mean()
    )


def sign_kept(x0_hat, mean, std, bones, pairs):
    """Left too long and right too long cancel, and a crooked body can score zero."""
    return _apart(_joints(x0_hat, mean, std), bones, pairs).mean()


def squared(x0_hat, mean, std, bones, pairs):
    """Squares the differences, so that small asymmetries vanish."""
    return _apart(_joints(x0_hat, mean, std), bones, pairs).square().mean()


ZOO = {
    "x0_hat": {
        "index left out": index_left_out,
        "last step for all": last_step_for_all,
        "one step earlier": one_step_earlier,
        "first sample's step for all": first_step_for_all,
        "no roots": no_roots,
        "second root forgotten": second_root_forgotten,
        "noise added again": noise_added_again,
        "first root forgotten": lambda x_s, s, eps_hat, alpha_bar: _guess(
            x_s, eps_hat, alpha_bar[s] ** 2, alpha_bar[s]
        ),
    },
    "skeleton_loss": {
        "variance over bones": mean_over_bones,
        "N instead of N - 1": divided_by_n,
        "standard deviation": lambda lengths: lengths.std(0).mean(),
        "sum over bones": lambda lengths: lengths.var(0).sum(),
        "all lengths together": lambda lengths: lengths.var(),
        "one for each bone": lambda lengths: lengths.var(0),
        "squared lengths": lambda lengths: (lengths**2).var(0).mean(),
        "one mean for all bones": lambda lengths: (
            ((lengths - lengths.mean()) ** 2).sum(0) / (len(lengths) - 1)
        ).mean(),
        "the first frame for the mean": lambda lengths: (
            ((lengths - lengths[0]) ** 2).sum(0) / (len(lengths) - 1)
        ).mean(),
        "frame to frame": lambda lengths: (lengths[1:] - lengths[:-1]).square().mean(),
    },
    "asymmetry_from_features": {
        "standardised units": standardised_units,
        "mean not added": mean_not_added,
        "root dropped": root_dropped,
        "left with left": left_with_left,
        "sign kept": sign_kept,
        "std forgotten": lambda x0_hat, mean, std, bones, pairs: (
            _apart(_joints(x0_hat, mean, torch.ones_like(std)), bones, pairs).abs().mean()
        ),
        "summed over pairs": lambda x0_hat, mean, std, bones, pairs: (
            _apart(_joints(x0_hat, mean, std), bones, pairs).abs().sum(1).mean()
        ),
        "squared": squared,
    },
}
