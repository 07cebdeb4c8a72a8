"""The measurements of the walkers by `make results`, in parts that can be run alone.

Each part is a list of records and one JSON file.
"""

import hashlib
import json
from dataclasses import asdict, dataclass
from functools import cache, cached_property
from pathlib import Path

import numpy as np
from safetensors import safe_open

from motiondiff_edu._files import replacing
from motiondiff_edu.metrics.walks import PAPER, ROBUST
from motiondiff_edu.modiff import MoDiffConfig
from motiondiff_edu.performers.performer import STEPS
from motiondiff_edu.pretrained import checkpoints

from . import steps_table
from .scores import FINISHED, Measure, diversity, measures, score
from .trials import (
    UNSEEN,
    Choices,
    Trials,
    choices,
    cleaned_rows,
    rollouts_of,
    unseen,
    walker_generate,
)

CACHE = Path("build/results")  # rollouts are kept, so that a new metric needs no new ones
PACKAGE = Path(checkpoints.__file__).parents[1]
ROLLING = (
    "cross_modal_attention.py",
    "ddpm.py",
    "modiff.py",
    "prediction.py",
    "rollout.py",
    "motion/scaler.py",
    "performers/performer.py",
    "performers/walker.py",
    "pretrained/checkpoints.py",
    "pretrained/weights_file.py",
)


@dataclass(frozen=True)
class Size:
    """The amount of measurement: 100 controls and 20 x 50 continuations, or little."""

    clips: int = 100
    pasts: int = 20
    each: int = 50
    seconds: int = 12


FULL, QUICK = Size(), Size(clips=12, pasts=3, each=8, seconds=7)


class Bench:
    """The trials, which are made once, and the rollouts on them.

    Rollouts are kept on disk under the digest of their weights.
    """

    def __init__(self, size: Size, weights: dict[str, Path] | None = None):
        self.size = size
        self.weights = checkpoints.available() | (weights or {})

    @cached_property
    def trials(self) -> Trials:
        return unseen(self.size.clips, self.size.seconds)

    @cached_property
    def choices(self) -> Choices:
        return choices(self.size.pasts, self.size.each)

    def rollouts(self, name: str, steps: int | None, hold: bool, what: str) -> np.ndarray:
        """Poses of the walker `name`.

        They are on the trials (what="walks") or on the choices (what="choices").
        """
        path = self.weights.get(name) or checkpoints.available().get(name)
        if path is None:
            raise SystemExit(
                f"no weights are called {name!r}; there are: {', '.join(self.weights) or 'none'}"
            )
        inputs = "-".join(_digest(x) for x in self._inputs(what))
        size = json.dumps(asdict(self.size))
        key = f"{weights_digest(path)}-{steps}-{hold}-{what}-{size}-{inputs}-{code_digest()}"
        kept = CACHE / f"{name}-{hashlib.sha256(key.encode()).hexdigest()[:12]}.npy"
        if not kept.exists():
            generate = walker_generate(checkpoints.load(path), steps, hold)
            asked = self.trials if what == "walks" else self.choices
            new = (
                rollouts_of(generate, asked)
                if what == "choices"
                else generate(asked.past, asked.control, 0)
            )
            with replacing(kept) as aside, open(aside, "wb") as file:
                np.save(file, new.astype(np.float32))
        return np.load(kept).astype(np.float64)

    def _inputs(self, what: str) -> tuple[np.ndarray, np.ndarray]:
        asked = self.trials if what == "walks" else self.choices
        return asked.past, asked.control


def _digest(array: np.ndarray) -> str:
    return hashlib.sha256(np.ascontiguousarray(array).tobytes()).hexdigest()[:16]


def weights_digest(path: Path) -> str:
    """Digest of the tensors in a weights file, without its card."""
    with safe_open(path, "pt") as file:
        return file.metadata()["sha256"][:16]


def code_digest() -> str:
    """Digest of all code that turns weights and inputs into poses.

    When it changes, old rollouts are not used.
    """
    files = [PACKAGE / name for name in ROLLING]
    return hashlib.sha256(b"".join(path.read_bytes() for path in files)).hexdigest()[:16]


