"""The part `mend`: what diffusion dropout is worth, repairs beside what needs no walker, and MoDiff's Table II."""

from motiondiff_edu import checkpoints
from motiondiff_edu.metrics.footsteps import PAPER, ROBUST

from .mend_dropout import dropout_records
from .mend_repair import FAULTS, RepairSize, footsteps, repair_figures, table_2
from .mend_trials import SHARE, names_of
from .parts import Bench, weights_digest
from .trials import UNSEEN

PAIRS_CLIPS = 40  # pasts from which the small walkers walk on for 12 s, three trainings of them


def records(bench: Bench, size: RepairSize, command: str) -> list[dict]:
    """Everything of the part: pairs of small walkers, repairs by the shipped walker, Table II by it and by the pairs.

    The pairs show what dropout does; whoever repairs a walk takes the walker that was trained for longer.
    """
    trials, weights = bench.trials, bench.weights
    best, pairs = (
        [checkpoints.load_walker(weights[name]) for name in names] for names in (["walker"], names_of("dropout"))
    )
    figures = [one for fault in FAULTS for one in repair_figures(fault, best[0], trials, size)]
    for who, walkers, asked in (("", best, trials), ("pairs_", pairs, trials.first(PAIRS_CLIPS))):
        second, after = table_2(walkers, asked, size, who)
        figures += second
        for suffix, rule in (("", ROBUST), ("_paper", PAPER)):
            figures.append(footsteps(f"footsteps_{who}over_data{suffix}", after, asked, rule))
    seeds = {"data": UNSEEN, "clips": len(trials.past), "missing": SHARE, "samples": size.samples}
    seeds |= {"rounds": size.rounds, "steps": size.steps, "clips_of_pairs": PAIRS_CLIPS}
    seeds |= {"weights": [weights_digest(weights[name]) for name in ("walker", *names_of("dropout"))]}
    return dropout_records(trials, weights, command) + [one.as_record("mend.", seeds, command) for one in figures]
