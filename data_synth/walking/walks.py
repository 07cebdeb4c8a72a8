"""Walks: a figure walks along a commanded path. One past has several right continuations.

    python -m data_synth walks --out FOLDER [--clips 20] [--seconds 12] [--seed 0]

The root is exactly the commanded path; the pelvis sways about it. All is a causal function of
control and noise.
"""

from collections.abc import Sequence
from dataclasses import asdict

import numpy as np
from jaxtyping import Float

from motiondiff_edu.motion.clip import Clip
from motiondiff_edu.motion.root_frame import FPS, root_path

from ..noise import white
from .body import body
from .controls import KINDS, random_control
from .styles import STYLES, Style, draw_style, person

WARM_UP = 60  # frames of walking before the first one, with the first control

__all__ = ["continuations", "dataset", "random_control", "walk"]


def walk(control: Float[np.ndarray, "T 3"], seed: int, style: str | Style | None = None) -> Clip:
    """A walk along this control (m/s ahead, m/s left, rad/s; 20 frames/s).

    The same seed gives the same bytes.

    `style`: a name of styles.STYLES (the person is drawn from it), a Style taken as it is, or None
    to draw one.
    Raises ValueError for a control that is not (T, 3), not finite, or too fast to walk.
    """
    control = _checked(control)
    rng = np.random.default_rng([seed, 0])
    if not isinstance(style, Style):
        style = person(STYLES[draw_style(style, rng)], rng)
    return _clip(control, seed, style, float(rng.random()), [])


def continuations(past: Clip, control: Float[np.ndarray, "n 3"], n: int, seed: int) -> list[Clip]:
    """n walks of len(control) frames that continue from the last frame of `past`.

    All are right, and they differ.

    control[0] belongs to the first new frame; the step into it is the past's last control. Person,
    pose, clock, footprints and present behaviours come from the past; later noise is drawn again.
    Raises ValueError unless `past` was made by `walk` or `continuations` (whole, or cut, not
    mirrored).
    """
    made, control = past.info.get("made"), _checked(control)
    if made is None:
        raise ValueError(
            f"clip {past.source!r} was not made by data_synth.walking, "
            "so its own continuations are unknown"
        )
    end = _end_in(past)
    whole = np.concatenate([made["control"][:end], control])
    redraw = [(f, s) for f, s in made["redraw"] if f < end]
    seeds = np.random.SeedSequence([seed, 3]).generate_state(n)
    walks = (
        _clip(whole, made["seed"], made["style"], made["phase"], [*redraw, (end, int(s))])
        for s in seeds
    )
    return [w.cut(end, len(whole)) for w in walks]


def dataset(
    n_clips: int, seconds: float, seed: int, styles: Sequence[str] | None = None
) -> list[Clip]:
    """n_clips walks of `seconds`, controls of every kind.

    Styles are drawn by their shares or evenly from `styles`.
    """
    return [
        drawn_walk(seconds, np.random.default_rng([seed, 4, k]), styles) for k in range(n_clips)
    ]


def drawn_walk(
    seconds: float, rng: np.random.Generator, styles: Sequence[str] | None = None
) -> Clip:
    """A walk of `seconds` with a random kind of control, control, style and person."""
    kind = str(rng.choice(list(KINDS), p=list(KINDS.values())))
    name = draw_style(None, rng) if styles is None else str(rng.choice(list(styles)))
    return walk(random_control(seconds, rng, kind), int(rng.integers(2**31)), name)


def _checked(control: np.ndarray) -> np.ndarray:
    control = np.asarray(control, dtype=np.float64)
    if control.ndim != 2 or control.shape[1] != 3 or len(control) == 0:
        raise ValueError(
            f"a control is (frames, 3): ahead m/s, left m/s, yaw rad/s; got shape {control.shape}"
        )
    if not np.isfinite(control).all():
        raise ValueError(
            "control has a value that is not finite in frame "
            f"{int(np.argmin(np.isfinite(control).all(1)))}"
        )
    if (np.abs(control) > (4.5, 1.5, 4.5)).any():
        t = int(np.argmax((np.abs(control) > (4.5, 1.5, 4.5)).any(1)))
        raise ValueError(
            f"control in frame {t} is {control[t]}: at most 4.5 m/s ahead, 1.5 m/s aside, 4.5 rad/s"
        )
    return control


def _clip(control: np.ndarray, seed: int, style: Style, phase: float, redraw: list) -> Clip:
    """The walk; `redraw` [(frame, seed)] draws new noise from that frame on."""
    led = np.concatenate([np.repeat(control[:1], WARM_UP, 0), control])
    root_xz, heading = root_path(led)
    rows = white(seed, len(led), [(f + WARM_UP, s) for f, s in redraw])
    poses, contacts = body(led, root_xz, heading, rows, style, phase, FPS)
    made = {
        "control": control,
        "seed": seed,
        "style": style,
        "phase": phase,
        "redraw": redraw,
        "poses": poses[WARM_UP:],
    }
    info = {"style": style.name, "latents": asdict(style), "made": made}
    name = f"walk-{seed}" + "".join(f"-{f}.{s}" for f, s in redraw)
    return Clip(poses[WARM_UP:], control, FPS, contacts[WARM_UP:], name, info)


def _end_in(past: Clip) -> int:
    """The frame of the whole walk at which this (cut) clip ends."""
    whole, n = past.info["made"]["poses"], len(past)
    for first in range(len(whole) - n + 1):
        if np.array_equal(whole[first], past.poses[0]) and np.array_equal(
            whole[first + n - 1], past.poses[-1]
        ):
            return first + n
    raise ValueError(
        f"clip {past.source!r} does not lie in the walk it was cut from (mirrored or reversed?)"
    )
