"""A mover: MoFusion from text with its units. It turns a sentence into motions.

Source: MoFusion 3, 4.2, Fig. 1, Fig. 6.
Notebook: 16, 17
"""

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor

from ..beyond import timeline
from ..beyond.classifier_free import guided_by_condition
from ..conditions.acts import USUALLY, Parts, in_words, scheduled, seconds_of
from ..conditions.clip import ClipModel, check
from ..conditions.text import Read
from ..conditions.word_encoder import WordReader
from ..ddpm import Denoiser, Generators, draw
from ..metrics import texts
from ..motion.arguments import (
    checked_count,
    checked_guidance,
    checked_samples,
    checked_seconds,
    checked_seed,
    checked_steps,
)
from ..motion.cleanup import Body, clean_up
from ..motion.motion import Motion, MotionWarning
from ..motion.moving_frame import D, to_features, to_positions
from ..motion.root_frame import FPS
from ..motion.scaler import Scaler
from ..motion.skeleton import BONE_LENGTHS
from .described_windows import GRID
from .networks import MoverConfig, MoverNetwork
from .performer import STEPS, Performer, Watch, bar, evaluating, float32, generators, sample_motion
from .planned_mofusion import PlannedMoFusion
from .text_mofusion import TextMoFusionConfig, Texts

ETA = 0.5  # default of DDIM
SECONDS = 6.0
SHORTEST, LONGEST = 2.0, 10.0  # seconds, as in training
TRIES = 4  # draws of a motion that does not show what was asked for


def checked_length(seconds: float) -> float:
    """The length of a motion, from SHORTEST to LONGEST seconds.  Raises ValueError for others."""
    if not SHORTEST <= checked_seconds(seconds) <= LONGEST:
        raise ValueError(
            f"seconds must be from {SHORTEST:g} to {LONGEST:g}, as in training, not {seconds:g}"
        )
    return float(seconds)


def lacking(asked: tuple, positions: Float[np.ndarray, "T 21 3"]) -> list[str]:
    """What a motion does not show of the acts that were asked for, in words."""
    if not asked:
        return []
    phrases = [[texts.Asked(a.verb, a.side, a.count, a.direction) for a in part] for part in asked]
    return texts.shortfalls(phrases, texts.actions(positions))


def written(
    asked: Parts, frames: int, draws: Sequence[torch.Generator]
) -> Float[Tensor, "B {frames} 24"]:
    """Timelines as one would write them for acts (`conditions.acts.scheduled`), one for each draw.

    A planner that has seen few of the pairs, counts and orders that there are misses some of them;
    nobody can miss them who writes them down.
    """
    made = []
    for one in draws:
        rng = np.random.default_rng(int(torch.randint(2**62, (), generator=one)))
        timed = [
            timeline.Timed(act.verb, act.side, act.count or USUALLY.get(act.verb, 1), first, last)
            for act, first, last in scheduled(asked, frames / FPS, rng)
        ]
        made.append(timeline.timeline(timed, frames))
    return torch.from_numpy(np.stack(made)).float()


def until_shown(
    asked: tuple,
    draw: Callable[[list[int], int], list[Float[np.ndarray, "T 21 3"]]],
    count: int,
    tries: int,
) -> tuple[list[Float[np.ndarray, "T 21 3"]], list[list[str]]]:
    """Motions that show what was asked for, or of `tries` draws the one that shows most of it.

    `draw(which, again)` makes those of the `count` samples that are named, for the first time (0)
    or again (1, 2, ...). Returned are the motions, and what each of them lacks.
    """
    acts = draw(list(range(count)), 0)
    wrong = [lacking(asked, act) for act in acts]
    for again in range(1, tries):
        which = [k for k in range(count) if wrong[k]]
        for k, act in zip(which, draw(which, again) if which else [], strict=True):
            others = lacking(asked, act)
            if len(others) < len(wrong[k]):
                acts[k], wrong[k] = act, others
    return acts, wrong


