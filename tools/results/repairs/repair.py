"""Repairs of faulty pasts against the truth, beside methods without a walker; MoDiff's Table II.

Source: MoDiff III-E, IV-B, Table II, Fig. 6.  Notebook: 10
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import torch
from jaxtyping import Float

from data_synth.imperfect import ARM, LEG, Imperfect, bursts, dead_joints, dropped_frames
from motiondiff_edu import reconstruction
from motiondiff_edu.beyond.back_with_known import masked_way_back
from motiondiff_edu.editing.repairs import with_bones
from motiondiff_edu.performers.walker import Walker
from motiondiff_edu.reconstruction import Rollout, Stop, WayBack, plain_way_back

from ..intervals import interval_over_seeds
from ..walks import steps_table
from ..walks.scores import Measure, measure_of, root_mean, squared_bone_error
from ..walks.trials import Trials
from .rivals import rivals
from .trials import SHARE, as_given, continued, without

Past = Float[np.ndarray, "N T_h J 3"]
FAULTS: dict[str, Callable[[Past], Imperfect]] = {
    "arm": lambda past: dead_joints(past, ARM),
    "leg": lambda past: dead_joints(past, LEG),
    "frames": lambda past: dropped_frames(past, 3, 4),  # four inner frames of ten
    "bursts": lambda past: bursts(past, np.random.default_rng(2)),
}


@dataclass(frozen=True)
class RepairSize:
    """Numbers: samples of each repair, rounds there and back, DDIM steps, repaired pasts."""

    samples: int = 10
    rounds: int = 2
    steps: int = 10
    pasts: int = 300


FULL, QUICK = RepairSize(), RepairSize(samples=2, rounds=1, steps=3, pasts=12)
PAPER_SAMPLES = 3  # of the paper's own repairs, for comparison


def repaired(
    walker: Walker,
    trials: Trials,
    broken: Imperfect,
    size: RepairSize,
    way_back: WayBack = plain_way_back,
    guess: Past | None = None,
    bones: bool = False,
) -> Float[np.ndarray, "S N T_h J 3"]:
    """`samples` repairs of each past, in metres."""
    past, known = as_given(walker, broken)
    control = torch.from_numpy(trials.control[:, : 2 * past.shape[1]]).float()
    start = None if guess is None else torch.from_numpy(guess).float().flatten(2)
    options = {"way_back": way_back, "guess": start, "stop": Stop(size.rounds)}
    options["correct"] = with_bones if bones else None
    draws = [torch.Generator().manual_seed(k) for k in range(size.samples)]
    made = [
        reconstruction.reconstruct(
            Rollout(walker, draw, size.steps), past, known, control, **options
        )
        for draw in draws
    ]
    return torch.stack(made).unflatten(-1, (-1, 3)).double().numpy()


def squared_errors(made: Past, truth: Past, broken: Imperfect) -> Float[np.ndarray, "N"]:
    """Mean squared distance (cm^2) of the missing joints of each past; NaN if none is missing."""
    squares = 1e4 * ((made - truth) ** 2).sum(-1)
    missing = ~broken.known
    with np.errstate(invalid="ignore"):
        return (squares * missing).sum((1, 2)) / missing.sum((1, 2))


def root_nanmean(squares: np.ndarray) -> float:
    return float(np.sqrt(np.nanmean(squares)))


def repair_measures(fault: str, walker: Walker, trials: Trials, size: RepairSize) -> list[Measure]:
    """Errors of the repairs' mean, of one, of the paper's way and of other methods, all in cm.

    The error of the mean is also divided by that of each other method.

    Ours start from the guess of ridge regression, hold known entries also on the way back, and keep
    bones. The paper's start from the mean pose and do neither (their mean is of fewer). Intervals
    are over pasts.
    """
    broken = FAULTS[fault](trials.past)
    guesses = rivals(broken, trials)
    ours = repaired(walker, trials, broken, size, masked_way_back, guesses["ridge"], bones=True)
    theirs = repaired(
        walker, trials, broken, replace(size, samples=min(size.samples, PAPER_SAMPLES))
    )
    each = {"": ours.mean(0), "one_": ours[0], "paper_": theirs.mean(0), "paper_one_": theirs[0]}
    rows = {
        f"{name}rmse_cm": squared_errors(made, trials.past, broken) for name, made in each.items()
    }
    others = {name: squared_errors(guess, trials.past, broken) for name, guess in guesses.items()}
    rows |= {f"rmse_{name}_cm": row for name, row in others.items()}
    found = [measure_of(f"{fault}_{name}", "cm", root_nanmean, row) for name, row in rows.items()]
    for name, row in others.items():
        over = f"{fault}_rmse_over_{name}", "ratio", lambda a, b: root_nanmean(a) / root_nanmean(b)
        found.append(measure_of(*over, rows["rmse_cm"], row))
        won = (
            f"{fault}_nearer_than_{name}",
            "share",
            lambda a, b: float(np.nanmean(np.where(np.isnan(b), b, a < b))),
        )
        found.append(measure_of(*won, rows["rmse_cm"], row))
    return found


def repaired_windows(
    walkers: list[Walker], trials: Trials, size: RepairSize
) -> dict[str, list[np.ndarray]]:
    """Pasts with 30 % of their joints missing, repaired once by each walker.

    `re`: our way as it comes from the network; `re_bones`: bones kept; `re_paper`: the paper's way.
    """
    broken = without(trials.past, SHARE)
    once = RepairSize(1, size.rounds, size.steps)
    guess = rivals(broken, trials)["ridge"]
    ours = {
        name: (masked_way_back, guess, bones) for name, bones in (("re", False), ("re_bones", True))
    }
    ways = ours | {"re_paper": ()}
    return {
        name: [repaired(walker, trials, broken, once, *how)[0] for walker in walkers]
        for name, how in ways.items()
    }


def table_2(
    walkers: list[Walker],
    trials: Trials,
    size: RepairSize,
    windows: dict[str, list[np.ndarray]],
    who: str = "",
    keep: int = 1,
) -> tuple[list[Measure], list[np.ndarray]]:
    """MoDiff's Table II.

    Bone errors with 30 % of the past's joints missing, over those with a complete past.

    They are of `repaired_windows`, and of the walks after the faulty past (`ge`). These walks are
    returned as well, one set for each walker. `who` names the walkers; they keep `keep` poses of a
    window.
    """
    frames = trials.truth.shape[1]
    whole = [
        continued(walker, trials, 0.0, frames, steps=size.steps, keep=keep) for walker in walkers
    ]
    after = [
        continued(walker, trials, SHARE, frames, steps=size.steps, keep=keep) for walker in walkers
    ]
    sets = {"whole": whole, "ge": after, **windows}
    squares = {name: np.stack([squared_bone_error(x) for x in each]) for name, each in sets.items()}
    measures = [
        Measure(f"table2_{who}bone_{name}_cm", *interval_over_seeds(root_mean, x), "cm")
        for name, x in squares.items()
    ]
    arrays = [squares[name] for name in ("whole", "ge", "re")]
    ratio = interval_over_seeds(
        lambda w, g, r: max(root_mean(g), root_mean(r)) / root_mean(w), *arrays
    )
    ge = interval_over_seeds(lambda w, g: root_mean(g) / root_mean(w), *arrays[:2])
    measures.append(Measure(f"table2_{who}ge_over_whole", *ge, "ratio"))
    return [*measures, Measure(f"table2_{who}ratio", *ratio, "ratio")], after


def footsteps(name: str, walks: list[np.ndarray], trials: Trials, rule) -> Measure:
    """Number of footsteps of walks over that of the recorded motion, at v95 of each.

    There is one set of walks for each training.
    """
    tables = np.stack([steps_table.tables(poses, trials.asked, rule) for poses in walks])
    data = np.broadcast_to(steps_table.tables(trials.truth, trials.asked, rule), tables.shape)

    def over(made: np.ndarray, recorded: np.ndarray) -> float:
        return np.mean(
            [
                steps_table.row(a)[0] / steps_table.row(b)[0]
                for a, b in zip(made, recorded, strict=True)
            ]
        )

    return Measure(name, *interval_over_seeds(over, tables, data), "ratio")
