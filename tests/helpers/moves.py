"""Movement whose beats are known: figures that stop when told, shake aimlessly, or sway."""

import numpy as np
from gaits import rest_pose


def directions(seed: int = 0) -> np.ndarray:
    """A unit vector for each joint."""
    drawn = np.random.default_rng(seed).normal(size=(21, 3))
    return drawn / np.linalg.norm(drawn, axis=1, keepdims=True)


def stopping_at(stops: np.ndarray, seconds: float, fps: float, reach: float = 0.3) -> np.ndarray:
    """Every joint goes to and fro and is at rest at each of the given times, and at no other.

    (T, 21, 3).
    """
    stops = np.asarray(stops, dtype=float)
    edges = np.concatenate([[stops[0] - 0.5], stops, [stops[-1] + 0.5]])
    times = np.arange(round(seconds * fps) + 1) / fps
    way = np.interp(times, edges, np.arange(len(edges)))  # 1 more at each stop
    return rest_pose() + reach * np.cos(np.pi * way)[:, None, None] * directions()


def shake(
    hz: float, seconds: float, fps: float, phase: float = 0.0, reach: float = 0.05
) -> np.ndarray:
    """The whole figure trembles at `hz`, and so stops 2 hz times a second.

    Whatever the music does.
    """
    times = np.arange(round(seconds * fps) + 1) / fps
    return (
        rest_pose() + reach * np.sin(2 * np.pi * hz * times + phase)[:, None, None] * directions()
    )


def sway(seconds: float, fps: float, hz: float = 0.5, reach: float = 0.2) -> np.ndarray:
    """Every joint goes round a level circle at one speed: nothing ever slows down."""
    angle = 2 * np.pi * hz * np.arange(round(seconds * fps) + 1) / fps
    ring = np.stack([np.cos(angle), 0 * angle, np.sin(angle)], -1)
    return rest_pose() + reach * ring[:, None]
