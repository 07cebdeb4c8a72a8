"""Train a recipe into a walker: data, windows, loop, card. A killed run continues where it was saved last."""

import datetime
import hashlib
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
from ..runs import notes_of, resume_run, saver
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
    config = recipe.config
    windows = Windows.of(clips or training_clips(recipe), config.T_h, config.T_p)
    about = asdict(recipe) | {"network": type(config).__name__, "data": digest(windows)}
    schedule = SCHEDULES[recipe.schedule](config.S)
    device = "cuda" if torch.cuda.is_available() else "cpu"
    model = network(config, windows.pose_scaler, windows.control_scaler).to(device)
    state = TrainState.start(model, recipe.seed, optimizer_for(model, recipe.optimizer))
    if run_file.exists():
        resume_run(state, run_file, about)
        log(f"{recipe.name}: continuing at step {state.step}")
    sittings = notes_of(run_file)
    if state.step < recipe.steps:
        sittings = [*sittings, {"from_step": state.step, **where(device)}]
    loss_fn = window_loss(windows, schedule, **recipe.loss_settings)
    rate = cosine_lr(recipe.lr, recipe.steps, warmup=min(500, recipe.steps // 4))
    run_to_end(recipe.name, recipe, rate, state, loss_fn, saver(run_file, about, sittings), log)
    card = card_of(recipe, windows, state, sittings)
    card["final_loss"] = round(mean_loss(loss_fn, state.average), 6)
    return Walker(state.average.cpu().eval(), schedule, windows.pose_scaler, windows.control_scaler, card)


def control_range(windows: Windows) -> dict[str, list[float]]:
    """The smallest and the largest of each column of the control in the data; m/s, m/s, rad/s."""
    control = windows.control_scaler.inverse(windows.control)
    return {name: [round(float(x), 3) for x in values] for name, values in
            (("low", control.amin(0)), ("high", control.amax(0)))}  # fmt: skip


def digest(windows: Windows) -> str:
    """Of the frames as the network sees them: a run goes on with the data it was begun with, or not at all."""
    frames = (windows.poses.numpy(), windows.control.numpy())
    return hashlib.sha256(b"".join(array.tobytes() for array in frames)).hexdigest()[:16]


@torch.no_grad()
def mean_loss(loss_fn, network: torch.nn.Module, batches: int = 50) -> float:
    """Of the averaged network, on batches drawn with a seed of their own."""
    generator = torch.Generator().manual_seed(1)
    return float(np.mean([loss_fn(network, generator).item() for _ in range(batches)]))


def run_to_end(name: str, recipe, rate, state: TrainState, loss_fn, save, log) -> None:
    """Train to the last step, with a word every thousand steps, or twenty times."""
    settings = {"lr": rate, "decay": recipe.decay, "save": save, "save_every": recipe.save_every, "progress": False}
    losses, every = [], min(1000, max(1, recipe.steps // 20))
    for report in train_steps(state, loss_fn, recipe.steps, **settings):
        losses.append(report.loss)
        if report.step % every == 0:
            mean, minutes = np.mean(losses[-every:]), state.seconds / 60
            log(f"{name} {report.step}/{recipe.steps}: loss {mean:.5f}, {minutes:.1f} min")


def commit_of(folder: Path) -> str:
    """The commit of the checkout whose top `folder` is, "-dirty" when files differ from it."""
    if not (folder / ".git").exists():  # a package installed within somebody's own repository has no commit of ours
        return "not in a checkout"
    command = ["git", "-C", str(folder), "describe", "--always", "--dirty"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError:  # no git here
        return "unknown"
    return done.stdout.strip() or "not in a checkout"


def where(device: str) -> dict:
    """The code and the machine of one sitting."""
    return {
        "commit": commit_of(Path(__file__).parents[2]),
        "date": datetime.date.today().isoformat(),
        "machine": torch.cuda.get_device_name() if device == "cuda" else platform.machine(),
        "threads": torch.get_num_threads(),
        "torch": torch.__version__,
    }


def card_of(recipe: Recipe, windows: Windows, state: TrainState, sittings: list[dict]) -> dict:
    """What a reader of the weights wants to know; `make results` adds the measured figures."""
    settings = {k: v for k, v in asdict(recipe).items() if k not in ("config", "name")}
    return {
        "name": recipe.name,
        "target": recipe.config.target,
        "recipe": settings,
        "parameters": sum(p.numel() for p in state.model.parameters()),
        "frames": len(windows.poses),
        "control_range": control_range(windows),
        "minutes": round(state.seconds / 60, 1),
        "sittings": sittings,
        "data": "data_synth.walking, synthetic",
    }
