"""The cost of a sampler around a model that costs nothing.

Ours is compared with diffusers and smalldiffusion, in one run.

Each repeat times all of them one after the other, in changing order; a record is the median of the
ratios of repeats. Run: python benchmarks/sampler_overhead.py [--repeats 40] [--out
benchmarks/results/sampler_overhead.json]
"""

import argparse
import importlib.util
from types import SimpleNamespace

import torch
from diffusers import DDIMScheduler, DDPMScheduler
from records import record, show, write_records
from timing import in_turn

from motiondiff_edu.ddpm import ddim_steps, linear_schedule, sample_steps

S, SHAPE = 100, (1, 10, 63)
COMMAND = "python -m benchmarks sampler"
ANSWER = torch.zeros(SHAPE)


def trivial(x, s):
    """A model that costs nothing, so that only the sampler is timed."""
    return ANSWER


def run_ours(sampler):
    schedule = linear_schedule(S)

    def run(x):
        for step in sampler(trivial, x, schedule):
            x = step.x_s
        return x

    return run


def run_diffusers(kind):
    scheduler = kind(num_train_timesteps=S, beta_start=1e-4, beta_end=0.1, clip_sample=False)
    scheduler.set_timesteps(S)

    @torch.no_grad()
    def run(x):
        for t in scheduler.timesteps:
            x = scheduler.step(trivial(x, t), t, x).prev_sample
        return x

    return run


def smalldiffusion_sampler():
    """Its sampling module, loaded from its file: the whole package would need torchvision."""
    spec = importlib.util.find_spec("smalldiffusion")
    path = spec.submodule_search_locations[0] + "/diffusion.py"
    spec = importlib.util.spec_from_file_location("smalldiffusion_sampling", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def run_smalldiffusion():
    theirs = smalldiffusion_sampler()
    sigmas = theirs.ScheduleDDPM(S, 1e-4, 0.1).sample_sigmas(S)
    model = SimpleNamespace(
        eval=lambda: None,
        rand_input=lambda n: torch.randn(n, *SHAPE[1:]),
        predict_eps_cfg=lambda x, sigma, cond, scale: trivial(x, sigma),
    )
    here = SimpleNamespace(device=torch.device("cpu"))

    def run(x):
        for out in theirs.samples(
            model, sigmas, gam=1, mu=0.5, xt=x * float(sigmas[0]), accelerator=here
        ):
            x = out
        return x

    return run


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=40)
    parser.add_argument("--out", default="benchmarks/results/sampler_overhead.json")
    args = parser.parse_args()
    torch.set_num_threads(1)
    runs = {
        "ours": run_ours(sample_steps),
        "ours_ddim": run_ours(lambda m, x, sch: ddim_steps(m, x, sch, steps=S)),
        "diffusers": run_diffusers(DDPMScheduler),
        "diffusers_ddim": run_diffusers(DDIMScheduler),
        "smalldiffusion": run_smalldiffusion(),
    }
    x = torch.randn(SHAPE)
    loops = {name: lambda run=run: run(x) for name, run in runs.items()}
    times = {
        name: 1000 * ms / S
        for name, ms in in_turn(loops, args.repeats, best_of=3, warmup=3).items()
    }
    records = [
        record(f"bench.sampler_us.{name}", values, unit="us a step", command=COMMAND)
        for name, values in times.items()
    ]
    for peer in ("diffusers", "smalldiffusion"):
        records.append(
            record(
                f"bench.sampler_over_{peer}",
                times["ours"] / times[peer],
                unit="ratio",
                command=COMMAND,
            )
        )
    show(records)
    write_records(args.out, records)


if __name__ == "__main__":
    main()