@dataclass(frozen=True)
class Walks:
    """One line of measurements: its weights, its sampler, and the control that it sees."""

    prefix: str
    name: str
    steps: int | None  # of DDIM, as `Walker.walk` has it; None: DDPM with all
    hold: bool = True
    choose: bool = True  # also measure the diversity

    def measures(self, bench: Bench) -> list[Measure]:
        trials = bench.trials
        walks = bench.rollouts(self.name, self.steps, self.hold, "walks")
        found = score(walks, trials.asked, trials.truth)
        found += measures(FINISHED, cleaned_rows(walks, trials))
        if self.choose:
            found += diversity(
                bench.rollouts(self.name, self.steps, self.hold, "choices"), bench.choices.drawn
            )
        return found


LINES = {
    line.prefix: line
    for line in (
        Walks("walker", "walker", STEPS),
        Walks("walker-plain", "walker-plain", STEPS, choose=False),
        Walks("walker-printed", "walker-printed", None, choose=False),
        Walks("walker-ddpm", "walker", None, choose=False),
        Walks("walker-lookahead", "walker", STEPS, hold=False, choose=False),
    )
}


def size_of_network(config: MoDiffConfig) -> str:
    """Width, feed-forward and layers of MoDiff: motion, control, cross-modal, decoder."""
    layers = config.motion_layers, config.control_layers, config.cross_layers, config.decoder_layers
    named = "/".join(map(str, layers))
    return f"width {config.width}, feed-forward {config.hidden}, layers {named}"


def kept_records(folder: Path, name: str) -> list[dict]:
    """The records of a part; none if it was not measured yet."""
    kept = folder / f"{name}.json"
    return json.loads(kept.read_text(encoding="utf-8")) if kept.is_file() else []


def walker_records(bench: Bench, line: Walks, command: str) -> list[dict]:
    """The measures of one line as records."""
    return [
        as_record(f"{line.prefix}.", measure, bench, line, command)
        for measure in line.measures(bench)
    ]


def as_record(
    prefix: str, measure: Measure, bench: Bench, line: Walks | None, command: str
) -> dict:
    """A record with all settings of the measure: seeds, the amount of measurement, and the weights.

    The data's own measures have no weights.
    """
    size, seeds = bench.size, {"rollouts": 0}
    if measure.name.startswith("diversity"):
        seeds |= {"data": UNSEEN + 500_000, "pasts": size.pasts, "each": size.each}
    else:
        seeds |= {"data": UNSEEN, "clips": size.clips, "seconds": size.seconds}
    if line:
        seeds |= _about_weights(bench.weights[line.name]) | {"steps": line.steps or "all"}
    return measure.as_record(prefix, seeds, command)


@cache
def _about_weights(path: Path) -> dict:
    """The digest of a walker's weights, the size of its network, and how long it was trained."""
    walker = checkpoints.load(path)
    recipe = walker.card.get("recipe", {})
    about = {"weights": weights_digest(path), "network": size_of_network(walker.config)}
    return about | {"trained_steps": recipe.get("steps"), "rate": recipe.get("lr")}


def footstep_records(bench: Bench, command: str) -> tuple[list[dict], dict[str, np.ndarray]]:
    """Table I on our data: the recorded walks and all walkers; and the curves of Fig. 3."""
    sets = {"data": (None, bench.trials.truth)}
    for line in LINES.values():
        if line.name in bench.weights and line.hold:
            sets[line.prefix] = line, bench.rollouts(line.name, line.steps, line.hold, "walks")
    records, curves = [], {}
    for name, (line, poses) in sets.items():
        for suffix, rule in (("", PAPER), ("-robust", ROBUST)):
            table = steps_table.tables(poses, bench.trials.asked, rule)
            curves[name + suffix] = steps_table.curve(table)
            found = steps_table.measures(table)
            records += [
                as_record(f"footsteps{suffix}.{name}.", measure, bench, line, command)
                for measure in found
            ]
    return records, curves
