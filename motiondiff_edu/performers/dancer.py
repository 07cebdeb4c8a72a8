"""A dancer: MoFusion's network, its schedule, and its scalers. It turns music into a dance.

Source: MoFusion 3, 4.1, Fig. 1.  Notebook: 00, 12
"""

import warnings
from dataclasses import dataclass, field
from pathlib import Path
from typing import BinaryIO

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor

from ..beyond.classifier_free import guided_by_condition, while_between, without
from ..beyond.guidance import with_guess
from ..conditions.audio_files import SILENT, AudioError, samples_of
from ..conditions.music import FRAMES_PER_SECOND, SAMPLE_RATE, fingerprint, frame_times, log_mel
from ..ddpm import Denoiser, Generators, draw
from ..mofusion import MoFusion, MoFusionConfig, Music
from ..motion.arguments import (
    checked_guidance,
    checked_samples,
    checked_seconds,
    checked_seed,
    checked_steps,
)
from ..motion.cleanup import Body, clean_up
from ..motion.dance_frame import to_positions
from ..motion.motion import Motion, MotionWarning
from ..motion.retarget import SHORTEST
from ..motion.scaler import Scaler
from .dance_windows import FPS, mel_frames
from .networks import DancerNetwork, register
from .performer import Performer, Watch, bar, evaluating, float32, generators, sample_motion

# defaults of DDIM; with ten steps, dances to a song differ less (docs/RESULTS_ALL.md:
# dancer.steps10, dancer.steps50), and with less fresh noise, too
STEPS, ETA = 25, 1.0
# chosen on other songs than those of docs/RESULTS.md
USUAL_GUIDANCE = 4.0
GUIDED = 0.0025, 0.27  # alpha_bar: with more or less, dances follow the music without guidance
# standard deviations from the mean pose, to which the x0_hat of an eps network is clamped, as in
# DDPM's code
FARTHEST = 5.0
QUIET, LOUD = 0.1, 0.5  # loudest sample of a song that is made louder, and what it gets


register("dancer", MoFusion, MoFusionConfig)


