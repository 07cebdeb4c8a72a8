"""The time of a training step and of a dance, for several networks: is MoFusion's U-Net light?

Times are CPU-seconds of one thread. The networks take turns in every round, so that a ratio is of
the same minutes. They are untrained, because the weights do not matter here.  Source: MoFusion 1
(lightweight); the measure is ours
"""

import time
from dataclasses import replace

import torch

from benchmarks.records import record
from motiondiff_edu.baselines.transformer import TransformerConfig
from motiondiff_edu.ddpm import cosine_schedule
from motiondiff_edu.mofusion import MOFUSION_SMALL
from motiondiff_edu.performers.dance_windows import DanceWindows
from motiondiff_edu.performers.dancer import STEPS, Dancer
from motiondiff_edu.performers.networks import Config, network
from motiondiff_edu.recipes.dancer import DanceRecipe, loss_of, training_windows
from motiondiff_edu.recipes.muon import optimizer_for
from motiondiff_edu.training import TrainState, train_steps

BASE = "unet"
NETWORKS: dict[str, Config] = {  # of equal size
    "unet": replace(MOFUSION_SMALL, target="x0", skip=False),
    "transformer": TransformerConfig(),
}
DANCES = 8  # at once
BATCH = 16  # windows a step of training


class Clock:
    """One network with the inputs of a training step, a pass and a dance.

    Times are CPU-seconds of one call.
    """

    def __init__(self, recipe: DanceRecipe, windows: DanceWindows):
        schedule = cosine_schedule(recipe.config.S)
        torch.manual_seed(recipe.seed)
        model = network(recipe.config)
        state = TrainState.start(model, recipe.seed, optimizer_for(model, recipe.optimizer))
        self.training = train_steps(
            state, loss_of(recipe, windows, schedule), 10**6, lr=1e-4, progress=False
        )
        self.dancer = Dancer(state.average, schedule, windows.motion_scaler, windows.mel_scaler)
        self.parameters = sum(p.numel() for p in model.parameters())
        x0, self.mel, _ = windows.draw(DANCES, torch.Generator().manual_seed(0))
        self.x_s, self.times = x0, windows.mel_times

    def step(self) -> None:
        next(self.training)

    @torch.inference_mode()
    def one_pass(self) -> None:
        """One call of the plain network, music included."""
        music = self.dancer.model.listen(self.mel, self.times)
        self.dancer.model(self.x_s, torch.full((len(self.x_s),), 500), music)

    def dance(self) -> None:
        """A dance as for a user: DDIM."""
        mel = self.dancer.mel_scaler.inverse(self.mel)
        self.dancer.dance_mel(mel, self.x_s.shape[1], generator=torch.Generator().manual_seed(0))


def spent(call) -> float:
    """CPU-seconds of this process."""
    began = time.process_time()
    call()
    return time.process_time() - began


def recipe_of(name: str) -> DanceRecipe:
    """A training of a network; how many songs there are does not change the time of a step."""
    return DanceRecipe(
        f"dance-time.{name}", NETWORKS[name], steps=1, songs=2, seconds=8.0, batch=BATCH,
        kinematic=None, changes=0.0, toes=0.0,
    )  # fmt: skip


def time_records(rounds: int, command: str) -> list[dict]:
    """Steps, passes and dances of all networks in turns.

    Each has a record of its median, and of its ratio to BASE in the same round.
    """
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    windows = training_windows(recipe_of(BASE))
    clocks = {name: Clock(recipe_of(name), windows) for name in NETWORKS}
    spans: dict[tuple[str, str], list[float]] = {}
    for turn in range(rounds + 1):
        for name, clock in clocks.items():
            calls = {"step": clock.step, "pass": clock.one_pass, "dance": clock.dance}
            for what, call in calls.items():
                seconds = spent(call)
                if turn:  # the first round is a warm-up
                    spans.setdefault((name, what), []).append(seconds)
    torch.set_num_threads(before)
    about = {
        "rounds": rounds,
        "batch": BATCH,
        "dances": DANCES,
        "frames": clock.x_s.shape[1],
        "steps": STEPS,
    }
    found = []
    for name in NETWORKS:
        found.append(
            record(
                f"dance-time.{name}.parameters", [clocks[name].parameters], unit="", command=command
            )
        )
        for what in ("step", "pass", "dance"):
            mine, base = spans[name, what], spans[BASE, what]
            kind = f"dance-time.{name}.{what}"
            found.append(
                record(f"{kind}_ms", [1000 * s for s in mine], unit="CPU ms", command=command)
            )
            ratios = [a / b for a, b in zip(mine, base, strict=True)]
            found.append(record(f"{kind}_over_{BASE}", ratios, unit="ratio", command=command))
    return [one | {"seeds": about} for one in found]
