"""A walker: a trained MoDiff with its schedule, its scalers, and the card that describes it.

`walker.walk(motion, control)` continues a Motion; `rollout.generate(walker, past, control)` works
on tensors in the root frame.  Notebook: 00, 07
"""

import warnings
from dataclasses import dataclass, field

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor

from .. import rollout
from ..conditions.control import as_long
from ..ddpm import Denoiser, Generators, ddim_steps, draw, sample_steps
from ..metrics.strays import strays
from ..modiff import MoDiff, MoDiffConfig
from ..motion.arguments import checked_samples, checked_seconds, checked_steps
from ..motion.motion import Motion, MotionWarning, as_motion
from ..motion.root_frame import FPS
from ..motion.scaler import Scaler
from ..motion.skeleton import J
from ..rollout import WindowSampler
from .continuation import Start, finish_continuation, in_words, resize_motion, unlike_training
from .networks import WalkerConfig, WalkerNetwork, register
from .performer import STEPS, Performer, bar, evaluating, float32, generators

register("walker", MoDiff, MoDiffConfig)


@dataclass(frozen=True, eq=False, repr=False)
class Walker(Performer):
    """A trained MoDiff: it continues a past under a velocity control (`walk`), frame by frame.

    A network, the schedule of its diffusion, and the scalers that convert poses (metres, root
    frame) and control (m/s, m/s, rad/s) to its units and back. `card` says how it was trained.
    Source: MoDiff III.  Notebook: 07
    """

    model: WalkerNetwork
    pose_scaler: Scaler
    control_scaler: Scaler
    card: dict = field(default_factory=dict)

    @property
    def config(self) -> WalkerConfig:
        return self.model.config

    def walk(
        self,
        motion: Motion,
        control: Float[np.ndarray, "n C"],
        *,
        seconds: float | None = None,
        samples: int = 1,
        seed: int = 0,
        steps: int | None = STEPS,
        progress: bool = True,
    ) -> Motion | list[Motion]:
        """Continue a motion along a control.

        The result has only the new frames. It begins one frame after the given motion, in the same
        world; `motion.then(more)` joins the two. Its bones are as long as the given ones, and feet
        that stand do not slide (`motion/cleanup`; `rollout.generate` has the network's own).
        Other body sizes work: the motion is scaled to the course's figure, and scaled back.

        control  forward m/s, left m/s, turning rad/s; 20 rows a second. A network with more columns
                 (C > 3) takes its own after these; their first row also stands for the past
        seconds  cut the control to this length, or hold its last row (default: keep its length)
        samples  above 1: a list with this many continuations; the first is that of samples=1
        steps    of DDIM, or None for DDPM with all steps, and noise of variance beta_s
        Raises MotionError for a motion that cannot be continued, ValueError for numbers out of
        range. Warns where control or poses go beyond the training data, where poses are off the
        floor, and where a joint would jump from the last pose.
        Source: MoDiff Alg. 2.  Notebook: 00
        """
        count, T_h = checked_samples(samples), self.config.T_h
        steps = checked_steps(steps, self.schedule.S)
        length = None if seconds is None else round(checked_seconds(seconds) * FPS)
        ahead = as_long(control, length, self.config.C)
        start = Start.of(as_motion(motion), ahead[:, :3], T_h)
        own = np.concatenate([ahead[:1, 3:].repeat(T_h, axis=0), ahead[:, 3:]])
        past = torch.from_numpy(start.past).float().flatten(1)
        steer = torch.from_numpy(np.hstack([start.control, own])).float()
        rollout.check_range(steer[None], T_h, self.card.get("control_range"), start.size)
        device = self.pose_scaler.mean.device
        loop = rollout.rollout_steps(
            self.window_sampler(steps),
            self.pose_scaler.transform(past.to(device)).expand(count, -1, -1),
            self.control_scaler.transform(steer.to(device)).expand(count, -1, -1),
            len(ahead),
            self.config.T_p,
            generator=generators(seed, count),
        )
        loop = bar("walking", len(ahead), progress)(loop)
        new = self.pose_scaler.inverse(torch.stack([frame.pose for frame in loop], dim=1))
        drawn = new.double().cpu().numpy().reshape(count, -1, J, 3)
        both = [finish_continuation(start, one) for one in drawn]
        jump, unlike = max(jump for _, jump in both), unlike_training(self.pose_scaler, past)
        if words := in_words(start, jump, unlike):
            warnings.warn(f"{motion.name}: {words}", MotionWarning, stacklevel=2)
        path, name = start.path[T_h:], f"{motion.name}, continued"
        made = []
        for world, _ in both:
            notes = tuple(strays(world, start.given))
            for words in notes:
                warnings.warn(f"{name}: {words}", MotionWarning, stacklevel=2)
            one = Motion(world, FPS, root=path, source=name, notes=notes)
            made.append(resize_motion(one, start.size))
        return made if samples > 1 else made[0]

    def denoiser(self, past: Float[Tensor, "B T_h D"], control: Float[Tensor, "B T C"]) -> Denoiser:
        """`denoise(x_s, s) -> eps_hat` for this past and control, in the network's units.

        Past and control are encoded here, once; each call decodes.
        """
        with evaluating(self.model), torch.no_grad():
            memory = self.model.encode(past, control)
        return self._denoiser(self.model.decode, memory)

    def window_sampler(self, steps: int | None = None) -> WindowSampler:
        """A function that draws a window of T_p poses: DDPM with all steps, or DDIM with `steps`.

        Notebook: 08
        """

        @float32()
        def sample(past: Tensor, control: Tensor, generator: Generators) -> Tensor:
            with torch.inference_mode():
                denoise = self.denoiser(past, control)
                x_S = draw(past.new_empty(len(past), self.config.T_p, self.config.D), generator)
                if steps is None:
                    loop = sample_steps(denoise, x_S, self.schedule, generator=generator)
                else:
                    loop = ddim_steps(denoise, x_S, self.schedule, steps, generator=generator)
                *_, last = loop
            return last.x_s.clone()  # a copy made outside of inference mode can be changed in place

        return sample
