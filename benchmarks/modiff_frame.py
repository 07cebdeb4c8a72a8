"""One autoregressive frame of MoDiff, S = 100, batch 1.

Ours is compared with the whole network under diffusers' DDPMScheduler.

Both sides have the same weights and the same noise, and end at the same poses (checked first). Ours
encodes past and control once a frame and keeps keys, values and step embeddings. Timed in turn, in
changing order. Run: python benchmarks/modiff_frame.py [--repeats 12] [--threads 1 2] [--out
benchmarks/results/modiff_frame.json]
"""

import argparse
import os
from collections.abc import Callable

import numpy as np
import torch
from diffusers import DDPMScheduler
from records import record, show, write_records
from timing import in_turn

from motiondiff_edu.ddpm import linear_schedule
from motiondiff_edu.modiff import MODIFF_PAPER, MODIFF_SMALL, MoDiff, MoDiffConfig
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.performers.walker import Walker

COMMAND = "python -m benchmarks frame"
SIZES = {"paper": MODIFF_PAPER, "small": MODIFF_SMALL}
Sampler = Callable[[torch.Tensor, torch.Tensor, torch.Generator], torch.Tensor]


def network(config: MoDiffConfig) -> Walker:
    """A MoDiff with random weights and scalers that do nothing.

    Its predictions do not matter here.
    """
    torch.manual_seed(0)
    unit = [Scaler(torch.zeros(n), torch.ones(n)) for n in (config.D, config.C)]
    return Walker(MoDiff(config).eval().requires_grad_(False), linear_schedule(config.S), *unit)


def whole_network(walker: Walker) -> Sampler:
    """The naive loop: encoders and decoder at each of the S steps, driven by diffusers."""
    config = walker.config
    scheduler = DDPMScheduler(
        config.S, beta_start=1e-4, beta_end=0.1, variance_type="fixed_large", clip_sample=False
    )
    scheduler.set_timesteps(config.S)

    @torch.inference_mode()
    def sample(past, control, generator):
        x = torch.randn(1, config.T_p, config.D, generator=generator)
        for t in scheduler.timesteps:
            eps_hat = walker.model(x, t[None] + 1, past, control)
            x = scheduler.step(eps_hat, t, x, generator=generator).prev_sample
        return x

    return sample


def samplers(walker: Walker) -> dict[str, Sampler]:
    few = {f"ddim{n}": walker.window_sampler(n) for n in (10, 5)}
    return {"diffusers": whole_network(walker), "ours": walker.window_sampler()} | few


def inputs(config: MoDiffConfig) -> tuple[torch.Tensor, torch.Tensor]:
    draw = torch.Generator().manual_seed(1)
    past = torch.randn(1, config.T_h, config.D, generator=draw)
    return past, torch.randn(1, config.T_h + config.T_p, config.C, generator=draw)


def check_equal(runs: dict[str, Sampler], past: torch.Tensor, control: torch.Tensor) -> None:
    """Both sides do the same work: the same noise leads to the same poses."""
    ours, theirs = (
        runs[name](past, control, torch.Generator().manual_seed(2))
        for name in ("ours", "diffusers")
    )
    apart = float((ours - theirs).abs().max() / theirs.abs().max())
    print(f"  the same noise leads to the same poses, up to {apart:.1e} of their size")
    if not apart < 1e-3:
        raise SystemExit(
            "the two sides do not compute the same thing; their times cannot be compared"
        )


def measure(runs: dict[str, Sampler], past, control, repeats: int) -> dict[str, np.ndarray]:
    """Milliseconds per frame of every sampler in every repeat."""
    generator = torch.Generator()
    frames = {
        name: lambda run=run: run(past, control, generator.manual_seed(3))
        for name, run in runs.items()
    }
    return in_turn(frames, repeats)


def records_of(size: str, threads: int, times: dict[str, np.ndarray], bar: bool) -> list[dict]:
    """Records of milliseconds, median and least, and of the speed ratio.

    With `bar` the ratio has the name of the goal.
    """
    stem, records = f"bench.modiff_frame_{size}", []
    middle = f"{stem}_{threads}thread{'s' * (threads > 1)}"
    for name, values in times.items():
        records.append(record(f"{middle}.{name}_ms", values, unit="ms", command=COMMAND))
        least = record(
            f"{middle}.{name}_least_ms", values, unit="ms", command=COMMAND, center=np.min
        )
        records.append(least)
    ratio = times["diffusers"] / times["ours"]
    return [
        *records,
        record(f"{stem}_x" if bar else f"{middle}_x", ratio, unit="times", command=COMMAND),
    ]


def main() -> None:
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=12)
    parser.add_argument("--threads", type=int, nargs="+", default=sorted({1, min(2, cores)}))
    parser.add_argument("--out", default="benchmarks/results/modiff_frame.json")
    args, records = parser.parse_args(), []
    for size, config in SIZES.items():
        walker, (past, control) = network(config), inputs(config)
        runs = samplers(walker)
        check_equal(runs, past, control)
        for threads in args.threads:
            torch.set_num_threads(threads)
            times = measure(runs, past, control, args.repeats)
            records += records_of(size, threads, times, threads == max(args.threads))
    show(records)
    write_records(args.out, records)


if __name__ == "__main__":
    main()
