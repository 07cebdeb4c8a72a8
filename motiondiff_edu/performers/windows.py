"""Training windows of MoDiff: ten past poses, ten future poses, the control of all twenty frames.

Source: MoDiff III-A.   Notebook: 07
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Float, Int
from torch import Tensor

from ..motion.clip import Clip
from ..motion.motion import Motion
from ..motion.root_frame import FPS
from ..motion.scaler import Scaler


@dataclass(frozen=True, eq=False)
class Windows:
    """All frames of a data set, standardised, and the frames where a window can start.

    No window contains frames of two clips.
    """

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
        clips: Sequence[Clip | Motion],
        T_h: int = 10,
        T_p: int = 10,
        scalers: tuple[Scaler, Scaler] | None = None,
    ) -> "Windows":
        """Collect clips or motions; the scalers (pose, control) are fitted on them unless given.

        Raises ValueError when no clip is as long as a window, or one is not at 20 frames/s, and
        MotionError for a motion that has no clip (`Motion.to_clip`).
        Notebook: 07
        """
        own = [one.to_clip() if isinstance(one, Motion) else one for one in clips]
        length = T_h + T_p
        starts = []
        first = 0
        other = next((clip for clip in own if clip.fps != FPS), None)
        if other:
            raise ValueError(
                f"clip {other.source!r} has {other.fps:g} frames/s; resample it to {FPS:g} first"
            )
        for clip in own:
            starts.append(np.arange(first, first + len(clip) - length + 1))
            first += len(clip)
        starts = np.concatenate(starts) if starts else np.zeros(0, int)
        if not len(starts):
            raise ValueError(f"no clip has the {length} frames of a window; pass longer clips")
        poses = torch.from_numpy(np.concatenate([clip.features() for clip in own]))
        control = torch.from_numpy(
            np.concatenate([clip.control for clip in own]).astype(np.float32)
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
        self, batch: int, generator: torch.Generator
    ) -> tuple[Float[Tensor, "B T_h D"], Float[Tensor, "B T_p D"], Float[Tensor, "B T C"]]:
        """A random batch (past, future, control)."""
        chosen = torch.randint(len(self.starts), (batch,), generator=generator)
        rows = self.starts[chosen][:, None] + torch.arange(self.T_h + self.T_p)
        poses, control = self.poses[rows], self.control[rows]
        return poses[:, : self.T_h], poses[:, self.T_h :], control


def held_control(
    control: Float[Tensor, "B T C"], T_h: int, share: float, generator: torch.Generator
) -> Float[Tensor, "B T C"]:
    """The control of a batch, of which a `share` holds row T_h - 1 over the future.

    With a joystick the control after the step about to be taken is not known, so a rollout holds
    it. A network that was always trained with the true future control would trust a held one as
    well. No gain is claimed: who steers by hand cannot give what is ahead.
    Ours; MoDiff takes the control up to t + T_p as known.  Notebook: 07
    """
    hold = torch.rand(len(control), generator=generator) < share
    held = control[:, T_h - 1 : T_h].expand_as(control[:, T_h:])
    future = held.where(hold[:, None, None].to(held.device), control[:, T_h:])
    return torch.cat([control[:, :T_h], future], dim=1)


def typical_change(windows: Windows, samples: int = 4096) -> Float[Tensor, "D"]:
    """The RMS movement of poses from frame to frame, over windows, in standard deviations."""
    past, future, _ = windows.draw(samples, torch.Generator().manual_seed(0))
    return (future[:, 0] - past[:, -1]).square().mean(0).sqrt()
