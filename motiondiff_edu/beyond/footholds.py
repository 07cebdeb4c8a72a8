"""Footholds: a MoDiff whose ankles and toes can stay where they are in the world.

A planted foot is at rest in the world. In the root frame it moves backwards, as fast as the root
moves forwards. A network that predicts it in every frame errs by millimetres, so the foot slides.
But the control alone gives the exact place of a joint that stays where it was in the last pose
(`held`). So for each ankle and toe the network predicts a gate between 0 and 1:

    x0_hat = gate * held + (1 - gate) * free
In training the past has noise (`past_noise`). A foot that is held at a noised place is wrong, so
the gate would learn never to hold. `CleanFootholds` removes most of this noise under the feet.
Gain: docs/RESULTS.md, *From the paper's walker to ours* (`ladder.ours-no-footholds.*`,
docs/results/ladder): feet slide less; bone errors are larger.
Ours; neither paper has it.  Notebook: 07
"""

from dataclasses import dataclass

import torch
from jaxtyping import Float, Int
from torch import Tensor, nn

from ..diffusion_dropout import changed_samples
from ..modiff import Memory, MoDiff, MoDiffConfig
from ..motion.scaler import Scaler
from ..motion.skeleton import J, joint_index
from .shared_encoding import SharedEncoding

FEET = [joint_index(name) for name in ("LeftFoot", "LeftToeBase", "RightFoot", "RightToeBase")]
LEAN, AWAY = 2.0, 0.25  # see `openness`
STRETCH = 0.1
NEAR = 0.015  # metres
COLUMNS = [3 * joint + axis for joint in FEET for axis in range(3)]


def held_positions(
    joints: Float[Tensor, "B K 3"], control: Float[Tensor, "B T 3"], fps: float = 20.0
) -> Float[Tensor, "B T K 3"]:
    """The future positions, in the root frame, of joints that stay where they are in the world.

    `joints` are in metres, in the root frame of the last pose. Row t of the control takes the root
    to frame t + 1, at the halfway heading; result t is in that frame.
    """
    forward, left, yaw = (control / fps).unbind(-1)
    heading = yaw.cumsum(1)
    halfway = heading - yaw / 2
    root_x = (forward * halfway.sin() + left * halfway.cos()).cumsum(1)
    root_z = (forward * halfway.cos() - left * halfway.sin()).cumsum(1)
    x, y, z = joints[:, None].unbind(-1)
    x, z = x - root_x[..., None], z - root_z[..., None]
    sin, cos = heading.sin()[..., None], heading.cos()[..., None]
    return torch.stack([x * cos - z * sin, y.expand_as(x), x * sin + z * cos], dim=-1)


@dataclass(frozen=True)
class FootholdConfig(MoDiffConfig):
    """Sizes of a network with footholds.

    A foothold is a position, so the target is x0, without the skip.
    Raises ValueError for another target, for a skip, for another skeleton than the course's, or for
    another control than forward, left and turning speed.
    """

    target: str = "x0"
    skip: bool = False

    def __post_init__(self):
        super().__post_init__()
        if self.target != "x0" or self.skip:
            raise ValueError('a foothold is a position: it needs target="x0" and skip=False')
        if self.D != 3 * J:
            raise ValueError(
                f"footholds are for the {J} joints of the course's skeleton, D = {3 * J}, "
                f"not {self.D}"
            )
        if self.C != 3:
            raise ValueError(
                f"footholds follow from forward, left and turning speed, C = 3, not {self.C}"
            )


@dataclass(frozen=True, eq=False)
class Standing(Memory):
    """The memory of past and control, and the standardised COLUMNS of feet that stay in place."""

    held: Float[Tensor, "B T_p K"]

    def rows(self, chosen: Int[Tensor, "N"]) -> "Standing":
        return Standing(**vars(super().rows(chosen)) | {"held": self.held[chosen]})


