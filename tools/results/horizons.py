"""How many future poses should be predicted at once? T_p of 1, 5, 10 and 20, each trained for the same CPU-seconds.

MoDiff says that T_p > 1 helps and gives no number. Everything else is alike: network, data, loss, seed, and the
rollout, which keeps one pose of every window.  Source: MoDiff III-A
"""

from dataclasses import dataclass, replace

import torch

from data_synth.walking import dataset
from motiondiff_edu.motion.augment import augment
from motiondiff_edu.pretrained.budget import X0_SMALL, train_for

from .scores import Figure, score
from .trials import T_H, UNSEEN, unseen, walker_generate

HORIZONS = (1, 5, 10, 20)
SHOWN = ("bone_rmse_cm", "adherence_mps", "adherence_shuffled_over_own", "skating_mps", "drift_ratio")


@dataclass(frozen=True)
class Budget:
    """CPU-seconds of training each, clips to train on, clips to walk, and for how long."""

    seconds: float = 240
    training: int = 300
    clips: int = 40
    walk_s: int = 8


FULL, QUICK = Budget(), Budget(seconds=3, training=6, clips=8, walk_s=6)


def measure(T_p: int, budget: Budget, clips: list) -> tuple[list[Figure], int]:
    """The figures of a walker that predicts T_p poses, and the steps its seconds were enough for."""
    walker, steps = train_for(budget.seconds, clips, replace(X0_SMALL, T_p=T_p), batch=32, noises=2)
    trials = unseen(budget.clips, budget.walk_s)
    walks = walker_generate(walker)(trials.past, trials.control, 0)
    return [figure for figure in score(walks, trials.asked, trials.truth) if figure.name in SHOWN], steps


def horizon_records(budget: Budget, command: str) -> list[dict]:
    """One thread, whatever the machine has: CPU-seconds are the budget."""
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    clips, records = augment(dataset(budget.training, 20.0, seed=1)), []
    for T_p in HORIZONS:
        figures, steps = measure(T_p, budget, clips)
        seeds = {"data": UNSEEN, "training": 0, "rollouts": 0, "clips": budget.clips}
        figures.append(Figure("steps", steps, steps, steps, "steps"))
        records += [
            dict(name=f"horizon-{T_p}.{f.name}", value=float(f"{f.value:.5g}"), low=float(f"{f.low:.5g}"),
                 high=float(f"{f.high:.5g}"), seeds=seeds, unit=f.unit, paper=None, command=command)
            for f in figures
        ]  # fmt: skip
        print(f"T_p = {T_p}: {steps} steps in {budget.seconds:g} CPU-seconds, T_h = {T_H}", flush=True)
    torch.set_num_threads(before)
    return records
