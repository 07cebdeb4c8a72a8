"""What 80 CPU-seconds of training give: a small walker on the walks of one style (and of all), on unseen controls.

One thread; the budget counts only the training loop. Raw output, DDPM with S = 100, held control.
Run: python benchmarks/walker_80s.py [--seconds 80] [--style neutral] [--out benchmarks/results/walker_80s.json]
"""

import argparse
import sys
from dataclasses import replace
from pathlib import Path

import torch
from records import show, write_records

sys.path.insert(0, str(Path(__file__).parents[1]))  # tools, beside this folder

from data_synth.walking import dataset  # noqa: E402
from motiondiff_edu.motion.augment import augment  # noqa: E402
from motiondiff_edu.pretrained.budget import train_for  # noqa: E402
from motiondiff_edu.pretrained.recipes import WALKER_X0  # noqa: E402
from tools.results.scores import score  # noqa: E402
from tools.results.trials import FPS, SECONDS, T_H, UNSEEN, Trials, walker_generate  # noqa: E402

COMMAND = "python -m benchmarks walker"
CLIPS = 120
CONFIG = replace(
    WALKER_X0.config, width=96, hidden=192, motion_layers=1, control_layers=1, cross_layers=1, decoder_layers=2
)
NAMES = {"bone_rmse_cm", "adherence_excess_mps", "adherence_mps", "adherence_data_mps", "adherence_shuffled_over_own"}


def measure(style: str | None, seconds: float, unseen: int, seed: int) -> list[dict]:
    """Train on one style (None: all of them), walk unseen controls of the same, and score the raw output."""
    styles, name = ([style], "bench.walker_80s_") if style else (None, "bench.walker_80s_all_styles_")
    clips = augment(dataset(CLIPS, 20, seed=11, styles=styles))
    trials = Trials.of(dataset(unseen, SECONDS + T_H / FPS, seed=UNSEEN, styles=styles))
    walker, steps = train_for(seconds, clips, CONFIG, seed=seed)
    weights = sum(p.numel() for p in walker.model.parameters())
    print(f"{style or 'all styles'}: {steps} steps in {seconds:g} CPU-seconds, {weights} weights", flush=True)
    walks = walker_generate(walker)(trials.past, trials.control, 0)
    seeds = {"data": UNSEEN, "training": seed, "clips": unseen}
    found = score(walks, trials.asked, trials.truth)
    return [figure.as_record(name, seeds, COMMAND) for figure in found if figure.name in NAMES]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=80)
    parser.add_argument("--style", default="neutral")
    parser.add_argument("--clips", type=int, default=50, help="unseen controls to walk")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--one-style", action="store_true", help="leave out the run on all styles")
    parser.add_argument("--out", default="benchmarks/results/walker_80s.json")
    args = parser.parse_args()
    torch.set_num_threads(1)
    records = []
    for style in (args.style, None)[: 1 if args.one_style else 2]:
        records += measure(style, args.seconds, args.clips, args.seed)
        show([one for one in records[-len(NAMES) :] if one["value"] is not None])
    write_records(args.out, records)


if __name__ == "__main__":
    main()
