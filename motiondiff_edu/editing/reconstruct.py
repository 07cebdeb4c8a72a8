"""Missing joints of a motion of any length: windows of ten frames cover each hole, and each window
is repaired by a walk there and back.

    guess -> every window there and back -> the mean where they overlap -> bones -> next guess
Windows that are repaired alone do not fit together. So each round begins with the mean of all
windows. The way back is conditioned on the known joints, so that a hole joins on both sides.
Source: MoDiff III-E; the overlapping windows are ours.
"""

import warnings
from collections.abc import Callable, Iterable

import numpy as np
import torch
from jaxtyping import Bool, Float, Int
from torch import Tensor

from .. import reconstruction
from ..beyond.back_with_known import FADE, blended_way_back
from ..beyond.guidance import blended_guess
from ..motion.cleanup import Body, clean_bones, clean_up, runs
from ..motion.dance_frame import headings_between
from ..motion.directions import ARMS, UPLEGS
from ..motion.motion import MotionError, MotionWarning
from ..motion.root_frame import FPS, smoothed_root, to_root_frame, to_world
from ..motion.skeleton import HIPS, JOINTS, MIRROR, J
from ..performers.continuation import farthest, unlike_training
from ..performers.performer import STEPS, float32
from ..reconstruction import Rollout, Stop
from ..rollout import SLACK, AnyWalker, Units

ROUNDS = 3  # there and back
BATCH = 64  # windows at once
CLEARLY = (
    0.9  # of the error of a limb that stands still: a reconstruction that is not nearer is in doubt
)


def reconstruct(
    walker: AnyWalker,
    positions: Float[np.ndarray, "T 21 3"],
    known: Bool[np.ndarray, "T 21"],
    *,
    generator: torch.Generator,
    rounds: int = ROUNDS,
    watch: Callable[[Iterable[int]], Iterable[int]] = iter,
) -> Float[np.ndarray, "T 21 3"]:
    """Reconstruct the joints that are not known, in a motion in the world (metres, 20 frames/s).

    Unknown joints can be NaN; known joints come back unchanged, bit by bit. The control comes from
    the pelvis and from the direction of hips and shoulders, smoothed. `watch` gets the loop over
    the rounds, and shows how far it is.
    Where the figure is faster than in the walker's training, the control stays at that limit, and a
    MotionWarning says where; so does one where known joints are unlike those of the training.
    Raises MotionError if a pelvis is missing, if no frame shows which way the figure faces, if
    nothing is missing, and for a motion shorter than a window.  Source: MoDiff III-E.
    """
    T_h, firsts = walker.config.T_h, _windows(known, walker.config.T_h)
    place, facing = path_of(positions, known)
    poses, control = to_root_frame(np.where(known[..., None], positions, 0.0), place, facing)
    mask = torch.from_numpy(np.repeat(known, 3, axis=1))
    given = torch.where(mask, torch.from_numpy(poses).flatten(1), 0.0)
    warn_of_unlike(walker.pose_scaler, given, known)
    body = Body.of(positions, known).completed()
    mean = walker.pose_scaler.mean.to(given).expand_as(given)
    guess = blended_guess(mean[None], given[None], mask[None], FADE)[0]
    steer = within_training(walker, control, known)
    steer = torch.from_numpy(np.concatenate([steer, np.repeat(steer[-1:], T_h, axis=0)]))
    rollout = Rollout(walker, generator, STEPS)
    for _ in watch(range(rounds)):
        found = _once(rollout, guess, mask, steer, firsts)
        joints = torch.where(mask, given, found).unflatten(-1, (J, 3)).numpy()
        guess = torch.from_numpy(clean_bones(joints, known, body)).flatten(1)
    start = (*place[0].tolist(), float(facing[0]))
    made = to_world(guess.unflatten(-1, (J, 3)).numpy(), control, start)
    whole = np.where(known[..., None], positions, made)
    return clean_up(whole, FPS, known)


def other_side_in_doubt(
    walker: AnyWalker,
    made: Float[np.ndarray, "T 21 3"],
    known: Bool[np.ndarray, "T 21"],
    generator: torch.Generator,
) -> str:
    """What speaks against a reconstruction, by a test on the limb of the other side; or "".

    That limb is given. It is hidden in the same frames and reconstructed from the rest; where a
    limb that stays in its mean pose is as near to it, the walker knows nothing of such motions.
    """
    missing = np.flatnonzero(~known.all(0))
    others = [int(MIRROR[joint]) for joint in missing if MIRROR[joint] not in missing]
    shown = np.ones_like(known)
    shown[:, others] = known[:, MIRROR[others]]
    if shown.all():
        return ""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MotionWarning)  # it was said of the motion itself
        again = reconstruct(walker, made, shown, generator=generator)
    place, facing = path_of(made, np.ones_like(known))
    poses, _ = to_root_frame(made, place, facing)
    usual = np.where(shown[..., None], 0.0, poses).sum(0) / np.maximum((~shown).sum(0), 1)[:, None]
    misses = np.linalg.norm(again - made, axis=-1)[~shown].mean()
    still = np.linalg.norm(poses - usual, axis=-1)[~shown].mean()
    if misses < CLEARLY * still:
        return ""
    return (
        f"{JOINTS[others[-1]]}, which is given, is missed by {100 * misses:.0f} cm when it is "
        f"hidden as well, and by {100 * still:.0f} cm if it stays in its mean pose: what is "
        "reconstructed on the other side may be no nearer than a motionless limb"
    )


