"""The settings of a notebook's run: profile, seed, device and threads.

A notebook's first code cell calls `run = runtime.start(notebook="03", seed=0)`; later ones use
`run.fast`, `run.generator` and `run.pick(400, 20_000)`.
"""

import os
import random
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import torch

from .profiles import Profile, ProfileError, profile

__all__ = ["Profile", "ProfileError", "Run", "demo", "device", "profile", "start", "threads"]

Choice = TypeVar("Choice")


def demo() -> bool:
    """True when the notebook was opened by `python -m motiondiff_edu demo`.

    Such a notebook uses shipped weights and trains nothing.
    """
    return os.environ.get("MOTIONDIFF_DEMO", "") not in ("", "0")


def device() -> torch.device:
    """The device for training: the GPU in the full profile where there is one, else the CPU.

    Fast stays on the CPU: its networks are so small that a GPU would gain nothing, and the numbers
    would differ between machines.
    """
    return torch.device("cuda" if profile() == "full" and torch.cuda.is_available() else "cpu")


def threads() -> int:
    """The number of torch's threads. Set OMP_NUM_THREADS before the start to change it."""
    return torch.get_num_threads()


@dataclass(frozen=True)
class Run:
    """The settings of a run, and its random generators, which are seeded once at the start."""

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
        show = ", demo: shipped weights, no long training" if self.demo else ""
        return (
            f"notebook {self.notebook} | profile {self.profile} | seed {self.seed} | torch "
            f"{torch.__version__} on {self.device}, {threads()} threads{show}"
        )


def start(notebook: str, seed: int = 0) -> Run:
    """Seed all random generators, print the settings in one line, and return them.

    This also seeds the global generators of torch, numpy and Python, because the initial weights
    of a network come from them.
    """
    torch.manual_seed(seed)
    random.seed(seed)
    np.random.seed(seed)
    generator = torch.Generator().manual_seed(seed)
    run = Run(notebook, profile(), seed, device(), demo(), generator, np.random.default_rng(seed))
    print(run)
    return run
