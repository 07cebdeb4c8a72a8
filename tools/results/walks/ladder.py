"""From the paper's walker to ours, one choice at a time: what each departure is worth.

All cells share one small network size, the data, and the budget: as many steps as 600 CPU-seconds
are worth on one thread, by a pace that was measured for all cells in turn. Each cell is trained
with three seeds. `ours` is the recipe of the shipped walker's trunk at this size, before diffusion
dropout is added at the end; from it one choice is taken out at a time. `printed` is the recipe as
MoDiff prints it, with TimeGrad's schedule, for MoDiff gives none; to it one choice is added at a
time.
Source: MoDiff III-D, IV-A, Alg. 1.  Notebook: 07
"""

import json
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass, field, replace
from functools import cache
from pathlib import Path

import numpy as np
import torch

from data_synth.walking import dataset
from motiondiff_edu._files import replacing
from motiondiff_edu.beyond.footholds import FootholdConfig
from motiondiff_edu.diffusion_dropout import P_D
from motiondiff_edu.metrics.adherence import adherence
from motiondiff_edu.metrics.skating import skating
from motiondiff_edu.motion.augment import augment
from motiondiff_edu.motion.clip import Clip
from motiondiff_edu.performers.walker import Walker
from motiondiff_edu.performers.windows import Windows
from motiondiff_edu.recipes.muon import optimizer_for
from motiondiff_edu.recipes.train_recipe import mean_loss
from motiondiff_edu.recipes.train_walker import (
    dropout_of,
    loss_of,
    prepared,
    train,
    training_clips,
)
from motiondiff_edu.recipes.walkers import MEND_CONFIG, OURS, LossWeights, Recipe
from motiondiff_edu.training import TrainState, TrainStep, train_steps

from ..repairs.trials import SHARE, continued, interval_over_seeds
from .scores import FPS, Measure, root_mean, squared_bone_error
from .trials import T_H, UNSEEN, Trials

SEEDS = 3
CPU_SECONDS = 600
VALIDATION = 700_000  # data seed of the clips that the rates are chosen on
RATES = {"adam": (3e-3, 1e-2, 3e-2), "muon": (3e-3, 1e-2, 3e-2)}
PRINTED_RATE = 5e-5  # MoDiff IV-A
LONGER = 4  # times the budget, for the printed recipe
TRIAL = 0.25  # share of the budget that each rate is tried for

EPS = replace(MEND_CONFIG, target="eps", skip=False)
EPS_SKIP = replace(MEND_CONFIG, target="eps", skip=True)
X0 = MEND_CONFIG
FOOTHOLDS = FootholdConfig(**asdict(MEND_CONFIG))
COMMON = {"steps": 0, "clips": 360, "save_every": 500}

OUR_CELL = Recipe(
    "ours",
    FOOTHOLDS,
    **COMMON,
    schedule="leap",
    optimizer="muon",
    batch=32,
    noises=2,
    past_noise=0.3,
    loss_weights=OURS,
)
PRINTED = Recipe("printed", EPS, **COMMON, lr=PRINTED_RATE, held_control=0.0, dropout=P_D)


@dataclass(frozen=True)
class Cell:
    """One recipe: what differs, in words, from which other cell (none: a recipe as a whole)."""

    words: str
    base: str
    recipe: Recipe
    tuned: bool = True  # the rate is the best of RATES; else the recipe's own
    budget: float = 1.0  # times CPU_SECONDS


def left_out(words: str, **changes) -> Cell:
    return Cell(words, "ours", replace(OUR_CELL, **changes))


def added(words: str, tuned: bool = False, **changes) -> Cell:
    return Cell(words, "printed", replace(PRINTED, **changes), tuned)