@dataclass(frozen=True, eq=False, repr=False)
class Dancer(Performer):
    """A network, and the scalers that convert metres and log-Mel to its units and back."""

    model: DancerNetwork
    motion_scaler: Scaler
    mel_scaler: Scaler
    card: dict = field(default_factory=dict)

    @property
    def device(self) -> torch.device:
        return self.motion_scaler.mean.device

    @property
    def bones(self) -> Float[np.ndarray, "20"] | None:
        """The lengths of the bones that it was taught, in metres; None if bodies differed."""
        lengths = self.card.get("bones_cm")
        return None if lengths is None else np.array(lengths) / 100

    def mel_input(
        self, mel: Float[Tensor, "B M C"], frames: int
    ) -> tuple[Float[Tensor, "B M2 C"], Float[Tensor, "M2"]]:
        """The network's music for a dance of `frames` frames: standardised Mel frames, and their
        times in seconds.
        """
        mel = self.mel_scaler.transform(mel[:, : mel_frames(frames)].to(self.device))
        return mel, frame_times(mel.shape[1]).float().to(self.device)

    def denoiser(
        self, mel: Float[Tensor, "B M C"] | None, frames: int, guidance: float = 1.0
    ) -> Denoiser:
        """`denoise(x_s, s) -> eps_hat` for this music (None for a network without music).

        It works in the network's units. The music is encoded here, once; each call decodes. The
        x0_hat of an eps network is clamped to FARTHEST.

        `guidance`: w of `beyond.classifier_free`; 1 is the conditional network. Above 1 it acts
        between the strongest and the weakest noise (GUIDED).
        Raises ValueError for a network with music but no `mel`, or the reverse, for music that is
        shorter than the motion, and for guidance of a network that was not made for it.
        """
        if (mel is None) != (self.config.C == 0):
            raise ValueError(
                'this network takes no music: use md.inbetween, or md.load("dancer") to dance'
                if mel is not None
                else "this network dances to music; pass its log-Mel as mel"
            )
        guidance, music = self._guidance(guidance), None
        if mel is not None:
            checked_frames(mel, frames)
            with evaluating(self.model), torch.no_grad():
                music = self.model.listen(*self.mel_input(mel, frames))
        denoise = to_music = self._denoiser_for(music, frames)
        if music is not None and guidance != 1:
            to_nothing = self._denoiser_for(without(music), frames)
            denoise = guided_by_condition(to_music, to_nothing, guidance)
            if guidance > 1:
                denoise = while_between(denoise, to_music, self.schedule, *GUIDED)
        return self._clamped(denoise)

    @property
    def can_be_guided(self) -> bool:
        """Whether music was left out in training at times, so that `guidance` has a meaning."""
        recipe = self.card.get("recipe")
        return isinstance(recipe, dict) and bool(recipe.get("no_music", 0))

    @property
    def usual_guidance(self) -> float:
        """The guidance that dances have where none is asked for."""
        return USUAL_GUIDANCE if self.can_be_guided else 1.0

    def _guidance(self, asked: float | None) -> float:
        """The guidance that was asked for, or the usual one.

        Raises ValueError for guidance of a network that was not made for it.
        """
        if asked is None:
            return self.usual_guidance
        guidance = checked_guidance(asked)
        if guidance != 1 and not self.can_be_guided:
            raise ValueError(
                f"guidance = {guidance:g}: in training this network was never without its music, "
                "so leave guidance out"
            )
        return guidance

    def _denoiser_for(self, music: Music | None, frames: int) -> Denoiser:
        """The denoiser for music that the network has listened to already."""
        with evaluating(self.model), torch.no_grad():
            memory = self.model.encode(music, frames)
        return self._denoiser(self.model.decode, memory)

    def _clamped(self, denoise: Denoiser) -> Denoiser:
        if self.config.target != "eps":
            return denoise
        return with_guess(denoise, self.schedule, lambda x0: x0.clamp(-FARTHEST, FARTHEST))

    def dance(
        self,
        sound: str | Path | bytes | BinaryIO | np.ndarray | Tensor,
        *,
        sample_rate: float | None = None,
        seconds: float | None = None,
        samples: int = 1,
        seed: int = 0,
        steps: int | None = STEPS,
        guidance: float | None = None,
        progress: bool = True,
    ) -> Motion | list[Motion]:
        """Dance to a sound file (its name, its bytes, or open), or to samples with their rate.

        The returned motion contains the sound. Its bones keep their lengths and its standing feet
        do not slide (`motion/cleanup`); the network's own dance is that of `dance_mel`.

        sample_rate  of mono samples (N,) from -1 to 1, in Hz; a sound file has its own
        seconds  use so much of the sound from its start (default: all of it)
        samples  above 1: a list with this many dances; the first is that of samples=1
        seed     chooses the dance together with the sound: other music gets other moves. To dance
                 with the same noise to two songs, pass `start` to `dance_mel`
        steps    of DDIM, or None for DDPM with all steps, and noise of the posterior's variance
        guidance above 1 the dance follows the music more closely, at up to twice the cost of 1
                 (`beyond.classifier_free`); None: what is usual for this dancer
        Raises AudioError for unusable sound (`conditions.audio_files`), ValueError for `seconds` or
        `samples` out of range. Warns where the sound is shorter than `seconds`, or very quiet.
        Source: MoFusion 3.  Notebook: 00, 12
        """
        count, steps = checked_samples(samples), checked_steps(steps, self.schedule.S)
        guidance = self._guidance(guidance)
        checked_seed(seed)
        longest = None if seconds is None else round(checked_seconds(seconds) * SAMPLE_RATE)
        audio = samples_of(sound, sample_rate)[:longest]
        name = Path(sound).stem if isinstance(sound, (str, Path)) else "the sound given"
        frames = int(len(audio) / SAMPLE_RATE * FPS)
        mel = log_mel(audible(audio, name, seconds), SAMPLE_RATE)
        draws = generators(seed, count, *fingerprint(mel))
        dances = self.dance_mel(
            mel.expand(count, -1, -1),
            frames,
            generator=draws,
            steps=steps,
            guidance=guidance,
            watch=bar("dancing", (steps or self.schedule.S) + 1, progress),
        )
        dances = dances.double().cpu().numpy()
        made = [
            Motion(
                clean_up(dance, FPS, body=Body.of(dance, bones=self.bones)),
                FPS,
                audio=audio.numpy(),
                sample_rate=SAMPLE_RATE,
                source=f"dance to {name}",
            )
            for dance in dances
        ]
        return made if samples > 1 else made[0]

    @torch.no_grad()
    @float32()
    def dance_mel(
        self,
        mel: Float[Tensor, "B M C"],
        frames: int | None = None,
        *,
        generator: Generators | None = None,
        steps: int | None = STEPS,
        eta: float = ETA,
        guidance: float | None = None,
        start: Float[Tensor, "B T D"] | None = None,
        watch: Watch = iter,
    ) -> Float[Tensor, "B T 21 3"]:
        """Dance to log-Mel spectrograms (`conditions.music.log_mel`), one dance each.

        Dances are in metres, at 20 frames a second, and as the network makes them, not cleaned up.

        frames  the length of the dance (default: that of the music)
        steps   of DDIM with `eta`, at most S; None for DDPM with all steps, and noise of the
                posterior's variance
        guidance as in `dance`
        start   the noise to begin with (default: drawn); pass the same noise to compare two songs
        watch   gets the sampling loop, and shows how far it is
        Raises ValueError for more frames than the music has, and as `denoiser`.  Notebook: 12
        """
        frames = checked_frames(mel, frames)
        guidance = self._guidance(guidance)
        if getattr(self.config, "deterministic", False):
            return self._regress(mel, frames)
        denoise = self.denoiser(mel, frames, guidance)
        where = self.motion_scaler.mean.new_empty(len(mel), frames, self.config.D)
        x_S = draw(where, generator) if start is None else start.to(self.device)
        x0 = sample_motion(denoise, x_S, self.schedule, steps, eta, generator, watch)
        return to_positions(self.motion_scaler.inverse(x0))

    def _regress(self, mel: Float[Tensor, "B M C"], frames: int) -> Float[Tensor, "B T 21 3"]:
        """The single dance that a regression gives for each song."""
        nothing = torch.zeros(len(mel), frames, self.config.D, device=self.device)
        s = torch.zeros(len(mel), dtype=torch.long, device=self.device)
        with evaluating(self.model):
            out = self.model(nothing, s, self.model.listen(*self.mel_input(mel, frames)))
        return to_positions(self.motion_scaler.inverse(out))


