"""Checks of notebook 05.

Back to x0 from any target, the averaged weights, and the weight between two losses.
"""

import numpy as np
import torch

from ._compare import compare
from ._drawn import tensors
from ._report import check
from .zoo.nb05 import MISTAKES


def _outputs(rng: np.random.Generator):
    """x0 = 2, -1 and eps = -1, 3 by hand, for the targets eps, x0 and v; then others."""
    alpha_bar, x_s = torch.tensor([0.64, 0.36]), torch.tensor([1.0, 1.8])
    yield torch.tensor([-1.0, 3.0]), x_s, alpha_bar, "eps"
    yield torch.tensor([2.0, -1.0]), x_s, alpha_bar, "x0"
    yield torch.tensor([-2.0, 2.6]), x_s, alpha_bar, "v"
    for target in ("v", "eps", "x0"):
        shares = torch.from_numpy(rng.uniform(0.1, 0.9, size=5))
        yield tensors(rng, 5), tensors(rng, 5), shares, target


def solved(output, x_s, alpha_bar, target: str) -> np.ndarray:
    """Number by number: x0 and eps from two equations, x_s = a x0 + b eps and the target's."""
    rows = {
        "eps": lambda a, b: [0.0, 1.0],
        "x0": lambda a, b: [1.0, 0.0],
        "v": lambda a, b: [-b, a],
    }
    found = []
    for out, x, share in zip(output.tolist(), x_s.tolist(), alpha_bar.tolist(), strict=True):
        a, b = share**0.5, (1 - share) ** 0.5
        found.append(np.linalg.solve([[a, b], rows[target](a, b)], [x, out])[0])
    return np.array(found)


@check
def back_to_x0(mine):
    """Check mine(output, x_s, alpha_bar, target): each target leads back to the same x0."""
    compare(mine, solved, _outputs, "x0", MISTAKES["back_to_x0"])
    return "The three targets differ by one rotation: its angle has the cosine a."


def _weights(rng: np.random.Generator):
    """Two arrays by hand; then others."""
    means = [np.array([1.0, -2.0]), np.zeros(3)]
    yield means, [np.array([2.0, 2.0]), np.array([10.0, 0.0, -5.0])], 0.9
    for decay in (0.8, 0.25):
        yield (
            [rng.normal(size=(2, 3)), rng.normal(size=4)],
            [rng.normal(size=(2, 3)), rng.normal(size=4)],
            decay,
        )


def moved_towards(means: list, new: list, decay: float) -> list:
    """Each average moves by the share 1 - decay of its distance from the new weights."""
    return [m + (1 - decay) * (n - m) for m, n in zip(means, new, strict=True)]


@check
def averaged_weights(mine):
    """mine(means, new, decay) -> new averages; the old ones stay as they are."""
    parts = ("the average of the first array", "the average of the second array")
    compare(mine, moved_towards, _weights, parts, MISTAKES["averaged_weights"])
    return "After 1 / (1 - decay) steps about a third of the old average is left."


def _shares(rng: np.random.Generator):
    """Four shares of the signal by hand; then others."""
    yield (torch.tensor([0.9, 0.5, 0.2, 0.01]),)
    yield (torch.from_numpy(rng.uniform(0.05, 0.95, size=6)),)


def from_an_error(alpha_bar) -> torch.Tensor:
    """The error of x0_hat that an error of 1 in eps_hat makes, squared."""
    a, b = alpha_bar.sqrt(), (1 - alpha_bar).sqrt()
    x_s = a * 0.3 + b * 0.7
    return ((x_s - b * (0.7 + 1)) / a - 0.3) ** 2


@check
def weight_between_losses(mine):
    """mine(alpha_bar): the squared error of x0 over that of eps, for each alpha_bar."""
    compare(
        mine, from_an_error, _shares, "the weight", MISTAKES["weight_between_losses"], rtol=1e-3
    )
    return (
        "The target decides which steps count: "
        "an unweighted eps loss gives little weight to high noise."
    )