CELLS = {
    "ours": Cell("our recipe", "", OUR_CELL),
    "ours-eps": left_out("eps instead of x0, no footholds", config=EPS),
    "ours-skip": left_out("eps with the skip instead of x0, no footholds", config=EPS_SKIP),
    "ours-no-footholds": left_out("no footholds", config=X0),
    "ours-adam": left_out("Adam instead of Muon", optimizer="adam"),
    "ours-linear": left_out("linear schedule, 1e-4 to 0.1", schedule="linear"),
    "ours-plain-loss": left_out("the plain loss", loss_weights=LossWeights()),
    "ours-clean-past": left_out("the past as it is", past_noise=0.0),
    "ours-dropout": left_out(
        "diffusion dropout instead of past noise", past_noise=0.0, dropout=P_D
    ),
    "ours-both": left_out("diffusion dropout beside past noise", dropout=P_D),
    "ours-both-light": Cell(
        "both, noised pasts with a fifth of the weight",
        "ours-both",
        replace(OUR_CELL, dropout=P_D, noised_past_weight=0.2),
    ),
    "ours-never-held": left_out("control never held", held_control=0.0),
    "ours-T_p-1": left_out("T_p = 1", config=replace(FOOTHOLDS, T_p=1)),
    "ours-T_p-5": left_out("T_p = 5", config=replace(FOOTHOLDS, T_p=5)),
    "ours-T_p-20": left_out("T_p = 20", config=replace(FOOTHOLDS, T_p=20)),
    "printed": Cell("the printed recipe", "", PRINTED, tuned=False),
    "printed-longer": Cell(
        f"{LONGER} times the budget", "printed", PRINTED, tuned=False, budget=LONGER
    ),
    "printed-skip": added("the skip", config=EPS_SKIP),
    "printed-x0": added("x0 instead of eps", config=X0),
    "printed-footholds": added("x0 with footholds", config=FOOTHOLDS),
    "printed-rate": added("Adam at the best of three rates", tuned=True),
    "printed-muon": added("Muon", tuned=True, optimizer="muon"),
    "printed-leap": added("leap schedule", schedule="leap"),
    "printed-loss": added("our loss terms", loss_weights=OURS),
    "printed-noise": added("past noise beside diffusion dropout", past_noise=0.3),
    "printed-clean-past": added("no diffusion dropout", dropout=()),
    "printed-held": added("control held in half of the windows", held_control=0.5),
}


# ---- one training --------------------------------------------------------------------------------
@dataclass(frozen=True)
class Size:
    """Clips to walk, seconds of each, training clips (None: the recipe's), share of the budget."""

    clips: int = 40
    seconds: float = 8.0
    training: int | None = None
    budget: float = 1.0


FULL, QUICK = Size(), Size(clips=4, seconds=6.5, training=4, budget=0.002)


@cache
def material(size: Size) -> tuple[list[Clip], Trials]:
    """What all cells are trained on, and what they walk."""
    recipe = OUR_CELL if size.training is None else replace(OUR_CELL, clips=size.training)
    walks = Trials.of(dataset(size.clips, size.seconds + T_H / FPS, seed=UNSEEN))
    return training_clips(recipe), walks


def rows_of(walker: Walker, trials: Trials, seed: int) -> dict[str, np.ndarray]:
    """What is measured of each walk: DDPM with all steps, control held, whole and broken pasts."""
    frames = trials.truth.shape[1]
    whole, broken = (continued(walker, trials, share, frames, seed) for share in (0.0, SHARE))
    return {
        "bone": squared_bone_error(whole),
        "bone_broken": squared_bone_error(broken),
        "adherence": adherence(whole, trials.asked),
        "adherence_data": adherence(trials.truth, trials.asked),
        "skating": skating(whole, trials.asked),
    }


# name: (unit, measure of the rows)
MEASURES = {
    "bone_rmse_cm": ("cm", ("bone",), root_mean),
    "adherence_excess_mps": (
        "m/s",
        ("adherence", "adherence_data"),
        lambda own, data: np.nanmean(own) - np.nanmean(data),
    ),
    "skating_mps": ("m/s", ("skating",), np.nanmean),
    "broken_over_whole": (
        "ratio",
        ("bone_broken", "bone"),
        lambda broken, whole: root_mean(broken) / root_mean(whole),
    ),
}


