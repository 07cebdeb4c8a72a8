"""A walker after 80 CPU-seconds of training.

A small walker is trained on each of three sets of walks, and measured on unseen controls.

    one person   neutral, no waving and looking about, straight ahead and in curves:
                 notebook 07's data (the bars)
    one style    neutral walkers, all their behaviours, all kinds of control
    all styles   the walkers' training data, fewer clips

One thread; the budget counts only the training loop. Raw output, DDPM with S = 100, held control.
Run: python benchmarks/walker_80s.py [--seconds 80] [--only person] [--out
benchmarks/results/walker_80s.json]
"""

import argparse
import json
import sys
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import torch
from budget import BUDGET, train_for
from records import show, write_records

sys.path.insert(0, str(Path(__file__).parents[1]))  # tools, beside this folder

from data_synth.walking import dataset, random_control, walk  # noqa: E402
from data_synth.walking.styles import STYLES  # noqa: E402
from motiondiff_edu.motion.augment import mirror  # noqa: E402
from motiondiff_edu.motion.clip import Clip  # noqa: E402
from motiondiff_edu.recipes.walker import MEND_CONFIG  # noqa: E402
from tools.results.walks.scores import score  # noqa: E402
from tools.results.walks.trials import FPS, SECONDS, T_H, UNSEEN, Trials, walker_generate  # noqa: E402

COMMAND = "python -m benchmarks walker"
CLIPS = 240
SMALL = replace(MEND_CONFIG, hidden=256, cross_layers=1)  # small enough to learn in minutes
NAMES = {
    "bone_rmse_cm",
    "adherence_excess_mps",
    "adherence_mps",
    "adherence_data_mps",
    "adherence_shuffled_over_own",
}


def one_person(clips: int, seconds: float, seed: int) -> list[Clip]:
    rng = np.random.default_rng(seed)
    person = replace(STYLES["neutral"], behaviours=0.0)
    kinds = ("straight", "turn") * clips
    return [walk(random_control(seconds, rng, kinds[i]), seed + i, person) for i in range(clips)]


SETS: dict[str, tuple[str, Callable]] = {  # name: (prefix of its records, what makes its clips)
    "person": ("bench.walker_80s_", one_person),
    "style": ("bench.walker_80s_one_style_", partial(dataset, styles=["neutral"])),
    "all": ("bench.walker_80s_all_styles_", dataset),
}


def measure(name: str, seconds: float, unseen: int, seed: int) -> list[dict]:
    """Train on one set of walks, walk unseen controls of that set, and score the raw output.

    Each walk is mirrored, too.
    """
    prefix, make = SETS[name]
    clips = [version for clip in make(CLIPS, 20.0, 11) for version in (clip, mirror(clip))]
    trials = Trials.of(make(unseen, SECONDS + T_H / FPS, UNSEEN))
    recipe = replace(BUDGET, name=name, config=SMALL, seed=seed, batch=16)
    walker, steps = train_for(seconds, clips, recipe)
    weights = sum(p.numel() for p in walker.model.parameters())
    print(f"{name}: {steps} steps in {seconds:g} CPU-seconds, {weights} weights", flush=True)
    walks = walker_generate(walker)(trials.past, trials.control, 0)
    seeds = {"data": UNSEEN, "training": seed, "clips": unseen}
    found = score(walks, trials.asked, trials.truth)
    return [measure.as_record(prefix, seeds, COMMAND) for measure in found if measure.name in NAMES]


def others(path: Path, measured: list[str]) -> list[dict]:
    """The records of the sets that are not measured now; they stay as they are."""
    kept = json.loads(path.read_text(encoding="utf-8")) if path.is_file() else []
    begins = tuple(SETS[name][0] for name in measured)
    return [one for one in kept if not one["name"].startswith(begins)]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=80)
    parser.add_argument("--clips", type=int, default=50, help="unseen controls to walk")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", nargs="+", choices=SETS, default=list(SETS))
    parser.add_argument("--out", default="benchmarks/results/walker_80s.json")
    args = parser.parse_args()
    torch.set_num_threads(1)
    records = []
    for name in args.only:
        records += measure(name, args.seconds, args.clips, args.seed)
        show([one for one in records[-len(NAMES) :] if one["value"] is not None])
    write_records(args.out, [*others(Path(args.out), args.only), *records])


if __name__ == "__main__":
    main()
