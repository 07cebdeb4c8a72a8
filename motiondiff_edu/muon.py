"""Adam for most weights, Muon for the matrices of the attention and feed-forward layers.

Adam scales every number by itself. Muon replaces the averaged gradient of a whole matrix by the nearest matrix whose
singular values are all one: directions that rarely show in the gradient learn as fast as the common ones. A step takes
longer, and the walkers need far fewer of them; `python -m tools.results --only budget` compares both.
Ours: the papers use Adam; Muon is torch.optim's.  Notebook: 07
"""

import torch
from torch import nn

from .cross_modal_attention import Block


def optimizer_for(model: nn.Module, name: str):
    """What `TrainState.start` needs for the optimizer a recipe names: "muon", or "adam" (None: it has its own)."""
    if name not in ("muon", "adam"):
        raise ValueError(f'optimizer must be "muon" or "adam", not {name!r}')
    return MuonAndAdam(model) if name == "muon" else None


class MuonAndAdam:
    """Two optimizers that look like one: what `training.train_steps` and `runs.save_run` ask of an optimizer."""

    def __init__(self, model: nn.Module, lr: float = 1e-3):
        blocks = [module for module in model.modules() if isinstance(module, Block)]
        matrices = {id(p) for block in blocks for p in block.parameters() if p.ndim == 2}
        first = [p for p in model.parameters() if id(p) in matrices]
        others = [p for p in model.parameters() if id(p) not in matrices]
        if not first:
            raise ValueError(f"{type(model).__name__} has no transformer block: nothing for Muon to do; use Adam")
        # matched to Adam's step size, so that one learning rate serves both
        muon = torch.optim.Muon(first, lr=lr, weight_decay=0.0, adjust_lr_fn="match_rms_adamw")
        self.parts = [muon, torch.optim.Adam(others, lr=lr, fused=True)]

    @property
    def param_groups(self) -> list[dict]:
        return [group for part in self.parts for group in part.param_groups]

    def zero_grad(self, set_to_none: bool = True) -> None:
        for part in self.parts:
            part.zero_grad(set_to_none=set_to_none)

    def step(self) -> None:
        for part in self.parts:
            part.step()

    def state_dict(self) -> dict:
        """{"state": {number of the parameter: its moments}}, Muon's parameters first."""
        state, offset = {}, 0
        for part in self.parts:
            state |= {offset + i: moments for i, moments in part.state_dict()["state"].items()}
            offset += sum(len(group["params"]) for group in part.param_groups)
        return {"state": state}

    def load_state_dict(self, saved: dict) -> None:
        offset = 0
        for part in self.parts:
            own, count = part.state_dict(), sum(len(group["params"]) for group in part.param_groups)
            mine = {i - offset: moments for i, moments in saved["state"].items() if offset <= i < offset + count}
            part.load_state_dict(own | {"state": mine})
            offset += count
