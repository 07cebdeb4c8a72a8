"""The part `mend`.

It measures diffusion dropout, repairs beside methods without a walker, and MoDiff's Table II.
"""

from motiondiff_edu.metrics.footsteps import PAPER, ROBUST
from motiondiff_edu.pretrained import checkpoints

from ..walks.parts import Bench, weights_digest
from ..walks.trials import UNSEEN
from .dropout import dropout_records
from .repair import FAULTS, RepairSize, footsteps, repair_figures, repaired_windows, table_2
from .trials import SHARE, names_of

KEEP = 5  # poses kept of every window of ten; frame by frame, each has other noise, and heels creep
CLIPS, FEW = 60, 20  # pasts of Table II, and of the larger walker


def records(bench: Bench, size: RepairSize, command: str) -> list[dict]:
    """All records of the part: pairs of small walkers, repairs by the shipped walker, Table II.

    Table II is of the small walkers with dropout, frame by frame. It is also measured with half of
    every window kept, and for the shipped walker, which was trained for longer, without dropout.
    """
    trials, weights = bench.trials, bench.weights
    best, pairs = (
        [checkpoints.load_walker(weights[name]) for name in names]
        for names in (["walker"], names_of("dropout"))
    )
    figures = [one for fault in FAULTS for one in repair_figures(fault, best[0], trials, size)]
    some, few = trials.first(CLIPS), trials.first(FEW)
    for walkers, asked, names in (
        (pairs, some, {"": 1, f"keep{KEEP}_": KEEP}),
        (best, few, {"walker_": 1}),
    ):
        windows = repaired_windows(walkers, asked, size)
        for who, keep in names.items():
            second, after = table_2(walkers, asked, size, windows, who, keep)
            figures += second
            for suffix, rule in (("", ROBUST), ("_paper", PAPER)):
                figures.append(footsteps(f"footsteps_{who}over_data{suffix}", after, asked, rule))
    seeds = {"data": UNSEEN, "clips": len(trials.past), "missing": SHARE, "samples": size.samples}
    seeds |= {
        "rounds": size.rounds,
        "steps": size.steps,
        "keep": KEEP,
        "table2_clips": CLIPS,
        "table2_walker_clips": FEW,
    }
    seeds |= {
        "weights": [weights_digest(weights[name]) for name in ("walker", *names_of("dropout"))]
    }
    return dropout_records(trials, weights, command) + [
        one.as_record("mend.", seeds, command) for one in figures
    ]
