"""Training windows of dance: seconds of motion and the music that sounds meanwhile, and the loss on them.

Motion has 20 frames a second, the Mel spectrogram 31.25: only every 0.8 s do both have a frame at the same moment, so
windows start there, and the music's frames lie at the same times in every window.
Source: MoFusion 4.1 (100 frames and more at a time; lengths are ours).  Notebook: 12
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Bool, Float, Int
from torch import Tensor, nn

from .conditions.music import frame_times
from .ddpm import Schedule, q_sample
from .kinematic_loss import (
    KinematicWeights,
    asymmetry_loss,
    bone_lengths,
    motion_loss,
    over_time,
    skeleton_loss,
    slide_loss,
)
from .motion.dance_frame import mirror, to_features, to_positions
from .motion.scaler import Scaler
from .motion.skeleton import BONES, JOINTS, TOES
from .prediction import target_of, to_x0

FPS = 20.0
MOTION_GRID, MEL_GRID = 16, 25  # frames in 0.8 s
PAIRS = tuple(
    (k, next(i for i, (_, other) in enumerate(BONES) if JOINTS[other] == JOINTS[child].replace("Left", "Right")))
    for k, (_, child) in enumerate(BONES)
    if JOINTS[child].startswith("Left")
)  # of bones, left and right


def mel_frames(n: int) -> int:
    """How many Mel frames sound during n frames of motion, the one at the start included."""
    return n * MEL_GRID // MOTION_GRID + 1


@dataclass(frozen=True, eq=False)
class DanceWindows:
    """Windows of n frames, standardised, with the Mel frames of the same seconds; contacts say which feet stand."""

    motion: Float[Tensor, "W T D"]
    contacts: Bool[Tensor, "W T 2"]
    mel: Float[Tensor, "F C"]  # of all songs, one after the other
    mel_starts: Int[Tensor, "W"]
    motion_scaler: Scaler
    mel_scaler: Scaler

    @classmethod
    def of(
        cls,
        dances: Sequence[Float[np.ndarray, "_ 21 3"]],
        contacts: Sequence[Bool[np.ndarray, "_ 2"]],
        mels: Sequence[Float[Tensor, "_ C"]],
        n: int = 100,
        scalers: tuple[Scaler, Scaler] | None = None,
    ) -> "DanceWindows":
        """Cut dances and the log-Mel of their songs into windows of n frames, and mirror each dance as well.

        Raises ValueError when no dance is long enough, or lists do not match.
        """
        if not len(dances) == len(contacts) == len(mels):
            raise ValueError(
                f"{len(dances)} dances, {len(contacts)} contacts and {len(mels)} songs: each needs its own"
            )
        motion, stands, starts, first = [], [], [], 0
        for dance, feet, mel in zip(dances, contacts, mels, strict=True):
            for k in range(
                0, min(len(dance) - n, (len(mel) - mel_frames(n)) // MEL_GRID * MOTION_GRID) + 1, MOTION_GRID
            ):
                window, standing = dance[k : k + n], feet[k : k + n]
                motion += [to_features(window), to_features(mirror(window))]
                stands += [standing, standing[:, ::-1]]
                starts += 2 * [first + k // MOTION_GRID * MEL_GRID]
            first += len(mel)
        if not motion:
            raise ValueError(f"no dance has {n} frames with music")
        motion = torch.from_numpy(np.stack(motion)).float()
        mel = torch.cat(list(mels)).float()
        motion_scaler, mel_scaler = scalers or (Scaler.fit(motion), Scaler.fit(mel))
        contacts = torch.from_numpy(np.stack(stands))
        starts = torch.tensor(starts)
        return cls(
            motion_scaler.transform(motion), contacts, mel_scaler.transform(mel), starts, motion_scaler, mel_scaler
        )

    @property
    def mel_times(self) -> Float[Tensor, "M"]:
        """When the Mel frames of a window sound: seconds from its first frame."""
        return frame_times(mel_frames(self.motion.shape[1])).float()

    def draw(
        self, batch: int, generator: torch.Generator
    ) -> tuple[Float[Tensor, "B T D"], Float[Tensor, "B M C"], Bool[Tensor, "B T 2"]]:
        """A random batch: motion, music, and which feet stand."""
        chosen = torch.randint(len(self.motion), (batch,), generator=generator)
        rows = self.mel_starts[chosen][:, None] + torch.arange(mel_frames(self.motion.shape[1]))
        return self.motion[chosen], self.mel[rows], self.contacts[chosen]


def dance_loss(
    windows: DanceWindows,
    schedule: Schedule,
    kinematic: KinematicWeights | None = None,
    *,
    batch: int = 32,
    high_noise: float = 0.0,
    changes: float = 0.0,
) -> Callable[[nn.Module, torch.Generator], Tensor]:
    """MoFusion's loss as a `loss_fn` for `training.train_steps`: the target's squared error, and L_k on x0_hat.

    `high_noise` = c weights the squared error at step s by 1 + min((1 - alpha_bar) / alpha_bar, c): an eps network
    would else hardly look where the beat is decided.
    Source: MoFusion eq. 4.  Notebook: 12, 13
    """
    noise_over_signal = ((1 - schedule.alpha_bar) / schedule.alpha_bar).float()
    data_weight = 1 + noise_over_signal.clamp_max(high_noise)
    lam = over_time(schedule, kinematic.over_time).float() if kinematic else None

    def loss_fn(model: nn.Module, generator: torch.Generator) -> Tensor:
        device = next(model.parameters()).device
        x0, mel, stands = (part.to(device) for part in windows.draw(batch, generator))
        s = torch.randint(1, schedule.S + 1, (batch,), generator=generator).to(device)
        eps = torch.randn(x0.shape, generator=generator).to(device)
        x_s = q_sample(x0, s, schedule, eps)
        out = model(x_s, s, model.listen(mel, windows.mel_times.to(device)))
        target = model.config.target
        wrong = out - target_of(x0, eps, s, schedule, target)
        error = wrong.square().mean((1, 2)) + changes * wrong.diff(dim=1).square().mean((1, 2))
        loss = (data_weight.to(device)[s] * error).mean()
        if kinematic:
            x0_hat = to_x0(out, x_s, s, schedule, target)
            parts = kinematic_parts(x0_hat, x0, stands, windows.motion_scaler.to(device))
            weighed = sum(getattr(kinematic, name) * value for name, value in parts.items())
            loss = loss + (lam.to(device)[s] * weighed).mean()
        return loss

    return loss_fn


def kinematic_parts(
    x0_hat: Float[Tensor, "B T D"], x0: Float[Tensor, "B T D"], stands: Bool[Tensor, "B T 2"], scaler: Scaler
) -> dict[str, Float[Tensor, "B"]]:
    """L_s, L_a, L_m and the foot-slide loss of standardised motions, by the names of KinematicWeights.  Notebook: 13"""
    positions = to_positions(scaler.inverse(x0_hat))
    lengths = bone_lengths(positions, BONES)
    return {
        "skeleton": skeleton_loss(lengths),
        "asymmetry": asymmetry_loss(lengths, PAIRS),
        "motion": motion_loss(x0_hat, x0),
        "slide": slide_loss(positions, stands, TOES),
    }
