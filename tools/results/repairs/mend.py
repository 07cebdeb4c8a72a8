"""The part `mend`.

It measures diffusion dropout, repairs beside methods without a walker, and MoDiff's Table II.
"""

from motiondiff_edu.metrics.walks import PAPER, ROBUST
from motiondiff_edu.pretrained import checkpoints

from ..walks.parts import Bench, weights_digest
from ..walks.trials import UNSEEN, unseen
from .dropout import SHIPPED_PAIR, SMALL_PAIRS, dropout_records
from .repair import FAULTS, RepairSize, footsteps, repair_measures, repaired_windows, table_2
from .trials import SHARE, names_of

KEEP = 5  # poses kept of every window of ten; frame by frame, each has other noise, and heels creep
CLIPS = 60  # pasts of Table II
PAST_S = 2  # seconds of control beside each past that is reconstructed


def records(bench: Bench, size: RepairSize, command: str) -> list[dict]:
    """All records of the part: the value of dropout, repairs by the shipped walker, Table II.

    Table II is of the small walkers with dropout, frame by frame. It is also measured with half of
    every window kept, and for the shipped walker, which is larger and was trained for longer.
    """
    trials, weights = bench.trials, bench.weights
    best, pairs = (
        [checkpoints.load(weights[name]) for name in names]
        for names in (["walker"], names_of("dropout"))
    )
    pasts = unseen(size.pasts, PAST_S)
    measures = [one for fault in FAULTS for one in repair_measures(fault, best[0], pasts, size)]
    asked = trials.first(CLIPS)
    for walkers, names in ((pairs, {"": 1, f"keep{KEEP}_": KEEP}), (best, {"walker_": 1})):
        windows = repaired_windows(walkers, asked, size)
        for who, keep in names.items():
            second, after = table_2(walkers, asked, size, windows, who, keep)
            measures += second
            for suffix, rule in (("", ROBUST), ("_paper", PAPER)):
                measures.append(footsteps(f"footsteps_{who}over_data{suffix}", after, asked, rule))
    seeds = {"data": UNSEEN, "pasts": len(pasts.past), "missing": SHARE, "samples": size.samples}
    seeds |= {
        "rounds": size.rounds,
        "steps": size.steps,
        "keep": KEEP,
        "table2_clips": len(asked.past),
    }
    seeds |= {
        "weights": [weights_digest(weights[name]) for name in ("walker", *names_of("dropout"))]
    }
    compared = [
        one
        for pair in (SHIPPED_PAIR, SMALL_PAIRS)
        for one in dropout_records(pair, trials, weights, command)
    ]
    return compared + [one.as_record("mend.", seeds, command) for one in measures]
