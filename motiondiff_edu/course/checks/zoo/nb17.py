"""Wrong answers to the exercises of notebook 17."""

import torch


def one_too_many(distances, k):
    """Counts the own motion when it is the (k + 1)-th."""
    rank = (distances < distances.diagonal()[:, None]).sum(1)
    return (rank <= k).mean()


def exactly(distances, k):
    """Counts only the k-th place."""
    rank = (distances < distances.diagonal()[:, None]).sum(1)
    return (rank == k - 1).mean()


def by_motion(distances, k):
    """Chooses a text for each motion."""
    rank = (distances < distances.diagonal()[None]).sum(0)
    return (rank < k).mean()


def ties_win(distances, k):
    """A network that always makes the same motion gets a perfect score."""
    rank = (distances < distances.diagonal()[:, None]).sum(1)
    return (rank < k).mean()


def ties_lose(distances, k):
    """Motions that are as near as the own one count as nearer."""
    rank = (distances <= distances.diagonal()[:, None]).sum(1) - 1
    return (rank < k).mean()


def farthest(distances, k):
    """Takes the k farthest motions."""
    rank = (distances > distances.diagonal()[:, None]).sum(1)
    return (rank < k).mean()


def noise_alone(x0, alpha_bar, noise):
    """Plain sampling: nothing of the motion is left."""
    return noise


def without_roots(x0, alpha_bar, noise):
    """The figure has too little noise, and the network takes it for a cleaner one."""
    return alpha_bar * x0 + (1 - alpha_bar) * noise


def not_shrunk(x0, alpha_bar, noise):
    """The motion is too large for its step."""
    return x0 + (1 - alpha_bar) ** 0.5 * noise


def inverted(eps_lower, eps_upper, lower):
    """The legs do what the arms were asked for."""
    return torch.where(lower, eps_upper, eps_lower)


def mean_of_both(eps_lower, eps_upper, lower):
    """Every joint does half of both."""
    return (eps_lower + eps_upper) / 2


def summed(eps_lower, eps_upper, lower):
    """Takes away twice the noise."""
    return eps_lower + eps_upper


ZOO = {
    "r_precision": {
        "one too many": one_too_many,
        "exactly the k-th": exactly,
        "texts for motions": by_motion,
        "the farthest": farthest,
        "ties win": ties_win,
        "ties lose": ties_lose,
    },
    "edit_start": {
        "noise alone": noise_alone,
        "without roots": without_roots,
        "not shrunk": not_shrunk,
    },
    "composed": {"inverted": inverted, "mean": mean_of_both, "sum": summed},
}
