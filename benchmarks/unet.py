"""MoFusion's U-Net, with its music, compared with two unconditioned ones.

These are lucidrains' Unet1D and diffusers' UNet1DModel.

The networks have about equally many parameters (widths are chosen for that) and random weights.
Sampling is ten DDIM steps for eight motions, each side with its own sampler. Training is a forward
and a backward pass and a step of Adam. All are timed in turn. Run: python -m benchmarks unet
[--repeats 12] [--out benchmarks/results/unet.json]
"""

import argparse
import importlib
import importlib.util
import sys
from functools import cache
from types import ModuleType

import numpy as np
import torch
from records import record, show, write_records
from timing import in_turn

from motiondiff_edu.conditions.music import frame_times
from motiondiff_edu.ddpm import cosine_schedule
from motiondiff_edu.mofusion import MOFUSION_SMALL, MoFusion
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.performers.dance_windows import mel_frames
from motiondiff_edu.performers.dancer import Dancer

COMMAND = "python -m benchmarks unet"
D = 63
BANDS = 80
STEPS = 10
PEER = "denoising_diffusion_pytorch"


def count(model: torch.nn.Module) -> int:
    return sum(p.numel() for p in model.parameters())


@cache
def lucidrains():
    """The module of Unet1D alone.

    The package as a whole imports torchvision, which it does not need here.
    """
    spec = importlib.util.find_spec(PEER)
    if spec is None:
        raise SystemExit(
            f"{PEER} is not installed: pip install --no-deps "
            "denoising-diffusion-pytorch einops ema-pytorch"
        )
    bare = ModuleType(PEER)
    bare.__path__ = list(spec.submodule_search_locations)
    sys.modules[PEER] = bare
    module = importlib.import_module(f"{PEER}.{PEER}_1d")
    module.tqdm = lambda steps, desc="", total=None: steps  # its bar would be timed, too
    return module


def closest(build, sizes, wanted: int) -> torch.nn.Module:
    """The network whose number of parameters is nearest to `wanted`."""
    torch.manual_seed(0)
    return build(min(sizes, key=lambda size: abs(count(build(size)) - wanted)))


def ours() -> Dancer:
    """The small configuration, with random weights and scalers that do nothing."""
    torch.manual_seed(0)
    scalers = [Scaler(torch.zeros(n), torch.ones(n)) for n in (D, BANDS)]
    return Dancer(MoFusion(MOFUSION_SMALL).eval(), cosine_schedule(MOFUSION_SMALL.S), *scalers)


def theirs(wanted: int) -> dict[str, torch.nn.Module]:
    from diffusers import UNet1DModel

    module = lucidrains()

    def diffusers_net(width):
        return UNet1DModel(
            in_channels=D,
            out_channels=D,
            extra_in_channels=2 * width,
            block_out_channels=(width, 2 * width, 3 * width),
        )

    return {
        "lucidrains": closest(
            lambda dim: module.Unet1D(dim, dim_mults=(1, 2, 3), channels=D),
            range(32, 97, 8),
            wanted,
        ),
        "diffusers": closest(diffusers_net, range(32, 257, 32), wanted),
    }


def samplers(dancer: Dancer, nets: dict[str, torch.nn.Module], B: int, N: int) -> dict:
    """Ten DDIM steps of each, from noise to motion."""
    from diffusers import DDIMScheduler

    mel = torch.randn(B, mel_frames(N), BANDS)
    diffusion = lucidrains().GaussianDiffusion1D(
        nets["lucidrains"], seq_length=N, sampling_timesteps=STEPS
    )
    scheduler = DDIMScheduler(1000, beta_schedule="squaredcos_cap_v2", clip_sample=False)

    @torch.inference_mode()
    def ours_once():
        return dancer.dance_mel(mel, N, steps=STEPS, eta=0.0)

    @torch.inference_mode()
    def lucidrains_once():
        return diffusion.ddim_sample((B, D, N))

    @torch.inference_mode()
    def diffusers_once():
        scheduler.set_timesteps(STEPS)
        x = torch.randn(B, D, N)
        for t in scheduler.timesteps:
            x = scheduler.step(nets["diffusers"](x, t).sample, t, x).prev_sample
        return x

    runs = {"ours": ours_once, "lucidrains": lucidrains_once}
    return runs | (
        {"diffusers": diffusers_once} if N == 64 else {}
    )  # it cannot halve 200 frames often enough


def trainers(dancer: Dancer, nets: dict[str, torch.nn.Module], B: int, N: int) -> dict:
    """One step of training of each."""
    model, peer = dancer.model, nets["lucidrains"]
    mel = torch.randn(B, mel_frames(N), BANDS)
    times = frame_times(mel_frames(N)).float()
    x, s = torch.randn(B, N, D), torch.randint(1, 1000, (B,))
    channels_first = x.mT.contiguous()
    optimizers = {
        name: torch.optim.Adam(net.parameters(), fused=True)
        for name, net in (("o", model), ("p", peer))
    }

    def step(optimizer, out, wanted):
        optimizer.zero_grad()
        (out - wanted).square().mean().backward()
        optimizer.step()

    return {
        "ours": lambda: step(optimizers["o"], model(x, s, model.listen(mel, times)), x),
        "lucidrains": lambda: step(optimizers["p"], peer(channels_first, s), channels_first),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=12)
    parser.add_argument("--out", default="benchmarks/results/unet.json")
    args, records = parser.parse_args(), []
    dancer = ours()
    nets = theirs(count(dancer.model))
    sizes = {"ours": count(dancer.model)} | {name: count(net) for name, net in nets.items()}
    print("parameters:", ", ".join(f"{name} {n / 1e6:.2f} M" for name, n in sizes.items()))
    worst = None
    for N in (64, 200):
        times = in_turn(samplers(dancer, nets, 8, N), args.repeats)
        for name, values in times.items():
            records.append(
                record(f"bench.unet_sampling_n{N}.{name}_ms", values, unit="ms", command=COMMAND)
            )
        ratio = times["lucidrains"] / times["ours"]
        records.append(record(f"bench.unet_sampling_n{N}_x", ratio, unit="times", command=COMMAND))
        if "diffusers" in times:
            ratio = times["diffusers"] / times["ours"]
            records.append(
                record("bench.unet_sampling_diffusers_x", ratio, unit="times", command=COMMAND)
            )
        times = in_turn(trainers(dancer, nets, 32, N), args.repeats)
        for name, values in times.items():
            records.append(
                record(f"bench.unet_training_n{N}.{name}_ms", values, unit="ms", command=COMMAND)
            )
        ratio = times["lucidrains"] / times["ours"]
        worst = ratio if worst is None or np.median(ratio) < np.median(worst) else worst
    records.append(record("bench.unet_training_x", worst, unit="times", command=COMMAND))
    show(records)
    write_records(args.out, records)


if __name__ == "__main__":
    main()
