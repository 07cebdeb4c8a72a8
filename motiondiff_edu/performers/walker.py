"""A walker: a trained MoDiff with all that it needs to be used: schedule, scalers, and the card
that says what it is.

`rollout.generate(walker, past, control)` lets it walk.  Notebook: 00, 07
"""

import copy
from dataclasses import dataclass, field
from functools import cached_property

import torch
from jaxtyping import Float
from torch import Tensor, nn

from ..beyond.footholds import FootholdConfig, FootholdMoDiff
from ..ddpm import Denoiser, Schedule, draw
from ..fast.footholds import FastFoothold
from ..fast.modiff import FastMoDiff
from ..fast.samplers import ddim_steps, ddpm_steps
from ..fast.twins import Twin, watched
from ..modiff import MoDiff, MoDiffConfig
from ..motion.scaler import Scaler
from ..prediction import denoiser_of
from ..rollout import Sizes, WindowSampler
from .networks import kind_of, register

register("walker", MoDiff, MoDiffConfig, fast=FastMoDiff)
register("walker", FootholdMoDiff, FootholdConfig, build=FootholdMoDiff, fast=FastFoothold)


@dataclass(frozen=True, eq=False)
class Walker:
    """The network, in its own units, and the scalers that lead there from metres and m/s."""

    model: nn.Module
    schedule: Schedule
    pose_scaler: Scaler
    control_scaler: Scaler
    card: dict = field(default_factory=dict)

    def __post_init__(self):
        """Raises ValueError for a schedule with another number of steps than the network's."""
        if self.schedule.S != self.model.config.S:
            raise ValueError(
                f"the schedule has {self.schedule.S} steps, the network {self.model.config.S}"
            )

    def to(self, device: str | torch.device) -> "Walker":
        """The same walker on another device; `rollout.generate` brings past and control there."""
        model = copy.deepcopy(self.model).to(device)
        return Walker(
            model,
            self.schedule,
            self.pose_scaler.to(device),
            self.control_scaler.to(device),
            self.card,
        )

    @property
    def config(self) -> Sizes:
        return self.model.config

    @cached_property
    def _twin(self) -> Twin | None:
        kind = kind_of(self.model)
        return Twin(self.model, kind.fast) if kind and kind.fast else None

    @property
    def fast(self) -> FastMoDiff | None:
        """The fast twin with the weights of now: built at first use, and again when they have
        changed. None for a network that was registered without one."""
        return self._twin and self._twin()

    def denoiser(
        self, past: Float[Tensor, "B T_h D"], control: Float[Tensor, "B T C"], fast: bool = True
    ) -> Denoiser:
        """`denoise(x_s, s) -> eps_hat` for this past and control, in the network's units.

        `fast`: by the fast twin, where there is one and nobody watches the network's attention; it
        cannot be differentiated.
        """
        twin = self.fast if fast and not watched(self.model) else None
        if twin is None:
            return self._as_eps(lambda x_s, s: self.model(x_s, s, past, control))
        context = twin.encode(past, control)
        return self._as_eps(lambda x_s, s: twin.denoise(x_s, s, context))

    def _as_eps(self, network) -> Denoiser:
        return denoiser_of(network, self.schedule, self.config.target)

    def window_sampler(self, steps: int | None = None) -> WindowSampler:
        """Draw a window of T_p poses: DDPM with all steps, or DDIM with `steps` of them.
        Notebook: 08"""

        @torch.inference_mode()
        def sample(past: Tensor, control: Tensor, generator: torch.Generator) -> Tensor:
            denoise = self.denoiser(past, control)
            x_S = draw(past.new_empty(len(past), self.config.T_p, self.config.D), generator)
            if steps is None:
                loop = ddpm_steps(denoise, x_S, self.schedule, generator=generator)
            else:
                loop = ddim_steps(denoise, x_S, self.schedule, steps=steps, generator=generator)
            for step in loop:
                last = step
            return last.x_s

        return sample
