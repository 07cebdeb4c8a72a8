"""Methods that fill holes without a walker.

They are the mean pose, ridge regression from known entries, and straight lines.
"""

from functools import cache

import numpy as np
import torch
from jaxtyping import Float

from data_synth.imperfect import Imperfect
from data_synth.walking import dataset
from motiondiff_edu.baselines import ridge
from motiondiff_edu.baselines.interpolation import linear
from motiondiff_edu.motion.augment import augment
from motiondiff_edu.performers.windows import Windows

from ..walks.trials import Trials
from .trials import columns_of

Past = Float[np.ndarray, "N T_h J 3"]
CLIPS = 200  # for the fit of the regression, each in four versions


@cache
def _regression() -> ridge.WindowRidge:
    return ridge.fit_windows(Windows.of(augment(dataset(CLIPS, 20.0, seed=1))), every=5)


def rivals(broken: Imperfect, trials: Trials) -> dict[str, Past]:
    """Guesses by name; straight lines only if every joint is known at some time."""
    fitted, known = _regression(), columns_of(broken.known)
    past = torch.from_numpy(np.nan_to_num(broken.positions)).float().flatten(2)
    control = torch.from_numpy(trials.control[:, : 2 * past.shape[1]]).float()
    mean = torch.where(known, past, fitted.pose_scaler.mean.expand_as(past))
    guesses = {"ridge": fitted.reconstruct(past, known, control), "meanpose": mean}
    found = {name: guess.unflatten(-1, (-1, 3)).double().numpy() for name, guess in guesses.items()}
    if broken.known.any(1).all():
        pairs = zip(np.nan_to_num(broken.positions), broken.known, strict=True)
        found["interpolation"] = np.stack([linear(one, seen) for one, seen in pairs])
    return found
