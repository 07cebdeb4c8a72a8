"""Where a notebook runs: fast or full, the seed, the device, the threads.

The one place that reads MOTIONDIFF_PROFILE.

A notebook's first code cell calls `run = runtime.start(notebook="03", seed=0)`; later ones use
`run.fast`, `run.generator` and `run.pick(400, 20_000)`.
"""

import os
import random
from dataclasses import dataclass
from typing import Literal, TypeVar

import numpy as np
import torch

Profile = Literal["fast", "full"]
Choice = TypeVar("Choice")


class ProfileError(ValueError):
    """MOTIONDIFF_PROFILE holds a word that is no profile."""


def profile() -> Profile:
    """The profile in force.

    `fast` (the default) or `full`: longer trainings, more clips, a GPU where there is one.

    Raises ProfileError when the environment variable MOTIONDIFF_PROFILE holds anything else.
    """
    word = os.environ.get("MOTIONDIFF_PROFILE", "fast").strip().lower() or "fast"
    if word not in ("fast", "full"):
        raise ProfileError(
            f"MOTIONDIFF_PROFILE is {word!r}; set it to 'fast' or 'full', or leave it out for fast"
        )
    return word


def demo() -> bool:
    """True when the notebook was opened by `python -m motiondiff_edu demo`.

    Shipped weights, no training.
    """
    return os.environ.get("MOTIONDIFF_DEMO", "") not in ("", "0")


def device() -> torch.device:
    """The device for training: the GPU in the full profile where there is one, else the CPU.

    Fast stays on the CPU: its networks are so small that a GPU gains nothing and figures would
    differ between machines.
    """
    return torch.device("cuda" if profile() == "full" and torch.cuda.is_available() else "cpu")


def threads() -> int:
    """How many threads torch computes with (OMP_NUM_THREADS sets it before the start)."""
    return torch.get_num_threads()


@dataclass(frozen=True)
class Run:
    """What a notebook needs to know about where it runs.

    The generators were seeded once, at the start.
    """

    notebook: str
    profile: Profile
    seed: int
    device: torch.device
    demo: bool
    generator: torch.Generator
    rng: np.random.Generator

    @property
    def fast(self) -> bool:
        return self.profile == "fast"

    def pick(self, fast: Choice, full: Choice) -> Choice:
        """`fast` in the fast profile, `full` in the full one: run.pick(400, 20_000) steps."""
        return fast if self.fast else full

    def __str__(self) -> str:
        show = ", demo: shipped weights, no training" if self.demo else ""
        return (
            f"notebook {self.notebook} | profile {self.profile} | seed {self.seed} | torch "
            f"{torch.__version__} on {self.device}, {threads()} threads{show}"
        )


def start(notebook: str, seed: int = 0) -> Run:
    """Seed everything, say in one line where the notebook runs, and return the record.

    Also seeds the global generators of torch, numpy and Python: the initial weights of a network
    come from there.
    """
    torch.manual_seed(seed)
    random.seed(seed)
    np.random.seed(seed)
    generator = torch.Generator().manual_seed(seed)
    run = Run(notebook, profile(), seed, device(), demo(), generator, np.random.default_rng(seed))
    print(run)
    return run