# ---- paces and rates: what the cells are trained with --------------------------------------------
@dataclass
class Plan:
    """The pace of each cell and the rate of each optimiser, in one JSON file beside the records."""

    path: Path
    pace: dict[str, float] = field(default_factory=dict)  # milliseconds of a step on one thread
    rates: dict[str, float] = field(default_factory=dict)  # by `rate_key`
    tried: dict[str, dict[str, float]] = field(default_factory=dict)  # rate: validation loss

    @classmethod
    def read(cls, path: Path) -> "Plan":
        return (
            cls(path, **json.loads(path.read_text(encoding="utf-8")))
            if path.is_file()
            else cls(path)
        )

    def write(self) -> None:
        kept = {"pace": self.pace, "rates": self.rates, "tried": self.tried}
        with replacing(self.path) as aside:
            aside.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")

    def recipe(self, name: str, seed: int, size: Size, share: float = 1.0) -> Recipe:
        """The recipe of a cell for one training seed, its steps and its rate filled in.

        `share`: of the cell's budget.
        """
        cell = CELLS[name]
        seconds = CPU_SECONDS * cell.budget * size.budget * share
        steps = max(20, round(1000 * seconds / self.pace[name]))
        rate = self.rates[rate_key(name)] if cell.tuned else cell.recipe.lr
        return replace(cell.recipe, name=f"ladder-{name}", steps=steps, lr=rate, seed=seed)


def root(name: str) -> str:
    """The whole recipe, "ours" or "printed", that a cell or the base of its base departs from."""
    base = CELLS[name].base
    return root(base) if base else name


def rate_key(name: str) -> str:
    """Cells of one root and one optimiser share a rate: only the choice that is named differs."""
    return f"{root(name)}-{CELLS[name].recipe.optimizer}"


def measure_pace(plan: Plan, size: Size, rounds: int = 5, steps: int = 4) -> None:
    """CPU-milliseconds of a training step of every cell, in turn: the median of the rounds."""
    clips = material(size)[0][:40]
    loops = {
        name: loop_of(replace(cell.recipe, steps=10**6), clips) for name, cell in CELLS.items()
    }
    times = {name: [] for name in loops}
    for turn in range(-1, rounds):
        for name, loop in loops.items():
            began = time.process_time()
            for _ in range(steps):
                next(loop)
            if turn >= 0:
                times[name].append(1000 * (time.process_time() - began) / steps)
    plan.pace = {name: round(float(np.median(values)), 2) for name, values in times.items()}
    plan.write()


def loop_of(recipe: Recipe, clips: list[Clip]) -> Iterator[TrainStep]:
    """The training loop of a recipe, with nothing saved; dropout at its mean rate throughout.

    What dropout costs depends on its rate, which is 0 in a training's first steps.
    """
    begun = prepared(recipe, clips)
    if begun.dropout:
        rate = begun.dropout.rate
        mean = float(np.mean([rate(done) for done in np.linspace(0, 1, 1000, endpoint=False)]))
        begun.dropout.rate = lambda done: mean
    optimizer = optimizer_for(begun.model, recipe.optimizer)
    state = TrainState.start(begun.model, recipe.seed, optimizer)
    before = begun.dropout.now if begun.dropout else None
    return train_steps(state, begun.loss_fn, recipe.steps, before=before, progress=False)


def choose_rates(plan: Plan, runs: Path, size: Size) -> None:
    """For each base and optimiser the best of three rates: least loss on validation clips.

    Each is tried for a quarter of the budget, with one seed.
    """
    tuned = {}
    for name, cell in CELLS.items():
        if cell.tuned:
            tuned.setdefault(rate_key(name), name)
    clips = augment(dataset(max(4, size.clips), 20.0, seed=VALIDATION))
    for key, name in tuned.items():
        tried = plan.tried.setdefault(key, {})
        for rate in RATES[CELLS[name].recipe.optimizer]:
            if f"{rate:g}" in tried:
                continue
            plan.rates[key] = rate
            recipe = plan.recipe(name, 0, size, share=TRIAL)
            run = runs / f"rate-{key}-{rate:g}.safetensors"
            walker = train(recipe, run, material(size)[0])
            tried[f"{rate:g}"] = round(validation_loss(walker, recipe, clips), 6)
            del plan.rates[key]  # until all are tried, none is chosen
            plan.write()
        plan.rates[key] = float(min(tried, key=tried.get))
        plan.write()


def validation_loss(walker: Walker, recipe: Recipe, clips: list[Clip], batches: int = 50) -> float:
    """The recipe's own loss on other clips, in the walker's units; dropout at its last rate."""
    scalers = (walker.pose_scaler, walker.control_scaler)
    windows = Windows.of(clips, recipe.config.T_h, recipe.config.T_p, scalers)
    dropout = dropout_of(recipe, walker.schedule)
    if dropout:
        dropout.now(recipe.steps)
    return mean_loss(loss_of(recipe, windows, walker.schedule, dropout), walker.model, batches)


