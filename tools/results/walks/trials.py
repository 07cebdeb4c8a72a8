"""The trials of a walker: unseen pasts, unseen controls, and the data's own continuations."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Float

from data_synth.walking import continuations, dataset
from motiondiff_edu import rollout
from motiondiff_edu.metrics.walks import adherence, skating
from motiondiff_edu.motion.cleanup import clean_up
from motiondiff_edu.motion.clip import Clip
from motiondiff_edu.motion.root_frame import root_path, to_root_frame, to_world
from motiondiff_edu.motion.skeleton import TOES, J

from .scores import FPS

UNSEEN = 900_000  # seeds from here on are in no training set
MORE_STEPS = 50  # of DDIM, to compare with the usual ones
SECONDS, T_H = 12, 10

# (past (N, T_h, J, 3), control (N, T_h + n, 3), seed) -> new poses (N, n, J, 3), metres
Generate = Callable[[np.ndarray, np.ndarray, int], np.ndarray]


@dataclass(frozen=True, eq=False)
class Trials:
    """N pasts with the control of past and future, and the recorded future.

    Control row T_h belongs to truth[:, 0].
    """

    past: Float[np.ndarray, "N T_h J 3"]
    control: Float[np.ndarray, "N T 3"]
    truth: Float[np.ndarray, "N n J 3"]

    @classmethod
    def of(cls, clips: Sequence[Clip], T_h: int = T_H) -> "Trials":
        """The first T_h frames of each clip are the past; the rest is the future."""
        poses = np.stack([clip.poses for clip in clips])
        control = np.stack([clip.control for clip in clips])
        return cls(poses[:, :T_h], control, poses[:, T_h:])

    def first(self, n: int) -> "Trials":
        """The first n of them."""
        return Trials(self.past[:n], self.control[:n], self.truth[:n])

    @property
    def asked(self) -> Float[np.ndarray, "N n 3"]:
        """The control of the generated frames."""
        return self.control[:, -self.truth.shape[1] :]


def unseen(n: int = 100, seconds: float = SECONDS) -> Trials:
    """n trials of `seconds` with pasts and controls that are in no training set."""
    return Trials.of(dataset(n, seconds + T_H / FPS, seed=UNSEEN))


def cleaned(made: Float[np.ndarray, "N n J 3"], trials: Trials) -> Float[np.ndarray, "N n J 3"]:
    """Rollouts after the clean-up of `Walker.walk`, in the root frame again."""
    found = []
    for past, new, control in zip(trials.past, made, trials.control, strict=True):
        rows = control[: len(past) + len(new)]
        known = np.zeros((len(rows), J), bool)
        known[: len(past)] = True
        whole = clean_up(to_world(np.concatenate([past, new]), rows), FPS, known)
        found.append(to_root_frame(whole, *root_path(rows))[0][len(past) :])
    return np.stack(found)


def cleaned_rows(made: Float[np.ndarray, "N n J 3"], trials: Trials) -> dict[str, np.ndarray]:
    """The rows of `scores.FINISHED`: sliding and control after the clean-up, how far toes moved."""
    clean = cleaned(made, trials)
    return {
        "skating_clean": skating(clean, trials.asked),
        "skating_data": skating(trials.truth, trials.asked),
        "adherence_clean": adherence(clean, trials.asked),
        "adherence_data": adherence(trials.truth, trials.asked),
        "toes_moved": np.linalg.norm((clean - made)[:, :, TOES], axis=-1).mean((1, 2)),
    }


def walker_generate(
    walker, steps: int | None = None, hold: bool = True, batch: int = 100
) -> Generate:
    """A walker as a function of plain arrays; DDPM with all S steps, or DDIM with `steps`."""

    def generate(past: np.ndarray, control: np.ndarray, seed: int) -> np.ndarray:
        new = []
        for i in range(0, len(past), batch):
            inputs = [torch.from_numpy(x[i : i + batch]).float() for x in (past, control)]
            poses = rollout.generate(
                walker, inputs[0].flatten(2), inputs[1], seed=seed + i, steps=steps, hold=hold
            )
            new.append(poses.unflatten(-1, (-1, 3)).double().numpy())
        return np.concatenate(new)

    return generate


@dataclass(frozen=True, eq=False)
class Choices:
    """P pasts with their control, and n futures drawn from the data for each."""

    past: Float[np.ndarray, "P T_h J 3"]
    control: Float[np.ndarray, "P T 3"]
    drawn: Float[np.ndarray, "P n frames J 3"]


def choices(pasts: int = 20, n: int = 50, seconds: float = 3.0) -> Choices:
    """Pasts that have several right continuations, with `n` of them drawn from the data."""
    clips = dataset(pasts, seconds + T_H / FPS, seed=UNSEEN + 500_000)
    frames = round(seconds * FPS)
    drawn = [
        continuations(c.cut(0, T_H), c.control[T_H:], n, seed=UNSEEN + i)
        for i, c in enumerate(clips)
    ]
    futures = np.stack([[future.poses[-frames:] for future in futures] for futures in drawn])
    return Choices(
        np.stack([c.poses[:T_H] for c in clips]), np.stack([c.control for c in clips]), futures
    )


def rollouts_of(
    generate: Generate, asked: Choices, seed: int = 0
) -> Float[np.ndarray, "P n frames J 3"]:
    """Rollouts of each past, as many as futures were drawn from the data."""
    n = asked.drawn.shape[1]
    past, control = (np.repeat(x, n, axis=0) for x in (asked.past, asked.control))
    return generate(past, control, seed).reshape(asked.drawn.shape)
