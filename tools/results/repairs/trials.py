"""The trials of repair methods.

They are unseen pasts with known faults; walkers get zero after standardisation for missing joints.
"""

import numpy as np
import torch
from jaxtyping import Bool, Float

from data_synth.imperfect import Imperfect, random_joints
from motiondiff_edu import rollout
from motiondiff_edu.performers.walker import Walker

from ..walks.trials import Trials

SHARE = 0.3  # of the joints, missing throughout: MoDiff's Table II
KINDS = {"plain": "mend-plain", "dropout": "mend-dropout"}
SEEDS = 3  # trainings of each kind, shipped


def names_of(kind: str) -> list[str]:
    """The shipped weights of one kind, one for each training seed."""
    return [f"{KINDS[kind]}-{k}" for k in range(SEEDS)]


def without(past: Float[np.ndarray, "N T_h J 3"], share: float, seed: int = 1) -> Imperfect:
    """Pasts with a share of their joints missing throughout, drawn with their own seed."""
    return random_joints(past, share, np.random.default_rng(seed))


def as_given(walker: Walker, broken: Imperfect) -> tuple[torch.Tensor, torch.Tensor]:
    """(past, known), both (N, T_h, D): the network's columns in metres.

    Unknown entries have the mean pose.
    """
    past = torch.from_numpy(broken.positions).float().flatten(2)
    known = columns_of(broken.known)
    return torch.where(known, past, walker.pose_scaler.mean.expand_as(past)), known


def columns_of(known: Bool[np.ndarray, "N T J"]) -> Bool[torch.Tensor, "N T D"]:
    """Each joint has three columns of a walker's pose."""
    return torch.from_numpy(np.repeat(known, 3, axis=-1))


def continued(
    walker: Walker,
    trials: Trials,
    share: float,
    frames: int,
    seed: int = 0,
    steps: int | None = None,
    keep: int = 1,
) -> Float[np.ndarray, "N n J 3"]:
    """The next `frames` after a past with a share of its joints missing.

    The control is held, as in all measurements.

    `keep` poses of every predicted window are kept.
    """
    past, _ = as_given(walker, without(trials.past, share))
    control = torch.from_numpy(trials.control[:, : past.shape[1] + frames]).float()
    made = rollout.generate(walker, past, control, seed=seed, steps=steps, keep=keep)
    return made.unflatten(-1, (-1, 3)).double().numpy()
