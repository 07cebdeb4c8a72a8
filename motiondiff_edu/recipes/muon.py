"""Adam for most weights, Muon for the matrices of the attention and feed-forward layers.

Adam scales every weight separately. Muon replaces the averaged gradient of a whole matrix by the
nearest matrix whose singular values are all one. So directions that are rare in the gradient learn
as fast as the common ones. A step takes longer, but the walkers need far fewer steps;
`python -m tools.results --only walker-departures.muon` compares both. Ours: the papers use Adam.
Notebook: 07
"""

import torch
from jaxtyping import Float
from torch import Tensor, nn

from ..cross_modal_attention import Block
from ..mofusion import CrossAttentionBlock, ResBlock


def optimizer_for(model: nn.Module, name: str):
    """The `optimizer` argument of `TrainState.start` for a recipe's optimizer, "muon" or "adam".

    It is None for "adam", which is the default there.
    """
    return MuonAndAdam(model) if name == "muon" else None


class Muon(torch.optim.Optimizer):
    """torch.optim.Muon in float32; the original uses bfloat16, which is slow on many CPUs.

    Source: Jordan and others, 2024. The size of a step follows Liu and others, 2025: it matches
    Adam's, so that one learning rate works for both.   Notebook: 07
    """

    def __init__(self, params: list[nn.Parameter], lr: float = 1e-3, momentum: float = 0.95):
        super().__init__(params, {"lr": lr, "momentum": momentum})

    @torch.no_grad()
    def step(self) -> None:  # type: ignore[override]  # no closure
        """One step against the gradients; parameters without a gradient do not change.

        Matrices of one shape are whitened together, which takes fewer launches on a GPU.
        """
        for group in self.param_groups:
            alike: dict[torch.Size, list[Tensor]] = {}
            for matrix in (p for p in group["params"] if p.grad is not None):
                alike.setdefault(matrix.shape, []).append(matrix)
            for shape, matrices in alike.items():
                for p in matrices:
                    if not self.state[p]:
                        self.state[p]["momentum_buffer"] = torch.zeros_like(p)
                means = [self.state[p]["momentum_buffer"] for p in matrices]
                gradients = [p.grad for p in matrices if p.grad is not None]
                torch._foreach_lerp_(means, gradients, 1 - group["momentum"])
                ahead = torch.stack(gradients).lerp(torch.stack(means), group["momentum"])
                step = whitened(ahead).unbind()  # of Nesterov's momentum
                size = 0.2 * max(shape) ** 0.5 * group["lr"]
                torch._foreach_add_(matrices, step, alpha=-size)


def whitened(matrix: Float[Tensor, "*k m n"], steps: int = 5) -> Float[Tensor, "*k m n"]:
    """Approximately the nearest matrix whose singular values are all one; they become .7 to 1.2.

    Each singular value x becomes a x + b x^3 + c x^5, five times. Jordan chose the three numbers
    for speed.
    """
    a = 3.4445
    b = -4.7750
    c = 2.0315
    tall = matrix.shape[-2] > matrix.shape[-1]
    wide = (matrix.mT if tall else matrix).reshape(-1, *sorted(matrix.shape[-2:]))
    x = wide / wide.norm(dim=(-2, -1), keepdim=True).clamp_min(1e-7)
    for _ in range(steps):
        square = x @ x.mT
        x = torch.baddbmm(x, torch.baddbmm(square, square, square, beta=b, alpha=c), x, beta=a)
    return (x.mT if tall else x).reshape(matrix.shape)


class MuonAndAdam:
    """Two optimizers with the interface of one, for `training.train_steps` and `save_run`."""

    def __init__(self, model: nn.Module, lr: float = 1e-3):
        blocks = [
            module
            for module in model.modules()
            if isinstance(module, (Block, ResBlock, CrossAttentionBlock))
        ]
        matrices = {id(p) for block in blocks for p in block.parameters() if p.ndim == 2}
        first = [p for p in model.parameters() if id(p) in matrices]
        others = [p for p in model.parameters() if id(p) not in matrices]
        if not first:
            raise ValueError(
                f"{type(model).__name__} has no block of a transformer or of MoFusion's U-Net, "
                'which Muon is for; write optimizer="adam"'
            )
        self.parts = [Muon(first, lr=lr), torch.optim.Adam(others, lr=lr, fused=True)]

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
        """{"state": {index of the parameter: its moments}}, with Muon's parameters first."""
        state, offset = {}, 0
        for part in self.parts:
            state |= {offset + i: moments for i, moments in part.state_dict()["state"].items()}
            offset += sum(len(group["params"]) for group in part.param_groups)
        return {"state": state}

    def load_state_dict(self, saved: dict) -> None:
        offset = 0
        for part in self.parts:
            own, count = part.state_dict(), sum(len(group["params"]) for group in part.param_groups)
            mine = {
                i - offset: moments
                for i, moments in saved["state"].items()
                if offset <= i < offset + count
            }
            part.load_state_dict(own | {"state": mine})
            offset += count
