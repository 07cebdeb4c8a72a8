"""Mirroring and time reversal, with the velocities that belong to them.

Both are exact here: bones keep their length and the control still integrates to the figure's path.
Where we differ: the public preprocessing of the corpus mirrors the limbs but not the x of the
central joints, and negates the velocities of a reversed clip without shifting them by the frame
that a forward difference needs.
Source: MoDiff III-E, IV-A.  Notebook: 01
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from .clip import Clip
from .skeleton import MIRROR

# facts about a recording that do not hold for its mirrored or reversed version
_OF_THE_RECORDING = ("wild", "start")

_FLIP_X = np.array([-1.0, 1.0, 1.0])  # positions: x points to the left
_FLIP_CONTROL = np.array([1.0, -1.0, -1.0])  # control: forward stays, left and yaw change sign


def mirror(clip: Clip) -> Clip:
    """The clip seen in a mirror: every joint's x is negated, left and right are exchanged.

    The contacts of the feet are exchanged too. Mirroring twice is the identity.
    Raises ValueError for a control with columns of your own.  Notebook: 01
    """
    _check_control(clip)
    # torch accepts no array with a negative stride
    contacts = None if clip.contacts is None else clip.contacts[:, ::-1].copy()
    return replace(
        clip,
        poses=clip.poses[:, MIRROR] * _FLIP_X,
        control=clip.control * _FLIP_CONTROL,
        contacts=contacts,
        info=_without_places(clip),
    )


def _check_control(clip: Clip) -> None:
    if clip.control.shape[1] != 3:
        raise ValueError(
            f"clip {clip.source!r} has {clip.control.shape[1]} columns of control, and only three "
            "are known to change their signs: mirror or reverse it first, then add your own"
        )


def _without_places(clip: Clip) -> dict:
    """What is known of a clip, but for which joints are wild and where it started."""
    return {name: fact for name, fact in clip.info.items() if name not in _OF_THE_RECORDING}


def reverse_time(clip: Clip) -> Clip:
    """The clip played backwards.

    control'[t] = -control[T-2-t], since control[t] leads from frame t to t+1.

    Reversing twice is the identity, except for the last row of control: it repeats the row before
    by convention.
    Raises ValueError for a control with columns of your own.
    Source: MoDiff III-E.  Notebook: 01
    """
    _check_control(clip)
    control = np.empty_like(clip.control)
    control[:-1] = -clip.control[:-1][::-1]
    control[-1] = control[-2] if len(clip) > 1 else -clip.control[-1]
    contacts = None if clip.contacts is None else clip.contacts[::-1].copy()
    return replace(
        clip,
        poses=clip.poses[::-1].copy(),
        control=control,
        contacts=contacts,
        info=_without_places(clip),
    )


def augment(clips: Sequence[Clip]) -> list[Clip]:
    """Four clips from each: unchanged, mirrored, reversed, and both.

    They keep their `source`, so a split by source stays clean.

    Source: MoDiff III-E.  Notebook: 01
    """
    both = [version for clip in clips for version in (clip, mirror(clip))]
    return both + [reverse_time(clip) for clip in both]
