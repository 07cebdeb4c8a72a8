"""A walker: a trained MoDiff with all that it needs to be used: schedule, scalers, and the card
that says what it is.

`walker.walk(motion, control)` continues a Motion; `rollout.generate(walker, past, control)` does so
with tensors in the root frame.  Notebook: 00, 07
"""

import copy
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor

from .. import rollout
from ..beyond.footholds import FootholdMoDiff
from ..conditions.control import as_long, splice
from ..ddpm import Schedule, linear_schedule, make_schedule
from ..fast.footholds import FastFoothold
from ..fast.modiff import FastMoDiff
from ..fast.samplers import ddim_steps, ddpm_steps
from ..modiff import MoDiff, MoDiffConfig
from ..motion.checks import checked_count, checked_seconds
from ..motion.motion import Motion, MotionError, as_motion
from ..motion.root_frame import FPS, root_path, to_world
from ..motion.scaler import Scaler
from ..motion.skeleton import J
from ..prediction import denoiser_of
from ..rollout import WindowSampler
from .watched import watched

STEPS = 10  # of DDIM, unless told: as good as DDPM with all, and ten times as fast (RESULTS)


def leap_schedule(
    S: int = 100, leap: float = 0.37, beta_2: float = 0.03, beta_S: float = 0.08
) -> Schedule:
    """beta_1 = leap, then evenly from beta_2 to beta_S: step 1 brings noise of sqrt(leap / (1 -
    leap)) of the signal.

    By default 0.77 of it. A small network sees no more of a pose at lower noise than it guesses
    anyhow. Steps there draw its errors again and again, and rollouts feed on them; one leap from
    step 1 to the clean pose does not. Ours.   Notebook: 07
    """
    rest = torch.linspace(beta_2, beta_S, S - 1, dtype=torch.float64)
    return make_schedule(
        torch.cat([torch.tensor([leap], dtype=torch.float64), rest]), f"leap {leap:g}"
    )


SCHEDULES = {"linear": linear_schedule, "leap": leap_schedule}  # by the names that recipes use


@dataclass(frozen=True, eq=False)
class Walker:
    """The network, in its own units, and the scalers that lead there from metres and m/s."""

    model: MoDiff
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
    def config(self) -> MoDiffConfig:
        return self.model.config

    @cached_property
    def fast(self) -> FastMoDiff:
        """The fast twin, built at first use."""
        return (FastFoothold if isinstance(self.model, FootholdMoDiff) else FastMoDiff)(self.model)

    def walk(
        self,
        motion: Motion,
        control: Float[np.ndarray, "n 3"],
        *,
        seconds: float | None = None,
        samples: int = 1,
        seed: int = 0,
        steps: int | None = STEPS,
        progress: bool = True,
    ) -> Motion | list[Motion]:
        """Continue a motion under a control (forward m/s, left m/s, turning rad/s; 20 rows a
        second).

        The result holds the new frames alone, in the same world: it begins one frame after the
        given motion ends, and `motion.then(more)` joins the two. `seconds` cuts the control, or
        holds its last row, by default it is taken as it is. With `samples` above 1 a list of so
        many different continuations. `steps` of DDIM, or None for DDPM with all.
        Raises MotionError and ValueError for what cannot be continued or meant; warns where the
        control asks for more than the walker saw in training.  Source: MoDiff Alg. 2.  Notebook: 00
        """
        as_motion(motion).check_whole()
        count, T_h = checked_count(samples, "samples"), self.config.T_h
        length = None if seconds is None else round(checked_seconds(seconds) * FPS)
        told = as_long(control, length)
        given = motion.resampled(FPS).rooted()
        clip = given.to_clip()
        if len(clip) < T_h:
            raise MotionError(
                f"{motion.name} has {len(clip)} frames; the walker looks at the last {T_h} "
                f"({T_h / FPS:g} s) and needs so many"
            )
        rows = splice(clip.control, told, T_h)
        past = torch.from_numpy(clip.features()[-T_h:]).expand(count, -1, -1)
        steer = torch.from_numpy(rows).float().expand(count, -1, -1)
        evaluations = len(told) * (steps or self.schedule.S)
        with watched(self, evaluations, "walking", progress) as walker:
            new = rollout.generate(walker, past, steer, seed=seed, steps=steps)
        poses = new.double().cpu().numpy().reshape(count, -1, J, 3)
        place, heading = root_path(rows, tuple(given.root[-T_h]))
        way = np.column_stack([place, heading])
        made = []
        for one in poses:
            whole = np.concatenate([clip.poses[-T_h:], one])
            world = to_world(whole, rows, tuple(way[0]))
            made.append(
                Motion(world[T_h:], FPS, root=way[T_h:], source=f"{motion.name}, continued")
            )
        return made if samples > 1 else made[0]

    def denoiser(
        self, past: Float[Tensor, "B T_h D"], control: Float[Tensor, "B T C"], fast: bool = True
    ):
        """`denoise(x_s, s) -> eps_hat` for this past and control, in the network's units.

        `fast`: by the fast twin; it cannot be differentiated.
        """
        if not fast:
            return denoiser_of(
                lambda x_s, s: self.model(x_s, s, past, control), self.schedule, self.config.target
            )
        context = self.fast.encode(past, control)
        return denoiser_of(
            lambda x_s, s: self.fast.denoise(x_s, s, context), self.schedule, self.config.target
        )

    def window_sampler(self, steps: int | None = None) -> WindowSampler:
        """Draw a window of T_p poses: DDPM with all steps, or DDIM with `steps` of them.
        Notebook: 08"""

        @torch.inference_mode()
        def sample(past: Tensor, control: Tensor, generator: torch.Generator) -> Tensor:
            denoise = self.denoiser(past, control)
            shape = (len(past), self.config.T_p, self.config.D)
            x_S = torch.randn(shape, generator=generator, device=generator.device).to(past.device)
            if steps is None:
                loop = ddpm_steps(denoise, x_S, self.schedule, generator=generator)
            else:
                loop = ddim_steps(denoise, x_S, self.schedule, steps=steps, generator=generator)
            for step in loop:
                last = step
            return last.x_s

        return sample
