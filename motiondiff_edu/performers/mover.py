"""A mover: MoFusion from text with its units. It turns a sentence into motions.

Source: MoFusion 3, 4.2.
"""

import copy
import warnings
from dataclasses import dataclass, field

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor, nn

from ..beyond.classifier_free import guided_by_text
from ..conditions.clip import Clip, check
from ..conditions.word_encoder import WordReader
from ..ddpm import Denoiser, Generators, Schedule, draw
from ..motion.checks import checked_count, checked_seconds, checked_steps
from ..motion.motion import Motion
from ..motion.moving_frame import D, to_features, to_positions
from ..motion.root_frame import FPS
from ..motion.scaler import Scaler
from ..prediction import denoiser_of
from .performer import Performer, generators, sampled
from .text_mofusion import Texts
from .with_bar import with_bar

STEPS, ETA = 50, 0.5  # defaults of DDIM
SECONDS = 6.0
SHORTEST, LONGEST = 2.0, 10.0  # seconds, as in training


@dataclass(frozen=True, eq=False)
class Mover(Performer):
    """A network, and the scaler that converts its units to metres.

    A network that reads by CLIP needs that `clip` (`conditions.clip.load`), and no other takes one.
    Raises ValueError for a schedule that does not fit the network, for no CLIP or one too many, and
    ClipError for another CLIP than that of the training.
    """

    model: nn.Module
    schedule: Schedule
    motion_scaler: Scaler
    card: dict = field(default_factory=dict)
    clip: Clip | None = None

    def __post_init__(self):
        super().__post_init__()
        name = getattr(self.config, "clip", "")
        if name and self.clip is None:
            raise ValueError(f"the network reads by CLIP: pass clip=conditions.clip.load({name!r})")
        if self.clip is not None and not name:
            raise ValueError("the network reads words of its own, and takes no CLIP")
        if self.clip is not None:
            check(self.clip, self.config.clip_width, self.card.get("clip_sample"))

    def to(self, device: str | torch.device) -> "Mover":
        """The same mover on another device."""
        model = copy.deepcopy(self.model).to(device)
        return Mover(model, self.schedule, self.motion_scaler.to(device), self.card, self.clip)

    @property
    def device(self) -> torch.device:
        return self.motion_scaler.mean.device

    @property
    def reader(self) -> WordReader | Clip:
        """How this network reads: `read(text)`, and `encoded(...)` for what the network takes."""
        return self.clip or WordReader(self.config.words)

    def denoiser(self, ids: Texts, guidance: float = 1.0, fast: bool = True) -> Denoiser:
        """`denoise(x_s, s) -> eps_hat` for these texts (`reader.encoded`).

        `guidance`: w of `beyond.classifier_free`; 1 is the conditional network.
        """
        texts = [ids] if guidance == 1 else [ids, self.reader.encoded([()] * len(ids))]
        contexts = [self.model.listen(one.to(self.device)) for one in texts]
        conditional, *nothing = (
            denoiser_of(
                lambda x_s, s, context=context: self._evaluated(x_s, s, context),
                self.schedule,
                self.config.target,
            )
            for context in contexts
        )
        return guided_by_text(conditional, nothing[0], guidance) if nothing else conditional

    def act(
        self,
        text: str,
        *,
        seconds: float = SECONDS,
        samples: int = 1,
        seed: int = 0,
        steps: int | None = STEPS,
        guidance: float = 1.0,
        progress: bool = True,
    ) -> Motion | list[Motion]:
        """Do what a sentence says, such as "walks forward, then waves with the left hand".

        The figure begins at the origin, facing z. A warning says which words were read as others.

        seconds   of the motion, from 2 to 10; a long sentence needs the time that it takes
        samples   above 1: a list with this many motions; the first is that of samples=1
        steps     of DDIM, or None for DDPM with all steps
        guidance  above 1 it follows the text more closely, at twice the cost
                  (`beyond.classifier_free`)
        Raises TextError for a text that cannot be read, ValueError for numbers out of range.
        Source: MoFusion 3.
        """
        found = self.reader.read(text)
        for note in found.notes:
            warnings.warn(note, stacklevel=2)
        count, steps = checked_count(samples, "samples"), checked_steps(steps)
        if not SHORTEST <= checked_seconds(seconds) <= LONGEST:
            raise ValueError(
                f"seconds must be from {SHORTEST:g} to {LONGEST:g}, as in training, not {seconds:g}"
            )
        ids = self.reader.encoded([found.words] * count)
        draws, frames = generators(seed, count), round(seconds * FPS)
        evaluations = min(steps or self.schedule.S, self.schedule.S)
        with with_bar(self, evaluations, "moving", progress) as one:
            made = one.act_ids(ids, frames, generator=draws, steps=steps, guidance=guidance)
        source = f"{text.strip():.60}"
        made = [Motion(x, FPS, source=source) for x in made.double().cpu().numpy()]
        return made if samples > 1 else made[0]

    def act_ids(
        self,
        ids: Texts,
        frames: int,
        *,
        generator: Generators | None = None,
        steps: int | None = STEPS,
        eta: float = ETA,
        guidance: float = 1.0,
        start: Float[Tensor, "B T F"] | None = None,
    ) -> Float[Tensor, "B T 21 3"]:
        """Motions in metres for texts as the network takes them (`reader.encoded`), one each.

        `start` is the noise to begin with (default: drawn); pass the same to compare two texts.
        """
        how = {"generator": generator, "steps": steps, "eta": eta, "guidance": guidance}
        return self.positions_of(self.act_units(ids, frames, start=start, **how))

    @torch.inference_mode()
    def act_units(
        self,
        ids: Texts,
        frames: int,
        *,
        generator: Generators | None = None,
        steps: int | None = STEPS,
        eta: float = ETA,
        guidance: float = 1.0,
        start: Float[Tensor, "B T F"] | None = None,
    ) -> Float[Tensor, "B T F"]:
        """The same in the network's units, with all columns that it generates.

        `positions_of` makes motions of them, and `timeline_of` shows what was planned.
        """
        denoise = self.denoiser(ids, guidance)
        where = self.motion_scaler.mean.new_empty(len(ids), frames, self.config.D)
        x_S = draw(where, generator) if start is None else start.to(self.device)
        return sampled(denoise, x_S, self.schedule, steps, eta, generator)

    def positions_of(self, x0: Float[Tensor, "*B T F"]) -> Float[Tensor, "*B T 21 3"]:
        """Motions in metres, of the network's units; columns of a timeline are left out."""
        return to_positions(self.motion_scaler.inverse(x0)[..., :D])

    def timeline_of(self, x0: Float[Tensor, "*B T F"]) -> Float[Tensor, "*B T P"]:
        """The timeline that was generated with a motion (`beyond/timeline.py`).

        Raises ValueError for a network that has none.
        """
        if self.config.D == D:
            raise ValueError("this mover generates motions alone, without a timeline")
        return self.motion_scaler.inverse(x0)[..., D:]

    def units_of(self, positions: Float[np.ndarray, "T 21 3"]) -> Float[Tensor, "T F"]:
        """A motion in the network's units. Its timeline, which nobody knows, is 0, the mean.

        Raises ValueError for another skeleton.
        """
        features = torch.from_numpy(to_features(positions)).float().to(self.device)
        mean, std = self.motion_scaler.mean, self.motion_scaler.std
        units = (features - mean[:D]) / std[:D]
        return torch.nn.functional.pad(units, (0, self.config.D - D))
