"""A second recogniser: a small network that reads a timeline off a motion.

`Mover.act` draws again what the rules of `metrics.texts` do not see. So these rules must not judge
it: whatever they mistake would be drawn until they are content. This network has learnt from
synthetic clips what goes on in each frame (`beyond.timeline`), and knows nothing of the rules.
"""

from collections.abc import Callable

import numpy as np
import scipy
import torch
from jaxtyping import Float
from torch import Tensor, nn

from motiondiff_edu.beyond import timeline
from motiondiff_edu.metrics.texts import Recognised
from motiondiff_edu.motion import moving_frame
from motiondiff_edu.motion.root_frame import FPS
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.recipes.mover import described

CLIPS = 4000
SEED = 71
STEPS = 3000
FRAMES = 4000  # of a batch
WIDTH = 96
DILATIONS = (1, 2, 4, 8, 16, 1)
REACH = 5  # frames
BOTH = ("wave", "raise", "hold")  # acts that both arms can do
NOISE = 0.1  # standard deviations on the poses: generated ones are not those of the data


class Tagger(nn.Module):
    """Convolutions from poses to the columns of a timeline; each frame sees six seconds."""

    def __init__(self):
        super().__init__()
        self.enter = nn.Conv1d(moving_frame.D, WIDTH, 1)
        self.layers = nn.ModuleList(
            nn.Conv1d(WIDTH, 2 * WIDTH, REACH, padding="same", dilation=d) for d in DILATIONS
        )
        self.leave = nn.Conv1d(WIDTH, timeline.D, 1)

    def forward(self, x: Float[Tensor, "B T 66"]) -> Float[Tensor, "B T 24"]:
        h = self.enter(x.mT)
        for layer in self.layers:
            h = h + nn.functional.glu(layer(nn.functional.relu(h)), dim=1)
        return self.leave(h).mT


def trained(log: Callable[[str], object] = print) -> tuple[Tagger, Scaler]:
    """A tagger, after some minutes of training on clips of its own."""
    windows = described(CLIPS, SEED).windows
    generator = torch.Generator().manual_seed(SEED)
    torch.manual_seed(SEED)
    model = Tagger()
    optimizer = torch.optim.AdamW(model.parameters(), lr=1e-3)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimizer, 1e-3, total_steps=STEPS)
    for step in range(STEPS):
        x, _, _ = windows.draw(FRAMES, generator)
        poses, wanted = x[..., : moving_frame.D], x[..., moving_frame.D :]
        poses = poses + NOISE * torch.randn(poses.shape, generator=generator)
        loss = (model(poses) - wanted).square().mean()
        optimizer.zero_grad()
        loss.backward()
        nn.utils.clip_grad_norm_(model.parameters(), 1.0)
        optimizer.step()
        schedule.step()
        if step % 250 == 0:
            log(f"tagger {step}/{STEPS}: loss {loss.item():.4f}")
    return model.eval(), windows.scaler


@torch.no_grad()
def tagged(
    model: Tagger, scaler: Scaler, positions: Float[np.ndarray, "T 21 3"]
) -> list[Recognised]:
    """The acts that the network sees in a motion (metres, 20 frames/s), without directions."""
    features = torch.from_numpy(moving_frame.to_features(positions)).float()
    poses = scaler.part(slice(moving_frame.D)).transform(features)[None]
    columns = scaler.part(slice(moving_frame.D, None)).inverse(model(poses))[0]
    made = columns.double().numpy()
    return [
        Recognised(one.verb, side_of(one), times_of(one, made), "", one.first, one.last)
        for one in timeline.acts_of(made)
    ]


def times_of(act: timeline.Timed, columns: Float[np.ndarray, "T 24"]) -> int:
    """How often an act is done: the hills of the column that says how far each time is."""
    if act.verb not in timeline.WITH_TIMES:
        return 1
    hills = columns[
        round(act.first * FPS) : round(act.last * FPS),
        timeline.MIDDLE + (act.verb in timeline.ARMS),
    ]
    smooth = scipy.ndimage.gaussian_filter1d(hills, 1.0)
    return max(1, len(scipy.signal.find_peaks(np.pad(smooth, 1), height=0.4, prominence=0.3)[0]))


def side_of(act: timeline.Timed) -> str:
    """The side of an act; a timeline has the same number for both arms and for no side."""
    return act.side or ("both" if act.verb in BOTH else "")
