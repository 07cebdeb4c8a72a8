"""Training windows of MoDiff: ten past poses, ten future poses, the control of all twenty frames;
and the loss on them.

Half of the windows hold the control of the step about to be taken over the future: whoever steers
does not know what comes. Source: MoDiff III-A, Alg. 1; the held half is ours.   Notebook: 07
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Float, Int
from torch import Tensor, nn

from ..beyond.footholds import FootholdMoDiff
from ..ddpm import Schedule, q_sample
from ..motion.clip import Clip
from ..motion.root_frame import FPS
from ..motion.scaler import Scaler
from ..motion.skeleton import BONES
from ..prediction import target_of


@dataclass(frozen=True, eq=False)
class Windows:
    """All frames of a data set, standardised, and where a window may start; a window never crosses
    two clips."""

    poses: Float[Tensor, "N D"]
    control: Float[Tensor, "N C"]
    starts: Int[Tensor, "K"]
    T_h: int
    T_p: int
    pose_scaler: Scaler
    control_scaler: Scaler

    @classmethod
    def of(
        cls,
        clips: Sequence[Clip],
        T_h: int = 10,
        T_p: int = 10,
        scalers: tuple[Scaler, Scaler] | None = None,
    ) -> "Windows":
        """Collect clips; the scalers are fitted on them unless given (pose, control).

        Raises ValueError when no clip is as long as a window, or one has not 20 frames/s.
        Notebook: 07
        """
        length = T_h + T_p
        starts = []
        first = 0
        other = next((clip for clip in clips if clip.fps != FPS), None)
        if other:
            raise ValueError(
                f"clip {other.source!r} has {other.fps:g} frames/s; bring it to {FPS:g} first"
            )
        for clip in clips:
            starts.append(np.arange(first, first + len(clip) - length + 1))
            first += len(clip)
        starts = np.concatenate(starts) if starts else np.zeros(0, int)
        if not len(starts):
            raise ValueError(f"no clip has the {length} frames of a window; pass longer clips")
        poses = torch.from_numpy(np.concatenate([clip.features() for clip in clips]))
        control = torch.from_numpy(
            np.concatenate([clip.control for clip in clips]).astype(np.float32)
        )
        pose_scaler, control_scaler = scalers or (Scaler.fit(poses), Scaler.fit(control))
        return cls(
            pose_scaler.transform(poses),
            control_scaler.transform(control),
            torch.from_numpy(starts),
            T_h,
            T_p,
            pose_scaler,
            control_scaler,
        )

    def draw(
        self, batch: int, generator: torch.Generator, held: float = 0.5
    ) -> tuple[Float[Tensor, "B T_h D"], Float[Tensor, "B T_p D"], Float[Tensor, "B T C"]]:
        """A random batch (past, future, control); a share `held` of it holds control[T_h - 1] over
        the future."""
        chosen = torch.randint(len(self.starts), (batch,), generator=generator)
        rows = self.starts[chosen][:, None] + torch.arange(self.T_h + self.T_p)
        poses, control = self.poses[rows], self.control[rows]
        hold = torch.rand(batch, generator=generator) < held
        control[:, self.T_h :] = torch.where(
            hold[:, None, None], control[:, self.T_h - 1 : self.T_h], control[:, self.T_h :]
        )
        return poses[:, : self.T_h], poses[:, self.T_h :], control


def window_loss(
    windows: Windows,
    schedule: Schedule,
    *,
    batch: int = 32,
    noises: int = 2,
    held: float = 0.5,
    jitter: float = 0.0,
    metres: float = 0.0,
    near: float = 0.0,
    high_noise: float = 0.0,
    bones: float = 0.0,
    doubt: float = 0.0,
    dropout: Callable[[Tensor, Tensor, torch.Generator], Tensor] | None = None,
) -> Callable[[nn.Module, torch.Generator], Tensor]:
    """Algorithm 1 as a `loss_fn` for `training.train_steps`: mean squared error of the network's
    target.

    Every window is encoded once and denoised at `noises` different steps: the encoder is the dear
    part. `jitter` shakes the past (see `shaken`), so that a rollout's own errors, small or large,
    are no news to the network. Columns are weighted by std^metres: 0 counts errors in standard
    deviations, 2 in metres (a toe moves tenfold a hip). Frame k is weighted by 1 / (how far poses
    move in k frames)^near: a rollout keeps the first, which moves least. `high_noise` = c weights
    step s by 1 + min((1 - alpha_bar) / alpha_bar, c): where eps is easy and the pose is not.
    `bones` is the weight of a second error, that of each joint against its parent: a shin keeps its
    length when knee and ankle err alike. It is the network's error times std, so it goes with
    metres=2 (for x0 it is in metres). `doubt` is the share of the shaking that reaches the feet
    which a network with footholds may leave in place (see `foothold`): with all of it the gate
    would learn never to hold. `dropout`(past, s, generator) is what becomes of the past at step s
    (`diffusion_dropout.Dropout`); the encoder then reads a window once for each noise.
    Raises ValueError for batch or noises under 1.
    Source: MoDiff eq. 10, Alg. 1; all but the squared error itself is ours.  Notebook: 07
    """
    if min(batch, noises) < 1:
        raise ValueError(
            f"a batch needs a window and a noise at least, not batch = {batch}, noises = {noises}"
        )
    change, std = typical_change(windows), windows.pose_scaler.std
    rows, columns = error_weights(change, std, metres, near)
    noise_over_signal = ((1 - schedule.alpha_bar) / schedule.alpha_bar).float()
    steps = 1 + noise_over_signal.clamp_max(high_noise)

    def loss_fn(model: nn.Module, generator: torch.Generator) -> Tensor:
        device = next(
            model.parameters()
        ).device  # batch and noise are drawn on the CPU: the same numbers everywhere
        past, future, control = windows.draw(batch, generator, held)
        seen = shaken(past, jitter, change[0], generator) if jitter else past
        standing = torch.lerp(past, seen, doubt)[:, -1]
        s = torch.randint(1, schedule.S + 1, (batch * noises,), generator=generator)
        if dropout:
            seen, standing, control = (
                x.repeat_interleave(noises, dim=0) for x in (seen, standing, control)
            )
            dropped = dropout(seen, s, generator)
            hit = (dropped != seen).flatten(1).any(1)
            seen, standing = dropped, torch.where(hit[:, None], dropped[:, -1], standing)
        feet = {"standing": standing.to(device)} if isinstance(model, FootholdMoDiff) else {}
        memory = model.encode(seen.to(device), control.to(device), **feet)
        memory = memory if dropout else memory.repeat_interleave(noises, dim=0)
        x0 = future.to(device).repeat_interleave(noises, dim=0)
        weight = steps[s][:, None, None].to(device)
        s, eps = s.to(device), torch.randn(x0.shape, generator=generator).to(device)
        wanted = target_of(x0, eps, s, schedule, model.config.target)
        error = wanted - model.decode(q_sample(x0, s, schedule, eps), s, memory)
        loss = (weight * columns.to(device) * error.square()).mean()
        if bones:
            loss = (
                loss
                + bones * (weight * rows.to(device) * bone_errors(error * std.to(device))).mean()
            )
        return loss

    return loss_fn


def error_weights(
    change: Float[Tensor, "T_p D"], std: Float[Tensor, "D"], metres: float, near: float
) -> tuple[Float[Tensor, "T_p 1"], Float[Tensor, "T_p D"]]:
    """Weights of frames, and of frames and columns together, whose mean is 1; as `window_loss`
    says."""
    rows = 1 / (change * std).square().mean(1, keepdim=True).sqrt() ** near
    columns = rows * std**metres
    return rows / columns.mean(), columns / columns.mean()


def bone_errors(error: Float[Tensor, "B T D"]) -> Float[Tensor, "B T 20"]:
    """Squared length of each joint's error against its parent's, a third for each axis; `error` is
    in metres."""
    joints = error.unflatten(-1, (-1, 3))
    parents, children = np.array(BONES).T
    return (joints[..., children, :] - joints[..., parents, :]).square().mean(-1)


def typical_change(windows: Windows, samples: int = 4096) -> Float[Tensor, "T_p D"]:
    """How far poses move in 1 ... T_p frames: root mean square over windows, in standard
    deviations."""
    past, future, _ = windows.draw(samples, torch.Generator().manual_seed(0))
    return (future - past[:, -1:]).square().mean(0).sqrt()


def shaken(
    past: Float[Tensor, "B T_h D"],
    jitter: float,
    change: Float[Tensor, "D"],
    generator: torch.Generator,
) -> Float[Tensor, "B T_h D"]:
    """The past with noise as a rollout's own errors are: one part the same in all frames, one part
    new in each.

    The steady part is up to `jitter` standard deviations, the other up to jitter / 0.3 times what
    one frame changes. Both levels are drawn evenly on a log scale over two decades: small errors
    must be kept small, large ones mended. Ours; the papers' own remedy is diffusion dropout.
    Notebook: 07
    """
    shape = (2, len(past), 1, 1)
    steady, fresh = jitter * 10 ** (-2 * torch.rand(shape, generator=generator))
    past = past + steady * torch.randn(len(past), 1, past.shape[2], generator=generator)
    return past + fresh / 0.3 * change * torch.randn(past.shape, generator=generator)