def within_training(
    walker: AnyWalker, control: Float[np.ndarray, "T 3"], known: Bool[np.ndarray, "T 21"]
) -> Float[np.ndarray, "T 3"]:
    """The control, limited to that of the walker's training; a MotionWarning where it goes beyond.

    A walker without a card gets it as it is.
    """
    seen = getattr(walker, "card", {}).get("control_range")
    if not seen:
        return control
    low, high = (np.array(seen[end]) for end in ("low", "high"))
    limited = control.clip(low, high)
    beyond = (np.abs(limited - control) > SLACK * (high - low)).any(1) & ~known.all(1)
    if beyond.any():
        warnings.warn(
            f"in {beyond.sum()} of the frames with missing joints, the first is {beyond.argmax()}, "
            "the figure moves or turns faster than the walker was trained on: there the result is "
            "less certain",
            MotionWarning,
            stacklevel=3,
        )
    return limited


def warn_of_unlike(
    scaler: Units, given: Float[Tensor, "T 63"], known: Bool[np.ndarray, "T 21"]
) -> None:
    """A MotionWarning where poses with missing joints are unlike those of the walker's training."""
    holes = ~np.all(known, axis=1)
    unlike = unlike_training(scaler, given[holes].float(), known[holes])
    if unlike:
        warnings.warn(
            f"the poses are unlike the walker's training {farthest(unlike)}, so what is "
            "reconstructed may be far from the truth, and samples are nearer to each other than to "
            "it",
            MotionWarning,
            stacklevel=3,
        )


@float32()
def _once(
    rollout: Rollout,
    guess: Float[Tensor, "T D"],
    mask: Bool[Tensor, "T D"],
    steer: Float[Tensor, "F 3"],
    firsts: Int[np.ndarray, "W"],
) -> Float[Tensor, "T D"]:
    """Repair every window once, there and back, and average where windows overlap.

    The middle of a window has the largest weight.
    """
    T_h = rollout.walker.config.T_h
    weight = 1.0 + torch.arange(T_h).minimum(torch.arange(T_h).flip(0)).to(guess)[:, None]
    found, total = torch.zeros_like(guess), torch.zeros_like(guess[:, :1])
    for some in torch.from_numpy(firsts).split(BATCH):
        rows = some[:, None] + torch.arange(T_h)
        control = steer[some[:, None] + torch.arange(2 * T_h)].float()
        past = guess[rows].float()
        back = reconstruction.reconstruct(
            rollout,
            past,
            mask[rows],
            control,
            way_back=blended_way_back,
            guess=past,
            stop=Stop(rounds=1),
        )
        for where, window in zip(rows, back, strict=True):
            found[where] += weight * window.to(guess)
            total[where] += weight
    return torch.where(total > 0, found / total.clamp(min=1.0), guess)


def _windows(known: Bool[np.ndarray, "T 21"], T_h: int) -> Int[np.ndarray, "W"]:
    """The first frames of windows that cover every hole, half a window apart.

    Windows extend beyond a hole where the motion has frames.
    """
    T, half = len(known), max(1, T_h // 2)
    if known.all():
        raise MotionError("nothing is missing, so there is nothing to reconstruct")
    if T < T_h:
        raise MotionError(f"the motion has {T} frames; the walker's windows have {T_h}")
    firsts = {
        min(max(begin, 0), T - T_h)
        for first, last in runs(~np.all(known, axis=1)).tolist()
        for begin in range(first - half, last, half)
    }
    return np.array(sorted(firsts))


def path_of(
    positions: Float[np.ndarray, "T 21 3"], known: Bool[np.ndarray, "T 21"]
) -> tuple[Float[np.ndarray, "T 2"], Float[np.ndarray, "T"]]:
    """Root path and heading of a motion with holes.

    They come from the pelvis, and from hips and shoulders where they are known. Between, the
    heading turns evenly, the short way round; before the first and after the last it stays.

    Raises MotionError, with the frame, if the pelvis is not known there, or if neither hips nor
    shoulders are known in any frame.
    """
    lost = np.flatnonzero(~known[:, HIPS])
    if len(lost):
        raise MotionError(
            f"the pelvis ({JOINTS[HIPS]}) is not known in frame {lost[0]} ({len(lost)} frames in "
            "all), but the control is derived from it. Frames that are lost as a whole are filled "
            "in by md.inbetween(motion, md.keyframes(motion, every=1))"
        )
    across, has_direction = np.zeros((len(positions), 3)), np.zeros(len(positions), bool)
    for left, right in (UPLEGS, ARMS):
        both = known[:, left] & known[:, right]
        across[both] += (positions[:, left] - positions[:, right])[both]
        has_direction |= both
    if not has_direction.any():
        raise MotionError(
            "the direction of the figure is unknown: no frame has both hips or both shoulders"
        )
    facing = headings_between(across, has_direction)
    return smoothed_root(positions[:, HIPS][:, [0, 2]], facing)
