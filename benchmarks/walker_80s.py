"""What 80 CPU-seconds of training give: a small walker on the walks of one style (and of all), on unseen controls.

One thread; the budget counts only the training loop. Raw output, DDPM with S = 100, held control.
Run: python benchmarks/walker_80s.py [--seconds 80] [--style neutral] [--out benchmarks/results/walker_80s.json]
"""

import argparse
import math
import sys
import time
from dataclasses import replace
from pathlib import Path

import torch
from records import show, write_records

sys.path.insert(0, str(Path(__file__).parents[1]))  # tools, beside this folder

from data_synth.walking import dataset  # noqa: E402
from motiondiff_edu.ddpm import linear_schedule  # noqa: E402
from motiondiff_edu.modiff import MODIFF_SMALL, MoDiff, MoDiffConfig  # noqa: E402
from motiondiff_edu.motion.augment import augment  # noqa: E402
from motiondiff_edu.muon import MuonAndAdam  # noqa: E402
from motiondiff_edu.training import TrainState, train_steps  # noqa: E402
from motiondiff_edu.walker import Walker  # noqa: E402
from motiondiff_edu.windows import Windows, window_loss  # noqa: E402
from tools.results.scores import score  # noqa: E402
from tools.results.trials import FPS, SECONDS, T_H, UNSEEN, Trials, walker_generate  # noqa: E402

COMMAND = "python -m benchmarks walker"
PEAK, CLIPS = 3e-3, 120
LOSS = {"batch": 32, "noises": 2, "jitter": 0.3, "metres": 2.0, "near": 1.0}
CONFIG = replace(
    MODIFF_SMALL, target="x0", skip=False, width=96, hidden=192, motion_layers=1, control_layers=1, cross_layers=1,
    decoder_layers=2,
)  # fmt: skip
NAMES = {"bone_rmse_cm", "adherence_excess_mps", "adherence_mps", "adherence_data_mps", "adherence_shuffled_over_own"}


def train(clips: list, seconds: float, config: MoDiffConfig = CONFIG, seed: int = 0) -> tuple[Walker, int]:
    """Train until the CPU-seconds are spent; the learning rate follows a half cosine over them."""
    torch.manual_seed(seed)
    windows, schedule = Windows.of(clips), linear_schedule(config.S)
    model = MoDiff(config)
    state, start = TrainState.start(model, seed, MuonAndAdam(model)), time.process_time()

    def spent() -> float:
        return (time.process_time() - start) / seconds

    def rate(step: int) -> float:
        return PEAK * min(1, (step + 1) / 100) * 0.5 * (1 + math.cos(math.pi * min(1.0, spent())))

    loss = window_loss(windows, schedule, **LOSS)
    for _ in train_steps(state, loss, 10**9, lr=rate, decay=0.99, progress=False):
        if spent() >= 1:
            break
    return Walker(state.average.eval(), schedule, windows.pose_scaler, windows.control_scaler), state.step


def measure(style: str | None, seconds: float, unseen: int, seed: int) -> list[dict]:
    """Train on one style (None: all of them), walk unseen controls of the same, and score the raw output."""
    styles, name = ([style], "bench.walker_80s_") if style else (None, "bench.walker_80s_all_styles_")
    clips = augment(dataset(CLIPS, 20, seed=11, styles=styles))
    trials = Trials.of(dataset(unseen, SECONDS + T_H / FPS, seed=UNSEEN, styles=styles))
    walker, steps = train(clips, seconds, seed=seed)
    weights = sum(p.numel() for p in walker.model.parameters())
    print(f"{style or 'all styles'}: {steps} steps in {seconds:g} CPU-seconds, {weights} weights", flush=True)
    walks = walker_generate(walker)(trials.past, trials.control, 0)
    seeds = {"data": UNSEEN, "training": seed, "clips": unseen}
    return [
        dict(name=name + f.name, value=f.value, low=f.low, high=f.high, seeds=seeds, unit=f.unit, paper=None,
             command=COMMAND)
        for f in score(walks, trials.asked, trials.truth) if f.name in NAMES
    ]  # fmt: skip


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
        show(records[-len(NAMES) :])
    write_records(args.out, records)


if __name__ == "__main__":
    main()