# ---- one cell ------------------------------------------------------------------------------------
def train_cell(name: str, plan: Plan, runs: Path, rows_file: Path, size: Size) -> None:
    """Train and measure the seeds of a cell that are not in `rows_file` yet."""
    for seed in range(SEEDS):
        kept = read_rows(rows_file)
        if str(seed) in kept["seeds"]:
            continue
        recipe = plan.recipe(name, seed, size)
        walker = train(recipe, runs / f"{name}-{seed}.safetensors", material(size)[0])
        rows = rows_of(walker, material(size)[1], seed)
        kept |= {"steps": recipe.steps, "rate": recipe.lr}
        kept["seeds"][str(seed)] = {
            key: [float(f"{x:.4g}") if np.isfinite(x) else None for x in row]
            for key, row in rows.items()
        }
        with replacing(rows_file) as aside:
            aside.write_text(json.dumps(kept) + "\n", encoding="utf-8")


def read_rows(path: Path) -> dict:
    """What was measured of a cell: its steps and rate, and for each training seed the rows."""
    return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {"seeds": {}}


def arrays(kept: dict) -> dict[str, np.ndarray]:
    """Rows of all training seeds: (seeds, clips) by name."""
    seeds = [kept["seeds"][key] for key in sorted(kept["seeds"])]
    return {key: np.array([one[key] for one in seeds], float) for key in seeds[0]}


def ladder_records(name: str, rows_file: Path, base_file: Path | None, command: str) -> list[dict]:
    """The measures of a cell, of each of its seeds, and what they are minus the base's."""
    kept = read_rows(rows_file)
    rows = arrays(kept)
    about = {"data": UNSEEN, "trainings": len(kept["seeds"]), "clips": rows["bone"].shape[1]}
    about |= {"steps": kept["steps"], "rate": kept["rate"], "cpu_seconds": CPU_SECONDS}
    base = arrays(read_rows(base_file)) if base_file is not None and base_file.is_file() else None
    found = []
    for kind, (unit, keys, value) in MEASURES.items():
        mine = [rows[key] for key in keys]
        found.append(Measure(kind, *interval_over_seeds(value, *mine), unit))
        for seed in range(len(mine[0])):
            one = float(value(*(row[seed] for row in mine)))
            found.append(Measure(f"{kind}.seed{seed}", one, one, one, unit))
        if base is not None and len(base["bone"]) == len(rows["bone"]):
            both = [*mine, *(base[key] for key in keys)]
            n = len(keys)
            apart = interval_over_seeds(lambda *x, n=n, v=value: v(*x[:n]) - v(*x[n:]), *both)
            found.append(Measure(f"{kind}_minus_base", *apart, unit))
    return [one.as_record(f"ladder.{name}.", about, command) for one in found]


def measure(row: str, folder: Path, runs: Path, size: Size, command: str) -> list[dict]:
    """One part of the ladder: "pace", "rates", or a cell, which needs both.

    One thread, whatever the machine has. Rows and plan are kept in `folder`, trainings in `runs`.
    """
    plan = Plan.read(folder / "plan.json")
    threads = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        if row == "pace" or not plan.pace:
            measure_pace(plan, size)
        if row == "rates" or (
            row in CELLS and CELLS[row].tuned and rate_key(row) not in plan.rates
        ):
            choose_rates(plan, runs, size)
        if row not in CELLS:
            return plan_records(plan, row, command)
        train_cell(row, plan, runs, folder / f"{row}.json", size)
    finally:
        torch.set_num_threads(threads)
    base = CELLS[row].base
    return ladder_records(
        row, folder / f"{row}.json", folder / f"{base}.json" if base else None, command
    )


def plan_records(plan: Plan, row: str, command: str) -> list[dict]:
    """Row "pace": milliseconds of a step of each cell. Row "rates": that of each optimiser."""
    found = {
        "pace": [Measure(f"{name}.step_ms", ms, ms, ms, "ms") for name, ms in plan.pace.items()],
        "rates": [Measure(f"{key}.rate", rate, rate, rate, "") for key, rate in plan.rates.items()],
    }
    return [one.as_record("ladder.plan.", {"threads": 1}, command) for one in found[row]]