@dataclass(frozen=True, eq=False, repr=False)
class Mover(Performer):
    """A network, and the scaler that converts its units to metres.

    A network that reads by CLIP needs that `clip` (`conditions.clip.load`), and no other takes one.
    Raises ValueError for a schedule that does not fit the network, for no CLIP or one too many, and
    ClipError for another CLIP than that of the training.
    """

    model: MoverNetwork
    motion_scaler: Scaler
    card: dict = field(default_factory=dict)
    clip: ClipModel | None = None

    def __post_init__(self):
        super().__post_init__()
        config = self.config
        if isinstance(config, TextMoFusionConfig) and config.clip:
            if self.clip is None:
                how = f"pass clip=conditions.clip.load({config.clip!r})"
                raise ValueError(f"the network reads by CLIP: {how}")
            check(self.clip, config.clip_width, self.card.get("clip_sample"))
        elif self.clip is not None:
            raise ValueError("the network reads words of its own, and takes no CLIP")

    @property
    def config(self) -> MoverConfig:
        return self.model.config

    @property
    def device(self) -> torch.device:
        return self.motion_scaler.mean.device

    @property
    def reader(self) -> WordReader | ClipModel:
        """How this network reads: `read(text)`, and `encoded(...)` for what the network takes."""
        return self.clip or WordReader(self.config.words)

    def denoiser(
        self,
        ids: Texts,
        frames: int,
        guidance: float = 1.0,
        plan: Float[Tensor, "#B T 24"] | Float[np.ndarray, "#B T 24"] | None = None,
    ) -> Denoiser:
        """`denoise(x_s, s) -> eps_hat` of motions of `frames` frames for texts (`reader.encoded`).

        The texts are encoded here, once; each call decodes.

        `guidance`: w of `beyond.classifier_free`; 1 is the conditional network.
        `plan`: a timeline for each (`plans`), which a network that plans needs.
        Raises ValueError for a network that plans without a plan, or a plan for another, or of
        another shape.
        """
        if (plan is None) == self.can_plan:
            what = "needs one: see `plans`" if plan is None else "takes none"
            raise ValueError(f"plan: this mover {what}")
        if plan is None:
            return self._guided(self.model, ids, frames, guidance)
        given = self.plan_scaler.transform(self._plan(plan, len(ids), frames))
        return self._guided(self.model, ids, frames, guidance, given.expand(len(ids), -1, -1))

    def plan_denoiser(self, ids: Texts, frames: int, guidance: float = 1.0) -> Denoiser:
        """The same for timelines in the network's units.

        Raises ValueError for a network that does not plan.
        """
        if not isinstance(self.model, PlannedMoFusion):
            raise ValueError("this mover makes no plans")
        return self._guided(self.model.planner, ids, frames, guidance)

    def _plan(self, plan: Tensor | np.ndarray, texts: int, frames: int) -> Float[Tensor, "#B T 24"]:
        """A plan as the network takes it.  Raises ValueError for one of another shape."""
        made = torch.as_tensor(plan, dtype=torch.float32, device=self.device)
        if made.ndim != 3 or made.shape[0] not in (1, texts) or made.shape[2] != timeline.D:
            raise ValueError(
                f"plan: its shape must be (1 or {texts}, frames, {timeline.D}), not "
                f"{tuple(made.shape)}"
            )
        if made.shape[1] != frames:
            raise ValueError(f"plan: it has {made.shape[1]} frames, and the motion {frames}")
        return made

    def _guided(
        self, network: MoverNetwork, ids: Texts, frames: int, guidance: float, *plans: Tensor
    ) -> Denoiser:
        """The denoiser of a network for these texts, away from no text if guidance is not 1."""
        guidance = checked_guidance(guidance)

        def denoiser(texts: Texts) -> Denoiser:
            with evaluating(network), torch.no_grad():
                memory = network.encode(network.listen(texts.to(self.device)), frames)
            return self._denoiser(network.decode, memory, *plans)

        if guidance == 1:
            return denoiser(ids)
        nothing = self.reader.encoded([()] * len(ids))
        return guided_by_condition(denoiser(ids), denoiser(nothing), guidance)

    @property
    def can_plan(self) -> bool:
        """Whether a timeline is generated before the motion (`performers/planned_mofusion.py`)."""
        return isinstance(self.model, PlannedMoFusion)

    @torch.no_grad()
    @float32()
    def plans(
        self,
        ids: Texts,
        frames: int,
        *,
        generator: Generators | None = None,
        steps: int | None = STEPS,
        eta: float = ETA,
        guidance: float = 1.0,
        start: Float[Tensor, "B T 24"] | None = None,
        watch: Watch = iter,
    ) -> Float[Tensor, "B T 24"]:
        """Timelines for texts (`beyond/timeline.py`), tidied up; for a network that plans.

        `start` is the noise to begin with (default: drawn).
        """
        denoise = self.plan_denoiser(ids, frames, guidance)
        x_S = self._noise((len(ids), frames, timeline.D), generator, start)
        made = sample_motion(denoise, x_S, self.schedule, steps, eta, generator, watch)
        return timeline.tidied(self.plan_scaler.inverse(made))

    def act(
        self,
        text: str | Read,
        *,
        seconds: float | None = None,
        samples: int = 1,
        seed: int = 0,
        steps: int | None = STEPS,
        guidance: float = 1.0,
        tries: int = TRIES,
        progress: bool = True,
    ) -> Motion | list[Motion]:
        """Do what a sentence says, such as "walks forward, then waves with the left hand".

        `about` of the motion says in plain words what was read. The figure begins at the origin,
        facing z. Its bones have constant lengths, and feet that
        stand do not slide (`motion/cleanup`; `act_ids` has the network's own). A warning
        says which words were read as others; there is none for a text that `reader.read` has read
        already (its `notes` say the same).

        seconds   of the motion, from 2 to 10 (default: what the acts of the sentence take)
        samples   above 1: a list with this many motions; the first is that of samples=1
        steps     of DDIM, or None for DDPM with all steps, and noise of the posterior's variance
        guidance  above 1 it follows the text more closely, at twice the cost
                  (`beyond.classifier_free`)
        tries     a motion that does not show what was asked for (`metrics.texts.shortfalls`) is
                  drawn again, so often in all, by a timeline that is `written` for its acts; the
                  one that shows most is taken, and a warning says what is not to be seen. `notes`
                  keep it
        Raises TextError for a text that cannot be read, ValueError for numbers out of range.
        Source: MoFusion 3.
        """
        count, steps = checked_samples(samples), checked_steps(steps, self.schedule.S)
        guidance, tries = checked_guidance(guidance), checked_count(tries, "tries")
        checked_seed(seed)
        if seconds is not None:
            checked_length(seconds)
        if isinstance(text, Read):
            found = text
        else:
            found = self.reader.read(text)
            for note in found.notes:
                warnings.warn(note, MotionWarning, stacklevel=2)
        lasts = seconds or seconds_of(found.asked) or SECONDS
        frames = round(lasts * FPS)
        bars = bar("moving", (steps or self.schedule.S) + 1, progress)

        def draw(which: list[int], again: int) -> list[Float[np.ndarray, "T 21 3"]]:
            draws = generators(seed, count, *([again] if again else []))
            draws = [draws[k] for k in which]
            return self._acts(found, frames, draws, steps, guidance, bars, again > 0)

        acts, wrong = until_shown(found.asked, draw, count, tries)
        made = []
        for act, words in zip(acts, wrong, strict=True):
            notes = (f"asked: {found.text:.80}; but {'; '.join(words)}",) if words else ()
            for note in notes:
                warnings.warn(note, MotionWarning, stacklevel=2)
            notes, about = (*found.notes, *notes), in_words(found.asked)
            made.append(Motion(act, FPS, source=f"{found.text:.60}", notes=notes, about=about))
        return made if samples > 1 else made[0]

    @float32()
    def _acts(
        self,
        found: Read,
        frames: int,
        draws: list[torch.Generator],
        steps: int | None,
        guidance: float,
        watch: Watch,
        by_schedule: bool,
    ) -> list[Float[np.ndarray, "{frames} 21 3"]]:
        """Motions for a text that was read, one for each generator, with clean feet and bones.

        Timelines are generated, or written for the acts that were read (`written`).
        """
        ids = self.reader.encoded([found.words] * len(draws))
        whole = -(-frames // GRID) * GRID  # as in training; what is too much is cut off
        plan = None
        if self.can_plan and by_schedule:
            plan = written(found.asked, whole, draws)
        elif self.can_plan:
            plan = self.plans(
                ids, whole, generator=draws, steps=steps, guidance=guidance, watch=watch
            )
        denoise = self.denoiser(ids, whole, guidance, plan)
        x_S = self._noise((len(draws), whole, D), draws, None)
        made = self.positions_of(
            sample_motion(denoise, x_S, self.schedule, steps, ETA, draws, watch)
        )
        acts = made.double().cpu().numpy()
        return [clean_up(x, FPS, body=Body.of(x, bones=BONE_LENGTHS))[:frames] for x in acts]

    @torch.no_grad()
    @float32()
    def act_ids(
        self,
        ids: Texts,
        frames: int,
        *,
        generator: Generators | None = None,
        steps: int | None = STEPS,
        eta: float = ETA,
        guidance: float = 1.0,
        start: Float[Tensor, "B T 66"] | None = None,
        plan: Float[Tensor, "#B T 24"] | Float[np.ndarray, "#B T 24"] | None = None,
    ) -> Float[Tensor, "B T 21 3"]:
        """Motions in metres for texts as the network takes them (`reader.encoded`), one each.

        `start` is the noise to begin with (default: drawn); pass the same to compare two texts.
        `plan`: the timelines of the motions; by default a network that plans makes its own.
        `steps` as in `act`.
        Raises ValueError for a plan of another length or shape.
        """
        if plan is None and self.can_plan:
            plan = self.plans(
                ids, frames, generator=generator, steps=steps, eta=eta, guidance=guidance
            )
        denoise = self.denoiser(ids, frames, guidance, plan)
        x_S = self._noise((len(ids), frames, D), generator, start)
        return self.positions_of(sample_motion(denoise, x_S, self.schedule, steps, eta, generator))

    def _noise(
        self, shape: tuple[int, ...], generator: Generators | None, start: Tensor | None
    ) -> Tensor:
        """The noise to begin with: what is given, or drawn."""
        if start is not None:
            return start.to(self.device)
        return draw(self.motion_scaler.mean.new_empty(shape), generator)

    @property
    def pose_scaler(self) -> Scaler:
        """The scaler of motions, without the columns of timelines."""
        return self.motion_scaler.part(slice(D))

    @property
    def plan_scaler(self) -> Scaler:
        """The scaler of timelines."""
        return self.motion_scaler.part(slice(D, None))

    def positions_of(self, x0: Float[Tensor, "*B T 66"]) -> Float[Tensor, "*B T 21 3"]:
        """Motions in metres, of the network's units."""
        return to_positions(self.pose_scaler.inverse(x0))

    def units_of(self, positions: Float[np.ndarray, "T 21 3"]) -> Float[Tensor, "T 66"]:
        """A motion in the network's units.  Raises ValueError for another skeleton."""
        features = torch.from_numpy(to_features(positions)).float().to(self.device)
        return self.pose_scaler.transform(features)