def audible(
    audio: Float[Tensor, "N"], name: str, seconds: float | None = None
) -> Float[Tensor, "N"]:
    """A sound as it is danced to: a very quiet one is made louder, with a MotionWarning.

    Another one says where it is shorter than `seconds`.
    Raises AudioError for silence, ValueError for a sound that is too short for a motion.
    """
    lasts, peak = len(audio) / SAMPLE_RATE, float(audio.abs().max())
    if lasts < SHORTEST:
        raise ValueError(f"{lasts:.3f} s of sound are too short: at least {SHORTEST} s are needed")
    if peak < SILENT:
        raise AudioError(
            f"{name} is silent in its first {lasts:.1f} s, so there is nothing to dance to: "
            "use more seconds of it"
        )
    notes = []
    if seconds is not None and lasts < seconds - 1 / FPS:
        notes.append(f"{name} lasts {lasts:.1f} s, and the dance ends with it")
    if peak < QUIET:
        notes.append(
            f"{name} is very quiet (its loudest sample is {peak:.1g} of the largest there is), "
            "so it is danced to as if it were louder"
        )
        audio = audio * LOUD / peak
    for note in notes:
        warnings.warn(note, MotionWarning, stacklevel=3)
    return audio


def checked_frames(mel: Float[Tensor, "B M C"], frames: int | None) -> int:
    """The frames of a motion to this music, by default as many as it lasts.

    Raises ValueError for more than that, and for fewer than one.
    """
    longest = int((mel.shape[1] - 1) / FRAMES_PER_SECOND * FPS) + 1
    frames = longest if frames is None else frames
    if not 1 <= frames <= longest:
        raise ValueError(
            f"the music lasts {longest} frames of motion ({longest / FPS:.1f} s), not {frames}"
        )
    return frames
