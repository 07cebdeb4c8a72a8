"""Train a recipe into a walker: data, windows, loop, card. A killed run continues where it was saved last."""

import datetime
import itertools
import platform
import subprocess
from dataclasses import asdict
from pathlib import Path

import numpy as np
import torch

from ..foothold import network
from ..motion.augment import mirror, reverse_time
from ..motion.clip import Clip
from ..muon import optimizer_for
from ..runs import resume_run, saver
from ..training import TrainState, cosine_lr, train_steps
from ..walker import SCHEDULES, Walker
from ..windows import Windows, window_loss
from .recipes import Recipe


def training_clips(recipe: Recipe) -> list[Clip]:
    """The recipe's data: made from its seed, every clip mirrored as well, a share of both reversed in time."""
    from data_synth.walking import dataset  # data_synth lies beside the package, and imports it

    clips = dataset(recipe.clips, recipe.seconds, seed=recipe.data_seed, styles=recipe.styles)
    both = [version for clip in clips for version in (clip, mirror(clip))]
    chosen = np.random.default_rng(recipe.data_seed).random(len(both)) < recipe.reversed_share
    return both + [reverse_time(clip) for clip, take in zip(both, chosen, strict=True) if take]


def train(recipe: Recipe, run_file: Path, clips: list[Clip] | None = None, log=print) -> Walker:
    """Train (or continue) a recipe; `run_file` holds the run.  Returns the averaged network as a walker.

    Raises ValueError when the run in `run_file` was begun with other settings.
    """
    torch.manual_seed(recipe.seed)
    config, commit, about = recipe.config, commit_of(Path(__file__).parent), asdict(recipe)
    windows = Windows.of(clips or training_clips(recipe), config.T_h, config.T_p)
    schedule = SCHEDULES[recipe.schedule](config.S)
    device = "cuda" if torch.cuda.is_available() else "cpu"
    model = network(config, windows.pose_scaler, windows.control_scaler).to(device)
    state = TrainState.start(model, recipe.seed, optimizer_for(model, recipe.optimizer))
    if run_file.exists():
        resume_run(state, run_file, about)
        log(f"{recipe.name}: continuing at step {state.step}")
    loss_fn = window_loss(windows, schedule, **recipe.loss_settings)
    losses = _run(recipe, state, loss_fn, device, saver(run_file, about), log)
    card = card_of(recipe, windows, state.seconds / 60, commit, device)
    card["parameters"] = sum(p.numel() for p in model.parameters())
    card["final_loss"] = round(float(np.mean(losses[-1000:])), 6) if losses else None
    return Walker(state.average.cpu().eval(), schedule, windows.pose_scaler, windows.control_scaler, card)


def _run(recipe: Recipe, state: TrainState, loss_fn, device: str, save, log) -> list[float]:
    """Train to the last step, the first share of them in bfloat16; the losses."""
    lr = cosine_lr(recipe.lr, recipe.steps, warmup=500)
    settings = {"lr": lr, "decay": recipe.decay, "save": save, "save_every": 2000, "progress": False}
    loop = itertools.chain(
        train_steps(state, _in_bf16(loss_fn, device), int(recipe.bf16_share * recipe.steps), **settings),
        train_steps(state, loss_fn, recipe.steps, **settings),
    )
    losses = []
    for report in loop:
        losses.append(report.loss)
        if report.step % 1000 == 0:
            mean, minutes = np.mean(losses[-1000:]), state.seconds / 60
            log(f"{recipe.name} {report.step}/{recipe.steps}: loss {mean:.5f}, {minutes:.1f} min")
    return losses


def _in_bf16(loss_fn, device: str):
    def run(model, generator):
        with torch.autocast(device, torch.bfloat16):
            return loss_fn(model, generator)

    return run


def commit_of(folder: Path) -> str:
    """The commit of the checkout that `folder` lies in, "-dirty" when files differ from it."""
    command = ["git", "-C", str(folder), "describe", "--always", "--dirty"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError:  # no git here
        return "unknown"
    return done.stdout.strip() or "not in a checkout"


def card_of(recipe: Recipe, windows: Windows, minutes: float, commit: str, device: str) -> dict:
    """What a reader of the weights wants to know; the figures are added by `make results`."""
    settings = {k: v for k, v in asdict(recipe).items() if k not in ("config", "name")}
    threads = f"{torch.get_num_threads()} threads"
    return {
        "name": recipe.name,
        "target": recipe.config.target,
        "recipe": settings,
        "frames": len(windows.poses),
        "minutes": round(minutes, 1),
        "machine": f"{torch.cuda.get_device_name() if device == 'cuda' else platform.machine()}, {threads}",
        "torch": torch.__version__,
        "commit": commit,
        "date": datetime.date.today().isoformat(),
        "data": "data_synth.walking, synthetic",
    }
