"""Controls like those from a joystick: targets held for a while, reached by smooth ramps."""

import numpy as np
from jaxtyping import Float
from scipy.ndimage import gaussian_filter1d

from motiondiff_edu.motion.root_frame import FPS

# the kinds and their shares in a data set
KINDS = {
    "mixed": 0.3,
    "straight": 0.16,
    "turn": 0.16,
    "run": 0.12,
    "start_stop": 0.12,
    "sidestep": 0.07,
    "backward": 0.04,
}
KINDS |= {"spot": 0.02, "stand": 0.01}
MAX_YAW = np.radians(120.0)


def _target(kind: str, rng: np.random.Generator) -> tuple[float, float, float]:
    """One commanded velocity: ahead, left, yaw."""
    some = float(rng.uniform(-1, 1))
    if kind == "straight":
        return float(rng.uniform(0.6, 1.9)), 0.0, 0.25 * some * (rng.random() < 0.5)
    if kind == "turn":
        return float(rng.uniform(0.4, 1.7)), 0.0, 1.1 * MAX_YAW * some
    if kind == "run":
        return float(rng.uniform(1.8, 3.0)), 0.0, 0.9 * some * (rng.random() < 0.6)
    if kind == "sidestep":
        return (
            float(rng.uniform(-0.1, 0.7)) * (rng.random() < 0.5),
            0.6 * some,
            0.3 * float(rng.uniform(-1, 1)) * (rng.random() < 0.3),
        )
    if kind == "backward":
        return (
            float(rng.uniform(-0.5, -0.15)),
            0.15 * some * (rng.random() < 0.3),
            0.5 * float(rng.uniform(-1, 1)) * (rng.random() < 0.4),
        )
    if kind == "spot":
        return 0.0, 0.0, 1.1 * MAX_YAW * some
    return 0.0, 0.0, 0.0  # stand


_MIXED = {
    "straight": 0.3,
    "turn": 0.28,
    "run": 0.12,
    "sidestep": 0.09,
    "backward": 0.06,
    "spot": 0.04,
    "stand": 0.11,
}


def _sub_kind(kind: str, previous: str, rng: np.random.Generator) -> str:
    if kind == "mixed":
        return str(rng.choice(list(_MIXED), p=list(_MIXED.values())))
    if kind == "start_stop":
        return (
            "stand"
            if previous != "stand"
            else str(rng.choice(["straight", "straight", "turn", "sidestep", "run"]))
        )
    if kind in ("sidestep", "backward", "spot") and previous != "stand" and rng.random() < 0.25:
        return "stand"
    return kind


def _ramp(targets: np.ndarray, fps: float, rise: tuple[float, float, float]) -> np.ndarray:
    """Follow the targets with limited acceleration."""
    out, step = targets.copy(), np.array(rise) / fps
    for t in range(1, len(out)):
        out[t] = out[t - 1] + np.clip(targets[t] - out[t - 1], -step, step)
    return out


def random_control(
    seconds: float, rng: np.random.Generator, kind: str = "mixed", fps: float = FPS
) -> Float[np.ndarray, "T 3"]:
    """A random control of one of KINDS.

    Targets last 1-5 s and ramps 0.3-1 s; it is as smooth as a real root path.

    Raises ValueError for an unknown kind.
    """
    if kind not in KINDS:
        raise ValueError(f"no kind of control is called {kind!r}; there are {', '.join(KINDS)}")
    margin, n = round(1.5 * fps), round(seconds * fps)
    rows, now = [], ""
    while len(rows) < n + 2 * margin:
        now = _sub_kind(kind, now, rng)
        hold = rng.uniform(1.0, 2.5) if now == "stand" else rng.uniform(1.2, 5.0)
        rows += [_target(now, rng)] * round(hold * fps)
    ramp = _ramp(
        np.array(rows[: n + 2 * margin]), fps, tuple(rng.uniform((1.3, 0.8, 2.5), (2.8, 1.6, 5.0)))
    )
    smooth = gaussian_filter1d(ramp, rng.uniform(0.15, 0.3) * fps, axis=0, mode="nearest")
    return _possible(smooth[margin : margin + n])


def _possible(control: np.ndarray) -> np.ndarray:
    """Limit turning and stepping aside by the speed.

    |v w| is at most 2.3 m/s2, and there is no fast sideways running.
    """
    speed = np.abs(control[:, 0])
    most = np.minimum(MAX_YAW, 2.3 / np.maximum(speed, 0.5))
    yaw = control[:, 2] / (1 + (np.abs(control[:, 2]) / most) ** 12) ** (1 / 12)
    aside = control[:, 1] * np.clip((2.0 - speed) / 0.8, 0, 1)
    return np.stack([control[:, 0], aside, yaw], -1)