class FootholdMoDiff(MoDiff):
    """MoDiff for x0 with a gate for each ankle and toe, in each frame, that can hold it in place.

    It needs the scalers, because footholds are computed in metres and m/s. They are not saved with
    the weights.
    """

    pose_mean: Tensor
    pose_std: Tensor
    control_mean: Tensor
    control_std: Tensor

    def __init__(self, config: FootholdConfig, pose_scaler: Scaler, control_scaler: Scaler):
        super().__init__(config)
        self.gate = nn.Linear(config.width, len(FEET))
        nn.init.zeros_(self.gate.weight)
        nn.init.constant_(self.gate.bias, -2.0)  # at the start the feet are nearly free
        units = {
            "pose_mean": pose_scaler.mean[COLUMNS],
            "pose_std": pose_scaler.std[COLUMNS],
            "control_mean": control_scaler.mean,
            "control_std": control_scaler.std,
        }
        for name, value in units.items():
            self.register_buffer(name, value.clone(), persistent=False)

    def held(
        self, pose: Float[Tensor, "B D"], control: Float[Tensor, "B T C"]
    ) -> Float[Tensor, "B T_p K"]:
        """`held_positions` of the feet of a pose (the last one given), everything standardised."""
        feet = pose[:, COLUMNS] * self.pose_std + self.pose_mean
        ahead = control[:, self.config.T_h - 1 : -1] * self.control_std + self.control_mean
        places = held_positions(feet.unflatten(-1, (-1, 3)), ahead).flatten(-2)
        return (places - self.pose_mean) / self.pose_std

    def encode(
        self,
        past: Float[Tensor, "B T_h D"],
        control: Float[Tensor, "B T C"],
        standing: Float[Tensor, "B D"] | None = None,
    ) -> Standing:
        """The memory, and the footholds of the pose `standing` (default: the last given pose)."""
        held = self.held(past[:, -1] if standing is None else standing, control)
        return Standing(**vars(super().encode(past, control)), held=held)

    def decode(
        self, x_s: Float[Tensor, "B T_p D"], s: Int[Tensor, "B"], memory: Memory
    ) -> Float[Tensor, "B T_p D"]:
        """x0_hat: free for most joints, between free and held for the feet.

        Raises TypeError for a memory without footholds.
        """
        if not isinstance(memory, Standing):
            raise TypeError("decode takes what `encode` of this network returns, a Standing")
        x = self.attend(self.embed(x_s, s, memory), memory)
        return self.placed(self.head(x), self.gate(x), memory.held)

    def placed(
        self,
        free: Float[Tensor, "B T_p D"],
        gate: Float[Tensor, "B T_p F"],
        held: Float[Tensor, "B T_p K"],
    ) -> Float[Tensor, "B T_p D"]:
        """Move the feet from free to held: by sigmoid(gate) in training, else by `openness`."""
        if self.training:
            return blend(free, torch.sigmoid(gate), held)
        apart = ((held - free[..., COLUMNS]) * self.pose_std).unflatten(-1, (-1, 3)).norm(dim=-1)
        return blend(free, openness(gate, apart), held)


@dataclass(frozen=True, eq=False)
class CleanFootholds:
    """A network with footholds in training: it gets the noised past, but nearly clean footholds.

    clean, noised  the past before and after `past_noise`
    foot_noise     fraction of the past noise applied to the held feet, 0 to 1
    If diffusion dropout noised the past as well, the footholds come from the last pose of that
    past. Otherwise the network would still see the clean feet.
    """

    model: FootholdMoDiff | SharedEncoding  # of a FootholdMoDiff
    clean: Float[Tensor, "B T_h D"]
    noised: Float[Tensor, "B T_h D"]
    foot_noise: float

    @property
    def config(self) -> MoDiffConfig:
        return self.model.config

    def __call__(
        self,
        x_s: Float[Tensor, "B T_p D"],
        s: Int[Tensor, "B"],
        past: Float[Tensor, "B T_h D"],
        control: Float[Tensor, "B T C"],
    ) -> Float[Tensor, "B T_p D"]:
        standing = torch.lerp(self.clean, self.noised, self.foot_noise)[:, -1]
        dropped = changed_samples(self.noised, past)
        standing = past[:, -1].where(dropped[:, None], standing)
        return self.model.decode(x_s, s, self.model.encode(past, control, standing))


def blend(
    free: Float[Tensor, "B T_p D"], share: Float[Tensor, "B T_p F"], held: Float[Tensor, "B T_p K"]
) -> Float[Tensor, "B T_p D"]:
    """share * held + (1 - share) * free in the feet's columns, with one share per joint."""
    out = free.clone()
    out[..., COLUMNS] = torch.lerp(out[..., COLUMNS], held, share.repeat_interleave(3, dim=-1))
    return out


def openness(
    gate: Float[Tensor, "*B F"], apart: Float[Tensor, "*B F"] | float = 0.0
) -> Float[Tensor, "*B F"]:
    """How far the gate of a joint is open in use, from 0 (free) to 1 (held).

    gate   its logit; in training, the share of the held place is the logit's sigmoid
    apart  metres between the held place and the one where the network puts the joint

        w = exp(-(apart / NEAR)^2)
        share = (1 + 2 STRETCH) sigmoid(gate + LEAN w - AWAY (1 - w)) - STRETCH, within 0..1

    Sliding by millimetres barely changes the training loss, but it is visible. So where both places
    are near each other (w near 1), the gate leans towards holding. Where they are centimetres apart
    it leans a little away from it: there the foot lifts, or the last pose is wrong. The stretch
    fully opens a gate that is nearly open. The numbers were chosen on walks that docs/RESULTS.md
    does not use.
    Source: ours; the stretch is that of the hard concrete distribution (Louizos and others, 2018).
    Notebook: 07
    """
    w = torch.exp(-((torch.as_tensor(apart) / NEAR) ** 2))
    leaning = gate + LEAN * w - AWAY * (1 - w)
    return ((1 + 2 * STRETCH) * torch.sigmoid(leaning) - STRETCH).clamp(0, 1)
